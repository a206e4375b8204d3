"""The figure of the shear strain in a layer's section, as its outer ring moves against the inner one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import require, vector
from bearingdyn.material import Elastic
from bearingdyn.parts import Layer
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.frame import finish, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CORNERS = 3.0  # times the strain that counts: the end of the colours


@figure(layer=one(Layer, maker="a bd.Layer(…)"))
def layer_strain(layer: Layer, relative: ArrayLike, ax: Axes | None = None) -> Axes:
    """Draw the shear strain of a layer's rubber in the section where it is largest, element by element.

    Parameters
    ----------
    layer
        The layer.
    relative
        (6,) motion of its outer interface against the inner one, m and rad, as `Layer.strain` takes it.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into; z to the right and r up, in mm.

    Raises
    ------
    ValueError
        For a layer of metal, and for a motion of another shape or none.
    """
    from matplotlib.collections import PolyCollection

    remedy = "a strain is asked of rubber"
    require(not isinstance(layer.material, Elastic), "material of the layer", layer.material, remedy)
    q = vector("relative", relative, (6,), "it must be (6,): x, y, z, θx, θy, θz of the outer interface")
    require(bool(q.any()), "relative", relative, "it must not be zero: give a motion, m and rad")
    mesh, whole = layer.body.mesh, layer.strain(q)
    gamma, volume = layer.body.strain_field(np.concatenate([np.zeros(6), q]))
    own, share = (x.reshape(*x.shape[:-1], len(mesh.elements), -1) for x in (gamma, volume))
    mean = np.sqrt((own**2 * share).sum(axis=-1) / share.sum(axis=-1))  # (azimuths, elements)
    at = int(np.argmax(mean.max(axis=1)))
    # the nodes of an element stand row by row, three by three
    corners = mesh.elements[:, [0, 2, 8, 6]]
    with style():
        ax = ax or new_axes()
        shapes = 1e3 * np.stack([mesh.z, mesh.r], axis=-1)[corners]
        field = PolyCollection([*shapes], cmap="viridis", linewidths=0)
        field.set_array(100 * mean[at])
        field.set_edgecolor("face")
        # bonded corners have no largest strain: their colour would leave one for all the rest
        field.set_clim(0.0, 100 * min(float(mean[at].max()), CORNERS * whole.logarithmic))
        ax.add_collection(field)
        ax.autoscale_view()
        ax.figure.colorbar(field, ax=ax, label="shear strain, %", extend="max")
        ax.set_aspect("equal")
        ax.set_xlabel("z, mm")
        ax.set_ylabel("r, mm")
        azimuth = 360.0 * at / len(mean)
        finish(ax, f"Strain at {azimuth:.0f}°; {whole.logarithmic:.2%} counts, {whole.rms:.2%} rms")
    return ax
