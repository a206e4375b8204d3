"""Pieces of the page: tables, facts, and numbers in the multiple of their unit that suits them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from html import escape

import numpy as np

from bearingdyn.types import Array
from bearingdyn.units import suited


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A report's block: a table that scrolls sideways where it is too wide; "" without rows."""
    body = "".join("<tr>" + "".join(f"<td>{escape(c)}</td>" for c in row) + "</tr>" for row in rows)
    if not body:
        return ""
    top = "".join(f"<th scope=col>{escape(h)}</th>" for h in heads)
    held = f"<table><thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>"
    return f"<div class=scroll tabindex=0>{held}</div>"


def paragraph(text: str, kind: str = "") -> str:
    """A report's block: a paragraph; "" of nothing."""
    return f"<p{f' class={kind}' if kind else ''}>{escape(text)}</p>" if text else ""


def scaled(values: Array, unit: str) -> tuple[Array, str]:
    """Values for a report's blocks in the multiple of their unit that suits the largest, and that unit."""
    size = np.abs(values[np.isfinite(values)])
    power, text, prefixed = suited(float(size.max()) if size.size else 0.0, unit)
    return (values / 10.0**power, text) if prefixed else (values, unit)


def told(x: float, unit: str = "") -> str:
    """A number and its unit in few digits, for a report's blocks."""
    if not math.isfinite(x):
        return "–" if math.isnan(x) else "∞" if x > 0 else "−∞"
    power, text, prefixed = suited(abs(x), unit)
    shown = x / 10.0**power if prefixed else x
    return f"{shown:.4g} {text if prefixed else unit}".replace("-", "−").rstrip()
