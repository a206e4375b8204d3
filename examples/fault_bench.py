"""A bench for bearing faults: a shaft in two 6205 bearings, the left one spalled, a sensor on its pedestal.

The bearing is the drive end bearing of the public Case Western Reserve University measurements. Surfaces are
wavy, drawn once by a law of amplitudes. Run it as `python examples/fault_bench.py`; it prints what the sensor
feels, sound and spalled, without and with a layer of rubber between outer rings and pedestals.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from functools import cache

import motor
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn.bearing import WavinessSpectrum, fault_lines, spall
from bearingdyn.bearing.catalogue import bearing

SPEED = 1797 * math.pi / 30  # rad/s, of the measurements
LOAD, PRELOAD = 300.0, 100.0  # N, radial and axial, at mid-shaft
STEP, STEPS, SETTLE = 2.5e-6, 200_000, 60_000  # half a second is kept: lines 2 Hz apart
RING = (0.0228, 0.026, 0.015)  # outer ring: groove radius taken off, outside radius, width, m
SENSOR = "left_housing.top.y.acceleration"

SPALL = spall("outer", -math.pi / 2, length=0.6e-3, depth=4e-6)  # where the load is carried
ORDERS = range(2, 41)  # of the waves
WAVES = WavinessSpectrum(60e-9, exponent=1.5, order=2, scatter="rayleigh")


@cache
def shaft() -> bd.Superelement:
    """The shaft with its rotor."""
    rotor = bd.Disc.cylinder(0.15, 0.12, 0.03, d_inner=0.03)
    seats = {"left": 0.02, "right": 0.28}
    # the inner rings, 15 mm wide on Ø25, stand against the shoulders
    sections = [bd.Section(0.0275, 0.025), bd.Section(0.245, 0.03), bd.Section(0.0275, 0.025)]
    whole = bd.Shaft(sections, seats, {"middle": 0.15}, discs=[rotor], damping=0.005, f_max=12e3)
    return whole.superelement()


@cache
def pedestal(outside: float) -> bd.Superelement:
    """A pedestal with a bore of this radius, m."""
    block = bd.Housing(
        0.12, 0.14, 0.025, bore_diameter=2 * outside, bore_height=0.08, damping=0.01, f_max=12e3
    )
    return block.superelement()


def bench(layer: bd.Layer | None = None, defects: Sequence[bd.Pit] = ()) -> bd.Application:
    """Shaft, two bearings, two pedestals; the layer, if any, lies between outer rings and pedestals."""
    app = bd.Application()
    app.add("shaft", shaft())
    outside = RING[1] if layer is None else layer.r_outer
    for side in ("left", "right"):
        app.add(f"{side}_ring", bd.RigidBody.ring(*RING))
        app.add(f"{side}_housing", pedestal(outside))
        app.ground(f"{side}_housing.feet")
        if layer is None:
            app.connect(f"{side}_ring.centre", f"{side}_housing.bore")
        else:
            app.add(f"{side}_layer", layer)
            app.connect(f"{side}_ring.centre", f"{side}_layer.inner")
            app.connect(f"{side}_layer.outer", f"{side}_housing.bore")
        app.bearing(side, ball_bearing(side, defects), inner=f"shaft.{side}", outer=f"{side}_ring.centre")
    app.load("shaft.middle", (0, -LOAD, PRELOAD, 0, 0, 0))
    app.unbalance("shaft.middle", 2e-6)
    return app


def ball_bearing(side: str, defects: Sequence[bd.Pit] = ()) -> bd.BallBearing:
    """A 6205 with wavy races and balls; only the left one can be damaged."""
    seed = {"left": 0, "right": 10}[side]
    waviness = (
        *WAVES.draw("inner", ORDERS, seed),
        *WAVES.draw("outer", ORDERS, seed + 1),
        *WAVES.draw("ball", range(2, 17, 2), seed + 2, Z=9),
    )
    damage = tuple(defects) if side == "left" else ()
    return bearing("6205", clearance=8e-6, damping=30.0, waviness=waviness, defects=damage)


def rubber_ring() -> bd.Layer:
    """The layer of the motor's low-loss rubber, 4 mm thick."""
    return bd.Layer(RING[1], RING[1] + 0.004, RING[2], motor.rubber()[0])


def run(app: bd.Application, steps: int = STEPS, settle: int = SETTLE) -> xarray.Dataset:
    """The acceleration of the left pedestal's top at 1797 rpm, once the start has rung down."""
    eq = bd.equilibrium(app)
    return bd.transient(eq, speed=SPEED, dt=STEP, steps=steps, settle=settle, record=[SENSOR, "left.loaded"])


def lines(harmonics: int = 1) -> dict[str, float]:
    """Fault frequencies of the bearing, Hz."""
    return fault_lines(bearing("6205", clearance=8e-6), SPEED, harmonics=harmonics)


def main() -> int:
    """Run the four cases; returns the exit code."""
    for label, layer in (("no layer", None), ("layer", rubber_ring())):
        for state, defects in (("sound", ()), ("spalled", (SPALL,))):
            record = run(bench(layer, defects))["record"].sel(channel=SENSOR).values
            print(
                f"{label:<9} {state:<8} {np.std(record):9.3g} m/s² rms, largest {np.abs(record).max():9.3g}"
            )
    return 0


if __name__ == "__main__":
    sys.exit(main())
