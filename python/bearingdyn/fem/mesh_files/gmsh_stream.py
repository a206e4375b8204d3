"""A file of gmsh (.msh) as a stream of numbers, text or binary."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import IO

import numpy as np

from bearingdyn.types import Array, Index

ENTITIES = 100_000  # of a drawing, of one dimension; a large assembly has some thousands


@dataclass
class Source:
    """A .msh file of gmsh as a stream of numbers, text or binary, that knows where it is."""

    file: IO[bytes]
    size: int
    line: int = 0
    binary: bool = False
    endian: str = "<"
    word: int = 8  # bytes of a size_t
    tokens: list[bytes] = field(default_factory=list)  # what is left of a line of text, last first

    def where(self) -> str:
        return f"byte {self.file.tell()}" if self.binary else f"line {self.line}"

    def fault(self, what: str) -> ValueError:
        return ValueError(f"{self.where()}: {what}")

    def text(self) -> bytes:
        """The next line, stripped; b"" at the end of the file, for lines that are blank are passed over."""
        while raw := self.file.readline():
            self.line += 1
            if line := raw.strip():
                return line
        return b""

    def read(self, size: int) -> bytes:
        if size > self.size - self.file.tell():
            raise self.fault(
                f"{size} bytes should follow, and the file ends before; it is cut off or damaged"
            )
        return self.file.read(size)

    def take(self, spec: str) -> list[int]:
        """The next numbers: i an int, z a size_t, d a double (passed over, 0)."""
        if self.binary:
            form = self.endian + spec.replace("z", "q" if self.word == 8 else "i")
            return [int(v) if s != "d" else 0 for s, v in zip(spec, self._unpack(form), strict=True)]
        found = []
        for s in spec:
            if not self.tokens:
                self.tokens = self.text().split()[::-1]
            if not self.tokens:
                raise self.fault("the file ends where numbers should follow; it is cut off")
            word = self.tokens.pop()
            try:
                found.append(int(word) if s != "d" else 0)
            except ValueError:
                raise self.fault(f"{shown(word)} stands where a whole number should") from None
        return found

    def _unpack(self, form: str) -> tuple[float, ...]:
        return struct.unpack(form, self.read(struct.calcsize(form)))

    def count(self, what: str, n: int, least: int) -> int:
        """A count from the file, if so many things of so many bytes can follow."""
        if not 0 <= n * least <= self.size - self.file.tell():
            raise self.fault(
                f"{n} {what} should follow, more than the file can hold; it is cut off or damaged"
            )
        if "of" in what.split() or what == "entities":
            if n > ENTITIES:
                raise self.fault(f"{n} {what} should follow; up to {ENTITIES} are read")
        return n

    def table(self, n: int, ints: str, doubles: int, exact: bool = True) -> tuple[Index, Array]:
        """The next n rows: whole numbers (n, i) of one type, i or z each, then doubles (n, d)."""
        k = len(ints)
        if self.binary:
            whole = self.endian + ("i4" if "i" in ints or self.word == 4 else "i8")
            row = np.dtype([("n", whole, (k,)), ("x", self.endian + "f8", (doubles,))])
            data = np.frombuffer(self.read(n * row.itemsize), dtype=row)
            return data["n"].astype(np.int64), data["x"].astype(np.float64)
        parts = []
        for rows in self.rows(n):
            width = k + doubles
            for at, row_of in enumerate(rows):
                if len(row_of) != width and (exact or len(row_of) < width):
                    self.line += at + 1 - len(rows)
                    raise self.fault(f"{len(row_of)} numbers stand where {width} should")
            parts.append(self.numbers([row_of[:width] for row_of in rows], k))
        whole_part, real = (
            zip(*parts, strict=True) if parts else ((np.zeros((0, k)),), (np.zeros((0, doubles)),))
        )
        return np.vstack(whole_part).astype(np.int64), np.vstack(real)

    def rows(self, n: int) -> Iterator[list[list[bytes]]]:
        """The next n lines of text in words, some at a time."""
        while n > 0:
            lines = list(islice(self.file, min(n, 50_000)))
            self.line += len(lines)
            if len(lines) < min(n, 50_000):
                raise self.fault("the file ends in the middle of a list; it is cut off")
            yield [line.split() for line in lines]
            n -= len(lines)

    def numbers(self, rows: list[list[bytes]], k: int) -> tuple[Index, Array]:
        """Rows of words, equally many in each, up to the line just read: k whole numbers, then doubles."""
        try:
            words = np.array(rows)
            return words[:, :k].astype(np.int64), words[:, k:].astype(np.float64)
        except (ValueError, OverflowError):
            for at, row in enumerate(rows):
                for j, word in enumerate(row):
                    try:
                        np.int64(int(word)) if j < k else float(word)
                    except (ValueError, OverflowError):
                        self.line += at + 1 - len(rows)
                        kind = "whole number" if j < k else "number"
                        raise self.fault(f"{shown(word)} stands where a {kind} should") from None
            raise

    def end(self, section: str) -> None:
        """Passes over what is left of a section."""
        self.tokens = []
        wanted = b"$End" + section.encode("ascii", "replace")
        while line := self.file.readline():
            self.line += 1
            if line.strip() == wanted or (self.binary and line.rstrip().endswith(wanted)):
                return
        raise self.fault(f"${section} has no $End{section}; the file is cut off")


def shown(word: bytes) -> str:
    """The first bytes of a word of gmsh's stream as a message shows them."""
    return repr(word[:40].decode("utf-8", "replace"))
