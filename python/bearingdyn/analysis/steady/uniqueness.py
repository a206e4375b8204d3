"""Which stable steady motions there are at one speed: those that a coast-down and a run-up lead to."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.analysis.steady.balance import Found, newton
from bearingdyn.analysis.steady.branches import Speeds, Task
from bearingdyn.analysis.steady.motion import Motion
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.searches import from_both_ends
from bearingdyn.application import Application
from bearingdyn.checks import require
from bearingdyn.system import System
from bearingdyn.types import Array

# shares of the speed from which its motions are approached
FROM, TO = 0.75, 1.6
# harmonics of a passage, samples for each, points of a branch that hardly bends, and at most
HARMONICS, PER, POINTS, MOST = 20, 16, 40, 400
# of a motion, by which another must differ to be another
DIFFERENT = 1e-3


class Approaches:
    """Whether a steady motion is unique: the stable ones at one speed that run-up and coast-down meet.

    Raises
    ------
    ValueError
        For a speed of zero, and for a machine whose motion has several base frequencies.
    """

    def __init__(self, source: Equilibrium | Application | System, speed: float) -> None:
        self.problem = Problem.of(source)
        self.speed = speed
        require(speed != 0.0, "check_unique with a speed", speed, "at rest nothing passes; leave it out")
        bases = [b.name for b in self.problem.bases.bases]
        require(
            len(bases) == 1,
            "check_unique for the base frequencies",
            bases,
            "steady motions are followed over speed where there is one; leave it out",
        )

    def swings(self, record: Sequence[str]) -> Array:
        """Peak to peak (motion, channel) of every stable motion found, the smallest first."""
        channels = [channel_of(self.problem.system, name)[0] for name in record]
        low, high = sorted((FROM * self.speed, TO * self.speed))
        step, tolerance = (high - low) / POINTS, 1e-6 * (high - low)
        task = Task(Speeds(self.problem), (), low, high, self.speed, step, HARMONICS, PER, MOST, tolerance)
        balance = self.problem.balance(task.lines(1), self.speed)
        found: list[Found] = []
        for branch in from_both_ends(task):
            points = [m.point for m in branch.marks if m.event != "failed"]
            for a, b in pairwise(points):
                p, q = a.parameter - self.speed, b.parameter - self.speed
                if p == q or p * q > 0.0:
                    continue
                own = newton(balance, a.z + p / (p - q) * (b.z - a.z), tolerance=1e-10)
                if own.converged and not any(_same(own, other) for other in found):
                    found.append(own)
        stable = [f for f in found if task.stability(balance, f.z, 1).stability.stable]
        swing = np.zeros((len(stable), len(channels)))
        for row, own in zip(swing, stable, strict=True):
            motion = Motion(balance, own)
            row[:] = np.ptp(motion.signals(channels, motion.amplitudes(channels), motion.times()), axis=0)
        return np.asarray(swing[np.argsort(swing.sum(axis=1))])


def _same(a: Found, b: Found) -> bool:
    size = float(np.linalg.norm(a.z[1:])) + 1e-4 * float(np.linalg.norm(a.z[0]))
    return float(np.linalg.norm(a.z - b.z)) <= DIFFERENT * size
