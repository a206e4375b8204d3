"""Figures over the speed: unbalance, orders, crossings in a Campbell diagram."""

from __future__ import annotations

import math
from collections.abc import Iterator

import matplotlib as mpl
import numpy as np
import pytest
import xarray

mpl.use("Agg")

import matplotlib.pyplot as plt

import bearingdyn as bd
from bearingdyn import plot
from bearingdyn.analysis import (
    envelope_spectrum,
    frequency_response,
    order_spectrum,
    spectrum,
    track_orders,
    unbalance_response,
)
from bearingdyn.results import dataset
from rotors import oscillator

RPM = 30 / math.pi


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    plt.close("all")


def unbalanced() -> xarray.Dataset:
    app = oscillator()  # 2 kg, 40 N s/m, 5e5 N/m: 500 rad/s, 2 % damping
    app.unbalance("body.centre", 1e-5)
    return unbalance_response(app, np.linspace(0.0, 1500.0, 151), ["body.centre.y", "body.centre.θx"])


def run_up() -> xarray.Dataset:
    """Two orders, 3 µm and 1 µm, through 600 to 3000 rpm in two seconds."""
    t = np.arange(40_000) * 5e-5
    angle = (600 * t + 0.5 * 1200 * t**2) / RPM
    made = dataset(
        {"record": (("time", "channel"), (3e-6 * np.cos(angle) + 1e-6 * np.cos(2 * angle))[:, None], "", "")},
        {"dt": 5e-5, "decimate": 1, "speed": np.array([600.0, 3000.0]) / RPM, "speed_time": [0.0, 2.0]},
        {"time": (t, "s"), "channel": (["shaft.mid.y"], "")},
    )
    return made.assign_coords(unit=("channel", ["m"]))


def test_unbalance_response_stands_over_the_speed_with_its_phase() -> None:
    ax = plot.unbalance_response({"bare": unbalanced()}, "body.centre.y")
    upper, lower = ax.figure.axes
    assert upper is ax
    (line,), (phase,) = upper.get_lines(), lower.get_lines()
    speed = np.linspace(0.0, 1500.0, 151)
    r = speed / 500.0
    H = 1e-5 / 2.0 * r**2 / (1 - r**2 + 0.04j * r)  # eccentricity U/m, 2 % damping
    np.testing.assert_allclose(line.get_xdata(), speed * RPM, rtol=1e-12)
    # one solution of a 6 x 6 system: rounding, and at resonance its condition
    np.testing.assert_allclose(line.get_ydata(), np.abs(H), rtol=1e-10)
    # the force in y lags the one in x by 90°; standstill has no phase
    expected = np.degrees(np.unwrap(np.angle(-1j * H[1:])))
    np.testing.assert_allclose(phase.get_ydata(), expected, atol=1e-6)
    np.testing.assert_allclose(phase.get_xdata(), speed[1:] * RPM, rtol=1e-12)
    assert upper.get_ylabel() == "displacement, zero-to-peak, µm"
    assert (lower.get_xlabel(), lower.get_ylabel()) == ("speed, rpm", "phase, °")
    assert upper.get_yscale() == "log"


def test_a_response_goes_to_the_picture_that_is_made_for_it() -> None:
    swept = frequency_response(oscillator(), [10.0, 20.0], ["body.centre.y"], ["body.centre.y"])
    with pytest.raises(ValueError, match=r"draw it with plot\.unbalance_response"):
        plot.frequency_response({"a": unbalanced()}, "body.centre.y", "body.centre.y")
    with pytest.raises(ValueError, match=r"draw it with plot\.frequency_response"):
        plot.unbalance_response({"a": swept}, "body.centre.y")
    with pytest.raises(ValueError, match=r"no output 'body.centre.z'"):
        plot.unbalance_response({"a": unbalanced()}, "body.centre.z")


def test_tracked_orders_stand_over_the_speed() -> None:
    tracked = track_orders(run_up(), "shaft.mid.y", [1.0, 2.0])
    upper, lower = plot.orders(tracked, phase=True).figure.axes
    assert [line.get_label() for line in upper.get_lines()] == ["1×", "2×"]
    for line, amplitude in zip(upper.get_lines(), (3e-6, 1e-6), strict=True):
        np.testing.assert_array_equal(line.get_xdata(), tracked["speed"].values * RPM)
        # track_orders finds a steady order to 1e-3 (its docstring: eight samples a period)
        np.testing.assert_allclose(line.get_ydata(), amplitude, rtol=2e-3)
    # cosines of the angle
    np.testing.assert_allclose(lower.get_lines()[0].get_ydata(), 0.0, atol=1.0)
    assert upper.get_ylabel() == "amplitude, zero-to-peak, µm"
    assert lower.get_xlabel() == "speed, rpm"
    (only,) = plot.orders(tracked, [2.0]).get_lines()
    assert only.get_label() == "2×"
    with pytest.raises(ValueError, match="order 3 was not tracked"):
        plot.orders(tracked, [3.0])
    with pytest.raises(ValueError, match=r"make it with bd\.track_orders"):
        plot.orders(order_spectrum(run_up(), "shaft.mid.y", 4.0))


