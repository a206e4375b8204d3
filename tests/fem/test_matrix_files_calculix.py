"""Beside CalculiX, where it is installed: the same mesh has the same modes, and its files are read."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("skfem")

import peers_fem

import bearingdyn as bd
from bearingdyn.fem import FEMatrices, read_matrices

pytestmark = pytest.mark.skipif(peers_fem.ccx() is None, reason=peers_fem.ABSENT)


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> peers_fem.HousingCase:
    """The demo's housing in a coarse mesh."""
    return peers_fem.HousingCase(tmp_path_factory.mktemp("ccx"), size=0.03)


@pytest.fixture(scope="module")
def stored(case: peers_fem.HousingCase) -> FEMatrices:
    return case.stored()


def test_modes_of_the_housing_are_those_of_calculix(case):
    # seven digits are printed
    np.testing.assert_allclose(case.ours(), case.theirs(rigid_bore=False), rtol=1e-6)


def test_matrices_that_calculix_stored_have_its_modes(case, stored):
    np.testing.assert_allclose(case.read_back(stored), case.theirs(rigid_bore=False), rtol=1e-6)


def test_the_superelement_of_the_housing_has_the_modes_calculix_finds_with_a_rigid_bore(case, stored):
    expected = case.theirs(rigid_bore=True)
    drawn = peers_fem.held(replace(case.part, f_max=40e3).superelement())
    imported = peers_fem.held(case.imported(stored, 40e3).superelement())
    # modes are kept to four times the highest of these: truncation leaves some 0.1 %, always stiffer
    for found in (drawn, imported):
        np.testing.assert_allclose(found, expected, rtol=2e-3)
        assert np.all(found > expected * (1 - 1e-6))


def test_a_model_calculix_stored_with_its_supports_is_refused_as_a_free_body(case):
    lines = [
        *case.model,
        "*BOUNDARY",
        "BASE,1,3",
        "*STEP",
        "*FREQUENCY,SOLVER=MATRIXSTORAGE",
        "1",
        "*END STEP",
    ]
    path = peers_fem.run(case.folder, "supported", lines)
    with pytest.raises(ValueError, match="export the model without supports"):
        read_matrices(path.with_suffix(".sti"), points=path.with_suffix(".inp"))


def test_a_bonded_layer_is_as_stiff_as_in_calculix(tmp_path):
    nu = 0.499
    material = bd.Elastic(2e6 * (1 + nu), nu, 1200.0)
    size = (17.5e-3, 20e-3, 11e-3)
    found = peers_fem.layer_by_calculix(
        tmp_path, size, material, (8, 6, 12), 2.0, motions=("axial", "torsion")
    )
    ours = np.diag(bd.Layer(*size, material).stiffness().real)
    # displacement elements are stiffer, here by 0.1 %; torsion is smooth, and what is left are the arcs
    assert 0.0 < found["axial"] / ours[2] - 1.0 < 2e-3
    assert found["torsion"] == pytest.approx(ours[5], rel=1e-5)
