"""Modes of like shapes whose frequencies lie an octave apart are not taken for one another."""

from __future__ import annotations

import importlib
import math

import numpy as np
import pytest
import xarray

from bearingdyn.analysis import campbell
from rotors import oscillator

# the function of the same name hides the module
MODULE = importlib.import_module("bearingdyn.analysis.campbell")


def direction(degrees: float) -> np.ndarray:
    """A shape (6,) in the plane x, y of a body of equal masses: its assurance to another is cos² between."""
    angle = math.radians(degrees)
    return np.array([math.cos(angle), math.sin(angle), 0, 0, 0, 0], dtype=complex)


@pytest.mark.parametrize("ratio", [2.0, 4.0])
def test_like_shapes_an_octave_apart_keep_their_frequencies(ratio: float, monkeypatch) -> None:
    """Shapes 20° apart turn by 12° towards each other; by shape alone (cos² 8° > cos² 12°) they swap."""
    low = 2 * math.pi * 100.0
    shapes = {100.0: (0.0, 20.0), 0.0: (12.0, 8.0)}

    def crafted(source, count, *, speed, damped, modulus):
        eigenvalue = 1j * np.array([low, ratio * low]) * (1 + 1e-3 * speed / 100.0)
        shape = np.array([direction(angle) for angle in shapes[speed]])
        return xarray.Dataset({"eigenvalue": ("mode", eigenvalue), "shape": (("mode", "coordinate"), shape)})

    monkeypatch.setattr(MODULE, "modes", crafted)
    found = campbell(oscillator(), [0.0, 100.0], count=2)
    # no mode jumps by an octave between two neighbouring speeds
    np.testing.assert_allclose(found.frequency.values[0], [100.0, ratio * 100.0], rtol=1e-12)
    np.testing.assert_allclose(found.frequency.values[1] / found.frequency.values[0], 1.001, rtol=1e-12)
    assert found.mac.values[0] == pytest.approx(math.cos(math.radians(12)) ** 2, rel=1e-12)


def test_modes_close_in_frequency_are_told_by_their_shapes(monkeypatch) -> None:
    """Two that cross within 1 %, at right angles: each keeps its shape and takes the other's place."""
    low = 2 * math.pi * 100.0

    def crafted(source, count, *, speed, damped, modulus):
        shape = np.array([direction(a) for a in ((0.0, 90.0) if speed else (90.0, 0.0))])
        eigenvalue = 1j * low * np.array([1.0, 1.01])
        return xarray.Dataset({"eigenvalue": ("mode", eigenvalue), "shape": (("mode", "coordinate"), shape)})

    monkeypatch.setattr(MODULE, "modes", crafted)
    found = campbell(oscillator(), [0.0, 100.0], count=2)
    np.testing.assert_allclose(found.frequency.values, [[100.0, 101.0], [101.0, 100.0]], rtol=1e-12)
    np.testing.assert_allclose(found.mac.values[0], 1.0, rtol=1e-12)
