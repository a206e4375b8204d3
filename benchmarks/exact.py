"""What an exact step costs beside one of Newmark's, and what each leaves, in one run.

python benchmarks/exact.py [--json]

The layered motor of the demo under its radial load, 5000 rpm: the ball pass drives it. Costs are
processor time of the core's march, by turns, the least of many. Errors are of the harmonics of the ball
pass in velocities of shaft and housings, fitted to 60 passages that begin 60 passages behind the balance of
harmonics to 52 kHz, against that balance: rms over the lines up to 4.7 and 9.4 kHz over theirs, the worst
channel. The times faster are those of a simulated second at the steps, interpolated in the logarithms, that
leave the error which Newmark's 1.25 µs leave to 9.4 kHz.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "examples"))

import motor
from printing import printed

import bearingdyn as bd
from bearingdyn.analysis.march import March
from bearingdyn.analysis.recordable_channels import channel_of

SPEED = 5000 * 2 * np.pi / 60
HARMONICS, PASSAGES = 240, 60
SAMPLE = 2e-5  # s
STEPS = {"exact": [2e-5, 1e-5, 5e-6, 2.5e-6], "newmark": [1e-5, 5e-6, 2.5e-6, 1.25e-6, 0.625e-6]}
BANDS = {"4.7 kHz": 4.7e3, "9.4 kHz": 9.4e3}
RECORD = [
    f"{place}.{axis}.velocity"
    for place in ("shaft.middle", "left_housing.top", "right_housing.top")
    for axis in "xy"
]
TIMED, REPEATS = 20_000, 12
RATIO, FASTER = 1.3, 4.0  # targets


class Marching:
    """One method and step, from the equilibrium."""

    def __init__(self, eq: bd.Equilibrium, method: str, dt: float) -> None:
        self.march = March.of(eq, speed=SPEED, dt=dt, steps=1, method=method)
        self.model = self.march.model([channel_of(self.march.modal, name)[0] for name in RECORD])
        self.first = self.march.start(self.model)
        self.dt = dt

    def us(self, state: np.ndarray) -> tuple[np.ndarray, float, float]:
        """State behind TIMED steps, microseconds and bearing evaluations of each."""
        began = time.process_time()
        _, after, report = self.march.core_march(self.model, state, TIMED, 10)
        return after, 1e6 * (time.process_time() - began) / TIMED, report.iterations / TIMED


class Balanced:
    """The motion that a march should keep."""

    def __init__(self, eq: bd.Equilibrium) -> None:
        self.eq = eq
        self.motion = bd.steady_state(eq, speed=SPEED, harmonics=HARMONICS, record=RECORD, stability=False)
        self.base = float(self.motion["frequency"].values[1])

    def errors(self, method: str, dt: float) -> list[float]:
        """Over the bands, the rms error of the lines by that of the lines, the worst channel."""
        steps = round(PASSAGES / self.base / dt)
        run = bd.transient(
            self.eq,
            speed=SPEED,
            dt=dt,
            steps=steps,
            settle=steps,
            record=RECORD,
            method=method,
            initial=self.motion,
            decimate=round(SAMPLE / dt),
            filter=False,
            progress=False,
        )
        # all lines that the samples tell apart
        turns = np.outer(run["time"].values, np.arange(1, int(0.45 / SAMPLE / self.base) + 1))
        swings = np.exp(2j * np.pi * self.base * turns)
        columns = np.hstack([np.ones((len(turns), 1)), swings.real, -swings.imag])
        fit = np.linalg.lstsq(columns, run["record"].values, rcond=None)[0][1:]
        found = fit[: len(fit) // 2] + 1j * fit[len(fit) // 2 :]
        parts = []
        for top in BANDS.values():
            count = int(top / self.base)
            true = self.motion["amplitude"].values[1 : count + 1]
            left = (np.abs(found[:count] - true) ** 2).sum(axis=0) / (np.abs(true) ** 2).sum(axis=0)
            parts.append(float(np.sqrt(left.max())))
        return parts


def measure() -> dict[str, Any]:
    """Costs, errors and both ratios."""
    low, _, _ = motor.rubber()
    eq = bd.equilibrium(motor.motor(motor.designs(low)[2], motor.RADIAL))
    timed = {"newmark": Marching(eq, "newmark", 2.5e-6), "exact": Marching(eq, "exact", 1e-5)}
    states = {
        m: one.march.core_march(one.model, one.first, 2000, 10, start=True)[1] for m, one in timed.items()
    }
    least: dict[str, float] = dict.fromkeys(timed, float("inf"))
    evaluations: dict[str, float] = {}
    for _ in range(REPEATS):
        for method, one in timed.items():
            states[method], us, evaluations[method] = one.us(states[method])
            least[method] = min(least[method], us)
    balanced = Balanced(eq)
    found = {m: [balanced.errors(m, dt) for dt in steps] for m, steps in STEPS.items()}

    def seconds(method: str, error: float) -> float:
        """Of a simulated second that leaves an error to 9.4 kHz."""
        each = np.array([e[1] for e in found[method]])
        order = np.argsort(each)
        log = np.interp(np.log(error), np.log(each[order]), np.log(np.array(STEPS[method])[order]))
        return float(least[method] / np.exp(log) * 1e-6)

    error = found["newmark"][STEPS["newmark"].index(1.25e-6)][1]
    return {
        "newmark_us_per_step": round(least["newmark"], 3),
        "exact_us_per_step": round(least["exact"], 3),
        "evaluations_per_step": {m: round(n, 2) for m, n in evaluations.items()},
        "cost_ratio": round(least["exact"] / least["newmark"], 3),
        "target_cost_ratio": RATIO,
        **{
            f"{m}_error": {
                f"{1e6 * dt:g} us": [float(f"{x:.2g}") for x in e]
                for dt, e in zip(STEPS[m], found[m], strict=True)
            }
            for m in STEPS
        },
        "bands": list(BANDS),
        "equal_error": float(f"{error:.2g}"),
        "times_faster_at_equal_error": round(seconds("newmark", error) / seconds("exact", error), 2),
        "target_times_faster": FASTER,
    }


if __name__ == "__main__":
    sys.exit(printed(__doc__, measure))
