"""A steady motion as the beginning of a march: where everything is at t = 0, and what the layers bear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.march_state import Beginning
from bearingdyn.analysis.softening import layer_names
from bearingdyn.analysis.steady.balance import Balance, Found
from bearingdyn.analysis.steady.choosing import candidates, lattice
from bearingdyn.analysis.steady.motion import Motion
from bearingdyn.analysis.steady.problem import Problem, motion_of
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.checks import one_of, require
from bearingdyn.results import inputs_of
from bearingdyn.system import Contacts, System
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    import xarray


def beginning(
    source: Equilibrium | System, result: xarray.Dataset, speed: object, contacts: Contacts = "viscous"
) -> Beginning:
    """The beginning of a march in a steady motion, from a result of `steady_state` on the same source.

    With contacts="film" it holds what films remember of that motion, whichever way they answered in it.

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
    theirs: Contacts = result.attrs.get("contacts", "viscous")
    one_of("initial, by its contacts,", theirs, ("film", "viscous"))
    problem = Problem.of(source, int(result.attrs["subharmonic"]), theirs)
    for name in layer_names(problem.system):
        raise ValueError(
            f"initial is a steady motion in which layer {name!r} softens with its amplitude (payne), and a "
            f"march has no beginning of that; march from the equilibrium, and give it time with settle="
        )
    told, here = result.attrs.get("inputs_hash"), inputs_of(problem.system.inputs).get("inputs_hash")
    require(
        told == here,
        "initial, by its inputs_hash,",
        told,
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
    films = _remembered(balance, z) if contacts == "film" else None
    return Beginning(x.real.sum(axis=0), (rate * x).real.sum(axis=0), np.concatenate(stress), films)


def _remembered(balance: Balance, z: Complex) -> tuple[Array, ...]:
    """What films remember of a motion (L, m) at t = 0: of each bearing that has them (1 + 2 echoes, Z)."""
    lines, omega = balance.lines, balance.omega[1:, None]
    signal = lines.signals(np.hstack([z, balance.rates(z)]))
    found = []
    for term, own, (angles, speeds) in zip(
        balance.system.bearings, balance.slots, balance.bodies, strict=True
    ):
        kernel = term.kernel("film")
        if not len(kernel.echoes):
            continue
        moving = signal[:, own], signal[:, z.shape[1] :][:, own]
        along = core.bearing_along(kernel, *moving, angles, speeds, tangents=False)
        p = lines.amplitudes(along.pressed)
        rows = [p.real.sum(axis=0)]
        for d in kernel.echoes[:, 0] + 1j * kernel.echoes[:, 1]:
            # q of a real p, dq/dt = p − d q, whose echo is complex
            halves = p[1:] / (d + 1j * omega) + p[1:].conj() / (d - 1j * omega)
            q = p[0] / d + 0.5 * halves.sum(axis=0)
            rows += [q.real, q.imag]
        found.append(np.array(rows))
    return tuple(found)
