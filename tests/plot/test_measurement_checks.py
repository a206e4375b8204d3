"""Figures: every curve is there with the numbers it was given, and every axis says its quantity and unit."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")

import matplotlib.pyplot as plt

from bearingdyn import plot
from bearingdyn.analysis import BearingState, orbit, spectrum
from bearingdyn.material import Maxwell, fit_maxwell, master_curve, read_dma, sample_dma_path
from bearingdyn.parts import Layer
from bearingdyn.results import dataset


@pytest.fixture(autouse=True)
def _closed():
    before = dict(mpl.rcParams)
    yield
    plt.close("all")
    assert dict(mpl.rcParams) == before, "a figure changed matplotlib's settings"


@pytest.fixture(scope="module")
def dma():
    return read_dma(sample_dma_path())


@pytest.fixture(scope="module")
def curve(dma):
    return master_curve(dma)


@pytest.fixture(scope="module")
def maxwell(curve):
    return fit_maxwell(curve, n=3, band=(10.0, 1e3), K=2e9, density=1200.0)


def response(scale=1.0, quantity="displacement"):
    """One mass on a spring with 2 % damping, resonance at 100 Hz."""
    f = np.geomspace(10.0, 1000.0, 200)
    r = f / 100.0
    H = scale * 1e-7 / (1 - r**2 + 0.04j * r)
    names = {"output": (["shaft.end.y", "shaft.end.θx"], ""), "input": (["shaft.mid.y"], "")}
    values = np.stack([H, 10 * H], axis=1)[:, :, None]
    return dataset(
        {"response": (("frequency", "output", "input"), values, "m/N", "complex")},
        {"quantity": quantity},
        {"frequency": (f, "Hz"), **names},
    )


def march(amplitude=1e-6):
    """A record of 0.1 s: a circle at 107.4 Hz about (3, −40) µm, and a velocity."""
    t = np.arange(4000) * 2.5e-5
    w = 2 * np.pi * 107.4
    rows = [
        3e-6 + amplitude * np.cos(w * t),
        -40e-6 + amplitude * np.sin(w * t),
        w * amplitude * np.cos(w * t),
    ]
    names = ["shaft.end.x", "shaft.end.y", "shaft.end.y.velocity"]
    data = dataset(
        {"record": (("time", "channel"), np.stack(rows, axis=1), "", "record")},
        {"dt": 2.5e-5, "decimate": 1},
        {"time": (t, "s"), "channel": (names, "")},
    )
    return data.assign_coords(unit=("channel", ["m", "m", "m/s"]))


def panels(ax):
    """All axes of the figure that hold curves, from above."""
    return [a for a in ax.figure.axes if a.get_label() != "<colorbar>"]


def curves(ax):
    return [line for line in ax.get_lines() if len(line.get_xdata()) > 2]


def texts_apart(ax):
    """Whether no two names of lines, nor title and legend, lie on one another once drawn."""
    ax.figure.canvas.draw()
    boxes = [t.get_window_extent() for t in ax.texts] + [
        ax.title.get_window_extent(),
        ax._left_title.get_window_extent(),
    ]
    if ax.get_legend():
        boxes.append(ax.get_legend().get_window_extent())
    boxes = [b for b in boxes if b.width > 1]
    # a third of a pixel of padding may touch
    return not any(
        min(a.x1, b.x1) - max(a.x0, b.x0) > 0.4 and min(a.y1, b.y1) - max(a.y0, b.y0) > 0.4
        for i, a in enumerate(boxes)
        for b in boxes[i + 1 :]
    )


def test_isotherms_show_every_sweep_in_modulus_and_loss_factor(dma):
    upper, lower = panels(plot.isotherms(dma))
    assert len(curves(upper)) == len(curves(lower)) == len(dma.isotherms)
    coldest = dma.isotherms[0]
    np.testing.assert_allclose(
        curves(upper)[0].get_ydata(), coldest.storage / 1e6, rtol=1e-15
    )  # one division
    np.testing.assert_array_equal(curves(lower)[0].get_ydata(), coldest.tan_delta)
    assert upper.get_ylabel() == "storage modulus G′, MPa"
    assert lower.get_ylabel() == "loss factor tan δ"
    assert lower.get_xlabel() == "frequency, Hz"
    assert [a.get_ylabel() for a in upper.figure.axes if a not in (upper, lower)] == ["temperature, °C"]
    low, high = upper.get_ylim()
    assert low < dma.storage.min() / 1e6 < dma.storage.max() / 1e6 < high


def test_master_curve_shows_all_points_the_model_and_its_band(curve, maxwell):
    ax = plot.master(curve, maxwell)
    upper, lower = panels(ax)
    for panel, values in ((upper, curve.storage / 1e6), (lower, curve.tan_delta)):
        (points,) = [c for c in panel.collections if len(c.get_offsets()) == curve.frequency.size]
        np.testing.assert_allclose(points.get_offsets().data[:, 1], values, rtol=1e-15)
        outside, inside = curves(panel)
        f, y = inside.get_xdata(), np.asarray(inside.get_ydata())
        assert f[np.isfinite(y)].min() >= 10.0
        assert f[np.isfinite(y)].max() <= 1e3
        (band,) = panel.patches
        assert (band.get_x(), band.get_x() + band.get_width()) == pytest.approx((10.0, 1e3), rel=1e-12)
        modulus = maxwell.complex_modulus(2 * np.pi * outside.get_xdata())
        drawn = modulus.real / 1e6 if panel is upper else modulus.imag / modulus.real
        np.testing.assert_allclose(outside.get_ydata(), drawn, rtol=1e-12)  # rounding
    assert lower.get_xlabel() == "reduced frequency at 20 °C, Hz"
    assert "band of the fit, 10 to 1000 Hz" in [t.get_text() for t in upper.get_legend().get_texts()]
    assert texts_apart(upper)


def test_master_curve_without_model_has_points_only(curve):
    assert [len(curves(p)) for p in panels(plot.master(curve))] == [0, 0]


def test_model_in_shear_is_drawn_in_tension_for_a_curve_in_tension(dma):
    """A model's E* = 9KG*/(3K + G*): three times G* for G ≪ K."""
    from dataclasses import replace

    curve = replace(master_curve(dma), mode="tension")
    soft = Maxwell(1e3, [1e3], [1e-3], K=1e12, density=1200.0)
    upper, _ = panels(plot.master(curve, soft))
    f, y = curves(upper)[0].get_data()
    # G/3K ~ 1e-9 is what the factor 3 leaves out
    np.testing.assert_allclose(y, 3 * soft.complex_modulus(2 * np.pi * f).real / 1e6, rtol=1e-8)
    assert upper.get_ylabel() == "storage modulus E′, MPa"


