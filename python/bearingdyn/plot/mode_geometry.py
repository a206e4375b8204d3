"""Figures of modes on the parts' own geometry."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis import Equilibrium, MovedSurface, mode_surfaces
from bearingdyn.application import Application
from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import STYLE, style
from bearingdyn.plot.surfaces_in_space import TO_FIGURE, axes_in_space, draw_surfaces, shaded, sharp_edges
from bearingdyn.system import System
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


SWING = 0.08  # of the size of the structure, by which the largest motion is drawn
MAP = "YlOrRd"


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
    """Draw the geometry of one mode by `bd.modes`: surfaces coloured by how far they move, edges at rest.

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

    largest = max(float(_amplitude(s).max()) for s in surfaces) or 1.0
    polygons: list[Array] = []
    colours: list[Array] = []
    edges: list[Array] = []
    for s in surfaces:
        rest, now = (1e3 * p[:, TO_FIGURE] for p in (s.points, s.points + factor * s.motion.real))
        level = _amplitude(s) / largest
        polygons += list(now[s.faces])
        colours.append(shaded(colormaps[MAP](level[s.faces].mean(axis=1)), now[s.faces]))
        edges.append(rest[sharp_edges(rest, s.faces)])
    on: Any = ax
    with style():
        if on is None:
            on = axes_in_space()
        draw_surfaces(on, polygons, np.concatenate(colours), np.concatenate(edges))
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
