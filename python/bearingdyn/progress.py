"""How far long work has come: told to a function, or shown as a bar where a person sits at a terminal."""

from __future__ import annotations

import multiprocessing
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeAlias

Progress: TypeAlias = Callable[[int, int], object]


"""Called with what is done and what there is to do."""


DELAY = 1.0  # s, after which a bar that nobody asked for appears


@contextmanager
def told(progress: Progress | bool | None, unit: str) -> Iterator[Progress | None]:
    """The function to be told of the progress, or None, for as long as the work lasts.

    Parameters
    ----------
    progress
        A function of (done, in all); True for a bar on standard error, False for nothing. None for a bar
        where standard error is a terminal, tqdm is installed, and this is no worker thread or process; it
        appears after a second.
    unit
        What is counted: "step".

    Raises
    ------
    TypeError
        For anything else.
    ModuleNotFoundError
        Where a bar is asked for and tqdm is not installed.
    """
    if not (progress is None or isinstance(progress, bool) or callable(progress)):
        raise TypeError(f"progress is {progress!r}; it must be True, False or a function of (done, in all)")
    if callable(progress):
        yield progress
        return
    if progress is False or (progress is None and not _watched()):
        yield None
        return
    try:
        from tqdm import tqdm
    except ModuleNotFoundError:
        if progress is None:
            yield None
            return
        raise
    with tqdm(
        unit=unit, unit_scale=unit == "step", delay=0.0 if progress else DELAY, leave=bool(progress)
    ) as bar:

        def show(done: int, total: int) -> None:
            bar.total = total
            bar.update(done - bar.n)

        yield show


def _watched() -> bool:
    """Whether a person may see a bar: a terminal, and the only one that draws there."""
    return (
        sys.stderr is not None
        and sys.stderr.isatty()
        and threading.current_thread() is threading.main_thread()
        and multiprocessing.parent_process() is None
    )


def part_of(progress: Progress | None, done: int, total: int) -> Callable[[int, int], object] | None:
    """Progress of one piece as progress of the whole."""
    if progress is None:
        return None
    return lambda piece, _: progress(done + piece, total)
