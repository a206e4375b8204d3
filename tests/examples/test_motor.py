"""The main job, examples/motor.py: its numbers, and that time and frequency domain tell one story on it."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path

import motor
import motor_report
import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.examples.paper import PRELOAD, paper_pedestal, plain_6305
from rotors import motor_rubber
from twins.linear_twin import discrete_response

ENERGIES = ("kinetic", "elastic", "stored", "indentation")


@cache
def rubber() -> bd.Maxwell:
    return motor_rubber()


@cache
def equilibrium(design: int, radial: float = 0.0) -> bd.Equilibrium:
    return bd.equilibrium(motor.motor(motor.designs(rubber())[design], radial))


def test_the_low_and_the_high_loss_rubber_are_equally_stiff_at_1_khz() -> None:
    low, high = (d.rubber for d in motor.designs(rubber())[1:3])
    assert low is not None
    assert high is not None
    omega = motor.ONE_KHZ
    # by construction, to round-off
    assert abs(high.complex_modulus(omega)) == pytest.approx(abs(low.complex_modulus(omega)), rel=1e-12)
    assert float(high.loss_factor(omega)) == pytest.approx(0.30, rel=1e-12)


def test_the_sample_too_has_a_layer_of_low_and_one_of_high_loss() -> None:
    """It loses 0.30 at 1 kHz of itself; without the measurement it is what the demo runs on."""
    sample, _, _ = motor.rubber(Path("absent.csv"))
    losses = [d.rubber.loss_factor(motor.ONE_KHZ) for d in motor.loss_designs(sample)]
    assert losses == pytest.approx([0.10, 0.30, 0.60], rel=0.02)
    stiff = [abs(d.rubber.complex_modulus(motor.ONE_KHZ)) for d in motor.designs(sample)[1:3]]
    assert stiff[0] == pytest.approx(stiff[1], rel=1e-9)


def test_bending_modes_lie_near_the_papers() -> None:
    # the aim is 10 %; the geometry is our own choice
    assert motor.bending_modes(equilibrium(0)) == pytest.approx(motor.PAPER_MODES, rel=0.10)


@pytest.mark.parametrize("design", [1, 2])
def test_the_layer_is_at_most_a_third_as_stiff_as_the_bearing(design: int) -> None:
    variant = motor.designs(rubber())[design]
    layer = variant.layer
    assert layer is not None
    eq, loaded = equilibrium(design), equilibrium(design, motor.RADIAL)
    dynamic = abs(layer.stiffness(motor.ONE_KHZ)[0, 0])
    # in the harmonic analysis' state (axial preload alone) and under the transient's radial load
    for state in (eq, loaded):
        assert dynamic <= state.bearings["left"].radial_stiffness / 3


@pytest.mark.parametrize("design", [1, 2])
def test_a_layer_strained_beyond_5_percent_under_the_papers_resting_load_is_warned_of(
    design: int, capsys: pytest.CaptureFixture[str]
) -> None:
    variant, rest, loaded = (
        motor.designs(rubber())[design],
        equilibrium(design),
        equilibrium(design, motor.RADIAL),
    )
    layer, material = variant.layer, variant.rubber
    assert layer is not None
    assert material is not None
    still = bd.static_summary(loaded).sel(layer="left_layer")
    # the force of the left bearing on the layer alone, solved in full at G(t)
    force = abs(loaded.bearings["left"].force[1])
    sag = force / layer.stiffness(after=motor.RESTED)[1, 1].real
    # the reduced layer's shapes are taken at G0 and at the top of the band: at G0 it is the full one
    assert float(still["deflection"]) == pytest.approx(sag, rel=0.02)
    assert float(still["strain"]) >= sag / layer.thickness * 0.98  # its tilt adds to it
    # what stands in for the measured rubber is stiffer at rest
    low, high = (0.05, 0.10) if motor.MEASURED.exists() else (0.02, 0.05)
    assert low < float(still["strain"]) < high
    motor_report.describe_layer(motor_report.State(variant, rest, loaded))
    printed = capsys.readouterr().out
    assert ("warning: above 5 %" in printed) == motor.MEASURED.exists()


def test_the_motors_rubber_carries_at_rest_what_the_master_curve_has_after_five_minutes() -> None:
    if not motor.MEASURED.exists():
        pytest.skip(f"{motor.MEASURED} is not here")
    material, _, master = motor.rubber()
    assert material.fit is not None
    near = np.abs(np.log(2 * np.pi * master.frequency * motor.RESTED)) < 0.5
    # of a power law ωⁿ, n = (2/π)·.105 by the loss factor there, G′(1/t)/G(t) is Γ(1 − n) cos(nπ/2) = 1.037;
    # the points scatter by 2 %
    n = 2 / math.pi * 0.105
    storage = np.exp(np.log(master.storage[near]).mean())
    expected = storage / (math.gamma(1 - n) * math.cos(n * math.pi / 2))
    assert material.G0 == pytest.approx(expected, rel=0.02)
    assert bd.equilibrium(
        motor.motor(motor.designs(material)[1], motor.RADIAL), after=motor.RESTED
    ).displacement("shaft.middle")[1] == pytest.approx(
        equilibrium(1, motor.RADIAL).displacement("shaft.middle")[1], rel=1e-6
    )


def test_both_bearings_share_the_axial_preload() -> None:
    eq = equilibrium(0)
    shares = [eq.bearings[side].g[2] for side in ("left", "right")]
    assert sum(shares) == pytest.approx(PRELOAD, rel=1e-9)  # statics, to Newton's tolerance
    assert min(shares) > 0.45 * PRELOAD


def steady_amplitude(signal: np.ndarray, per_period: int) -> complex:
    """Complex amplitude X of Re X e^{iωt}, ω = 2π/(per_period·dt), of a whole number of periods."""
    n = np.arange(1, signal.size + 1)
    return complex(2 * np.mean(signal * np.exp(-2j * np.pi * n / per_period)))


@pytest.mark.parametrize("per_period", [800, 200])
def test_the_march_is_its_own_transfer_function_and_the_harmonic_response(per_period: int) -> None:
    dt = motor.STEP
    frequency = 1 / (per_period * dt)
    app = motor.motor(motor.designs(rubber())[2])
    app.load("shaft.middle", (0, 1, 0, 0, 0, 0), frequency=frequency)
    system = bd.equilibrium(app).linearised()
    outputs = [*motor.OUTPUTS]
    slowest = bd.modes(system, damped=True)["eigenvalue"].values.real.max()
    settle = int(np.ceil(np.log(1e11) / -slowest / dt / per_period)) * per_period  # what is left: 1e-11
    run = bd.transient(system, speed=0.0, dt=dt, steps=4 * per_period, settle=settle, record=outputs)
    marched = np.array(
        [steady_amplitude(run["record"].values[:, k], per_period) for k in range(len(outputs))]
    )
    force = system.row(motor.INPUT)
    scheme = np.array([discrete_response(system, system.row(o), force, dt, per_period) for o in outputs])
    assert np.linalg.norm(marched - scheme) < 1e-8 * np.linalg.norm(scheme)
    # and the continuous response where (ωΔt)²/12 is below 1e-4: 1 % as the issue asks
    continuous = bd.frequency_response(system, [frequency], [motor.INPUT], outputs)["response"].values[
        0, :, 0
    ]
    assert np.linalg.norm(marched - continuous) < 0.01 * np.linalg.norm(continuous)


def test_energy_of_the_running_motor_is_accounted_for() -> None:
    eq = equilibrium(2, motor.RADIAL)
    arguments = {"speed": motor.SPEED, "dt": motor.STEP, "record": [], "audit": True}
    before = bd.transient(eq, steps=0, **arguments).attrs
    after = bd.transient(eq, steps=20_000, **arguments).attrs
    change = sum(after[f"energy_{e}"] - before[f"energy_{e}"] for e in ENERGIES)
    fed = after["energy_load"] + after["energy_turning"]
    lost = sum(after[f"energy_{e}"] for e in ("linear", "branch", "contact"))
    assert lost > 0.0
    # the bound; powers are summed by the trapezoidal rule, second order in dt
    assert abs(fed - lost - change) < 1e-4 * after["energy_throughput"]


def test_the_motor_converges_with_second_order_while_no_contact_is_lost() -> None:
    """Started from rest by a smooth force, at no speed, under axial preload: every ball stays loaded."""
    app = motor.motor(motor.designs(rubber())[2])
    t = np.linspace(0.0, 4e-3, 4001)
    app.load("shaft.middle", (0, 40, 0, 0, 0, 0), time=t, value=np.sin(np.pi * t / 4e-3) ** 4)
    eq = bd.equilibrium(app)
    ends = []
    for dt in (8e-6, 4e-6, 2e-6, 1e-6):
        run = bd.transient(
            eq,
            speed=0.0,
            dt=dt,
            steps=round(3.2e-3 / dt),
            record=["shaft.middle.y", "shaft.end.y", "left.loaded", "right.loaded"],
            scheme=core.Scheme(tolerance=1e-13),
        )
        assert (run["record"].values[:, 2:] == 7).all()
        ends.append(run["record"].values[-1, :2])
    steps = [np.linalg.norm(a - b) for a, b in pairwise(ends)]
    orders = np.log2(np.array(steps[:-1]) / steps[1:])
    assert orders[-1] > 1.9  # the figure


AUDIBLE = motor.AUDIBLE[::4]  # a step of 4 Hz; the sharpest resonance there is 2ζf = 7 Hz wide


@pytest.mark.parametrize("design", [1, 2, 3])
def test_the_layers_make_the_housings_radiate_less_over_1_to_5_khz(design: int) -> None:
    """All the outside of both pedestals, for one point is not enough, as the paper says."""
    bare, layered = (motor.radiated(equilibrium(k), AUDIBLE) for k in (0, design))
    power = 10 * np.log10(layered.mean() / bare.mean())
    curve = float((10 * np.log10(layered / bare)).mean())
    print(f"equivalent radiated power: {power:.1f} dB, mean of the curve {curve:.1f} dB")
    assert power < -10.0  # the aim
    # averaged in dB the stiffer, thin layer misses it: between resonances it isolates less
    assert curve < (-10.0 if design < 3 else -6.0)


def test_radiated_power_is_that_of_the_pedestals_faces() -> None:
    """½ρc∫|v_n|²dA over top, front and back is part of that of the outside, which adds the two sides.

    At 700 Hz the pedestals rock on their feet as cantilevers do: the mean square over a face is a quarter of
    the square of the tip's, exactly so for Euler's beam in its first mode; in shear alone, a third.
    """
    eq = equilibrium(0)
    faces = [f"left_housing.{face}" for face in ("top", "front", "back", "outside")]
    found = bd.radiated_power(eq, [700.0, 2100.0], [motor.INPUT], faces)
    top, front, back, outside = found["power"].values[:, :, 0].T
    assert (top + front + back < outside).all()
    tip = bd.frequency_response(eq, [700.0], [motor.INPUT], ["left_housing.top.z"], quantity="velocity")
    square = abs(complex(tip["response"].values[0, 0, 0])) ** 2
    part = paper_pedestal(2 * motor.RING[1])
    face = part.width * part.height - np.pi * part.bore_diameter**2 / 4
    for power in (front, back):
        assert 0.25 < power[0] / (0.5 * 1.204 * 343.2 * face * square) < 1 / 3  # ρ and c of air at 20 °C
    edges = (part.width + 2 * part.height) * part.length
    area = found["area"].values
    # the bore is a polygon of quadratic sides; 1e-3 is far above what that takes off
    assert area == pytest.approx([part.width * part.length, face, face, 2 * face + edges], rel=1e-3)


@pytest.mark.parametrize("design", [0, 2])
def test_shares_of_energy_and_loss_sum_to_one(design: int) -> None:
    found = motor.bending(equilibrium(design))
    for kind in ("kinetic", "strain", "dissipation"):
        # sums of some ten shares, to round-off
        assert found.shares[kind].values.sum(axis=1) == pytest.approx(1.0, abs=1e-12)
    # the loss and the eigenvalue give the damping ratio each on its own. Round-off of the eigenvalue, some
    # 1e-16 of the largest (1e6 rad/s), is 1e-10 of the smallest real part (4 1/s)
    damping = found.shares["damping"].values.sum(axis=1)
    assert damping == pytest.approx(found.modes["damping_ratio"].values, rel=1e-6)


def test_softer_layers_take_more_of_the_strain_energy_of_the_first_bending_mode() -> None:
    shares = [float(motor.bending(equilibrium(k)).of("strain", "layer")[0]) for k in (0, 3, 1, 2)]
    print([f"{100 * s:.0f} %" for s in shares])
    assert shares[0] == 0.0
    # the thin layer has least; of the thick ones that of high loss is softer below 1 kHz
    assert shares == sorted(shares)
    assert shares[1] > 0.2


@pytest.mark.parametrize("design", [2, 3])
def test_frequencies_rise_with_the_rubbers_modulus_by_half_its_share_of_the_strain_energy(
    design: int,
) -> None:
    """Rayleigh: d ln ω = ½ Σ U_i d ln k_i of an undamped mode, to the first order; here by ±1 % of G."""
    variant = motor.designs(rubber())[design]
    assert variant.rubber is not None
    size = abs(complex(variant.rubber.complex_modulus(motor.ONE_KHZ)))
    frequency = []
    for factor in (0.99, 1.01):
        scaled = replace(variant, rubber=variant.rubber.with_modulus(factor * size, motor.ONE_KHZ))
        found = motor.bending(bd.equilibrium(motor.motor(scaled)), damped=False)
        frequency.append(found.modes["frequency"].values)
    slope = np.log(frequency[1] / frequency[0]) / np.log(1.01 / 0.99)
    share = motor.bending(equilibrium(design), damped=False).of("strain", "(shear)")
    print(2 * slope / share - 1)
    # central differences leave (0.01)² of second order; the two bearings share the preload a little otherwise
    assert 2 * slope == pytest.approx(share, rel=5e-4)


@pytest.mark.parametrize("design", [1, 2, 3])
def test_layers_damp_a_mode_by_their_loss_factor_times_their_share_of_the_strain_energy(design: int) -> None:
    """Ungar and Kerwin (1962): η = Σ U_i η_i / Σ U_i = 2ζ; the rubber's η is tan δ(ω)."""
    material = motor.designs(rubber())[design].rubber
    assert material is not None
    found = motor.bending(equilibrium(design))
    loss = np.asarray(material.loss_factor(2 * np.pi * found.modes["frequency"].values))
    expected = 0.5 * loss * found.of("strain", "(shear)")
    damping = found.of("damping", "(shear)")
    print(expected / damping - 1)
    # the formula takes G* at iω instead of at λ = (i − ζ)ω: an error of the order of ζ
    assert (np.abs(expected / damping - 1) < found.modes["damping_ratio"].values).all()


