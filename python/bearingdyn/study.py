"""Studies: one function over many cases, in many processes, resumed where it was interrupted."""

from __future__ import annotations

import hashlib
import json
import logging
import math
import multiprocessing
import os
import pickle
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import product
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bearingdyn.results import dataset

if TYPE_CHECKING:
    import xarray

Parameter: TypeAlias = bool | int | float | str
Parameters: TypeAlias = Mapping[str, Parameter]
Study: TypeAlias = Callable[[dict[str, Parameter]], Mapping[str, float]]
Progress: TypeAlias = Callable[[int, int], object]

# each worker is one process on one core: a BLAS with threads of its own would only get in the others' way
WORKER_ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1"}
# Windows waits for no more handles than this
MOST_WORKERS = 61

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Case:
    """One case of a study: its parameters, and its values or the error that kept it from them.

    values is empty where error is set; error is the exception's kind and message.
    """

    parameters: Parameters
    values: Mapping[str, float]
    error: str | None = None


def grid(**axes: Iterable[Parameter]) -> list[dict[str, Parameter]]:
    """Every combination of the values of the axes, the last axis running fastest.

    Raises ValueError for an axis without values, or no axis at all.
    """
    if not axes:
        raise ValueError("grid needs at least one axis, such as grid(width=[0.012, 0.016])")
    columns = {name: list(values) for name, values in axes.items()}
    for name, values in columns.items():
        if not values:
            raise ValueError(f"axis {name!r} is empty; give at least one value")
    return [dict(zip(columns, values, strict=True)) for values in product(*columns.values())]


def sweep(
    function: Study,
    cases: Iterable[Parameters],
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
) -> list[Case]:
    """Call a function on every case and gather what it returns, in the order of the cases.

    Parameters
    ----------
    function
        Maps the parameters of a case, a dict, to a mapping of real numbers. An exception it raises is kept in
        the case and the study goes on.
    cases
        Parameters (numbers and strings) by name, the same names in each; `grid` makes them.
    executor
        Any executor of `concurrent.futures`, or one that behaves like it. None: processes, as many as there
        are processors, started afresh ("spawn"), BLAS with one thread in each. These import the function by
        name: it must stand at the top level of a module or script, and a script must call `sweep` below
        ``if __name__ == "__main__":``. Ctrl-C ends the study when the cases being computed are done.
    store
        Folder, made where missing: each finished case is written there at once, as JSON under the hash of its
        parameters, and taken from there when the study is run again. Failed cases are not written and so are
        tried again. A store serves one function and knows only its name: when its code changes, or values
        bound into it, take another folder.
    progress
        Called with (cases done, cases in all) after each.

    Raises
    ------
    ValueError
        Before any work: no cases, unequal names, a parameter that is no number or string, a function that
        other processes cannot import, a store of another function.
    concurrent.futures.BrokenExecutor
        Where a worker process died. What was finished is in the store.
    """
    todo = _checked(cases)
    folder = _Store(Path(store), _name(function)) if store is not None else None
    done: dict[int, Case] = {}
    for index, parameters in enumerate(todo):
        values = folder.read(parameters) if folder else None
        if values is not None:
            done[index] = Case(parameters, values)
    ahead = [index for index in range(len(todo)) if index not in done]
    if progress and done:
        progress(len(done), len(todo))
    if ahead:
        with _pool(executor, function, len(ahead)) as pool:
            for index, case in _run(pool, function, todo, ahead):
                done[index] = case
                if case.error is not None:
                    log.warning("case %d, %s, failed: %s", index, dict(case.parameters), case.error)
                elif folder:
                    folder.write(case)
                if progress:
                    progress(len(done), len(todo))
    return [done[index] for index in range(len(todo))]


