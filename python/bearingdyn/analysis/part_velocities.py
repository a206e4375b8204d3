"""How fast the coordinates of parts move under harmonic inputs: what radiates from their surfaces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.linearised import Linear
from bearingdyn.application import Place
from bearingdyn.checks import instance, items, meant, number
from bearingdyn.cms import Surface
from bearingdyn.progress import Progress, told
from bearingdyn.system import PartTerm, System
from bearingdyn.types import Array, Complex


def part_velocities(
    state: Linear,
    parts: Sequence[PartTerm],
    frequency: Array,
    inputs: Sequence[Input],
    speed: float = 0.0,
    progress: Progress | bool | None = None,
) -> list[Complex]:
    """Velocities of the coordinates of parts per unit of each input.

    Parameters
    ----------
    state
        The linearised system.
    parts
        Whose coordinates.
    frequency
        (f,), Hz.
    inputs
        Forces, or velocities of the ground.
    speed
        Of the shaft, rad/s.
    progress
        As in `frequency_response`.

    Returns
    -------
    list of numpy.ndarray
        (f, n, i) complex of each part of n coordinates.

    Raises
    ------
    ValueError
        For arguments of another kind, and as `frequency_response`.
    """
    instance("state", state, Linear, "it must be what `linear` gives")
    frequency = frequencies(frequency)
    parts = items("parts", parts, "it must be a list of parts of the system")
    inputs = items("inputs", inputs, "it must be a list of inputs, as Input.of makes them")
    for one in parts:
        instance("parts", one, PartTerm, "it must be a list of parts of the system")
    for each in inputs:
        instance("inputs", each, Input, "it must be a list of inputs, as Input.of makes them")
    speed = number("speed", speed, "it must be a number in rad/s")
    n = state.system.n
    force = np.array([i.force for i in inputs]).reshape(-1, n)
    rows = np.vstack([np.zeros((0, n)), *(t.place for t in parts)])
    omega = 2 * np.pi * frequency
    with told(progress, "frequency") as tell:
        x = state.solve(omega, force, rows, speed, tell)
    factor = np.stack([i.rate(omega) for i in inputs], axis=1)[:, None]
    moved, at = [], 0
    for term in parts:
        velocity = x[:, at : at + len(term.place)] * factor
        at += len(term.place)
        for i, one in enumerate(inputs):
            if one.axis is not None:
                velocity[:, :, i] += term.rigid[:, one.axis]
        moved.append(velocity)
    return moved


def surface_of(system: System, name: str) -> tuple[PartTerm, Surface]:
    """For its velocities, a surface of a part by its name, and the part.

    Parameters
    ----------
    system
        The system.
    name
        Part and surface, "housing.outside".

    Raises
    ------
    ValueError
        For what is no system and no text, and for a part or a surface that there is not.
    """
    instance("system", system, System, "it must be a System")
    instance("name", name, str, 'it must be a text, part and surface, "housing.outside"')
    owner = next((term for term in system.parts if name.startswith(f"{term.name}.")), None)
    if owner is None:
        raise ValueError(f"{name!r} is no surface; there are the parts {[t.name for t in system.parts]}")
    place, known = Place.parse(name), owner.element.surfaces
    if place.name not in known:
        raise ValueError(f"part {owner.name!r} has no surface {place.name!r}; {meant(place.name, known)}")
    return owner, known[place.name]
