"""Studies: order, failures kept, resumption, spawned workers, the Pareto front."""

from __future__ import annotations

import dataclasses
import functools
import json
import math
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
import types
import warnings
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import core, results, study
from bearingdyn.notice import ChangedFunction
from bearingdyn.study import chunks, store


def kept_rows(folder: Path) -> list[dict[str, object]]:
    """Rows of a store, as they stand in its file."""
    with closing(sqlite3.connect(folder / store.FILE, timeout=60)) as file:
        file.row_factory = sqlite3.Row
        try:
            return [dict(row) for row in file.execute("SELECT * FROM cases")]
        except sqlite3.OperationalError:  # just made, and still without tables
            return []


def damage(folder: Path, **columns: object) -> None:
    """Write other content into all rows of a store."""
    with closing(sqlite3.connect(folder / store.FILE)) as file, file:
        for name, value in columns.items():
            file.execute(f'UPDATE cases SET "{name}" = ?', (value,))


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
    """Counts its calls, and fails from the given one on; all of them are one function to a store."""

    told_as = "Counter"

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


class LosesEverySecond(Executor):
    """An executor that reports a lost task as an error of its own, as a cluster does."""

    def __init__(self):
        self.count = 0

    def submit(self, function, /, *args, **kwargs):
        self.count += 1
        future = Future()
        if self.count % 2:
            future.set_result(function(*args, **kwargs))
        else:
            future.set_exception(RuntimeError("the worker is gone"))
        return future


def test_case_that_the_executor_lost_fails_alone():
    cases = study.sweep(Counter(), study.grid(x=[1.0, 2.0, 3.0]), LosesEverySecond())
    assert [c.values.get("y") for c in cases] == [1.0, None, 9.0]
    assert cases[1].error == "RuntimeError: the worker is gone"


def test_cancelled_study_is_no_result(tmp_path):
    class Cancels(LosesEverySecond):
        def submit(self, function, /, *args, **kwargs):
            future = super().submit(function, *args, **kwargs) if self.count == 0 else Future()
            future.cancel()
            future.set_running_or_notify_cancel() if future.cancelled() else None
            return future

    with pytest.raises(CancelledError):
        study.sweep(Counter(), study.grid(x=[1.0, 2.0]), Cancels(), store=tmp_path)
    assert len(kept_rows(tmp_path)) == 1  # what was finished is kept


def test_interrupted_study_computes_only_what_is_missing(tmp_path):
    cases = study.grid(x=[0.1, 0.2, 0.3, 0.4])
    first = Counter(fail_at=3)
    with one_thread() as pool:
        before = study.sweep(first, cases, pool, store=tmp_path / "study")
    assert [c.error for c in before] == [None, None, "RuntimeError: power cut", "RuntimeError: power cut"]
    again = Counter()
    with one_thread() as pool:
        assert study.sweep(again, cases, pool, store=tmp_path / "study") == before  # failures are kept too
    assert again.calls == 0
    second, seen = Counter(), []
    with one_thread() as pool:
        after = study.sweep(
            second, cases, pool, store=tmp_path / "study", retry=True,
            progress=lambda n, total: seen.append(n),
        )  # fmt: skip
    assert second.calls == 2
    assert seen == [2, 3, 4]
    assert [c.values["y"] for c in after] == [x**2 for x in (0.1, 0.2, 0.3, 0.4)]  # exact through JSON
    third = Counter()
    with one_thread() as pool:
        assert study.sweep(third, cases, pool, store=tmp_path / "study") == after
    assert third.calls == 0


