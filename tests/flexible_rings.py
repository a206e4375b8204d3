"""A 6305 whose outer ring bends: in a rigid bore, in rubber, loose in its bore; and applications of it."""

from __future__ import annotations

import math
from dataclasses import replace

import xarray

import bearingdyn as bd
from bearingdyn.bearing import LooseFit
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts import FlexibleRing, Layer, RigidBody

MM = 1e-3
RUBBER = bd.Maxwell(G0=2e6, G=[2e6, 3e6], tau=[1e-3, 1e-5], K=2e9, density=1200.0)
B6305 = bearing("6305", balls=7, clearance=10e-6, damping=30.0)
SIZE = (27.5 * MM, 31 * MM, 17 * MM)
LAYER = Layer(31 * MM, 35 * MM, 17 * MM, RUBBER)
RING = FlexibleRing(*SIZE, bearing=B6305)
CUSHIONED = replace(RING, layer=LAYER)
LOOSE = replace(RING, outside="flexible")
STIFF = Elastic(1e6 * STEEL.E, STEEL.nu, STEEL.density)
LOAD = (0.0, -2000.0, 200.0, 0.0, 0.0, 0.0)


def hung(ring: FlexibleRing | None, load: tuple[float, ...] = LOAD) -> bd.Application:
    """A rotor in one bearing, tilts on soft springs; the ring None: rigid rings."""
    app = bd.Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(0, 0, 0, 1e4, 1e4, 1.0), damping=(50, 50, 50, 1, 1, 0.1))
    if ring is None:
        app.bearing("b", B6305, inner="rotor.centre", outer="ground")
    else:
        app.add("ring", ring)
        app.ground("ring.outer")
        app.bearing("b", B6305, inner="rotor.centre", outer="ring.raceway")
    app.load("rotor.centre", load)
    return app


def loose(clearance: float, ring: FlexibleRing = LOOSE, **fit: float) -> bd.Application:
    """A rotor in one bearing whose ring lies in a rigid bore with clearance; a ball under the load."""
    app = bd.Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(0, 0, 0, 1e6, 1e6, 1.0), damping=(50, 50, 50, 1, 1, 0.1))
    app.add("ring", ring)
    brg = replace(B6305, angle0=-0.5 * math.pi)
    app.bearing("b", brg, inner="rotor.centre", outer="ring.raceway")
    app.fit("seat", LooseFit(clearance, **fit), ring="ring.outside", bore="ground")
    app.load("rotor.centre", (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0))
    return app


def audited(
    eq: bd.Equilibrium, dt: float, *channels: str, steps: int = 8000
) -> tuple[float, dict[str, float], xarray.Dataset]:
    """Energy that a run at 500 rad/s leaves unaccounted for, J; the energies; and the run."""
    record = ["rotor.centre.y", "b.force.y", "b.ball3", "b.loaded", *channels]
    arguments = {"speed": 500.0, "dt": dt, "record": record, "audit": True}
    before = bd.transient(eq, steps=0, **arguments).attrs
    run = bd.transient(eq, steps=steps, **arguments)
    after = run.attrs
    change = sum(
        after[f"energy_{e}"] - before[f"energy_{e}"] for e in ("kinetic", "elastic", "stored", "indentation")
    )
    lost = sum(after[f"energy_{e}"] for e in ("linear", "branch", "contact"))
    assert lost > 0.0
    return after["energy_load"] + after["energy_turning"] - lost - change, after, run
