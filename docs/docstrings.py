"""Docstrings of the package, put into the form Sphinx reads.

They are written for the reader of the source, with |x| for magnitudes and E* for a modulus: these marks are
escaped here. Napoleon reads the sections.
"""

from __future__ import annotations

import re
from typing import Any

ARRAY = re.compile(r"[\w~.]*ndarray\[tuple\[[\w~.]*Any, \.\.\.\], [\w~.]*dtype\[[\w~.]*?(\w+)\]\]")
MARK = re.compile(r"([|*@]|_(?!\w))")
LITERAL = re.compile(r"(``.+?``|`[^`]+`)", re.DOTALL)


def process(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Escape the lines of one docstring in place (Sphinx's event autodoc-process-docstring)."""
    lines[:] = map(escaped, lines)


def shorten(app: Any, what: str, name: str, obj: Any, options: Any, signature: Any, returned: Any) -> Any:
    """NumPy's types by the names users write (Sphinx's event autodoc-process-signature)."""

    def short(text: Any) -> Any:
        return ARRAY.sub(r"NDArray[\1]", text).replace("<factory>", "...") if isinstance(text, str) else text

    return short(signature), short(returned)


def escaped(line: str) -> str:
    """What Sphinx would read as a mark, as it stands: bars, stars, @, underscores at the end of a word."""
    if line.lstrip().startswith((">>>", "...")):
        return line
    parts = LITERAL.split(line)
    return "".join(part if i % 2 else MARK.sub(r"\\\1", part) for i, part in enumerate(parts))
