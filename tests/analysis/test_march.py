"""What transient and dissipation share: one prepared march, its fingerprint, its errors, its state."""

from __future__ import annotations

import dataclasses
import math
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.analysis.march import March
from bearingdyn.analysis.march_state import system_hash
from bearingdyn.notice import NothingPushes
from rotors import motor, oscillator

ARGUMENTS = {"speed": 300.0, "dt": 1e-5, "steps": 50, "record": ["shaft.end.y"]}


@pytest.fixture(scope="module")
def state() -> bd.Equilibrium:
    return bd.equilibrium(motor())


@pytest.fixture(scope="module")
def first(state: bd.Equilibrium) -> xarray.Dataset:
    return bd.transient(state, **ARGUMENTS)


# ------------------------------------------------------------------- one place for each number


@pytest.mark.parametrize("name", ["dt", "speed", "audit"])
def test_a_scheme_has_no_step_no_speed_and_no_audit(name: str) -> None:
    with pytest.raises(TypeError, match=name):
        bd.Scheme(**{name: 1.0})
    with pytest.raises(TypeError, match="positional"):
        bd.Scheme(1e-5)  # type: ignore[misc]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"dt": 0.0}, r"dt is 0\.0; the time step must be positive and finite, in s"),
        ({"dt": "1e-5"}, "dt is '1e-5'"),
        ({"steps": 2.5}, r"steps is 2\.5; it must be a whole number of at least"),
        ({"settle": math.nan}, "settle is nan; it must be a whole number of at least 0"),
        ({"speed": "fast"}, "speed is 'fast'; give one finite number in rad/s, or"),
        ({"speed": [0.0, 1.0]}, r"speed is \[0\.0, 1\.0\]; give one finite number"),
        ({"speed": ([0.0, 1.0], ["a", "b"])}, "speed is .*; give one finite number"),
        ({"speed": ([0.0, 0.0], [1.0, 2.0])}, "times must increase"),
    ],
)
def test_both_analyses_refuse_the_same_things_in_the_same_words(
    state: bd.Equilibrium, change: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        bd.transient(state, **(ARGUMENTS | change))
    with pytest.raises(ValueError, match=message):
        bd.dissipation(state, **({k: v for k, v in ARGUMENTS.items() if k != "record"} | change))


def test_an_application_loses_what_its_equilibrium_loses(state: bd.Equilibrium) -> None:
    arguments = {"speed": 300.0, "dt": 1e-5, "steps": 40, "settle": 10}
    found = bd.dissipation(motor(), **arguments)
    assert found.attrs["complete"] == 1
    np.testing.assert_array_equal(found.energy, bd.dissipation(state, **arguments).energy)
    with pytest.raises(ValueError, match="source is <System"):
        bd.dissipation(state.linearised(), **arguments)  # type: ignore[arg-type]


# ------------------------------------------------------------------- what a march that fails leaves


def unstable(**change: object) -> xarray.Dataset:
    """Central differences at a step far beyond their limit: each step makes the motion 5e5 times larger."""
    app = oscillator(c=0.1)
    app.load("body.centre", (0, 1.0, 0, 0, 0, 0), frequency=0.1)
    arguments = {"speed": 0.0, "dt": 1.0, "steps": 1000, "record": ["body.centre.y"]}
    return bd.transient(bd.equilibrium(app), scheme=bd.Scheme(beta=0.0), **(arguments | change))


def test_an_audited_march_that_overflows_keeps_what_it_computed() -> None:
    """Energies are squares: they overflow long before the displacements do."""
    with pytest.raises(bd.SolverError, match=r"no longer finite in step \d+ .*smaller dt") as plain:
        unstable()
    with pytest.raises(bd.SolverError, match=r"no longer finite in step \d+ .*smaller dt") as audited:
        unstable(audit=True)
    partial = audited.value.partial
    assert isinstance(partial, xarray.Dataset)
    assert isinstance(plain.value.partial, xarray.Dataset)
    assert partial.sizes["time"] > 20
    np.testing.assert_array_equal(partial.record, plain.value.partial.record)
    assert math.isnan(partial.attrs["energy_kinetic"])
    assert partial.attrs["complete"] == 0


def test_an_audit_that_overflows_between_two_chunks_ends_the_march(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bearingdyn.analysis.march_pieces.CHUNK_STEPS", 5)
    path = tmp_path / "run.bdrun"
    with pytest.raises(bd.SolverError, match="no longer finite") as caught:
        unstable(audit=True, stream=path)
    rows = caught.value.partial.record.values
    assert len(rows) % 5 == 0
    np.testing.assert_array_equal(rows, bd.open_result(path).record)
    with pytest.raises(ValueError, match=r"run.bdrun holds a state whose number \d+ is"):
        unstable(audit=True, stream=path)


def test_dissipation_fails_where_transient_fails_and_keeps_its_sums(state: bd.Equilibrium) -> None:
    # a run-up that outruns three iterations a step after some hundred steps
    speed = ([0.0, 0.02], [300.0, 3e4])
    arguments = {"speed": speed, "dt": 5e-5, "steps": 2000, "scheme": bd.Scheme(max_iterations=3)}
    with pytest.raises(bd.SolverError) as march:
        bd.transient(state, record=["left.loss", "right.loss"], **arguments)
    with pytest.raises(bd.SolverError) as sums:
        bd.dissipation(state, settle=150, **arguments)
    assert str(sums.value) == str(march.value)
    for name in ("status", "steps", "t", "residual", "bearing"):
        assert getattr(sums.value.report, name) == getattr(march.value.report, name)
    losses, found = march.value.partial.record.values, sums.value.partial
    assert len(losses) > 200
    assert found.attrs["complete"] == 0
    assert found.attrs["steps"] == len(losses) - 150
    # the trapezoidal rule over the same powers, from that of the last state before the record
    expected = 5e-5 * np.trapezoid(losses[149:], axis=0)
    np.testing.assert_allclose(found.energy.sel(part=["left", "right"]), expected, rtol=1e-12)


def test_an_interrupted_dissipation_keeps_its_sums(state: bd.Equilibrium) -> None:
    def stop(done: int, _: int) -> None:
        if done >= 4000:
            raise KeyboardInterrupt

    with pytest.raises(bd.Interrupted, match="`partial`") as caught:
        bd.dissipation(state, speed=300.0, dt=1e-5, steps=10**7, progress=stop)
    found = caught.value.partial
    assert isinstance(found, xarray.Dataset)
    whole = bd.dissipation(state, speed=300.0, dt=1e-5, steps=found.attrs["steps"])
    np.testing.assert_allclose(found.energy, whole.energy, rtol=1e-12)  # summed in other pieces


# ------------------------------------------------------------------- the fingerprint

SCHEMES = {"beta": 0.3, "gamma": 0.6, "tolerance": 1e-8, "max_iterations": 39, "isa": "base", "hold": 2}
STEPPINGS = {"dt": 2e-5, "speed": 301.0, "audit": True, "scheme": bd.Scheme(gamma=0.6)}


def test_each_field_is_tried() -> None:
    assert set(SCHEMES) == {f.name for f in dataclasses.fields(core.Scheme)}
    assert set(STEPPINGS) == {f.name for f in dataclasses.fields(core.Stepping)}


@pytest.mark.parametrize(
    "change",
    [{name: value} for name, value in STEPPINGS.items()]
    + [{"scheme": bd.Scheme(**{name: value})} for name, value in SCHEMES.items()],
    ids=[*STEPPINGS, *SCHEMES],
)
def test_a_stream_goes_on_with_nothing_else(
    state: bd.Equilibrium, tmp_path: Path, change: dict[str, object]
) -> None:
    path = tmp_path / "run.bdrun"
    bd.transient(state, stream=path, **ARGUMENTS)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="another run"):
        bd.transient(state, stream=path, **(ARGUMENTS | change))
    assert path.read_bytes() == before
    bd.transient(state, stream=path, **ARGUMENTS)


def test_the_fingerprint_sees_the_numbers_and_not_how_they_are_given(state: bd.Equilibrium) -> None:
    def digest(speed: object, x: float = 0.0) -> str:
        march = March.of(state, speed=speed, dt=1e-5, steps=5)  # type: ignore[arg-type]
        return march.digest(np.array([x]))

    assert digest(300) == digest(np.float64(300.0))
    assert digest(([0, 1], [2, 3])) == digest((np.array([0.0, 1.0]), (2.0, 3.0)))
    assert digest(([0, 1], [2, 3])) != digest(([0, 1], [2, 3.0000001]))
    assert digest(300) != digest(300, x=1e-300)


@pytest.mark.parametrize("name", ["M", "C", "G", "K", "N", "layers", "bearings", "loads"])
def test_a_system_is_known_by_each_of_its_matrices_and_terms(state: bd.Equilibrium, name: str) -> None:
    system = state.system
    if name in "MCGKN":
        changed = np.array(getattr(system, name))
        changed[0, 1] += 1e-3
        changed[1, 0] += 1e-3 if name in "MCK" else -1e-3
        other = dataclasses.replace(system, **{name: changed})
    else:
        other = dataclasses.replace(system, **{name: getattr(system, name)[1:]})
    assert system_hash(other) != system_hash(system)
    assert system_hash(dataclasses.replace(system, inputs="told otherwise")) == system_hash(system)


# ------------------------------------------------------------------- going on


def body(m: float, push: float = 1.0) -> bd.Application:
    app = oscillator(m)
    app.load("body.centre", (0, push, 0, 0, 0, 0))
    return app


@pytest.mark.parametrize("other", [body(2.1), body(2.0, push=2.0), oscillator(2.0, c=41.0)])
def test_the_state_of_another_application_of_the_same_size_is_refused(
    tmp_path: Path, other: bd.Application
) -> None:
    arguments = {"speed": 0.0, "dt": 1e-4, "steps": 5, "record": ["body.centre.y"]}
    begun = bd.transient(bd.equilibrium(body(2.0)), **arguments)
    bd.save(begun, tmp_path / "begun.nc")
    kept = bd.open_result(tmp_path / "begun.nc")
    again = bd.transient(bd.equilibrium(body(2.0)), resume=kept, **arguments)  # built anew: the same
    assert again.time.values[0] == pytest.approx(6e-4)
    for result in (begun, kept):
        with pytest.raises(
            ValueError, match="resume is the state of another application: its system_hash is"
        ):
            bd.transient(bd.equilibrium(other), resume=result, **arguments)


def test_a_smaller_application_is_told_by_its_size(state: bd.Equilibrium) -> None:
    small = bd.transient(bd.equilibrium(oscillator()), speed=0.0, dt=1e-4, steps=1, record=[])
    with pytest.raises(
        ValueError, match=r"state of another application: it has \d+ numbers, and this one has"
    ):
        bd.transient(state, resume=small, **ARGUMENTS)


def test_a_linearised_march_is_no_beginning_of_the_nonlinear_one() -> None:
    app = motor()
    eq = bd.equilibrium(app)
    turned = bd.equilibrium(app, angle=0.3)
    begun = bd.transient(eq, **ARGUMENTS)
    with pytest.raises(ValueError, match="another system of this application"):
        bd.transient(turned, resume=begun, **ARGUMENTS)


def test_a_result_that_does_not_say_its_system_is_compared_by_its_channels(
    state: bd.Equilibrium, first: xarray.Dataset
) -> None:
    old = first.copy()
    del old.attrs["system_hash"]
    second = bd.transient(state, resume=old, **ARGUMENTS)
    np.testing.assert_array_equal(second.state, bd.transient(state, resume=first, **ARGUMENTS).state)
    named = old.assign_coords(channel=["rotor.end.y"])
    with pytest.raises(ValueError, match=r"another application: .*'rotor.end' is no"):
        bd.transient(state, resume=named, **ARGUMENTS)


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e308, -1e101])
def test_an_impossible_number_in_a_state_is_named(
    state: bd.Equilibrium, first: xarray.Dataset, value: float
) -> None:
    # the clock and every kind of number behind it, the stresses of the branches among them
    for k in (6, first.sizes["word"] // 3, first.sizes["word"] // 2, first.sizes["word"] - 1):
        bad = first.copy(deep=True)
        bad["state"][k] = value
        with pytest.raises(ValueError, match=f"resume holds a state whose number {k} is"):
            bd.transient(state, resume=bad, **ARGUMENTS)


def test_a_result_without_a_state_is_named(state: bd.Equilibrium, first: xarray.Dataset) -> None:
    with pytest.raises(ValueError, match=r"resume holds \['record'\] and no state"):
        bd.transient(state, resume=first.drop_vars("state"), **ARGUMENTS)


def test_a_march_that_nothing_pushes_says_so():
    """A rotor in clearance without a load stays; with weight, or started displaced, it moves."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("rotor.centre", stiffness=(0, 0, 1e6, 1e3, 1e3, 0), damping=(10, 10, 10, 1, 1, 0))
    ball = bd.catalogue.bearing("6205", clearance=1e-5)
    app.bearing("b", ball, inner="rotor.centre", outer="ground")
    course = {"speed": 100.0, "dt": 1e-5, "steps": 20}
    with pytest.warns(NothingPushes, match="no ball is pressed, and no load acts"):
        still = bd.transient(app, **course, record=["rotor.centre.y"])
    assert not still["record"].values.any()
    with pytest.warns(NothingPushes):
        bd.dissipation(app, **course)
    with warnings.catch_warnings():
        warnings.simplefilter("error", NothingPushes)
        displaced = {"rotor.centre": [0, 1e-7, 0, 0, 0, 0]}
        run = bd.transient(app, **course, record=["rotor.centre.y"], initial=displaced)
        assert run["record"].values.any()
        app.gravity((0, -9.81, 0))
        assert bd.transient(app, **course, record=["rotor.centre.y"])["record"].values.any()


@pytest.mark.parametrize("plain", [True, False])
def test_a_record_that_would_keep_no_sample_is_refused(plain: bool):
    app = oscillator()
    with pytest.raises(ValueError, match="decimate is 21; of 20 steps no sample would be kept"):
        bd.transient(app, speed=0.0, dt=1e-5, steps=20, decimate=21, filter=plain, record=["body.centre.y"])
