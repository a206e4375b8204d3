"""Bands of a layer: the orders of a ring, which do not couple, are marched one by one, to the same end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.cms import coupled_blocks
from bearingdyn.system import factor
from flexible_rings import CUSHIONED, hung

ORDER = 8
RECORD = ["rotor.centre.y", "rotor.centre.θx", "b.force.y", "b.ball3"]


@pytest.fixture(scope="module")
def state() -> bd.Equilibrium:
    return bd.equilibrium(hung(replace(CUSHIONED, order=ORDER, refinement=0.5, f_max=0.0)))


def test_orders_of_a_layer_do_not_couple(state: bd.Equilibrium) -> None:
    (layer,) = state.system.layers
    touched = (layer.L != 0.0).astype(float)
    # cosines and sines of each order but 0, which has stretch with the axial motion, and torsion
    assert len(coupled_blocks(touched @ touched.T)) >= 2 * ORDER + 2
    # what H couples by round-off alone would not fall apart
    assert np.count_nonzero(touched) < 0.2 * touched.size


def test_a_factor_of_blocks_is_a_factor() -> None:
    rng = np.random.default_rng(3)
    A = np.zeros((7, 7))
    for at, size, rank in ((0, 4, 2), (4, 3, 3)):
        part = rng.standard_normal((size, rank)) * 10.0 ** rng.uniform(-3, 3, (size, 1))
        A[at : at + size, at : at + size] = part @ part.T
    order = rng.permutation(7)
    A = A[np.ix_(order, order)]
    L = factor(A)
    assert L.shape == (7, 5)
    np.testing.assert_allclose(L @ L.T, A, rtol=1e-12, atol=1e-12 * np.abs(A).max())
    assert sorted(len(b) for b in coupled_blocks((L != 0.0) @ (L != 0.0).T.astype(float))) == [3, 4]


@pytest.mark.parametrize("speed", [300.0, ([0.0, 1.0], [280.0, 320.0])], ids=["steady", "run-up"])
def test_a_march_by_bands_is_the_march_as_one(state: bd.Equilibrium, speed: object) -> None:
    """Columns of the factor turned among one another leave H, and couple all that the layer moves."""
    (layer,) = state.system.layers
    rank = layer.L.shape[1]
    turn = np.linalg.qr(np.random.default_rng(7).standard_normal((rank, rank)))[0]
    as_one = replace(state, system=replace(state.system, layers=(replace(layer, L=layer.L @ turn),)))
    assert max(map(len, as_one.system.blocks())) > 3 * max(map(len, state.system.blocks()))

    def marched(eq: bd.Equilibrium) -> np.ndarray:
        run = bd.transient(eq, speed=speed, dt=5e-6, steps=2000, record=RECORD, progress=False)
        return np.asarray(run["record"].values)

    bands, whole = marched(state), marched(as_one)
    # rounding of 2000 steps through contacts: two turns part by 2e-12
    assert np.all(np.abs(bands - whole) < 1e-9 * np.abs(whole).max(axis=0))


def test_rings_side_by_side_march_to_the_bit(state: bd.Equilibrium) -> None:
    cases = [
        {
            "source": state,
            "initial": {"rotor.centre": [0, 1e-6 * k, 0, 0, 0, 0]},
            "speed": 300.0,
            "dt": 5e-6,
            "steps": 500,
            "record": RECORD,
            "progress": False,
        }
        for k in range(3)
    ]
    for together, case in zip(bd.transients(cases), cases, strict=True):
        alone = bd.transient(**case)
        for name in ("record", "state"):
            assert together[name].values.tobytes() == alone[name].values.tobytes()
