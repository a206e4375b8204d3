"""Input files of Abaqus and CalculiX (.inp): keywords, their lines, and nodes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path


def blocks(path: Path) -> Iterator[tuple[str, dict[str, str], list[str]]]:
    """Keyword, options and data lines of each block, *INCLUDE followed."""
    keyword, options, lines = "", {}, []  # type: ignore[var-annotated]
    with path.open(encoding="utf-8", errors="replace") as file:
        pending = ""
        for raw in file:
            line = raw.strip()
            if not line or line.startswith("**"):
                continue
            if pending or line.startswith("*"):
                pending += line
                if pending.endswith(","):  # a keyword line goes on
                    continue
                if keyword:
                    yield keyword, options, lines
                keyword, options, lines = *_keyword(pending), []
                pending = ""
                if keyword == "INCLUDE":
                    other = path.parent / options.get("INPUT", "")
                    if not other.is_file():
                        raise ValueError(f"*INCLUDE names {other}, which is not a file")
                    yield from blocks(other)
                    keyword = ""
            else:
                lines.append(line)
    if keyword:
        yield keyword, options, lines


def _keyword(line: str) -> tuple[str, dict[str, str]]:
    first, *rest = line[1:].split(",")
    pairs = (option.partition("=") for option in rest)
    return " ".join(first.upper().split()), {k.strip().upper(): v.strip().strip('"') for k, _, v in pairs}


def fields(line: str) -> list[str]:
    return [f.strip() for f in line.split(",") if f.strip()]


def node(line: str) -> tuple[int, tuple[float, float, float]]:
    """Number and position of a line of *NODE; a coordinate that is blank or absent is zero.

    Raises
    ------
    ValueError
        If the line does not hold a node.
    """
    number, *place = (f.strip() for f in line.split(","))
    try:
        x, y, z = (float(v or "0") for v in (*place, "", "", "")[:3])
        return int(number), (x, y, z)
    except ValueError as error:
        raise ValueError(f"{line!r} is no node: {error}") from error
