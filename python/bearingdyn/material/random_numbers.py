"""Random numbers for draws: even and normal ones, by a Sobol sequence or at random."""

from __future__ import annotations

import numpy as np

from bearingdyn.checks import one_of, whole
from bearingdyn.types import Array


def normals(n: int, size: int, seed: int = 0, method: str = "sobol") -> Array:
    """Random numbers of the standard normal kind (n, size), by a Sobol sequence or at random.

    Parameters
    ----------
    n, size
        Number of draws, and of numbers in each.
    seed
        Of the scrambling, or of the random numbers.
    method
        "sobol" or "random".
    """
    from scipy.special import ndtri

    return np.asarray(ndtri(uniforms(n, size, seed, method)))


def uniforms(n: int, size: int, seed: int = 0, method: str = "sobol") -> Array:
    """Random numbers that fill (0, 1) evenly, (n, size), by a Sobol sequence or at random.

    Parameters
    ----------
    n, size
        Number of draws, and of numbers in each.
    seed
        Of the scrambling, or of the random numbers.
    method
        "sobol" or "random".
    """
    import warnings

    n, seed = whole("n", n, 1), whole("seed", seed, 0)
    one_of("method", method, ("sobol", "random"))
    if method == "random":
        unit = np.random.default_rng(seed).random((n, size))
    else:
        from scipy.stats import qmc

        with warnings.catch_warnings():  # of a number that is no power of two
            warnings.simplefilter("ignore", UserWarning)
            unit = qmc.Sobol(size, scramble=True, rng=seed).random(n)
    return np.asarray(np.clip(unit, 2.0**-40, 1.0 - 2.0**-40))
