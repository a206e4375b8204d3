"""What eight marches side by side win over one at a time, on one core: the demo's motor, bare and layered.

python benchmarks/abreast.py [--json]

The cases differ in their loads alone ("alike"), or in clearance too, on which the arms of their tilts depend
("differ"). Processor time of the core's marches, by turns, the least of many; states are compared to the bit.
"""

from __future__ import annotations

import sys
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor
from printing import printed

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.analysis.march import March
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.examples import paper

ABREAST, STEPS, REPEATS = 8, 12_000, 8
RATIO = 2.2  # target


def case(design: Any, k: int, differ: bool) -> core.MarchCall:
    """One march of the motor, its ring-down begun."""
    plain = paper.plain_6305
    if differ:
        ball = plain()
        paper.plain_6305 = lambda: replace(ball, clearance=ball.clearance + 1e-6 * k)
    try:
        eq = bd.equilibrium(motor.motor(design, motor.RADIAL * (1.0 + 0.02 * k)))
    finally:
        paper.plain_6305 = plain
    march = March.of(eq, speed=motor.SPEED, dt=motor.STEP, steps=1)
    model = march.model([channel_of(march.modal, "shaft.end.y")[0]])
    _, state, _ = core.march(model, march.start(model), march.stepping, 4000, 100, start=True)
    return core.MarchCall(model, state, march.stepping, STEPS, 100)


def ratio(calls: list[core.MarchCall]) -> dict[str, Any]:
    """Microseconds of a step of one march, by itself and side by side."""
    alone, abreast = np.inf, np.inf
    for k in range(REPEATS):
        call = calls[k % ABREAST]
        began = time.process_time()
        one = core.march(call.model, call.state, call.stepping, STEPS, 100)
        alone = min(alone, time.process_time() - began)
        began = time.process_time()
        together = core.march_abreast(calls)
        abreast = min(abreast, (time.process_time() - began) / ABREAST)
        if one[1].tobytes() != together[k % ABREAST][1].tobytes():
            raise SystemExit("not the same bits")
    us = [round(1e6 * seconds / STEPS, 3) for seconds in (alone, abreast)]
    return {"us_alone": us[0], "us_abreast": us[1], "ratio": round(alone / abreast, 2), "target": RATIO}


def measure() -> dict[str, Any]:
    """Microseconds of a step, and ratios."""
    low, _, _ = motor.rubber()
    bare, layered, *_ = motor.designs(low)
    found: dict[str, Any] = {}
    for name, design in (("bare", bare), ("layered", layered)):
        for differ in (False, True):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", UserWarning)
                cases = [case(design, k, differ) for k in range(ABREAST)]
            found[f"{name}, {'differ' if differ else 'alike'}"] = ratio(cases)
    return found


if __name__ == "__main__":
    sys.exit(printed(__doc__, measure))
