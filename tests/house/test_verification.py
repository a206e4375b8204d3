"""The verification table: its quick families hold, and a wrong number would show."""

from __future__ import annotations

import math

import pytest

import verification
from verified.row import Row

QUICK = [
    "Maxwell model",
    "Lubricant",
    "Hertz contact",
    "Bearings of ISO/TS 16281",
    "Bearing 6202 under preload",
    "Balls with inertia",
    "Paired bearings",
    "Press fits",
    "Rings under opposed loads",
    "Flexible ring, stiff and free",
    "Distorted mesh",
    "Rigid rotor",
    "Weight and a moving ground",
    "Whirl over speed",
    "Ring-down",
    "Sandwich cantilever",
]


@pytest.mark.parametrize("title", QUICK)
def test_family_holds(title):
    rows = verification.FAMILIES[title]()
    assert rows
    for row in rows:
        # each row carries its own tolerance and reason
        assert row.holds, f"{row.case}: {row.computed!r}, not {row.expected!r} within {row.tolerance:g}"
        assert row.reason


@pytest.mark.slow
def test_every_family_holds_and_is_written():
    text, good = verification.report()
    assert good
    assert "exceeded" not in text
    for title in verification.FAMILIES:
        assert f"## {title}" in text


def test_a_wrong_number_does_not_hold():
    row = Row("case", "source", 1.0, 1.0 + 2e-3, 1e-3, "reason")
    assert row.error == pytest.approx(2e-3)
    assert not row.holds
    assert not Row("case", "source", 1.0, math.nan, 1e-3, "reason").holds
