"""The layers' modulus at rest: relaxed, instantaneous or G(t), and the warning where data do not reach."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.material import WLF, FractionalZener, TabulatedModulus
from bearingdyn.notice import BeyondData

RUBBER = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e3, 1e-3], K=2e9, density=1150.0, law=WLF(8.0, 120.0, 20.0))
BANDED = replace(RUBBER, band=(10.0, 1e3), low_end=None)  # known to 1/(20π) = 0.016 s
LOAD = 150.0  # N


def ring(rubber: object) -> bd.Layer:
    # shapes at the moduli asked for, so that the reduced layer is the full one there
    return bd.Layer(0.020, 0.024, 0.008, rubber, moduli=(1e6, 1.4e6, 2e6, 4e6), refinement=0.3)  # type: ignore[arg-type]


def loaded(rubber: object = RUBBER) -> bd.Application:
    app = bd.Application()
    app.add("ring", ring(rubber))
    app.free("ring.inner")
    app.ground("ring.outer")
    app.load("ring.inner", (0.0, -LOAD, 0.0, 0.0, 0.0, 0.0))
    return app


def motor(rubber: bd.Maxwell = RUBBER) -> bd.Application:
    app = bd.Application()
    app.add("shaft", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3), rotating=True))
    app.add("ring", bd.Layer(0.0235, 0.0275, 0.014, rubber, refinement=0.3))
    app.ground("ring.outer")
    app.bearing("left", bearing("6204", clearance=10e-6), inner="shaft.centre", outer="ring.inner")
    app.load("shaft.centre", (0.0, -100.0, 50.0, 0.0, 0.0, 0.0))
    return app


@pytest.mark.parametrize("t", [1e-9, 10.0, 1e3, 1e9])
def test_the_sag_after_a_time_is_that_of_an_elastic_ring_of_the_relaxation_modulus(t: float) -> None:
    G = 1e6 + 1e6 * math.exp(-t / 1e3) + 2e6 * math.exp(-t / 1e-3)
    # an elastic material of this G and K, solved in full
    elastic = bd.Elastic(
        E=9 * 2e9 * G / (3 * 2e9 + G), nu=(3 * 2e9 - 2 * G) / (2 * (3 * 2e9 + G)), density=1150.0
    )
    sag = LOAD / ring(elastic).stiffness()[1, 1].real
    eq = bd.equilibrium(loaded(), after=t)
    # four moduli give the reduced ring its shapes; between them it is 1e-4 too stiff
    assert -eq.displacement("ring.inner")[1] == pytest.approx(sag, rel=5e-4)
    assert ring(RUBBER).stiffness(after=t)[1, 1].real == pytest.approx(LOAD / sag, rel=1e-9)
    assert eq.moduli["ring"] == pytest.approx(G, rel=1e-12)


def test_long_after_loading_the_layers_are_relaxed_and_right_after_it_instantaneous() -> None:
    for word, t in (("relaxed", 1e9), ("instantaneous", 1e-12)):
        named = bd.equilibrium(motor(), modulus=word)
        # e^{−1e9/1e3} and 1e-12/1e-3
        assert bd.equilibrium(motor(), after=t).x == pytest.approx(named.x, rel=1e-6, abs=1e-15)


def test_a_warm_layer_relaxes_sooner_by_its_shift() -> None:
    warm = RUBBER.at(40.0)
    aT = 10 ** (-8.0 * 20.0 / 140.0)  # WLF by hand
    sag = [
        bd.equilibrium(loaded(m), after=t).displacement("ring.inner")[1]
        for m, t in ((RUBBER, 500.0), (warm, 500.0 * aT))
    ]
    assert sag[0] == pytest.approx(sag[1], rel=1e-9)


def test_an_elastic_ring_does_not_know_the_time() -> None:
    app = loaded(bd.Elastic(3e6, 0.4995, 1150.0))
    assert (bd.equilibrium(app, after=1.0).x == bd.equilibrium(app).x).all()


@pytest.mark.parametrize(
    "material",
    [
        TabulatedModulus(np.array([1.0, 1e3]), np.array([1e6, 2e6]), np.array([1e5, 5e5]), 2e9, 1150.0),
        FractionalZener(1e6, 1e9, 1e-6, 0.5, 2e9, 1150.0),
    ],
)
def test_a_law_without_a_relaxation_modulus_is_refused_with_the_way_out(material: object) -> None:
    with pytest.raises(ValueError, match="need a Maxwell model"):
        bd.equilibrium(loaded(material), after=1.0)
    with pytest.raises(ValueError, match=r"after= needs a relaxation modulus: take material\.maxwell"):
        ring(material).stiffness(after=1.0)


@pytest.mark.parametrize("after", [0.0, -1.0, math.nan, math.inf, "soon"])
def test_a_time_that_is_none_is_refused(after: object) -> None:
    with pytest.raises(ValueError, match=r"after is .*; it must be a positive and finite time, s"):
        bd.equilibrium(loaded(), after=after)  # type: ignore[arg-type]


def test_a_time_and_a_modulus_together_are_refused() -> None:
    for word in ("relaxed", "instantaneous"):
        with pytest.raises(ValueError, match=rf"modulus is '{word}'; with after=10.0, leave it out"):
            bd.equilibrium(loaded(), modulus=word, after=10.0)
    with pytest.raises(ValueError, match=r"omega is 5.0; with after=1.0"):
        ring(RUBBER).stiffness(5.0, after=1.0)


def test_a_march_starts_relaxed_only() -> None:
    with pytest.raises(
        ValueError, match=r"state after 10 s; a march starts with relaxed layers: .*without after="
    ):
        bd.transient(
            bd.equilibrium(motor(), after=10.0), speed=0.0, dt=1e-6, steps=1, record=["shaft.centre.y"]
        )


def test_a_state_and_what_starts_from_it_say_which_modulus_the_layers_have() -> None:
    eq = bd.equilibrium(motor(), after=10.0)
    assert (eq.modulus, eq.after) == ("after", 10.0)
    assert "layers after 10 s" in repr(eq)
    found = [bd.modes(eq), bd.frequency_response(eq, [50.0], ["shaft.centre.y"], ["shaft.centre.y"])]
    assert [data.attrs["layers"] for data in found] == 2 * ["after 10 s"]
    assert bd.modes(bd.equilibrium(motor())).attrs["layers"] == "relaxed"


def test_the_harmonic_response_has_the_modulus_of_its_frequency_whatever_the_state_had() -> None:
    H = [
        bd.frequency_response(bd.equilibrium(loaded(), after=t), [100.0], ["ring.inner.y"], ["ring.inner.y"])
        for t in (1e-3, 1e6)
    ]
    assert (H[0]["response"].values == H[1]["response"].values).all()


SOURCES: dict[str, Callable[[bd.Maxwell], object]] = {
    "equilibrium": lambda m: bd.equilibrium(motor(m)),
    "after": lambda m: bd.equilibrium(motor(m), after=1.0),
    "transient": lambda m: bd.transient(motor(m), speed=0.0, dt=1e-6, steps=1, record=["shaft.centre.y"]),
    "0 Hz": lambda m: bd.frequency_response(loaded(m), [0.0, 20.0], ["ring.inner.y"], ["ring.inner.y"]),
    "stiffness": lambda m: ring(m).stiffness(),
    "stiffness after": lambda m: ring(m).stiffness(after=1.0),
    "sample": lambda m: bd.damping_sample(m, refinement=0.3).stiffness(),
}


@pytest.mark.parametrize("name", SOURCES)
def test_a_static_answer_beyond_the_data_warns_at_the_users_line(name: str) -> None:
    with pytest.warns(
        BeyondData, match=r"0\.0159 s, 10 Hz at 20 °C; they allow 0.*fit_maxwell\(pin="
    ) as caught:
        SOURCES[name](BANDED)
    assert [w.category for w in caught] == [BeyondData]
    assert caught[0].filename == __file__


@pytest.mark.parametrize("name", SOURCES)
def test_a_material_given_by_hand_is_believed(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        SOURCES[name](RUBBER)


def test_a_static_answer_inside_the_data_does_not_warn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bd.equilibrium(loaded(BANDED), after=0.03)  # twice 0.016 s
        bd.equilibrium(loaded(BANDED), modulus="instantaneous")
        ring(BANDED).stiffness(after=0.01)
        bd.frequency_response(loaded(BANDED), [10.0], ["ring.inner.y"], ["ring.inner.y"])


def test_a_table_at_rest_warns_too() -> None:
    table = TabulatedModulus(np.array([1.0, 1e3]), np.array([1e6, 2e6]), np.array([1e5, 5e5]), 2e9, 1150.0)
    with pytest.warns(BeyondData, match=r"reach 0\.159 s"):
        ring(table).stiffness()


def test_the_summary_tells_deflection_strain_modulus_time_and_what_the_doubt_makes_of_them() -> None:
    with pytest.warns(BeyondData):
        eq = bd.equilibrium(loaded(BANDED), after=1.0)
    found = bd.static_summary(eq)
    one = {name: float(found[name][0]) for name in found.data_vars}
    assert found["layer"].values.tolist() == ["ring"]
    assert one["deflection"] == pytest.approx(-eq.displacement("ring.inner")[1], rel=1e-9)
    assert one["strain"] == pytest.approx(one["deflection"] / 0.004, rel=1e-3)  # of a pure translation
    assert one["time"] == 1.0
    assert one["reach"] == pytest.approx(1 / (20 * np.pi), rel=1e-12)
    assert one["temperature"] == 20.0
    # of a band without data nothing is known below, and above the modulus at its edge
    assert one["modulus_low"] == 0.0
    assert one["deflection_high"] == math.inf
    x = 20 * np.pi * np.array([1e3, 1e-3])
    edge = 1e6 + float(x**2 / (1 + x**2) @ [1e6, 2e6])
    assert one["modulus_high"] == pytest.approx(edge, rel=1e-9)
    # the ring alone: as 1/G, but for what the bulk modulus gives, G/K = 1e-3
    assert one["deflection_low"] / one["deflection"] == pytest.approx(one["modulus"] / edge, rel=2e-3)
    assert found.attrs["layers"] == "after 1 s"


def test_the_summary_of_a_believed_material_has_no_doubt() -> None:
    found = bd.static_summary(bd.equilibrium(motor()))
    assert float(found["deflection_low"][0]) == pytest.approx(float(found["deflection_high"][0]), rel=1e-9)
    assert float(found["time"][0]) == math.inf
    assert math.isnan(float(found["reach"][0]))
    with pytest.raises(ValueError, match="eq has no layers"):
        bd.static_summary(bd.equilibrium(loaded(bd.Elastic(3e6, 0.4995, 1150.0))))
