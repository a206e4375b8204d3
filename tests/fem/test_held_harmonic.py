"""Factors of held harmonics by a band: the solutions of SuperLU, whatever the section and what is held."""

from __future__ import annotations

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.fem import assemble_harmonic, factorise, held_factors
from bearingdyn.fem import held_harmonic as room

COMPONENTS = {0: (0, 2), 1: (0, 1, 2), 3: (0, 1, 2)}


def held(order: int, shape: tuple[float, float]):
    """A rubber ring held at its inner face: the harmonic, its stiffness and what remains."""
    layer = bd.Layer(0.03, 0.03 + shape[0], shape[1], bd.Maxwell(1e6, [1e6], [1e-3], K=2e9, density=1100.0))
    mesh = layer.body.mesh
    h = assemble_harmonic(mesh, order, COMPONENTS[order])
    inside = h.coordinates(np.flatnonzero(mesh.r < 0.03 + 1e-9))
    return h, h.stiffness([2e9], [1e6]), np.setdiff1d(h.free, inside)


@pytest.mark.parametrize("order", [0, 1, 3])
@pytest.mark.parametrize("shape", [(0.002, 0.02), (0.012, 0.006)])
def test_band_gives_the_solutions_of_superlu(order, shape):
    h, K, inner = held(order, shape)
    load = np.random.default_rng(2).standard_normal((inner.size, 3))
    ours, theirs = held_factors(h, K, inner), factorise(K[inner][:, inner])
    assert isinstance(ours, room.Banded)
    for b in (load, load[:, 0], load[:, :0]):
        x, y = ours.solve(b), theirs.solve(b)
        assert x.shape == b.shape
        # condition of nearly incompressible rubber, some 1e7, times rounding
        assert np.abs(x - y).max(initial=0.0) <= 1e-9 * np.abs(y).max(initial=0.0)


def test_designs_of_one_topology_do_not_mix():
    """Two layers of other dimensions, the same number of elements: each by its own numbers."""
    first, second = held(1, (0.002, 0.02)), held(1, (0.0021, 0.0209))
    assert first[0].pattern is second[0].pattern  # and with it the places of the band
    held_factors(*first)
    places = set(first[0].pattern.held)
    for h, K, inner in (first, second):
        b = np.ones(inner.size)
        x = held_factors(h, K, inner).solve(b)
        assert np.abs(K[inner][:, inner] @ x - b).max() < 1e-6
    assert set(first[0].pattern.held) == places


@pytest.mark.parametrize("change", ["complex", "indefinite"])
def test_what_has_no_cholesky_factors_goes_to_superlu(change):
    h, K, inner = held(1, (0.002, 0.02))
    K = K * (1 + 0.1j) if change == "complex" else K - 1e12 * h.mass_matrix([1100.0])
    found = held_factors(h, K, inner)
    assert not isinstance(found, room.Banded)
    b = np.ones(inner.size, dtype=K.dtype)
    assert np.abs(K[inner][:, inner] @ found.solve(b) - b).max() < 1e-6
