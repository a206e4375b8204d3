"""Orbits: two recorded channels against each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bearingdyn.results import signal_of

if TYPE_CHECKING:
    import xarray


def orbit(result: xarray.Dataset, x: str, y: str) -> xarray.Dataset:
    """The orbit of two channels against each other, each with the mean of its record subtracted.

    The mean is the static deflection and what the rotation adds to it.

    Parameters
    ----------
    result
        As `transient` returns it.
    x, y
        Names of recorded channels, m.

    Returns
    -------
    xarray.Dataset
        x and y (time), m.

    Raises
    ------
    ValueError
        For an unknown channel.
    """
    from bearingdyn.results import dataset

    across, up = signal_of(result, x), signal_of(result, y)
    return dataset(
        {
            "x": ("time", across - across.mean(), "m", f"{x} about its mean"),
            "y": ("time", up - up.mean(), "m", f"{y} about its mean"),
        },
        {"analysis": "orbit", "mean_x": float(across.mean()), "mean_y": float(up.mean())},
        {"time": (result["time"].values, "s")},
    )
