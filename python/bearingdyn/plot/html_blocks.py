"""What pages of objects in notebooks are made of: tables, boxes, and figures as SVG; HTML without scripts.

Colours are the notebook's own, so that a page is read in its dark theme too; figures keep a white ground.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CELL = "padding:2px 10px 2px 0;text-align:left;vertical-align:top;border:none"
HEAD = f"{CELL};opacity:.65;font-weight:normal"


def svg(figure: Figure, told: str) -> str:
    """For an object's HTML in a notebook: a figure as SVG with a text for those who do not see it."""
    import matplotlib
    import matplotlib.pyplot as plt

    held = io.StringIO()
    settings: Any = matplotlib.rcParams
    # the same drawing gives the same text; letters are paths, for a reader without the font
    before = {key: settings[key] for key in ("svg.hashsalt", "svg.fonttype")}
    settings.update({"svg.hashsalt": "bearingdyn", "svg.fonttype": "path"})
    try:
        figure.savefig(held, format="svg", facecolor="white", metadata={"Date": None})
    finally:
        settings.update(before)
        plt.close(figure)
    text = held.getvalue()
    text = text[text.index("<svg") :]
    said = f'<svg role="img" aria-label="{escape(told, True)}" style="max-width:100%;height:auto"'
    return text.replace("<svg", said, 1)


def rows(heads: Sequence[str], cells: Iterable[Sequence[str]]) -> str:
    """A table on the page of an object; "" where it has no rows."""
    body = "".join(
        "<tr>" + "".join(f'<td style="{CELL}">{escape(c)}</td>' for c in row) + "</tr>" for row in cells
    )
    if not body:
        return ""
    top = "".join(f'<th style="{HEAD}">{escape(h)}</th>' for h in heads)
    return f'<table style="border-collapse:collapse;margin:.3em 0"><tr>{top}</tr>{body}</table>'


def box(title: str, *blocks: str) -> str:
    """A box in a notebook: a title and blocks below it."""
    return f'<div class="bearingdyn"><div><strong>{escape(title)}</strong></div>{"".join(blocks)}</div>'


def canvas(width: float, height: float) -> Any:
    """Figure and axes for the page of an object in a notebook, inches."""
    import matplotlib.pyplot as plt

    return plt.subplots(figsize=(width, height), layout="constrained")
