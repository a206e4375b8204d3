"""What is found of a system once, and kept as long as that system lives: a decorator for functions of one."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

from bearingdyn.system import System

_T = TypeVar("_T")


def kept_by_system(find: Callable[[System], _T]) -> Callable[[System], _T]:
    """Keep what a function finds of a system until the system itself is gone.

    What is found must not hold the system, or neither ever goes. Two threads may find it twice.
    """
    held: WeakKeyDictionary[System, _T] = WeakKeyDictionary()

    @wraps(find)
    def found(system: System) -> _T:
        known = held.get(system)
        if known is None:
            known = held[system] = find(system)
        return known

    return found