@cache
def short_run() -> xarray.Dataset:
    return motor.run(equilibrium(2, motor.RADIAL), settle=10_000, steps=26_000)  # two turns of the cage


@pytest.mark.parametrize("side", ["left", "right"])
def test_contact_statistics_tell_of_the_loaded_balls_what_the_march_counts(side: str) -> None:
    result = short_run()
    counted = result["record"].sel(channel=f"{side}.loaded").values.astype(int)
    found = bd.contact_statistics(result, side)
    share = np.bincount(counted, minlength=8) / counted.size
    assert found["loaded"].values == pytest.approx(share, abs=1e-12)  # two counts of the same samples
    assert (1 - found["free"].values).sum() == pytest.approx(counted.mean(), rel=1e-12)
    # in two turns of the cage every ball leaves the loaded zone twice, and is loaded as long as any other
    turn = 2 * np.pi / (plain_6305().cage_ratio * motor.SPEED)
    assert 2 * turn == pytest.approx(26_000 * motor.STEP, rel=0.01)
    assert (found["losses"].values >= 2).all()
    # the record ends within 1 % of two turns
    assert np.ptp(found["free"].values) < 0.01
    # statics: the balls carry the radial load against their directions, so more than it together
    both = sum(bd.contact_statistics(result, s)["mean"].values.sum() for s in ("left", "right"))
    assert both > motor.RADIAL


