"""A steady motion as the beginning of a march: where everything is at t = 0, and what the layers bear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.march_state import Beginning
from bearingdyn.analysis.softening import layer_names
from bearingdyn.analysis.steady.balance import Found
from bearingdyn.analysis.steady.choosing import candidates, lattice
from bearingdyn.analysis.steady.motion import Motion
from bearingdyn.analysis.steady.problem import Problem, motion_of
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.checks import require
from bearingdyn.results import inputs_of
from bearingdyn.system import System

if TYPE_CHECKING:
    import xarray


def beginning(source: Equilibrium | System, result: xarray.Dataset, speed: object) -> Beginning:
    """The beginning of a march in a steady motion, from a result of `steady_state` on the same source.

    Raises
    ------
    ValueError
        For the result of another speed, of other bearings, or of layers that soften.
    """
    require(
        speed == result.attrs.get("speed"),
        "speed",
        speed,
        f"initial is a steady motion at {result.attrs.get('speed')} rad/s; march it at that speed",
    )
    problem = Problem.of(source, int(result.attrs["subharmonic"]))
    for name in layer_names(problem.system):
        raise ValueError(
            f"initial is a steady motion in which layer {name!r} softens with its amplitude (payne), and a "
            f"march has no beginning of that; march from the equilibrium, and give it time with settle="
        )
    theirs, here = result.attrs.get("inputs_hash"), inputs_of(problem.system.inputs).get("inputs_hash")
    require(
        theirs == here,
        "initial, by its inputs_hash,",
        theirs,
        f"it is the motion of another application, for this one's is {here}; find it anew",
    )
    index, z = motion_of("initial", problem, result)
    own, harmonics = float(result.attrs["speed"]), int(result.attrs["harmonics"])
    if len(problem.bases.bases) > 1:
        lines = lattice(index, candidates(problem, own, harmonics))
    else:
        lines = Lines.harmonics(len(index) - 1)
    balance = problem.balance(lines, own)
    x = Motion(balance, Found(z, balance.press(z, tangents=False), 0.0, 0, 0, True)).x
    rate = 1j * balance.omega[:, None]
    stress = [np.zeros(0)]
    for layer in problem.system.layers:
        turned = x @ layer.L
        for G, tau in zip(layer.material.G, layer.material.tau, strict=True):
            stress.append((2.0 * G * rate * tau / (1.0 + rate * tau) * turned).real.sum(axis=0))
    return Beginning(x.real.sum(axis=0), (rate * x).real.sum(axis=0), np.concatenate(stress))
