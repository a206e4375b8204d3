"""Derivatives of frequency responses with respect to what a machine is made of, by adjoints."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.analysis.gradient.parameters import Change, modulus_slope
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.linearised import Linear
from bearingdyn.material import answer_of
from bearingdyn.types import Array, Complex, Index

Factor = Callable[[Array], Any]
_Term = tuple[Array, list[tuple[int, Factor]]]


def _one(omega: Array) -> float:
    return 1.0


def _rate(omega: Array) -> Complex:
    return np.asarray(1j * omega)


def _inertia(omega: Array) -> Array:
    return -(omega**2)


@dataclass(frozen=True, eq=False)
class _Group:
    """Matrices that act on the same few motions.

    Attributes
    ----------
    own
        The coordinates, among those felt.
    rows
        (r, own) combinations of them; None: they themselves.
    terms
        Each matrix (r, r), with the parameters by which it changes Z, and by what factor (f,).
    """

    own: Index
    rows: Array | None
    terms: list[_Term]

    def seen(self, motion: Complex) -> Complex:
        """The motions (k, r, f) out of those felt, (k, felt, f)."""
        found = motion[:, self.own]
        return found if self.rows is None else np.asarray(self.rows @ found)


@dataclass(frozen=True, eq=False)
class ResponseSlopes:
    """Slopes of responses x by their adjoints y, −yᵀ Z' x + yᵀ f'; fields as of `Gradient`."""

    state: Linear
    changes: Mapping[str, Change]
    K: Array
    C: Array
    B: Mapping[int, Array]

    def felt(self, rows: Array | None = None) -> Index:
        """Coordinates that the changes of the system touch, and rows (k, n) beside them.

        Parameters
        ----------
        rows
            Of outputs that are told by these coordinates too; None: they are asked for by themselves.
        """
        touched = np.zeros(self.state.system.n) if rows is None else np.abs(rows).sum(axis=0)
        for change in self.changes.values():
            for A in (change.M, change.C, change.K, *change.H.values()):
                if A is not None:
                    touched += np.abs(A).sum(axis=0)
            for layer, _ in change.shear:
                touched += np.abs(self.state.system.layers[layer].L).sum(axis=1)
            if change.inertia is not None:
                touched += np.abs(change.inertia).sum(axis=1)
        for A in self.B.values():
            touched += np.abs(A).sum(axis=0)
        if self.K.any() or self.C.any() or self.B:
            touched += np.abs(self.state.system.B).sum(axis=0)
        return np.asarray(np.flatnonzero(touched > 0), dtype=np.intp)

    def slopes(self, felt: Index, x: Complex, y: Complex, omega: Array, inputs: Sequence[Input]) -> Complex:
        """Derivatives (p, f, k, i) of the response.

        Parameters
        ----------
        felt
            Coordinates that are told.
        x, y
            Motions (f, felt, i) under the inputs, and adjoints (f, felt, k) of the outputs.
        omega
            (f,) rad/s.
        inputs
            What acts: the ground's motion acts by the masses, which change.
        """
        # frequencies last: each number of a matrix then acts on a row of them
        near, far = (np.ascontiguousarray(motion.transpose(2, 1, 0)) for motion in (y, x))
        total = np.zeros((len(self.changes), len(near), len(far), omega.size), dtype=np.complex128)
        for group in (*self._matrices(felt), *self._bearings(felt), *self._moduli(felt)):
            forms = _between([A for A, _ in group.terms], group.seen(near), group.seen(far))
            for form, (_, uses) in zip(forms, group.terms, strict=True):
                for p, factor in uses:
                    total[p] += factor(omega) * form
        for p, change in enumerate(self.changes.values()):
            if change.inertia is not None:
                for i, one in enumerate(inputs):
                    if one.axis is not None:
                        total[p, :, i] += change.inertia[felt, one.axis] @ near
        return -total.transpose(0, 3, 1, 2)

    def _matrices(self, felt: Index) -> list[_Group]:
        """Changes of the system's own matrices, together where they touch the same coordinates."""
        B = self.state.system.B
        found: dict[tuple[int, ...], _Group] = {}
        for p, change in enumerate(self.changes.values()):
            mine: list[tuple[Factor, Array | None]] = [
                (_one, change.K),
                (_rate, change.C),
                (_inertia, change.M),
                *((self._modulus(k), H) for k, H in change.H.items()),
            ]
            if p in self.B:  # (B'ᵀ A B + Bᵀ A B'), A = K + iωC
                halves = (_one, self.B[p].T @ self.state.K @ B), (_rate, self.B[p].T @ self.state.C @ B)
                mine += [(factor, half + half.T) for factor, half in halves]
            for factor, A in mine:
                if A is None:
                    continue
                A = A[np.ix_(felt, felt)]
                own = np.flatnonzero(np.abs(A).sum(axis=0))
                if own.size:
                    group = found.setdefault(tuple(own.tolist()), _Group(own, None, []))
                    group.terms.append((A[np.ix_(own, own)], [(p, factor)]))
        return list(found.values())

    def _bearings(self, felt: Index) -> list[_Group]:
        """Changes of the bearings' tangents, which act on few coefficients."""
        terms: list[_Term] = []
        for A, factor in ((self.K, _one), (self.C, _rate)):
            terms += [(A[p], [(p, factor)]) for p in range(len(A)) if A[p].any()]
        B = self.state.system.B[:, felt]
        own = np.flatnonzero(np.abs(B).sum(axis=0))
        return [_Group(own, B[:, own], terms)] if terms else []

    def _moduli(self, felt: Index) -> list[_Group]:
        """Changes of moduli: yᵀ L Lᵀ x of a layer stands for all of them."""
        uses: dict[int, list[tuple[int, Factor]]] = {}
        for p, change in enumerate(self.changes.values()):
            for (k, name), weight in change.shear.items():
                uses.setdefault(k, []).append((p, self._by_modulus(k, name, weight)))
        found = []
        for k, mine in uses.items():
            L = self.state.system.layers[k].L[felt]
            own = np.flatnonzero(np.abs(L).sum(axis=1))
            found.append(_Group(own, L[own].T, [(np.eye(L.shape[1]), mine)]))
        return found

    def _modulus(self, k: int) -> Factor:
        material = self.state.system.layers[k].material
        return lambda omega: 2.0 * answer_of(material, omega)

    def _by_modulus(self, k: int, name: str, weight: float) -> Factor:
        material = self.state.system.layers[k].material
        return lambda omega: 2.0 * weight * modulus_slope(material, name, 1j * omega)


def _between(matrices: Sequence[Array], y: Complex, x: Complex) -> Complex:
    """yᵀ A x (matrices, k, i, f) of y (k, n, f) and x (i, n, f), by entries that are not zero in some A."""
    A = np.array(matrices)
    a, b = np.nonzero(A.any(axis=0))
    entries = np.ascontiguousarray(A[:, a, b])
    found = np.empty((len(A), len(y), len(x), y.shape[2]), dtype=np.complex128)
    for k, left in enumerate(y):
        for i, right in enumerate(x):
            # a product of real matrices: the entries stand for real and imaginary parts alike
            pairs = (left[a] * right[b]).view(np.float64)
            found[:, k, i] = (entries @ pairs).view(np.complex128)
    return found
