"""On which line of a TOML text each key stands."""

from __future__ import annotations

import re
from bisect import bisect_left
from typing import TypeAlias

Key: TypeAlias = tuple[str | int, ...]
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_STRINGS = (
    re.compile(r'"""(?:\\.|[^\\])*?"{3,5}', re.DOTALL),
    re.compile(r"'''.*?'{3,5}", re.DOTALL),
    re.compile(r'"(?:\\.|[^"\\\n])*"'),
    re.compile(r"'[^'\n]*'"),
)
# keys joined by dots: a TOML reader nests them in a time that grows with the square of their number
_CHAIN = re.compile(r"""(?<![\w-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){30}""")
_PLAIN = re.compile(r"[^,\]}\n#]*")


def key_lines(text: str) -> dict[Key, int]:
    """Line, from 1, of every key of a valid TOML text; array entries by their number, from 0."""
    return _Scanner(text).lines


def check_chains(text: str) -> None:
    """Check that no key of a TOML text is a chain of thirty or more, joined by dots; ValueError otherwise."""
    if _CHAIN.search(text):
        raise ValueError("a key has more than thirty parts joined by dots")


class _Scanner:
    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        self.breaks = [found.start() for found in re.finditer("\n", text)]
        self.lines: dict[Key, int] = {}
        self.counts: dict[Key, int] = {}  # of the arrays of tables
        here: Key = ()
        while True:
            self._skip(_BLANK)
            if self.at >= len(text):
                return
            if text.startswith("[[", self.at):
                here = self._header(2)
            elif text[self.at] == "[":
                here = self._header(1)
            else:
                self._entry(here)

    def _skip(self, pattern: re.Pattern[str]) -> str:
        found = pattern.match(self.text, self.at)
        assert found is not None  # every pattern used here also matches nothing, or the text is valid
        self.at = found.end()
        return found[0]

    def _mark(self, key: Key) -> None:
        line = bisect_left(self.breaks, self.at) + 1
        for k in range(1, len(key) + 1):
            self.lines.setdefault(key[:k], line)

    def _key(self) -> list[str]:
        found = []
        while True:
            self._skip(_SPACE)
            if self.text[self.at] in "\"'":
                found.append(self._string()[1:-1])
            else:
                found.append(self._skip(_BARE))
            self._skip(_SPACE)
            if self.text[self.at] != ".":
                return found
            self.at += 1

    def _string(self) -> str:
        for pattern in _STRINGS:
            found = pattern.match(self.text, self.at)
            if found:
                self.at = found.end()
                return found[0]
        raise AssertionError("no string")  # the text is valid

    def _header(self, depth: int) -> Key:
        start = self.at
        self.at += depth
        names = self._key()
        self.at += depth
        key: Key = ()
        for k, name in enumerate(names):
            key = (*key, name)
            if depth == 2 and k == len(names) - 1:
                self.counts[key] = self.counts.get(key, -1) + 1
            if key in self.counts:
                key = (*key, self.counts[key])
        end, self.at = self.at, start
        self._mark(key)
        self.at = end
        return key

    def _entry(self, here: Key) -> None:
        start = self.at
        key = (*here, *self._key())
        end, self.at = self.at, start
        self._mark(key)
        self.at = end + 1  # the sign =
        self._value(key)

    def _value(self, key: Key) -> None:
        self._skip(_SPACE)
        first = self.text[self.at]
        if first in "\"'":
            self._string()
        elif first == "[":
            self._between("]", key, numbered=True)
        elif first == "{":
            self._between("}", key, numbered=False)
        else:
            self._skip(_PLAIN)

    def _between(self, close: str, key: Key, *, numbered: bool) -> None:
        self.at += 1
        count = 0
        while True:
            self._skip(_BLANK)
            if self.text[self.at] == close:
                self.at += 1
                return
            if self.text[self.at] == ",":
                self.at += 1
                continue
            if numbered:
                self._mark((*key, count))
                self._value((*key, count))
                count += 1
            else:
                self._entry(key)
