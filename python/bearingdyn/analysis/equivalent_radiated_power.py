"""Equivalent radiated power (ERP) of vibrating surfaces: what they would radiate if they did it like a plane.

ERP = ½ ρ c ∫ |v_n|² dA, with the amplitude v_n of the normal velocity, takes a radiation efficiency of 1.
Small bodies are far below it at low frequency: a sphere of Ø100 mm that moves to and fro in air,
P = (2π/3) ρ c a² v² (ka)⁴/(4 + (ka)⁴), radiates less than its ERP by 35.5 dB at 200 Hz, 19.7 dB at 500 Hz,
8.3 dB at 1 kHz and 1.3 dB at 2 kHz.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.linearised import linear
from bearingdyn.analysis.part_velocities import part_velocities, surface_of
from bearingdyn.application import Application
from bearingdyn.checks import name_list, one_speed, positive
from bearingdyn.progress import Progress
from bearingdyn.system import System
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(frequency="Hz", speed="rad/s")
def radiated_power(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    inputs: Sequence[str],
    surfaces: Sequence[str],
    *,
    speed: float | None = None,
    density: float = 1.204,
    sound_speed: float = 343.2,
    progress: Progress | bool | None = None,
    rpm: float | None = None,
) -> xarray.Dataset:
    """Equivalent radiated power of surfaces ("housing.outside") under unit harmonic forces at `inputs`.

    It is no sound power, and no fair measure to compare designs by: it takes every surface to radiate like a
    plane. A sphere of Ø100 mm that moves to and fro radiates 35.5 dB less at 200 Hz, 8.3 dB at 1 kHz and 1.3
    dB at 2 kHz. Where a design moves the motion from one frequency to another, as a soft layer does, the sum
    over a band weighs the low end too much; only levels at one frequency, of bodies of one size, compare.

    Parameters
    ----------
    source, frequency, inputs
        As in `frequency_response`; a "ground" input is a unit velocity of the ground.
    surfaces
        Surfaces of parts, by part and name.
    speed
        As in `frequency_response`, rad/s.
    density, sound_speed
        Of the medium, kg/m³ and m/s; those of air at 20 °C.
    progress, rpm
        As in `frequency_response`.

    Returns
    -------
    xarray.Dataset
        Over (frequency, surface, input): power, W per N², and mean_square, the squared amplitude of the
        normal velocity averaged over the area, (m/s)² per N²; and area (surface), m².

    Raises
    ------
    ValueError
        For an unknown surface or channel, a density or speed of sound that is not positive, and as
        `frequency_response`.
    """
    f = frequencies(frequency)
    inputs, surfaces = name_list("inputs", inputs, least=1), name_list("surfaces", surfaces, "surfaces", 1)
    density, sound_speed = positive("density", density), positive("sound_speed", sound_speed)
    state = linear(source)
    speed = one_speed(speed, rpm, 0.0)
    state.system.check_speed(speed)
    found = [surface_of(state.system, name) for name in surfaces]
    given = [Input.of(state.system, name) for name in inputs]

    parts = list({term.name: term for term, _ in found}.values())
    square = np.zeros((f.size, len(found), len(given)))
    moved = part_velocities(state, parts, f, given, speed, progress)
    for term, velocity in zip(parts, moved, strict=True):
        for k, (owner, surface) in enumerate(found):
            if owner is term:
                square[:, k] = np.einsum(
                    "fai,ab,fbi->fi", velocity.conj(), surface.W, velocity, optimize=True
                ).real
    area = np.array([surface.area for _, surface in found])

    from bearingdyn.results import dataset, inputs_of

    over = ("frequency", "surface", "input")
    return dataset(
        {
            "power": (
                over,
                0.5 * density * sound_speed * square,
                "W/N²",
                "equivalent radiated power, zero-to-peak input of one",
            ),
            "mean_square": (
                over,
                square / area[:, None],
                "(m/s)²/N²",
                "squared amplitude of the normal velocity, averaged over the area",
            ),
            "area": ("surface", area, "m²", "area of the surface"),
        },
        {
            "analysis": "radiated power",
            "speed": speed,
            "density": density,
            "sound_speed": sound_speed,
            **state_of(source),
            **inputs_of(state.system.inputs),
        },
        {"frequency": (f, "Hz"), "surface": (list(surfaces), ""), "input": (list(inputs), "")},
    )
