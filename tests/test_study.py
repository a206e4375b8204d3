"""Studies: order, failures kept, resumption, spawned workers, the Pareto front."""

from __future__ import annotations

import functools
import json
import math
import os
import signal
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from bearingdyn import core, results, study


def natural_frequency(case):
    """f = √(k/m)/2π of one mass on one spring."""
    if case["m"] <= 0:
        raise ValueError(f"m is {case['m']}; it must be positive")
    return {"f": math.sqrt(case["k"] / case["m"]) / (2 * math.pi)}


def threads_and_environment(case):
    """Threads of this process after BLAS has worked, and what its environment says."""
    A = np.ones((300, 300)) * case["x"]
    _ = A @ A
    return {
        "threads": len(os.listdir("/proc/self/task")) if Path("/proc/self/task").is_dir() else 1,
        "allowed": float(os.environ["OPENBLAS_NUM_THREADS"]),
        "pid": os.getpid(),
    }


def fails_as_a_march_does(case):
    """A SolverError holds a report and cannot be rebuilt from its message alone."""
    raise core.SolverError("diverged", core.Report(-6, 7, 40, 0, 0, 0, 1e-3, 0.5, 0))


def dies(case):
    os.kill(os.getpid(), signal.SIGKILL)


class Counter:
    """Counts its calls, and fails from the given one on."""

    def __init__(self, fail_at=math.inf):
        self.calls = 0
        self.fail_at = fail_at

    def __call__(self, case):
        self.calls += 1
        if self.calls >= self.fail_at:
            raise RuntimeError("power cut")
        return {"y": case["x"] ** 2}


def one_thread():
    return ThreadPoolExecutor(1)


def test_grid_holds_every_combination_once_last_axis_fastest():
    cases = study.grid(a=[1, 2], b=["u", "v", "w"])
    assert [(c["a"], c["b"]) for c in cases] == [(1, "u"), (1, "v"), (1, "w"), (2, "u"), (2, "v"), (2, "w")]


@pytest.mark.parametrize("axes", [{}, {"a": []}, {"a": [1], "b": []}])
def test_empty_grid_is_refused(axes):
    with pytest.raises(ValueError, match="at least one"):
        study.grid(**axes)


def test_spawned_workers_give_results_in_order_and_keep_failures():
    masses = [4.0, 0.0, 1.0, 0.25]
    seen = []
    cases = study.sweep(
        natural_frequency,
        study.grid(k=[100.0], m=masses),
        progress=lambda done, total: seen.append((done, total)),
    )
    assert [c.parameters["m"] for c in cases] == masses
    # one operation after another in double precision: the same expression gives the same bits
    assert [c.values.get("f") for c in cases] == [
        None if m == 0 else math.sqrt(100.0 / m) / (2 * math.pi) for m in masses
    ]
    assert cases[1].error == "ValueError: m is 0.0; it must be positive"
    assert [c.error for c in cases if c.parameters["m"] > 0] == [None] * 3
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]


def test_spawned_workers_run_blas_with_one_thread_and_the_environment_is_left_alone():
    before = dict(os.environ)
    cases = study.sweep(threads_and_environment, study.grid(x=[1.0, 2.0]))
    assert [c.error for c in cases] == [None, None]
    assert {c.values["allowed"] for c in cases} == {1.0}
    assert {c.values["threads"] for c in cases} == {1.0}
    assert os.getpid() not in {c.values["pid"] for c in cases}
    assert dict(os.environ) == before


def test_exception_that_cannot_be_sent_back_is_kept_in_words():
    (case,) = study.sweep(fails_as_a_march_does, [{"x": 1.0}])
    assert case.error == "SolverError: diverged"


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a process that can be killed")
def test_death_of_a_worker_says_what_may_be_wrong():
    with pytest.raises(BrokenExecutor) as caught:
        study.sweep(dies, [{"x": 1.0}])
    assert "__main__" in caught.value.__notes__[0]


def test_interrupted_study_computes_only_what_is_missing(tmp_path):
    cases = study.grid(x=[0.1, 0.2, 0.3, 0.4])
    first = Counter(fail_at=3)
    with one_thread() as pool:
        before = study.sweep(first, cases, pool, store=tmp_path / "study")
    assert [c.error for c in before] == [None, None, "RuntimeError: power cut", "RuntimeError: power cut"]
    second, seen = Counter(), []
    with one_thread() as pool:
        after = study.sweep(
            second, cases, pool, store=tmp_path / "study", progress=lambda n, total: seen.append(n)
        )
    assert second.calls == 2
    assert seen == [2, 3, 4]
    assert [c.values["y"] for c in after] == [x**2 for x in (0.1, 0.2, 0.3, 0.4)]  # exact through JSON
    third = Counter()
    with one_thread() as pool:
        assert study.sweep(third, cases, pool, store=tmp_path / "study") == after
    assert third.calls == 0


def test_store_holds_one_readable_file_per_case_and_nothing_else(tmp_path):
    with one_thread() as pool:
        study.sweep(Counter(), study.grid(x=[1.0, 2.0]), pool, store=tmp_path)
    kept = [json.loads(p.read_text()) for p in tmp_path.iterdir()]
    assert sorted(k["parameters"]["x"] for k in kept) == [1.0, 2.0]
    assert {k["function"] for k in kept} == {"Counter"}


