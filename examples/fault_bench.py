"""A bench for bearing faults: a shaft in two 6205 bearings, the left one spalled, a sensor on its pedestal.

The bearing is the drive end bearing of the public Case Western Reserve University measurements. Surfaces are
wavy, drawn once by a law of amplitudes. Run it as `python examples/fault_bench.py`; it prints what the sensor
feels, sound and spalled, without and with a layer of rubber between outer rings and pedestals.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence

import motor
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn.bearing import fault_lines, spall
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.examples.paper import OUTER_6205

SPEED = 1797 * math.pi / 30  # rad/s, of the measurements
STEP, STEPS, SETTLE = 2.5e-6, 200_000, 60_000  # half a second is kept: lines 2 Hz apart
SENSOR = "left_housing.top.y.acceleration"

SPALL = spall("outer", -math.pi / 2, length=0.6e-3, depth=4e-6)  # where the load is carried


def bench(layer: bd.Layer | None = None, defects: Sequence[bd.Pit] = ()) -> bd.Application:
    """Shaft, two bearings, two pedestals; the layer, if any, lies between outer rings and pedestals."""
    return bd.examples.fault_bench(layer, defects)


def rubber_ring() -> bd.Layer:
    """The layer of the motor's low-loss rubber, 4 mm thick."""
    return bd.Layer(OUTER_6205[1], OUTER_6205[1] + 0.004, OUTER_6205[2], motor.rubber()[0])


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
