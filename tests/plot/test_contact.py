"""Figures of lubricated contacts show the numbers they are given."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bearingdyn import plot
from bearingdyn.bearing import Lubricant, Walther, ehl
from bearingdyn.bearing.catalogue import bearing

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

BRG, OIL = bearing("6205", clearance=10e-6), Lubricant(Walther.iso_vg(32))
FREQUENCY = np.geomspace(50, 20e3, 40)


@pytest.fixture(autouse=True)
def _close():
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


@pytest.fixture(scope="module")
def looked_up() -> ehl.LubricatedContact:
    return ehl.look_up(BRG.inner_contact, OIL, 100.0, 5.9, 60.0)


def test_maps_reach_from_the_least_film_to_the_highest_pressure() -> None:
    contact = ehl.solve(BRG.inner_contact, OIL, 100.0, 5.9, 60.0, accuracy=0.1)
    b, a = contact.contact.semi_axes(100.0)
    for quantity, least, most in (
        ("film", min(contact.hmin, contact.film.min()) * 1e6, 1.6 * contact.hc * 1e6),
        ("pressure", 0.0, contact.pressure.max() / 1e9),
    ):
        ax = plot.film_map(contact, quantity=quantity)
        ax.figure.canvas.draw()
        assert ax.collections[0].get_clim() == pytest.approx((least, most), rel=1e-12)
        ellipse = ax.lines[0].get_xydata()
        assert np.abs(ellipse).max(axis=0) == pytest.approx([a * 1e6, b * 1e6], rel=1e-3)
        assert quantity.capitalize() in ax.get_title("left")


def test_damping_is_drawn_over_frequency_with_its_viscous_limit(looked_up: ehl.LubricatedContact) -> None:
    ax = plot.contact_damping({"inner": looked_up}, FREQUENCY)
    ax.figure.canvas.draw()
    answer = looked_up.stiffness(FREQUENCY)
    curve, level, dot = ax.lines
    np.testing.assert_allclose(curve.get_ydata(), answer.imag / (2 * math.pi * FREQUENCY), rtol=1e-12)
    assert level.get_ydata()[0] == looked_up.c0
    assert dot.get_xdata()[0] == looked_up.viscous_limit
    # c there is .9 c0; drawn on a line between two of the frequencies
    assert dot.get_ydata()[0] == pytest.approx(0.9 * looked_up.c0, rel=0.01)
    lower = ax.figure.axes[1].lines[0].get_ydata()
    np.testing.assert_allclose(lower, answer.real / looked_up.dry_stiffness, rtol=1e-12)


def test_bad_input_is_named(looked_up: ehl.LubricatedContact) -> None:
    with pytest.raises(ValueError, match=r"contact is .*bearing\.ehl\.solve"):
        plot.film_map(looked_up)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="frequency is "):
        plot.contact_damping({"inner": looked_up}, [100.0, 50.0])
    with pytest.raises(ValueError, match=r"contacts\['a'\] is 3"):
        plot.contact_damping({"a": 3}, FREQUENCY)  # type: ignore[dict-item]
    with pytest.raises(ValueError, match="nothing to draw"):
        plot.contact_damping({}, FREQUENCY)
