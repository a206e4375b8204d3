"""Layers that soften with their own amplitude, marched: against the frequency domain, and by themselves."""

from dataclasses import replace

import numpy as np
import pytest
from tests.analysis.test_softening import LAW, RUBBER, mass_on_layer

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.material.amplitude import Rest
from two_tones import PAIRS, AtOneAmplitude, inertia_of_a_step

PLACE, STEPS = "mass.centre.z", 100  # a period
# a band tells how far the rest is sought; without, a second tone errs by up to three times as much
BANDED = replace(RUBBER, band=(5.0, 7e3))


def driven(tones, material=RUBBER, *, periods=120, kept=20, steps=STEPS, static=0.0, **more):
    """March under forces (N at Hz) along z; their amplitudes in the last `kept` periods of the first."""
    app = mass_on_layer(material)
    for size, hz in tones:
        app.load("mass.centre", (0, 0, size, 0, 0, 0), frequency=hz)
    if static:
        app.load("mass.centre", (0, 0, static, 0, 0, 0))
    base = min(hz for _, hz in tones)
    dt = 1 / base / steps
    record = [PLACE, *(["layer.strain"] if material.payne else [])]
    run = bd.transient(
        bd.equilibrium(app),
        speed=0.0,
        dt=dt,
        steps=kept * steps,
        settle=(periods - kept) * steps,
        record=record,
        progress=False,
        **more,
    )
    z, t = run.record.sel(channel=PLACE).values, run.time.values
    found = [2 * np.mean(z * np.exp(-2j * np.pi * hz * t)) for _, hz in tones]
    return found, run


def answered(f, size, material=RUBBER):
    """Complex response of the frequency domain to this force, m."""
    amplitude = {} if material.payne is None else {"amplitude": size}
    run = bd.frequency_response(mass_on_layer(material), f, [PLACE], [PLACE], **amplitude)
    return size * run.response.values[:, 0, 0]


def peak_of(f, response):
    """Frequency and height of a resonance by the parabola of 1/|H|² in f² through three points or more."""
    x = (np.asarray(f) / f[1]) ** 2 - 1
    a, b, c = np.polyfit(x, np.abs(response) ** -2, 2)
    return f[1] * np.sqrt(1 - b / (2 * a)), (c - b * b / (4 * a)) ** -0.5


@pytest.mark.parametrize("size", [0.5, 5.0, 20.0])
def test_both_domains_have_the_same_resonance(size):
    """At 100 steps a period: .1 % in frequency, .2 % in height. Newmark errs by (ωΔt)²/12 = .03 %."""
    fine = np.linspace(230.0, 320.0, 901)
    top = fine[np.abs(answered(fine, size)).argmax()]
    f = [0.985 * top, top, 1.015 * top]
    ours = [driven([(size, hz)])[0][0] for hz in f]
    frequency, height = peak_of(f, np.array(ours))
    expected = peak_of(f, answered(f, size))
    assert frequency == pytest.approx(expected[0], rel=1e-3)
    assert height == pytest.approx(expected[1], rel=2e-3)


def test_the_running_strain_is_that_of_the_frequency_domain():
    _, run = driven([(5.0, 250.0)])
    wanted = bd.frequency_response(mass_on_layer(), [250.0], [PLACE], [PLACE], amplitude=5.0)
    running = run.record.sel(channel="layer.strain").values[-1]
    # the memory of five periods cuts 1/(2 (2π 5)²) = .05 % of the amplitude, Newmark some more of the motion
    assert running == pytest.approx(float(wanted.strain[0, 0, 0]), rel=3e-3)


def test_the_running_strain_is_exact_but_for_its_memory_however_long_the_step():
    """Over the motion it comes from, at 20 steps a period as at 200: cut by 1/√(1 + 1/(ω memory)²)."""
    wanted = bd.frequency_response(mass_on_layer(), [200.0], [PLACE], [PLACE], amplitude=5.0)
    of_one = float(wanted.strain[0, 0, 0]) / abs(5.0 * complex(wanted.response[0, 0, 0]))
    cut = 1 / np.sqrt(1 + 1 / (2 * np.pi * 5) ** 2)
    for steps in (20, 200):
        (z,), run = driven([(5.0, 200.0)], steps=steps, memory=5 / 200.0)
        running = run.record.sel(channel="layer.strain").values
        # its ripple is 1/(2 (2π 5)²)²-th part; a rule of first order would be off by 1/(2·20·5) = .5 %
        assert np.sqrt(np.mean(running**2)) == pytest.approx(cut * of_one * abs(z), rel=5e-5), steps


def test_a_small_vibration_meets_the_unbroken_rubber():
    """The limit of small amplitude is linear: rest and D, marched as an ordinary Maxwell model."""
    rest = RUBBER.rest
    assert isinstance(rest, Rest)
    hz = 240.0
    (small,), _ = driven([(1e-6, hz)])
    (smaller,), _ = driven([(1e-9, hz)])
    assert small / 1e-6 == pytest.approx(smaller / 1e-9, rel=1e-9)
    expected = answered([hz], 1e-6)[0]
    assert abs(small) == pytest.approx(abs(expected), rel=1e-3)


