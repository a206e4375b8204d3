"""The table against new solutions between its nodes, and at its nodes."""

from __future__ import annotations

import csv
import math
from importlib import resources

import pytest

from bearingdyn.bearing import ehl


def test_table_gives_its_own_nodes_back() -> None:
    text = resources.files("bearingdyn.bearing.ehl").joinpath("table.csv").read_text(encoding="utf-8")
    for row in list(csv.DictReader(text.splitlines()))[::13]:
        found = ehl.lookup(*(float(row[name]) for name in "MLD"))
        assert found.figures == pytest.approx([float(row[name]) for name in found.figures._fields], rel=1e-9)
        C0 = float(row["C0"])
        assert found.C == pytest.approx([C0 * float(row[f"C_{x:g}"]) for x in ehl.table.OMEGA], rel=1e-9)


@pytest.mark.parametrize(("M", "L", "D"), [(548, 7.5, 0.253), (119, 7.6, 0.02), (474, 6.1, 0.235)])
def test_table_is_within_its_stated_error_of_new_solutions(M: float, L: float, D: float) -> None:
    solved, found = ehl.steady(M, L, D, accuracy=0.02), ehl.lookup(M, L, D).figures
    # what its notes state
    assert found.Hc == pytest.approx(solved.Hc, rel=0.005)
    assert found.H0 == pytest.approx(solved.H0, rel=0.01)
    assert found.Hmin == pytest.approx(solved.Hmin, rel=0.03)
    assert found.K0 == pytest.approx(solved.K0, abs=0.002)
    assert found.C0 == pytest.approx(solved.C0, rel=0.025)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        ((1.0, 10.0, 0.5), r"M is 1.0; the table holds 2\.\.709; use ehl.steady"),
        ((100.0, 25.0, 0.5), r"L is 25.0; the table holds 2.5\.\.20"),
        ((100.0, 10.0, 0.0), r"D is 0.0; the table holds 0.02\.\.1"),
        ((math.nan, 10.0, 0.5), "M is nan"),
    ],
)
def test_outside_of_the_table_is_named(place: tuple[float, float, float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ehl.lookup(*place)
