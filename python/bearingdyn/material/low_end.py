"""What data say of a material at long times."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

FALL = 0.05  # of G′ a decade: what moduli from one specimen to the next are good to
LATE = 10.0  # times the reach: a pin this late is the relaxed state, with branches up to a tenth of it
SLACK = 2.0  # times the reach: a third of a decade, as a band may go beyond the curve


@dataclass(frozen=True)
class LowEnd:
    """The low end of a fit: what its points say of the modulus at long times, and how long these are.

    A point at ω speaks of the relaxation modulus at t = 1/ω. Beyond the longest time the modulus cannot rise,
    and of the relaxed modulus the data alone give no lower bound unless they show a plateau: a branch that
    relaxes later looks like a spring in every point.

    Attributes
    ----------
    frequency
        Lowest frequency of the points fitted, Hz, at the temperature of the material.
    measured
        Lowest frequency of the whole master curve, Hz.
    modulus
        G′ at the low end, Pa: a parabola through ln G′ of the lowest decade, at its lowest frequency.
    slope, slope_error
        d ln G′/d ln ω of the line through that decade, and its standard error; NaN below three points.
    tan_delta
        Mean loss factor of the lowest decade.
    scatter
        rms relative deviation of G′ from the fit.
    plateau
        Whether the points show one: G′ falls, and by its loss has to fall, less than 5 % a decade. The fall
        is the larger of slope + 2 slope_error and (2/π) tan_delta (Kramers and Kronig, locally), so that
        noise makes no plateau. 5 % is what moduli of rubber agree to from one specimen to the next.
    interval
        Lowest and highest relaxed modulus, Pa, that the points allow. With a plateau: those at which a dense
        non-negative spectrum with times up to a decade beyond the points renders them within 1.2 times the
        best rms deviation, as n="auto" judges a fit, and the fit's own G0. Without: from 0 to G′ at the low
        end, as G0 ≤ G′(ω) at every ω, with twice the scatter.
    pinned
        Time, s, and modulus, Pa, at which the fit was pinned. If that is ten times the reach or more, all
        branches of the fit have relaxed by then, and the relaxed state stands for that time.
    """

    frequency: float
    measured: float
    modulus: float
    slope: float
    slope_error: float
    tan_delta: float
    scatter: float
    plateau: bool
    interval: tuple[float, float]
    pinned: tuple[float, float] | None = None

    @property
    def reach(self) -> float:
        """Longest time that the points fitted speak of, 1/ω, s."""
        return 1 / (2 * math.pi * self.frequency)

    @property
    def fall(self) -> float:
        """Share by which G′ falls in a decade at the low end, at most; NaN where nothing is known."""
        return -math.expm1(-self._steepest * math.log(10))

    @property
    def _steepest(self) -> float:
        return max(self.slope + 2 * self.slope_error, 2 / math.pi * self.tan_delta)

    def covers(self, time: float) -> bool:
        """Whether the data speak of the modulus after a time, s; inf is the relaxed state."""
        if self.plateau:
            return True
        return self.meant(time) <= SLACK * max(self.reach, self.pinned[0] if self.pinned else 0.0)

    def meant(self, time: float) -> float:
        """The time, s, that the model's modulus after a time, s, stands for; inf may be that of the pin."""
        if self.pinned is not None and math.isinf(time) and self.pinned[0] >= LATE * self.reach:
            return self.pinned[0]
        return time

    def bounds(self, time: float, value: float) -> tuple[float, float]:
        """Lowest and highest modulus, Pa, after a time, s, at which the model says `value`.

        Inside the data: twice the scatter. Beyond: it cannot rise, and it falls no more steeply than at their
        end, in logarithms, as rubber below its transition does; after an infinite time, the interval.
        """
        if not self.plateau and self.covers(time):  # at a pin as good as what it was read from: the scatter
            time = min(time, self.reach)
        if time <= SLACK * self.reach:
            return value * math.exp(-2 * self.scatter), value * math.exp(2 * self.scatter)
        low, high = self.interval
        if math.isfinite(time) and not self.plateau:
            low = 0.0
            if math.isfinite(self._steepest):
                low = self.modulus * math.exp(-2 * self.scatter) * (time / self.reach) ** -self._steepest
        return min(low, value), max(high, value)

    def moved(self, aT: float, bT: float) -> LowEnd:
        """At another temperature: times by aT, moduli by bT."""
        pinned = None if self.pinned is None else (self.pinned[0] * aT, self.pinned[1] * bT)
        return replace(
            self,
            frequency=self.frequency / aT,
            measured=self.measured / aT,
            modulus=self.modulus * bT,
            interval=(self.interval[0] * bT, self.interval[1] * bT),
            pinned=pinned,
        )

    @classmethod
    def from_numbers(cls, given: Mapping[str, Any]) -> LowEnd:
        """From its fields as JSON keeps them; TypeError for another set of fields."""
        values: dict[str, Any] = {
            name: math.nan if value is None and name != "pinned" else value for name, value in given.items()
        }
        for pair in ("interval", "pinned"):
            if isinstance(values.get(pair), list):
                values[pair] = tuple(map(float, values[pair]))
        return cls(**values)

    @classmethod
    def of_band(cls, frequency: float, modulus: float) -> LowEnd:
        """Of a model that states its lowest frequency, Hz, and nothing of data; G′ there, Pa."""
        unknown = math.nan
        return cls(frequency, frequency, modulus, unknown, unknown, unknown, 0.0, False, (0.0, modulus))