@cache
def in_motion(design: int, rpm: float = 5000.0) -> xarray.Dataset:
    return bd.steady_state(
        equilibrium(design, motor.RADIAL),
        rpm=rpm,
        record=motor.VELOCITIES,
        harmonics=motor.HARMONICS,
    )


def marched_on(design: int, motion: xarray.Dataset, passages: int, per: int) -> np.ndarray:
    """Velocities (passage, sample, channel) of a march that begins in a steady motion."""
    run = bd.transient(
        equilibrium(design, motor.RADIAL),
        speed=motion.attrs["speed"],
        dt=1 / float(motion["base_frequency"].values[0]) / per,
        steps=passages * per,
        record=motor.VELOCITIES,
        method="exact",
        initial=motion,
    )
    return np.asarray(run["record"].values.reshape(passages, per, -1))


@pytest.mark.parametrize("design", [0, 2])
def test_a_march_stays_in_the_steady_motion_and_its_first_20_lines_are_the_balances(design: int) -> None:
    motion, per = in_motion(design), 2048
    assert motion.attrs["stable"] == 1
    run = marched_on(design, motion, 100, per)
    first, last = run[0], run[-1]
    # from its first step on: x, v and what the branches bear are all where the motion has them
    turns = np.exp(2j * np.pi / per * np.outer(np.arange(1, per + 1), np.arange(motor.HARMONICS + 1)))
    own = (turns @ motion["amplitude"].values).real
    missed = np.sqrt(((first - own) ** 2).mean(axis=0)) / own.std(axis=0)
    print(missed)
    # harmonics above the sixtieth, and the jump where a damper closes: most in the housing's small y
    assert (missed < [1e-2, 5e-2, 1e-3]).all()
    lines = np.abs(np.fft.rfft(last, axis=0))[1:21] * (2 / per)
    wanted = np.abs(motion["amplitude"].values[1:21])
    off = np.abs(lines - wanted)
    # the bound, of the largest line; and of each that is no smaller than a twentieth of it
    print(off.max(axis=0) / wanted.max(axis=0), (off / wanted).max(axis=0))
    assert (off <= 1e-3 * wanted.max(axis=0)).all()
    big = wanted >= 0.05 * wanted.max(axis=0)
    assert (off[big] <= 1e-3 * wanted[big]).all()


