"""The lowest modes of a pair of matrices: none is missed, however many lie below the limit."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy

from bearingdyn.fem import factorise, lowest_modes
from bearingdyn.fem import factors as room
from bearingdyn.fem.block_lanczos import lowest_pairs


def chain(n: int) -> scipy.sparse.csr_matrix:
    """Springs of unit stiffness in a row between two walls."""
    return scipy.sparse.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1], format="csr")


@pytest.mark.parametrize("count", [7, 20, 21, 53])
def test_every_mode_below_the_limit_is_found(count: int) -> None:
    """Masses in a row between two walls: ω_j = 2√(k/m) sin(jπ/(2(n + 1)))."""
    n, k, m = 600, 1e6, 0.1
    K = k * chain(n)
    exact = np.sqrt(k / m) / math.pi * np.sin(np.arange(1, n + 1) * math.pi / (2 * (n + 1)))
    limit = 0.5 * (exact[count - 1] + exact[count])
    found, shapes = lowest_modes(K, m * scipy.sparse.eye(n), f_max=limit)
    assert found.size == shapes.shape[1] == count
    np.testing.assert_allclose(found, exact[:count], rtol=1e-9)  # round-off, over ω² of 1 to 1e-5


@pytest.mark.parametrize("copies", [1, 8, 13, 30])
def test_modes_of_equal_frequency_are_all_found_however_many(copies: int) -> None:
    """Chains that do not touch: each frequency comes once for each, more often than a block is wide."""
    n = 700 // copies + 40
    K = scipy.sparse.kron(scipy.sparse.eye(copies), chain(n), format="csr")
    exact = 2.0 * np.sin(np.arange(1, 6) * math.pi / (2 * (n + 1)))
    found, shapes = lowest_modes(K, scipy.sparse.eye(copies * n), n_modes=4 * copies)
    # round-off of ω² of 1e-4 to 1e-2 against springs of one
    np.testing.assert_allclose(2 * math.pi * found, np.repeat(exact[:4], copies), rtol=1e-9)
    np.testing.assert_allclose(shapes.T @ shapes, np.eye(4 * copies), atol=1e-12)  # round-off of n terms
    # few are found in few steps, before rounding has shown what a block of eight could not hold
    first = lowest_modes(K, scipy.sparse.eye(copies * n), n_modes=min(9, copies))[0]
    np.testing.assert_allclose(first, found[: min(9, copies)], rtol=1e-9)
    below = lowest_modes(K, scipy.sparse.eye(copies * n), f_max=(exact[3] + exact[4]) / (4 * math.pi))[0]
    np.testing.assert_allclose(below, found, rtol=1e-9)


@pytest.mark.parametrize("low", [4, 6, 8])
def test_none_is_missed_where_the_first_block_holds_one_part_alone(low: int) -> None:
    """Chains that do not touch, begun from the lowest modes of one of them: the others are still found."""
    copies, n = 6, 160
    K = scipy.sparse.kron(scipy.sparse.eye(copies), chain(n), format="csr")
    exact = 2.0 * np.sin(np.arange(1, 10) * math.pi / (2 * (n + 1)))
    place = np.arange(1, n + 1)[:, None] * np.arange(1, low + 1) * math.pi / (n + 1)
    near = np.zeros((copies * n, low))
    near[:n] = np.sin(place)
    limit = (exact[low - 1] + 1e-3 * (exact[low] - exact[low - 1])) / (2 * math.pi)
    found, _ = lowest_modes(K, scipy.sparse.eye(copies * n), f_max=limit, near=near)
    # round-off of ω² of 4e-4 against springs of one
    np.testing.assert_allclose(2 * math.pi * found, np.repeat(exact[:low], copies), rtol=1e-9)


def test_vectors_near_the_modes_save_steps_and_change_nothing() -> None:
    n = 900
    K, M = chain(n), scipy.sparse.eye(n, format="csc")
    exact = 2.0 * np.sin(np.arange(1, 8) * math.pi / (2 * (n + 1)))
    place = np.arange(1, n + 1)[:, None] * np.arange(1, 7) * math.pi / (n + 1)
    near = np.sin(place) + 1e-3 * np.random.default_rng(4).standard_normal((n, 6))
    lu, steps = factorise(K), []

    class Counted:
        def solve(self, b):
            steps.append(b.shape[1])
            return lu.solve(b)

    limit = 0.5 * (exact[4] + exact[5]) / (2 * math.pi)
    plain, shapes = lowest_modes(K, M, f_max=limit, lu=Counted())
    without = sum(steps)
    steps.clear()
    found, same = lowest_modes(K, M, f_max=limit, lu=Counted(), near=near)
    assert len(steps) < without
    np.testing.assert_allclose(found, plain, rtol=1e-9)  # round-off of ω² of 1e-5 against springs of one
    np.testing.assert_allclose(same, shapes, atol=1e-7)  # a residual of 1e-10 over relative gaps of .01


def test_pairs_are_those_of_arpack_and_as_many_as_pivots_are_negative() -> None:
    """A membrane of unequal sides and masses: the same ω² by ARPACK, and none below them by Sylvester."""
    A, B = chain(37), chain(41)
    K = scipy.sparse.kron(A, scipy.sparse.eye(41)) + scipy.sparse.kron(scipy.sparse.eye(37), B)
    K = scipy.sparse.csc_matrix(K)
    M = scipy.sparse.diags(np.random.default_rng(3).uniform(0.5, 2.0, 37 * 41), format="csc")
    found = lowest_pairs(factorise(K).solve, M, 25, math.inf, 700)
    assert found is not None
    theirs = np.sort(scipy.sparse.linalg.eigsh(K, 26, M, sigma=0.0, return_eigenvectors=False))
    np.testing.assert_allclose(found[0], theirs[:25], rtol=1e-12)  # round-off of ω² of .01 against 8
    assert (room.pivots(K - 0.5 * (theirs[24] + theirs[25]) * M) < 0).sum() == 25
    # a residual of 1e-10 θ over relative gaps of .01, and the weight of M
    force = K @ found[1] - (M @ found[1]) * found[0]
    assert np.linalg.norm(force, axis=0).max() < 1e-7 * found[0].max()


def test_the_same_shapes_come_again_from_other_factors() -> None:
    """Bending of a square beam: two modes of one frequency, whose plane nothing but a rule tells."""
    K = scipy.sparse.kron(scipy.sparse.eye(2), chain(450) @ chain(450), format="csr")
    M = scipy.sparse.eye(900, format="csr")
    one = lowest_modes(K, M, n_modes=4)[1]
    order = np.random.default_rng(1).permutation(900)
    lu = factorise(K[order][:, order])

    class Turned:
        def solve(self, b):
            x = np.empty_like(b)
            x[order] = lu.solve(np.ascontiguousarray(b[order]))
            return x

    other = lowest_modes(K, M, n_modes=4, lu=Turned())[1]
    np.testing.assert_allclose(other, one, atol=1e-6)  # condition of K, 1e9, times rounding
