"""The lowest modes of a pair of matrices: none is missed, however many lie below the limit."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy

from bearingdyn.fem import lowest_modes


@pytest.mark.parametrize("count", [7, 20, 21, 53])
def test_every_mode_below_the_limit_is_found(count: int) -> None:
    """Masses in a row between two walls: ω_j = 2√(k/m) sin(jπ/(2(n + 1)))."""
    n, k, m = 600, 1e6, 0.1
    K = k * scipy.sparse.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1])
    exact = np.sqrt(k / m) / math.pi * np.sin(np.arange(1, n + 1) * math.pi / (2 * (n + 1)))
    limit = 0.5 * (exact[count - 1] + exact[count])
    found, shapes = lowest_modes(K, m * scipy.sparse.eye(n), f_max=limit)
    assert found.size == shapes.shape[1] == count
    np.testing.assert_allclose(found, exact[:count], rtol=1e-9)  # round-off, over ω² of 1 to 1e-5