def test_orders_at_constant_speed_stand_over_time() -> None:
    steady = run_up().assign_attrs(speed=100.0)
    del steady.attrs["speed_time"]
    assert plot.orders(track_orders(steady, "shaft.mid.y", [1.0])).get_xlabel() == "time, s"


def test_order_spectrum_shows_its_numbers_over_orders() -> None:
    found = order_spectrum(run_up(), "shaft.mid.y", 4.0)
    ax = plot.order_spectrum({"run-up": found})
    (line,) = ax.get_lines()
    np.testing.assert_array_equal(line.get_xdata(), found["order"].values[1:])
    np.testing.assert_array_equal(line.get_ydata(), found["amplitude"].values[1:])
    assert ax.get_xlabel() == "order of the shaft speed"
    assert ax.get_ylabel() == "amplitude, zero-to-peak, µm"
    assert ax.get_title(loc="left") == "Order spectrum of shaft.mid.y"
    with pytest.raises(ValueError, match=r"bd\.order_spectrum"):
        plot.order_spectrum({"a": spectrum(run_up(), "shaft.mid.y")})


def test_an_envelope_is_called_an_envelope() -> None:
    band = envelope_spectrum(run_up(), "shaft.mid.y", (10.0, 200.0))
    ax = plot.spectrum({"a": band})
    assert ax.get_title(loc="left") == "Envelope spectrum (10 to 200 Hz) of shaft.mid.y"
    ax = plot.spectrum({"a": spectrum(run_up(), "shaft.mid.y")})
    assert ax.get_title(loc="left") == "Spectrum of shaft.mid.y"


def fan() -> xarray.Dataset:
    """Modes at 50 Hz, 30 Hz + a tenth of the speed, and one that does not swing, over 0 to 6000 rpm."""
    speed = np.linspace(0.0, 6000.0, 7) / RPM
    frequency = np.stack([np.full(7, 50.0), 30.0 + 0.1 * speed * RPM / 60, np.full(7, 20.0)], axis=1)
    eigenvalue = 2j * np.pi * frequency
    eigenvalue[:, 2] = -2 * np.pi * frequency[:, 2]
    return xarray.Dataset(
        {
            "frequency": (("speed", "mode"), frequency),
            "whirl": (("speed", "mode"), np.tile([-1.0, 1.0, 0.0], (7, 1))),
            "eigenvalue": (("speed", "mode"), eigenvalue),
        },
        {"speed": speed},
    )


def rings(ax: object) -> list[mpl.lines.Line2D]:
    return [line for line in ax.get_lines() if line.get_marker() == "o"]  # type: ignore[attr-defined]


def test_crossings_with_an_order_are_ringed_at_their_speed() -> None:
    ax = plot.campbell(fan())
    (ring,) = rings(ax)
    # 50 = n/60, and 30 + 0.1 n/60 = n/60: straight lines, exact but for rounding
    np.testing.assert_allclose(ring.get_xydata(), [[2000.0, 100 / 3], [3000.0, 50.0]], rtol=1e-12)
    assert {"2000", "3000", "1×"} == {text.get_text() for text in ax.texts}


def test_each_order_has_its_crossings_and_no_order_none() -> None:
    (ring,) = rings(plot.campbell(fan(), orders=(1.0, 2.0)))
    # half the speed for 50 Hz at 2×; 30 = 1.9 n/60 for the other
    speeds = sorted(ring.get_xdata())
    np.testing.assert_allclose(speeds, [1800 / 1.9, 1500.0, 2000.0, 3000.0], rtol=1e-12)
    assert not rings(plot.campbell(fan(), orders=()))


def test_a_campbell_diagram_tells_axial_and_torsional_modes_by_name() -> None:
    """A rigid disc on springs: kz, kθz and the lateral ones each give a mode of a known frequency."""
    app = bd.Application()
    app.add("disc", bd.RigidBody(mass=2.0, inertia=(4e-3, 4e-3, 8e-3)))
    app.ground("disc.centre", stiffness=[1e6, 1e6, 4e6, 2e3, 2e3, 500.0])
    data = bd.campbell(app, [0.0, 100.0], 6)
    told = dict(zip(data["direction"].values, data["frequency"].values[0], strict=True))
    assert told["axial"] == pytest.approx(math.sqrt(4e6 / 2.0) / 2 / math.pi, rel=1e-9)
    assert told["torsional"] == pytest.approx(math.sqrt(500.0 / 8e-3) / 2 / math.pi, rel=1e-9)
    assert list(data["direction"].values).count("lateral") == 4
    ax = plot.campbell(data)
    assert {"axial", "torsional"} < {t.get_text() for t in ax.get_legend().get_texts()}
    # the axial mode, along the line that is drawn, has arrows
    found = bd.modes(app)
    axial = int(np.argmin(np.abs(found["frequency"].values - told["axial"])))
    drawn = plot.mode_shape(bd.mode_shapes(app, found), axial)
    assert sum(t.arrow_patch is not None for t in drawn.texts) == 1
    assert "arrows" in drawn.get_xlabel()
