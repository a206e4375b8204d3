"""Derivatives of eigenvalues with respect to what a machine is made of, of multiple ones too."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from bearingdyn.analysis.gradient.parameters import Change, modulus_slope
from bearingdyn.analysis.linearised import Linear
from bearingdyn.types import Array, Complex


@dataclass(frozen=True, eq=False)
class ModeSlopes:
    """Slopes of a state's modes: derivatives of eigenvalues; fields as of `Gradient`, and modes asked for.

    References
    ----------
    R. L. Fox and M. P. Kapoor, AIAA J. 6 (1968) 2426.
    """

    state: Linear
    changes: Mapping[str, Change]
    K: Array
    C: Array
    B: Mapping[int, Array]
    speed: float
    damped: bool
    side: str | None

    def of_multiple(self, value: complex, V: Complex, first: int) -> Complex:
        """λ' (parameters, m) of an m-fold eigenvalue with shapes V (n, m), the `first` of all modes.

        Parameters
        ----------
        value, V, first
            The eigenvalue, its shapes, and its number.

        Raises
        ------
        ValueError
            Where a parameter parts the modes and no side is asked for.
        """
        speed, damped = self.speed, self.damped
        s, B = self.state.system, self.state.system.B
        K = (s.K + B.T @ self.state.K @ B).astype(np.complex128)
        C = (s.C + B.T @ self.state.C @ B) if damped else np.zeros_like(s.C)
        turning = speed * s.G if damped else np.zeros_like(s.G)
        dZ = C + turning + 2 * value * s.M
        Z = K + value * (C + turning) + value**2 * s.M + (speed * s.N if damped else 0.0)
        for layer in s.layers:
            m, L = layer.material, layer.L
            shear = complex(m.G0)
            if damped:
                shear += value * m.eta0 + complex(np.sum(m.G * value * m.tau / (1 + value * m.tau)))
                rising = m.eta0 + complex(np.sum(m.G * m.tau / (1 + value * m.tau) ** 2))
                dZ = dZ + 2 * rising * (L @ L.T)
            Z += 2 * shear * (L @ L.T)
        if damped and speed != 0.0:
            # left vectors, by the smallest singular values of Z scaled by the masses
            scale = 1.0 / np.sqrt(np.abs(np.diag(s.M)))
            u = np.linalg.svd(scale[:, None] * Z * scale)[0][:, -V.shape[1] :]
            W = scale[:, None] * np.conj(u)
        else:
            W = V
        norm = W.T @ dZ @ V
        found = np.zeros((len(self.changes), V.shape[1]), dtype=np.complex128)
        for p, (name, change) in enumerate(self.changes.items()):
            A = np.linalg.solve(norm, -W.T @ self._matrix_slope(change, p, value) @ V)
            if V.shape[1] == 1:
                found[p] = A[0, 0]
                continue
            each = np.linalg.eigvals(A)
            spread, scale_of = np.ptp(each.real) + np.ptp(each.imag), np.abs(each).max()
            if spread > 1e-5 * scale_of and self.side not in ("up", "down"):
                numbers = ", ".join(str(first + k + 1) for k in range(V.shape[1]))
                raise ValueError(
                    f"modes {numbers} coincide at {abs(value) / (2 * math.pi):.6g} Hz, and {name!r} parts "
                    f"them: their derivatives are one-sided; ask for side='up', of a parameter that "
                    f"grows, or 'down'"
                )
            order = np.argsort(each.imag, kind="stable")
            found[p] = each[order if self.side != "down" else order[::-1]]
        return found

    def _matrix_slope(self, change: Change, p: int, value: complex) -> Complex:
        """∂Z/∂(parameter) (n, n) at a rate λ."""
        s, B, damped = self.state.system, self.state.system.B, self.damped
        total = np.zeros((s.n, s.n), dtype=np.complex128)
        if change.K is not None:
            total += change.K
        if change.M is not None:
            total += value**2 * change.M
        total += B.T @ self.K[p] @ B
        if p in self.B:
            half = self.B[p].T @ (self.state.K + (value if damped else 0.0) * self.state.C) @ B
            total += half + half.T
        if damped:
            total += value * (B.T @ self.C[p] @ B)
            if change.C is not None:
                total += value * change.C
        for k, layer in enumerate(s.layers):
            m, shear = layer.material, 0.0 + 0.0j
            if k in change.H:
                G = complex(m.G0)
                if damped:
                    G += value * m.eta0 + complex(np.sum(m.G * value * m.tau / (1 + value * m.tau)))
                total += 2 * G * change.H[k]
            for (own, name), weight in change.shear.items():
                if own == k:
                    rate = value if damped else 0.0
                    shear += weight * complex(modulus_slope(m, name, rate))
            if shear:
                total += 2 * shear * (layer.L @ layer.L.T)
        return total
