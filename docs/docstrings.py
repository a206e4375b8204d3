"""Docstrings of the package, put into the form Sphinx reads.

They are written for the reader of the source, with |x| for magnitudes and E* for a modulus: these marks are
escaped here. Sections underlined in NumPy's manner are left to napoleon. The rooms that conf.py lists as
mixed also have plain lines "name: meaning", continued by indented lines: here they become lists.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

FIELD = re.compile(r"^([A-Za-zθ_*][\w*]*(?:, [\w*]+)*): (\S.*)$")
SECTION = re.compile(r"^-{3,}$")
ARRAY = re.compile(r"[\w~.]*ndarray\[tuple\[[\w~.]*Any, \.\.\.\], [\w~.]*dtype\[[\w~.]*?(\w+)\]\]")
PROSE = ("Reference", "Returns", "Raises", "Source")
MARK = re.compile(r"([|*]|_(?!\w))")
LITERAL = re.compile(r"(``.+?``|`[^`]+`)", re.DOTALL)


def process(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Rewrite the lines of one docstring in place (Sphinx's event autodoc-process-docstring)."""
    room = str(getattr(obj, "__module__", None) or name).split(".")[1:2]
    if not room or room[0] not in app.config.mixed_docstrings:
        lines[:] = map(escaped, lines)
        return
    prose: list[list[str]] = []
    sections: list[list[str]] = []
    for block in blocks(lines):
        titled = len(block) > 1 and SECTION.match(block[1].strip()) is not None
        described = any(line.startswith("    ") for line in block)
        (sections if titled or (sections and described) else prose).append(block)
    made = [line for k, block in enumerate(prose) for line in rendered(block, fields=k > 0)]
    for block in sections:
        made += [*map(escaped, block), ""]
    lines[:] = made


def shorten(app: Any, what: str, name: str, obj: Any, options: Any, signature: Any, returned: Any) -> Any:
    """NumPy's types by the names users write (Sphinx's event autodoc-process-signature)."""

    def short(text: Any) -> Any:
        return ARRAY.sub(r"NDArray[\1]", text).replace("<factory>", "...") if isinstance(text, str) else text

    return short(signature), short(returned)


def blocks(lines: list[str]) -> Iterator[list[str]]:
    """Runs of lines between empty ones."""
    block: list[str] = []
    for line in [*lines, ""]:
        if line.strip():
            block.append(line)
        elif block:
            yield block
            block = []


def rendered(block: list[str], fields: bool) -> list[str]:
    """A paragraph, or a list of fields where lines begin with "name: "; examples and lists as they are."""
    if block[0].lstrip().startswith((">>>", "- ", ".. ")) or block[0].startswith("    "):
        return [*block, ""]
    items: list[tuple[str, str]] = []  # name or nothing, text
    for line in block:
        field = FIELD.match(line) if fields and not line.startswith(PROSE) else None
        if field or not items:
            items.append((field[1], field[2]) if field else ("", line.strip()))
        else:
            items[-1] = (items[-1][0], f"{items[-1][1]} {line.strip()}")
    made = [f"* **{name}**: {escaped(text)}" if name else escaped(text) for name, text in items]
    if not items[0][0]:
        made.insert(1, "")
    return [*made, ""]


def escaped(line: str) -> str:
    """What Sphinx would read as a mark, as it stands: bars, stars, underscores at the end of a word."""
    if line.lstrip().startswith((">>>", "...")):
        return line
    parts = LITERAL.split(line)
    return "".join(part if i % 2 else MARK.sub(r"\\\1", part) for i, part in enumerate(parts))