def test_model_at_another_temperature_is_refused(curve, maxwell):
    with pytest.raises(ValueError, match=r"pass maxwell.at\(20.0\)"):
        plot.master(curve, maxwell.at(50.0))


@pytest.mark.parametrize("law", ["wlf", "arrhenius", "free"])
def test_shifts_are_drawn_with_their_law(dma, law):
    curve = master_curve(dma, law=law)
    ax = plot.shifts(curve)
    (points,) = [line for line in ax.get_lines() if line.get_marker() == "o"]
    (drawn,) = [line for line in ax.get_lines() if len(line.get_xdata()) == 200]
    np.testing.assert_array_equal(points.get_ydata(), list(curve.shifts.values()))
    # the same law at the same temperatures
    np.testing.assert_array_equal(drawn.get_ydata(), curve.law.log_shift(drawn.get_xdata()))
    assert ax.get_xlabel() == "temperature, °C"
    assert "decades" in ax.get_ylabel()


def test_response_is_drawn_as_its_magnitude_on_a_log_axis():
    data = {"no layer": response(), "layer": response(0.5)}
    ax = plot.frequency_response(data, "shaft.end.y", "shaft.mid.y")
    assert len(panels(ax)) == 1
    assert [t.get_text() for t in ax.get_legend().get_texts()] == ["no layer", "layer"]
    first, second = curves(ax)
    np.testing.assert_allclose(first.get_ydata(), 2 * np.asarray(second.get_ydata()), rtol=1e-14)  # rounding
    # at resonance 1e-7/0.04; the grid steps by 2.3 %, so |1 − r²| < 0.024 at its nearest point, and
    # 1/√(0.024² + 0.04²) is 14 % below 1/0.04
    assert np.max(first.get_ydata()) == pytest.approx(1e-7 / 0.04, rel=0.15)
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_xlabel() == "frequency, Hz"
    assert ax.get_ylabel() == "displacement, zero-to-peak, m/N"
    assert texts_apart(ax)


