"""Pages of the bearing sheet: as plain text, as HTML, and as rows for a table of one's own."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis.sheet_quantities import ROWS
from bearingdyn.checks import instance, require

if TYPE_CHECKING:
    import xarray


def sheet_text(sheet: xarray.Dataset) -> str:
    """The bearing sheet as a page of plain text, a column for each bearing.

    Parameters
    ----------
    sheet
        By `bearing_sheet`.
    """
    names = _names(sheet)
    lines: list[str] = []
    width = max(12, *(len(n) + 2 for n in names))
    for heading, rows in sheet_rows(sheet).items():
        lines += ["", f"{heading:<58}" + "".join(f"{n:>{width}}" for n in names)]
        for label, values, unit in rows:
            title = f"{label}, {unit}" if unit else label
            lines.append(f"  {title:<56}" + "".join(f"{v:>{width}}" for v in values))
    for name in names:
        one = sheet.sel(bearing=name)
        lines += ["", f"{name}: {one['source'].item()}"]
        if one["warnings"].item():
            lines.append(f"{name}, warnings: {one['warnings'].item()}")
    return "\n".join(lines[1:])


def sheet_rows(sheet: xarray.Dataset) -> dict[str, list[tuple[str, list[str], str]]]:
    """On the sheet's pages, rows by heading, for a table of one's own: label, value of each bearing, unit.

    Parameters
    ----------
    sheet
        By `bearing_sheet`.
    """
    _names(sheet)
    return {heading: _printed(sheet, rows) for heading, rows in ROWS.items()}


def sheet_html(sheet: xarray.Dataset, title: str = "Bearings") -> str:
    """The bearing sheet as one page of HTML that needs nothing else, a column for each bearing.

    Parameters
    ----------
    sheet
        By `bearing_sheet`.
    title
        Of the page.
    """
    names = _names(sheet)
    instance("title", title, str, "give a text")

    def cells(tag: str, texts: Sequence[str]) -> str:
        return "".join(f"<{tag}>{html.escape(t)}</{tag}>" for t in texts)

    body: list[str] = []
    for heading, rows in sheet_rows(sheet).items():
        body.append(f"<tr>{cells('th', [heading, '', *names])}</tr>")
        body += [f"<tr>{cells('td', [label, unit, *values])}</tr>" for label, values, unit in rows]
    notes = []
    for name in names:
        one = sheet.sel(bearing=name)
        notes.append(f"<p><b>{html.escape(name)}</b>: {html.escape(one['source'].item())}</p>")
        if one["warnings"].item():
            notes.append(
                f"<p class=warning><b>{html.escape(name)}</b>: {html.escape(one['warnings'].item())}</p>"
            )
    style = (
        "body{font-family:sans-serif;margin:2em}table{border-collapse:collapse}"
        "th,td{padding:.15em 1em;text-align:right}th:first-child,td:first-child{text-align:left}"
        "th{border-bottom:1px solid;padding-top:1em}.warning{color:#a00}"
    )
    return (
        f"<!DOCTYPE html><html lang=en><head><meta charset=utf-8><title>{html.escape(title)}</title>"
        f"<style>{style}</style></head><body><h1>{html.escape(title)}</h1>"
        f"<table>{''.join(body)}</table>{''.join(notes)}<p>{html.escape(sheet.attrs['made_by'])}, "
        f"{html.escape(sheet.attrs['made_at'])}</p></body></html>\n"
    )


def _names(sheet: Any) -> list[str]:
    kind = getattr(sheet, "attrs", {}).get("analysis")
    require(kind == "bearing sheet", "sheet", kind, "it must be a Dataset of bearing_sheet")
    return [str(name) for name in sheet["bearing"].values]


def _printed(
    sheet: xarray.Dataset, rows: Mapping[str, tuple[str, str, float, str]]
) -> list[tuple[str, list[str], str]]:
    """Label, values and unit of each row that is known of any bearing."""
    found = []
    for name, (_, meaning, factor, unit) in rows.items():
        values = sheet[name].values * factor
        if not np.isnan(values).all():
            found.append(
                (
                    meaning,
                    ["–" if np.isnan(v) else f"{v:.4g}" if abs(v) < 1e4 else f"{v:.0f}" for v in values],
                    unit,
                )
            )
    return found
