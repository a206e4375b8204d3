"""A step too coarse for what drives the march: said beforehand by name, and estimated afterwards."""

from __future__ import annotations

import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.analysis.driving_periods import rhythms
from bearingdyn.bearing.imperfections import Pit, Waviness
from bearingdyn.notice import CoarseStep
from rotors import oscillator

SPEED = 500.0  # rad/s


def driven(**flaws: object) -> bd.Equilibrium:
    """A body on one bearing and springs, at rest under its weight."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(2.0, (0.01, 0.01, 0.005), rotating=True))
    ball = bd.BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6, damping=300.0, **flaws)
    app.bearing("drive end", ball, inner="rotor.centre", outer="ground")
    app.ground("rotor.centre", stiffness=(0, 0, 1e5, 1e4, 1e4, 1e4), damping=(1e3,) * 3 + (5.0,) * 3)
    app.load("rotor.centre", (0.0, -300.0, 0, 0, 0, 0))
    return bd.equilibrium(app)


def warned(source: object, dt: float, speed: object = SPEED) -> str:
    with pytest.warns(CoarseStep) as caught:
        bd.transient(source, speed=speed, dt=dt, steps=3, record=["rotor.centre.y"])
    assert caught[0].filename == __file__  # the user's line
    return str(caught[0].message)


def silent(source: object, dt: float, speed: object = SPEED, **more: object) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", CoarseStep)
        bd.transient(source, speed=speed, dt=dt, steps=3, record=["rotor.centre.y"], **more)


# what drives, and its angular frequency from the kinematics of a ball between races (ISO 15243 notation):
# cage over shaft (1 − D/dm)/2, spin (dm/D)(1 − (D/dm)²)/2, at a contact angle of 0
RATIO = 12.303e-3 / 52e-3
CAGE, SPIN = (1 - RATIO) / 2, (1 - RATIO**2) / RATIO / 2
CASES = {
    "the passage of the 8 balls": ({}, 8 * CAGE),
    "wave of the inner race, radial, order 60": (
        {"waviness": [Waviness("inner", 60, 1e-7)]},
        60 * (1 - CAGE),
    ),
    "wave of the inner race, axial, order 60": (
        {"waviness": [Waviness("inner", 60, 1e-7, direction="axial")]},
        60 * (1 - CAGE),
    ),
    "wave of the outer race, radial, order 70": ({"waviness": [Waviness("outer", 70, 1e-7)]}, 70 * CAGE),
    "wave of the balls, order 16": ({"waviness": [Waviness("ball", 16, 1e-7)]}, 16 * SPIN),
}


@pytest.mark.parametrize("what", CASES)
def test_what_has_fewer_than_twenty_steps_is_named_with_the_step_that_would_do(what: str) -> None:
    flaws, ratio = CASES[what]
    eq = driven(**flaws)
    period = 2 * math.pi / (ratio * SPEED)
    silent(eq, 0.0499 * period)
    text = warned(eq, 0.0505 * period)
    assert f"{what} in bearing 'drive end': period {period:.3g} s, 19.8 steps" in text
    enough = float(re.findall(r"march with dt=(\S+) or less", text)[0])
    # two digits, rounded down
    assert 0.9 * 0.05 * period <= enough <= 0.05 * period
    silent(eq, enough)
    # the highest speed of a profile counts, of either sign
    assert what in warned(eq, 0.0505 * period, ([0.0, 5.0, 9.0], [0.0, -SPEED, 10.0]))
    silent(eq, 0.0505 * period, 0.9 * SPEED)


@pytest.mark.parametrize("body", ["outer", "inner", "ball"])
def test_a_pit_is_a_drop_and_a_rise(body: str) -> None:
    """A ball sinks 4 µm over √(depth·(D − depth)) into a wide pit, over half the width into a narrow one."""
    D, dm = 12.303e-3, 52e-3
    wide, narrow = (driven(defects=[Pit(body, -1.5, w, 4e-6)]) for w in (5e-3, 0.2e-3))
    radius, over = {
        "outer": ((dm + D) / 2, CAGE),
        "inner": ((dm - D) / 2, 1 - CAGE),
        "ball": (D / 2, SPIN),
    }[body]
    for eq, length in ((wide, 2 * math.sqrt(4e-6 * (D - 4e-6))), (narrow, 0.2e-3)):
        # the races' radii are those of the grooves, near enough
        period = length / (radius * over * SPEED)
        (found,) = [r.period for r in rhythms(eq.system, SPEED) if "pit" in r.what]
        assert found == pytest.approx(period, rel=2e-2)
        assert f"pit of the {body}" in warned(eq, 0.06 * period)


def test_loads_are_named_with_their_frequency() -> None:
    def loaded(**load: object) -> bd.Application:
        app = bd.Application()
        app.add("rotor", bd.RigidBody(2.0, (0.01, 0.01, 0.02), rotating=True))
        app.ground("rotor.centre", stiffness=(1e5,) * 6)
        if load:
            app.load("rotor.centre", (0, 10.0, 0, 0, 0, 0), **load)
        else:
            app.unbalance("rotor.centre", 1e-5)
        return app

    sine = loaded(frequency=2000.0)
    assert "2000 Hz: period 0.0005 s, 10 steps a period; dt=2.5e-05" in warned(sine, 5e-5)
    silent(sine, 2.5e-5)
    turning = loaded()
    assert "unbalance" in warned(turning, 0.06 * 2 * math.pi / SPEED)
    silent(turning, 0.049 * 2 * math.pi / SPEED)
    silent(turning, 1e-3, 0.0)
    # a sine as a table: its own period, however finely it is sampled
    for points in (41, 4001):
        t = np.linspace(0.0, 0.02, points)
        table = loaded(time=t, value=np.sin(2 * np.pi * 100.0 * t))
        (found,) = [r.period for r in rhythms(bd.equilibrium(table).system, 0.0) if "sampled" in r.what]
        assert found == pytest.approx(0.01, rel=2e-2)  # 20 points a period: chords of a sine
    silent(loaded(time=[0.0, 1.0], value=[2.0, 2.0]), 1e-2, 0.0)


@pytest.mark.parametrize("share", [0.02, 0.05, 0.1])
def test_the_estimate_is_the_error_of_a_free_oscillation(share: float) -> None:
    """x = cos ωt: the scheme's phase is late by ωt(ωΔt)²/12, grown from the stretch's begin to 2000 steps."""
    m, k = 2.0, 5e5
    w = math.sqrt(k / m)
    dt = share * 2 * math.pi / w / 10
    app = oscillator(m, 0.0, k)
    run = bd.transient(
        bd.equilibrium(app),
        speed=0.0,
        dt=dt,
        steps=100,
        record=["body.centre.y"],
        initial={"body.centre": [0, 1e-6, 0, 0, 0, 0]},
        check_step=True,
    )
    late = 2000 * w * dt * (w * dt) ** 2 / 12
    # rms over the stretch of a difference that grows evenly: 1/√3 of its end; beats of whole periods aside
    assert run.attrs["step_error"][0] == pytest.approx(late / math.sqrt(3), rel=0.1)
    assert "2000 steps" in run.attrs["step_error_made"]


def test_the_estimate_changes_nothing_else_and_is_written_to_files(tmp_path: Path) -> None:
    eq = driven()
    arguments = {"speed": SPEED, "dt": 2e-5, "steps": 500, "record": ["rotor.centre.y", "drive end.loaded"]}
    plain, checked = bd.transient(eq, **arguments), bd.transient(eq, check_step=True, **arguments)
    np.testing.assert_array_equal(checked.state, plain.state)
    np.testing.assert_array_equal(checked.record, plain.record)
    assert "step_error" not in plain.attrs
    bd.save(checked, tmp_path / "run.nc")
    back = bd.open_result(tmp_path / "run.nc")
    np.testing.assert_array_equal(back.attrs["step_error"], checked.attrs["step_error"])


def test_the_examples_march_finely_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(Path(__file__).parents[2] / "examples"))
    import fault_bench
    import motor

    bench = fault_bench.bench(None, (fault_bench.SPALL,))
    designs = [motor.motor(d, motor.RADIAL) for d in motor.designs(motor.rubber()[0])[:1]]
    for app, speed, dt in [(bench, fault_bench.SPEED, fault_bench.STEP)] + [
        (d, motor.SPEED, motor.STEP) for d in designs
    ]:
        fastest = rhythms(bd.equilibrium(app).system, speed)[0]
        assert dt <= 0.05 * fastest.period, fastest


def swinging(start: float, dt: float, record: str = "body.centre.y", **more: object) -> str:
    """Warnings of 2 kg on a spring, 79.6 Hz, with 20 g on it that swing at 5058 Hz, let go a start apart."""
    app = bd.Application()
    for name, mass in (("body", 2.0), ("tip", 0.02)):
        app.add(name, bd.RigidBody(mass, (1e-3 * mass,) * 3))
    app.ground("body.centre", stiffness=(5e5,) * 3 + (1e3,) * 3, damping=(10.0,) * 3 + (1.0,) * 3)
    app.spring(
        "body.centre", "tip.centre", stiffness=(2e7,) * 3 + (1e3,) * 3, damping=(200.0,) * 3 + (1.0,) * 3
    )
    places = {"body.centre": [0, 1e-6, 0, 0, 0, 0], "tip.centre": [0, 1e-6 + start, 0, 0, 0, 0]}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CoarseStep)
        bd.transient(app, speed=0.0, dt=dt, steps=3, record=[record], initial=places, progress=False, **more)
    return "\n".join(str(w.message) for w in caught if w.category is CoarseStep)


def test_a_displaced_start_that_swings_faster_than_the_step_follows_is_told() -> None:
    slow, fast = 1 / 79.18, 1 / 5058.0  # periods, s
    assert swinging(0.0, 0.049 * slow) == ""
    assert re.search(
        r"start that initial= gives: modes from 79.\d+ Hz .* carry of the swing of body.centre.y 100 %; "
        r"march with dt=0.00063 or less",
        swinging(0.0, 0.06 * slow),
    )
    # the tip's y is 1 cos 500t + 0.99 s cos 31781t, in µm, and the body's has a hundredth of the second
    dt = 0.4 * fast
    assert swinging(9e-8, dt, "tip.centre.y") == ""
    assert re.search(
        r"tip.centre.y 1\d %; march with dt=9.8e-06 or less", swinging(1.2e-7, dt, "tip.centre.y")
    )
    assert swinging(1.2e-7, dt) == ""
    assert "body.centre.y.velocity" not in swinging(1.2e-8, dt, "body.centre.y.velocity")
    assert "tip.centre.y.velocity 99 %" in swinging(1.2e-7, dt, "tip.centre.y.velocity")
    # exact steps follow any linear swing, and a record that begins when the swing is over has none of it:
    # c/2µ = 5050 1/s, so that 0.7 are left of it after one step and 1e-5 after thirty
    assert swinging(1.2e-7, dt, "tip.centre.y.velocity", method="exact") == ""
    assert swinging(1.2e-7, dt, "tip.centre.y.velocity", settle=1) != ""
    assert swinging(1.2e-7, dt, "tip.centre.y.velocity", settle=30) == ""


def test_a_start_too_coarse_is_as_wrong_as_it_is_told() -> None:
    """At 2.5 steps a period the average acceleration's frequency is arctan's: 2/Δt·atan(ωΔt/2)."""
    app = oscillator(2.0, 0.0, 5e5)
    dt = 2 * math.pi / 500.0 / 2.5
    with pytest.warns(CoarseStep, match="initial= gives"):
        run = bd.transient(
            app, speed=0.0, dt=dt, steps=200, record=["body.centre.y"], progress=False,
            initial={"body.centre": [0, 1e-6, 0, 0, 0, 0]},
        )  # fmt: skip
    w = 2 / dt * math.atan(500.0 * dt / 2)
    t = run["record"]["time"].values
    np.testing.assert_allclose(run["record"].values[:, 0], 1e-6 * np.cos(w * t), atol=1e-9)
    assert w < 0.72 * 500.0