@pytest.mark.parametrize("hz", [260.0, 320.0])
def test_a_linear_march_errs_by_what_the_step_makes_of_inertia(hz):
    """The closed form of Newmark's error, on both flanks of the layer without its law: .14 and −.31 %."""
    (z,), run = driven([(6.0, hz)], RUBBER.with_payne(None))
    dt = float(run.time[1] - run.time[0])
    apart = mass_on_layer(RUBBER.with_payne(None), mass=0.6 * inertia_of_a_step(hz, dt))
    meant = bd.frequency_response(apart, [hz], [PLACE], [PLACE]).response.values[0, 0, 0]
    # branches take the strain as linear between samples, which is (ωΔt)²/12 of what relaxes in a step
    assert abs(z) == pytest.approx(6.0 * abs(meant), rel=3e-5)
    assert abs(abs(z) / abs(answered([hz], 6.0, RUBBER.with_payne(None))[0]) - 1) > 1e-3


@pytest.mark.parametrize(("tones", "kept"), PAIRS)
@pytest.mark.filterwarnings("ignore::bearingdyn.notice.BeyondData")  # at rest, below the band
def test_two_tones_share_one_strain(tones, kept):
    """Each tone against the formula for several, E + 2 L iω/(iω + Ω), of the strain of both, to .2 %.

    At 100 steps of a period of the faster, with what the step makes of inertia in the reference: a march
    without a law errs by as much, up to .31 % at these tones. The law's own: what the rest lacks is added
    for one frequency, and is off by up to .1 % of the modulus at another. Where a weak tone at the resonance
    is far from a strong one that is .4 % of its motion (5 N at 270 Hz beside 50 N at 180 Hz).
    """
    (_, slow), (_, fast) = tones
    steps = round(STEPS * fast / slow)
    found, run = driven(tones, BANDED, periods=240, kept=kept, steps=steps, memory=10 / slow)
    running = run.record.sel(channel="layer.strain").values  # it beats by half a percent
    gamma = float(np.sqrt(np.mean(running**2)))
    met = AtOneAmplitude.of(BANDED, gamma, [hz for _, hz in tones], np.array(found))
    for (size, hz), z in zip(tones, found, strict=True):
        apart = mass_on_layer(met, mass=0.6 * inertia_of_a_step(hz, 1 / slow / steps))
        meant = bd.frequency_response(apart, [hz], [PLACE], [PLACE]).response.values[0, 0, 0]
        assert abs(z) == pytest.approx(size * abs(meant), rel=2e-3)


def test_a_lasting_load_is_no_amplitude():
    """Small vibration about a static deflection of half a percent is that without it, .3 %."""
    (alone,), _ = driven([(0.5, 240.0)])
    (about,), run = driven([(0.5, 240.0)], static=400.0)
    z = run.record.sel(channel=PLACE).values.mean()
    assert z > 10 * abs(alone)
    assert abs(about) == pytest.approx(abs(alone), rel=3e-3)


def test_the_start_is_at_rest_in_the_equilibrium():
    app = mass_on_layer()
    app.load("mass.centre", (0, 0, 300.0, 0, 0, 0))
    state = bd.equilibrium(app)
    run = bd.transient(state, speed=0.0, dt=1e-5, steps=500, record=[PLACE], memory=0.01, progress=False)
    z = run.record.values[:, 0]
    assert np.ptp(z) < 1e-9 * abs(z[0])


def test_energy_is_accounted_for_with_a_loss_of_its_own():
    for steps, allowed in (
        (100, 5e-4),
        (200, 1.3e-4),
    ):  # of the throughput; the trapezoidal rule, second order
        _, run = driven([(10.0, 270.0)], steps=steps, audit=True)
        e = {name: run.attrs[f"energy_{name}"] for name in core.ENERGIES}
        lost = e["linear"] + e["branch"] + e["contact"] + e["softening"]
        change = e["kinetic"] + e["elastic"] + e["stored"] + e["indentation"]
        start = 0.0  # no static load
        assert e["load"] + e["turning"] - lost - (change - start) == pytest.approx(
            0.0, abs=allowed * e["throughput"]
        )
        assert e["softening"] > 0.1 * e["branch"]


def test_what_a_layer_holds_is_accounted_for_within_a_swing():
    """Pulled aside once: what is stored is then as much as what came in, the slow branch's share too."""
    app = mass_on_layer()
    knots = np.array([0.0, 4e-3, 8e-3])
    app.load("mass.centre", (0, 0, 1.0, 0, 0, 0), time=knots, value=np.array([0.0, 300.0, 300.0]))
    run = bd.transient(
        bd.equilibrium(app),
        speed=0.0,
        dt=5e-6,
        steps=1000,
        record=[],
        memory=0.02,
        audit=True,
        progress=False,
    )
    e = {name: run.attrs[f"energy_{name}"] for name in core.ENERGIES}
    lost = e["linear"] + e["branch"] + e["contact"] + e["softening"]
    held = e["kinetic"] + e["elastic"] + e["stored"] + e["indentation"]
    assert held > 0.5 * e["load"]
    # the slow branch holds 3 % of it; the trapezoidal rule leaves 1e-5
    assert e["load"] + e["turning"] == pytest.approx(lost + held, rel=2e-4)


