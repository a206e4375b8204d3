"""Modes to be turned and seen moving: surfaces thinned to what a page can draw sixty times a second."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bearingdyn.analysis import Equilibrium, mode_surfaces
from bearingdyn.reporting.chart import floats, json_text
from bearingdyn.types import Array, Complex, Index

if TYPE_CHECKING:
    import xarray

CELLS = 24  # of a part along its longest side
SHOWN = 12  # modes
FREE = 1e-3  # of the median frequency of the lowest modes, below which a motion is free


def shapes_html(eq: Equilibrium, found: xarray.Dataset) -> str:
    """A report's mode shapes on the surfaces of the parts; "" where no part has one.

    Parameters
    ----------
    eq
        What the modes are of.
    found
        By `bd.modes`.
    """
    count = min(SHOWN, found.sizes["mode"])
    try:
        drawn = [mode_surfaces(eq, found, k) for k in range(count)]
    except ValueError:
        return ""  # parts without a surface, or modes of another system
    if not drawn or not drawn[0]:
        return ""
    first = first_elastic(found, count)
    points, faces, groups, parts = _thinned(drawn[0])
    modes: list[dict[str, Any]] = []
    for k, surfaces in enumerate(drawn):
        motion = np.concatenate([_means(s.motion, g) for s, g in zip(surfaces, groups, strict=True)])
        modes.append({"title": mode_title(found, k), **_packed(motion)})
    held = {
        "points": floats(points.ravel()),
        "faces": base64.b64encode(faces.astype("<u2").tobytes()).decode("ascii"),
        "parts": parts,
        "modes": modes,
        "first": first,
    }
    buttons = "".join(
        f"<button type=button aria-pressed={'true' if k == first else 'false'}>{mode['title']}</button>"
        for k, mode in enumerate(modes)
    )
    told = f"{count} modes on the surfaces of {', '.join(parts)}; drag to turn"
    return (
        "<figure class=shapes><figcaption>Shapes, in motion; drag to turn</figcaption>"
        f"<div class=choice>{buttons}<button type=button class=play aria-pressed=true>moving</button></div>"
        f'<canvas role=img tabindex=0 aria-label="{told}"></canvas>'
        f"<script type=application/json>{json_text(held)}</script></figure>"
    )


def free_motions(found: xarray.Dataset) -> NDArray[np.bool_]:
    """Mode shapes (mode,) of a report that nothing holds, as a rotor's spin, found near 0 Hz."""
    frequency = np.asarray(found["frequency"].values, dtype=np.float64)
    return np.asarray(frequency <= FREE * np.median(frequency[:SHOWN]))


def first_elastic(found: xarray.Dataset, count: int) -> int:
    """Number, from 0, of the mode shape that a report opens with: the first that is no free motion."""
    return int(np.argmin(free_motions(found)[:count]))


def mode_title(found: xarray.Dataset, k: int) -> str:
    """Title of a report's mode shape: number and frequency, and damping where it has any."""
    if free_motions(found)[k]:
        return f"{k + 1}: free"
    damped = bool(found.attrs.get("damped"))
    zeta = f", ζ {100 * float(found['damping_ratio'].values[k]):.2g} %" if damped else ""
    return f"{k + 1}: {float(found['frequency'].values[k]):.4g} Hz{zeta}"


def _thinned(surfaces: list[Any]) -> tuple[Array, Index, list[Index], list[str]]:
    """Points (p, 3) and triangles (t, 3) of all parts, the group of each point of each part, and names."""
    points, faces, groups, names = [], [], [], []
    before = 0
    for s in surfaces:
        size = float(np.ptp(s.points, axis=0).max()) / CELLS or 1.0
        place = np.floor((s.points - s.points.min(axis=0)) / size).astype(np.int64)
        _, group = np.unique(place, axis=0, return_inverse=True)
        group = group.ravel()
        points.append(_means(s.points, group))
        quads = group[s.faces]
        triangles = quads if quads.shape[1] == 3 else np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (a != c)]
        _, first = np.unique(np.sort(triangles, axis=1), axis=0, return_index=True)
        faces.append(triangles[np.sort(first)] + before)
        groups.append(group)
        names.append(s.part)
        before += len(points[-1])
    return np.concatenate(points), np.concatenate(faces), groups, names


def _means(values: Any, group: Index) -> Any:
    """Mean (g, 3) of values (p, 3) over the points of each group."""
    count = np.bincount(group)[:, None]
    summed = np.zeros((len(count), values.shape[1]), dtype=values.dtype)
    np.add.at(summed, group, values)
    return summed / count


def _packed(motion: Complex) -> dict[str, str]:
    """A motion (p, 3) over its largest, as 16-bit integers; a quarter period later only where that moves."""
    largest = motion.ravel()[int(np.argmax(np.abs(motion)))]
    turned = motion / largest if largest else motion
    packed = {"re": _words(turned.real)}
    if float(np.abs(turned.imag).max()) > 1e-3:
        packed["im"] = _words(turned.imag)
    return packed


def _words(values: Array) -> str:
    words = np.round(np.clip(values, -1.0, 1.0) * 32767.0).astype("<i2")
    return base64.b64encode(words.tobytes()).decode("ascii")
