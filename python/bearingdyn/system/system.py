"""The system: an application as plain arrays, ready for the C core.

    M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 [G*] L Lᵀ x + Bᵀ g(B x) = f(t)

Layers are kept apart by a factor of their deviatoric matrix, H = L Lᵀ (paper (16), (25)): their modulus is a
property of time or frequency, not of the matrices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from bearingdyn import core
from bearingdyn.application import COMPONENTS, Channel
from bearingdyn.bearing import BallBearing, FilmDamping
from bearingdyn.checks import meant
from bearingdyn.cms import coupled_blocks
from bearingdyn.notice import OilAtOtherSpeed, warn
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_speed_value, plausible
from bearingdyn.system.layer_static_modulus import Modulus, static_modulus
from bearingdyn.system.natural_modes import natural
from bearingdyn.system.raceway_channels import raceway_row
from bearingdyn.system.softening_layer import marched_layer
from bearingdyn.system.system_matrix_check import check_matrix
from bearingdyn.system.terms import BearingTerm, Contacts, LayerTerm, LoadTerm, PartTerm, SpringTerm
from bearingdyn.types import Array, Index

# a speed over that of an oil supply, from which its films are doubted: the film's change is 16 %
APART = 1.25
# a test spring in N/m that stands for a bearing when free motions are sought: any stiff value serves
TEST_SPRING = 1e8


@dataclass(frozen=True, eq=False, kw_only=True)
class System:
    """The system: matrices (n, n), terms, and rows (3 or 6, n) of every interface and output by name.

    All fields are given by name; M, C, G, K, N is the order wherever the matrices are listed.

    Raises
    ------
    ValueError
        For M, C or K that is not symmetric, G or N that is not skew-symmetric, and matrices of unequal
        shape or with an entry that is not finite; names the matrix and the entry.
    """

    M: Array
    C: Array
    G: Array
    K: Array
    N: Array
    layers: tuple[LayerTerm, ...] = ()
    bearings: tuple[BearingTerm, ...] = ()
    loads: tuple[LoadTerm, ...] = ()
    outputs: Mapping[str, Array] = field(default_factory=dict)
    standstill: tuple[str, ...] = ()
    """Parts that turn with the shaft, but whose damping is written for the fixed frame."""
    inertia: Array | None = None
    """(n, 3) kg: −inertia @ ü is the force of a ground that moves with ü; NaN where a part holds itself."""
    parts: tuple[PartTerm, ...] = ()
    springs: tuple[SpringTerm, ...] = ()
    held: tuple[tuple[str, ...], ...] = ()
    """Interfaces that the ground holds rigidly, those that are one joint together."""
    turning: tuple[str, ...] = ()
    """Parts that turn with the shaft."""
    positions: Mapping[str, Array] = field(default_factory=dict)
    """Where interfaces and outputs stand, (3,) m, from the first interface of the first part."""
    inputs: str = ""
    """What the system was assembled from, as `bearingdyn.fingerprint` writes it."""

    _repr_html_ = page

    def __post_init__(self) -> None:
        """Check the matrices."""
        for name in "MCGKN":
            check_matrix(name, getattr(self, name), self.n, sign=-1 if name in "GN" else 1)

    def __repr__(self) -> str:
        """One line instead of the matrices."""
        counts = f"{len(self.layers)} layers, {len(self.bearings)} bearings, {len(self.loads)} loads"
        return f"<System of {self.n} coordinates, {counts}>"

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.M.shape[0])

    @property
    def B(self) -> Array:
        """All bearings' coefficients, one under another, (coefs, n)."""
        return np.vstack([np.zeros((0, self.n)), *(b.B for b in self.bearings)])

    def rows(self, name: str) -> Array:
        """Rows (3 or 6, n) of an interface or output.

        Raises
        ------
        ValueError
            Where none has that name.
        """
        if name not in self.outputs:
            raise ValueError(f"{name!r} is no interface or output; {meant(name, self.outputs)}")
        return self.outputs[name]

    def row(self, channel: str | Channel) -> Array:
        """Row (n,) of one component: "shaft.left.y"; rotations are θx, θy, θz or rx, ry, rz.

        Of a raceway: "ring.raceway.radial-cos2", or "ring.raceway.axial@-90" at an azimuth in degrees.

        Raises
        ------
        ValueError
            Where the place or the component does not exist.
        """
        wanted = Channel.parse(channel) if isinstance(channel, str) else channel
        for part in self.parts:
            for name, raceway in part.element.raceways.items():
                place = f"{part.name}.{name}"
                if f"{wanted.site}.".startswith(f"{place}."):
                    own = raceway_row(place, raceway, f"{wanted.site}.{wanted.component}"[len(place) + 1 :])
                    return np.asarray(own @ part.place)
        place = f"{wanted.site}.{wanted.component}"
        if place in self.outputs:
            raise ValueError(f"{place!r} is a place; add what of it is meant, as {place + '.y'!r}")
        rows = self.rows(wanted.site)
        if wanted.index is None or wanted.index >= rows.shape[0]:
            known = list(COMPONENTS[: rows.shape[0]])
            raise ValueError(f"{str(channel)!r}: {wanted.site} has {known}, not {wanted.component!r}")
        return np.asarray(rows[wanted.index])

    def check_speed(self, speed: float) -> None:
        """Refuse a speed at which the damping of a part would be wrong.

        Damping of material that turns acts on ẋ − Ω J x. Without its circulatory part, a whirl that it makes
        unstable would look damped.

        Raises
        ------
        ValueError
            For a speed (rad/s) that is not finite, and for any but 0 where the damping of a part that turns
            is known at rest only; names the part.

        Warns
        -----
        OilAtOtherSpeed
            For bearings that were lubricated for a speed more than a quarter off.
        """
        plausible("speed", "speed", speed, "it must be one finite number, in rad/s")
        for term in self.bearings:
            if isinstance(term.bearing, BallBearing):
                # no contact angle stated: deep groove; ceramic balls, of 3200 kg/m³, are a spindle's
                groove = term.bearing.contact_angle is None and term.bearing.ball_material.density > 5e3
                check_speed_value(f"bearing {term.name!r}: speed", speed, term.bearing.Dpw, groove)
                _doubt_oil(term.name, term.bearing, speed)
        if speed != 0.0 and self.standstill:
            raise ValueError(
                f"{self.standstill[0]!r} turns with the shaft, and its damping is known for a part at rest "
                f"only; put it outside the bearings, or compute at speed 0"
            )

    def static_load(self) -> Array:
        """Sum of the constant loads, (n,)."""
        return sum((p.p_cos for p in self.loads if p.kind == "constant"), np.zeros(self.n))

    def static_moduli(self, modulus: Modulus = "relaxed") -> list[float]:
        """Shear modulus of each layer, Pa, at "relaxed" G0, "instantaneous", or G(t) at a time t, s."""
        return [static_modulus(layer, modulus) for layer in self.layers]

    def stiffness(self, modulus: Modulus = "relaxed") -> Array:
        """K (n, n) with every layer at its "relaxed" modulus G0, its "instantaneous" one, or G(t), t in s.

        A sequence gives the modulus of each layer itself, Pa.
        """
        K = self.K.copy()
        moduli = modulus if isinstance(modulus, Sequence) and not isinstance(modulus, str) else None
        for G, layer in zip(moduli or self.static_moduli(modulus), self.layers, strict=True):
            K += 2.0 * G * (layer.L @ layer.L.T)
        return K

    def viscous(self) -> Array:
        """C with the parallel dashpots 2 η0 L Lᵀ of the layers, (n, n)."""
        C = self.C.copy()
        for layer in self.layers:
            C += 2.0 * getattr(layer.material, "eta0", 0.0) * (layer.L @ layer.L.T)
        return C

    def transformed(self, T: Array) -> System:
        """The same system in coordinates q, x = T q; T (n, m)."""

        def congruence(A: Array) -> Array:
            return np.asarray(T.T @ A @ T)

        return replace(
            self,
            M=congruence(self.M),
            C=congruence(self.C),
            G=congruence(self.G),
            K=congruence(self.K),
            N=congruence(self.N),
            layers=tuple(replace(t, L=T.T @ t.L) for t in self.layers),
            bearings=tuple(replace(t, B=t.B @ T) for t in self.bearings),
            loads=tuple(replace(t, p_cos=T.T @ t.p_cos, p_sin=T.T @ t.p_sin) for t in self.loads),
            outputs={name: rows @ T for name, rows in self.outputs.items()},
            inertia=None if self.inertia is None else T.T @ self.inertia,
            parts=tuple(replace(t, place=t.place @ T) for t in self.parts),
            springs=tuple(replace(t, across=t.across @ T) for t in self.springs),
        )

    def blocks(self) -> list[Index]:
        """Coordinates that the structure couples, its bearings left out, block by block."""
        touched = [(layer.L != 0.0).astype(float) for layer in self.layers]
        return coupled_blocks(self.M, self.C, self.G, self.K, self.N, *(t @ t.T for t in touched))

    def basis(self, modulus: Modulus = "relaxed") -> tuple[Array, Array]:
        """ω² (n,) and modes T (n, n), x = T q, of the structure, its bearings left out, block by block."""
        K = self.stiffness(modulus)
        T = np.zeros((self.n, self.n))
        squares = np.zeros(self.n)
        for block in self.blocks():
            inside = np.ix_(block, block)
            squares[block], T[inside] = natural(K[inside], self.M[inside])
        return squares, T

    def modal(self) -> tuple[System, Array]:
        """The system in modes of its relaxed stiffness and mass, block by block, and T with x = T q.

        Layers that soften have there what their law leaves (`Maxwell.rest`).

        M is then exactly the identity and the relaxed stiffness exactly diagonal, as a long march needs.
        """
        moduli = self.marched_moduli()
        squares, T = self.basis(moduli)
        modal = self.transformed(T)
        relaxed = np.zeros((self.n, self.n))
        for G, layer in zip(moduli, modal.layers, strict=True):
            relaxed += 2.0 * G * (layer.L @ layer.L.T)
        # K + relaxed, formed again in `stiffness`, is diagonal to the last bit
        return replace(modal, M=np.eye(self.n), K=np.diag(squares) - relaxed), T

    def free_motions(self, modulus: str = "relaxed") -> Array:
        """Motions (n, m) that nothing holds, mass-normalised; bearings count as springs."""
        K = self.stiffness(modulus) + TEST_SPRING * (self.B.T @ self.B)
        squares, shapes = natural(K, self.M)
        return np.asarray(shapes[:, squares <= 0.0])

    def marched_moduli(self) -> list[float]:
        """Shear modulus, Pa, of each layer in a march: relaxed, or what a law of softening leaves."""
        return [
            static_modulus(layer, "relaxed") if layer.strain is None else layer.material.rest.G0
            for layer in self.layers
        ]

    def model(
        self,
        channels: list[tuple[int, Array | None, int, int]],
        relaxed: bool = True,
        memory: float | None = None,
        contacts: Contacts = "viscous",
    ) -> core.Model:
        """The core's model.

        Parameters
        ----------
        channels
            Kind, row (n,), bearing and index of what a march records.
        relaxed
            True, for a march: K holds the layers at their G0, and branches do the rest. False, for a
            harmonic response: the whole deviatoric stiffness is left to a modulus given per frequency.
        memory
            Time, s, over which layers that soften remember their amplitude; needed for their march.
        contacts
            Whether films answer as viscous dampers, or remember.

        Raises
        ------
        ValueError
            Without a memory that is needed, and as `BearingTerm.kernel`.
        """
        C = self.viscous() if relaxed else self.C
        K = self.stiffness(self.marched_moduli()) if relaxed else self.K
        empty = np.zeros(0)
        layers = [marched_layer(t, memory) if relaxed else (t.L, empty, empty) for t in self.layers]
        return core.Model(
            M=self.M,
            C=C,
            G=self.G,
            K=K,
            N=self.N,
            layers=layers,
            bearings=[(t.kernel(contacts).packed(), t.B) for t in self.bearings],
            loads=[(t.kind, t.omega, t.p_cos, t.p_sin, t.time, t.value) for t in self.loads],
            channels=channels,
        )


def _doubt_oil(name: str, bearing: BallBearing, speed: float) -> None:
    """Warn of films and damping that were found at another speed, rad/s (OilAtOtherSpeed)."""
    damping = bearing.damping
    inner, outer = bearing.ring_speeds
    if not isinstance(damping, FilmDamping) or damping.answer is None or speed == 0.0 or inner == outer:
        return
    # the speed of entrainment was that of the loaded angle, whose cosine matters little here
    gamma = bearing.geometry.gamma
    known = damping.answer.us / (bearing.Dpw / 2 * abs(inner - outer) * (1 - gamma**2))
    if not 1 / APART <= abs(speed) / known <= APART:
        warn(
            f"bearing {name!r} has the films and the damping of {known:.3g} rad/s, of its lubrication, and "
            f"is asked at a speed more than {APART - 1:.0%} off: films go as speed to the power 0.67; give "
            "lubrication=OilSupply(..., speed=) of the speed asked",
            OilAtOtherSpeed,
        )
