"""Steady motions, maps and responses say what a march says: overload, an open side, nothing that pushes."""

from __future__ import annotations

import gc
import math
import warnings
import weakref
from threading import Thread

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.analysis.steady.borne import warn_of_motions
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.bearing import samples_off
from bearingdyn.bearing.open_side import runs_off
from bearingdyn.notice import BearingWarning, NothingPushes, OpenSideWarning, OutsideBand, untold, warn

MAP = {"several": False, "doublings": 0, "harmonics": 8, "points": 6, "progress": False}
Y = ["rotor.centre.y"]


def rotor(clearance: float = 1e-5, load: float = 0.0, unbalance: float = 0.0) -> bd.Application:
    """A rotor of 4 kg in one 6205, held in tilt and along its axis."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("rotor.centre", stiffness=(0, 0, 1e6, 1e3, 1e3, 0), damping=(100, 100, 100, 1, 1, 0))
    ball = bd.catalogue.bearing("6205", clearance=clearance, damping=200.0)
    app.bearing("b", ball, inner="rotor.centre", outer="ground")
    if load:
        app.load("rotor.centre", (0, -load, 0, 0, 0, 0))
    if unbalance:
        app.unbalance("rotor.centre", unbalance)
    return app


def test_a_steady_motion_that_nothing_pushes_says_so():
    """In clearance, without a load; with its weight it moves, and nothing is said."""
    with pytest.warns(NothingPushes, match="nothing pushes in the steady motion at 300 rad/s"):
        still = bd.steady_state(rotor(), speed=300.0, record=Y, harmonics=8)
    assert not still["amplitude"].values.any()
    with warnings.catch_warnings():
        warnings.simplefilter("error", NothingPushes)
        moved = bd.steady_state(rotor(load=40.0), speed=300.0, record=Y, harmonics=8)
    assert moved["amplitude"].values.any()


def test_a_map_that_nothing_pushes_is_refused():
    with pytest.raises(ValueError, match="nothing pushes at 250, an end of the range"):
        bd.speed_map(rotor(), speeds=(250.0, 300.0), record=Y, **MAP)
    with pytest.raises(ValueError, match="nothing pushes at 1e-05"):
        bd.parameter_map(rotor, values=(1e-5, 1.2e-5), speed=300.0, record=Y, **MAP)


def test_a_map_warns_of_the_heaviest_ball_of_all_its_motions():
    """9 kN on a static rating of 7.9 kN; at rest the equilibrium says it, along the map the map."""
    with pytest.warns(BearingWarning) as told:
        bd.speed_map(rotor(0.0, 9e3), speeds=(250.0, 300.0), record=Y, **MAP)
    assert sum("a ball bore" in str(w.message) and " at " in str(w.message) for w in told) == 1


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.UnusualMagnitude")
def test_an_unbalance_that_overloads_is_warned_of_in_every_analysis():
    """400 N at rest are 1.9 GPa; mu Ω² = 12 kN at 1000 rad/s is beyond the static rating of 7.9 kN."""
    app = rotor(0.0, 400.0, 12e-3)
    state = bd.equilibrium(app)
    words = "bearing 'b': a ball bore .* over 4.2 GPa"
    with pytest.warns(BearingWarning, match=f"{words}"):
        steady = bd.steady_state(state, speed=1000.0, record=["b.ball1"], harmonics=3, stability=False)
    assert steady["record"].values.max() > 4000.0
    with pytest.warns(BearingWarning, match="in the response at 1000 rad/s"):
        bd.unbalance_response(state, [100.0, 1000.0], Y)
    with warnings.catch_warnings():
        warnings.simplefilter("error", BearingWarning)
        bd.unbalance_response(state, [100.0, 150.0], Y)
        bd.steady_state(state, speed=100.0, record=Y, harmonics=3, stability=False)


def test_the_balls_of_a_linear_response_bear_what_a_slow_turn_of_the_rings_gives():
    """Quasi-static, no clearance: under the load F the heaviest of Z balls bears about 4.4 F/Z (Stribeck)."""
    app = rotor(0.0, 400.0, 12e-3)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        bd.unbalance_response(bd.equilibrium(app), [900.0], Y)
    said = next(str(w.message) for w in told if w.category is BearingWarning)
    borne = float(said.split("bore ")[1].split(" N")[0])
    force = 400.0 + 12e-3 * 900.0**2
    # a linear spring of the 400 N state is softer than Hertz at ten times the load, so the ring moves further
    assert 4.4 * force / 9 < borne < 12 * force


def test_a_steady_motion_onto_the_open_side_is_warned_of():
    """A motion along the axis that takes the ring 0.5 mm off the shoulder and back, and one that does not."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(0.5, (1e-3, 1e-3, 1e-3), rotating=True))
    ball = bd.catalogue.bearing("7205", damping=100.0)
    app.bearing("front", ball, inner="rotor.centre", outer="ground")
    app.ground("rotor.centre", stiffness=[1e4, 1e4, 0, 100, 100, 0], damping=[50] * 3 + [0.1] * 3)
    app.load("rotor.centre", (0, -20.0, 200.0, 0, 0, 0))
    options = {"speed": 100.0, "record": ["rotor.centre.z"], "harmonics": 6, "stability": False}
    with warnings.catch_warnings():
        warnings.simplefilter("error", OpenSideWarning)
        bd.steady_state(app, **options)
    problem = Problem.of(app)
    lines = Lines.harmonics(3)
    z = problem.standing(lines)
    kernel = problem.system.bearings[0].kernel()
    (axial,) = np.flatnonzero((kernel.axial == 1) & (kernel.order == 0))
    z[1, axial] = -0.5e-3
    with pytest.warns(OpenSideWarning, match="bearing 'front': at 100 rad/s, for 0.* of the time"):
        warn_of_motions([(problem.balance(lines, 100.0), z, "at 100 rad/s", None)])


