"""The figure of the stiffness of layers over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.parts import Layer
from bearingdyn.plot.arguments import figure, several
from bearingdyn.plot.frame import colour, finish, new_axes, some, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure(layers=several(Layer, maker="a bd.Layer(…)"))
def layer_stiffness(layers: Mapping[str, Layer], frequency: ArrayLike, ax: Axes | None = None) -> Axes:
    """Draw the stiffness |k| of layers, held outside, moved inside, over frequency; axial dashed.

    Parameters
    ----------
    layers
        Layers by label.
    frequency
        (f,) Hz, positive; a static solution is made at each.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For frequencies that are not positive and finite.
    """
    f = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
    if f.ndim != 1 or f.size == 0 or not (np.isfinite(f).all() and (f > 0).all()):
        raise ValueError("frequency must be a list of positive, finite values, in Hz")
    with style():
        ax = ax or new_axes()
        for k, (label, layer) in enumerate(some(layers).items()):
            stiffness = np.array([layer.stiffness(2 * np.pi * value) for value in f])
            for way, i, dash in (("radial", 0, "-"), ("axial", 2, "--")):
                ax.loglog(
                    f, np.abs(stiffness[:, i, i]), color=colour(k), linestyle=dash, label=f"{label}, {way}"
                )
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("dynamic stiffness |k|, N/m")
        finish(ax, "Stiffness of layers", legend=True)
    return ax
