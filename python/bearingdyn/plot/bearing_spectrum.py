"""The figure of a spectrum with the lines of a bearing named."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.bearing import BallBearing, fault_lines
from bearingdyn.bearing import waviness_lines as lines_of_waviness
from bearingdyn.plot.arguments import figure, results
from bearingdyn.plot.frame import new_axes, style
from bearingdyn.plot.spectrum import spectrum

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


@figure(datasets=results("bd.spectrum", "frequency", "amplitude"))
def bearing_spectrum(
    datasets: Mapping[str, xarray.Dataset],
    bearing: BallBearing,
    speed: float,
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
    harmonics: int = 1,
    waviness: bool = False,
    contact_angle: float | None = None,
) -> Axes:
    """Draw spectra as `spectrum` does, with the lines of the bearing's faults, or waviness, named.

    A wave at the frequency of a fault goes by the name of the fault.

    Parameters
    ----------
    datasets
        Spectra by label, as `spectrum` takes them.
    bearing
        The bearing whose lines are named.
    speed
        Of the inner ring, rad/s.
    ax
        Axes to draw into; None: those of a new figure.
    f_max
        Highest frequency drawn, Hz; None: the whole of the spectra.
    harmonics
        Multiples of the ball passes.
    waviness
        Name the lines of waviness too.
    contact_angle
        Of the loaded state, rad.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        As `spectrum`, `fault_lines` and `waviness_lines`.
    """
    lines = fault_lines(bearing, speed, harmonics=harmonics, contact_angle=contact_angle)
    if waviness:
        waves = lines_of_waviness(bearing, speed, multiples=harmonics, contact_angle=contact_angle)
        known = list(lines.values())
        lines |= {name: f for name, f in waves.items() if not np.isclose(known, f, rtol=1e-9).any()}
        if ax is None:
            with style():
                ax = new_axes(width=6.8, height=4.8)  # room for the names
    return spectrum(datasets, lines, ax, f_max=f_max)