def test_only_lines_that_move_a_layer_are_told_of_outside_its_band():
    """Unbalance moves the layer at the speed alone; forty harmonics of it are tried, and are nothing."""
    rubber = bd.Maxwell(1e6, [2e6], [1e-3], K=2e9, density=1100.0, temperature=20.0, band=(100.0, 1e3))
    app = bd.Application()
    app.add("mass", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.add("layer", bd.Layer(0.02, 0.025, 0.01, rubber, refinement=0.5))
    app.connect("mass.centre", "layer.inner")
    app.ground("layer.outer")
    app.unbalance("mass.centre", 1e-6)
    asked = {"record": ["mass.centre.y"], "harmonics": 40}
    with warnings.catch_warnings():
        warnings.simplefilter("error", OutsideBand)
        bd.steady_state(app, speed=2 * math.pi * 200.0, **asked)
    with pytest.warns(OutsideBand, match="'layer' moves at 50 to 50 Hz in this motion, 1 lines outside"):
        bd.steady_state(app, speed=2 * math.pi * 50.0, **asked)


def test_many_samples_are_judged_as_one_by_one():
    kernel = bd.catalogue.bearing("7205").kernel()
    rng = np.random.default_rng(5)
    z = rng.normal(0.0, 2e-4, (200, 5)) * [1, 1, 1, 0.02, 0.02]
    loads = np.maximum(rng.normal(0.0, 50.0, (200, kernel.Z)), 0.0)
    loads[:3] = 0.0
    turn = rng.uniform(0.0, 2 * math.pi, 200)
    each = [runs_off(kernel, a, b, t) is not None for a, b, t in zip(z, loads, turn, strict=True)]
    assert 0 < sum(each) < 197
    assert samples_off(kernel, z, loads, turn).tolist() == each


def test_a_notice_held_back_in_one_thread_is_issued_in_another() -> None:
    """The filters of `warnings` are all threads' own; what a search holds back is its thread's alone."""

    def elsewhere() -> None:
        warn("asked beyond the band", OutsideBand)

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with untold(OutsideBand):
            before = warnings.filters[:]
            warn("asked beyond the band", OutsideBand)
            with untold(NothingPushes):
                warn("asked beyond the band", OutsideBand)
            assert not caught
            warn("nothing pushes", NothingPushes)
            other = Thread(target=elsewhere)
            other.start()
            other.join()
            assert warnings.filters == before
        warn("asked beyond the band", OutsideBand)
    assert [w.category for w in caught] == [NothingPushes, OutsideBand, OutsideBand]


def test_what_steady_motions_keep_of_a_system_goes_with_it() -> None:
    eq = bd.equilibrium(rotor(load=100.0))
    bd.steady_state(eq, speed=300.0, record=Y, harmonics=8, stability=False)
    system = weakref.ref(eq.system)
    del eq
    gc.collect()
    assert system() is None


def test_a_motion_that_turns_backwards_mirrors_the_one_that_turns_forwards() -> None:
    """Its lines have negative frequencies; the rotor and its load are symmetrical to the plane of x = 0."""
    eq = bd.equilibrium(rotor(load=100.0))
    asked = {"record": ["rotor.centre.x", "rotor.centre.y"], "harmonics": 8, "stability": False}
    forwards, backwards = (bd.steady_state(eq, speed=s, **asked)["amplitude"].values for s in (300.0, -300.0))
    size = np.abs(forwards[1:]).max()
    # a line at -omega is the conjugate of one at omega
    for axis in range(2):
        np.testing.assert_allclose(
            np.abs(backwards[:, axis]), np.abs(forwards[:, axis]), rtol=0, atol=1e-9 * size
        )
