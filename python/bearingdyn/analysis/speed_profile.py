"""The speed of the shaft through a march, its profile, and the angle through which the shaft has turned."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.checks import number
from bearingdyn.plausible_ranges import plausible
from bearingdyn.results import check_dataset
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


def drive_of(speed: float | tuple[ArrayLike, ArrayLike]) -> float | tuple[Array, Array]:
    """The speed of the shaft as one number, rad/s, or as times in s and speeds in rad/s, (n,) each.

    Raises
    ------
    ValueError
        For anything else, and for times that do not increase.
    """
    either = "give one finite number in rad/s, or (times in s, speeds in rad/s)"
    if not isinstance(speed, tuple):
        return number("speed", speed, either)
    if len(speed) != 2:
        raise ValueError(f"speed has {len(speed)} parts; {either}")
    try:
        times, speeds = (np.atleast_1d(np.array(part, dtype=np.float64)) for part in speed)
    except (TypeError, ValueError):
        raise ValueError(f"speed is {speed!r}; {either}") from None
    if times.shape != speeds.shape or times.ndim != 1 or times.size < 2:
        raise ValueError(
            f"speed has {times.size} times and {speeds.size} speeds; give two or more of each, or one number"
        )
    if not (np.isfinite(times).all() and np.isfinite(speeds).all() and (np.diff(times) > 0).all()):
        raise ValueError("speed: times must increase and all numbers be finite, in s and rad/s")
    ramp = float(np.abs(np.diff(speeds) / np.diff(times)).max())
    plausible("angular acceleration", "speed: the steepest change of the profile", ramp)
    return times, speeds


def angle_turned(stepping: core.Stepping, t: float) -> float:
    """Angle, rad, through which a shaft of this speed has turned from 0 to t, s."""
    times, speeds = stepping.profile
    knots = np.unique(np.concatenate([[0.0, t], times[(times > 0.0) & (times < t)]]))
    return float(np.trapezoid(np.interp(knots, times, speeds), knots))


def shaft_angle(result: xarray.Dataset) -> Array:
    """Angle of the shaft at every sample of a march: the exact integral of its speed profile.

    Parameters
    ----------
    result
        As `transient` returns it.

    Returns
    -------
    Array
        (n,), rad; zero at t = 0.
    """
    check_dataset("result", result, ["time"], "transient")
    t = np.asarray(result["time"].values, dtype=np.float64)
    times, speeds = speed_profile(result)
    if speeds.size == 1:
        return np.asarray(speeds[0] * t)
    # as in the core: the first speed holds before the profile, the last after it; the angle is 0 at t = 0
    angle = _turned(times, speeds, t)
    start = _turned(times, speeds, np.zeros(1))[0] if times[0] < 0 else -speeds[0] * times[0]
    return np.asarray(angle - start)


def _turned(times: Array, speeds: Array, t: Array) -> Array:
    """∫Ω dt from the first knot to t (n,), rad."""
    at = np.concatenate([[0.0], np.cumsum(0.5 * (speeds[1:] + speeds[:-1]) * np.diff(times))])
    k = np.clip(np.searchsorted(times, t, side="right") - 1, 0, times.size - 2)
    inside = np.clip(t, times[0], times[-1]) - times[k]
    slope = (speeds[k + 1] - speeds[k]) / (times[k + 1] - times[k])
    angle = at[k] + speeds[k] * inside + 0.5 * slope * inside**2
    angle += speeds[0] * np.minimum(t - times[0], 0.0) + speeds[-1] * np.maximum(t - times[-1], 0.0)
    return np.asarray(angle)


def speed_profile(result: xarray.Dataset) -> tuple[Array, Array]:
    """Speed of the shaft of a march: times, s, and speeds, rad/s, linear between; one of each if steady."""
    speeds = np.atleast_1d(np.asarray(result.attrs["speed"], dtype=np.float64))
    return np.atleast_1d(np.asarray(result.attrs.get("speed_time", [0.0]), dtype=np.float64)), speeds
