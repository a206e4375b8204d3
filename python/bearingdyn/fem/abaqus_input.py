"""Input files of Abaqus and CalculiX (.inp): keywords, their lines, and nodes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

INCLUDES = 1000  # files that one file may include, some ten times what a large assembly has
AGAIN = 2**25  # bytes of files that may be read a second time; 22 files that include twice would be 4 million
LARGEST_NUMBER = 2**31 - 1  # of a node or element; Abaqus' own limit is 999 999 999
WITH_FILE = ("NODE", "ELEMENT")  # keywords whose INPUT= names a file of more data lines


@dataclass
class Block:
    """A block of an Abaqus input file: a keyword with its options and data lines.

    Parameters
    ----------
    keyword
        In capitals, without the star.
    options
        Names in capitals.
    lines, places
        Data lines, and the number of each in its file.
    file
        The name of the file.
    place
        The keyword's own line.
    """

    keyword: str
    options: dict[str, str]
    file: str
    place: int
    lines: list[str] = field(default_factory=list)
    places: list[int] = field(default_factory=list)

    def fault(self, what: object, at: int | None = None) -> ValueError:
        """An error that names file, line and keyword; `at` counts the data lines."""
        place = self.place if at is None else self.places[at]
        return ValueError(f"{self.file}, line {place}: *{self.keyword}: {what}")

    def named(self, option: str) -> str:
        """An option that must be there. Raises ValueError if it is not."""
        name = self.options.get(option, "")
        if not name:
            raise self.fault(f"it has no {option}=; write *{self.keyword}, {option}=name")
        return name


@dataclass
class _Budget:
    """What one file may still include, so that files which include each other end."""

    includes: int = INCLUDES
    again: int = AGAIN
    seen: set[Path] = field(default_factory=set)


def blocks(path: Path) -> Iterator[Block]:
    """The blocks of an Abaqus input file in turn, *INCLUDE followed.

    Raises
    ------
    ValueError
        For a file that includes itself, that cannot be found, or includes that multiply without end.
    """
    yield from _blocks(path, (path.resolve(),), _Budget(seen={path.resolve()}))


def _blocks(path: Path, chain: tuple[Path, ...], budget: _Budget) -> Iterator[Block]:
    block: Block | None = None
    pending: list[str] = []
    begun = 0
    with path.open(encoding=_encoding(path), errors="replace") as file:
        for number, raw in enumerate(file, 1):
            line = raw.strip()
            if not line or line.startswith("**"):
                continue
            keyword = line.startswith("*")
            if pending and keyword:  # a keyword line whose last comma led nowhere
                block = _begun(pending, path, begun)
                pending = []
            if keyword or pending:
                if block is not None:
                    yield from _finished(block, chain, budget)
                    block = None
                begun = number if keyword else begun
                pending.append(line)
                if not line.endswith(","):  # else the keyword line goes on
                    block, pending = _begun(pending, path, begun), []
            elif block is not None:
                block.lines.append(line)
                block.places.append(number)
    if pending:
        block = _begun(pending, path, begun)
    if block is not None:
        yield from _finished(block, chain, budget)


def _finished(block: Block, chain: tuple[Path, ...], budget: _Budget) -> Iterator[Block]:
    """The block itself, or the blocks or lines of the file that it names."""
    if block.keyword == "INCLUDE":
        other = _other(block, chain, budget)
        yield from _blocks(other, (*chain, other), budget)
        return
    if block.keyword in WITH_FILE and "INPUT" in block.options:
        other = _other(block, chain, budget)
        with other.open(encoding=_encoding(other), errors="replace") as file:
            for number, raw in enumerate(file, 1):
                line = raw.strip()
                if line.startswith("*") and not line.startswith("**"):
                    raise ValueError(
                        f"{other.name}, line {number}: {line[:40]!r}; INPUT= names a file of data lines"
                    )
                if line and not line.startswith("*"):
                    block.lines.append(line)
                    block.places.append(number)
        block.file = other.name
    yield block


def _other(block: Block, chain: tuple[Path, ...], budget: _Budget) -> Path:
    """The file a block names, if it is there and may be read."""
    other = (chain[-1].parent / block.named("INPUT")).resolve()
    if not other.is_file():
        raise block.fault(f"it names {other}, which is not a file")
    if other in chain:
        raise block.fault(f"{other.name} includes itself; take the line out")
    budget.includes -= 1
    if other in budget.seen:
        budget.again -= other.stat().st_size
    budget.seen.add(other)
    if budget.includes < 0 or budget.again < 0:
        raise block.fault(
            f"more than {INCLUDES} files are included, or {AGAIN >> 20} MB a second time; do the files "
            "include each other?"
        )
    return other


def _encoding(path: Path) -> str:
    with path.open("rb") as file:
        start = file.read(2)
    return "utf-16" if start in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig"


def _begun(lines: list[str], path: Path, place: int) -> Block:
    first, *rest = "".join(lines)[1:].split(",")
    pairs = (option.partition("=") for option in rest)
    options = {"".join(k.upper().split()): v.strip().strip('"') for k, _, v in pairs if k.strip()}
    return Block(" ".join(first.upper().split()), options, path.name, place)


def fields(line: str) -> list[str]:
    """The entries of a data line of an Abaqus input file that are not blank."""
    return [f.strip() for f in line.split(",") if f.strip()]


def whole(text: str) -> int:
    """A whole number of an Abaqus input file, of a node or element; ValueError for anything else."""
    if not (text.isascii() and text.isdigit() and len(text) < 20 and int(text) <= LARGEST_NUMBER):
        raise ValueError(
            f"{text[:40]!r} is not the number of a node or element; it must be in 0...{LARGEST_NUMBER}"
        )
    return int(text)


def real(text: str) -> float:
    """A finite number of an Abaqus input file, blank for 0, Fortran's exponents too; ValueError otherwise."""
    try:
        value = float(text.replace("D", "e").replace("d", "e") or "0")
    except ValueError:
        value = math.nan
    if "_" in text or not math.isfinite(value):
        raise ValueError(f"{text[:40]!r} is not a finite number")
    return value


def node(line: str) -> tuple[int, tuple[float, float, float]]:
    """Abaqus input file: number and position of a line of *NODE; absent coordinates are zero.

    Raises
    ------
    ValueError
        If the line does not hold a node.
    """
    number, *place = (f.strip() for f in line.split(","))
    try:
        x, y, z = (real(v) for v in (*place, "", "", "")[:3])
        return whole(number), (x, y, z)
    except ValueError as error:
        raise ValueError(f"{line[:80]!r} is not a node: {error}") from error
