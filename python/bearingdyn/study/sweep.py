"""One function over many cases, in many processes, resumed where it was interrupted."""

from __future__ import annotations

import ast
import logging
import multiprocessing
import os
import pickle
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from bearingdyn.notice import ChangedFunction, warn
from bearingdyn.progress import Progress, told
from bearingdyn.study.cases import Case, Parameters, checked
from bearingdyn.study.chunks import Study, run
from bearingdyn.study.store import Store, name_of

# Windows waits for no more handles than this
MOST_WORKERS = 61
log = logging.getLogger(__name__)


def sweep(
    function: Study,
    cases: Iterable[Parameters],
    executor: Executor | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: Progress | bool | None = None,
    *,
    retry: bool = False,
) -> list[Case]:
    """Sweep a function over all cases and gather what it returns, in the order of the cases.

    Parameters
    ----------
    function
        Maps the parameters of a case, a dict, to a mapping of real numbers. An exception it raises is kept in
        the case and the study goes on.
    cases
        Parameters by name, the same names in each: a list of dicts, as `grid` and `sobol` make them. A
        parameter is a number, a text, an array, or an object told by its content, such as a part or material.
    executor
        Any executor of `concurrent.futures`, or one that behaves like it, as the ``get_executor()`` of a
        client of dask.distributed does. None: processes, as many as there are processors, started afresh
        ("spawn"), BLAS with one thread in each. These import the function by name: it must stand at the top
        level of a module or script, and a script must call `sweep` below ``if __name__ == "__main__":``.
        Ctrl-C ends the study when the cases being computed are done.
    store
        Folder, made where missing, on a disk of this machine: workers elsewhere need not see it. Each
        finished case, a failed one too, is written there at once, as a row of an SQLite file under the hash
        of the function, this package's version and the parameters, and taken from there when the study is run
        again; `status` tells how far it is. Of the function counts all that it is: its code and name, bound
        arguments, the object it is a method of, defaults, enclosed variables and the global values and
        functions it uses; of installed packages and modules it uses, their names alone: when these change,
        take another folder. Several studies may share a folder, at the same time too.
    progress
        Called with (cases done, cases in all) after each; True for a bar on standard error, False for none,
        None for a bar where standard error is a terminal.
    retry
        Compute again what failed before and lies in the store with its error.

    Returns
    -------
    list[Case]
        One for each case, in the order given.

    Raises
    ------
    ValueError
        Before any work: no cases, unequal names, a parameter that cannot be told by its content, nor, with
        a store, the function; a function that other processes cannot import; a script that calls `sweep`
        outside ``if __name__ == "__main__":``.
    RuntimeError
        Where a process that computes has another version of this package: its cases are refused.
    concurrent.futures.BrokenExecutor
        Where a worker of a pool of processes died. What was finished is in the store. A dask cluster computes
        the cases of a worker that died anew, and gives up a case that killed several.
    concurrent.futures.CancelledError
        Where the executor cancelled cases, as a cluster does whose scheduler is gone. What was finished is in
        the store, and the same call on another cluster goes on from there.

    Warns
    -----
    ChangedFunction
        Where the processes that compute have another function by that name.
    """
    if not callable(function):
        raise ValueError(f"function is {function!r}; it must be a function of a case, a dict")
    todo = checked(cases)
    kept = Store(Path(store), function) if store is not None else None
    try:
        done = kept.read(todo) if kept else {}
        if retry:
            done = {index: case for index, case in done.items() if case.error is None}
        ahead = [index for index in range(len(todo)) if index not in done]
        with told(progress, "case") as tell:
            advance = tell or (lambda done, total: None)
            if done:
                advance(len(done), len(todo))
            if ahead:
                with _pool(executor, function, len(ahead)) as pool:
                    warned = False
                    for index, case, meant in run(pool, function, todo, ahead):
                        done[index] = case
                        if not meant and not warned:
                            _warn_of_another(function)
                            warned = True
                        if case.error is not None:
                            log.warning("case %d, %s, failed: %s", index, dict(case.parameters), case.error)
                        if kept and meant:
                            kept.write(case, asked=len(todo), ahead=len(ahead))
                        advance(len(done), len(todo))
    finally:
        if kept:
            kept.close()
    return [done[index] for index in range(len(todo))]


def _warn_of_another(function: Study) -> None:
    warn(
        f"function {name_of(function)} is not the same in the processes that compute the cases: a global "
        f"value, a default or an attribute that it uses was changed after its module was imported, and they "
        f"import it afresh. The cases are those of the module as it stands in its file, and none of them is "
        f"stored; pass what changes as a parameter of the cases, or give an executor of threads",
        ChangedFunction,
    )


# ---------------------------------------------------------------- processes


@contextmanager
def _pool(executor: Executor | None, function: Study, cases: int) -> Iterator[Executor]:
    if executor is not None:
        yield executor
        return
    _importable(function)
    _check_guard()
    pool = ProcessPoolExecutor(
        min(cases, _processors(), MOST_WORKERS), mp_context=multiprocessing.get_context("spawn")
    )
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _processors() -> int:
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _importable(function: Study) -> None:
    remedy = "define it with def at the top level of a module or script, or give an executor of threads"
    name = name_of(function)
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ValueError(f"function {name} cannot be sent to another process ({error}); {remedy}") from None
    typed_in = not hasattr(sys.modules["__main__"], "__file__")
    if getattr(function, "__module__", "") == "__main__" and typed_in:
        raise ValueError(f"function {name} was typed in, and other processes cannot import it; {remedy}")


def _check_guard() -> None:
    """A script that starts processes does so behind its guard: each of them runs the script once more."""
    frame: FrameType | None = sys._getframe()
    while frame is not None:
        if (
            frame.f_globals.get("__name__") in ("__main__", "__mp_main__")
            and frame.f_code.co_name == "<module>"
        ):
            break
        frame = frame.f_back
    file = getattr(sys.modules["__main__"], "__file__", None)
    if frame is None or file is None or frame.f_code.co_filename != file:
        return
    try:
        tree = ast.parse(Path(file).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "__name__" in ast.unparse(node.test):
            before = node.lineno <= frame.f_lineno
            if before and (frame.f_lineno <= (node.end_lineno or 0) or "!=" in ast.unparse(node.test)):
                return
    raise ValueError(
        f'{file}, line {frame.f_lineno} calls sweep outside `if __name__ == "__main__":`, and each worker '
        f"process runs the script up to there again; put the call below that line"
    )
