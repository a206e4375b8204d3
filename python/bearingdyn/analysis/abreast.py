"""Marches abreast: calls of the core gathered from the threads of several marches, and made together."""

from __future__ import annotations

from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass
from threading import Condition
from typing import TypeVar

from bearingdyn import core
from bearingdyn.types import Array

# marches that the core takes side by side: BD_ABREAST of csrc/bearingdyn.h
WIDTH = 8
CoreMarch = tuple[Array, Array, core.Report]
_Made = TypeVar("_Made")


@dataclass(eq=False)
class _Waiting:
    """A call that waits for others, and what became of it."""

    call: core.MarchCall
    structure: str | None
    taken: bool = False
    found: CoreMarch | None = None
    error: BaseException | None = None


class Gathering:
    """A gathering of marches that each run in a thread of their own, from `threads` groups of them.

    A call waits until as many of its structure as fit abreast are there, or until every march waits; then one
    of the waiting threads makes the calls of one structure. What comes out does not depend on who was there.

    Parameters
    ----------
    marches
        How many there are.
    threads
        How many groups may march at a time.
    """

    def __init__(self, marches: int, threads: int) -> None:
        self.abreast = max(1, min(WIDTH, -(-marches // threads)))
        self.threads = threads
        self.members = min(marches, self.abreast * threads)  # threads that march at a time
        self._ahead = marches - self.members  # marches not begun, when all members are busy
        self._busy = self.members  # members that neither wait nor have ended
        self._groups = 0
        self._waiting: list[_Waiting] = []
        self._turn = Condition()

    def member(self, march: Callable[[], _Made]) -> _Made:
        """One march of the gathering, in the thread of a member."""
        token = GATHERING.set(self)
        try:
            return march()
        finally:
            GATHERING.reset(token)
            with self._turn:
                if self._ahead > 0:
                    self._ahead -= 1
                else:
                    self._busy -= 1
                self._turn.notify_all()

    def march(self, call: core.MarchCall, structure: str | None) -> CoreMarch:
        """Make a call of the core, together with others of its structure; None: by itself."""
        own = _Waiting(call, structure)
        with self._turn:
            self._busy -= 1
            self._waiting.append(own)
            self._turn.notify_all()
            self._turn.wait_for(lambda: own.found is not None or own.error is not None or self._ready(own))
            group = [] if own.taken else self._take(own)
        if group:
            self._make(group)
        if own.error is not None:
            raise own.error
        assert own.found is not None
        return own.found

    def _ready(self, own: _Waiting) -> bool:
        """Whether the thread of this call is to make those of its structure."""
        if own.taken or self._groups == self.threads:
            return False
        if own.structure is None:
            return True
        alike = sum(each.structure == own.structure for each in self._waiting)
        return alike >= self.abreast or self._busy == 0

    def _take(self, own: _Waiting) -> list[_Waiting]:
        alike = [each for each in self._waiting if each.structure == own.structure and each is not own]
        group = [own, *alike[: self.abreast - 1]] if own.structure is not None else [own]
        for each in group:
            each.taken = True
            self._waiting.remove(each)
        self._groups += 1
        return group

    def _make(self, group: list[_Waiting]) -> None:
        """The calls of a group, and what became of them to those that wait."""
        try:
            for each, found in zip(group, core.march_abreast([each.call for each in group]), strict=True):
                each.found = found
        except BaseException:  # of one of them, a `progress` or no memory: which one, each shows by itself
            for each in group:
                try:
                    each.found = core.march_abreast([each.call])[0]
                except BaseException as error:
                    each.error = error
        with self._turn:
            self._groups -= 1
            self._busy += len(group)
            self._turn.notify_all()


# the gathering that a thread's marches belong to; None: each march by itself
GATHERING: ContextVar[Gathering | None] = ContextVar("GATHERING", default=None)