def test_store_holds_one_readable_row_per_case_in_one_file(tmp_path):
    with one_thread() as pool:
        study.sweep(Counter(), study.grid(x=[1.0, 2.0]), pool, store=tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [store.FILE]  # no journal is left
    kept = kept_rows(tmp_path)
    assert sorted(json.loads(k["parameters"])["x"] for k in kept) == [1.0, 2.0]
    assert sorted(json.loads(k["values"])["y"] for k in kept) == [1.0, 4.0]
    (told,) = study.status(tmp_path)
    assert (told.function, told.version) == (f"{__name__}.Counter", results.versions()["bearingdyn"])


def test_damaged_row_of_a_store_is_computed_again(tmp_path, caplog):
    with one_thread() as pool:
        study.sweep(Counter(), [{"x": 3.0}], pool, store=tmp_path)
    damage(tmp_path, values='{"y": 9')
    again = Counter()
    with one_thread() as pool:
        (case,) = study.sweep(again, [{"x": 3.0}], pool, store=tmp_path)
    assert (again.calls, case.values) == (1, {"y": 9.0})
    assert "computed again" in caplog.text


SCRIPT = """
import sys, time
from bearingdyn import study

def square(case):
    time.sleep(0.05)
    return {"y": case["x"] ** 2}

if __name__ == "__main__":
    cases = study.sweep(square, study.grid(x=[float(i) for i in range(30)]), store=sys.argv[1])
    print(sum(case.values["y"] for case in cases))
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a process that can be killed")
def test_study_killed_outright_goes_on_where_it_stopped(tmp_path):
    script, folder = tmp_path / "squares.py", tmp_path / "store"
    script.write_text(SCRIPT)
    command = [sys.executable, str(script), str(folder)]
    with subprocess.Popen(command, start_new_session=True) as process:
        while not (folder / store.FILE).exists() or len(kept_rows(folder)) < 5:
            assert process.poll() is None
            time.sleep(0.01)
        os.killpg(process.pid, signal.SIGKILL)  # its workers with it
    before = kept_rows(folder)
    assert 5 <= len(before) < 30
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert float(run.stdout) == sum(x**2 for x in range(30))
    after = {row["id"]: row for row in kept_rows(folder)}
    assert len(after) == 30
    assert all(after[row["id"]] == row for row in before)  # the times too: not computed again


def test_infinite_and_missing_numbers_survive_the_store(tmp_path):
    for _ in range(2):
        with one_thread() as pool:
            (case,) = study.sweep(undefined, [{"x": math.inf}], pool, store=tmp_path)
        assert case.values["up"] == math.inf
        assert math.isnan(case.values["none"])


def undefined(case):
    return {"up": case["x"], "none": np.float64("nan")}


@dataclasses.dataclass(frozen=True)
class Power:
    """A function with a number of its own."""

    n: int

    def __call__(self, case):
        return {"y": case["x"] ** self.n}


def scaled(factor, case):
    return {"y": factor * case["x"]}


def test_store_tells_functions_and_what_is_bound_into_them_apart(tmp_path):
    functions = [
        Power(2),
        Power(3),
        functools.partial(scaled, 5.0),
        functools.partial(scaled, 7.0),
        Counter(),
    ]
    for _ in range(2):
        with one_thread() as pool:
            found = [study.sweep(f, [{"x": 2.0}], pool, store=tmp_path)[0].values["y"] for f in functions]
        assert found == [4.0, 8.0, 10.0, 14.0, 4.0]
    assert functions[-1].calls == 1
    assert len(kept_rows(tmp_path)) == 5


def test_store_of_another_version_is_computed_again(tmp_path, monkeypatch):
    for version in ("1", "2", "2"):
        monkeypatch.setattr(store, "versions", lambda version=version: {"bearingdyn": version})
        with one_thread() as pool:
            study.sweep(Counter(), [{"x": 2.0}], pool, store=tmp_path)
    assert len(kept_rows(tmp_path)) == 2
    assert sorted(told.version for told in study.status(tmp_path)) == ["1", "2"]


def radial(case):
    return {"k": float(case["layer"].stiffness()[0, 0].real) * case["factor"].sum()}


def test_parts_and_arrays_are_parameters_told_by_their_content(tmp_path):
    def cases():
        layers = [bd.Layer(0.026, 0.028, w, bd.Elastic(3e6, 0.49, 1200.0)) for w in (0.01, 0.02)]
        return study.grid(layer=layers, factor=[np.ones(3), np.arange(3.0)])

    with one_thread() as pool:
        first = study.sweep(radial, cases(), pool, store=tmp_path)
        assert len(kept_rows(tmp_path)) == 4
        again = study.sweep(Counter(), cases(), pool)  # fails: what comes from the store does not call it
        kept = study.sweep(radial, cases(), pool, store=tmp_path)
    assert [c.values for c in kept] == [c.values for c in first]
    assert all(c.error for c in again)
    assert first[2].values["k"] > first[0].values["k"]  # wider is stiffer
    table = study.table(first)
    results.save(table, tmp_path / "study.nc")
    assert len(set(table["layer"].values.tolist())) == 2
    assert table["layer"].values[0].startswith("Layer ")


def test_bar_goes_to_standard_error(capsys):
    with one_thread() as pool:
        study.sweep(Counter(), study.grid(x=[1.0, 2.0]), pool, progress=True)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "2/2" in captured.err


def test_sobol_fills_the_box_evenly_and_again_the_same():
    """Of 2^m points of a Sobol sequence in base 2 each dyadic interval of 1/2^m holds one, in every axis."""
    cases = study.sobol(16, 3, width=(0.01, 0.02), modulus=(1e5, 1e7, "log"))
    assert cases == study.sobol(16, 3, width=(0.01, 0.02), modulus=(1e5, 1e7, "log"))
    assert cases != study.sobol(16, 4, width=(0.01, 0.02), modulus=(1e5, 1e7, "log"))
    width = [(c["width"] - 0.01) / 0.01 for c in cases]
    modulus = [math.log10(c["modulus"] / 1e5) / 2 for c in cases]
    for x in (width, modulus):
        assert sorted(math.floor(16 * value) for value in x) == list(range(16))
    assert study.sobol(8, 3, width=(0.01, 0.02), modulus=(1e5, 1e7, "log")) == cases[:8]


@pytest.mark.parametrize(
    ("n", "ranges", "message"),
    [(0, {"a": (0, 1)}, "one case or more"), (4, {}, "at least one range"), (4, {"a": (1, 1)}, "low must be"),
     (4, {"a": (0, 1, "log")}, "above 0"), (4, {"a": (1, 2, "lin")}, "range 'a'"),
     (4, {"a": (0, math.nan)}, "low must be")],
)  # fmt: skip
def test_bad_sobol_is_refused(n, ranges, message):
    with pytest.raises(ValueError, match=message):
        study.sobol(n, **ranges)


@pytest.mark.parametrize(
    ("cases", "message"),
    [
        ([], "at least one case"),
        ([{"x": math.nan}], "case 0: parameter 'x' is nan"),
        ([{"x": 1.0}, {"x": [1.0]}], r"case 1: parameter 'x' is \[1.0\]"),
        ([{"x": None}], "case 0: parameter 'x' is None"),
        ([{"x": object()}], "case 0: parameter 'x': .*cannot be told by its content"),
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
    for data in (table, results.open_result(tmp_path / "study.nc")):
        assert data["f"].dims == ("case",)
        np.testing.assert_array_equal(data["f"], [2.0, math.nan])
        assert data["rubber"].values.tolist() == ["soft", "hard"]
        assert data["error"].values.tolist() == ["", "ValueError: no"]


def test_table_carries_units_and_becomes_a_frame():
    cases = [study.Case({"k": float(i)}, {"f": 2.0 * i}) for i in range(3)]
    table = study.table(cases, {"k": "N/m", "f": "Hz"})
    assert (table["k"].attrs["units"], table["f"].attrs["units"]) == ("N/m", "Hz")
    with pytest.raises(ValueError, match="'z', which is not a column"):
        study.table(cases, {"z": "m"})
    pytest.importorskip("pandas")
    frame = table.to_dataframe()
    assert frame["f"].tolist() == [0.0, 2.0, 4.0]
    assert frame["k"].tolist() == [0.0, 1.0, 2.0]


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
    [
        ({}, "at least one"),
        ({"minimise": ["z"]}, "'z' is not a number"),
        ({"minimise": ["error"]}, "not a number"),
        ({"minimise": ["a"], "maximise": ["a"]}, "named twice"),
    ],
)
def test_bad_aims_are_refused(aims, message):
    table = study.table([study.Case({"w": 1.0}, {"a": 1.0})])
    with pytest.raises(ValueError, match=message):
        study.pareto(table, **aims)


class Rig:
    """A bench with a stiffness of its own."""

    def __init__(self, k):
        self.k = k

    def run(self, case):
        return {"f": math.sqrt(self.k / case["m"])}

    def __call__(self, case):
        return self.run(case)


STIFFNESS = 100.0


def by_default(case, k=100.0):
    return {"f": math.sqrt(k / case["m"])}


def with_global(case):
    return {"f": math.sqrt(STIFFNESS / case["m"])}


def through_another(case):
    return with_global(case)


def closed_over(k):
    def run(case):
        return {"f": math.sqrt(k / case["m"])}

    return run


def stored(function, folder):
    with one_thread() as pool:
        return study.sweep(function, [{"m": 1.0}], pool, store=folder)[0].values["f"]


def retuned(k):
    changed = types.FunctionType(by_default.__code__, globals(), "by_default", (k,))
    changed.__module__, changed.__qualname__ = __name__, "by_default"
    return changed


@pytest.mark.parametrize(
    "make",
    [
        lambda k: Rig(k).run,
        Rig,
        closed_over,
        lambda k: functools.partial(by_default, k=k),
        lambda k: functools.partial(Rig(k).run),
        retuned,
        lambda k: (
            (lambda case: {"f": math.sqrt(100.0)}) if k == 100.0 else lambda case: {"f": math.sqrt(500.0)}
        ),
        lambda k: lambda case: Rig(k).run(case),
    ],
)
def test_a_store_tells_apart_what_a_function_carries(tmp_path, make):
    """ω = √(k/m) of two stiffnesses, asked for twice."""
    for _ in range(2):
        assert [stored(make(k), tmp_path) for k in (100.0, 500.0)] == [10.0, math.sqrt(500.0)]
    assert len(kept_rows(tmp_path)) == 2


@pytest.mark.parametrize("function", [with_global, through_another])
def test_a_global_that_a_function_uses_counts(tmp_path, monkeypatch, function):
    assert stored(function, tmp_path) == 10.0
    monkeypatch.setitem(globals(), "STIFFNESS", 400.0)
    assert stored(function, tmp_path) == 20.0


def test_what_cannot_be_told_is_refused_with_the_remedy(tmp_path):
    lock = threading.Lock()

    def run(case):
        with lock:
            return {"f": 1.0}

    with pytest.raises(ValueError, match=r"uses 'lock' from around it.*told_as.*leave store out"):
        stored(run, tmp_path / "none")
    assert not (tmp_path / "none").exists()


def test_a_stored_key_is_compared(tmp_path, caplog):
    assert stored(Rig(100.0), tmp_path) == 10.0
    wrong = json.dumps({"f": -1.0})
    for change in (
        {"parameters": "{}", "values": wrong}, {"values": json.dumps({"f": 10**400})}, {"values": "5"},
        {"values": "[" * 100_000}, {"values": None},
    ):  # fmt: skip
        damage(tmp_path, **change)
        caplog.clear()
        assert stored(Rig(100.0), tmp_path) == 10.0
        assert "computed again" in caplog.text
    damage(tmp_path, study="0" * 32, values=wrong)  # of another function or version
    assert stored(Rig(100.0), tmp_path) == 10.0


def test_what_is_no_store_is_named(tmp_path):
    (tmp_path / store.FILE).write_bytes(b"no database at all, but a text " * 50)
    with pytest.raises(ValueError, match=r"cases\.sqlite cannot be used .*give another folder"):
        stored(Rig(100.0), tmp_path)
    with pytest.raises(ValueError, match="cannot be used"):
        study.status(tmp_path)
    with pytest.raises(ValueError, match=r"holds no cases\.sqlite"):
        study.status(tmp_path / "none")
    with pytest.raises(ValueError, match="store is 5"):
        study.status(5)


def test_status_tells_how_far_a_study_is_and_how_long_it_will_take(tmp_path):
    cases, seen = study.grid(x=[float(x) for x in range(1, 9)]), []

    def look(done, total):
        time.sleep(0.02)
        seen.append(study.status(tmp_path)[0])

    with one_thread() as pool:
        study.sweep(Counter(), cases[:2], pool, store=tmp_path)
        study.sweep(Counter(fail_at=4), cases, pool, store=tmp_path, progress=look)
    assert [told.ahead for told in seen[1:]] == [5, 4, 3, 2, 1, 0]  # the first two lay there
    assert {told.asked for told in seen[1:]} == {8}
    assert [told.done + told.failed for told in seen[1:]] == [3, 4, 5, 6, 7, 8]
    assert seen[-1].failed == 3
    assert math.isnan(seen[1].seconds_left)
    paces = [told.seconds_left / told.ahead for told in seen[2:-1]]
    assert all(pace >= 0.02 for pace in paces)  # what a case waits for `look`
    assert str(seen[3]).endswith(f"about {seen[3].seconds_left:.0f} s")
    assert str(seen[-1]) == f"{__name__}.Counter: 8 of 8 cases, 3 failed, complete"


def test_quick_cases_travel_in_chunks_and_come_back_in_order(tmp_path):
    """Ten thousand: far fewer submissions, each case once."""
    submitted = []

    class Counted(ThreadPoolExecutor):
        def submit(self, function, /, *args, **kwargs):
            submitted.append(len(args[1]))
            return super().submit(function, *args, **kwargs)

    counter = Counter()
    with Counted(1) as pool:
        found = study.sweep(counter, study.grid(x=[float(x) for x in range(10_000)]), pool, store=tmp_path)
    assert [case.values["y"] for case in found] == [float(x) ** 2 for x in range(10_000)]
    assert counter.calls == sum(submitted) == len(kept_rows(tmp_path)) == 10_000
    assert len(submitted) < 3000  # the first window goes case by case


def test_a_worker_of_another_version_is_refused(tmp_path):
    """A process whose package says another version."""
    with pytest.raises(RuntimeError, match=r"has bearingdyn other where the study was begun with"):
        study.sweep(natural_frequency, [{"k": 1.0, "m": 1.0}], OtherVersion(), store=tmp_path)
    assert not list(tmp_path.iterdir())


class OtherVersion(Executor):
    """Computes as another process would, with another version of the package."""

    def submit(self, function, /, *args, **kwargs):
        future = Future()
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "getpid", lambda: -1)
            patch.setattr(chunks, "versions", lambda: {"bearingdyn": "other"})
            try:
                future.set_result(function(*args, **kwargs))
            except Exception as error:
                future.set_exception(error)
        return future


def leaves(case):
    sys.exit("enough")


def test_an_exit_in_a_case_fails_the_case():
    with one_thread() as pool:
        (case,) = study.sweep(leaves, [{"x": 1.0}], pool)
    assert case.error == "SystemExit: enough"
    assert study.sweep(leaves, [{"x": 1.0}])[0].error == "SystemExit: enough"


def test_studies_in_threads_share_a_store(tmp_path):
    cases = study.grid(m=[float(m) for m in range(1, 40)])

    def whole(_):
        with ThreadPoolExecutor(4) as pool:
            return study.sweep(Rig(100.0), cases, pool, store=tmp_path)

    with ThreadPoolExecutor(6) as pool:
        first, *others = pool.map(whole, range(6))
    assert all(other == first for other in others)
    assert len(kept_rows(tmp_path)) == 39
    assert [path.name for path in tmp_path.iterdir()] == [store.FILE]  # no scratch file is left


UNGUARDED = SCRIPT.replace('if __name__ == "__main__":', "if True:")


def test_a_missing_guard_is_one_sentence(tmp_path):
    script = tmp_path / "squares.py"
    script.write_text(UNGUARDED)
    run = subprocess.run(
        [sys.executable, str(script), str(tmp_path / "store")], capture_output=True, text=True, timeout=60
    )
    assert run.returncode == 1
    assert run.stderr.count("Traceback") == 1
    assert run.stderr.splitlines()[-1].startswith(
        f"ValueError: {script}, line 10 calls sweep outside `if __name__"
    )


@pytest.mark.parametrize("alien", [5, "6205", [None], [5], {"a": 5}, object(), study.Case])
def test_a_table_refuses_what_is_no_list_of_cases(alien: object) -> None:
    with pytest.raises(ValueError, match="cases is "):
        study.table(alien)
    with pytest.raises(ValueError, match="units is "):
        study.table([study.Case({"k": 1.0}, {"m": 1.0})], units=alien if not isinstance(alien, dict) else 5)


FACTOR = 1.0


def times_the_global(case):
    return {"y": FACTOR * case["x"]}


def times_its_default(case, factor=2.0):
    return {"y": factor * case["x"]}


@pytest.mark.parametrize("change", ["global", "default"])
def test_a_function_changed_after_its_import_is_told_of_and_not_stored(change, monkeypatch, tmp_path):
    """Spawned workers import the module afresh, with the values that stand in its file."""
    function, old = (times_the_global, 1.0) if change == "global" else (times_its_default, 2.0)
    if change == "global":
        monkeypatch.setitem(function.__globals__, "FACTOR", 5.0)
    else:
        monkeypatch.setattr(function, "__defaults__", (5.0,))
    with pytest.warns(ChangedFunction, match="was changed after its module was imported"):
        found = study.sweep(function, [{"x": 1.0}, {"x": 2.0}], store=tmp_path, progress=False)
    assert [case.values["y"] for case in found] == [old, 2 * old]
    assert not list(tmp_path.iterdir())
    with ThreadPoolExecutor(1) as threads, warnings.catch_warnings():
        warnings.simplefilter("error")
        here = study.sweep(function, [{"x": 1.0}], threads, store=tmp_path, progress=False)
    assert here[0].values["y"] == 5.0


def test_an_unchanged_function_is_sent_without_a_word(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = study.sweep(times_the_global, [{"x": 1.0}], store=tmp_path, progress=False)
    assert found[0].values["y"] == 1.0
    assert len(kept_rows(tmp_path)) == 1


SEEN: dict[tuple[float, str], float] = {}
LOG: list[float] = []


def remembered(case):
    key = (case["x"], "square")
    if key not in SEEN:
        SEEN[case["x"], "square"] = FACTOR * case["x"] ** 2
        LOG.append(case["x"])
    return {"y": SEEN[key]}


def test_what_a_function_has_kept_of_its_own_calls_is_no_change_of_it(tmp_path, monkeypatch):
    """Called once here, its memory is filled; the workers begin with an empty one, and compute the same."""
    monkeypatch.setitem(remembered.__globals__, "SEEN", {})
    monkeypatch.setitem(remembered.__globals__, "LOG", [])
    assert remembered({"x": 3.0}) == {"y": 9.0}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = study.sweep(remembered, [{"x": 2.0}, {"x": 3.0}], store=tmp_path, progress=False)
    assert [case.values["y"] for case in found] == [4.0, 9.0]
    assert len(kept_rows(tmp_path)) == 2
    # what it only reads counts as before, and so does what it writes where it was not empty at the import
    monkeypatch.setitem(remembered.__globals__, "FACTOR", 5.0)
    with pytest.warns(ChangedFunction):
        study.sweep(remembered, [{"x": 4.0}], progress=False)


STATE = {"k": 100.0, "calls": 0}


def counting(case):
    STATE["calls"] += 1
    return {"y": STATE["k"] * case["x"]}


def test_a_setting_beside_what_a_function_writes_is_still_a_setting(monkeypatch):
    monkeypatch.setitem(counting.__globals__, "STATE", {"k": 500.0, "calls": 0})
    with pytest.warns(ChangedFunction):
        found = study.sweep(counting, [{"x": 1.0}], progress=False)
    assert found[0].values["y"] == 100.0


@pytest.mark.parametrize("relative", [20.0, 2.5])
def test_a_relative_deviation_in_per_cent_is_refused(relative):
    with pytest.raises(ValueError, match=r"LogNormal.relative is .*; is it in per cent\?"):
        study.LogNormal(1e6, relative)


SCRIPT = """
from dataclasses import dataclass
from functools import cache

import numpy as np

from bearingdyn import study

GAINS = np.ones(100)


@dataclass(frozen=True)
class Spring:
    k: float


STIFF = Spring(3.0)


@cache
def gain():
    return float(GAINS.sum())


def helper(x):
    return gain() * STIFF.k * x


def design(case):
    return {"y": helper(case["x"])}


if __name__ == "__main__":
    gain()
    study.sweep(design, [{"x": 1.0}, {"x": 2.0}], store="kept", progress=False)
"""


def test_a_script_that_calls_its_own_functions_is_the_same_in_its_workers(tmp_path):
    """Where it runs it is __main__, in the processes that it spawns __mp_main__."""
    (tmp_path / "script.py").write_text(SCRIPT)
    done = subprocess.run(
        [sys.executable, "-W", "error", "script.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert len(kept_rows(tmp_path / "kept")) == 2


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: study.sweep(len, "abc"), "cases is 'abc'; it must be a list of cases"),
        (lambda: study.sweep(len, {"v": 1}), "cases is {'v': 1}; it must be a list of cases"),
        (
            lambda: study.sweep(len, [{"v": 1}, 5]),
            r"cases\[1\] is 5; it must be a list of cases",
        ),
        (lambda: study.sweep(5, [{"v": 1}]), "function is 5; it must be a function of a case"),
        (lambda: study.optimise(5, {"v": (0, 1)}, minimise="y"), "function is 5; it must be a function"),
        (
            lambda: study.optimise(lambda d: d["v"], {"v": (0, 1)}, minimise="y", starts=1),
            "function is 0.*; it must return {name: value",
        ),
    ],
)
def test_a_study_of_what_is_no_function_or_no_case_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