def test_what_has_healed_bears_nothing_of_a_load_that_was_there():
    """A load sags under strong vibration, and does not rise again when that has died away."""
    period, vibrating = 1 / 200.0, 80
    t = np.arange(0.0, 2 * vibrating * period, period / 40)
    force = 200.0 + np.where(t < vibrating * period, 60.0 * np.sin(2 * np.pi * t / period), 0.0)
    app = mass_on_layer()
    app.load("mass.centre", (0, 0, 1.0, 0, 0, 0), time=t, value=force)
    run = bd.transient(
        bd.equilibrium(app),
        speed=0.0,
        dt=period / 100,
        steps=2 * vibrating * 100,
        record=[PLACE, "layer.strain"],
        memory=5 * period,
        progress=False,
    )
    z, strain = (run.record.sel(channel=c).values for c in (PLACE, "layer.strain"))
    at = vibrating * 100
    sunk, after = z[at - 500 : at].mean(), z[-500:].mean()
    assert strain[at - 1] > 5e-3 > 1e-4 > strain[-1]
    assert sunk > 1.05 * z[0]
    # relaxing and the amplitude that is left take it on, if anything
    assert after > 0.999 * sunk


@pytest.mark.parametrize("seed", range(20))
def test_softening_never_makes_energy(seed):
    """Random forces: what the law has turned into heat never falls. 50 stretches of each of 20 paths."""
    rng = np.random.default_rng(seed)
    knots = np.concatenate([[0.0], np.cumsum(rng.uniform(1e-4, 3e-3, 120))])
    force = rng.normal(size=121) * 10 ** rng.uniform(-1.0, 2.3, 121)
    app = mass_on_layer()
    app.load("mass.centre", (0, 0, 1.0, 0, 0, 0), time=knots, value=force)
    run, lost = None, [0.0]
    for _ in range(50):
        run = bd.transient(
            bd.equilibrium(app) if run is None else app,
            speed=0.0,
            dt=2e-5,
            steps=150,
            record=[],
            resume=run,
            memory=0.01,
            audit=True,
            progress=False,
        )
        lost.append(run.attrs["energy_softening"])
    assert (np.diff(lost) >= 0).all()
    assert lost[-1] > 0


def test_a_march_goes_on_bit_for_bit_and_is_the_same_for_every_instruction_set():
    app = mass_on_layer()
    app.load("mass.centre", (0, 0, 10.0, 0, 0, 0), frequency=280.0)
    state = bd.equilibrium(app)
    same = {"speed": 0.0, "dt": 1 / 28000, "record": [PLACE, "layer.strain"], "progress": False}
    whole = bd.transient(state, steps=3000, **same)
    assert whole.attrs["refactors"] > 10
    first = bd.transient(state, steps=1111, **same)
    rest = bd.transient(state, steps=1889, resume=first, **same)
    assert np.array_equal(whole.state.values, rest.state.values)
    assert np.array_equal(whole.record.values[1111:], rest.record.values[-1889:])
    for isa in core.ISAS:
        try:
            scheme = bd.Scheme(isa=isa)
        except ValueError:
            continue  # not of this machine
        run = bd.transient(state, steps=3000, scheme=scheme, **same)
        assert np.array_equal(whole.state.values, run.state.values), isa


def test_a_memory_that_nothing_tells_is_asked_for():
    with pytest.raises(ValueError, match=r"memory is None; a layer softens .* five periods"):
        bd.transient(mass_on_layer(), speed=0.0, dt=1e-5, steps=10, record=[PLACE])
    with pytest.raises(ValueError, match=r"memory is -1"):
        bd.transient(mass_on_layer(), speed=0.0, dt=1e-5, steps=10, record=[PLACE], memory=-1)


def test_a_channel_of_strain_needs_a_law():
    with pytest.raises(ValueError, match=r"'layer' has no law of softening"):
        bd.transient(
            mass_on_layer(RUBBER.with_payne(None)),
            speed=0.0,
            dt=1e-5,
            steps=10,
            record=["layer.strain"],
        )


def test_laws_of_a_state_belong_to_its_system():
    app = mass_on_layer()
    run = bd.transient(app, speed=0.0, dt=1e-5, steps=10, record=[PLACE], memory=0.01)
    other = mass_on_layer(RUBBER.with_payne(LAW.scaled(0.9)))
    with pytest.raises(ValueError, match=r"resume"):
        bd.transient(other, speed=0.0, dt=1e-5, steps=10, record=[PLACE], memory=0.01, resume=run)