def test_half_written_file_of_a_store_is_computed_again(tmp_path, caplog):
    with one_thread() as pool:
        study.sweep(Counter(), [{"x": 3.0}], pool, store=tmp_path)
    (path,) = tmp_path.iterdir()
    path.write_text(path.read_text()[:20])
    again = Counter()
    with one_thread() as pool:
        (case,) = study.sweep(again, [{"x": 3.0}], pool, store=tmp_path)
    assert (again.calls, case.values) == (1, {"y": 9.0})
    assert "computed again" in caplog.text


def test_infinite_and_missing_numbers_survive_the_store(tmp_path):
    for _ in range(2):
        with one_thread() as pool:
            (case,) = study.sweep(undefined, [{"x": math.inf}], pool, store=tmp_path)
        assert case.values["up"] == math.inf
        assert math.isnan(case.values["none"])


def undefined(case):
    return {"up": case["x"], "none": np.float64("nan")}


def test_store_of_another_function_is_refused(tmp_path):
    with one_thread() as pool:
        study.sweep(Counter(), [{"x": 1.0}], pool, store=tmp_path)
        with pytest.raises(ValueError, match="'Counter', not 'undefined'"):
            study.sweep(undefined, [{"x": 1.0}], pool, store=tmp_path)


@pytest.mark.parametrize(
    ("cases", "message"),
    [
        ([], "at least one case"),
        ([{"x": math.nan}], "case 0: parameter 'x' is nan"),
        ([{"x": 1.0}, {"x": [1.0]}], r"case 1: parameter 'x' is \[1.0\]"),
        ([{"x": 1.0}, {"y": 1.0}], r"case 1 has the parameters \['y'\]"),
        ([{"x": 1.0}, {"x": "wide"}], "case 1: parameter 'x' is 'wide'"),
    ],
)
def test_bad_cases_are_refused_before_any_work(cases, message):
    counter = Counter()
    with one_thread() as pool, pytest.raises(ValueError, match=message):
        study.sweep(counter, cases, pool)
    assert counter.calls == 0


def test_function_that_no_other_process_can_import_is_refused():
    with pytest.raises(ValueError, match="top level of a module"):
        study.sweep(lambda case: {"y": 1.0}, [{"x": 1.0}])


@pytest.mark.parametrize("returned", [1.0, {"y": "wide"}, {"y": 1j}, {"y": [1.0]}, None])
def test_function_that_returns_no_numbers_fails_in_its_case(returned):
    with one_thread() as pool:
        (case,) = study.sweep(functools.partial(constant, returned), [{"x": 1.0}], pool)
    assert case.error is not None
    assert case.error.startswith("TypeError")


def constant(value, case):
    return value


def test_table_has_parameters_as_coordinates_and_failures_as_nan(tmp_path):
    cases = [
        study.Case({"k": 1.0, "rubber": "soft"}, {"f": 2.0}),
        study.Case({"k": 2.0, "rubber": "hard"}, {}, "ValueError: no"),
    ]
    table = study.table(cases)
    results.save(table, tmp_path / "study.nc")
    for data in (table, results.load(tmp_path / "study.nc")):
        assert data["f"].dims == ("case",)
        np.testing.assert_array_equal(data["f"], [2.0, math.nan])
        assert data["rubber"].values.tolist() == ["soft", "hard"]
        assert data["error"].values.tolist() == ["", "ValueError: no"]


def test_value_with_the_name_of_a_parameter_is_refused():
    with pytest.raises(ValueError, match="value 'k' has the name"):
        study.table([study.Case({"k": 1.0}, {"k": 2.0})])


def test_pareto_front_of_a_known_set():
    """By hand: (1, 5), (2, 3), (4, 1) are the front, (2, 4) loses to (2, 3), (4, 3) to two, NaN to none."""
    points = [(1, 5), (2, 4), (2, 3), (4, 3), (4, 1), (math.nan, 0), (2, 3)]
    table = study.table([study.Case({"i": i}, {"a": a, "b": b}) for i, (a, b) in enumerate(points)])
    expected = [True, False, True, False, True, False, True]
    assert study.pareto(table, minimise=["a", "b"])["front"].values.tolist() == expected
    mirrored = table.assign(b=-table["b"])
    assert study.pareto(mirrored, minimise=["a"], maximise=["b"])["front"].values.tolist() == expected


def test_pareto_of_one_aim_is_its_minimum_and_a_parameter_may_be_an_aim():
    table = study.table([study.Case({"w": w}, {"a": a}) for w, a in ((3, 1.0), (1, 2.0), (2, 1.0))])
    assert study.pareto(table, minimise=["a"])["front"].values.tolist() == [True, False, True]
    assert study.pareto(table, minimise=["a", "w"])["front"].values.tolist() == [False, True, True]


@pytest.mark.parametrize(
    ("aims", "message"),
    [({}, "at least one"), ({"minimise": ["z"]}, "'z' is no number"), ({"minimise": ["error"]}, "no number"),
     ({"minimise": ["a"], "maximise": ["a"]}, "named twice")],
)  # fmt: skip
def test_bad_aims_are_refused(aims, message):
    table = study.table([study.Case({"w": 1.0}, {"a": 1.0})])
    with pytest.raises(ValueError, match=message):
        study.pareto(table, **aims)
