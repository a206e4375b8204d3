"""Rings that bend between the balls, beyond Hertz's contact, against independent finite elements."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bearingdyn.bearing.catalogue import bearing
from bearingdyn.parts import FlexibleBearing, FlexibleRing, Ring, RingBed, RingPoints
from verified.row import MM, Row

B6305 = bearing("6305", balls=7, clearance=10e-6)
SIZE = (27.5 * MM, 31 * MM, 17 * MM)
RING = FlexibleRing(*SIZE, bearing=B6305, f_max=0.0)
CALCULIX = "CalculiX, computed independently for this project"
OWN = "other finite elements of rings, computed independently for this project"
LOAD, BELOW = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), -0.5 * math.pi


def rings_beyond_hertz() -> list[Row]:
    """What a ring gives under Z equal loads beyond the half-space, free and in a rigid bore; its modes."""
    found = []
    for outside, Z, wanted, source in (
        ("flexible", 3, 31.91, CALCULIX),
        ("flexible", 7, 5.376, CALCULIX),
        ("flexible", 8, 5.125, CALCULIX),
        ("rigid", 7, -0.527, OWN),
    ):
        # the ellipse of 2 kN is as long as the patch of the other model
        ring = replace(RING, bearing=replace(B6305, Z=Z), order=Z + 1, outside=outside, load=2000.0)
        free = "free" if outside == "flexible" else "in a rigid bore"
        found.append(
            Row(
                f"ring 55/62×17, {free}, {Z} equal loads, give beyond Hertz (µm/kN)",
                f"{source}, 3.0 × 0.4 mm patch less the half-space",
                wanted,
                ring.compliance.of(0) * 1e9,
                0.02 if outside == "flexible" else 0.03,
                "asked for to this; an even patch is not an ellipse",
            )
        )
    plain = Ring(*SIZE)
    grooved = FlexibleRing(
        25.6 * MM, *SIZE[1:], arm=B6305.arm, outside="flexible", groove=9.2 * MM, groove_radius=6.1 * MM
    )
    for name, body, n, f in (
        ("plain", plain, 2, 2611.8),
        ("plain", plain, 3, 7325.8),
        ("plain", plain, 4, 13869.0),
        ("grooved", grooved.body, 2, 3849.4),
        ("grooved", grooved.body, 3, 10685.0),
    ):
        got = float(body.modes(n, 1).frequency[0])
        source = OWN if name == "plain" else CALCULIX
        found.append(Row(f"{name} ring, free, mode of order {n} (Hz)", source, f, got, 3e-3, "asked for"))
    return found


def rings_on_supports() -> list[Row]:
    """A 6305 under 3 kN, a ball below: its ring in a rigid bore, on beds, on two points."""
    found = []
    y, Q = _settled(RING)
    for name, want, got, tolerance in (("depth (µm)", 36.65, y, 3e-3), ("peak (N)", 1971.5, Q, 2e-3)):
        found.append(Row(f"6305 in a rigid bore, {name}", OWN, want, got, tolerance, "asked for"))
    for stiffness, depth, peak in ((1e9, 1869.34, 1464.6), (1e10, 236.35, 1502.0), (1e11, 65.290, 1708.0)):
        bed = RingBed(stiffness)
        raw = FlexibleRing(*SIZE, arm=B6305.arm, order=10, outside=bed, f_max=0.0)
        y, Q = _settled(replace(RING, order=10, outside=bed), raw)
        for name, want, got in (("depth (µm)", depth, y), ("peak (N)", peak, Q)):
            case = f"6305 on a bed of {stiffness:.0e} N/m³, orders to 10 alone, {name}"
            found.append(
                Row(case, OWN, want, got, 1e-3, "asked for; the other model has no half-space taken out")
            )
    # a soft bed keeps the ring, on whose x no load acts, from rolling off
    feet = (RingPoints((0.5 * math.pi, -0.5 * math.pi), 5e7), RingBed(1e6))
    y, Q = _settled(replace(RING, outside=feet, order=10))
    for name, want, got, tolerance in (("depth (µm)", 92.53, y, 0.015), ("peak (N)", 2412.6, Q, 2e-3)):
        found.append(
            Row(f"6305 on two points, {name}", f"{OWN}, order 42", want, got, tolerance, "asked for")
        )
    return found


def _settled(ring: FlexibleRing, alone: FlexibleRing | None = None) -> tuple[float, float]:
    """Depth, µm, and largest ball load, N; with the orders of another ring alone in place of the ring's."""
    brg = FlexibleBearing(B6305, ring)
    if alone is not None:
        brg.__dict__["_element"] = alone.superelement()
    q = brg.displacement(LOAD, BELOW)
    return float(-1e6 * q[1]), float(np.max(brg.ball_loads(q, BELOW)))
