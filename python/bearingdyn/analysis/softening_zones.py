"""The harmonic response of softening layers in zones, each with a strain of its own.

The zones of a layer share its few coordinates y: where one number makes 2 [G*(γ) − G_lin] of each, zones q
make

    Δ = Σ_q 2 [G*(γ_q) − G_lin] A_q,   Σ_q A_q = 1,   γ_q² = yᴴ Γ_q y

so that there are more strains to find, and no larger matrices to solve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.checks import require, whole
from bearingdyn.parts import RubberZone
from bearingdyn.system import LayerTerm, System
from bearingdyn.types import Array, Complex

# below this strain the law is at its limit of small ones to 1e-12; steps in ln γ, and how far each may leap
NO_STRAIN, STEPS, LEAP, CLOSE = 1e-10, 80, 0.7, 5e-6
# of A, by which the zones of a part may miss its layer
WHOLE = 1e-6


@dataclass(frozen=True, eq=False)
class Zones:
    """Zones (q) of all softening layers, in their coordinates (r).

    Parameters
    ----------
    names
        Of each zone its layer and its own name.
    layer
        (q,) number of its layer among those that soften.
    share
        (q, r, r) A of each.
    strain
        (q, r, r) Γ of each.
    laws
        (q) their materials.
    """

    names: list[str]
    layer: Array
    share: Array
    strain: Array
    laws: list[Any]

    @classmethod
    def of(cls, system: System, soft: Sequence[int], names: Sequence[str], count: object) -> Zones:
        """So many zones of each softening layer's section.

        Parameters
        ----------
        system
            With its parts.
        soft, names
            Which of its layers soften, and their names.
        count
            1 or more.

        Raises
        ------
        ValueError
            For a part that knows no zones.
        """
        number = whole("zones", count, 1)
        ranks = [system.layers[k].L.shape[1] for k in soft]
        ends = np.cumsum([0, *ranks])
        told: list[str] = []
        layer: list[int] = []
        share: list[Array] = []
        strain: list[Array] = []
        laws: list[Any] = []
        for i, k in enumerate(soft):
            term = system.layers[k]
            own = slice(int(ends[i]), int(ends[i + 1]))
            zones, place = _zones_of(system, k, number)
            back = np.linalg.pinv(term.L)  # (rank, n)
            total = np.zeros((ranks[i],) * 2)
            for zone in zones:
                A, Γ = (np.zeros((int(ends[-1]),) * 2) for _ in range(2))
                rows = back @ place.T
                A[own, own] = rows @ zone.H @ rows.T
                counts = rows * zone.concentration
                Γ[own, own] = 2.0 / zone.volume * (counts @ zone.H @ counts.T)
                total += A[own, own]
                told.append(f"{names[i]}: {zone.name}")
                layer.append(i)
                share.append(A)
                strain.append(Γ)
                laws.append(term.material.payne)
            off = float(np.abs(total - np.eye(ranks[i])).max())
            require(
                off <= WHOLE,
                f"zones of part {term.part!r}",
                f"off by {off:.2g}",
                "they do not add up to its rubber: its superelement was changed; leave zones out",
            )
        return cls(told, np.array(layer), np.array(share), np.array(strain), laws)

    def found(
        self, w: Array, R: Complex, linear: Complex, y: Complex
    ) -> tuple[Complex, Complex, Array, Array]:
        """Motions y (e, r), forces on them (e, r), zones' strains (e, q) and layers' (e, l), from a start y.

        Parameters
        ----------
        w
            (e,) rad/s.
        R, linear
            (e, r, r) receptances of y, and (e, r) what y would be without softening.
        y
            (e, r) the motion to begin from.

        Raises
        ------
        ArithmeticError
            Where a strain is not found.
        """
        y = np.array(y, dtype=np.complex128)
        g, force = np.log(self._strains(y)), np.zeros_like(y)
        todo = np.flatnonzero(w > 0)
        eye = np.eye(y.shape[1])
        for _ in range(STEPS):
            if not todo.size:
                break
            change, slope = self._laws(w[todo], g[todo])
            Δ = np.einsum("eq,qrs->ers", 2.0 * change, self.share)
            N = eye + R[todo] @ Δ
            there = np.linalg.solve(N, linear[todo][..., None])[..., 0]
            pulled = np.einsum("qrs,es,eq->erq", self.share, there, 2.0 * slope, optimize=True)
            moved = -np.linalg.solve(N, R[todo] @ pulled)  # (e, r, q)
            gamma = self._strains(np.asarray(there))
            felt = np.einsum("er,qrs->eqs", there.conj(), self.strain)
            J = np.einsum("eqs,esp->eqp", felt, moved, optimize=True).real / gamma[:, :, None] ** 2
            J[gamma <= NO_STRAIN] = 0.0
            step = np.linalg.solve(np.eye(g.shape[1]) - J, (np.log(gamma) - g[todo])[..., None])[..., 0]
            size = np.abs(step).max(axis=1)
            step *= np.minimum(1.0, LEAP / np.maximum(size, 1e-300))[:, None]
            close = size < CLOSE
            g[todo] = np.maximum(g[todo] + step, np.log(NO_STRAIN))
            # the last step is taken along the derivatives
            y[todo] = there + np.einsum("erq,eq->er", moved, step)
            last = todo[close]
            if last.size:
                change, _ = self._laws(w[last], g[last])
                force[last] = np.einsum("eq,qrs,es->er", 2.0 * change, self.share, y[last], optimize=True)
            todo = todo[~close]
        if todo.size:
            raise ArithmeticError(
                f"the strains of the zones were not found at {w[todo[0]] / 2 / np.pi:.6g} Hz: the response "
                f"may jump there from one amplitude to another; take a smaller amplitude, or no zones"
            )
        gamma = self._strains(y)
        return y, force, gamma, self._of_layers(y, gamma)

    def largest(self, strain: Array) -> Array:
        """The largest strain (…, l, c) of each layer's zones, of theirs (…, q, c)."""
        layers = range(int(self.layer.max()) + 1)
        return np.stack([strain[..., self.layer == k, :].max(axis=-2) for k in layers], axis=-2)

    def _strains(self, y: Complex) -> Array:
        """γ (e, q) of motions (e, r), no less than NO_STRAIN."""
        squares = np.einsum("er,qrs,es->eq", y.conj(), self.strain, y, optimize=True).real
        return np.asarray(np.sqrt(np.maximum(squares, NO_STRAIN**2)))

    def _of_layers(self, y: Complex, gamma: Array) -> Array:
        """One strain (e, l) of each layer: ln γ of its zones by their energy."""
        energy = np.einsum("er,qrs,es->eq", y.conj(), self.share, y, optimize=True).real
        found = np.zeros((len(y), int(self.layer.max()) + 1))
        for k in range(found.shape[1]):
            own = self.layer == k
            part = np.maximum(energy[:, own], 0.0) + 1e-300
            found[:, k] = np.exp((part * np.log(gamma[:, own])).sum(axis=1) / part.sum(axis=1))
        return found

    def _laws(self, w: Array, g: Array) -> tuple[Complex, Complex]:
        """Change of modulus (e, q) at ln γ = g (e, q), and its slope over it."""
        change, slope = np.zeros((2, *g.shape), dtype=np.complex128)
        for law in {id(one): one for one in self.laws}.values():
            own = np.array([one is law for one in self.laws])
            gamma = np.exp(g[:, own])
            change[:, own], slope[:, own] = law.change(w[:, None], gamma), law.slope(gamma)
        return change, slope


def _zones_of(system: System, k: int, count: int) -> tuple[list[RubberZone], Array]:
    """Zones of one layer in its part's coordinates, and these (m, n) from the system's."""
    layer: LayerTerm = system.layers[k]
    part = next(p for p in system.parts if p.name == layer.part)
    own = [t for t in system.layers if t.part == layer.part]
    known = getattr(part.source, "zones", None)
    require(
        known is not None,
        "zones",
        count,
        f"part {layer.part!r} is a {type(part.source).__name__}, whose zones are not known: give a bd.Layer "
        f"or bd.Revolved, or leave zones out",
    )
    assert known is not None
    return known(count, next(i for i, t in enumerate(own) if t is layer)), part.place
