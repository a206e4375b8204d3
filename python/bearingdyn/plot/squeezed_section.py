"""The figure of a squeezed body of revolution: its section before and after, stretch and pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import require
from bearingdyn.parts import Prestress, Squeezed
from bearingdyn.plot.arguments import figure
from bearingdyn.plot.frame import COLOURS, GREY, finish, new_axes, style
from bearingdyn.types import Array, Index

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# an element's nodes as eight triangles
TRIANGLES = ((0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (3, 6, 7), (3, 7, 4), (4, 7, 8), (4, 8, 5))


@figure()
def squeezed_section(squeezed: Squeezed, ax: Axes | None = None) -> Axes:
    """Draw the section of a squeezed body of revolution, coloured by its largest stretch, in mm.

    A dashed line is the body before; thick lines are where rigid surfaces touch it, with the mean pressure on
    each.

    Parameters
    ----------
    squeezed
        As Layer.assembled, ORing.assembled or Revolved.assembled return it.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For anything else.
    """
    from matplotlib.tri import Triangulation

    prestress = getattr(getattr(squeezed, "part", None), "prestress", None)
    require(isinstance(prestress, Prestress), "squeezed", squeezed, "it must be what Layer.assembled returns")
    assert isinstance(prestress, Prestress)
    state = prestress.state
    mesh, before = state.mesh, state.body.mesh
    with style():
        ax = ax or new_axes()
        stretch = _nodal(mesh.elements, state.elements.stretches[..., -1], mesh.r.size)
        eighths = mesh.elements[:, np.array(TRIANGLES)].reshape(-1, 3)
        drawn = ax.tripcolor(
            Triangulation(1e3 * mesh.z, 1e3 * mesh.r, eighths),
            stretch,
            shading="gouraud",
            cmap="viridis",
            vmin=1.0,
            vmax=max(float(stretch.max()), 1.0 + 1e-6),
        )
        ax.figure.colorbar(drawn, ax=ax, label="largest stretch")
        for k, side in enumerate(before.outline_sides):
            label = "before" if k == 0 else None
            ax.plot(1e3 * before.z[side], 1e3 * before.r[side], "--", color=GREY, linewidth=0.8, label=label)
        for k, (name, face) in enumerate(prestress.faces.items()):
            for i, side in enumerate(face.sides):
                label = f"{name}: {squeezed.pressures[name] / 1e6:.2f} MPa" if i == 0 else None
                ax.plot(
                    1e3 * mesh.z[side], 1e3 * mesh.r[side], color=COLOURS[1 + k], linewidth=2.5, label=label
                )
        ax.set_aspect("equal")
        ax.set_xlabel("z, mm")
        ax.set_ylabel("r, mm")
        finish(ax, f"Squeezed by {squeezed.force:.4g} N", legend=True)
    return ax


def _nodal(elements: Index, values: Array, nodes: int) -> Array:
    """Values at the integration points of elements (m, 9), as means at the nodes (nodes,)."""
    x = np.sqrt(0.6)
    # to the nodes of a square from its 3×3 Gauss points: products of the line's extrapolation
    line = np.linalg.inv(np.array([[0.5 * g * (g - 1), 1 - g * g, 0.5 * g * (g + 1)] for g in (-x, 0.0, x)]))
    own = values @ np.kron(line, line).T
    total = np.bincount(elements.ravel(), own.ravel(), nodes)
    return np.asarray(total / np.bincount(elements.ravel(), minlength=nodes), dtype=np.float64)
