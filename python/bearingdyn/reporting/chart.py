"""Curves for the page's own script: numbers as 32-bit floats in base64, thinned where they are too many."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import pairwise
from typing import Any

import numpy as np

from bearingdyn.types import Array

MOST = 6000  # points of a curve that are kept whole; more are thinned to their extremes
BINS = 2000  # of a thinned curve, two points each


@dataclass(frozen=True)
class Curve:
    """One curve of a report's chart: its name, x (n,) ascending and y (n,), NaN where there is nothing.

    beside: name of a line before it, whose colour it takes, dashed.
    """

    name: str
    x: Array
    y: Array
    beside: str = ""


@dataclass(frozen=True)
class Chart:
    """A report's chart to zoom and read off: a title, what its axes are, and its curves.

    Parameters
    ----------
    title
        Above it.
    x, y
        What the axes are, with units.
    curves
        At least one.
    log_x, log_y
        Whether an axis is logarithmic; values that are not positive are then left out.
    note
        Below it.
    dots
        Whether points are drawn instead of a line.
    """

    title: str
    x: str
    y: str
    curves: Sequence[Curve] = field(default_factory=list)
    log_x: bool = False
    log_y: bool = False
    note: str = ""
    dots: bool = False

    def held(self) -> dict[str, Any]:
        """Axes and curves as the page's script takes them."""
        curves = [thinned(c) for c in self.curves]
        shared: list[Array] = []
        rows: list[dict[str, Any]] = []
        for curve in curves:
            at = next((k for k, x in enumerate(shared) if np.array_equal(x, curve.x)), len(shared))
            if at == len(shared):
                shared.append(curve.x)
            base = _base(curve.y)
            row: dict[str, Any] = {"name": curve.name, "x": at, "y": floats(curve.y - base)}
            if base:
                row["base"] = base
            if curve.beside:
                row["beside"] = [c.name for c in curves].index(curve.beside)
            rows.append(row)
        return {
            "x": {"label": self.x, "log": self.log_x},
            "y": {"label": self.y, "log": self.log_y},
            "grids": [floats(x) for x in shared],
            "curves": rows,
            "dots": self.dots,
        }

    def html(self) -> str:
        """The chart as the page holds it; for readers who do not see it, its ranges as text."""
        note = f"<p class=note>{escape(self.note)}</p>" if self.note else ""
        return (
            f"<figure class=chart><figcaption>{escape(self.title)}</figcaption>"
            f'<div class=plot role=img tabindex=0 aria-label="{escape(self.told(), True)}"></div>'
            f"<script type=application/json>{json_text(self.held())}</script>{note}</figure>"
        )

    def told(self) -> str:
        """What is drawn, in words."""
        said = []
        for curve in self.curves:
            y = curve.y[np.isfinite(curve.y)]
            if y.size:
                k = int(np.nanargmax(curve.y))
                said.append(
                    f"{curve.name}: {y.min():.4g} to {y.max():.4g}, largest at {float(curve.x[k]):.4g}"
                )
        return f"{self.title}; {self.y} over {self.x}. " + "; ".join(said)


def thinned(curve: Curve) -> Curve:
    """A chart's curve of many points by the lowest and highest of each of BINS pieces, in order."""
    n = curve.x.size
    if n <= MOST:
        return curve
    edges = np.linspace(0, n, BINS + 1).astype(np.intp)
    y = np.asarray(curve.y, dtype=np.float64)
    kept = []
    for first, last in pairwise(edges):
        piece = y[first:last]
        if np.isfinite(piece).any():
            kept += [first + int(np.nanargmin(piece)), first + int(np.nanargmax(piece))]
        else:
            kept.append(int(first))
    at = np.unique([0, *kept, n - 1])
    return Curve(curve.name, curve.x[at], y[at], curve.beside)


def _base(y: Array) -> float:
    """A level that a small motion rides on: taken off a chart's values before they become 32-bit floats."""
    known = y[np.isfinite(y)]
    if not known.size or np.ptp(known) >= 1e-2 * np.abs(known).max():
        return 0.0
    return float(known[0])


def floats(values: Array) -> str:
    """A chart's numbers as little-endian 32-bit floats in base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype="<f4").tobytes()).decode("ascii")


def json_text(held: object) -> str:
    """A chart's JSON, as it may stand inside a script element: no end of it within."""
    return json.dumps(held, ensure_ascii=False, separators=(",", ":")).replace("</", "<\\/")
