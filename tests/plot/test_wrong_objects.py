"""Every figure given what it cannot draw refuses it by the argument's name, before anything is drawn."""

from __future__ import annotations

import inspect
import warnings

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import plot
from bearingdyn.bearing import Lubricant, Pair, Walther, ehl, load_distribution

BALL = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=10e-6)
RUBBER = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
STRAIN = np.geomspace(1e-3, 2e-2, 12)
LAW = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
SWEEP = bd.StrainSweep(STRAIN, 3e6 + LAW.storage(STRAIN), 3e5 + LAW.loss(STRAIN), 10.0)


@pytest.fixture(scope="module")
def good() -> dict[str, dict[str, object]]:
    """What each figure can draw, by its arguments without a default."""
    app = bd.Application()
    app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.ground("r.centre", stiffness=[1e6] * 6, damping=[10.0] * 6)
    app.unbalance("r.centre", 1e-5)
    eq = bd.equilibrium(app)
    found = bd.modes(eq)
    run = bd.transient(
        eq, speed=([0.0, 0.1], [1e3, 5e3]), dt=2e-5, steps=5000, record=["r.centre.x", "r.centre.y"]
    )
    frequency, dma = [10.0, 20.0], bd.read_dma(bd.sample_dma_path())
    curve, y = bd.master_curve(dma), "r.centre.y"
    oil = Lubricant(Walther.iso_vg(32))
    study = xarray.Dataset({"m": ("case", [1.0, 2.0]), "n": ("case", [2.0, 1.0])})
    ball = bd.catalogue.bearing("6305", clearance=10e-6)
    ring = bd.FlexibleRing.of(ball, outside=bd.RingBed(1e11), f_max=0.0)
    plate = bd.Application()
    plate.add("plate", bd.Housing(0.1, 0.1, 0.03, 0.04, f_max=0.0).superelement())
    plate.ground("plate.feet")
    plate.free("plate.bore")
    heard = (plate, 500.0, "plate.bore.y", ["plate.outside"])
    solved = ehl.solve(BALL.inner_contact, oil, 100.0, 5.9, 60.0, accuracy=0.1)
    steady = xarray.Dataset(
        {
            "peak_to_peak": (("point", "channel"), [[1e-6], [2e-6]]), "stable": ("point", [1, 0]),
            "branch": ("point", [0, 0]), "passages": ("point", [1, 1]), "event": ("point", ["", "fold"]),
            "amplitude": (("point", "channel", "order"), np.full((2, 1, 3), 1e-6 + 0j)),
            "passage_frequency": ("point", [50.0, 60.0]), "speed": ("point", [100.0, 120.0]),
        },
        {"channel": [y], "order": [0.0, 1.0, 2.0], "unit": ("channel", ["m"])},
    )  # fmt: skip
    return {
        "as_html": {"thing": BALL},
        "ball_loads": {"loads": np.arange(9.0)},
        "bearing_spectrum": {"datasets": {"a": bd.spectrum(run, y)}, "bearing": BALL, "speed": 10.0},
        "bearing_stiffness": {
            "bearings": {"a": BALL}, "direction": (0, -1.0, 0, 0, 0, 0), "loads": [9.0, 99.0],
        },
        "campbell": {"data": bd.campbell(eq, [0.0, 10.0], 3)},
        "causality": {"dma": dma},
        "contact_damping": {"contacts": {"a": solved}, "frequency": frequency},
        "draw": {"app": app},
        "cole_cole": {"data": dma},
        "film": {
            "bearing": BALL, "lubricant": oil, "temperatures": [40.0, 60.0], "speeds": [100.0, 200.0],
            "load": (0, -400.0, 0, 0, 0, 0),
        },
        "film_map": {"contact": solved},
        "frequency_response": {
            "datasets": bd.frequency_response(eq, frequency, [y], [y]),
        },
        "isotherms": {"dma": dma},
        "layer_stiffness": {"layers": {"a": bd.Layer(0.02, 0.024, 0.015, RUBBER)}, "frequency": frequency},
        "layer_strain": {
            "layer": bd.Layer(0.02, 0.024, 0.015, RUBBER, refinement=0.5), "relative": (1e-5, 0, 0, 0, 0, 0),
        },
        "load_distribution": {"distributions": {"a": load_distribution(BALL, (0, -2e-5, 0, 0, 0, 0))}},
        "master": {"curve": curve},
        "mode_geometry": {"source": eq, "found": found, "mode": 0},
        "mode_shape": {"data": bd.mode_shapes(eq, found), "mode": 0},
        "orbit": {"datasets": {"a": bd.orbit(run, "r.centre.x", y)}},
        "order_spectrum": {"datasets": {"a": bd.order_spectrum(run, y, 5.0)}},
        "orders": {"data": bd.track_orders(run, y, [1.0])},
        "ring_shape": {"bearing": bd.FlexibleBearing(ball, ring), "load": (0, -300.0, 0, 0, 0, 0)},
        "scene": {"app": app},
        "shifts": {"curve": curve},
        "sound_contributions": {"data": bd.sound_contributions(*heard, element_size=0.02)},
        "sound_intensity": {"data": bd.sound_intensity(*heard, element_size=0.02)},
        "spectrum": {"datasets": {"a": bd.spectrum(run, y)}},
        "spectrum_of": {"materials": {"a": RUBBER}},
        "speed_map": {"data": steady},
        "speed_waterfall": {"data": steady},
        "strain_softening": {"law": bd.fit_payne(SWEEP, strain_of_isotherms=1.5e-3, lowest_trusted=1e-3)},
        "time": {"datasets": {"a": run}},
        "trade_off": {"study": study, "x": "m", "y": "n"},
        "unbalance_response": {"datasets": {"a": bd.unbalance_response(app, [10.0, 20.0], [y])}},
        "van_gurp_palmen": {"data": dma},
        "waterfall": {"data": bd.waterfall(run, y, length=0.01)},
    }  # fmt: skip


