"""Built-in meshes of bricks: a box, a ring or a segment of one, an O-ring, a block with bore and feet."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import positive, whole
from bearingdyn.fem.meshes.solid_element import HEX20, HEX27
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, merged, second_order
from bearingdyn.types import Array, Index

BRICKS = (HEX20.name, HEX27.name)
SIDES = ("x-", "x+", "y-", "y+", "z-", "z+")


def crowded(a: float, b: float, count: int) -> Array:
    """Grid lines from a to b, crowded towards both: (a + b)/2 − (b − a)/2 cos(πi/count), i = 0...count.

    A soft layer bonded to something stiff has singular stresses where its free edge meets the bond.
    """
    if not (math.isfinite(a) and math.isfinite(b) and a < b and count >= 1):
        raise ValueError(f"lines from {a} to {b} in {count} steps: they must rise, in one step or more")
    lines = 0.5 * (a + b) - 0.5 * (b - a) * np.cos(np.pi * np.arange(count + 1) / count)
    lines[[0, -1]] = a, b
    return lines


def box_mesh(x: ArrayLike, y: ArrayLike, z: ArrayLike, element: str = "hex20") -> SolidMesh:
    """Bricks between grid lines x, y, z; surfaces "x-", "x+", "y-", "y+", "z-", "z+".

    Parameters
    ----------
    x, y, z
        Grid lines, m, each rising.
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For lines that do not rise, or an unknown element.
    """
    lines = [np.asarray(v, dtype=np.float64) for v in (x, y, z)]
    for name, v in zip("xyz", lines, strict=True):
        if v.ndim != 1 or v.size < 2 or not np.all(np.diff(v) > 0):
            raise ValueError(f"{name} is {v.tolist()}; it must be two grid lines or more, rising, m")
    shape = tuple(v.size for v in lines)
    p = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    i = np.arange(len(p)).reshape(shape)
    ends = (slice(None, -1), slice(1, None))
    corners = [i[tuple(ends[int(side)] for side in corner)].ravel() for corner in HEX20.corners]
    p, elements, _ = second_order(p, np.stack(corners, axis=1))
    surfaces = {
        f"{'xyz'[a]}{sign}": np.flatnonzero(p[:, a] == lines[a][end])
        for a in range(3)
        for sign, end in (("-", 0), ("+", -1))
    }
    return _with_kind(SolidMesh(p, elements, surfaces=surfaces), element)


def _with_kind(mesh: SolidMesh, element: str) -> SolidMesh:
    if element not in BRICKS:
        raise ValueError(f"element is {element!r}; the built-in meshes have {' or '.join(BRICKS)}")
    return mesh.with_centres() if element == HEX27.name else mesh


def ring_mesh(
    radii: Sequence[float],
    width: float,
    angle: tuple[float, float] | None = None,
    *,
    across: Sequence[int] | int = 4,
    along: int = 8,
    around: int = 24,
    regions: Sequence[str] = (),
    element: str = "hex27",
) -> SolidMesh:
    """A ring about z, or a segment of it, of concentric layers, each layer a region.

    Lines crowd towards the ends of the width, and towards both faces of each layer. Surfaces: "inner",
    "outer", "z-", "z+"; of a segment also "start" and "end".

    Parameters
    ----------
    radii
        Radii of the bore, the bonds and the outside, m, rising.
    width
        Extent along z, m, with its middle at z = 0.
    angle
        (from, to), rad; None: the whole ring.
    across, along, around
        Number of elements through each layer, over the width and over the angle.
    regions
        Names of the layers (default "layer 1", ...).
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For measures out of order, fewer than 6 elements around a whole ring, or a segment of a turn or more.
    """
    count = len(radii) - 1
    if not (count >= 1 and radii[0] > 0 and all(b > a for a, b in itertools.pairwise(radii))):
        raise ValueError(f"radii is {tuple(radii)}; it must be two radii or more, rising from above 0, m")
    positive("width", width, "it must be a positive length in m")
    names = tuple(regions) or tuple(f"layer {k + 1}" for k in range(count))
    steps = (across,) * count if isinstance(across, int) else tuple(across)
    if len(names) != count or len(steps) != count or len(set(names)) != count:
        raise ValueError(
            f"regions is {names} and across {steps}; {count} layers need a name of its own and a number each"
        )
    start, end = _angles(angle, around)
    r = np.concatenate(
        [crowded(a, b, n)[:-1] for (a, b), n in zip(itertools.pairwise(radii), steps, strict=True)]
        + [np.array([radii[-1]])]
    )
    flat = box_mesh(r, np.linspace(start, end, around + 1), crowded(-0.5 * width, 0.5 * width, along))
    flat = _with_kind(flat, element)
    middle = flat.points[flat.elements[:, :8], 0].mean(axis=1)
    layer = np.searchsorted(radii, middle) - 1
    kept = {"x-": "inner", "x+": "outer", "z-": "z-", "z+": "z+", "y-": "start", "y+": "end"}
    surfaces = {kept[name]: at for name, at in flat.surfaces.items()}
    layers = {name: np.flatnonzero(layer == k) for k, name in enumerate(names)}
    return _revolved(replace(flat, regions=layers, surfaces=surfaces), closed=angle is None)


def _revolved(flat: SolidMesh, closed: bool) -> SolidMesh:
    """A mesh whose points are (r, φ, z) laid out in space; closed: its ends, a turn apart, become one."""
    r, phi, z = flat.points.T
    p, elements, surfaces = (
        np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=1),
        flat.elements,
        flat.surfaces,
    )
    if closed:
        p, label = merged(p, 1e-9 * float(r.max()))
        elements = label[elements]
        surfaces = {n: label[at] for n, at in surfaces.items() if n not in ("start", "end")}
    return SolidMesh(p, elements, flat.regions, surfaces)


def o_ring_mesh(
    radius: float,
    cord: float,
    band: float,
    angle: tuple[float, float] | None = None,
    *,
    across: int = 4,
    around: int = 24,
    element: str = "hex27",
) -> SolidMesh:
    """An O-ring about z, or a segment of it, at rest between a shaft and a bore.

    Surfaces: "inner" and "outer", the bands; of a segment also "start" and "end".

    Parameters
    ----------
    radius
        Radius of the circle on which the cord's centre lies, m.
    cord
        Diameter of the cord, m.
    band
        Width along z, m, of the two strips by which the ring is held, the innermost and the outermost of its
        surface; 0.2 to 0.95 of the cord.
    angle
        (from, to), rad; None: the whole ring.
    across, around
        Number of elements across each band and over the angle.
    element
        "hex20" or "hex27".

    Raises
    ------
    ValueError
        For measures out of range.
    """
    if not (cord > 0 and 0.5 * cord < radius < math.inf):
        raise ValueError(f"cord is {cord} and radius {radius}; they must be positive, radius above cord/2, m")
    if not 0.2 * cord <= band <= 0.95 * cord:
        raise ValueError(
            f"band is {band}; it must lie in 0.2 to 0.95 of the cord, {0.2 * cord} to {0.95 * cord} m"
        )
    whole("across", across, 2)
    start, end = _angles(angle, around)
    a, half = 0.5 * cord, math.asin(band / cord)
    plane, quads = disc_section(a, half, crowded(0.0, 1.0, across), max(2, across // 2))
    p, elements, ends = second_order(*_extruded(plane, quads, np.linspace(start, end, around + 1)))
    skin = np.hypot(p[:, 0], p[:, 1]) > a * (1 - 1e-9)
    middle = len(p) - len(ends) + np.flatnonzero(skin[ends].all(axis=1))
    p[middle, :2] *= (a / np.hypot(*p[middle, :2].T))[:, None]
    skin[middle] = True
    held = skin & (np.abs(p[:, 1]) < 0.5 * band * (1 + 1e-9))
    surfaces = {
        "inner": np.flatnonzero(held & (p[:, 0] < 0)),
        "outer": np.flatnonzero(held & (p[:, 0] > 0)),
        "start": np.flatnonzero(p[:, 2] == start),
        "end": np.flatnonzero(p[:, 2] == end),
    }
    flat = SolidMesh(np.stack([radius + p[:, 0], p[:, 2], p[:, 1]], axis=1), elements, {}, surfaces)
    return _revolved(_with_kind(flat, element), closed=angle is None)


def disc_section(radius: float, half: float, share: Array, layers: int) -> tuple[Array, Index]:
    """Points (k, 2) and quadrilaterals (m, 4), clockwise, of a disc: a rectangle and four patches about it.

    Parameters
    ----------
    radius
        m.
    half
        Half the angle of the two patches at either end of the first axis, rad.
    share
        Grid lines over the arc of each patch, from 0 to 1.
    layers
        Elements from the rectangle to the circle.
    """
    core = 0.45
    sides = [-half + 2.0 * half * share, half + (math.pi - 2.0 * half) * share]
    sides += [arc + math.pi for arc in sides]
    corner = core * radius * np.exp(1j * np.array([-half, half, math.pi - half, math.pi + half, -half]))
    t = np.linspace(0.0, 1.0, layers + 1)[:, None]
    patches = []
    for k, arc in enumerate(sides):
        inside = corner[k] + share * (corner[k + 1] - corner[k])
        place = inside + t * (radius * np.exp(1j * arc) - inside)
        patches.append(_patch(place.real, place.imag))
    x, y = np.meshgrid((2 * share[::-1] - 1) * corner[1].real, (2 * share - 1) * corner[1].imag)
    patches.append(_patch(x, y))  # all clockwise, for (r, φ, z) is right-handed
    return _joined(patches, 1e-9 * 2.0 * radius)


def _angles(angle: tuple[float, float] | None, around: int) -> tuple[float, float]:
    start, end = (0.0, 2.0 * math.pi) if angle is None else angle
    if not (start < end and (angle is None or end - start < 2.0 * math.pi - 1e-6)):
        raise ValueError(f"angle is {angle}; it must be (from, to) in rad, less than a turn; None: the whole")
    least = 6 if angle is None else 1
    whole("around", around, least)
    return start, end


def _lines(stops: list[float], size: float, least: int = 1) -> Array:
    """Grid lines through all stops, no step longer than size, at least ``least`` steps between two stops."""
    sorted_stops = np.unique(np.round(np.array(stops), 12))
    parts = [sorted_stops[:1]]
    for a, b in itertools.pairwise(sorted_stops):
        parts.append(np.linspace(a, b, max(least, math.ceil((b - a) / size - 1e-9)) + 1)[1:])
    return np.concatenate(parts)


def _patch(x: Array, y: Array) -> tuple[Array, Index]:
    """Points (k, 2) and quadrilaterals (m, 4) of a structured grid; x and y are (rows, columns)."""
    i = np.arange(x.size).reshape(x.shape)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    return np.stack([x.ravel(), y.ravel()], axis=-1), quads


def _joined(patches: Sequence[tuple[Array, Index]], tolerance: float) -> tuple[Array, Index]:
    """Patches as one; points within the tolerance become one."""
    offsets = np.cumsum([0] + [len(p) for p, _ in patches])
    plane, label = merged(np.vstack([p for p, _ in patches]), tolerance)
    return plane, label[np.vstack([q + o for (_, q), o in zip(patches, offsets[:-1], strict=True)])]


def _extruded(plane: Array, quads: Index, z: Array) -> tuple[Array, Index]:
    """Points (k, 3) and bricks (m, 8) of a plane mesh at heights z."""
    points = np.hstack([np.tile(plane, (len(z), 1)), np.repeat(z, len(plane))[:, None]])
    lower = (quads[None] + len(plane) * np.arange(len(z) - 1)[:, None, None]).reshape(-1, 4)
    return points, np.hstack([lower, lower + len(plane)])


def block_with_bore(
    width: float,
    height: float,
    length: float,
    bore_diameter: float,
    bore_height: float,
    element_size: float,
    flange: tuple[float, float] | None = None,
    strip: float | None = None,
    element: str = "hex20",
) -> SolidMesh:
    """Structured mesh of bricks of a block with a round bore through it along z.

    The origin is on the bore's axis at mid-length. The nodes of the bore lie on its circle, and its edges are
    quadratic. Surfaces: "bore", "base", "top", "front" (at +z), "back"; "feet": the undersides of the
    flanges, the strips, or the base; "outside": all but the bore and the base. The measures must be
    consistent; parts.Housing checks them.

    Parameters
    ----------
    width, height, length
        Extent along x, y and z, m.
    bore_diameter
        Diameter of the bore, m.
    bore_height
        Height of the bore's axis above the base, m.
    element_size
        Longest wanted side of an element, m.
    flange
        (width, height), m, of two flanges on the sides at the base; None: none.
    strip
        Width, m, of two strips along the base at either side, which grid lines bound; None: none.
    element
        "hex20" or "hex27".
    """
    r, half, base, top = 0.5 * bore_diameter, 0.5 * width, -bore_height, height - bore_height
    low = base if bore_height - top < element_size else -top  # a box about the bore, the pedestal below it
    x = _lines([-half, 0.0, half] + ([strip - half, half - strip] if strip else []), element_size, 2)
    shelf = [base + flange[1]] if flange else []
    y = _lines([low, 0.0, top, *(s for s in shelf if low < s < top)], element_size, 2)
    layers = max(2, round((math.sqrt(width * (top - low) / math.pi) - r) / element_size))
    patches = []
    t = np.linspace(1.0, 0.0, layers + 1)[:, None]  # inward, so that all patches turn the same way
    for px, py in (
        (x, np.full_like(x, low)),
        (np.full_like(y, half), y),
        (x[::-1], np.full_like(x, top)),
        (np.full_like(y, -half), y[::-1]),
    ):
        rho = np.hypot(px, py)
        patches.append(_patch(px * (t + (1.0 - t) * r / rho), py * (t + (1.0 - t) * r / rho)))
    side = y
    if low > base:
        below = _lines([base, low, *(s for s in shelf if base < s < low)], element_size)
        patches.append(_patch(*np.meshgrid(x, below)))
        side = np.concatenate([below[:-1], y])
    if flange:
        out = _lines([half, half + flange[0]], element_size)
        foot = side[side <= shelf[0] + 1e-9 * height]
        patches += [_patch(*np.meshgrid(out, foot)), _patch(*np.meshgrid(-out[::-1], foot))]
    plane, quads = _joined(patches, 1e-6 * element_size)
    z = _lines([-0.5 * length, 0.5 * length], element_size, 2)

    p, elements, _ = second_order(*_extruded(plane, quads, z))
    rho = np.hypot(p[:, 0], p[:, 1])
    bore = rho < r * (1.0 + 1e-9)  # nodes on the bore, and the middles of its chords
    p[bore, :2] *= (r / rho[bore])[:, None]
    near = 1e-6 * element_size
    on_base = np.abs(p[:, 1] - base) < near
    foot_from = half if flange else half - strip if strip else 0.0
    surfaces = {
        "bore": np.flatnonzero(bore),
        "base": np.flatnonzero(on_base),
        "feet": np.flatnonzero(on_base & (np.abs(p[:, 0]) > foot_from - near)),
        "top": np.flatnonzero(np.abs(p[:, 1] - top) < near),
        "front": np.flatnonzero(np.abs(p[:, 2] - 0.5 * length) < near),
        "back": np.flatnonzero(np.abs(p[:, 2] + 0.5 * length) < near),
    }
    skin = SolidMesh(p, elements).boundary
    other = ~(bore[skin].all(axis=1) | on_base[skin].all(axis=1))
    surfaces["outside"] = np.unique(skin[other])
    return _with_kind(SolidMesh(p, elements, surfaces=surfaces), element)