def table(cases: Sequence[Case]) -> xarray.Dataset:
    """A study as a Dataset over "case": parameters as coordinates, values and "error" as variables.

    error is "" where there was none. Values of failed cases are NaN.

    Raises ValueError where there are no cases, or a value has the name of a parameter.
    """
    if not cases:
        raise ValueError("a table needs at least one case")
    parameters = list(cases[0].parameters)
    names = list(dict.fromkeys(name for case in cases for name in case.values))
    for name in names:
        if name in (*parameters, "case", "error"):
            raise ValueError(f"value {name!r} has the name of a parameter or of another column; rename it")
    columns = {n: ("case", [c.values.get(n, math.nan) for c in cases], "", n) for n in names}
    errors = np.array([case.error or "" for case in cases], dtype=np.str_)
    made = dataset(
        {**columns, "error": ("case", errors, "", "what kept the case from its values")},
        {"analysis": "study"},
        {"case": (np.arange(len(cases)), "")},
    )
    return made.assign_coords({n: ("case", [case.parameters[n] for case in cases]) for n in parameters})


def pareto(
    study: xarray.Dataset, minimise: Sequence[str] = (), maximise: Sequence[str] = ()
) -> xarray.Dataset:
    """The table with a variable "front", true for the cases that no other one beats.

    A case is beaten by one that is as good in every aim and better in one. Cases with NaN in an aim are not
    on the front. Aims may be values or numeric parameters.

    Raises ValueError for no aims, an aim that is not in the table or not a number, or one named twice.
    """
    aims = [*minimise, *maximise]
    if not aims:
        raise ValueError("pareto needs at least one name in minimise or maximise")
    for name in aims:
        if name not in study.variables or study[name].dtype.kind not in "biuf" or name == "case":
            numbers = [str(n) for n in study.variables if study[n].dtype.kind in "biuf" and n != "case"]
            raise ValueError(f"aim {name!r} is no number of the table; there are {numbers}")
        if aims.count(name) > 1:
            raise ValueError(f"aim {name!r} is named twice; it can be minimised or maximised, once")
    sign = np.array([1.0] * len(minimise) + [-1.0] * len(maximise))
    cost = np.stack([np.asarray(study[name].values, dtype=np.float64) for name in aims], axis=1) * sign
    valid = np.isfinite(cost).all(axis=1)
    front = valid.copy()
    for i in np.flatnonzero(valid):
        beats = (cost[valid] <= cost[i]).all(axis=1) & (cost[valid] < cost[i]).any(axis=1)
        front[i] = not beats.any()
    meaning = f"not beaten in {', '.join(aims)}"
    return study.assign(front=("case", front, {"units": "", "long_name": meaning}))


# ---------------------------------------------------------------- cases


def _checked(cases: Iterable[Parameters]) -> list[dict[str, Parameter]]:
    checked = [{name: _scalar(i, name, v) for name, v in case.items()} for i, case in enumerate(cases)]
    if not checked:
        raise ValueError("a study needs at least one case")
    first = checked[0]
    for i, case in enumerate(checked):
        if case.keys() != first.keys():
            raise ValueError(
                f"case {i} has the parameters {sorted(case)}, case 0 has {sorted(first)}; give each the same"
            )
        for name, value in case.items():
            if isinstance(value, str) != isinstance(first[name], str):
                raise ValueError(
                    f"case {i}: parameter {name!r} is {value!r}, in case 0 {first[name]!r}; "
                    f"let it be a number throughout, or a text throughout"
                )
    return [{name: case[name] for name in first} for case in checked]


def _scalar(index: int, name: str, value: object) -> Parameter:
    if isinstance(value, np.generic | np.ndarray) and value.ndim == 0:
        value = value.item()
    if not isinstance(value, bool | int | float | str) or value != value:
        raise ValueError(
            f"case {index}: parameter {name!r} is {value!r}; it must be one number (not NaN) or a text"
        )
    return value


def _attempt(function: Study, parameters: dict[str, Parameter]) -> tuple[dict[str, float], str | None]:
    """Numbers, or the error in words: not every exception survives the way to another process."""
    try:
        returned = function(dict(parameters))
        if not isinstance(returned, Mapping):
            raise TypeError(
                f"returned {type(returned).__name__}; the function must return a mapping of numbers"
            )
        return {str(name): _real(str(name), value) for name, value in returned.items()}, None
    except KeyboardInterrupt:
        raise KeyboardInterrupt from None
    except Exception as error:
        return {}, f"{type(error).__name__}: {error}"


