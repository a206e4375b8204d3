"""Figures of modes on the parts' own geometry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis import Equilibrium, MovedSurface, mode_surfaces
from bearingdyn.application import Application
from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import STYLE, style
from bearingdyn.system import System
from bearingdyn.types import Array, Index

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


SWING = 0.08  # of the size of the structure, by which the largest motion is drawn
MAP = "YlOrRd"
EDGE = 0.8  # cosine of the angle between two faces from which on their common edge is drawn
SHADE = 0.55  # of its colour that a face seen along its plane keeps
LIGHT = np.array([0.3, -0.5, 0.8])  # where the light comes from, in the axes z, x, y of the figure
TO_FIGURE = [2, 0, 1]  # z along the figure's first axis, y up


@figure(found=result("bd.modes", "frequency", "shape"))
def mode_geometry(
    source: Equilibrium | Application | System,
    found: xarray.Dataset,
    mode: int,
    ax: Axes | None = None,
    *,
    scale: float | None = None,
    parts: Sequence[str] | None = None,
) -> Axes:
    """Geometry of one mode by `bd.modes`: surfaces of the parts coloured by how far they move, edges at rest.

    Phases are turned so that the largest motion is real. The colour is the amplitude √(|x|² + |y|² + |z|²).

    Parameters
    ----------
    source
        What the modes are of; an Application is needed for parts with a surface.
    found
        Result of `bd.modes`.
    mode
        Its place in `found`, counted from 0.
    ax
        Axes to draw into, of projection "3d"; None: those of a new figure.
    scale
        Factor on the mode as drawn; None: its largest motion is 8 % of the structure's size.
    parts
        Names of the parts drawn; None: all that have a surface.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        As `bd.mode_surfaces`.
    """
    surfaces, factor = _drawn(source, found, mode, scale, parts)
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    largest = max(float(_amplitude(s).max()) for s in surfaces) or 1.0
    polygons: list[Array] = []
    colours: list[Array] = []
    edges: list[Array] = []
    for s in surfaces:
        rest, now = (1e3 * p[:, TO_FIGURE] for p in (s.points, s.points + factor * s.motion.real))
        level = _amplitude(s) / largest
        polygons += list(now[s.faces])
        shade = SHADE + (1.0 - SHADE) * np.abs(_normals(now[s.faces]) @ (LIGHT / np.linalg.norm(LIGHT)))
        colour = colormaps[MAP](level[s.faces].mean(axis=1))
        colour[:, :3] *= shade[:, None]
        colours.append(colour)
        edges.append(rest[_sharp(rest, s.faces)])
    on: Any = ax
    with style():
        if on is None:
            import matplotlib.pyplot as plt

            figure = plt.figure(figsize=(7.4, 4.6), layout="constrained")
            on = figure.add_subplot(projection="3d", proj_type="ortho")
            on.view_init(elev=20.0, azim=-60.0)
        shown = np.concatenate(colours)
        for drawn in (
            Poly3DCollection(polygons, facecolors=shown, edgecolors=shown, linewidths=0.2),
            Line3DCollection(np.concatenate(edges), colors="0.35", linewidths=0.35),
        ):
            drawn.set_clip_on(False)
            on.add_collection3d(drawn)
        _frame(on, np.concatenate([*polygons, *(e.reshape(-1, 3) for e in edges)]))
        bar = on.figure.colorbar(ScalarMappable(cmap=MAP), ax=on, shrink=0.6, pad=0.12)
        bar.set_label("displacement over the largest", size=STYLE["axes.labelsize"])
        frequency, damping = (float(found[name].values[mode]) for name in ("frequency", "damping_ratio"))
        said = f", ζ = {100 * damping:.2g} %" if found.attrs.get("damped") else ""
        on.set_title(f"Mode {mode + 1} at {frequency:.4g} Hz{said}", loc="left")
    drawn_in: Axes = on
    return drawn_in


@figure(found=result("bd.modes", "frequency", "shape"))
def mode_scene(
    source: Equilibrium | Application | System,
    found: xarray.Dataset,
    mode: int,
    *,
    scale: float | None = None,
    parts: Sequence[str] | None = None,
) -> Any:
    """What `mode_geometry` draws as a pyvista.MultiBlock; `.plot(scalars="amplitude")` shows it.

    Data of the points: displacement (p, 3) and amplitude (p,), over the largest amplitude, and rest (p, 3),
    m, where they stand. `.save("mode.vtm")` writes it for ParaView.

    Parameters
    ----------
    source
        What the modes are of; an Application is needed for parts with a surface.
    found
        Result of `bd.modes`.
    mode
        Its place in `found`, counted from 0.
    scale
        Factor on the mode as drawn; None: its largest motion is 8 % of the structure's size.
    parts
        Names of the parts drawn; None: all that have a surface.

    Raises
    ------
    ImportError
        Without pyvista.
    ValueError
        As `bd.mode_surfaces`.
    """
    try:
        from importlib import import_module

        pyvista = import_module("pyvista")
    except ImportError:
        raise ImportError(
            "mode_scene needs pyvista: pip install bearingdyn[scene]; mode_geometry draws without"
        ) from None
    surfaces, factor = _drawn(source, found, mode, scale, parts)
    largest = max(float(_amplitude(s).max()) for s in surfaces) or 1.0
    scene = pyvista.MultiBlock()
    for s in surfaces:
        cells = np.insert(s.faces, 0, s.faces.shape[1], axis=1)
        block = pyvista.PolyData(s.points + factor * s.motion.real, cells.ravel())
        block["displacement"] = s.motion.real / largest
        block["amplitude"] = _amplitude(s) / largest
        block["rest"] = s.points
        scene.append(block, s.part)
    return scene


def _drawn(
    source: Equilibrium | Application | System,
    found: xarray.Dataset,
    mode: int,
    scale: float | None,
    parts: Sequence[str] | None,
) -> tuple[list[MovedSurface], float]:
    """The surfaces with their phases turned, and times what their motion is drawn."""
    if scale is not None and not np.isfinite(scale):
        raise ValueError(f"scale is {scale}; it must be finite, or None for a scale that fits the picture")
    surfaces = mode_surfaces(source, found, mode, parts)
    motion = np.concatenate([s.motion for s in surfaces]).ravel()
    largest = motion[int(np.argmax(np.abs(motion)))]
    turn = abs(largest) / largest if largest else 1.0
    turned = [MovedSurface(s.part, s.points, s.faces, s.motion * turn) for s in surfaces]
    size = float(np.ptp(np.concatenate([s.points for s in surfaces]), axis=0).max())
    own = SWING * size / abs(largest) if largest else 0.0
    return turned, own if scale is None else scale


def _amplitude(surface: MovedSurface) -> Array:
    return np.asarray(np.linalg.norm(np.abs(surface.motion), axis=1))


def _normals(polygons: Array) -> Array:
    """Unit normals (f, 3) of polygons (f, q, 3), by Newell's sum; zero of those without area."""
    normal = np.cross(polygons, np.roll(polygons, -1, axis=1)).sum(axis=1)
    return np.asarray(normal / np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None])


def _sharp(points: Array, faces: Index) -> Index:
    """Edges (e, 2) at which a surface turns sharply, or ends."""
    normals = np.repeat(_normals(points[faces]), faces.shape[1], axis=0)
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    edges, which, count = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
    pair = np.argsort(which.ravel(), kind="stable")
    first = np.cumsum(count) - count
    last = first + count - 1
    cosine = np.abs(np.sum(normals[pair[first]] * normals[pair[last]], axis=1))
    return np.asarray(edges[(count == 1) | (cosine < EDGE)])


def _frame(ax: Any, points: Array) -> None:
    """Equal scales, few ticks, names of the axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
    ax.set_box_aspect(high - low, zoom=1.1)
    for axis, name in zip((ax.xaxis, ax.yaxis, ax.zaxis), "zxy", strict=True):
        axis.set_label_text(f"{name}, mm")
        axis.label.set_fontsize(STYLE["axes.labelsize"])
        axis.set_pane_color((1.0, 1.0, 1.0, 0.0))
        axis.set_major_locator(_few())
    ax.tick_params(labelsize=8.0)
    ax.grid(False)


def _few() -> Any:
    from matplotlib.ticker import MaxNLocator

    return MaxNLocator(4)
