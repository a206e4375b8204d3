"""What layers that soften with their amplitude cost on the demo's layered motor, over layers that do not.

python benchmarks/softening.py [--json]

A step of the march, with its refactoring, and the harmonic response with all strains converged, at one level
of excitation and at three. Processor time, the least of turns taken one after the other in one run: other
programs then count little. Targets: 1.3 times the linear march; 3 times the linear response.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor

import bearingdyn as bd

# of the EPDM that the motor's layers are made of, by its strain sweep
LAW = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
FREQUENCY = np.geomspace(50.0, 7000.0, 2000)  # Hz
STEPS, TURNS = 20_000, 12
LEVELS = [1.0, 30.0, 1000.0]  # N


def least(tasks: dict[str, Callable[[], object]], turns: int) -> dict[str, float]:
    """Processor seconds of each, the least of turns."""
    found = dict.fromkeys(tasks, float("inf"))
    for _ in range(turns):
        for name, task in tasks.items():
            began = time.process_time()
            task()
            found[name] = min(found[name], time.process_time() - began)
    return found


def states() -> dict[str, bd.Equilibrium]:
    """The layered motor without the law and with it."""
    design = motor.designs(motor.rubber()[0])[2]
    assert design.rubber is not None
    soft = replace(design, rubber=design.rubber.with_payne(LAW))
    return {
        name: bd.equilibrium(motor.motor(d, motor.RADIAL)) for name, d in (("linear", design), ("law", soft))
    }


def marches(eq: dict[str, bd.Equilibrium]) -> dict[str, float]:
    """Microseconds a step of both, and their ratio."""

    def march(name: str) -> Callable[[], object]:
        memory = {"memory": 0.05} if name == "law" else {}
        return lambda: bd.transient(
            eq[name],
            speed=motor.SPEED,
            dt=motor.STEP,
            steps=STEPS,
            decimate=100,
            record=["shaft.end.y"],
            progress=False,
            **memory,
        )

    # a short one beside a long one: what stands before the first step drops out
    def short(name: str) -> Callable[[], object]:
        memory = {"memory": 0.05} if name == "law" else {}
        return lambda: bd.transient(
            eq[name],
            speed=motor.SPEED,
            dt=motor.STEP,
            steps=100,
            decimate=100,
            record=["shaft.end.y"],
            progress=False,
            **memory,
        )

    tasks = {n: march(n) for n in eq} | {f"{n} short": short(n) for n in eq}
    cost = least(tasks, TURNS)
    own = {n: 1e6 * (cost[n] - cost[f"{n} short"]) / (STEPS - 100) for n in eq}
    return {
        "march_us_linear": round(own["linear"], 3),
        "march_us_law": round(own["law"], 3),
        "march_ratio": round(own["law"] / own["linear"], 3),
    }


def responses(eq: dict[str, bd.Equilibrium]) -> dict[str, float]:
    """Seconds of the linear response, of one level and of three, and their ratios."""

    def ask(name: str, amplitude: object) -> Callable[[], object]:
        more = {} if amplitude is None else {"amplitude": amplitude}
        return lambda: bd.frequency_response(eq[name], FREQUENCY, [motor.INPUT], motor.OUTPUTS, **more)  # type: ignore[arg-type]

    tasks = {"linear": ask("linear", None), "three": ask("law", LEVELS)}
    tasks |= {f"{a:g} N": ask("law", a) for a in LEVELS}
    cost = least(tasks, TURNS)
    return {
        "harmonic_s_linear": round(cost["linear"], 4),
        **{
            f"harmonic_ratio {name}": round(t / cost["linear"], 2)
            for name, t in cost.items()
            if name != "linear"
        },
    }


def main() -> None:
    """Print what was measured."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--json", action="store_true")
    asked = parser.parse_args()
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        eq = states()
        found = {**marches(eq), **responses(eq)}
    if asked.json:
        print(json.dumps(found))
        return
    for name, value in found.items():
        print(f"{name:24} {value}")


if __name__ == "__main__":
    main()
