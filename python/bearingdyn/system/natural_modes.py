"""The natural modes of a whole, dense system: squares of frequencies, and shapes."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from bearingdyn.types import Array

# below this share of the largest eigenvalue of (K, M) its round-off may hide a slow mode
SLOW = 1e-6
# round-off left in φᵀKφ, as a share of |φ|ᵀ|K||φ|, and in the slow modes, as a share of the fastest of them
ROUND_OFF, SLOW_ROUND_OFF = 1e-12, 1e-13


def natural(K: Array, M: Array) -> tuple[Array, Array]:
    """Natural modes of a system's dense matrices (K, M).

    The ω² of a suspension at 1 Hz is 1e-12 of that of a layer's inner mode at 1 MHz. The slow modes are
    therefore solved for once more, among themselves.

    Parameters
    ----------
    K, M
        Stiffness and mass (n, n), symmetric.

    Returns
    -------
    squares : Array
        ω² (n,), rad²/s²; zero within round-off.
    shapes : Array
        (n, n), mass-normalised.

    Raises
    ------
    ValueError
        For a mass matrix that is not positive definite.
    """
    try:
        squares, shapes = scipy.linalg.eigh(K, M)
    except np.linalg.LinAlgError:
        raise ValueError(
            "the mass matrix is not positive definite: a coordinate has no mass; give every body a mass and "
            "moments of inertia"
        ) from None
    slow = squares < SLOW * squares[-1]
    noise = np.zeros(len(squares))
    if slow.any():
        inner = shapes[:, slow].T @ K @ shapes[:, slow]
        squares[slow], turn = np.linalg.eigh(0.5 * (inner + inner.T))
        shapes[:, slow] = shapes[:, slow] @ turn
        noise[slow] = SLOW_ROUND_OFF * np.abs(squares[slow]).max()
    noise = np.maximum(noise, ROUND_OFF * np.sum(np.abs(shapes) * (np.abs(K) @ np.abs(shapes)), axis=0))
    squares[np.abs(squares) <= noise] = 0.0
    return squares, shapes