def test_phase_goes_on_through_a_resonance_without_a_jump():
    upper, lower = panels(
        plot.frequency_response({"a": response(-1.0)}, "shaft.end.y", "shaft.mid.y", phase=True)
    )
    (line,) = curves(lower)
    phase = np.asarray(line.get_ydata())
    # −1 × (0° → −180°), each end within 0.25° of its limit: tan φ = 0.04 r/(1 − r²) at r = 0.1 and 10
    assert phase[0] == pytest.approx(-180.0, abs=0.25)
    assert phase[-1] == pytest.approx(-360.0, abs=0.25)
    assert (np.diff(phase) < 0).all()
    assert lower.get_ylabel() == "phase, °"
    assert lower.get_xlabel() == "frequency, Hz"
    assert upper.get_xlim() == lower.get_xlim()


@pytest.mark.parametrize(
    ("quantity", "output", "unit"),
    [
        ("displacement", "shaft.end.θx", "rad/N"),
        ("velocity", "shaft.end.y", "(m/s)/N"),
        ("acceleration", "shaft.end.θx", "(rad/s²)/N"),
    ],
)
def test_unit_of_a_response_follows_from_what_is_asked(quantity, output, unit):
    ax = plot.frequency_response({"a": response(quantity=quantity)}, output, "shaft.mid.y")
    assert ax.get_ylabel() == f"{quantity}, zero-to-peak, {unit}"


@pytest.mark.parametrize(
    ("data", "output", "input", "message"),
    [
        ({}, "shaft.end.y", "shaft.mid.y", "nothing to draw"),
        ({"a": response()}, "shaft.end.z", "shaft.mid.y", "no output .shaft.end.z"),
        ({"a": response()}, "shaft.end.y", "shaft.end.y", "no input .shaft.end.y"),
        ({"a": response(), "b": response(quantity="velocity")}, "shaft.end.y", "shaft.mid.y", "of each"),
    ],
)
def test_response_that_cannot_be_drawn_is_refused(data, output, input, message):
    with pytest.raises(ValueError, match=message):
        plot.frequency_response(data, output, input)


def test_orbit_is_in_micrometres_to_one_scale():
    orbits = {"small": march(1e-6), "large": march(2e-6)}
    ax = plot.orbit({k: orbit(v, "shaft.end.x", "shaft.end.y") for k, v in orbits.items()})
    small, large = curves(ax)
    # a circle of 372 samples a turn: its extremes are missed by 1 − cos(π/372) = 4e-5
    assert np.ptp(small.get_xdata()) == pytest.approx(2.0, rel=1e-4)
    assert np.ptp(large.get_ydata()) == pytest.approx(4.0, rel=1e-4)
    assert small.get_zorder() > large.get_zorder()
    assert ax.get_aspect() == 1.0
    assert ax.get_xlabel() == "shaft.end.x about its mean, µm"
    assert ax.get_ylabel() == "shaft.end.y about its mean, µm"
    assert ax.get_title(loc="left") == "Orbits about their means"
    ax.figure.canvas.draw()
    box = ax.get_window_extent()
    # equal scales, in pixels
    assert box.width / np.ptp(ax.get_xlim()) == pytest.approx(box.height / np.ptp(ax.get_ylim()), rel=1e-6)


