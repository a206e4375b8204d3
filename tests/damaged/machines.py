"""Readers of whole machines."""

from __future__ import annotations

import json
from pathlib import Path

from damaged.mutations import Reader


def model_file() -> Reader:
    """A small machine as a model, read and its equilibrium found, with the table of its rubber."""
    import bearingdyn as bd

    text = """format = 1
title = "a rotor"
[parameters]
load = 100.0
[materials.rubber]
type = "Maxwell"
G0 = 1e6
G = [2e6]
tau = [1e-3]
K = 2e9
density = 1100.0
[parts.rotor]
type = "RigidBody"
mass = 4.0
inertia = [0.02, 0.02, 0.004]
rotating = true
[bearings.b]
designation = "6205"
clearance = "10 µm"
inner = "rotor.centre"
outer = "ground"
[[loads]]
at = "rotor.centre"
force = [0, -100.0, 20.0, 0, 0, 0]
"""

    def write(folder: Path) -> None:
        (folder / "m.toml").write_text(text, encoding="utf-8")

    return Reader(write, lambda f: bd.read_model(f / "m.toml"))


def ross() -> Reader:
    import bearingdyn as bd

    steel = {"name": "steel", "rho": 7810, "E": 211e9, "G_s": 81.2e9}
    shaft = {
        f"ShaftElement_{k}": {
            "L": 0.25, "idl": 0.0, "odl": 0.05, "idr": 0.0, "odr": 0.05, "n": k, "axial_force": 0,
            "torque": 0,
            "shear_effects": True, "rotary_inertia": True, "gyroscopic": True, "alpha": 0, "beta": 0,
            "material": steel,
        }
        for k in range(3)
    }  # fmt: skip
    more = {
        "DiskElement_a": {"n": 1, "m": 32.6, "Id": 0.178, "Ip": 0.329},
        **{
            f"BearingElement_{n}": {"n": n, "kxx": [1e6], "kyy": [1e6], "cxx": [10.0], "cyy": [10.0]}
            for n in (0, 3)
        },
    }

    def write(folder: Path) -> None:
        (folder / "r.json").write_text(json.dumps({"parameters": {}, **shaft, **more}, indent=1))

    return Reader(write, lambda f: bd.read_ross(f / "r.json", f_max=1e3))
