"""What the sound power of a machine comes from: the bearings it passed through, and the modes that move."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Equilibrium, Input, frequencies, linear, state_of
from bearingdyn.application import Application
from bearingdyn.checks import instance, number, one_speed, require, whole
from bearingdyn.progress import Progress, told
from bearingdyn.sound.radiating_parts import RadiatingParts
from bearingdyn.sound.radiation import DENSITY, SOUND_SPEED
from bearingdyn.sound.velocity_paths import real_modes, velocity_paths, whole_motion
from bearingdyn.system import System
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(frequency="Hz", speed="rad/s")
def sound_contributions(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    input: str,
    surfaces: Sequence[str],
    *,
    speed: float | None = None,
    rpm: float | None = None,
    floor: float | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    element_size: float | None = None,
    cache: str | os.PathLike[str] | None = None,
    modes: int = 8,
    progress: Progress | bool | None = None,
) -> xarray.Dataset:
    """Sound power under one harmonic input, taken apart by transfer path and by mode.

    The velocity v of the parts that radiate is a sum: what the input moves with no bearing there, and what
    the force through each bearing moves. The share of a term v_k is ½ Re(v_kᴴ R v), what it gives to the
    whole; shares add up to the power, and where a term cancels others its share is negative. Alone it would
    radiate ½ v_kᴴ R v_k, and these do not add up. The same holds for the modes.

    Parameters
    ----------
    source, frequency, speed, rpm
        As in `sound_power`; frequencies above 0.
    input
        One channel, as "shaft.left.y" for a force there; "ground.y" is a velocity of the ground.
    surfaces, floor, density, sound_speed, element_size, cache
        As in `sound_power`, and with the same `cache` nothing is solved twice.
    modes
        How many modes are told apart: those with the largest shares over all frequencies; the others are
        one.
    progress
        As in `frequency_response`.

    Returns
    -------
    xarray.Dataset
        power (frequency), W per N². Over (frequency, path), the paths "direct" and one by the name of each
        bearing or loose fit: path_power, the shares, and path_alone. bearing_force (frequency, bearing,
        axis), complex, N/N, from the inner to the outer ring. Over (frequency, mode), named by number and
        frequency, "others" last: mode_power, the shares, and mode_alone; mode_frequency, Hz. The modes are
        real ones of the whole system, without gyroscopic forces; bearings and layers have there the
        stiffness of the frequency "modes_at", in attrs, the middle of those asked for.

    Raises
    ------
    ValueError
        As `sound_power`, and for a frequency of 0 Hz.
    ArithmeticError
        Where the structure without its bearings resonates without damping.

    Warns
    -----
    CoarsePanels, BeyondModes, RepairedResistance, UnsureInterpolation
        As in `sound_power`.

    References
    ----------
    M. V. van der Seijs, D. de Klerk, D. J. Rixen, Mech. Syst. Signal Process. 68-69 (2016) 217.
    """
    f = frequencies(frequency)
    require(bool(f.min() > 0.0), "frequency", float(f.min()), "it must be above 0 Hz, where nothing sounds")
    instance("input", input, str, 'it must be one channel, as "shaft.left.y"')
    modes = whole("modes", modes, 1)
    speed = number("speed", one_speed(speed, rpm, 0.0))
    state = linear(source)
    system = state.system
    system.check_speed(speed)
    radiating = RadiatingParts.of(
        system, surfaces, highest=float(f.max()), floor=floor, density=density,
        sound_speed=sound_speed, element_size=element_size, cache=cache,
    )  # fmt: skip
    given = Input.of(system, input)

    motion = whole_motion(state, f, given, speed, progress)
    paths = velocity_paths(state, radiating.parts, f, given, motion, speed, progress)
    terms = np.concatenate([paths.direct[:, None], paths.bearings], axis=1)
    middle = float(np.sqrt(f.min() * f.max()))
    natural, shapes = real_modes(state, middle)
    amplitude = (motion @ (system.M @ shapes)) * given.rate(2.0 * np.pi * f)[:, None]
    moved = np.vstack([term.place @ shapes for term in radiating.parts])

    with told(progress, "octave") as tell:
        solved = list(radiating.octaves(f, tell=tell))
    force = np.zeros(paths.total.shape, dtype=np.complex128)  # R v
    for at, octave in solved:
        force[at] = octave.force(f[at], paths.total[at])
    each = 0.5 * (amplitude.conj() * (force @ moved)).real
    kept = np.sort(np.argsort(np.abs(each).sum(axis=0))[::-1][:modes])
    others = np.setdiff1d(np.arange(system.n), kept)
    rest = amplitude[:, others] @ moved[:, others].T
    if given.axis is not None:
        rest = rest + np.concatenate([term.rigid[:, given.axis] for term in radiating.parts])
    single = amplitude[:, kept, None] * moved[:, kept].T
    by_mode = np.concatenate([single, rest[:, None]], axis=1)

    def shares(terms: Complex) -> Array:
        return np.asarray(0.5 * np.einsum("fkm,fm->fk", terms.conj(), force).real)

    def alone(terms: Complex) -> Array:
        found = np.zeros(terms.shape[:2])
        for at, octave in solved:
            for k in range(terms.shape[1]):
                found[at, k] = octave.power(f[at], terms[at, k])[0]
        return found

    from bearingdyn.results import dataset, inputs_of

    per = "m/s" if given.axis is not None else "N m" if given.turning else "N"
    watts = "W/N²" if per == "N" else f"W/({per})²"
    bearings = [hung.name for hung in system.bearings]
    names = [f"{k + 1}: {natural[k]:.4g} Hz" for k in kept]
    return dataset(
        {
            "power": (
                "frequency", shares(paths.total[:, None])[:, 0], watts,
                "sound power, zero-to-peak input of one",
            ),
            "path_power": (("frequency", "path"), shares(terms), watts, "share of a path in the power"),
            "path_alone": (("frequency", "path"), alone(terms), watts, "what a path would radiate alone"),
            "bearing_force": (
                ("frequency", "bearing", "axis"), paths.force, "N/N" if per == "N" else f"N/({per})",
                "complex force from the inner to the outer ring, zero-to-peak",
            ),
            "mode_power": (("frequency", "mode"), shares(by_mode), watts, "share of a mode in the power"),
            "mode_alone": (("frequency", "mode"), alone(by_mode), watts, "what a mode would radiate alone"),
            "mode_frequency": ("mode", np.append(natural[kept], np.nan), "Hz", "natural frequency"),
        },
        {
            "analysis": "sound contributions",
            "speed": speed,
            "input": input,
            "modes_at": middle,
            **radiating.facts(),
            "panels": "; ".join(radiating.said(octave) for _, octave in solved),
            **state_of(source),
            **inputs_of(system.inputs),
        },
        {
            "frequency": (f, "Hz"),
            "path": (["direct", *bearings], ""),
            "bearing": (bearings, ""),
            "axis": (["x", "y", "z"], ""),
            "mode": ([*names, "others"], ""),
        },
    )  # fmt: skip
