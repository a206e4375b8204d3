"""Derivatives of frequency responses with respect to what a machine is made of, by adjoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bearingdyn.analysis.gradient.parameters import Change, modulus_slope
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.linearised import Linear
from bearingdyn.material import answer_of
from bearingdyn.types import Array, Complex, Index


@dataclass(frozen=True, eq=False)
class ResponseSlopes:
    """Slopes of responses x by their adjoints y, −yᵀ Z' x + yᵀ f'; fields as of `Gradient`."""

    state: Linear
    changes: Mapping[str, Change]
    K: Array
    C: Array
    B: Mapping[int, Array]

    def felt(self, rows: Array) -> Index:
        """Coordinates that the outputs' rows (k, n) and the changes of the system touch.

        Parameters
        ----------
        rows
            Of the outputs.
        """
        touched = np.abs(rows).sum(axis=0)
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
        turned, w = y.transpose(0, 2, 1), omega[:, None, None]
        total = np.zeros((len(self.changes), omega.size, y.shape[2], x.shape[2]), dtype=np.complex128)
        for own, matrices in self._matrices(felt).items():
            at = np.asarray(own)
            each = _between([A for _, _, A in matrices], turned[:, :, at], x[:, at])
            for (p, kind, _), found in zip(matrices, each, strict=True):
                total[p] += self._factor(kind, omega) * found
        self._add_bearings(total, felt, turned, x, w)
        self._add_moduli(total, felt, turned, x, omega)
        for p, change in enumerate(self.changes.values()):
            if change.inertia is not None:
                for i, one in enumerate(inputs):
                    if one.axis is not None:
                        total[p, :, :, i] += turned @ change.inertia[felt, one.axis]
        return -total

    def _matrices(self, felt: Index) -> dict[tuple[int, ...], list[tuple[int, str | int, Array]]]:
        """By the coordinates that they touch: parameter, "K", "C", "M" or the layer of a H, and matrix."""
        B = self.state.system.B
        found: dict[tuple[int, ...], list[tuple[int, str | int, Array]]] = {}
        for p, change in enumerate(self.changes.values()):
            mine: list[tuple[str | int, Array | None]] = [
                ("K", change.K),
                ("C", change.C),
                ("M", change.M),
                *change.H.items(),
            ]
            if p in self.B:  # (B'ᵀ A B + Bᵀ A B'), A = K + iωC
                halves = (("K", self.B[p].T @ self.state.K @ B), ("C", self.B[p].T @ self.state.C @ B))
                mine += [(kind, half + half.T) for kind, half in halves]
            for kind, A in mine:
                if A is None:
                    continue
                A = A[np.ix_(felt, felt)]
                own = np.flatnonzero(np.abs(A).sum(axis=0))
                if own.size:
                    entry = (p, kind, A[np.ix_(own, own)])
                    found.setdefault(tuple(own.tolist()), []).append(entry)
        return found

    def _factor(self, kind: str | int, omega: Array) -> Any:
        """What a matrix is multiplied by in Z (f, 1, 1)."""
        w = omega[:, None, None]
        if isinstance(kind, str):
            return {"K": np.ones_like(w), "C": 1j * w, "M": -(w**2)}[kind]
        modulus = answer_of(self.state.system.layers[kind].material, omega)
        return 2.0 * np.asarray(modulus)[:, None, None]

    def _add_bearings(self, total: Complex, felt: Index, turned: Complex, x: Complex, w: Array) -> None:
        """The bearings' tangents change, and act on few coefficients."""
        B = self.state.system.B[:, felt]
        near, far = turned @ B.T, B @ x
        for A, factor in ((self.K, 1.0), (self.C, 1j * w)):
            changed = [p for p in range(len(A)) if A[p].any()]
            if changed:
                total[changed] += factor * _between([A[p] for p in changed], near, far)

    def _add_moduli(self, total: Complex, felt: Index, turned: Complex, x: Complex, omega: Array) -> None:
        """Moduli change, each by itself: yᵀ L Lᵀ x of a layer stands for all of them."""
        seen: dict[int, Complex] = {}
        for p, change in enumerate(self.changes.values()):
            for (k, name), weight in change.shear.items():
                layer = self.state.system.layers[k]
                if k not in seen:
                    L = layer.L[felt]
                    own = np.flatnonzero(np.abs(L).sum(axis=1))
                    seen[k] = (turned[:, :, own] @ L[own]) @ (L[own].T @ x[:, own])
                slope = np.asarray(modulus_slope(layer.material, name, 1j * omega))
                total[p] += 2.0 * weight * slope[:, None, None] * seen[k]


def _between(matrices: Sequence[Array], y: Complex, x: Complex) -> Complex:
    """yᵀ A x (matrices, f, k, i) of y (f, k, n) and x (f, n, i)."""
    f, k, n = y.shape
    half = y.reshape(f * k, n) @ np.concatenate(matrices, axis=1)
    return np.asarray(np.einsum("fkpn,fni->pfki", half.reshape(f, k, -1, n), x))
