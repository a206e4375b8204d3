"""Cases on their way through an executor: in chunks as long as quick cases need, a bounded number at once."""

from __future__ import annotations

import functools
import math
import os
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import contextmanager, suppress
from numbers import Real
from queue import Empty, SimpleQueue
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from bearingdyn import fingerprint
from bearingdyn.results import versions
from bearingdyn.study.cases import Case

Study: TypeAlias = Callable[[dict[str, Any]], Mapping[str, float]]
# each worker is one process on one core: a BLAS with threads of its own would only get in the others' way
WORKER_ENVIRONMENT = {"OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
# chunks at once: what a cluster of some five hundred workers does while it waits for more; fewer at first
WINDOW, PROBE = 1024, 64
# of a cluster that tells of its processors: for each of them, and at least. What its workers hold is made
# anew where one dies, also what has been taken in, until the scheduler has heard of that: with all chunks on
# their way one death made 4000 of 100 thousand stored cases anew, with these none
EACH, LEAST_WINDOW = 3, 6
PATIENCE = 2.0  # s without a finished chunk after which a cluster is asked whether it is still there
# s of work in a chunk, some fifty times what a cluster takes to hand it over, and the most cases in it
CHUNK_SECONDS, LONGEST_CHUNK = 0.1, 200


class OtherVersion(RuntimeError):
    """One of the refusals of a worker: it has another version of this package."""


class Meant(NamedTuple):
    """The function that was meant, by its fingerprint, by that before its first call, and the process of it.

    A function is sent to other processes by its name, and these import its module afresh: what it takes from
    around it may have been changed since.
    """

    told: str
    unused: str
    process: int
    version: str

    @classmethod
    def here(cls, function: Study) -> Meant:
        """The function as it stands in this process."""
        told, unused = fingerprint.loose(function), fingerprint.loose(function, forgetful=True)
        return cls(told, unused, os.getpid(), versions()["bearingdyn"])

    def is_this(self, function: Study) -> bool:
        """Whether a function is the one, where another process computes."""
        if os.getpid() == self.process:
            return True
        here = versions()["bearingdyn"]
        if here != self.version:
            raise OtherVersion(
                f"a process that computes cases, {os.getpid()} on {_host()}, has bearingdyn {here} where the "
                f"study was begun with {self.version}; install the same version on all workers"
            )
        try:
            told = _told_at_first(function)
        except TypeError:  # no hash
            told = fingerprint.loose(function)
        return told in (self.told, self.unused)


def _host() -> str:
    import platform

    return platform.node() or "its host"


@functools.lru_cache(maxsize=64)
def _told_at_first(function: Study) -> str:
    """Before the first case: a function may keep things in a global of its module as it goes."""
    return fingerprint.loose(function)


class Result(NamedTuple):
    """Numbers, or the error in words: not every exception survives the way to another process."""

    values: dict[str, float]
    error: str | None
    meant: bool = True


def attempt(function: Study, chunk: list[dict[str, Any]], meant: Meant) -> tuple[list[Result], float]:
    """Some cases, in whatever process, and the seconds they took."""
    began = time.perf_counter()
    same = meant.is_this(function)
    return [_attempt(function, parameters, same) for parameters in chunk], time.perf_counter() - began


def _attempt(function: Study, parameters: dict[str, Any], same: bool) -> Result:
    try:
        returned = function(dict(parameters))
        if not isinstance(returned, Mapping):
            raise TypeError(
                f"returned {type(returned).__name__}; the function must return a mapping of numbers"
            )
        return Result({str(name): _real(str(name), value) for name, value in returned.items()}, None, same)
    except KeyboardInterrupt:
        raise KeyboardInterrupt from None
    except BaseException as error:  # sys.exit too ends the case, not the study
        return Result({}, f"{type(error).__name__}: {error}", same)


def _real(name: str, value: Any) -> float:
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if not isinstance(value, Real | np.bool_):
        raise TypeError(f"value {name!r} is {value!r}; it must be one real number")
    return float(value)


def run(
    pool: Executor, function: Study, todo: list[dict[str, Any]], ahead: list[int]
) -> Iterator[tuple[int, Case, bool]]:
    """Cases as they are finished, and whether of the function meant; what ended the study is raised last.

    So many chunks are on their way at once that no worker waits, and no more: what a worker that dies had
    finished and not yet handed over is soon handed over, or soon done again.
    """
    traffic = _Traffic(pool, function, todo, ahead)
    try:
        while traffic.submit():
            try:
                indices, outcome, failure = traffic.finished.get(timeout=PATIENCE)
            except Empty:
                if getattr(getattr(pool, "_client", None), "status", None) == "closed":
                    # dask never ends the futures whose results were about to be handed over
                    raise CancelledError("the cluster's client is closed: its scheduler is gone") from None
                continue
            traffic.away -= 1
            # cancelled: a cluster whose scheduler is gone
            if isinstance(failure, BrokenExecutor | CancelledError):
                traffic.ended = traffic.ended or failure
                continue
            if isinstance(failure, OtherVersion) or not isinstance(failure, Exception | None):
                raise failure
            if failure is None:
                assert outcome is not None
                results, seconds = outcome
            else:  # the executor's own, as dask's KilledWorker
                if len(indices) > 1:  # one of them may have killed the others' worker
                    traffic.alone.extend(indices)
                    continue
                results, seconds = [Result({}, f"{type(failure).__name__}: {failure}")], 0.0
            traffic.note(len(indices), seconds)
            for index, result in zip(indices, results, strict=True):
                yield index, Case(todo[index], result.values, result.error), result.meant
        if isinstance(traffic.ended, BrokenExecutor):
            traffic.ended.add_note(
                "A worker process died: the function crashed it or used up the memory, or the script "
                'calls sweep outside `if __name__ == "__main__":`.'
            )
        if traffic.ended is not None:
            raise traffic.ended
    finally:
        for future in list(traffic.futures):
            future.cancel()


class _Traffic:
    """Chunks on their way, and the cases that wait for theirs."""

    def __init__(self, pool: Executor, function: Study, todo: list[dict[str, Any]], ahead: list[int]) -> None:
        self.pool, self.function, self.todo = pool, function, todo
        self.waiting, self.alone = deque(ahead), deque[int]()
        self.futures: dict[Future[Any], list[int]] = {}
        self.finished: SimpleQueue[tuple[list[int], Any, BaseException | None]] = SimpleQueue()
        self.away = 0  # chunks handed out, and not taken in again
        self.ended: BaseException | None = None
        self.seconds, self.cases = 0.0, 0
        self.asked, self.processors = -math.inf, 0
        self.meant = Meant.here(function)

    def submit(self) -> bool:
        """Fill the window; False where nothing is on its way any more."""
        with _worker_environment():  # a worker may be started with every submission
            while self.ended is None and (self.waiting or self.alone) and self.away < self.window:
                queue, size = (self.alone, 1) if self.alone else (self.waiting, self.chunk())
                indices = [queue.popleft() for _ in range(min(size, len(queue)))]
                chunk = [self.todo[index] for index in indices]
                try:
                    future = self.pool.submit(attempt, self.function, chunk, self.meant)
                except BrokenExecutor as broken:
                    self.ended = broken
                    break
                self.futures[future] = indices
                self.away += 1
                future.add_done_callback(self._come_back)
        return self.away > 0

    def _come_back(self, future: Future[Any]) -> None:
        """Take the results out of a future and let go of it.

        While it lives, a cluster holds its results on a worker, and makes them anew where that dies.
        """
        indices = self.futures.pop(future)
        try:
            outcome, failure = future.result(), None
        except BaseException as error:
            outcome, failure = None, error
        self.finished.put((indices, outcome, failure))

    @property
    def window(self) -> int:
        """Chunks on their way at once: few until one knows how many cases belong in each, and on clusters."""
        if not self.cases:
            return PROBE
        client = getattr(self.pool, "_client", None)
        if client is None:
            return WINDOW
        if time.monotonic() > self.asked + PATIENCE:
            self.asked = time.monotonic()
            with suppress(OSError):  # that its scheduler is gone the futures will tell
                self.processors = sum(client.ncores().values())
        return max(LEAST_WINDOW, EACH * self.processors)

    def chunk(self) -> int:
        """Cases in the next chunk: one until some are back, and few enough that every worker has several."""
        if not self.cases:
            return 1
        each = max(self.seconds / self.cases, 1e-6)
        fair = len(self.waiting) // (4 * (os.cpu_count() or 1))
        return max(1, min(int(CHUNK_SECONDS / each), LONGEST_CHUNK, fair))

    def note(self, cases: int, seconds: float) -> None:
        """Take in how long some cases took."""
        self.cases, self.seconds = self.cases + cases, self.seconds + seconds


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
