"""Sound power of the parts of a machine under harmonic inputs, and its sound at microphones."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Equilibrium, Input, frequencies, linear, part_velocities, state_of
from bearingdyn.application import Application
from bearingdyn.checks import name_list, number, one_speed, real, require
from bearingdyn.progress import Progress, told
from bearingdyn.sound.radiating_parts import RadiatingParts
from bearingdyn.sound.radiation import DENSITY, SOUND_SPEED
from bearingdyn.sound.resistance import heard
from bearingdyn.system import System
from bearingdyn.types import Array
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(frequency="Hz", speed="rad/s")
def sound_power(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    inputs: Sequence[str],
    surfaces: Sequence[str],
    *,
    speed: float | None = None,
    rpm: float | None = None,
    floor: float | None = None,
    microphones: ArrayLike | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    element_size: float | None = None,
    cache: str | os.PathLike[str] | None = None,
    progress: Progress | bool | None = None,
) -> xarray.Dataset:
    """Sound power of an application's parts under unit harmonic forces, and sound at microphones.

    The parts that own the `surfaces` radiate together, each with its whole boundary: a body that moves as one
    must not pulsate. Their radiation is solved at a few frequencies of each octave and interpolated; `cache`
    keeps it, so that another speed, bearing or layer costs only the response.

    Parameters
    ----------
    source, frequency, inputs, speed, rpm
        As in `radiated_power`.
    surfaces
        Surfaces of parts, by part and name ("housing.outside").
    floor
        Height y of a rigid floor, m, from the first interface of the first part; None: free field.
    microphones
        Places (p, 3), m, from the same point, at which the sound pressure is wanted.
    density, sound_speed
        Of the medium, kg/m³ and m/s; those of air at 20 °C.
    element_size
        Side of the radiating panels, m; None: a quarter of the shortest wavelength of each octave, and a
        tenth of the smallest body at most.
    cache
        A folder for what was solved, by the hash of the panels' source; None: nothing is kept.
    progress
        As in `frequency_response`.

    Returns
    -------
    xarray.Dataset
        Over (frequency, input): power, W per N²; equivalent_radiated_power of the surfaces, which a plane
        would radiate, and its error in dB; efficiency, the power over ½ ρ c ∫ |v|² dA; interpolation_error,
        dB. Over (frequency, part, input): part_power, what each part gives; it may be negative. With
        microphones: pressure (frequency, microphone, input), complex, zero-to-peak, Pa/N. Panels and their
        sides by octave, and valid_to, the lowest f_max of the parts, Hz, in attrs.

    Raises
    ------
    ValueError
        For an unknown surface or channel, a part whose boundary is not known, a floor above a part, a
        microphone too near, values that are not positive, and as `frequency_response`.

    Warns
    -----
    CoarsePanels
        For an `element_size` above a sixth of the shortest wavelength.
    BeyondModes
        For a frequency above the f_max of a part that radiates.
    RepairedResistance, UnsureInterpolation
        As their text says.

    References
    ----------
    A. J. Burton, G. F. Miller, Proc. R. Soc. Lond. A 323 (1971) 201.
    """
    f = frequencies(frequency)
    inputs = name_list("inputs", inputs, least=1)
    places = _microphones(microphones)
    speed = number("speed", one_speed(speed, rpm, 0.0))
    state = linear(source)
    state.system.check_speed(speed)
    radiating = RadiatingParts.of(
        state.system, surfaces, highest=float(f.max()), floor=floor, density=density,
        sound_speed=sound_speed, element_size=element_size, cache=cache,
    )  # fmt: skip
    parts, radiators = radiating.parts, radiating.radiators
    given = [Input.of(state.system, name) for name in inputs]

    moved = part_velocities(state, parts, f, given, speed, progress)
    velocity = np.concatenate(moved, axis=1)
    plane = np.zeros((f.size, len(given)))
    for term, surface in radiating.surfaces:
        v = moved[parts.index(term)]
        plane += (
            0.5
            * radiating.density
            * radiating.sound_speed
            * np.einsum("fai,ab,fbi->fi", v.conj(), surface.W, v, optimize=True).real
        )

    power, error = np.zeros(plane.shape), np.zeros(plane.shape)
    part_power = np.zeros((f.size, len(parts), len(given)))
    pressure = np.zeros((f.size, len(places), len(given)), dtype=np.complex128)
    told_of: list[str] = []
    with told(progress, "octave") as tell:
        for at, octave in radiating.octaves(f, places, tell):
            told_of.append(radiating.said(octave))
            H = heard(octave, radiators, f[at], places, radiating.sound_speed) if len(places) else None
            for i in range(len(given)):
                v = velocity[at, :, i]
                power[at, i], error[at, i] = octave.power(f[at], v)
                part_power[at, :, i] = octave.shares(f[at], v, radiators.blocks)
                if H is not None:
                    pressure[at, :, i] = np.einsum("fpn,fn->fp", H, v)

    from bearingdyn.results import dataset, inputs_of

    over = ("frequency", "input")
    with np.errstate(divide="ignore", invalid="ignore"):
        overstated = np.where(power > 0, 10.0 * np.log10(plane / power), np.nan)
        efficiency = np.where(plane > 0, power / plane, np.nan)
    variables = {
        "power": (over, power, "W/N²", "sound power, zero-to-peak input of one"),
        "equivalent_radiated_power": (over, plane, "W/N²", "what the surfaces would radiate as a plane"),
        "equivalent_error": (over, overstated, "dB", "by which the equivalent radiated power is too high"),
        "efficiency": (over, efficiency, "", "sound power over the equivalent radiated power"),
        "interpolation_error": (over, error, "dB", "estimated, of the interpolation over frequency"),
        "part_power": (("frequency", "part", "input"), part_power, "W/N²", "what each part gives"),
    }
    coords = {
        "frequency": (f, "Hz"),
        "input": (list(inputs), ""),
        "part": ([term.name for term in parts], ""),
    }
    if len(places):
        variables["pressure"] = (
            ("frequency", "microphone", "input"), pressure, "Pa/N", "sound pressure, complex, zero-to-peak"
        )  # fmt: skip
        variables["microphone_place"] = (
            ("microphone", "axis"),
            places,
            "m",
            "from the first part's interface",
        )
        coords["axis"] = (["x", "y", "z"], "")
    return dataset(
        variables,
        {
            "analysis": "sound power",
            "speed": speed,
            **radiating.facts(),
            "panels": "; ".join(told_of),
            **state_of(source),
            **inputs_of(state.system.inputs),
        },
        coords,
    )


def _microphones(given: ArrayLike | None) -> Array:
    if given is None:
        return np.zeros((0, 3))
    remedy = "it must be places (p, 3) in m"
    try:
        places = real(given)
    except (TypeError, ValueError):
        raise ValueError(f"microphones is {given!r}; {remedy}") from None
    good = places.ndim == 2 and places.shape[1] == 3 and bool(np.isfinite(places).all())
    require(good, "microphones", given, remedy)
    return places
