"""A machine in tables: what the parts, bearings, joints and loads are, in words and display units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from bearingdyn.application import Plan
from bearingdyn.bearing import BallBearing, catalogue
from bearingdyn.material import Elastic
from bearingdyn.parts import FlexibleRing, Housing, Layer, RigidBody, Ring, Shaft

Row = tuple[str, str, str]


def designation(bearing: BallBearing) -> tuple[str, bool]:
    """Words for a drawn bearing: the catalogue's designation in this envelope, "" where there is none; and
    whether the balls are the catalogue's too."""
    angular = bearing.contact_angle is not None
    same = {
        name: (entry.Z, entry.Dw, entry.Dpw, entry.contact_angle)
        == (bearing.Z, bearing.Dw, bearing.Dpw, bearing.contact_angle)
        for name, entry in catalogue.CATALOGUE.items()
        if bearing.boundary == (entry.bore, entry.outside, entry.width)
        and angular == (entry.contact_angle is not None)
    }
    return max(same.items(), key=lambda item: item[1], default=("", False))


def material_words(material: Any) -> str:
    """A drawing's words for a material."""
    if isinstance(material, Elastic):
        if (material.E, material.density) == (210e9, 7850.0):
            return "steel"
        return f"E {material.E / 1e9:.4g} GPa, {material.density:g} kg/m³"
    G0 = getattr(material, "G0", None)
    told = type(material).__name__
    return f"rubber, G0 {G0 / 1e6:.3g} MPa" if G0 is not None else told


def part_words(source: Any) -> str:
    """A drawing's words for a part: its kind and measures, in mm."""
    mm = 1e3
    if isinstance(source, Shaft):
        widest = max(s.d_outer for s in source.sections)
        size = f"{mm * source.length:.4g} long, up to Ø{mm * widest:.4g}"
        return f"shaft, {size}, {material_words(source.material)}"
    if isinstance(source, Layer | Ring):
        kind = "layer" if isinstance(source, Layer) else "ring"
        size = f"Ø{2 * mm * source.r_inner:.4g}/{2 * mm * source.r_outer:.4g} × {mm * source.width:.4g}"
        return f"{kind}, {size}, {material_words(source.material)}"
    if isinstance(source, FlexibleRing):
        size = f"Ø{2 * mm * source.r_inner:.4g}/{2 * mm * source.r_outer:.4g} × {mm * source.width:.4g}"
        kind = "flexible inner ring" if source.inner else "flexible ring"
        return f"{kind}, {size}" + (" with its layer" if source.layer is not None else "")
    if isinstance(source, Housing):
        size = f"{mm * source.width:.4g} × {mm * source.height:.4g} × {mm * source.length:.4g}"
        return f"housing, {size}, bore Ø{mm * source.bore_diameter:.4g}, {material_words(source.material)}"
    if isinstance(source, RigidBody):
        kind = "rigid body, turning" if source.rotating else "rigid body"
        if source.measures is None:
            return f"{kind}, drawn as the box of its mass and inertia"
        a, b, width = (mm * x for x in source.measures)
        return f"{kind}, Ø{2 * a:.4g}/{2 * b:.4g} × {width:.4g}"
    return type(source).__name__


def bearing_words(bearing: BallBearing) -> str:
    """A drawing's words for a bearing: balls, and clearance or contact angle."""
    play = (
        f"clearance {1e6 * bearing.clearance:.3g} µm"
        if bearing.clearance is not None
        else f"contact angle {math.degrees(bearing.contact_angle or 0.0):.3g}°"
    )
    named, exact = designation(bearing)
    balls = f"{bearing.Z} balls Ø{1e3 * bearing.Dw:.4g} on Ø{1e3 * bearing.Dpw:.4g}"
    own = "" if not named else f" {named}" if exact else f" in the envelope of {named}"
    return f"ball bearing{own}, {balls}, {play}"


def parts_list(plan: Plan) -> Mapping[str, Row]:
    """A drawing's list in words: every part, bearing and fit by name, what it is, and its mass."""
    rows: dict[str, Row] = {}
    for name, source in plan.sources.items():
        mass, T = plan.mass(name), plan.temperatures.get(name)
        told = part_words(source) + ("" if T is None else f", at {T:g} °C")
        rows[name] = (name, told, "" if mass is None else _mass(mass))
    for name, joint in plan.bearings.items():
        moved = f", offset {1e6 * joint.offset:.4g} µm" if joint.offset else ""
        rows[name] = (name, bearing_words(joint.bearing) + moved, "")
    for name, fit in plan.fits.items():
        rows[name] = (name, f"loose fit, {1e6 * fit.fit.clearance:.4g} µm", "")
    return rows


def _mass(mass: float) -> str:
    return f"{mass:.4g} kg" if mass >= 0.1 else f"{1e3 * mass:.3g} g"
