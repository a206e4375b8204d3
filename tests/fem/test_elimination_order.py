"""The order of elimination: a permutation, little fill, and the same solution."""

from __future__ import annotations

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from bearingdyn.fem import Factors
from bearingdyn.fem.elimination_order import elimination_order


def grid(n: int) -> scipy.sparse.csc_matrix:
    """A grid of n × n × n nodes, each coupled with all 26 about it as by bricks, three coordinates each."""
    one = scipy.sparse.diags([np.ones(n - 1), 4.0 * np.ones(n), np.ones(n - 1)], [-1, 0, 1])
    coupled = np.array([[3.0, 0.5, 1.0], [0.5, 3.0, 0.5], [1.0, 0.5, 3.0]])
    return scipy.sparse.csc_matrix(
        scipy.sparse.kron(scipy.sparse.kron(one, scipy.sparse.kron(one, one)), coupled)
    )


def fill(A, order=None):
    options = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    if order is None:
        return scipy.sparse.linalg.splu(A, permc_spec="MMD_AT_PLUS_A", **options).nnz
    return scipy.sparse.linalg.splu(A[order][:, order].tocsc(), permc_spec="NATURAL", **options).nnz


def test_dissection_of_a_cube_fills_little():
    A = grid(14)
    order = elimination_order(A)
    assert np.array_equal(np.sort(order), np.arange(A.shape[0]))
    # coordinates of a node follow each other: they have the same neighbours
    assert np.all(np.diff(order.reshape(-1, 3), axis=1) == 1)
    ratio = fill(A, order) / fill(A)
    natural = fill(A, np.arange(A.shape[0])) / fill(A)
    print(f"fill of {A.shape[0]} over minimum degree's: dissection {ratio:.2f}, as numbered {natural:.2f}")
    # dissection is for large solids: as small as this, where half the cube is surface, minimum degree wins
    assert ratio < 0.8 * natural
    assert ratio < 1.5


def test_bodies_that_do_not_touch_are_ordered_one_after_another():
    A = scipy.sparse.block_diag([grid(8), grid(7)], format="csc")
    order = elimination_order(A)
    assert np.array_equal(np.sort(order), np.arange(A.shape[0]))
    assert fill(A, order) < 1.5 * fill(A)
    b = np.random.default_rng(0).standard_normal((A.shape[0], 2))
    x = Factors(A, order).solve(b)
    np.testing.assert_allclose(A @ x, b, atol=1e-12)  # condition 1e3, round-off 1e-16
    np.testing.assert_allclose(Factors(A, order).solve(b[:, 0]), x[:, 0], atol=1e-13)
