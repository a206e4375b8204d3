"""The figure of a deformed solid: its surface, coloured by the largest stretch, and its edges before."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.checks import require
from bearingdyn.fem import SolidMesh, by_size
from bearingdyn.parts import SolidPrestress, Squeezed
from bearingdyn.plot.arguments import figure
from bearingdyn.plot.frame import GREY, STYLE, style
from bearingdyn.plot.surfaces_in_space import (
    TO_FIGURE,
    axes_in_space,
    draw_surfaces,
    in_space,
    shaded,
    sharp_edges,
)
from bearingdyn.types import Array, Index

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAP = "viridis"
PALE = 0.8  # of its colour that a face along the light keeps: the scale must stay readable


@figure(ax=in_space)
def squeezed_solid(squeezed: Squeezed, ax: Axes | None = None) -> Axes:
    """Draw the surface of a deformed solid, coloured by its largest stretch, in mm.

    Dashed lines are its edges before. The colour of a face is the mean over its nodes, each of these the mean
    of the elements around it: at the edge of a bond the largest stretch is above it.

    Parameters
    ----------
    squeezed
        As Solid.assembled returns it.
    ax
        Axes to draw into, of projection "3d"; None: those of a new figure. `ax.view_init` turns it.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For anything else.
    """
    from matplotlib import colormaps
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from mpl_toolkits.mplot3d.art3d import Line3DCollection

    prestress = getattr(getattr(squeezed, "part", None), "prestress", None)
    require(
        isinstance(prestress, SolidPrestress), "squeezed", squeezed, "it must be what Solid.assembled returns"
    )
    assert isinstance(prestress, SolidPrestress)
    mesh, before = prestress.mesh, prestress.state.body.mesh
    rings = _rings(mesh)
    polygons = [1e3 * mesh.points[ring][:, TO_FIGURE] for ring in rings]
    stretch = np.array([prestress.stretch[ring].mean() for ring in rings])
    scale = Normalize(1.0, max(float(stretch.max()), 1.0 + 1e-6))
    colours = colormaps[MAP](scale(stretch))
    light = np.stack([polygon[[0, 2, 4]] for polygon in polygons])
    on: Any = ax
    with style():
        if on is None:
            on = axes_in_space()
        draw_surfaces(on, polygons, shaded(colours, light, PALE), _edges(mesh))
        ghost = Line3DCollection(_edges(before), colors=GREY, linewidths=0.9, linestyles="--", label="before")
        ghost.set_clip_on(False)
        on.add_collection3d(ghost)
        bar = on.figure.colorbar(ScalarMappable(scale, MAP), ax=on, shrink=0.6, pad=0.12)
        bar.set_label("largest stretch", size=STYLE["axes.labelsize"])
        bar.ax.tick_params(labelsize=8.0)
        told = f"{squeezed.squeezed}: {squeezed.force:.4g} N, {squeezed.pressure / 1e6:.2f} MPa"
        on.set_title(told, loc="left", pad=12.0)
        on.legend(loc="upper right", frameon=False)
    drawn_in: Axes = on
    return drawn_in


def _rings(mesh: SolidMesh) -> list[Index]:
    """Nodes around each face of the boundary, corners and middles in turn."""
    found: list[Index] = []
    for rows, n in by_size(mesh.boundary):
        corners = 3 if n == 6 else 4
        around = np.arange(2 * corners).reshape(2, -1).T.ravel()
        found += list(mesh.boundary[rows][:, around])
    return found


def _edges(mesh: SolidMesh) -> Array:
    """Sharp edges of the boundary, each side in two halves, (e, 2, 3) mm."""
    found = []
    for rows, n in by_size(mesh.boundary):
        corners = 3 if n == 6 else 4
        faces = mesh.boundary[rows]
        sharp = sharp_edges(mesh.points, faces[:, :corners])
        middle = {
            tuple(sorted((int(f[k]), int(f[(k + 1) % corners])))): int(f[corners + k])
            for f in faces
            for k in range(corners)
        }
        for a, b in sharp.tolist():
            m = middle[min(a, b), max(a, b)]
            found += [(a, m), (m, b)]
    return 1e3 * mesh.points[np.array(found)][..., TO_FIGURE]
