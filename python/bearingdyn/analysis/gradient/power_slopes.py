"""Derivatives of the power that surfaces radiate, ½ vᴴ R v, by adjoints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.gradient.response_slopes import ResponseSlopes
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.part_velocities import surface_of
from bearingdyn.checks import name_list, positive
from bearingdyn.system import PartTerm
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    import xarray


def power_slopes(
    of: ResponseSlopes,
    parts: Sequence[PartTerm],
    frequency: Array,
    inputs: Sequence[Input],
    force: Callable[[Complex], Complex],
    speed: float = 0.0,
) -> tuple[Complex, Array]:
    """Velocities of parts, and derivatives of the power ½ vᴴ R v that they radiate.

    dP = Re(vᴴ R dv): R v, turned into an adjoint load at each frequency and input, stands for all parameters.

    Parameters
    ----------
    of
        Slopes of responses, as `Gradient.slopes` gives them.
    parts
        Whose coordinates radiate, in the order of R's.
    frequency
        (f,), Hz.
    inputs
        Forces, or velocities of the ground.
    force
        Function that turns velocities (f, n, i) into R v (f, n, i), N; R (n, n) is real and symmetric at
        every frequency and does not depend on the parameters.
    speed
        Of the shaft, rad/s.

    Returns
    -------
    tuple of numpy.ndarray
        Velocities (f, n, i), complex, and derivatives (parameters, f, i), W per unit of each.
    """
    state, omega = of.state, 2 * np.pi * frequency
    loads = np.array([i.force for i in inputs])
    rows = np.vstack([term.place for term in parts])
    felt = of.felt(rows)
    every = np.eye(state.system.n)[felt]
    if speed == 0.0:
        both = state.solve(omega, np.vstack([loads, rows]), every, 0.0)
        x, y = both[:, :, : len(loads)], both[:, :, len(loads) :]
    else:  # the adjoint turns the other way
        x, y = state.solve(omega, loads, every, speed), state.solve(omega, rows, every, -speed)
    rate = np.stack([i.rate(omega) for i in inputs], axis=1)
    velocity = (rows[:, felt] @ x) * rate[:, None]
    for i, one in enumerate(inputs):
        if one.axis is not None:
            velocity[:, :, i] += np.concatenate([term.rigid[:, one.axis] for term in parts])
    weight = np.conj(force(velocity)) * rate[:, None]
    slopes = np.zeros((len(of.changes), omega.size, len(inputs)))
    for i, one in enumerate(inputs):
        adjoint = np.einsum("fna,fa->fn", y, weight[:, :, i])[:, :, None]
        slopes[:, :, i] = of.slopes(felt, x[:, :, i : i + 1], adjoint, omega, [one])[:, :, 0, 0].real
    return velocity, slopes


def equivalent_power(
    of: ResponseSlopes,
    frequency: ArrayLike,
    inputs: Sequence[str],
    surfaces: Sequence[str],
    speed: float,
    density: float,
    sound_speed: float,
) -> xarray.Dataset:
    """Equivalent radiated power of surfaces and its derivatives, as `Gradient.radiated_power` gives them."""
    f = frequencies(frequency)
    inputs, surfaces = name_list("inputs", inputs, least=1), name_list("surfaces", surfaces, "surfaces", 1)
    impedance = positive("density", density) * positive("sound_speed", sound_speed)
    system = of.state.system
    system.check_speed(speed)
    found = [surface_of(system, name) for name in surfaces]
    parts = list({term.name: term for term, _ in found}.values())
    starts = np.cumsum([0, *(len(term.place) for term in parts)])
    R = np.zeros((starts[-1], starts[-1]))
    for term, surface in found:
        at = slice(*starts[parts.index(term) :][:2])
        R[at, at] += impedance * surface.W
    given = [Input.of(system, name) for name in inputs]
    velocity, slopes = power_slopes(of, parts, f, given, lambda v: R @ v, speed)
    power = 0.5 * np.einsum("fni,fni->fi", velocity.conj(), R @ velocity).real
    return power_table(of, f, inputs, power, slopes, "gradient of the equivalent radiated power")


def power_table(
    of: ResponseSlopes, f: Array, inputs: Sequence[str], power: Array, slopes: Array, analysis: str
) -> xarray.Dataset:
    """Radiated power and its derivatives by the parameters of a gradient, as a Dataset.

    Parameters
    ----------
    of
        Slopes of responses, whose parameters are named.
    f
        (f,), Hz.
    inputs
        Names of the inputs.
    power
        (f, i), W/N².
    slopes
        (parameters, f, i), W/N² per unit of each.
    analysis
        What was computed, in words.

    Returns
    -------
    xarray.Dataset
        `power` and `derivative` over these.
    """
    from bearingdyn.results import dataset

    dims = ("frequency", "input")
    return dataset(
        {
            "power": (dims, power, "W/N²", "power, zero-to-peak input of one"),
            "derivative": (("parameter", *dims), slopes, "", "derivative, per unit of the parameter"),
        },
        {"analysis": analysis},
        {"frequency": (f, "Hz"), "input": (list(inputs), ""), "parameter": (list(of.changes), "")},
    )
