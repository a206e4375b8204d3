"""A figure of one result needs no label, and no channel where there is one."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import plot


@pytest.fixture(scope="module")
def rotor() -> bd.Application:
    """A shaft between two springs, with an unbalance."""
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(0.2, 0.01)], seats={"a": 0.0, "b": 0.2}, points={"mid": 0.1}))
    for place in ("shaft.a", "shaft.b"):
        app.ground(place, [1e7, 1e7, 1e7, 1e3, 1e3, 1e3])
    app.unbalance("shaft.a", 1e-6)
    return app


@pytest.fixture(scope="module")
def run(rotor: bd.Application) -> xarray.Dataset:
    """A short march with one channel."""
    return bd.transient(rotor, speed=100.0, dt=1e-4, steps=400, record=["shaft.mid.x"])


def drawn(ax: Any) -> Any:
    """The axes, once drawn; without a legend, as nothing has a label."""
    ax.figure.canvas.draw()
    assert ax.get_legend() is None
    plt.close(ax.figure)
    return ax


def test_every_figure_of_results_takes_one(rotor: bd.Application, run: xarray.Dataset) -> None:
    """The trace, spectrum, orders and response of one result are drawn as they are given."""
    response = bd.unbalance_response(rotor, rpm=[600.0, 900.0], outputs=["shaft.mid.x"])
    frf = bd.frequency_response(rotor, [10.0, 20.0, 30.0], outputs=["shaft.mid.x"], inputs=["shaft.a.x"])
    assert plot.time(run).get_title(loc="left") == "shaft.mid.x over time"
    drawn(plot.spectrum(bd.spectrum(run)))
    drawn(plot.unbalance_response(response, phase=False))
    drawn(plot.frequency_response(frf))
    labelled = plot.frequency_response({"soft": frf, "hard": frf})
    assert labelled.get_legend() is not None


def test_an_orbit_is_drawn_alone() -> None:
    """Of a result that holds one orbit."""
    turn = np.linspace(0.0, 2 * np.pi, 50)
    path = xarray.Dataset({"x": ("time", np.cos(turn)), "y": ("time", np.sin(turn))})
    for name in ("x", "y"):
        path[name].attrs.update(long_name=name, units="m")
    drawn(plot.orbit(path))


def test_speeds_may_be_given_as_rpm_alone(rotor: bd.Application) -> None:
    """600 rpm are 20π rad/s, whichever argument says so."""
    asked = ["shaft.mid.x"]
    by_rpm = bd.unbalance_response(rotor, rpm=[600.0], outputs=asked)
    by_speed = bd.unbalance_response(rotor, [600.0 * np.pi / 30], asked)
    assert by_rpm["response"].values == pytest.approx(by_speed["response"].values, rel=1e-12)
    with pytest.raises(ValueError, match="outputs is"):
        bd.unbalance_response(rotor, rpm=[600.0])
    with pytest.raises(ValueError, match=r"speeds is None; give it in rad/s, or rpm="):
        bd.unbalance_response(rotor, outputs=asked)


def test_several_channels_are_listed(rotor: bd.Application) -> None:
    """A choice that is open names itself and what there is to choose from."""
    two = ["shaft.a.x", "shaft.mid.x"]
    frf = bd.frequency_response(rotor, [10.0, 20.0], outputs=two, inputs=["shaft.a.x"])
    run = bd.transient(rotor, speed=100.0, dt=1e-4, steps=40, record=two)
    calls: list[Callable[[], object]] = [lambda: plot.frequency_response(frf), lambda: bd.spectrum(run)]
    for call in calls:
        with pytest.raises(
            ValueError, match=r"is None; it must be one of those .*shaft\.a\.x.*shaft\.mid\.x"
        ):
            call()


def test_a_missing_argument_names_the_figure() -> None:
    """Python's own words for it name no function."""
    with pytest.raises(TypeError, match=r"plot\.spectrum: missing a required argument: 'datasets'"):
        plot.spectrum()  # type: ignore[call-arg]
