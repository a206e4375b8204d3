"""Sound intensity on the panels of radiating parts at one frequency: where the power leaves them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Equilibrium, Input, linear, part_velocities, state_of
from bearingdyn.application import Application
from bearingdyn.checks import instance, number, one_speed, positive
from bearingdyn.sound.radiating_parts import RadiatingParts
from bearingdyn.sound.radiation import DENSITY, SOUND_SPEED, below_resonances, solve
from bearingdyn.sound.triangle_surface import TriangleSurface
from bearingdyn.system import System
from bearingdyn.types import Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

COVERED = 1e-9  # of a part's area, from which on what no surface names is told


def panel_forces(
    surface: TriangleSurface,
    velocity: ArrayLike,
    frequency: float,
    *,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
) -> Complex:
    """Force of the sound field on each triangle of a surface, of which its intensity follows.

    The pressure at the corners has an error that is small beside the pressure, not beside that part of it
    which is in phase with the velocity: of a plate at 600 Hz its power was 9 % too high. The force on
    triangle t is therefore taken from the form F(1_t, v) of `bearingdyn.sound.radiation`, whose error is of
    second order, as the impedance of triangles that move alone.

    Parameters
    ----------
    surface
        Closed, or open on its floor alone.
    velocity
        Outward normal velocity (triangles,), complex, zero-to-peak, m/s.
    frequency
        Hz.
    density, sound_speed
        Of the medium, kg/m³ and m/s.

    Returns
    -------
    numpy.ndarray
        (triangles,) complex, N, inward: over the area, the mean pressure. ½ Re(velocity* force) is the power
        that leaves the triangle, and these add up to that of `solve`.

    Raises
    ------
    ValueError
        For a velocity of another number of triangles, and as `solve`.
    """
    instance("surface", surface, TriangleSurface, "it must be a bd.sound.TriangleSurface")
    v, m = np.asarray(velocity), len(surface.faces)
    if v.shape != (m,) or v.dtype.kind not in "iufc" or not np.isfinite(v).all():
        raise ValueError(
            f"velocity has shape {v.shape}; it must be ({m},): the normal velocity of each triangle in m/s, "
            "finite"
        )
    frequency, sound_speed = positive("frequency", frequency), positive("sound_speed", sound_speed)
    alone = solve(
        surface, np.eye(m), frequency, density=density, sound_speed=sound_speed, coarse=True,
        below=below_resonances(surface, frequency, sound_speed),
    )  # fmt: skip
    return np.asarray(alone.impedance @ v)


@takes(frequency="Hz", speed="rad/s")
def sound_intensity(
    source: Equilibrium | Application | System,
    frequency: float,
    input: str,
    surfaces: Sequence[str],
    *,
    speed: float | None = None,
    rpm: float | None = None,
    floor: float | None = None,
    density: float = DENSITY,
    sound_speed: float = SOUND_SPEED,
    element_size: float | None = None,
) -> xarray.Dataset:
    """Sound intensity ½ Re(p v*) that leaves each panel of the radiating parts at one frequency.

    Where it is negative, the panel takes in sound that others radiate. `bd.plot.sound_intensity` draws it.

    Parameters
    ----------
    source, surfaces, speed, rpm, floor, density, sound_speed, element_size
        As in `sound_power`; the surfaces say which parts radiate.
    frequency
        Hz, above 0; its radiation is solved directly.
    input
        One channel, as "shaft.left.y" for a force there; "ground.y" is a velocity of the ground.

    Returns
    -------
    xarray.Dataset
        Over panel: intensity, W/m² per N²; area, m²; normal_velocity outward and pressure, mean over the
        panel, complex; corners (panel, corner, axis), m, anticlockwise seen from outside, from the first
        part's first interface; part, its name. Over surface: surface_power, W/N², through each named surface
        of these parts, and through what has no name, "housing, the rest"; surfaces that overlap count twice.
        power, W/N², of all panels. `bd.sound.panel_forces` says how the pressure is found.

    Raises
    ------
    ValueError
        As `sound_power`, and for a frequency that is not positive.

    Warns
    -----
    CoarsePanels, BeyondModes
        As in `sound_power`.
    """
    f = positive("frequency", frequency, "it must be one frequency above 0, in Hz")
    instance("input", input, str, 'it must be one channel, as "shaft.left.y"')
    speed = number("speed", one_speed(speed, rpm, 0.0))
    state = linear(source)
    state.system.check_speed(speed)
    radiating = RadiatingParts.of(
        state.system, surfaces, highest=f, floor=floor, density=density, sound_speed=sound_speed,
        element_size=element_size,
    )  # fmt: skip
    given = Input.of(state.system, input)
    moved = part_velocities(state, radiating.parts, np.array([f]), [given], speed, False)
    v = np.concatenate(moved, axis=1)[0, :, 0]
    size = radiating.element_size or radiating.radiators.size(radiating.sound_speed / f)
    panels = radiating.radiators.panels(size)
    normal = panels.rows @ v
    areas = panels.surface.areas
    force = panel_forces(
        panels.surface, normal, f, density=radiating.density, sound_speed=radiating.sound_speed
    )
    pressure = force / areas
    intensity = 0.5 * (pressure * normal.conj()).real

    through: dict[str, float] = {}
    for k, term in enumerate(radiating.parts):
        own = panels.body == k
        leaving, left = (intensity * areas)[own], panels.unnamed[own]
        for name, share in panels.shares[k].items():
            through[f"{term.name}.{name}"] = float(share @ leaving)
        if left @ areas[own] > COVERED * areas[own].sum():
            through[f"{term.name}, the rest"] = float(left @ leaving)

    from bearingdyn.results import dataset, inputs_of

    per = "m/s" if given.axis is not None else "N m" if given.turning else "N"
    square = "N²" if per == "N" else f"({per})²"
    once = "N" if per == "N" else f"({per})"
    names = np.array([term.name for term in radiating.parts])
    return dataset(
        {
            "intensity": ("panel", intensity, f"W/(m² {square})", "sound intensity out of the surface"),
            "area": ("panel", areas, "m²", "area of a panel"),
            "normal_velocity": ("panel", normal, f"m/s/{once}", "outward, complex, zero-to-peak"),
            "pressure": ("panel", pressure, f"Pa/{once}", "on the panel, complex, zero-to-peak"),
            "corners": (
                ("panel", "corner", "axis"), panels.surface.points[panels.surface.faces], "m",
                "from the first part's interface",
            ),
            "surface_power": ("surface", list(through.values()), f"W/{square}", "through each surface"),
            "power": ((), float(intensity @ areas), f"W/{square}", "sound power, zero-to-peak input of one"),
        },
        {
            "analysis": "sound intensity",
            "frequency": f,
            "speed": speed,
            "input": input,
            **radiating.facts(),
            "panels": f"{len(areas)} of {1e3 * size:.3g} mm",
            **state_of(source),
            **inputs_of(state.system.inputs),
        },
        {
            "surface": (list(through), ""),
            "axis": (["x", "y", "z"], ""),
            "part": ("panel", names[panels.body], "", "part a panel belongs to"),
        },
    )  # fmt: skip
