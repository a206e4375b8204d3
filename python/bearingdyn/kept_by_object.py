"""What is found of an object once, and kept as long as that object lives: a decorator of functions."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

_A = TypeVar("_A")
_T = TypeVar("_T")


def kept_by_object(find: Callable[[_A], _T]) -> Callable[[_A], _T]:
    """Keep what a function finds of an object that nobody changes until that object itself is gone.

    What is found must not hold the object, or neither ever goes; and nobody may write into it. Two threads
    may find it twice.
    """
    held: WeakKeyDictionary[_A, _T] = WeakKeyDictionary()

    @wraps(find)
    def found(of: _A) -> _T:
        try:
            return held[of]
        except KeyError:
            known = held[of] = find(of)
            return known

    return found