def test_an_unstable_steady_motion_is_left_at_the_rate_found() -> None:
    """At 12 000 rpm the bare motor's passages begin to alternate: a flip, by 1.5 % a passage."""
    motion = in_motion(0, 12_000.0)
    assert motion.attrs["stable"] == 0
    assert motion.attrs["loss"] == "flip"
    z = marched_on(0, motion, 600, 256)[:, :, 2]
    away = np.abs(np.diff(z, axis=0)).max(axis=1) / np.ptp(z[0])
    # what the first steps leave dies away before
    later = np.arange(len(away)) > np.argmin(away)
    inside = np.flatnonzero(later & (away > 1e-5) & (away < 1e-2))
    assert len(inside) >= 200
    rate = np.polyfit(inside, np.log(away[inside]), 1)[0]
    assert rate == pytest.approx(math.log(motion.attrs["multiplier"]), rel=0.05)  # the bound


def test_a_march_cannot_begin_in_the_motion_of_another_speed_or_machine() -> None:
    motion = in_motion(0)
    arguments = {"dt": 1e-5, "steps": 1, "record": [], "initial": motion}
    with pytest.raises(
        ValueError, match=r"speed is 500\.0; initial is a steady motion at 523\.59877\d+ rad/s"
    ):
        bd.transient(equilibrium(0, motor.RADIAL), speed=500.0, **arguments)
    with pytest.raises(ValueError, match=r"initial, by its inputs_hash.*another application"):
        bd.transient(equilibrium(2, motor.RADIAL), speed=motor.SPEED, **arguments)


def test_heat_of_the_parts_is_what_the_audit_of_the_march_says_is_lost() -> None:
    eq = equilibrium(2, motor.RADIAL)
    arguments = {"speed": motor.SPEED, "dt": motor.STEP, "steps": 8000}
    heat = bd.dissipation(eq, **arguments)["energy"]
    audit = bd.transient(eq, record=[], audit=True, **arguments).attrs
    # the rubber's dashpot heats the layer; the audit counts it with the linear damping
    of = {
        ("contact",): heat.sel(part=["left", "right"]),
        ("branch", "linear"): heat.drop_sel(part=["left", "right"]),
    }
    for kinds, parts in of.items():
        # both by the trapezoidal rule; the audit also counts the step from the start
        lost = sum(audit[f"energy_{kind}"] for kind in kinds)
        assert float(parts.sum()) == pytest.approx(lost, rel=1e-3), kinds
    assert sum(p.size for p in of.values()) == heat.size
