"""The figure of a rubber's softening: storage modulus and loss factor over the amplitude of strain."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import require
from bearingdyn.material import Payne
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.frame import COLOURS, GREY, finish, halve, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure(law=one(Payne, maker="a law that bd.fit_payne(…) found"))
def strain_softening(law: Payne, ax: Axes | None = None) -> Axes:
    """Draw G′ and, below, tan δ over the strain amplitude: points of a sweep, and the law fitted to them.

    Shaded is the range of strain that was trusted in the fit; a dotted line is the strain of the isotherms.

    Parameters
    ----------
    law
        With the report of its fit.
    ax
        Axes to draw into, which are halved; None: those of a new figure.

    Returns
    -------
    Axes
        The upper ones.

    Raises
    ------
    ValueError
        For a law that comes from no sweep: what it is added to is not known.
    """
    fit = law.fit
    remedy = "it comes from no strain sweep, and what it is added to is not known: take that of bd.fit_payne"
    require(fit is not None, "law", law, remedy)
    assert fit is not None
    low, high = law.strains or (float(fit.strain.min()), float(fit.strain.max()))
    gamma = np.geomspace(min(low, law.gamma_r) / 3.0, 1.5 * high, 200)
    G = fit.linear + law.modulus(gamma)
    with style():
        upper = ax or new_axes(height=4.2)
        lower = halve(upper)
        for panel, curve, points in (
            (upper, 1e-6 * G.real, 1e-6 * fit.storage),
            (lower, G.imag / G.real, fit.loss / fit.storage),
        ):
            panel.axvspan(100 * low, 100 * high, color="0.93", label="trusted")
            panel.axvline(100 * law.gamma_r, color=GREY, linestyle=":", linewidth=0.8, label="isotherms")
            panel.semilogx(100 * gamma, curve, color=COLOURS[0], label="law")
            panel.semilogx(100 * fit.strain, points, "o", color=COLOURS[1], markersize=3.0, label="sweep")
        upper.set_ylabel("G′, MPa")
        lower.set_ylabel("tan δ")
        lower.set_xlabel("shear strain amplitude, %")
        finish(lower)
        finish(upper, f"Softening at {fit.frequency:g} Hz", legend=True)
    return upper
