"""The figure of the stiffness and damping of lubricated contacts over frequency."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing import ehl
from bearingdyn.checks import require
from bearingdyn.plot.arguments import figure, several
from bearingdyn.plot.frame import colour, finish, halve, new_axes, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure(contacts=several(ehl.LubricatedContact, maker="what bearing.ehl.solve or look_up returns"))
def contact_damping(
    contacts: Mapping[str, ehl.LubricatedContact], frequency: ArrayLike, ax: Axes | None = None
) -> Axes:
    """Draw c(ω), N s/m, of lubricated contacts, and below it K(ω) over the stiffness of the dry contact.

    A thin line is c0, the viscous damping of low frequency, and a dot where c(ω) is 10 % off it.

    Parameters
    ----------
    contacts
        As `bearing.ehl.solve` or `bearing.ehl.look_up` returns them, by label.
    frequency
        (f,) Hz, positive and increasing.
    ax
        Axes to draw into, which are halved; None: those of a new figure.

    Returns
    -------
    Axes
        The axes of the damping.

    Raises
    ------
    ValueError
        Without contacts, for anything but lubricated contacts, and frequencies that do not increase from
        above zero.
    """
    f = np.asarray(frequency, dtype=np.float64)
    rising = f.ndim == 1 and f.size > 1 and bool((f > 0).all() and (np.diff(f) > 0).all())
    require(rising, "frequency", frequency, "give two or more positive frequencies that increase, in Hz")
    with style():
        ax = ax or new_axes(height=4.6)
        lower = halve(ax)
        for k, (label, one) in enumerate(contacts.items()):
            answer = one.stiffness(f)
            c = answer.imag / (2 * np.pi * f)
            ax.semilogx(f, c, color=colour(k), label=label)
            ax.axhline(one.c0, color=colour(k), linewidth=0.5)
            limit = one.viscous_limit
            if f[0] <= limit <= f[-1]:
                ax.plot([limit], [np.interp(limit, f, c)], "o", color=colour(k), markersize=3.5)
            lower.semilogx(f, answer.real / one.dry_stiffness, color=colour(k))
        ax.set_ylim(0.0)
        ax.set_xlim(f[0], f[-1])
        ax.set_ylabel("c(ω), N s/m")
        lower.set_ylabel("K(ω) / K dry")
        lower.set_xlabel("frequency, Hz")
        finish(lower)
        finish(ax, "Contact damping", legend=True)
    return ax
