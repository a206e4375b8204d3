"""What a steady motion is sought of: a system, what turns in it, what its structure answers, and a start."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.bearing_state import BearingState
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.static_balance import Statics
from bearingdyn.analysis.steady.balance import Balance
from bearingdyn.analysis.steady.layer_lines import soft_layers
from bearingdyn.analysis.steady.receptances import Receptances
from bearingdyn.analysis.steady.torus import Bases, Lines
from bearingdyn.application import Application
from bearingdyn.checks import require
from bearingdyn.material import Maxwell, answer_of
from bearingdyn.system import Contacts, LayerTerm, System, system_of
from bearingdyn.types import Array, Complex, Index

if TYPE_CHECKING:
    import xarray

# of the mean of the bearings' own stiffness, that the reference adds to each coefficient: what holds a rotor
# whose loaded balls stand on one side. Any value gives the same motion
EVEN = 1.0
# N/m, where no ball is pressed
IDLE = 1e6


@dataclass(frozen=True, eq=False)
class Problem:
    """The problem of a steady state: a system ready to be balanced.

    Parameters
    ----------
    source
        Where its bearings stand still.
    system, bases, receptances
        The system, its base frequencies and what its structure answers.
    rest
        (m,) coefficients of all bearings at rest, m, and coordinates of the layers that soften.
    """

    source: Equilibrium | System
    system: System
    bases: Bases
    receptances: Receptances
    rest: Array

    @classmethod
    def of(
        cls,
        source: Equilibrium | Application | System,
        subharmonic: int = 1,
        contacts: Contacts = "viscous",
    ) -> Problem:
        """From an equilibrium, an application (its equilibrium is found) or a system.

        Films answer as their tangents do, as in a march, or with contacts="film" by frequency.

        Raises
        ------
        ValueError
            For a layer whose law has no modulus at rest although a dead load rests on it; for what
            `Bases.of` and `equilibrium` refuse.
        """
        system = source.system if isinstance(source, Equilibrium) else system_of("source", source)
        for layer in system.layers:
            check_rest(layer, system)
        bases = Bases.of(system, subharmonic)
        if not isinstance(source, Equilibrium) and _plain(system):
            source = equilibrium(source)
        if isinstance(source, Equilibrium):
            system, states, x = source.system, source.bearings, source.x
        else:
            source = system
            x, states = _standing(system)
        rest = np.concatenate([np.zeros(0), *(s.z for s in states.values())])
        K = np.zeros((len(rest), len(rest)))
        C = np.zeros_like(K)
        at = 0
        for s in states.values():
            own = slice(at, at + len(s.z))
            K[own, own], C[own, own] = s.K, s.C
            at += len(s.z)
        level = EVEN * float(np.trace(K)) / max(len(rest), 1)
        K = K + max(level, IDLE) * np.eye(len(rest))
        # beside them the coordinates of layers that soften, which no reference touches
        layers = soft_layers(system).rows(system.n) @ x
        more = len(layers)
        rest = np.concatenate([rest, layers])
        K, C = np.pad(K, (0, more)), np.pad(C, (0, more))
        balls = source.balls if contacts == "film" and isinstance(source, Equilibrium) else None
        return cls(source, system, bases, Receptances(system, K, C, balls), rest)

    def balance(self, lines: Lines, speed: float, rows: Array | None = None) -> Balance:
        """Its equations on chosen lines at a speed, rad/s; rows (k, n) of motions asked for beside them."""
        standing = self.rest[self.receptances.of_layers]
        return Balance(self.system, self.bases, self.receptances, lines, speed, rows, standing)

    def standing(self, lines: Lines) -> Complex:
        """The motion (L, m) that stands still at the equilibrium."""
        z = np.zeros((lines.count, len(self.rest)), dtype=np.complex128)
        z[0] = self.rest
        return z


def motion_of(field: str, problem: Problem, result: xarray.Dataset) -> tuple[Index, Complex]:
    """Start of a problem: the amplitudes of an earlier steady motion in its terms; else ValueError."""
    require("motion" in result, field, sorted(map(str, result)), "give a result of steady_state")
    index, z = np.asarray(result["index"].values, dtype=np.intp), np.asarray(result["motion"].values)
    names = [b.name for b in problem.bases.bases]
    require(
        z.shape[1] == len(problem.rest) and [str(b) for b in result["base"].values] == names,
        field,
        list(map(str, result["base"].values)),
        f"it must be a motion of the same bearings over the base frequencies {names}",
    )
    return index, np.ascontiguousarray(z, dtype=np.complex128)


def _plain(system: System) -> bool:
    return all(isinstance(t.material, Maxwell) for t in system.layers)


def rest_modulus(layer: LayerTerm) -> float:
    """G*(0) of a layer's law, Pa, for the mean of a steady state's problem."""
    return float(answer_of(layer.material, 0.0).real)


def check_rest(layer: LayerTerm, system: System) -> None:
    """Refuse in a steady state's problem a law without a modulus at rest under a dead load: ValueError."""
    G = rest_modulus(layer)
    if not G > 0.0 and system.static_load().any():
        raise ValueError(
            f"layer {layer.part!r} has the material {type(layer.material).__name__}, whose modulus at rest "
            f"is {G:g} Pa; under a dead load it must be positive, or there is no mean to move about: give a "
            f"law with a plateau, or take the constant loads away"
        )


def _standing(system: System) -> tuple[Array, dict[str, BearingState]]:
    """Coordinates and bearings at rest, layers at G*(0) of their own laws."""
    statics = Statics.of(system, [rest_modulus(layer) for layer in system.layers])
    q, states = statics.balance(system.bearings)
    return statics.T @ q, states
