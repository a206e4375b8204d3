"""Housings of many bores, interpolated between a few reduced ones on a common basis."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import solid_family

F = [100.0, 1000.0, 3000.0]


def pedestal(bore: float) -> bd.Housing:
    return bd.Housing(
        width=0.16, height=0.2, length=0.03, bore_diameter=bore, bore_height=0.12,
        damping=0.01, f_max=8e3, element_size=0.022,
    )  # fmt: skip


def coarse(bore: float) -> bd.Housing:
    return bd.Housing(0.16, 0.2, 0.03, bore, f_max=4e3, element_size=0.05)


@pytest.fixture(scope="module")
def family():
    return solid_family(pedestal, 0.074, 0.080, frequency=F)


def test_a_member_is_as_good_as_one_reduced_anew(family):
    for bore in (0.0745, 0.0772, 0.0794):
        plain = pedestal(bore).body
        anew = bd.reduction_error(plain.full_model(), plain.basis(), F, damping=0.01, held="feet", exact=True)
        member = family.error(bore, F, exact=True)
        # of the interpolation: 1e-4, which the next test makes smaller; above some hundred Hz the
        # reductions' own errors are 1e-4 to 1e-3, and alike
        assert np.abs(member.error - anew.error).max() < 1e-4
        assert member.error[1:] == pytest.approx(anew.error[1:], rel=0.15)


def test_what_interpolation_leaves_falls_with_the_cube_of_the_range(family):
    """Three samples: half the range leaves an eighth."""
    near = solid_family(pedestal, 0.0755, 0.0785, frequency=[100.0])
    # at a sixth of the way, where the polynomial's remainder is largest, statically but for 1e-6
    wide, narrow = (fam.error(low + far, [100.0], exact=True).worst
                    for fam, low, far in ((family, 0.074, 0.001), (near, 0.0755, 0.0005)))  # fmt: skip
    assert 5 < wide / narrow < 12


def test_a_member_answers_as_the_one_reduced_anew(family):
    bore = 0.0762
    found = []
    for housing in (family(bore), pedestal(bore).superelement()):
        app = bd.Application()
        app.add("housing", housing)
        app.ground("housing.feet")
        app.free("housing.bore")
        frf = bd.frequency_response(app, [50.0, 500.0, 1500.0], ["housing.bore.y"], ["housing.top.y"])
        found.append(frf["response"].values.ravel())
    # two reductions of one body, each within 1e-4 of it there
    assert found[0] == pytest.approx(found[1], rel=2e-4)


def test_the_guard_judges_the_interpolated_matrices(family):
    """Matrices of another member in the place of the interpolated ones are found out."""
    bore = float(family.places[1])
    wrong = bd.SolidFamily(**{**vars(family), "K": np.roll(family.K, 1, axis=0)})
    assert family.error(bore, F).worst < 5e-3
    assert wrong.error(bore, F).worst > 0.02


def test_it_travels_to_workers_and_fits_its_neighbours(family):
    again = pickle.loads(pickle.dumps(family))
    one, other = family(0.0771), again(0.0771)
    assert np.array_equal(one.K, other.K)
    assert one.faces["bore"][0].radius == pytest.approx(0.0771 / 2, rel=1e-12)


def test_what_is_no_family_is_named(family):
    with pytest.raises(ValueError, match=r"value is 0\.09; it must lie within the family, 0\.074 to 0\.08"):
        family(0.09)
    with pytest.raises(ValueError, match="another mesh"):
        solid_family(pedestal, 0.06, 0.10, frequency=F)
    with pytest.raises(ValueError, match="still errs by"):
        solid_family(coarse, 0.0771, 0.0772, frequency=[3000.0], tolerance=1e-9)
    with pytest.raises(ValueError, match="high is"):
        solid_family(pedestal, 0.08, 0.07, frequency=F)
    with pytest.raises(ValueError, match=r"must return a bd\.Housing"):
        solid_family(lambda x: x, 0.07, 0.08, frequency=F)
