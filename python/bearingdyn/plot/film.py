"""The figure of the lubricant films of a bearing over speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing import BallBearing, Lubricant, lubricate
from bearingdyn.plot.arguments import figure
from bearingdyn.plot.frame import colour, finish, frame_log, halve, new_axes, style, written_out
from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure()
def film(
    bearing: BallBearing,
    lubricant: Lubricant,
    temperatures: ArrayLike,
    speeds: ArrayLike,
    load: ArrayLike,
    ax: Axes | None = None,
    *,
    roughness: tuple[float, float] | None = None,
    starvation: float = 1.0,
) -> Axes:
    """Draw central films of both races against speed, rpm, coloured by temperature in °C; with roughness, λ.

    With a roughness the axes are halved, and λ, the film over the composite roughness, stands below.

    Parameters
    ----------
    bearing
        Its own film and damping are not used.
    lubricant
        Oil, or base oil of a grease.
    temperatures
        (k,) at the inlet of the contacts, °C.
    speeds
        (n,) of the inner ring, rad/s, increasing and positive.
    load
        (6,) on the inner ring, N and N m.
    ax
        Axes to draw into; None: those of a new figure.
    roughness
        Rms roughness of race and ball, m.
    starvation
        Film over fully flooded film, in 0..1.

    Returns
    -------
    Axes
        The axes of the film.

    Raises
    ------
    ValueError
        For speeds that do not increase from above zero, and as `bearing.lubricate`.
    """
    omega = np.asarray(speeds, dtype=np.float64)
    if omega.ndim != 1 or omega.size < 2 or not (omega > 0).all() or not (np.diff(omega) > 0).all():
        raise ValueError("speeds must be two or more positive numbers that increase, in rad/s")
    grid: Array = np.atleast_1d(np.asarray(temperatures, dtype=np.float64))
    found = {
        float(T): [
            lubricate(
                bearing,
                lubricant,
                float(T),
                float(s),
                load,
                law="nijenbanning-venner-moes",
                roughness=roughness,
                starvation=starvation,
            )
            for s in omega
        ]
        for T in grid
    }
    rpm = omega * 30 / np.pi
    with style():
        ax = ax or new_axes(height=3.4 if roughness is None else 4.8)
        lower = None if roughness is None else halve(ax)
        films = np.zeros(0)
        for k, (T, points) in enumerate(found.items()):
            for race, dash in (("inner", "-"), ("outer", "--")):
                h = [getattr(point, f"film_{race}") * 1e6 for point in points]
                films = np.append(films, h)
                ax.plot(rpm, h, color=colour(k), linestyle=dash, label=f"{race} race, {T:g} °C")
                if lower is not None:
                    ratio = [getattr(point, f"lambda_{race}") for point in points]
                    lower.plot(rpm, ratio, color=colour(k), linestyle=dash)
        ax.set_yscale("log")
        ax.set_ylabel("central film, µm")
        bottom = lower or ax
        bottom.set_xscale("log")
        bottom.set_xlim(float(rpm[0]), float(rpm[-1]))
        bottom.set_xlabel("speed of the inner ring, rpm")
        written_out(bottom.xaxis, float(np.log10(rpm[-1] / rpm[0])))
        frame_log(ax, films)
        if lower is not None:
            lower.set_yscale("log")
            lower.axhline(1.0, color="0.35", linewidth=0.7)
            lower.set_ylabel("λ ratio")
            finish(lower)
        finish(ax, "Lubricant film", legend=True)
    return ax
