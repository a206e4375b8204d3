"""A march knows the largest load of every ball from each of its steps, recorded or not."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import run_file
from bearingdyn.analysis import ball_channels, overload
from bearingdyn.analysis.march import March
from bearingdyn.analysis.march_pieces import pieces
from bearingdyn.notice import BearingWarning

BALLS = {"Z": 9, "Dw": 7.94e-3, "Dpw": 39.04e-3, "fi": 0.52, "fo": 0.53, "clearance": 10e-6}
STEPS = 2000


def rotor(blow: float) -> bd.Application:
    """A rotor on two bearings, with a blow of 0.2 ms that is over when the march ends."""
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    for name, offset in (("a", 5e-6), ("b", -5e-6)):
        app.bearing(
            name, bd.BallBearing(**BALLS, damping=500.0), inner="r.centre", outer="ground", offset=offset
        )
    app.gravity((0, -9.81, 0))
    app.load("r.centre", (0, -1.0, 0, 0, 0, 0), time=[0, 1e-3, 1.1e-3, 1.2e-3, 1.0], value=[0, 0, blow, 0, 0])
    return app


def march(app: bd.Application, **options):
    given = {"speed": 100.0, "dt": 5e-6, "steps": STEPS, "record": ["r.centre.y"]}
    return bd.transient(app, **{**given, **options})


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarseStep")
@pytest.mark.parametrize("options", [{}, {"decimate": 500}, {"settle": STEPS, "steps": 1}, {"record": []}])
def test_a_blow_between_two_samples_is_warned_of(options):
    """Neither recorded nor in the last state: known from the steps alone."""
    with pytest.warns(BearingWarning, match="bearing 'a': a ball bore .* in this march") as told:
        march(rotor(1.5e5), **options)
    assert {str(w.message)[8:11] for w in told if w.category is BearingWarning} == {"'a'", "'b'"}


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarseStep")
def test_an_ordinary_blow_is_not():
    with warnings.catch_warnings():
        warnings.simplefilter("error", BearingWarning)
        march(rotor(2e3))


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarseStep")
@pytest.mark.parametrize("isa", ["base", "avx2", "avx512", "best"])
def test_the_peaks_are_the_largest_of_every_recorded_step(isa):
    """To the bit but for one rounding: the running maximum adds what is above it."""
    try:
        scheme = bd.Scheme(isa=isa)
        prepared = March.of(rotor(2e3), speed=100.0, dt=5e-6, steps=STEPS, scheme=scheme)
    except ValueError:
        pytest.skip(f"this machine has no {isa}")
    eq = bd.equilibrium(rotor(2e3))
    channels = [*ball_channels(eq, "a"), *ball_channels(eq, "b")]
    rows = march(eq, record=channels, scheme=scheme)["record"].values
    model = prepared.modal.model([])
    *_, (_, _, report) = pieces(prepared, model, prepared.start(model), start=True)
    np.testing.assert_allclose(report.peaks, [rows[:, :9].max(), rows[:, 9:].max()], rtol=1e-15)


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarseStep")
def test_a_stream_keeps_the_peaks_of_the_chunks_before(tmp_path, monkeypatch):
    """Cut after the blow and gone on with, the march warns of what came before the cut."""
    monkeypatch.setattr("bearingdyn.analysis.march_pieces.CHUNK_STEPS", 500)
    path = tmp_path / "run.bdrun"
    with pytest.warns(BearingWarning, match="a ball bore"):
        march(rotor(1.5e5), stream=path)
    chunks = run_file.read(path)[1]
    assert len(chunks) == STEPS // 500
    assert chunks[0].report.peaks[0] > 3 * chunks[-1].report.peaks[0]
    with pytest.warns(BearingWarning, match="bearing 'a': a ball bore"):
        march(rotor(1.5e5), stream=path)


def _swinging(bearing: bd.BallBearing):
    """An equilibrium on two such bearings, and random swings of every size of both, as coefficients."""
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    for name, offset in (("a", 5e-6), ("b", -5e-6)):
        app.bearing(name, bearing, inner="r.centre", outer="ground", offset=offset)
    app.gravity((0, -9.81, 0))
    eq = bd.equilibrium(app)
    rng = np.random.default_rng(14)
    size = np.geomspace(1e-7, 3e-5, 300)[:, None] * np.array([1, 1, 1, 20, 20, 0])  # m, and rad on some 20 mm
    q = [size * (rng.normal(size=size.shape) + 1j * rng.normal(size=size.shape)) for _ in "ab"]
    across = [t.bearing.coefficients() for t in eq.system.bearings]
    return eq, q, np.hstack([m @ c.T for m, c in zip(q, across, strict=True)])


@pytest.mark.parametrize(
    "bearing",
    [
        bd.BallBearing(**BALLS, damping=500.0),
        bd.BallBearing(
            **BALLS,
            damping=500.0,
            waviness=[bd.Waviness("inner", 9, 4e-6), bd.Waviness("outer", 5, 3e-6, 0.4)],
        ),
    ],
    ids=["smooth", "wavy"],
)
def test_the_heaviest_ball_of_all_swings_is_found_without_a_look_at_each(bearing):
    """Against the loads of every ball at every moment of every swing; with each limit among them."""
    eq, q, swings = _swinging(bearing)
    turns = np.exp(2j * np.pi * np.arange(overload.SAMPLES) / overload.SAMPLES)
    for first, own, term in zip((0, 5), q, eq.system.bearings, strict=True):
        rest = np.linalg.lstsq(term.bearing.coefficients(), eq.bearings[term.name].z, rcond=None)[0]
        rest[2] += term.offset
        peaks = np.array(
            [max(term.bearing.ball_loads(rest + (m * t).real).max() for t in turns) for m in own[::3]]
        )
        some = swings[::3, first : first + 5]
        for limit in (0.0, *np.quantile(peaks, [0.1, 0.5, 0.9, 0.999]), 2 * peaks.max()):
            peak, worst = overload._worst(term.kernel(), float(limit), eq.bearings[term.name].z, some)
            if peaks.max() > limit:
                # q through the coefficients and back costs digits of a micrometre among millimetres
                assert (peak, worst) == (pytest.approx(peaks.max(), rel=1e-9), int(peaks.argmax()))
            else:
                assert peak <= limit


def test_swings_that_stay_below_the_limit_are_not_looked_at(monkeypatch):
    """The rest alone is computed: the raceways do not move far enough for any ball."""
    eq, _, swings = _swinging(bd.BallBearing(**BALLS, damping=500.0))
    seen = []
    along = overload.core.bearing_along

    def counted(kernel, z, *rest, **options):
        seen.append(len(z))
        return along(kernel, z, *rest, **options)

    monkeypatch.setattr(overload.core, "bearing_along", counted)
    overload.warn_of_swings(eq, swings[:100], lambda k: "here")
    assert seen == [1, 1]


def test_a_response_of_a_given_amplitude_knows_the_balls_that_it_overloads():
    """2 kN zero-to-peak on a 6205 in a soft layer at its resonance; a fifth of a newton is nothing."""
    law = bd.Payne(D=2e6, gamma_c=4e-3, m=0.5, Lm=1e5, gamma_l=3e-3)
    rubber = bd.Maxwell(2e6, [2e6], [1e-3], K=2e9, density=1100.0).with_payne(law)
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("layer", bd.Layer(0.026, 0.032, 0.015, rubber))
    app.ground("layer.outer")
    app.ground("r.centre", stiffness=(0, 0, 1e6, 1e4, 1e4, 0), damping=(0, 0, 10, 1, 1, 0))
    app.bearing(
        "b", bd.BallBearing(**BALLS, damping=500.0), inner="r.centre", outer="layer.inner", fits=False
    )
    app.gravity((0, -9.81, 0))
    eq = bd.equilibrium(app)
    places = [50.0], ["r.centre.y"], ["r.centre.y"]
    with pytest.warns(BearingWarning, match=r"bearing 'b': a ball bore .* over 4\.2 GPa"):
        bd.frequency_response(eq, *places, amplitude=50e3)
    with warnings.catch_warnings():
        warnings.simplefilter("error", BearingWarning)
        bd.frequency_response(eq, *places, amplitude=0.2)
