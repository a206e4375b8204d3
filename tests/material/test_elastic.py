"""Elastic materials."""

from __future__ import annotations

import math

import pytest

from bearingdyn.material import STEEL, Elastic


def test_moduli_of_steel():
    """E = 9KG/(3K + G), ν = (3K − 2G)/(6K + 2G): the inverse relations of any textbook."""
    G, K = STEEL.G, STEEL.K
    assert 9 * K * G / (3 * K + G) == pytest.approx(210e9, rel=1e-14)
    assert (3 * K - 2 * G) / (6 * K + 2 * G) == pytest.approx(0.3, rel=1e-14)
    assert STEEL.density == 7850.0


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((0.0, 0.3, 7850.0), r"Elastic.E is 0.0; .*, Pa"),
        ((math.nan, 0.3, 7850.0), r"Elastic.E is nan; .*, Pa"),
        ((210e9, 0.5, 7850.0), r"Elastic.nu is 0.5"),
        ((210e9, -1.0, 7850.0), r"Elastic.nu is -1.0"),
        ((210e9, math.nan, 7850.0), r"Elastic.nu is nan"),
        ((210e9, 0.3, -1.0), r"Elastic.density is -1.0"),
    ],
)
def test_bad_material_is_refused(values, message):
    """A message naming field and value."""
    with pytest.raises(ValueError, match=message):
        Elastic(*values)
