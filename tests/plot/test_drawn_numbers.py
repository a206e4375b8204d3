"""Figures draw the numbers they claim: moduli in tension of a stiff model, and motion with its sign."""

from __future__ import annotations

from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")

import bearingdyn as bd
from bearingdyn import plot
from bearingdyn.material import Maxwell, master_curve, read_dma, sample_dma_path
from bearingdyn.results import dataset


@pytest.fixture(autouse=True)
def _closed():
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


# G near K/2, as plastics are: E = 9KG/(3K + G) is 3G/(1 + G/3K) = 2.6 G, 14 % below 3G
STIFF = Maxwell(0.8e9, [0.2e9, 0.2e9], [1e-2, 1e-3], K=2e9, density=1200.0)


@pytest.fixture(scope="module")
def tension():
    return replace(master_curve(read_dma(sample_dma_path())), mode="tension")


def young(G: np.ndarray) -> np.ndarray:
    return 9 * 2e9 * G / (3 * 2e9 + G)


def lines(ax):
    return [line for line in ax.get_lines() if len(line.get_xdata()) > 2]


def test_a_stiff_model_is_drawn_in_tension_by_youngs_modulus_on_the_master_curve(tension):
    upper, lower = (a for a in plot.master(tension, STIFF).figure.axes[:2])
    f, y = lines(upper)[0].get_data()
    E = young(STIFF.complex_modulus(2 * np.pi * np.asarray(f)))
    # rounding
    np.testing.assert_allclose(y, E.real / 1e6, rtol=1e-12)
    np.testing.assert_allclose(lines(lower)[0].get_ydata(), E.imag / E.real, rtol=1e-12)


def test_a_stiff_model_is_drawn_in_tension_by_youngs_modulus_in_both_diagrams(tension):
    """Points (E′, E″) and (|E|, δ) of the drawn line are the model's at one frequency each."""
    f = np.geomspace(tension.frequency.min(), tension.frequency.max(), 300)
    E = young(STIFF.complex_modulus(2 * np.pi * f))
    storage, loss = (lines(plot.cole_cole(tension, STIFF))[-1].get_data()[k] for k in (0, 1))
    np.testing.assert_allclose(storage, E.real / 1e6, rtol=1e-9)
    np.testing.assert_allclose(loss, E.imag / 1e6, rtol=1e-9)
    size, phase = (lines(plot.van_gurp_palmen(tension, STIFF))[-1].get_data()[k] for k in (0, 1))
    np.testing.assert_allclose(size, np.abs(E) / 1e6, rtol=1e-9)
    np.testing.assert_allclose(phase, np.degrees(np.angle(E)), rtol=1e-9)


# ---------------------------------------------------------------- modes seen from the side


def mode(*motions):
    """A shaft of three places along z whose motion is given (place, xyz)."""
    motion = np.zeros((1, 3, 6), dtype=complex)
    motion[0, :, :3] = motions
    position = np.array([[0, 0, 0], [0, 0, 0.1], [0, 0, 0.2]])
    names = ["shaft.a", "shaft.b", "shaft.c"]
    return dataset(
        {
            "motion": (("mode", "place", "component"), motion, "m, rad", ""),
            "position": (("place", "axis"), position, "m", ""),
            "frequency": ("mode", [100.0], "Hz", ""),
        },
        {},
        {
            "place": (names, ""),
            "component": (["x", "y", "z", "θx", "θy", "θz"], ""),
            "axis": (list("xyz"), ""),
        },
    )


def outlines(ax):
    """(z, height), mm, of the structure at rest, of the mode, and of the mode a quarter period later."""
    return [np.array(line.get_data()) for line in ax.get_lines()]


@pytest.mark.parametrize("axis", ["x", "y"])
@pytest.mark.parametrize("sign", [1, -1])
def test_motion_along_the_shaft_is_drawn_to_the_side_it_goes(axis, sign):
    """The largest motion is drawn positive, a tenth of 200 mm; the motion along z in its proportion."""
    side = [0.0, 0.0, 0.5 * sign]
    side["xyz".index(axis)] = 1.0
    rest, drawn, later = outlines(plot.mode_shape(mode([0, 0, 0], side, [0, 0, 0]), 0, axis=axis))
    np.testing.assert_allclose(rest, [[0, 100, 200], [0, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(drawn[0], [0, 100 + 10 * sign, 200], rtol=1e-12)
    np.testing.assert_allclose(drawn[1], [0, 20, 0], atol=1e-12)
    # undamped: a quarter period later everything passes its rest
    np.testing.assert_allclose(later, rest, atol=1e-12)


def test_a_mode_along_the_shaft_alone_moves_its_outline_to_positive_z():
    rest, drawn, _ = outlines(plot.mode_shape(mode([0, 0, 1], [0, 0, 1], [0, 0, 0.5]), 0))
    np.testing.assert_allclose(drawn[0] - rest[0], [20, 20, 10], rtol=1e-12)
    np.testing.assert_array_equal(drawn[1], rest[1])


def test_what_a_damped_mode_does_a_quarter_period_later_is_drawn_thin():
    """Re(u e^{iφ}) at φ = π/2 later is Re(−i u)… of a mode i ahead at b: there +1, at rest at a."""
    _, drawn, later = outlines(plot.mode_shape(mode([0, 1, 0], [0, 0.5j, 0], [0, 0, 0.25j]), 0))
    np.testing.assert_allclose(drawn[1], [20, 0, 0], atol=1e-12)
    np.testing.assert_allclose(later[1], [0, 10, 0], atol=1e-12)
    np.testing.assert_allclose(later[0], [0, 100, 205], rtol=1e-12)


def test_decibels_are_levels_over_the_references_of_iso_1683() -> None:
    app = bd.Application()
    app.add("m", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.ground("m.centre", stiffness=[1e6] * 6)
    for quantity, static, said in (("displacement", 120.0, "1 pm"), ("velocity", None, "1 nm/s")):
        found = bd.frequency_response(app, [1e-3, 10.0], ["m.centre.y"], ["m.centre.y"], quantity=quantity)
        ax = bd.plot.frequency_response(found, "m.centre.y", "m.centre.y", decibels=True)
        drawn = ax.lines[0].get_ydata()
        assert f"dB re {said}" in ax.get_ylabel()
        assert ax.get_yscale() == "linear"
        if static is not None:
            assert drawn[0] == pytest.approx(static, abs=1e-6)  # 1 N on 1 N/µm is 1 µm: 10⁶ pm
        else:
            omega = 2 * np.pi * 10.0
            assert drawn[1] == pytest.approx(20 * np.log10(omega / (1e6 - 2.0 * omega**2) / 1e-9), abs=1e-6)
