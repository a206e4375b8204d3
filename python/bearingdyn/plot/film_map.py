"""The figure of the film or the pressure of one lubricated contact, seen from above."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from bearingdyn.bearing import ehl
from bearingdyn.checks import one_of
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.frame import GREY, finish, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 1.6  # half the picture, over the dry contact's semi-axes
RANGE = 1.6  # thickest film told apart, over that at the centre


@figure(contact=one(ehl.SolvedContact, maker="what bearing.ehl.solve returns: the table has no maps"))
def film_map(
    contact: ehl.SolvedContact, ax: Axes | None = None, *, quantity: Literal["film", "pressure"] = "film"
) -> Axes:
    """Draw film, µm, or pressure, GPa, of a lubricated contact; rolling carries the oil to the right.

    A dashed ellipse is the dry contact. Both directions have scales of their own where the contact is long.

    Parameters
    ----------
    contact
        As `bearing.ehl.solve` returns it.
    ax
        Axes to draw into; None: those of a new figure.
    quantity
        "film" or "pressure".

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For anything but a solved contact, and an unknown quantity.
    """
    one_of("quantity", quantity, ("film", "pressure"))
    b, a = contact.contact.semi_axes(contact.F)
    if quantity == "film":
        centre = contact.hc * 1e6
        values, unit, title = contact.film * 1e6, "film, µm", f"Film, {centre:.3g} µm at the centre"
        # hmin is extrapolated from the grids and may lie above this one's
        levels = np.linspace(min(contact.hmin * 1e6, float(values.min())), RANGE * centre, 25)
    else:
        highest = float(contact.pressure.max()) / 1e9
        values, unit, title = contact.pressure / 1e9, "pressure, GPa", f"Pressure, at most {highest:.3g} GPa"
        levels = np.linspace(0.0, highest, 25)
    with style():
        ax = ax or new_axes(width=5.6)
        x, y = contact.x * 1e6, contact.y * 1e6
        drawn = ax.contourf(
            x, y, values, levels=levels, cmap="viridis", extend="max" if quantity == "film" else "neither"
        )
        ax.figure.colorbar(drawn, ax=ax, label=unit, format="%.3g")
        turn = np.linspace(0, 2 * np.pi, 200)
        ax.plot(a * 1e6 * np.cos(turn), b * 1e6 * np.sin(turn), "--", color=GREY, linewidth=0.8)
        ax.set_xlim(-SHOWN * a * 1e6, SHOWN * a * 1e6)
        ax.set_ylim(-SHOWN * b * 1e6, SHOWN * b * 1e6)
        if b < 2 * a:
            ax.set_aspect("equal")
        ax.set_xlabel("along the rolling direction, µm")
        ax.set_ylabel("across, µm")
        finish(ax, title)
    return ax
