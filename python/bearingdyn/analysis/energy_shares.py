"""Which parts store the energy of a mode, and which parts lose it.

For a mode φ e^{λt}, averaged over its phase and in units of ¼e^{2 Re λ t}: kinetic |λ|² φᴴMφ; stored in
springs φᴴKφ, and in a Maxwell branch 2 G |λτ/(1 + λτ)|² |Lᵀφ|²; lost in dampers, twice |λ|² φᴴCφ and 2 Gτ
|λ/(1 + λτ)|² |Lᵀφ|². The energy falls as e^{2 Re λ t}, so that −Re λ (kinetic + stored) is half of what is
lost: the shares of the loss are shares of the damping ratio, exactly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.linearised import linear
from bearingdyn.application import Application
from bearingdyn.material import is_volume
from bearingdyn.results import check_dataset, dataset, inputs_of
from bearingdyn.system import System
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class Store:
    """What one part keeps and loses of a mode's energy, (m,): kinetic, stored, lost."""

    name: str
    kinetic: Array
    stored: Array
    lost: Array


def energy_shares(source: Equilibrium | Application | System, found: xarray.Dataset) -> xarray.Dataset:
    """Share of each part, bearing and spring in the energy and the loss of the modes that `modes` found.

    The shear of a viscoelastic part has an entry of its own, "layer (shear)", and so has its volume where
    its bulk modulus relaxes, "layer (volume)"; "layer" is the rest of the part: its mass, elastic regions and
    constant change of volume. A bearing has its tangent stiffness and damping,
    or those of its films, as the modes were found with.

    Parameters
    ----------
    source
        What the modes were found of.
    found
        As `modes` returns it.

    Returns
    -------
    xarray.Dataset
        Over (mode, part): kinetic, strain and dissipation, shares that sum to 1 (the dissipation of undamped
        modes to 0); and damping, what each part adds to the damping ratio. It is negative where material
        that turns with the shaft feeds the mode.

    Raises
    ------
    ValueError
        For modes of another system, and for bearings without an equilibrium.
    """
    check_dataset("found", found, ["shape", "eigenvalue"], "modes")
    system = linear(source).system
    if not system.parts:
        raise ValueError("the system does not know its parts; pass an application or its equilibrium")
    shape, value = found["shape"].values, found["eigenvalue"].values
    if shape.shape[1] != system.n:
        raise ValueError(
            f"the modes have {shape.shape[1]} coordinates and the system {system.n}; give modes of this one"
        )
    damped, speed = bool(found.attrs["damped"]), float(found.attrs["speed"])
    filmed = damped and found.attrs.get("contacts", "viscous") == "film"
    modulus = str(found.attrs["modulus"])
    stores = list(_stores(source, system, shape.T, value, damped, speed, modulus, filmed))
    kinetic = np.array([s.kinetic for s in stores]).T
    stored = np.array([s.stored for s in stores]).T
    lost = np.array([s.lost for s in stores]).T
    energy = kinetic.sum(axis=1) + stored.sum(axis=1)

    def share(of: Array) -> Array:
        total = of.sum(axis=1, keepdims=True)
        return np.asarray(np.divide(of, total, out=np.zeros_like(of), where=total != 0.0))

    size = np.abs(value) * energy
    damping = np.divide(lost, size[:, None], out=np.zeros_like(lost), where=size[:, None] > 0.0)

    over = ("mode", "part")
    return dataset(
        {
            "kinetic": (over, share(kinetic), "1", "share of the kinetic energy"),
            "strain": (over, share(stored), "1", "share of the energy stored in springs"),
            "dissipation": (over, share(lost), "1", "share of what is lost"),
            "damping": (over, damping, "1", "part of the damping ratio −Re λ/|λ|"),
            "frequency": ("mode", found["frequency"].values, "Hz", "undamped natural frequency |λ|/2π"),
        },
        {
            "analysis": "energy shares",
            "speed": speed,
            "damped": int(damped),
            **state_of(source),
            **inputs_of(system.inputs),
        },
        {"part": ([s.name for s in stores], "")},
    )


def _stores(
    source: Equilibrium | Application | System,
    system: System,
    phi: Complex,
    value: Complex,
    damped: bool,
    speed: float,
    modulus: str,
    filmed: bool,
) -> Iterator[Store]:
    size = np.abs(value) ** 2
    none = np.zeros(value.size)
    loses = 1.0 if damped else 0.0

    def quadratic(A: Any, u: Complex) -> Complex:
        return np.asarray(np.sum(u.conj() * (np.asarray(A) @ u), axis=0))

    for part in system.parts:
        u, e = part.place @ phi, part.element
        # damping that turns acts on ẋ − Ω J x: its circulatory part gives or takes power
        turning = speed * (value.conj() * quadratic(e.N, u)).real
        yield Store(
            part.name,
            size * quadratic(e.M, u).real,
            quadratic(e.K, u).real,
            loses * (size * quadratic(e.C, u).real + turning),
        )
        for term in e.viscoelastic:
            shear = 2.0 * quadratic(term.H, u).real
            stored, lost = _branches(term.material, value, damped, modulus)
            what = "volume" if is_volume(term.material) else "shear"
            yield Store(f"{part.name} ({what})", none, stored * shear, lost * shear)
    for spring in system.springs:
        u = spring.across @ phi
        yield Store(
            spring.name,
            none,
            spring.stiffness @ np.abs(u) ** 2,
            loses * size * (spring.damping @ np.abs(u) ** 2),
        )
    if isinstance(source, Equilibrium):
        for hung in system.bearings:
            state, u = source.bearings[hung.name], hung.B @ phi
            stored, lost = quadratic(state.K, u).real, size * quadratic(state.C, u).real
            if filmed and state.balls is not None:
                omega = np.abs(value.imag)
                k, moved = state.balls.stiffness(omega), np.abs(state.balls.across @ u) ** 2
                stored = stored + np.sum(k.real.T * moved, axis=0)
                lost = lost + size / omega * np.sum(k.imag.T * moved, axis=0)
            yield Store(hung.name, none, stored, loses * lost)


def _branches(material: Any, value: Complex, damped: bool, modulus: str) -> tuple[Array, Array]:
    """Moduli (m,) that store, Pa, and lose, Pa rad/s, at eigenvalues λ."""
    if not damped:
        G = material.G0 if modulus == "relaxed" else material.G_instantaneous
        return np.full(value.size, float(G)), np.zeros(value.size)
    stored, lost = np.full(value.size, float(material.G0)), material.eta0 * np.abs(value) ** 2
    for G, tau in zip(material.G, material.tau, strict=True):
        rate = np.abs(value / (1.0 + value * tau)) ** 2
        stored = stored + G * tau**2 * rate
        lost = lost + G * tau * rate
    return stored, lost