def _real(name: str, value: Any) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if not isinstance(value, Real | np.bool_):
        raise TypeError(f"value {name!r} is {value!r}; it must be one real number")
    return float(value)


# ---------------------------------------------------------------- processes


def _run(
    pool: Executor, function: Study, todo: list[dict[str, Parameter]], ahead: list[int]
) -> Iterator[tuple[int, Case]]:
    """Cases as they are finished."""
    futures: dict[Future[tuple[dict[str, float], str | None]], int] = {}
    try:
        with _worker_environment():  # a worker may be started with every submission
            for index in ahead:
                futures[pool.submit(_attempt, function, todo[index])] = index
        for future in as_completed(futures):
            index = futures[future]
            try:
                values, error = future.result()
            except BrokenExecutor as broken:
                broken.add_note(
                    "A worker process died: the function crashed it or used up the memory, or the script "
                    'calls sweep outside `if __name__ == "__main__":`.'
                )
                raise
            yield index, Case(todo[index], values, error)
    finally:
        for future in futures:
            future.cancel()


@contextmanager
def _pool(executor: Executor | None, function: Study, cases: int) -> Iterator[Executor]:
    if executor is not None:
        yield executor
        return
    _importable(function)
    pool = ProcessPoolExecutor(
        min(cases, _processors(), MOST_WORKERS), mp_context=multiprocessing.get_context("spawn")
    )
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _worker_environment() -> Iterator[None]:
    """The environment that new processes inherit.

    It cannot be set in the worker: BLAS reads it when NumPy is loaded, and a spawned worker loads NumPy with
    the caller's script, before any initializer of the pool. The BLAS of this process has read it long since.
    """
    before = {name: os.environ.get(name) for name in WORKER_ENVIRONMENT}
    os.environ.update(WORKER_ENVIRONMENT)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _importable(function: Study) -> None:
    remedy = "define it with def at the top level of a module or script, or give an executor of threads"
    name = _name(function)
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ValueError(f"function {name} cannot be sent to another process ({error}); {remedy}") from None
    typed_in = not hasattr(sys.modules["__main__"], "__file__")
    if getattr(function, "__module__", "") == "__main__" and typed_in:
        raise ValueError(f"function {name} was typed in, and other processes cannot import it; {remedy}")


def _name(function: Study) -> str:
    inner = getattr(function, "func", function)  # of a partial
    return str(getattr(inner, "__qualname__", type(inner).__qualname__))


# ---------------------------------------------------------------- store


@dataclass(frozen=True)
class _Store:
    """A folder of finished cases: <hash of the parameters>.json holds function, parameters and values."""

    folder: Path
    function: str

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)

    def _path(self, parameters: Parameters) -> Path:
        text = json.dumps(parameters, sort_keys=True)
        return self.folder / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.json"

    def read(self, parameters: Parameters) -> dict[str, float] | None:
        path = self._path(parameters)
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
            function, values = kept["function"], {str(k): float(v) for k, v in kept["values"].items()}
        except FileNotFoundError:
            return None
        except (ValueError, KeyError, TypeError, AttributeError):
            log.warning("%s holds no finished case; the case is computed again", path)
            return None
        if function != self.function:
            raise ValueError(
                f"store {self.folder} holds cases of the function {function!r}, not {self.function!r}; "
                f"give each function a folder of its own"
            )
        return values

    def write(self, case: Case) -> None:
        path = self._path(case.parameters)
        kept = {"function": self.function, "parameters": dict(case.parameters), "values": dict(case.values)}
        text = json.dumps(kept, indent=1)
        scratch = path.with_suffix(f".{os.getpid()}.part")
        scratch.write_text(text, encoding="utf-8")
        scratch.replace(path)
