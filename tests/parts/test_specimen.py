"""Bonded specimens against the formula that their modulus is read by."""

import math

import pytest

import bearingdyn as bd


@pytest.mark.parametrize(("diameter", "thickness"), [(14.000e-3, 1.965e-3), (20.00e-3, 2.200e-3)])
def test_discs_of_the_dma_have_the_published_factor(diameter, thickness):
    """Two specimens of the EPDM measurement: .967 of G A/t for the first; the thinner in shape has more."""
    factor = bd.specimen_factor(thickness, diameter=diameter)
    slenderness = thickness / diameter / (1.965 / 14.0)
    assert 1 - factor == pytest.approx(0.033 * slenderness, rel=0.05)


def test_a_bonded_disc_lies_between_a_beam_and_pure_shear():
    """Simple shear bounds from above, the stresses of a clamped beam (E = 3G) from below."""
    t, D = 6e-3, 33.5e-3
    nu = 0.5
    kappa = 6 * (1 + nu) / (7 + 6 * nu)  # Cowper, a full circle
    area, inertia = math.pi * D**2 / 4, math.pi * D**4 / 64
    beam = 1 / (1 / kappa + t**2 * area / (12 * 3 * inertia))
    assert beam < bd.specimen_factor(t, diameter=D) < 1.0


def test_a_square_block_and_a_disc_of_its_area_are_much_alike():
    t, a = 2e-3, 12e-3
    block = bd.specimen_factor(t, section=(a, a))
    disc = bd.specimen_factor(t, diameter=2 * a / math.sqrt(math.pi))
    assert block == pytest.approx(disc, abs=0.01)
    # sheared along its long side it has less free edge across
    assert bd.specimen_factor(t, section=(20e-3, 8e-3)) > bd.specimen_factor(t, section=(8e-3, 20e-3))


def test_a_thin_bonded_disc_in_tension_is_as_stiff_as_its_shape_factor_says():
    """Incompressible, thin: E_c = E (1 + 2 S²) − small; S = D/4t (Gent and Lindley 1959), K large."""
    t, D = 1e-3, 20e-3
    S = D / 4 / t
    ratio = bd.specimen_factor(t, diameter=D, mode="tension", G=1e5, K=1e10)
    assert ratio == pytest.approx(1 + 2 * S**2, rel=0.06)  # free edges: the approximation's own


@pytest.mark.parametrize(
    ("D", "bore", "t"),
    [(2e-3, 0.0, 20e-3), (10e-3, 8e-3, 40e-3)],
)
def test_a_slender_specimen_in_tension_is_pulled_by_its_area_and_E(D, bore, t):
    """The ends hold it over a length of its width: 1 to 2.5 %. At G = K/5 E is 6 % less than 3 G."""
    factor = bd.specimen_factor(t, diameter=D, bore=bore, mode="tension", G=1e6, K=5e6)
    assert 1.0 < factor < 1.03


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"thickness": 0.0, "diameter": 1e-2}, r"thickness is 0\.0"),
        ({"thickness": 1e-3}, r"give either diameter or section"),
        ({"thickness": 1e-3, "diameter": 1e-2, "section": (1e-2, 1e-2)}, r"give either diameter or section"),
        ({"thickness": 1e-3, "diameter": 1e-2, "bore": 1e-2}, r"bore is 0\.01"),
        ({"thickness": 1e-3, "section": (1e-2, -1.0)}, r"section\[1\] is -1"),
        ({"thickness": 1e-3, "diameter": 1e-2, "mode": "torsion"}, r"mode is 'torsion'"),
    ],
)
def test_specimens_that_cannot_be_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        bd.specimen_factor(**given)
