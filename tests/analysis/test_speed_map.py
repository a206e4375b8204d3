"""Maps of steady motions: against the reference page, a file of their own, processes and failed points."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from types import SimpleNamespace

import matplotlib as mpl
import numpy as np
import pytest
import xarray

mpl.use("Agg")

import matplotlib.pyplot as plt

import rotors
from bearingdyn import plot
from bearingdyn.analysis import equilibrium, parameter_map, speed_map, steady_state, transient
from bearingdyn.analysis.steady import branches as tracing
from bearingdyn.analysis.steady import searches
from bearingdyn.analysis.steady.balance import flat, newton, unflat
from bearingdyn.analysis.steady.continuation import Point, backwards, follow, locate
from bearingdyn.analysis.steady.event_accuracy import half_turn, once, within
from bearingdyn.analysis.steady.factored import Factored, jacobian
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.reaching import curve_of
from bearingdyn.analysis.steady.receptances import AtRest
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.application import Application
from bearingdyn.material import FractionalZener
from bearingdyn.notice import CutHarmonics
from bearingdyn.system import assemble

RPM = math.pi / 30
RECORD = ["rotor.centre.x", "rotor.centre.y"]
QUICK = {"several": False, "doublings": 0, "harmonics": 12, "points": 30, "progress": False}


def made(low: float, high: float, **given: object) -> xarray.Dataset:
    """A map of the JIS 6306 rotor between two speeds, rpm."""
    eq = equilibrium(rotors.held_jis_rotor())
    return speed_map(eq, speeds=(low * RPM, high * RPM), record=RECORD, **{**QUICK, **given})


@pytest.fixture(scope="module")
def hysteresis() -> xarray.Dataset:
    return made(4550, 5300)


def events(data: xarray.Dataset, name: str) -> np.ndarray:
    """Speeds, rpm, of the events of a name, falling."""
    return np.sort(data["speed"].values[data["event"].values == name] / RPM)[::-1]


def swing(data: xarray.Dataset, rpm: float, keep: np.ndarray) -> float:
    """x peak to peak of chosen points at a speed, µm, straight between them."""
    order = np.argsort(data["speed"].values[keep])
    at, size = data["speed"].values[keep][order] / RPM, data["peak_to_peak"].values[keep, 0][order]
    return float(1e6 * np.interp(rpm, at, size))


def test_folds_and_flips_lie_where_the_reference_page_has_them(hysteresis: xarray.Dataset) -> None:
    """§4.4; 12, 24 and 48 harmonics agree within .1 rpm there."""
    assert events(hysteresis, "fold") == pytest.approx([5229.2], abs=0.3)
    upper = hysteresis["branch"].values == 0
    flip = events(hysteresis.isel(point=upper), "flip")
    assert flip == pytest.approx([4602.6], abs=0.3)
    at = (hysteresis["event"].values == "flip") & upper
    # asked for to 2e-4; 13.974 µm is given
    assert 1e6 * hysteresis["peak_to_peak"].values[at, 0] == pytest.approx([13.974], abs=3e-3)


def test_two_motions_are_stable_between_them(hysteresis: xarray.Dataset) -> None:
    upper = hysteresis["branch"].values == 0
    rpm, stable = hysteresis["speed"].values / RPM, hysteresis["stable"].values == 1
    assert stable[upper & (rpm > 4603)].all()
    assert not stable[upper & (rpm < 4602)].any()
    # a run-up loses its motion at the fold; the branch goes back from there, unstable
    lower = np.flatnonzero(~upper)
    fold = lower[np.argmax(rpm[lower])]
    assert stable[lower[lower < fold]].all()
    assert not stable[lower[lower > fold]].any()
    # 1.008 µm after a run-up, §3.6; straight between points of the branch
    assert swing(hysteresis, 5000.0, lower[lower < fold]) == pytest.approx(1.008, rel=0.02)


def test_periods_double_at_a_flip_to_what_marches_find() -> None:
    """§3.6, period two: x peak to peak 8.05, 6.70 and 4.79 µm, from marches."""
    data = made(10400, 11250, doublings=1, points=20, harmonics=16)
    twice = data["passages"].values == 2
    for rpm, size in ((10500, 8.05), (10750, 6.70), (11000, 4.79)):
        # three digits are given; straight between points of the branch
        assert swing(data, rpm, twice) == pytest.approx(size, rel=0.01)
    # a point at the flip itself has a multiplier of 1
    beyond = data["speed"].values / RPM < events(data, "flip")[0] - 1.0
    assert (data["stable"].values[twice & beyond] == 1).all()
    # what it comes from is unstable for as long
    assert (data["stable"].values[~twice & beyond] == 0).all()


def test_several_states_find_motions_that_neither_end_leads_to() -> None:
    """From 4900 to 5100 rpm both ends stand on the lower branch; the upper one and one between hang apart."""
    ends = made(4900, 5100, points=6)
    assert set(ends["branch"].values) == {0}
    data = made(4900, 5100, points=6, several=True)
    found = {}
    for branch in np.unique(data["branch"].values):
        keep = data["branch"].values == branch
        at = np.abs(data["speed"].values[keep] / RPM - 5000.0) < 1.0
        for size, stable in zip(
            data["peak_to_peak"].values[keep, 0][at], data["stable"].values[keep][at], strict=True
        ):
            found[round(1e6 * float(size), 1)] = int(stable)
    # 1.008 and 10.0257 µm, §3.6 and §4.4, are stable; twelve harmonics give three digits
    assert found == {1.0: 1, 10.0: 1, 9.6: 0}
    # the one between is unstable down to the fold at 5229 rpm, and flips back at 5037 (the guide's map)
    assert events(data, "flip") == pytest.approx([5037.0], abs=1.0)


@pytest.mark.slow
def test_the_upper_branch_ends_where_the_reference_page_says() -> None:
    data = made(3000, 5400, points=60, harmonics=24)
    # the first branch is the coast-down's, and its first fold is where it ends: 3075 ± 2 rpm, 39.9 µm
    end = np.flatnonzero(data["event"].values == "fold")[0]
    assert float(data["speed"].values[end]) / RPM == pytest.approx(3075.0, abs=3.0)
    assert 1e6 * float(data["peak_to_peak"].values[end, 0]) == pytest.approx(39.9, rel=0.01)
    # one fold, where 12, 24, 32 and 48 harmonics have it to .03 rpm: 3073.05 to 3073.08
    assert len(events(data, "fold")) == 2
    few = made(3000, 5400, points=60)
    assert events(few, "fold") == pytest.approx(events(data, "fold"), abs=0.1)
    there = data["event"].values != ""
    assert data["located_within"].values[there].max() / RPM < 0.3


def test_an_interval_between_neimark_sacker_points_is_one_that_marches_leave_turning() -> None:
    """With 6 µm a side, from 4149 to 4317 rpm: a pair of multipliers is outside; marches have that pair."""
    eq = equilibrium(rotors.held_jis_rotor(6e-6))
    data = speed_map(
        eq, speeds=(4080 * RPM, 4380 * RPM), record=RECORD, **{**QUICK, "harmonics": 24, "points": 12}
    )
    ends = events(data, "neimark-sacker")
    assert len(ends) == 2
    assert 4080 < ends[1] < 4230 < ends[0] < 4380
    rpm, stable = data["speed"].values / RPM, data["stable"].values == 1
    inside = (rpm > ends[1] + 1) & (rpm < ends[0] - 1)
    assert not stable[inside].any()
    assert stable[(rpm < ends[1] - 1) | (rpm > ends[0] + 1)].all()

    at = 4230 * RPM
    found = steady_state(eq, speed=at, harmonics=24, record=RECORD)
    steps, passages = 512, 110
    passage = 2 * math.pi / float(np.abs(found["frequency"].values[1]) * 2 * math.pi)
    run = transient(
        eq,
        speed=at,
        dt=passage / steps,
        steps=steps * passages,
        decimate=steps,
        filter=False,
        record=RECORD,
        initial=found,
    )
    # one pair μ, μ*: d(n + 2) = 2 Re μ d(n + 1) - |μ|² d(n), of differences, which know no mean
    d = np.diff(run["record"].values, axis=0)
    d = d[(np.abs(d).max(axis=1) > 3e-12).argmax() :]
    d = d[: (np.abs(d).max(axis=1) > 1e-8).argmax()]
    assert len(d) > 20
    before = np.stack([d[1:-1].ravel(), d[:-2].ravel()], axis=1)
    _, square = np.linalg.lstsq(before, d[2:].ravel(), rcond=None)[0]
    assert math.log(-square) / 2 == pytest.approx(math.log(found.attrs["multiplier"]), rel=0.05)


def test_folds_that_crowd_are_known_to_what_they_span() -> None:
    events = ["", "fold", "", "fold", "fold", "flip", "fold", "failed"]
    found = within(events, [500.0, 400.0, 400.2, 400.3, 400.1, 600.0, 700.0, 710.0], 1e-3)
    assert np.isnan([found[0], found[2], found[7]]).all()
    assert [found[k] for k in (1, 3, 4)] == pytest.approx([0.3] * 3)
    assert [found[5], found[6]] == [1e-3, 1e-3]


def test_an_event_on_a_point_is_told_once(hysteresis: xarray.Dataset) -> None:
    """A crossing on a point is found behind the point before it and again behind it."""

    def mark(event: str, parameter: float, size: float = 1.0) -> SimpleNamespace:
        z = np.array([[1.0], [size]])
        return SimpleNamespace(event=event, point=SimpleNamespace(parameter=parameter, z=z))

    marks = [mark("", 1.0), mark("flip", 1.5), mark("", 1.5), mark("flip", 1.5 + 1e-9), mark("fold", 1.5)]
    marks += [mark("flip", 1.6), mark("flip", 1.6, 1.1)]
    kept = list(once(marks, 1e-6))
    assert kept == [m for k, m in enumerate(marks) if k != 3]
    located = hysteresis["event"].values != ""
    assert np.isfinite(hysteresis["located_within"].values[located]).all()
    assert np.isnan(hysteresis["located_within"].values[~located]).all()


def test_a_pair_that_turns_through_minus_one_between_points_is_seen() -> None:
    def pair(size: float, left: float) -> list[complex]:
        m = size * np.exp(1j * (math.pi - left))
        return [m, m.conjugate(), 0.5 * m, 0.3 + 0.0j]

    places = [10.0, 9.0, 8.0]
    # 0.5, 0.3 and 0.1 beyond what is left of the half turn: the crossing lies three quarters of the way
    found = half_turn([pair(0.99, 0.5), pair(0.99, 0.3), pair(0.99, 0.1)], places)
    assert found is None
    turned = half_turn([pair(0.99, 0.7), pair(0.99, 0.3), pair(0.99, 0.1)], places)
    assert turned == pytest.approx(0.75)
    # another mode, or one that dies away at once
    assert half_turn([pair(0.99, 0.7), pair(0.99, 0.3), pair(0.95, 0.1)], places) is None
    assert half_turn([pair(0.8, 0.7), pair(0.8, 0.3), pair(0.8, 0.1)], places) is None


def doubled(parameters: list[float], odd: float) -> tracing.Branch:
    """A branch of doubled period whose odd lines have the size `odd` where the parameter is 1, none at 0."""

    def mark(parameter: float) -> tracing.Mark:
        z = np.zeros((5, 2), dtype=complex)
        z[0::2], z[1::2] = 1.0, odd * parameter
        return tracing.Mark(SimpleNamespace(parameter=parameter, z=z, pressed=None, tangent=None), None, z)

    return tracing.Branch(2, tuple(mark(p) for p in parameters), "")


def test_a_doubled_motion_is_the_same_a_passage_later() -> None:
    own = doubled([0.0, 0.5, 1.0], 0.4)
    z = doubled([0.75], 0.4).marks[0].point.z
    # a passage is half a period: lines of odd multiples of its frequency turn by π, the others by whole turns
    later = z * (-1.0) ** np.arange(5)[:, None]
    assert tracing.known([own], 2, 0.75, z)
    assert tracing.known([own], 2, 0.75, later)
    assert not tracing.known([own], 2, 0.75, z * np.exp(0.5j * np.pi * np.arange(5))[:, None])
    # from its other flip the branch is met again, though nothing lies between that flip and its last point
    back = doubled([1.0002, 1.0001, 0.9, 0.7, 0.4], -0.4)
    assert searches._met(back, [own], 1e-3)
    assert not searches._met(back, [own], 5e-5)
    assert not searches._met(doubled([1.0001, 0.9, 0.7], 0.2), [own], 1e-3)


def test_a_store_gives_the_same_map_again_without_work(tmp_path, monkeypatch, hysteresis) -> None:
    first = made(5250, 5300, points=3, store=tmp_path)
    assert list(tmp_path.iterdir())
    monkeypatch.setattr(searches, "newton", None)
    again = made(5250, 5300, points=3, store=tmp_path)
    assert first.attrs.pop("made_at") <= again.attrs.pop("made_at")
    xarray.testing.assert_identical(first, again)
    with pytest.raises(TypeError):  # another range is another map
        made(5251, 5300, points=3, store=tmp_path)


def test_a_store_tells_laws_apart(tmp_path) -> None:
    """Laws without branches, too: each has a file of its own."""
    app = rotors.motor()
    system = assemble(app)
    counts = []
    for tau in (1e-4, 2e-4):
        law = FractionalZener(1e6, 6e6, tau, 0.7, K=2e9, density=1200.0)
        layers = tuple(replace(t, material=law) for t in system.layers)
        speed_map(
            replace(system, layers=layers),
            speeds=(600.0, 610.0),
            record=["shaft.end.y"],
            **{**QUICK, "points": 2, "harmonics": 6},
            store=tmp_path,
        )
        counts.append(len(list(tmp_path.iterdir())))
    assert counts[1] == 2 * counts[0]


@pytest.mark.slow
def test_processes_find_the_same_map(hysteresis: xarray.Dataset) -> None:
    with ProcessPoolExecutor(2) as pool:
        spread = made(4550, 5300, executor=pool)
    for name in ("fold", "flip"):
        for rpm in events(hysteresis, name):
            assert np.abs(events(spread, name) - rpm).min() < 0.01


def test_a_map_goes_on_past_a_failed_point_and_marks_it(monkeypatch: pytest.MonkeyPatch) -> None:
    follow = tracing.follow

    def stumbling(*given: object) -> Iterator[object]:
        for count, point in enumerate(follow(*given)):
            if count == 2:
                return
            yield point

    monkeypatch.setattr(tracing, "follow", stumbling)
    data = made(7000, 8000, points=10)
    assert data.attrs["failed"] > 1
    assert (data["event"].values == "failed").sum() == data.attrs["failed"]
    # beyond the first failed point there are converged ones, down to the end of the range
    assert float(data["speed"].min()) / RPM < 7050


def test_a_map_over_clearance_ends_where_the_speed_alone_has_its_motion() -> None:
    make = rotors.held_jis_rotor
    asked = {**QUICK, "points": 4}
    data = parameter_map(make, values=(16e-6, 20e-6), speed=8000 * RPM, record=RECORD, **asked)
    last = int(np.argmax(data["parameter"].values))
    assert data["parameter"].values[last] == 20e-6
    alone = steady_state(make(), speed=8000 * RPM, record=RECORD, harmonics=12, stability=False)
    # a map takes 16 samples a harmonic, one motion 20; the largest line is 1.5e-7 m
    np.testing.assert_allclose(
        data["amplitude"].values[last], alone["amplitude"].values, rtol=1e-5, atol=1e-12
    )


def test_a_map_without_bearings_follows_the_load() -> None:
    """One harmonic load: a linear machine, whose map is its frequency response, the same at every speed."""
    app = rotors.friswell()
    app.load("rotor.left", (0, 1.0, 0, 0, 0, 0), frequency=20.0)
    data = speed_map(
        app, speeds=(10.0, 20.0), record=["rotor.right.y"], harmonics=2, points=2, doublings=0, progress=False
    )
    assert (data["stable"].values == -1).all()
    assert data["passage_frequency"].values == pytest.approx(20.0)


def test_a_march_can_be_asked_whether_its_motion_is_the_only_one() -> None:
    """§3.6 and §4.4: 1.008 µm after a run-up, 10.0257 µm after a coast-down, at 5000 rpm."""
    eq = equilibrium(rotors.held_jis_rotor())
    asked = {"dt": 1e-5, "steps": 10, "record": RECORD[:1], "check_unique": True}
    two = transient(eq, rpm=5000, **asked)
    # four digits are given
    assert 1e6 * two["stable_motion"].values[:, 0] == pytest.approx([1.008, 10.0257], rel=5e-4)
    assert two.attrs["stable_motions"] == 2
    with pytest.raises(ValueError, match="check_unique with speed"):
        transient(eq, speed=([0.0, 1.0], [100.0, 200.0]), **asked)
    unbalanced = rotors.held_jis_rotor()
    unbalanced.unbalance("rotor.centre", 1e-6)
    with pytest.raises(ValueError, match="check_unique for the base frequencies"):
        transient(unbalanced, speed=500.0, **asked)


def test_the_derivative_as_one_matrix_is_that_of_products_and_of_differences() -> None:
    """A machine of two bearings in layers, whose balls come and go."""
    app = rotors.motor()
    app.load("shaft.end", (0, -600.0, 0, 0, 0, 0))
    problem = Problem.of(app)
    lines = Lines.harmonics(6, 16)
    balance = problem.balance(lines, 700.0)
    z = problem.standing(lines)
    rng = np.random.default_rng(0)
    z[1:3] += 3e-7 * (rng.normal(size=z[1:3].shape) + 1j * rng.normal(size=z[1:3].shape))
    pressed = balance.press(z)
    assert np.ptp([along.loads for along in pressed.bearings]) > 0.0
    J = jacobian(balance, pressed)
    step = rng.normal(size=z.shape) + 1j * rng.normal(size=z.shape)
    vector = flat(step)  # the mean loses its imaginary part here
    linear = balance.linearised(pressed)
    product = linear.product(vector.copy())
    whole = linear.prepared(unflat(J @ vector, balance).copy())
    np.testing.assert_allclose(whole, product, rtol=0, atol=1e-12 * np.abs(product).max())
    # the balls' force has a kink where one closes: differences see it to the share of a step, 1e-4 here
    size = 1e-11
    ends = [balance.residual(z + s * step, balance.press(z + s * step)) for s in (size, -size)]
    slope = flat((ends[0] - ends[1]) / (2 * size))
    np.testing.assert_allclose(J @ vector, slope, rtol=0, atol=1e-3 * np.abs(slope).max())
    kept = J.copy()
    solved = Factored.of(J).solve(vector)
    np.testing.assert_allclose(kept @ solved, vector, rtol=0, atol=1e-9 * np.abs(vector).max())
    # corrections are in single precision: six digits after sums of a hundred products
    single = jacobian(balance, pressed, single=True)
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, kept, rtol=0, atol=1e-6 * np.abs(kept).max())
    rough = Factored.of(single).solve(vector)
    np.testing.assert_allclose(rough, solved, rtol=0, atol=1e-3 * np.abs(solved).max())


def test_what_stands_answers_at_every_speed_from_one_factoring() -> None:
    rng = np.random.default_rng(1)
    D, N, forces = rng.normal(size=(8, 8)) + 8 * np.eye(8), np.zeros((8, 8)), rng.normal(size=(8, 3))
    N[2:5, 1:6] = rng.normal(size=(3, 5))
    for turning in (N, np.zeros_like(N)):
        at_rest = AtRest.of(D, turning)
        for speed in (0.0, 0.3, -2.0):
            expected = np.linalg.solve(D + speed * turning, forces)
            # round-off of two well-conditioned solves
            np.testing.assert_allclose(at_rest.solve(speed, forces), expected, rtol=0, atol=1e-13)


def test_a_corrector_that_lands_far_from_its_predictor_is_refused() -> None:
    problem = Problem.of(equilibrium(rotors.held_jis_rotor()))
    lines = Lines.harmonics(12, 16)
    speed = 8000 * RPM
    found = newton(problem.balance(lines, speed), problem.standing(lines), tolerance=1e-10)
    curve = curve_of(lambda p: problem.balance(lines, p), found, speed)
    point = curve.begin(found, speed, -1.0)
    length = 0.02
    held = curve.step(point, length, bend=np.zeros(len(point.tangent) + 1))
    across = curve.step(point, length)
    assert held is not None
    assert across is not None
    # no fold is near: the parameter stays where it was predicted, and the tangent goes on the same way
    assert held.parameter == point.parameter + curve.scale * length * point.slope
    assert curve.turn(held, across) < 1e-2
    away = np.zeros(len(point.tangent) + 1)
    away[2 * point.z.shape[1]] = 2.0 / length  # the predictor leaves the tangent by the length of the step
    assert curve.step(point, length, bend=away) is None
    assert curve.step(point, length, exact=True, bend=away) is not None  # it does come back to the curve


def test_a_tangent_that_points_past_the_curve_is_taken_anew_and_the_branch_goes_on() -> None:
    """A neighbour's slope gives a tangent that may be off; the bare motor's branch once ended there."""
    problem = Problem.of(equilibrium(rotors.held_jis_rotor()))
    lines = Lines.harmonics(12, 16)
    speed = 8000 * RPM
    found = newton(problem.balance(lines, speed), problem.standing(lines), tolerance=1e-10)
    curve = curve_of(lambda p: problem.balance(lines, p), found, speed)
    point = curve.begin(found, speed, -1.0)
    off = point.tangent.copy()
    off[2 * point.z.shape[1]] += 1.0
    size = math.hypot(float(np.linalg.norm(off)), point.slope)
    wrong = replace(point, tangent=off / size, slope=point.slope / size)
    assert all(curve.step(wrong, length) is None for length in (1e-2, 1e-3, 1e-4))  # no shorter step mends it
    points = list(follow(curve, wrong, 7900 * RPM, speed, 2.0, 4))
    assert len(points) == 4
    for p in points:
        alone = newton(problem.balance(lines, p.parameter), problem.standing(lines), tolerance=1e-10)
        np.testing.assert_allclose(p.z, alone.z, rtol=0, atol=1e-8 * np.abs(alone.z).max())


def test_multipliers_of_a_map_are_those_of_its_motions() -> None:
    """A map takes fewer samples of a passage and leaves out what the bearings do not feel; 1e-3 is asked."""
    data = made(7900, 8000, points=2)
    alone = steady_state(rotors.held_jis_rotor(), rpm=8000, record=RECORD, harmonics=12)
    last = int(np.argmax(data["speed"].values))
    assert float(data["multiplier"][last]) == pytest.approx(alone.attrs["multiplier"], abs=3e-4)


def test_searches_from_both_ends_meet_in_one_branch() -> None:
    data = made(6000, 9000, points=8)
    assert set(data["branch"].values) == {0}
    rpm = data["speed"].values / RPM
    assert np.ptp(rpm) == pytest.approx(3000.0)
    # in order along the branch, the place where they met told once
    assert (np.diff(rpm) < 0.0).all()
    assert math.sqrt(6000 * 9000) == pytest.approx(rpm[np.abs(rpm - math.sqrt(6000 * 9000)).argmin()])


def test_a_step_against_both_tangents_is_none() -> None:
    def point(parameter: float, slope: float) -> SimpleNamespace:
        return SimpleNamespace(parameter=parameter, slope=slope)

    assert backwards(point(1.0, 0.1), point(0.9, 0.2))  # two folds were leapt over
    assert not backwards(point(1.0, 0.1), point(1.1, 0.2))
    assert not backwards(point(1.0, 0.1), point(0.9, -0.2))  # round a fold
    assert not backwards(point(1.0, -0.1), point(0.9, -0.2))


@pytest.mark.parametrize("end", [1.0, -2.0])
def test_an_event_is_located_where_its_test_leaps_before_it(end: float) -> None:
    """A multiplier that is none up to 0.3, and crosses at 0.37: secants from −1 come to rest beside it."""

    def point(s: float) -> Point:
        return Point(np.array([[0j]]), s, None, 0.0, 0, np.zeros(2), 1.0)  # type: ignore[arg-type]

    tried = []

    def step(_: Point, s: float, exact: bool) -> Point:
        assert exact
        tried.append(s)
        return point(s)

    curve = SimpleNamespace(step=step, scale=1.0, size=1.0)
    sign = math.copysign(1.0, end)
    found = locate(
        curve,  # type: ignore[arg-type]
        point(0.0),
        point(end),
        lambda p: (
            -1.0
            if sign * p.parameter < 0.3
            else (sign * p.parameter - 0.37) ** 3 + 0.01 * (sign * p.parameter - 0.37)
        ),
        1e-6,
    )
    assert found is not None
    assert found.parameter == pytest.approx(sign * 0.37, abs=1e-6)
    assert len(tried) < 40


def test_bad_input_is_named_before_work() -> None:
    eq = equilibrium(rotors.held_jis_rotor())
    for speeds, message in (
        ((0.0, 100.0), "the lowest must be positive"),
        ((200.0, 100.0), "the first must be below the second"),
        ((math.nan, 100.0), "speeds"),
    ):
        with pytest.raises(ValueError, match=message):
            speed_map(eq, speeds=speeds, record=RECORD)
    with pytest.raises(ValueError, match="a map records motions"):
        speed_map(eq, speeds=(400.0, 500.0), record=["ball.loaded"])
    with pytest.raises(ValueError, match="speed is 0"):
        parameter_map(rotors.held_jis_rotor, values=(1e-5, 2e-5), speed=0.0, record=RECORD)
    unbalanced: Application = rotors.held_jis_rotor()
    unbalanced.unbalance("rotor.centre", 1e-6)
    with pytest.raises(ValueError, match="a map follows motions of one"):
        speed_map(unbalanced, speeds=(400.0, 500.0), record=RECORD)


def test_a_figure_shows_branches_stability_and_events(hysteresis: xarray.Dataset) -> None:
    ax = plot.speed_map(hysteresis, "rotor.centre.x")
    drawn = {line.get_label(): line for line in ax.get_lines() if not line.get_label().startswith("_")}
    assert {"stable", "unstable", "fold", "flip"} <= drawn.keys()
    assert drawn["fold"].get_xdata() == pytest.approx([5229.2], abs=0.3)
    assert drawn["unstable"].get_linestyle() == "--"
    with pytest.raises(ValueError, match="channel is 'rotor'"):
        plot.speed_map(hysteresis, "rotor")
    lines = plot.speed_waterfall(hysteresis, "rotor.centre.y").collections[0].get_offsets()
    # the passage is 3.0846 times the shaft (§3.6), and nothing lies below it
    assert (lines[:, 1] / (lines[:, 0] / 60)).min() == pytest.approx(3.0846, abs=1e-4)
    plt.close("all")


def test_a_map_says_at_which_points_it_wants_more_harmonics() -> None:
    """As a steady state does, whose estimate it is; at the harmonics of the other tests no point does."""
    with pytest.warns(
        CutHarmonics, match=r"the motion at \d+\.?\d* rad/s, one of \d+ points of \d+, wants"
    ) as told:
        few = made(4650, 4750, harmonics=1, points=4)
    assert len(told) == 1
    i = int(few["cut"].values[:, 0].argmax())
    with pytest.warns(CutHarmonics):
        one = steady_state(
            equilibrium(rotors.held_jis_rotor()), speed=float(few["speed"][i]), record=RECORD, harmonics=1
        )
    # the same lines, balanced on other samples: 48 of a passage there
    assert few["cut"].values[i] == pytest.approx(one["cut"].values, rel=0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("error", CutHarmonics)
        assert (made(4650, 4750, points=4)["cut"].values < 1e-2 * few["cut"].values.max()).all()
