"""What can be turned on a machine: its sliders, and the machine with their values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from bearingdyn.application import GRAVITY, GROUND, Application, ConstantLoad, Place
from bearingdyn.bearing import BallBearing
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, RigidBody
from bearingdyn.short_repr import short

ONE_KHZ = 2.0 * math.pi * 1e3
# half the mesh density: stiffnesses stay within .02 %, and a layer's shapes take a quarter of the time
REFINEMENT = 0.5
LOSS = (0.02, 0.9)  # tan δ at 1 kHz


@dataclass(frozen=True)
class Slider:
    """One quantity that is turned.

    Parameters
    ----------
    name
        Of the quantity, as shown.
    unit
        As shown; "" for a plain number.
    low, value, high
        Range, and what the machine has, in that unit.
    log
        Whether its steps are even in the logarithm.
    note
        What turning it means.
    """

    name: str
    unit: str
    low: float
    value: float
    high: float
    log: bool = False
    note: str = ""

    __repr__ = short


def sliders_of(app: Application) -> list[Slider]:
    """The sliders that a machine has: of its layers, their material, its static loads and its bearings."""
    found = []
    layers = list(_layers(app).values())
    if layers:
        t, w = (1e3 * x for x in (layers[0].thickness, layers[0].width))
        note = (
            "the outside stays; steel on the ring fills what a thinner layer leaves" if _sleeved(app) else ""
        )
        found += [
            Slider("layer thickness", "mm", 0.25 * t, t, t, note=note),
            Slider("layer width", "mm", 0.4 * w, w, 1.5 * w),
        ]
        material = layers[0].material
        if isinstance(material, Maxwell):
            loss = float(material.loss_factor(ONE_KHZ))
            found.append(Slider("rubber stiffness", "×", 0.25, 1.0, 4.0, log=True, note="all moduli alike"))
            if LOSS[0] < loss < LOSS[1]:
                note = "tan δ at 1 kHz, |G*| there the same"
                found.append(Slider("rubber loss", "", LOSS[0], loss, LOSS[1], note=note))
    for k, name in ((1, "radial load"), (2, "axial load")):
        load = _first_load(app, k)
        if load is not None:
            size = abs(float(load.vector[k]))
            found.append(Slider(name, "N", 0.0, size, 3.0 * size, note=f"at {load.where}"))
    clearance = _clearance(app)
    if clearance is not None:
        c = 1e6 * clearance
        found.append(Slider("clearance", "µm", 0.0, c, max(3.0 * c, 20.0), note="of all bearings, diametral"))
    return found


def turned(app: Application, sliders: Mapping[str, Slider], values: Mapping[str, float]) -> Application:
    """Sliders turned: the machine at their values; the machine itself stays as it is.

    Parameters
    ----------
    app
        The machine as given.
    sliders
        Its own, by name.
    values
        By name, in the sliders' units; those left out stay.
    """

    def factor(name: str) -> float:
        return values[name] / sliders[name].value if name in values else 1.0

    parts: dict[str, Any] = {}
    made: dict[Layer, Layer] = {}
    for name, layer in _layers(app).items():
        if layer not in made:  # equal ones are reduced once
            made[layer] = replace(
                layer,
                r_inner=layer.r_outer - factor("layer thickness") * layer.thickness,
                width=factor("layer width") * layer.width,
                material=_material(layer.material, factor("rubber stiffness"), values.get("rubber loss")),
                meshed_as=layer.meshed_as or (layer.r_inner, layer.r_outer, layer.width),
                refinement=REFINEMENT * layer.refinement,
            )
        parts[name] = made[layer]
    for name, (ring, layer) in _sleeved(app).items():
        inside = layer.r_outer - factor("layer thickness") * layer.thickness
        if inside > layer.r_inner * (1.0 + 1e-9):
            sleeve = RigidBody.ring(layer.r_inner, inside, layer.width)
            x, y, z = (a + b for a, b in zip(ring.inertia, sleeve.inertia, strict=True))
            parts[name] = replace(ring, mass=ring.mass + sleeve.mass, inertia=(x, y, z))
    found = app.with_parts(parts)
    for k, name in ((1, "radial load"), (2, "axial load")):
        load = _first_load(app, k)
        if load is not None and name in values:
            more = [0.0] * 6
            more[k] = (factor(name) - 1.0) * float(load.vector[k])
            found.load(str(load.where), more)
    if "clearance" in values:
        for name, joint in app.plan.bearings.items():
            if isinstance(joint.bearing, BallBearing) and joint.bearing.clearance is not None:
                ball = replace(joint.bearing, clearance=1e-6 * values["clearance"])
                found.plan.bearings[name] = replace(joint, bearing=ball)
    return found


def _material(material: Any, stiffness: float, loss: float | None) -> Any:
    """A rubber made stiffer, and given another loss at 1 kHz."""
    if not isinstance(material, Maxwell):
        return material
    if loss is not None:
        present = float(material.loss_factor(ONE_KHZ))
        if loss > present * (1.0 + 1e-6):
            material = material.with_relaxation(loss, ONE_KHZ)
        elif loss < present * (1.0 - 1e-6):
            material = material.with_loss_factor(loss, ONE_KHZ)
    if stiffness != 1.0:
        material = material.with_modulus(stiffness * abs(complex(material.complex_modulus(ONE_KHZ))), ONE_KHZ)
    return material


def _layers(app: Application) -> dict[str, Layer]:
    """Layers by the name of their part."""
    return {name: part for name, part in app.plan.sources.items() if isinstance(part, Layer)}


def _sleeved(app: Application) -> dict[str, tuple[RigidBody, Layer]]:
    """Rigid rings inside layers, by the name of their part, each with its layer."""
    found = {}
    for joint in app.plan.connections:
        for one, other in ((joint.a, joint.b), (joint.b, joint.a)):
            ring, layer = (app.plan.sources.get(p.part) for p in (one, other))
            if isinstance(layer, Layer) and other.name == "inner" and isinstance(ring, RigidBody):
                found[one.part] = (ring, layer)
    return found


def _first_load(app: Application, k: int) -> ConstantLoad | None:
    """The first constant force along an axis."""
    return next(
        (
            load
            for load in app.plan.loads
            if isinstance(load, ConstantLoad)
            and load.where not in (GROUND, GRAVITY)
            and load.vector[k] != 0.0
        ),
        None,
    )


def _clearance(app: Application) -> float | None:
    """Clearance of the first bearing that has one, m."""
    balls = (joint.bearing for joint in app.plan.bearings.values())
    return next((b.clearance for b in balls if isinstance(b, BallBearing) and b.clearance is not None), None)


def place_of_load(app: Application) -> Place | None:
    """Where the force acts that has a slider: the first constant one."""
    loads = (_first_load(app, k) for k in (1, 2, 0))
    return next((load.where for load in loads if load is not None), None)
