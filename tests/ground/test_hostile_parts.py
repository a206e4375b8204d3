"""Arguments of parts, faces, meshes, sound and studies that cannot be meant: a ValueError from the door."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import bearing as brg
from bearingdyn import material, sound, study
from hostile import doors, nowhere, refuses

__all__ = ["nowhere"]

RUBBER = bd.Maxwell(1e6, [2e6, 1e6], [1e-3, 1e-2], K=2e9, density=1200.0, law=material.WLF(10.0, 100.0, 20.0))
BALL = bd.catalogue.bearing("6305", clearance=1e-5, damping=200.0)
LOAD, PLACE = [0, -500.0, 0, 0, 0, 0], [0, -2e-5, 0, 0, 0, 0]
T = np.repeat([-20.0, 0.0, 20.0, 40.0], 8)
F = np.tile(np.logspace(-1, 1.5, 8), 4)
G = RUBBER.complex_modulus(F * 10 ** (-10 * (T - 20) / (80 + T)), doubt=False)
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    CURVE = bd.master_curve(bd.DMAData(F, T, G.real, G.imag, mode="shear"))
STRAIN = np.logspace(-4, -1, 12)
SWEEP = bd.StrainSweep(STRAIN, 1e6 + 5e5 / (1 + (STRAIN / 0.01) ** 1.2), np.full(12, 1e5), 1.0, 20.0)
LAYER = bd.Layer(0.026, 0.030, 0.015, RUBBER)
RING = {"r_inner": 0.0228, "r_outer": 0.028, "width": 0.015, "arm": 0.0196, "f_max": 0.0}
REGION = bd.Region((0.02, 0.03), (-0.01, 0.01), bd.STEEL)
CORNERS = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
TONE = np.sin(0.3 * np.arange(4800))
CASES_OF_TWO = [study.Case({"value": v}, {"y": v}) for v in (1.0, 2.0)]


def of_network(method: str) -> Callable[..., Any]:
    """A method of a thermal network, each time a new one."""

    def call(**given: Any) -> Any:
        return getattr(bd.ThermalNetwork(), method)(**given)

    call.__signature__ = inspect.signature(getattr(bd.ThermalNetwork(), method))  # type: ignore[attr-defined]
    return call


def heard(
    pressure: Any, rate: Any = 48000.0, bits: Any = 32, full_scale: Any = None, pause: Any = 0.5
) -> float:
    return bd.write_wav("a.wav", pressure, rate, bits=bits, full_scale=full_scale, pause=pause)


CASES: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "Layer.stiffness": (LAYER.stiffness, {}),
    "Layer.strain": (LAYER.strain, {"relative": [0, 1e-5, 0, 0, 0, 0]}),
    "Layer.eccentricity": (LAYER.eccentricity, {"relative": [0, 1e-5, 0, 0, 0, 0]}),
    "Layer.nominal_strain": (LAYER.nominal_strain, {"relative": [0, 1e-5, 0, 0, 0, 0]}),
    "Region": (bd.Region, {"r": (0.02, 0.03), "z": (-0.01, 0.01), "material": bd.STEEL}),
    "Patch": (bd.Patch, {"material": bd.STEEL}),
    "Cylinder": (bd.Cylinder, {"r": 0.02}),
    "EndFace": (bd.EndFace, {"z": 0.01}),
    "Line": (bd.Line, {"start": (0.02, 0), "end": (0.03, 0)}),
    "Where": (bd.Where, {"inside": lambda r, z: r > 0}),
    "Groove": (bd.Groove, {"surface": bd.Cylinder(0.02), "arm": 0.0205}),
    "Revolved": (bd.Revolved, {"regions": (REGION,), "interfaces": {"inner": bd.Cylinder(0.02)}}),
    "Ring": (bd.Ring, {"r_inner": 0.02, "r_outer": 0.03, "width": 0.02}),
    "FlexibleRing": (bd.FlexibleRing, RING),
    "RingBed": (bd.RingBed, {"stiffness": 1e10}),
    "RingPoints": (bd.RingPoints, {"azimuth": [0.0, 2.0, 4.0], "stiffness": 1e7}),
    "damping_sample": (bd.damping_sample, {"material": RUBBER}),
    "specimen_factor": (bd.specimen_factor, {"thickness": 2e-3, "diameter": 0.02}),
    "quadrilaterals": (
        bd.quadrilaterals,
        {"points": [[0.02, 0], [0.03, 0], [0.03, 0.01], [0.02, 0.01]], "cells": [[0, 1, 2, 3]]},
    ),
    "at_radius": (bd.at_radius, {"radius": 0.02}),
    "NodeSet": (bd.NodeSet, {"nodes": [1, 2, 3]}),
    "MeshNodes": (bd.MeshNodes, {"nodes": (1, 2, 3)}),
    "Feet": (bd.Feet, {"width": 0.01}),
    "Units": (bd.Units, {}),
    "StrainSweep": (
        bd.StrainSweep,
        {"strain": STRAIN, "storage": SWEEP.storage, "loss": SWEEP.loss, "frequency": 1.0},
    ),
    "fit_maxwell": (bd.fit_maxwell, {"master": CURVE, "n": 2, "K": 2e9, "density": 1100.0}),
    "fit_dense": (material.fit_dense, {"master": CURVE, "K": 2e9, "density": 1100.0}),
    "fit_payne": (bd.fit_payne, {"sweep": SWEEP, "strain_of_isotherms": 1e-3}),
    "doubts": (bd.doubts, {"material": RUBBER, "level": (0.9, 1.1)}),
    "RhoT": (material.RhoT, {"T_ref": 20.0}),
    "Joined": (material.Joined, {"C1": 10.0, "C2": 50.0, "Tg": -40.0, "Ea": 1e5, "T_ref": 20.0}),
    "Spread": (material.Spread, {}),
    "group_isotherms": (material.group_isotherms, {"temperature": T}),
    "Running": (brg.Running, {"bearing": BALL, "speed": 100.0}),
    "Running.displacement": (brg.Running(BALL, 100.0).displacement, {"load": LOAD}),
    "Running.force": (brg.Running(BALL, 100.0).force, {"q": PLACE}),
    "iso_ratings": (brg.iso_ratings, {"Z": 9, "Dw": 7.94e-3, "Dpw": 39e-3}),
    "resultant_damping": (brg.resultant_damping, {"inner": (1e8, 100.0), "outer": (1e8, 100.0)}),
    "WavinessSpectrum": (brg.WavinessSpectrum, {"amplitude": 1e-8}),
    "catalogue": (bd.catalogue.bearing, {"designation": "6205"}),
    "Geometry": (
        brg.Geometry,
        {"Z": 9, "Dw": 7.94e-3, "Dpw": 39e-3, "fi": 0.52, "fo": 0.53, "clearance": 0.0},
    ),
    "contamination_factor": (brg.contamination_factor, {"contamination": 0.5, "Dpw": 0.039}),
    "without_spin": (brg.without_spin, {"stiffness": np.eye(6)}),
    "ThermalNetwork.link": (of_network("link"), {"a": "x", "b": "y", "conductance": 1.0}),
    "ThermalNetwork.film": (of_network("film"), {"a": "x", "area": 0.1, "coefficient": 10.0}),
    "write_wav": (heard, {"pressure": TONE}),
    "mean_squares": (sound.mean_squares, {"samples": TONE, "rate": 48000.0}),
    "filtered_bands": (sound.filtered_bands, {"samples": TONE, "rate": 48000.0, "low": 400.0}),
    "bands": (sound.bands, {"low": 100.0, "high": 1000.0}),
    "band_levels": (sound.band_levels, {"frequency": np.linspace(90, 1200, 400), "power": np.ones(400)}),
    "weighted_signal": (sound.weighted_signal, {"samples": TONE, "rate": 48000.0}),
    "vibration_severity": (sound.vibration_severity, {"velocity": 1e-3 * TONE, "rate": 48000.0}),
    "pressure_signal": (
        sound.pressure_signal,
        {"force": TONE, "rate": 48000.0, "frequency": np.linspace(0, 2e4, 9), "transfer": np.ones(9) + 0j},
    ),
    "hemisphere_positions": (sound.hemisphere_positions, {"radius": 1.0}),
    "box_positions": (sound.box_positions, {"low": (0, 0, 0), "high": (0.1, 0.1, 0.1)}),
    "radiated_power": (
        sound.radiated_power,
        {"points": CORNERS, "faces": FACES, "velocity": [1e-3] * 4, "frequency": 100.0},
    ),
    "Uniform": (study.Uniform, {"low": 1.0, "high": 2.0}),
    "Normal": (study.Normal, {"mean": 1.0, "sd": 0.1}),
    "LogNormal": (study.LogNormal, {"median": 1.0, "relative": 0.1}),
    "draw": (study.draw, {"n": 4, "parameters": {"value": study.Uniform(1, 2)}}),
    "band": (
        study.band,
        {"function": lambda p: [p["value"]], "parameters": {"value": study.Uniform(1, 2)}, "n": 20},
    ),
    "pareto": (study.pareto, {"study": study.table(CASES_OF_TWO), "minimise": ["y"]}),
    "table": (study.table, {"cases": CASES_OF_TWO}),
    "Analysis": (bd.Analysis, {"name": "m", "kind": "modes"}),
    "Model": (bd.Model, {"application": bd.Application()}),
    "Scheme": (bd.Scheme, {}),
}  # fmt: skip
TEXTS = {"a", "b", "name", "title", "source", "radiating", "surface"}
TAKES_ANY = {
    ("StrainSweep", "temperature"),  # NaN where it is not known
    ("StrainSweep", "notes"),
    ("fit_payne", "mode"),  # of a table; a sweep has its own
    ("pressure_signal", "transfer"),
    ("without_spin", "stiffness"),
}


test_what_cannot_be_meant_is_a_value_error_from_the_door = doors(CASES, TEXTS, TAKES_ANY)


@pytest.mark.filterwarnings("ignore")
def test_what_stands_on_a_mesh_refuses_what_cannot_be_meant() -> None:
    pytest.importorskip("skfem")
    mesh = bd.box_mesh([0, 0.01, 0.02], [0, 0.02], [0, 0.005, 0.01], "hex20")
    block = bd.Solid(mesh, bd.STEEL, {"top": "z+", "base": "z-"}, 0.0)
    pad = bd.Solid(
        bd.box_mesh([0, 0.02], [0, 0.02], [0, 0.01], "hex27"), RUBBER, {"top": "z+", "base": "z-"}, 0.0
    )
    solid = {"mesh": mesh, "materials": bd.STEEL, "interfaces": {"top": "z+"}, "f_max": 0.0}
    refuses(bd.Solid, solid, texts={"radiating", "attach"})
    refuses(bd.RigidSurface, {"surface": "z+"}, texts={"surface"})
    refuses(bd.SolidMesh, {"points": mesh.points, "elements": mesh.elements})
    refuses(mesh.surface, {"name": "z+"})
    refuses(pad.stiffness, {})
    refuses(pad.assembled, {"press": {"top": 1e-4}})
    element = block.superelement()
    refuses(bd.Superelement, {k: getattr(element, k) for k in ("M", "C", "G", "K", "interfaces")})
    full = block.full_model()
    refuses(bd.FullModel, {k: getattr(full, k) for k in ("M", "K", "interfaces")})
    refuses(bd.reduction_error, {"model": full, "basis": block.basis(), "frequency": [100.0, 200.0]})
