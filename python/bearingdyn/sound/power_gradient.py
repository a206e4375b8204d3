"""Derivatives of the sound power of a machine with respect to what it is made of."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Gradient, Input, frequencies, power_slopes, power_table
from bearingdyn.checks import instance, name_list, number
from bearingdyn.sound.radiating_parts import RadiatingParts
from bearingdyn.sound.radiation import DENSITY, SOUND_SPEED
from bearingdyn.types import Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(frequency="Hz", speed="rad/s")
def sound_power_gradient(
    slope: Gradient,
    frequency: ArrayLike,
    inputs: Sequence[str],
    surfaces: Sequence[str],
    *,
    speed: float = 0.0,
    floor: float | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    element_size: float | None = None,
    cache: str | os.PathLike[str] | None = None,
) -> xarray.Dataset:
    """Sound power as of `sound_power`, and its derivatives: dP = Re(vᴴ R dv), R the radiation resistance.

    R stays: the parameters change how the parts move, not their skins. By adjoints, so that thirty parameters
    cost hardly more than one.

    Parameters
    ----------
    slope
        What `bearingdyn.gradient` gives.
    frequency, inputs, surfaces, speed, floor, density, sound_speed, element_size, cache
        As for `sound_power`.

    Returns
    -------
    xarray.Dataset
        power (frequency, input), W per N², and derivative (parameter, frequency, input).

    Raises
    ------
    ValueError
        For what is no gradient, and as `sound_power`.

    Warns
    -----
    CoarsePanels, BeyondModes, RepairedResistance, UnsureInterpolation
        As `sound_power`.
    """
    instance("slope", slope, Gradient, "it must be what bearingdyn.gradient gives")
    f = frequencies(frequency)
    inputs = name_list("inputs", inputs, least=1)
    speed = number("speed", speed)
    system = slope.state.system
    system.check_speed(speed)
    radiating = RadiatingParts.of(
        system, surfaces, highest=float(f.max()), floor=floor, density=density,
        sound_speed=sound_speed, element_size=element_size, cache=cache,
    )  # fmt: skip
    octaves = list(radiating.octaves(f))

    def force(v: Complex) -> Complex:
        found = np.zeros_like(v)
        for at, octave in octaves:
            for i in range(v.shape[2]):
                found[at, :, i] = octave.force(f[at], v[at, :, i])
        return found

    given = [Input.of(system, name) for name in inputs]
    velocity, slopes = power_slopes(slope.slopes, radiating.parts, f, given, force, speed)
    power = 0.5 * np.einsum("fni,fni->fi", velocity.conj(), force(velocity)).real
    return power_table(slope.slopes, f, inputs, power, slopes, "gradient of the sound power")
