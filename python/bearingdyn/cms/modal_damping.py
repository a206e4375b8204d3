"""Viscous damping by modes."""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.cms.coordinate_coupling import coupled_blocks
from bearingdyn.cms.reduction_options import check_damping
from bearingdyn.types import Array


def modal_damping(M: ArrayLike, K: ArrayLike, zeta: float) -> Array:
    """Viscous damping that gives every free elastic mode the same damping ratio.

    C = M Φ diag(2 ζ ω) Φᵀ M with ΦᵀMΦ = I, rigid-body modes undamped: the same matrix serves the time and the
    frequency domain.

    Parameters
    ----------
    M, K
        Mass, kg, positive definite, and stiffness, N/m, (n, n). A mode counts as rigid when its ω² is below
        round-off of the largest.
    zeta
        The damping ratio ζ.

    Returns
    -------
    Array
        C (n, n), N s/m.

    Raises
    ------
    ValueError
        For zeta outside 0...1 or an M that is not positive definite.

    References
    ----------
    Wilson & Penzien, Int. J. Num. Meth. Eng. 4 (1972) 5-10.
    """
    m, k = np.asarray(M, dtype=np.float64), np.asarray(K, dtype=np.float64)
    check_damping(zeta, "zeta")
    if zeta == 0.0:
        return np.zeros_like(m)
    if not np.all(np.diag(m) > 0):
        raise ValueError("M has a diagonal entry that is not positive; modal damping needs a mass for each")
    C = np.zeros_like(m)
    for block in coupled_blocks(m, k):  # so that round-off does not couple what M and K do not
        inside = np.ix_(block, block)
        m_b, k_b = m[inside], k[inside]
        s = 1.0 / np.sqrt(np.diag(m_b))  # metres and radians brought to one scale before the rank decision
        try:
            lam, phi = scipy.linalg.eigh(s[:, None] * k_b * s, s[:, None] * m_b * s)
        except np.linalg.LinAlgError as error:
            raise ValueError(
                f"M is not positive definite ({error}); modal damping needs one that is"
            ) from error
        elastic = lam > 100.0 * len(lam) * np.finfo(float).eps * np.abs(lam).max()
        MPhi = m_b @ (s[:, None] * phi[:, elastic])
        C[inside] = (MPhi * (2.0 * zeta * np.sqrt(lam[elastic]))) @ MPhi.T
    return C
