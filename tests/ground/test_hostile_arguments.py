"""Every argument of what a user makes, given what cannot be meant: a ValueError from the door."""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import bearing as brg
from bearingdyn import fem, material
from hostile import doors, nowhere

__all__ = ["nowhere"]

RUBBER = bd.Maxwell(1e6, [2e6, 1e6], [1e-3, 1e-2], K=2e9, density=1200.0, law=material.WLF(10.0, 100.0, 20.0))
BALL = bd.bearing.catalogue.bearing("6205", clearance=1e-5, damping=200.0)
ANGULAR = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, contact_angle=0.3)
OIL = brg.Lubricant(brg.Walther.iso_vg(32))
F, T = np.tile(np.logspace(-1, 1.5, 8), 4), np.repeat([-20.0, 0.0, 20.0, 40.0], 8)
G = RUBBER.complex_modulus(F * 10 ** (-10 * (T - 20) / (80 + T)), doubt=False)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    DMA = bd.DMAData(F, T, G.real, G.imag, mode="shear")
    CURVE = bd.master_curve(DMA)
LOAD, PLACE = [0, -500.0, 0, 0, 0, 0], [0, -2e-5, 0, 0, 0, 0]


def of_application(method: str) -> Callable[..., Any]:
    """A method of an application of two bodies, each time a new one."""

    def call(**given: Any) -> Any:
        app = bd.Application()
        app.add("r", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
        app.add("h", bd.RigidBody(4.0, (0.02, 0.02, 0.004)))
        return getattr(app, method)(**given)

    call.__signature__ = inspect.signature(getattr(bd.Application(), method))  # type: ignore[attr-defined]
    return call


SIX = {"stiffness": [1e6] * 6, "damping": [1.0] * 6}
METHODS: dict[str, dict[str, Any]] = {
    "add": {"name": "q", "part": bd.RigidBody(1.0, (1e-3,) * 3)},
    "connect": {"a": "r.centre", "b": "h.centre"},
    "ground": {"interface": "r.centre", **SIX},
    "spring": {"a": "r.centre", "b": "h.centre", **SIX},
    "free": {"interface": "r.centre"},
    "bearing": {"name": "b", "bearing": BALL, "inner": "r.centre", "outer": "h.centre"},
    "load": {"where": "r.centre", "vector": [1.0] * 6, "time": [0.0, 1.0], "value": [0.0, 1.0]},
    "unbalance": {"where": "r.centre", "moment": 1e-6},
    "gravity": {"acceleration": [0, -9.81, 0]},
    "base_motion": {"acceleration": [0, 1.0, 0]},
    "with_parts": {"parts": {"r": bd.RigidBody(1.0, (1e-3,) * 3)}},
    "mass": {"part": "r"},
}
MODEL = {"K": 2e9, "density": 1100.0}
BLOCK = {"width": 0.08, "height": 0.08, "length": 0.02, "bore_diameter": 0.03, "bore_height": 0.04}
CASES: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    **{f"app.{name}": (of_application(name), given) for name, given in METHODS.items()},
    "RigidBody": (bd.RigidBody, {"mass": 1.0, "inertia": (1e-3,) * 3}),
    "RigidBody.ring": (bd.RigidBody.ring, {"r_inner": 0.01, "r_outer": 0.02, "width": 0.01}),
    "Disc": (bd.Disc, {"z": 0.05, "mass": 1.0, "Id": 1e-3, "Ip": 2e-3}),
    "Section": (bd.Section, {"length": 0.1, "d_outer": 0.02}),
    "Shaft": (bd.Shaft, {"sections": [bd.Section(0.1, 0.02)], "seats": {"left": 0.02}}),
    "Housing": (bd.Housing, {**BLOCK, "f_max": 0.0, "element_size": 0.03}),
    "solid_family": (
        bd.solid_family,
        {
            "build": lambda d: bd.Housing(**BLOCK | {"bore_diameter": d}, f_max=0.0, element_size=0.06),
            "low": 0.0295, "high": 0.0305, "frequency": [100.0], "tolerance": 0.5,
        },
    ),
    "Layer": (bd.Layer, {"r_inner": 0.026, "r_outer": 0.030, "width": 0.015, "material": RUBBER}),
    "ORing": (bd.ORing, {"radius": 0.02, "cord": 0.003, "material": RUBBER}),
    "FlexibleBore": (bd.FlexibleBore, {"surface": "bore", "order": 4}),
    "BoreShape": (bd.BoreShape, {}),
    "LooseFit": (bd.LooseFit, {"clearance": 1e-5}),
    "ring_mesh": (fem.ring_mesh, {"radii": [0.01, 0.02], "width": 0.01}),
    "o_ring_mesh": (fem.o_ring_mesh, {"radius": 0.02, "cord": 0.003, "band": 0.002}),
    "block_with_bore": (fem.block_with_bore, {**BLOCK, "element_size": 0.03}),
    "box_mesh": (fem.box_mesh, {"x": [0, 0.1], "y": [0, 0.1], "z": [0, 0.1]}),
    "Elastic": (bd.Elastic, {"E": 2e11, "nu": 0.3, "density": 7850.0}),
    "Maxwell": (bd.Maxwell, {"G0": 1e6, "G": [2e6], "tau": [1e-3], **MODEL}),
    "PowerLaw": (bd.PowerLaw, {"modulus": 1e6, "exponent": 0.2, "frequency": 10.0, **MODEL}),
    "FractionalZener": (bd.FractionalZener, {"G0": 1e6, "G_inf": 1e7, "tau": 1e-4, "alpha": 0.5, **MODEL}),
    "TabulatedModulus": (
        bd.TabulatedModulus,
        {"frequency": np.array([1.0, 9.0]), "storage": np.array([1e6, 2e6]), "loss": [1e5] * 2, **MODEL},
    ),
    "MooneyRivlin": (bd.MooneyRivlin, {"C10": 5e5, "C01": 1e5}),
    "Yeoh": (bd.Yeoh, {"C10": 5e5, "C20": -1e4}),
    "BulkRelaxation": (bd.BulkRelaxation, {"share": [0.2], "tau": [1e-3]}),
    "Payne": (bd.Payne, {"D": 5e5, "gamma_c": 0.01, "m": 0.6, "Lm": 1e5, "gamma_l": 0.01}),
    "WLF": (material.WLF, {"C1": 10.0, "C2": 100.0, "T_ref": 20.0}),
    "Arrhenius": (material.Arrhenius, {"Ea": 1e5, "T_ref": 20.0}),
    "ShiftTable": (material.ShiftTable, {"T": (0.0, 20.0), "log_aT": (1.0, 0.0), "T_ref": 20.0}),
    "DMAData": (
        bd.DMAData,
        {"frequency": F, "temperature": T, "storage": DMA.storage, "loss": DMA.loss, "mode": "shear"},
    ),
    "DMAData.select": (DMA.select, {}),
    "master_curve": (bd.master_curve, {"dma": DMA}),
    "read_dma": (bd.read_dma, {"data": [[1.0, 20.0, 1e6, 1e5], [10.0, 20.0, 2e6, 1e5]], "mode": "shear"}),
    "Maxwell.at": (RUBBER.at, {"T": 30.0}),
    "Maxwell.complex_modulus": (RUBBER.complex_modulus, {"omega": [1.0, 10.0]}),
    "Maxwell.relaxation": (RUBBER.relaxation, {"t": [1.0]}),
    "Maxwell.creep": (RUBBER.creep, {"t": [1.0]}),
    "Maxwell.stress": (RUBBER.stress, {"strain_rate": [1.0, 1.0], "dt": 1e-3}),
    "Maxwell.with_modulus": (RUBBER.with_modulus, {"modulus": 2e6, "omega": 10.0}),
    "Maxwell.with_loss_factor": (RUBBER.with_loss_factor, {"loss_factor": 0.01, "omega": 10.0}),
    "Maxwell.from_json": (bd.Maxwell.from_json, {"text": RUBBER.to_json()}),
    "to_abaqus_prony": (material.to_abaqus_prony, {"material": RUBBER}),
    "to_abaqus_frequency": (material.to_abaqus_frequency, {"material": RUBBER, "frequency": [1.0, 10.0]}),
    "to_ansys": (material.to_ansys, {"material": RUBBER}),
    "to_calculix": (material.to_calculix, {"material": RUBBER, "frequency": 10.0}),
    "BallBearing": (
        bd.BallBearing,
        {"Z": 9, "Dw": 7.94e-3, "Dpw": 39e-3, "fi": 0.52, "fo": 0.53, "clearance": 0.0},
    ),
    "Waviness": (bd.Waviness, {"body": "inner", "order": 5, "amplitude": 1e-6}),
    "Pit": (bd.Pit, {"body": "inner", "angle": 0.0, "width": 1e-3, "depth": 1e-6}),
    "dent": (brg.dent, {"body": "inner", "angle": 0.0, "width": 2e-4, "particle": 1e-3}),
    "spall": (brg.spall, {"body": "inner", "angle": 0.0, "length": 1e-3, "depth": 1e-5}),
    "diameter_scatter": (brg.diameter_scatter, {"Z": 9, "deviation": 1e-7, "seed": 1}),
    "Pair": (brg.Pair, {"row": ANGULAR, "arrangement": "DB", "distance": 0.015}),
    "Triplet": (brg.Triplet, {"row": ANGULAR, "arrangement": "DBD", "distance": 0.015}),
    "Walther.iso_vg": (brg.Walther.iso_vg, {"grade": 32}),
    "Lubricant": (brg.Lubricant, {"kinematic": OIL.kinematic}),
    "OilSupply": (brg.OilSupply, {"lubricant": OIL, "temperature": 60.0, "speed": 100.0}),
    "Mounting": (brg.Mounting, {"bore": 0.025, "outside": 0.052}),
    "Seat": (brg.Seat, {}),
    "LoadDamping": (brg.LoadDamping, {"time": 1e-5}),
    "TabulatedDamping": (brg.TabulatedDamping, {"delta": [0.0, 1e-5], "c": [0.0, 100.0]}),
    "displacement": (BALL.displacement, {"load": LOAD}),
    "force": (BALL.force, {"q": PLACE, "velocity": [0.0] * 6, "speed": 10.0}),
    "stiffness": (BALL.stiffness, {"q": PLACE}),
    "frequencies": (BALL.frequencies, {"speed": 100.0}),
    "lines": (BALL.lines, {"speed": 100.0}),
    "turned": (BALL.turned, {"angle": 0.1}),
    "load_distribution": (brg.load_distribution, {"bearing": BALL, "q": PLACE}),
    "passage": (brg.passage, {"bearing": BALL, "load": LOAD}),
    "rating_life": (brg.rating_life, {"bearing": BALL, "load": LOAD}),
    "life_of_loads": (brg.life_of_loads, {"bearing": BALL, "inner": [100.0] * 9}),
    "load_cases": (brg.load_cases, {"bearing": BALL, "loads": [LOAD]}),
    "equivalent_load": (brg.equivalent_load, {"radial": 1e3, "axial": 100.0, "C0": 7800.0, "f0": 13.0}),
    "modified_life": (
        brg.modified_life,
        {"L10": 100.0, "P": 1e3, "C0": 7800.0, "Dpw": 0.039, "speed": 100.0, "viscosity": 1e-5},
    ),
    "equivalent_life": (brg.equivalent_life, {"phases": [(1.0, 100.0, 100.0)]}),
    "in_hours": (brg.in_hours, {"revolutions": 1e6, "speed": 100.0}),
    "clearance_range": (brg.clearance_range, {"bore": 0.025}),
    "friction": (
        brg.friction,
        {
            "radial": 1e3, "axial": 100.0, "speed": 100.0, "viscosity": 1e-5, "bore": 0.025, "outside": 0.052,
            "C0": 7800.0,
        },
    ),
    "lubricate": (
        brg.lubricate,
        {"bearing": BALL, "lubricant": OIL, "temperature": 60.0, "speed": 100.0, "load": LOAD},
    ),
    "lubricated": (
        brg.lubricated,
        {"bearing": BALL, "supply": brg.OilSupply(OIL, 60.0, 100.0), "Q": 100.0, "angle": 0.0},
    ),
    "fault_lines": (brg.fault_lines, {"bearing": BALL, "speed": 100.0}),
    "waviness_lines": (brg.waviness_lines, {"bearing": BALL, "speed": 100.0}),
    "nijenbanning_venner_moes": (
        brg.nijenbanning_venner_moes,
        {"contact": BALL.inner_contact, "F": 100.0, "us": 4.0, "eta0": 0.01, "alpha": 2e-8},
    ),
    "film_by_formula": (
        brg.film_by_formula,
        {"contact": BALL.inner_contact, "F": 100.0, "us": 4.0, "eta0": 0.01, "alpha": 2e-8},
    ),
    "contact_modulus": (brg.contact_modulus, {"first": bd.STEEL, "second": bd.STEEL}),
}  # fmt: skip
# names are texts, and what the package itself writes beside the numbers is not read by any answer
ANY_TEXT = {"name", "cache", "surface", "body", "source", "step", "order"}
TAKES_ANY = {
    ("DMAData", "notes"), ("DMAData", "run"), ("read_dma", "step"),
    ("ring_mesh", "regions"),  # an array of texts names them
    ("Maxwell.relaxation", "t"), ("Maxwell.creep", "t"),  # at rest after an infinite time
}  # fmt: skip


test_what_cannot_be_meant_is_a_value_error_from_the_door = doors(CASES, ANY_TEXT, TAKES_ANY)


@pytest.mark.parametrize("number", [Fraction(1, 50), Decimal("0.02"), np.float64(0.02), np.array(0.02)])
def test_a_number_of_another_kind_is_that_number(number: Any) -> None:
    ring = bd.RigidBody.ring(r_inner=0.0, r_outer=number, width=number)
    assert ring.mass == pytest.approx(7850 * math.pi * 0.02**3, rel=1e-12)  # round-off
