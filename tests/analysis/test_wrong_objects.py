"""Every analysis given what it cannot use refuses it by the argument's name, before long work."""

from __future__ import annotations

import inspect
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import analysis
from bearingdyn.bearing import Pair

BALL = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, contact_angle=0.3)


def held() -> bd.Application:
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("r.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    app.load("r.centre", (0, -10.0, 0, 0, 0, 0))
    return app


APP = held()
STATE = bd.equilibrium(APP)
MODES = bd.modes(STATE)
RUN = bd.transient(STATE, speed=10.0, dt=1e-5, steps=64, record=["r.centre.x", "r.centre.y"])
BORNE = bd.Application()
BORNE.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
BORNE.add("g", bd.RigidBody(4.0, (0.02, 0.02, 0.004)))
BORNE.ground("g.centre", stiffness=[1e6] * 6)
BORNE.bearing("b", BALL, inner="r.centre", outer="g.centre")
BORNE.load("r.centre", (0, 0, 200.0, 0, 0, 0))
SHEET = bd.bearing_sheet(bd.equilibrium(BORNE))
TABLE = bd.stiffness_table(BALL, [[0, 0, 200.0, 0, 0, 0]])
OIL = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32))
RESPONSE = bd.frequency_response(STATE, [10.0], ["r.centre.y"], ["r.centre.y"])
PLATE = bd.Application()
PLATE.add("plate", bd.Housing(0.1, 0.1, 0.03, 0.04, f_max=0.0).superelement())
PLATE.ground("plate.feet")
PLATE.free("plate.bore")
PLATED = analysis.linear(PLATE).system
WRONG = [
    Pair(BALL, "DB", distance=0.015), 5, "6205", None, [], {}, RUN, RESPONSE, STATE, MODES, APP, np.zeros(3),
    object(), 1.5, True, BALL,
]  # fmt: skip
GOOD = {
    "app": APP, "eq": STATE, "source": STATE, "result": RUN, "found": MODES, "speed": 10.0,
    "frequency": [10.0, 20.0], "frequencies": [10.0, 20.0], "inputs": ["r.centre.y"],
    "outputs": ["r.centre.y"], "dt": 1e-5, "steps": 8,
    "record": ["r.centre.y"], "speeds": [0.0, 10.0], "channel": "r.centre.y", "bearing": "b", "mode": 0,
    "x": "r.centre.x", "y": "r.centre.y", "length": 2e-4, "band": (1e3, 2e4), "highest": 5.0, "orders": [1.0],
    "surfaces": ["r.all"], "cases": [], "table": TABLE, "path": "table.csv", "oil": OIL,
    "sheet": SHEET, "loads": [[0, 0, 200.0, 0, 0, 0]],
    "make": lambda value: held(), "values": (1.0, 2.0),
}  # fmt: skip
# what the sound room takes from this one: arguments of their own under names of others
OWN = {
    "part_velocities": {
        "state": analysis.linear(STATE), "parts": STATE.system.parts, "frequency": np.array([10.0]),
        "inputs": [analysis.Input.of(STATE.system, "r.centre.y")],
    },
    "surface_of": {"system": PLATED, "name": "plate.outside"},
    "band_of": {"draws": np.arange(40.0)[:, None], "coverage": 0.9},
    "gradient": {"parameters": ["r.mass"]},
}  # fmt: skip
# what takes the insides of a gradient, which the sound room hands on
INNER = {"power_slopes", "power_table"}
ANALYSES = [
    name for name in analysis.__all__ if inspect.isfunction(getattr(analysis, name)) and name not in INNER
]


@pytest.mark.parametrize("name", ANALYSES)
def test_a_wrong_object_is_refused_by_name(name, tmp_path, monkeypatch):
    """Or taken, where it means something: no AttributeError, KeyError and their like from within."""
    monkeypatch.chdir(tmp_path)  # "6205" is a file's name too
    call = getattr(analysis, name)
    parameters = inspect.signature(call).parameters
    good = GOOD | OWN.get(name, {})
    needed = {key: good[key] for key, p in parameters.items() if p.default is p.empty and key in good}
    lacking = [key for key, p in parameters.items() if p.default is p.empty and key not in good]
    assert lacking == [], "an argument that this test has no good value for"
    if name in OWN:
        call(**needed)
    for key in parameters:
        for wrong in WRONG:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    call(**{**needed, key: wrong})
                except (ValueError, ArithmeticError, bd.SolverError, OSError):
                    pass
                except TypeError as error:  # progress=, whose message is its own
                    assert str(error).startswith(f"{key} is "), (key, wrong, error)  # noqa: PT017


def test_transients_tell_of_the_marches_that_are_done():
    told = []
    case = {"source": STATE, "speed": 0.0, "dt": 1e-5, "steps": 5, "record": []}
    bd.transients([case] * 3, threads=2, progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]
    with pytest.raises(ValueError, match=r"cases\[1\] is 5; it must be a list of mappings"):
        bd.transients([case, 5])
    with pytest.raises(
        ValueError, match=r"cases\[1\] is 'step'; it is no argument of transient; did you mean"
    ):
        bd.transients([case, {**case, "step": 5}])
    with pytest.raises(ValueError, match=r"cases\[0\] is .*; it lacks dt"):
        bd.transients([{"source": STATE, "steps": 5, "record": []}])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"harmonics": 10**9}, r"harmonics is 1000000000; it must be a whole number in 1\.\.\.2000"),
        ({"harmonics": 2000, "subharmonic": 64}, r"harmonics times subharmonic is 128000; .* GB; give fewer"),
        ({"tolerance": 0.5}, r"tolerance is 0\.5; .* at most 1e-3"),
        ({"record": []}, r"record is \[\]; it must be a list of channels, of at least 1"),
    ],
)
def test_a_steady_motion_that_no_memory_holds_is_refused(given, message):
    pair = bd.Application()
    pair.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    pair.add("g", bd.RigidBody(4.0, (0.02, 0.02, 0.004)))
    pair.ground("g.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    pair.bearing("b", bd.catalogue.bearing("6205", clearance=1e-5), inner="r.centre", outer="g.centre")
    pair.load("r.centre", (0, -200.0, 50.0, 0, 0, 0))
    with pytest.raises(ValueError, match=message):
        bd.steady_state(pair, **{"speed": 100.0, "record": ["r.centre.y"], **given})


@pytest.mark.parametrize("name", ["filter", "audit", "check_step", "check_unique"])
@pytest.mark.parametrize("wrong", ["yes", None, 2, []])
def test_a_truth_of_a_march_is_true_or_false(name, wrong):
    with pytest.raises(ValueError, match=f"{name} is .*; it must be True or False"):
        bd.transient(APP, speed=100.0, dt=1e-5, steps=3, record=["r.centre.y"], **{name: wrong})
