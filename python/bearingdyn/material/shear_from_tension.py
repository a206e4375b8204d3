"""Complex shear moduli from moduli measured in tension."""

from __future__ import annotations

import numpy as np

from bearingdyn.checks import positive, require
from bearingdyn.types import Complex


def shear_modulus(modulus: Complex, K: float | None, nu: float | None) -> tuple[Complex, str]:
    """Complex shear modulus of a complex modulus in tension, Pa, by K or by nu, and a note that says how.

    Raises ValueError unless exactly one is given and in its range.
    """
    if (K is None) == (nu is None):
        raise ValueError("to_shear: give either the bulk modulus, K=2e9, or Poisson's ratio, nu=0.5")
    if nu is not None:
        require(0 <= nu <= 0.5, "nu", nu, "Poisson's ratio must lie between 0 and 0.5")
        return modulus / (2 * (1 + nu)), f"tension turned into shear by E*/2(1 + nu), nu = {nu:g}"
    assert K is not None  # one of the two is given
    positive("K", K, "it must be positive and finite, Pa")
    if not np.all(modulus.real < 9 * K):
        raise ValueError(
            f"K is {K:g} Pa; it must exceed a ninth of the tensile modulus, here {modulus.real.max():.4g} Pa"
        )
    return 3 * K * modulus / (9 * K - modulus), f"tension turned into shear by 3KE*/(9K - E*), K = {K:g} Pa"
