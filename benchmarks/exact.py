"""What an exact step costs beside one of Newmark's, and what each leaves, in one run.

python benchmarks/exact.py [--json]

The layered motor of the demo under its radial load, 5000 rpm: the ball pass drives it. Costs are
processor time of the core's march, by turns, the least of many. Errors are of velocities of shaft and
housings over 20 ms behind 0.1 s, against exact steps of 0.625 µs: the rms error of the spectrum's lines
up to 4.7 and 9.4 kHz over their rms, the worst channel. The times faster are those of a simulated
second at the steps, interpolated in the logarithms, that leave the error which Newmark's 1.25 µs leave
to 9.4 kHz.
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
SETTLE, SPAN, SAMPLE = 0.1, 0.02, 2e-5  # s
FINE = 0.625e-6
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

    def record(self) -> np.ndarray:
        """Velocities each SAMPLE over SPAN."""
        every = round(SAMPLE / self.dt)
        _, settled, _ = self.march._core_march(
            self.model, self.first, round(SETTLE / self.dt), every, start=True
        )
        return self.march._core_march(self.model, settled, round(SPAN / self.dt), every)[0]

    def us(self, state: np.ndarray) -> tuple[np.ndarray, float, float]:
        """State behind TIMED steps, microseconds and bearing evaluations of each."""
        began = time.process_time()
        _, after, report = self.march._core_march(self.model, state, TIMED, 10)
        return after, 1e6 * (time.process_time() - began) / TIMED, report.iterations / TIMED


def errors(found: np.ndarray, fine: np.ndarray) -> list[float]:
    """Over the bands, the rms error of the lines by that of the lines, the worst channel."""
    window = np.hanning(len(fine))[:, None]
    spectra = [np.abs(np.fft.rfft(window * (x - x.mean(axis=0)), axis=0)) for x in (found - fine, fine)]
    f = np.fft.rfftfreq(len(fine), SAMPLE)
    parts = [[np.sqrt((s[f <= top] ** 2).sum(axis=0)) for s in spectra] for top in BANDS.values()]
    return [float(np.max(error / size)) for error, size in parts]


def measure() -> dict[str, Any]:
    """Costs, errors and both ratios."""
    low, _, _ = motor.rubber()
    eq = bd.equilibrium(motor.motor(motor.designs(low)[2], motor.RADIAL))
    timed = {"newmark": Marching(eq, "newmark", 2.5e-6), "exact": Marching(eq, "exact", 1e-5)}
    states = {
        m: one.march._core_march(one.model, one.first, 2000, 10, start=True)[1] for m, one in timed.items()
    }
    least: dict[str, float] = dict.fromkeys(timed, float("inf"))
    evaluations: dict[str, float] = {}
    for _ in range(REPEATS):
        for method, one in timed.items():
            states[method], us, evaluations[method] = one.us(states[method])
            least[method] = min(least[method], us)
    fine = Marching(eq, "exact", FINE).record()
    found = {m: [errors(Marching(eq, m, dt).record(), fine) for dt in steps] for m, steps in STEPS.items()}

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