UNASKED = {"mode_scene", "squeezed_section", "squeezed_solid"}


def wrong(good: dict[str, dict[str, object]]) -> list[object]:
    return [
        5, "6205", None, [], {}, {"a": 5}, {5: 5}, np.zeros(3), np.nan, object(), BALL, RUBBER, bd.Layer,
        Pair(bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, contact_angle=0.3), "DB", distance=0.015),
        good["mode_geometry"]["source"], good["frequency_response"]["datasets"], good["trade_off"]["study"],
    ]  # fmt: skip


def test_each_figure_is_asked(good: dict[str, dict[str, object]]) -> None:
    """But mode_scene, which needs pyvista, and the two whose part takes long to squeeze."""
    assert {*good} == {*plot.__all__} - UNASKED
    for given in wrong(good):
        for draw in (plot.squeezed_section, plot.squeezed_solid):
            with pytest.raises(ValueError, match="squeezed is "):
                draw(given)


@pytest.mark.parametrize("name", sorted({*plot.__all__} - UNASKED))
def test_a_wrong_object_is_refused_by_name(name: str, good: dict[str, dict[str, object]]) -> None:
    """Or drawn, where it means something: no AttributeError, KeyError and their like from within."""
    draw, right = getattr(plot, name), good[name]
    parameters = inspect.signature(draw).parameters
    assert {k for k, p in parameters.items() if p.default is p.empty} == {*right}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for key in parameters:
            for given in wrong(good):
                try:
                    draw(**{**right, key: given})
                except ValueError as error:
                    told = str(error)
                    # a channel, column or order that is not there is named as such, and an empty list
                    named = (key, "'6205'", "order 5", "nothing to draw", "no part has a surface to draw")
                    assert any(word in told for word in named), (key, given, error)  # noqa: PT017
                finally:
                    plt.close("all")