def test_spectrum_marks_the_lines_inside_and_their_names_do_not_touch():
    data = {
        "a": spectrum(march(), "shaft.end.y.velocity"),
        "b": spectrum(march(2e-6), "shaft.end.y.velocity"),
    }
    lines = {"FTF": 32.1, "BPFO": 107.4, "2 BPFO": 214.8, "BSF": 220.0, "2× shaft": 225.0, "far": 5000.0}
    ax = plot.spectrum(data, lines, f_max=1000.0)
    assert len(curves(ax)) == 2
    marked = {line.get_xdata()[0] for line in ax.get_lines() if len(line.get_xdata()) == 2}
    assert marked == {f for f in lines.values() if f < 1000.0}
    assert {t.get_text() for t in ax.texts} == set(lines) - {"far"}
    assert ax.get_xlim() == (0.0, 1000.0)
    assert ax.get_xlabel() == "frequency, Hz"
    assert ax.get_ylabel() == "amplitude, zero-to-peak, mm/s"
    assert texts_apart(ax)


@pytest.mark.parametrize("f_max", [0.0, -1.0, float("nan")])
def test_spectrum_to_no_frequency_is_refused(f_max):
    with pytest.raises(ValueError, match="f_max"):
        plot.spectrum({"a": spectrum(march(), "shaft.end.y")}, f_max=f_max)


def test_spectra_in_different_units_are_refused():
    data = {"a": spectrum(march(), "shaft.end.y"), "b": spectrum(march(), "shaft.end.y.velocity")}
    with pytest.raises(ValueError, match="one of each"):
        plot.spectrum(data)


def test_silence_can_be_drawn():
    ax = plot.spectrum({"a": spectrum(march(0.0), "shaft.end.y.velocity")}, {"BPFO": 107.4})
    ax.figure.canvas.draw()


def test_ball_loads_stand_at_the_azimuth_of_each_ball():
    loads = np.array([0.0, 0.0, 0.0, 0.0, 10.0, 500.0, 800.0, 480.0])
    state = BearingState(np.zeros(5), np.zeros(5), np.eye(5), np.eye(5), loads)
    for given in (loads, state):
        ax = plot.ball_loads(given, angle=0.1)
        bars = ax.patches
        assert [b.get_height() for b in bars] == loads.tolist()
        middles = [b.get_x() + b.get_width() / 2 for b in bars]
        assert middles == pytest.approx(0.1 + 2 * np.pi * np.arange(8) / 8, rel=1e-12)
        assert ax.get_ylabel() == "ball load, N"
        assert ax.get_xlabel() == "ball number at its azimuth; 4 of 8 loaded"


def test_ball_loads_need_polar_axes_and_finite_numbers():
    with pytest.raises(ValueError, match="polar"):
        plot.ball_loads([1.0, 2.0], plt.subplots()[1])
    with pytest.raises(ValueError, match="one finite load per ball"):
        plot.ball_loads([1.0, float("nan")])


def test_layer_stiffness_is_that_of_the_layer():
    rubber = Maxwell(1e6, [2e6], [1e-4], K=2e9, density=1200.0)
    layer = Layer(0.026, 0.028, 0.016, rubber, refinement=0.5)
    ax = plot.layer_stiffness({"2 mm": layer}, [10.0, 100.0, 1000.0])
    radial, axial = curves(ax)
    at = np.abs(layer.stiffness(2 * np.pi * 100.0))
    assert (radial.get_ydata()[1], axial.get_ydata()[1]) == (at[0, 0], at[2, 2])
    assert ax.get_xlabel() == "frequency, Hz"
    assert ax.get_ylabel() == "dynamic stiffness |k|, N/m"
    with pytest.raises(ValueError, match="positive"):
        plot.layer_stiffness({"2 mm": layer}, [0.0, 1.0])


def test_figures_go_into_the_axes_given(dma, curve):
    figure, axes = plt.subplots(2, 2)
    assert plot.isotherms(dma, axes[0, 0]) is axes[0, 0]
    assert plot.shifts(curve, axes[0, 1]) is axes[0, 1]
    free = figure.add_axes((0.1, 0.1, 0.3, 0.3))  # no place in a grid
    data = {"a": response()}
    assert plot.frequency_response(data, "shaft.end.y", "shaft.mid.y", free, phase=True) is free
    lower = figure.axes[-1]
    assert lower.get_position().y0 == pytest.approx(0.1)
    assert lower.get_position().y1 < free.get_position().y0 < free.get_position().y1 == pytest.approx(0.4)
    assert len(plt.get_fignums()) == 1
