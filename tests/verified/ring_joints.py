"""Rings loose in a bore that bends, and the hoop stress at their outside, against plane elasticity."""

from __future__ import annotations

import math

import numpy as np

import bearingdyn as bd
from bearingdyn.bearing import LooseFit
from bearingdyn.fem import ring_mesh
from bearingdyn.material import STEEL
from bearingdyn.parts import Cylinder, FlexibleBore, FlexibleRing, Groove, Line, Region, Revolved, Solid
from bearingdyn.system import assemble
from verified.ring_theory import annulus_hoop, annulus_in_bush
from verified.row import MM, Row

INNER, SEAT, FOOT, WIDTH = 40 * MM, 60 * MM, 80 * MM, 1 * MM
SPRING = 1e11  # N/m of the seat on each of its coefficients, when it is closed all round
HIGHEST = 6


def _ring() -> FlexibleRing:
    """A free ring, so narrow that it is in plane stress, pressed evenly over its width."""
    return FlexibleRing(
        INNER, SEAT, WIDTH, arm=50 * MM, groove=WIDTH, outside="flexible", order=HIGHEST, refinement=2.0,
        f_max=0.0,
    )  # fmt: skip


def rings_in_bores() -> list[Row]:
    """Give of the race of a ring that sits, closed all round and without friction, in a bush held outside."""
    half = 0.5 * WIDTH
    revolved = Revolved(
        (Region((SEAT, FOOT), (-half, half), STEEL),),
        {"foot": Cylinder(FOOT)},
        grooves={"bore": Groove(Line((SEAT, -half), (SEAT, half)), SEAT, HIGHEST, z=0.0)},
        refinement=2.0,
    )
    mesh = ring_mesh((SEAT, FOOT), WIDTH, across=6, along=1, around=48)
    bore = FlexibleBore("inner", HIGHEST)
    solid = Solid(mesh, STEEL, {"foot": "outer"}, f_max=0.0, inertia=0, bores={"bore": bore})
    return [*_in_bush("a bush", revolved), *_in_bush("a bush of bricks", solid)]


def _in_bush(what: str, bush: Revolved | Solid) -> list[Row]:
    """Of one way to make the bush."""
    ring = _ring()
    app = bd.Application()
    app.add("ring", ring)
    app.add("bush", bush)
    app.ground("bush.foot")
    app.free("ring.raceway")
    app.fit("seat", LooseFit(0.0), ring="ring.outside", bore="bush.bore")
    system = assemble(app)
    B = system.bearings[0].B
    K = system.K + SPRING * B.T @ B
    raceway = app.plan.parts["ring"].raceways["raceway"]
    found = []
    for n in range(2, HIGHEST + 1):
        row = np.zeros(len(K))  # the ring's coordinates come first
        row[: raceway.rows.shape[1]] = raceway.rows[raceway.series.index(0, n, 0)]
        bed = SPRING / (math.pi * SEAT * WIDTH)
        give = annulus_in_bush(n, STEEL.E, STEEL.nu, INNER, SEAT, FOOT, bed) / (math.pi * INNER * WIDTH)
        found.append(
            Row(
                f"ring 40/60 mm, without friction in {what} 60/80 mm, race's give of order {n} (m/N)",
                "plane elasticity, Michell, both bodies together",
                give,
                float(row @ np.linalg.lstsq(K, row, rcond=1e-15)[0]),
                1e-3,
                "plane stress, which the foot, held in all directions across the width, disturbs",
            )
        )
    return found


def hoop_stresses() -> list[Row]:
    """Hoop stress at the outside of a free ring under the pressure cos nφ within, over that pressure."""
    ring = _ring()
    element, psi = ring.superelement(), np.linspace(0.0, 2 * math.pi, 48, endpoint=False)
    raceway = element.raceways["raceway"]
    rows = ring.body.hoop_stress(SEAT, (-0.05 * WIDTH, 0.05 * WIDTH), psi, STEEL)
    flexible = np.linalg.pinv(element.K, rcond=1e-13)
    found = []
    for n in (2, 3, 4, 6):
        # a load of 1 N on the coefficient is a pressure of 1/(π a width)
        stress = rows @ flexible @ raceway.rows[raceway.series.index(0, n, 0)] * math.pi * INNER * WIDTH
        found.append(
            Row(
                f"ring 40/60 mm, hoop stress outside over the pressure of order {n}",
                "plane elasticity, Michell",
                annulus_hoop(n, INNER, SEAT),
                float(2 * np.mean(stress * np.cos(n * psi))),
                1e-3,
                "strain of quadratic elements at an edge",
            )
        )
    return found
