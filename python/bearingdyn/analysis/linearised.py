"""The system with its bearings linearised, from which harmonic analyses start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.static_balance import HOLD
from bearingdyn.application import COMPONENTS, Application
from bearingdyn.checks import one_of
from bearingdyn.material import answer_of
from bearingdyn.system import Contacts, System, natural, system_of
from bearingdyn.types import Array, Complex

# N/m: a bearing below it holds nothing; κ^(2/3) F^(1/3) of one ball under 1e-9 N is some 1e4 N/m
IDLE = 1e3


@dataclass(frozen=True, eq=False)
class Linear:
    """A system with its bearings linearised: K, C (coefs, coefs) on their raceway coefficients.

    balls: what lubricated balls add by frequency, as `Equilibrium.balls` says; None: nothing.
    """

    system: System
    K: Array
    C: Array
    balls: Callable[[Array], tuple[Complex, Array] | None] | None = None

    def solve(
        self,
        omega: Array,
        force: Array,
        rows: Array,
        speed: float,
        progress: core.Progress | None = None,
        modulus: Complex | None = None,
    ) -> Complex:
        """Motions rows (k, n) under forces (i, n) e^{iωt}, (f, k, i); paper (20).

        modulus: of `moduli`, where it is known already.
        """
        system = self.system
        if modulus is None:
            modulus = self.moduli(omega)
        # η0 sits in G*(ω) here, so C is the structure's own
        moving = omega > 0
        if moving.all():
            return self._respond(system, omega, modulus, force, rows, speed, progress)
        x = np.zeros((omega.size, len(rows), len(force)), dtype=np.complex128)
        for part in (moving, ~moving):
            if part.any():
                held = system if omega[part][0] > 0 else self.held_at_rest(modulus[part][0], force)
                x[part] = self._respond(held, omega[part], modulus[part], force, rows, speed, progress)
        return x

    def moduli(self, omega: Array) -> Complex:
        """G* or K* (f, layers) of the layers' materials at omega (f,), rad/s, Pa; of each material once."""
        of: dict[int, Complex] = {}
        for layer in self.system.layers:
            if id(layer.material) not in of:
                of[id(layer.material)] = answer_of(layer.material, omega)
        found = np.ones((omega.size, len(self.system.layers)), dtype=np.complex128)
        for k, layer in enumerate(self.system.layers):
            found[:, k] = of[id(layer.material)]
        return found

    def _respond(
        self,
        system: System,
        omega: Array,
        modulus: Complex,
        force: Array,
        rows: Array,
        speed: float,
        progress: core.Progress | None,
    ) -> Complex:
        """Motions (f, k, i) at the moduli (f, layers) of the system's layers."""
        return core.harmonic(
            system.model([], relaxed=False),
            omega,
            modulus,
            self.K,
            self.C,
            force,
            rows,
            speed,
            progress,
            self.balls and self.balls(omega),
        )

    def dynamic(self, omega: Array) -> Complex:
        """K + iωC of all bearings (f, coefs, coefs), with what lubricated balls add, at omega (f,), rad/s."""
        found = self.K + 1j * omega[:, None, None] * self.C
        balls = self.balls and self.balls(omega)
        if balls:
            k, v = balls
            found += np.einsum("fb,bk,bl->fkl", k, v, v, optimize=True)
        return np.asarray(found)

    def held_at_rest(self, modulus: Complex, force: Array) -> System:
        """The system with its free motions held, which no force drives; modulus (layers,) at 0 Hz, Pa.

        Raises
        ------
        ArithmeticError
            Where a force drives one: its response is infinite. Names what moves.
        """
        system = self.system
        K = system.K + system.B.T @ self.K @ system.B
        for layer, G in zip(system.layers, modulus.real, strict=True):
            K += 2.0 * G * (layer.L @ layer.L.T)
        squares, shapes = natural(K, system.M)
        free = shapes[:, squares <= 0.0]
        if not free.shape[1]:
            return system
        drives = force @ free
        worst = int(np.argmax(np.abs(drives).max(axis=1)))
        if np.abs(drives[worst]).max() > 1e-9 * np.abs(free).max():
            ends = np.cumsum([0, *(len(t.B) for t in system.bearings)])
            idle = [
                t.name
                for t, a, b in zip(system.bearings, ends, ends[1:], strict=False)
                if np.abs(self.K[a:b, a:b]).max(initial=0.0) <= IDLE
            ]
            raise ArithmeticError(_freedom(system, free @ drives[worst], idle))
        held = system.M @ free
        return replace(system, K=system.K + HOLD * (held @ held.T))


def _freedom(system: System, motion: Array, idle: list[str]) -> str:
    """What is said of a motion (n,) that is free and driven at 0 Hz."""
    sites = [(name, rows @ motion) for name, rows in system.outputs.items()]
    name, moved = max(sites, key=lambda site: float(np.abs(site[1]).max()))
    k = int(np.argmax(np.abs(moved)))
    place = f"{name}.{COMPONENTS[k]}"
    hint = f" (no ball of {idle} is pressed: load it)" if idle else ""
    spins = k == 5 and np.abs(moved[:5]).max() < 1e-6 * abs(moved[5])
    what = "the shaft is free to spin about z" if spins else f"nothing holds that motion{hint}"
    spring = ", ".join("k" if i == k else "0" for i in range(6))
    return (
        f"frequency is 0 Hz, and a force drives {place}, where {what}: the static response is infinite (the "
        f"dynamic stiffness is singular); ask from above 0 Hz on, leave that input out, or hold it, as by "
        f'app.ground("{name}", stiffness=[{spring}])'
    )


def linear(source: Equilibrium | Application | System, contacts: Contacts = "film") -> Linear:
    """The linearised system that a harmonic analysis starts from.

    Parameters
    ----------
    source
        What is linear or linearised.
    contacts
        How lubricated contacts answer: "film", by their stiffness and damping at each frequency, or
        "viscous", by the tangents that hold at low frequency, as in a march.

    Raises
    ------
    ValueError
        For bearings without an equilibrium, and for unknown contacts.
    """
    one_of("contacts", contacts, ("film", "viscous"))
    if isinstance(source, Equilibrium):
        source.warn_of_unloaded()
        balls = source.balls if contacts == "film" else None
        return Linear(source.system, source.bearing_K, source.bearing_C, balls)
    system = system_of("source", source)
    if system.bearings:
        raise ValueError(
            "bearings have no stiffness of their own; pass bd.equilibrium(app), which linearises them"
        )
    return Linear(system, np.zeros((0, 0)), np.zeros((0, 0)))
