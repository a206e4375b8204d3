"""Distributions of what is not exactly known: tolerances, clearances, temperatures, materials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from bearingdyn.checks import number, positive, require, two
from bearingdyn.material import Doubts, Maxwell, uniforms
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.study.cases import label
from bearingdyn.types import Array


@dataclass(frozen=True)
class Normal:
    """A normal distribution, cut at `low` and `high` where they are given.

    Parameters
    ----------
    mean
        In the parameter's unit.
    sd
        Standard deviation, positive.
    low, high
        Limits that no draw passes.

    Raises
    ------
    ValueError
        For a deviation that is not positive, or limits that leave nothing.
    """

    mean: float
    sd: float
    low: float = -math.inf
    high: float = math.inf

    def __post_init__(self) -> None:
        sd = positive("Normal.sd", self.sd, "it must be a positive standard deviation")
        ends = two("Normal.low, Normal.high", (self.low, self.high), "they must be numbers")
        for name, value in (("mean", number("Normal.mean", self.mean)), ("sd", sd)):
            object.__setattr__(self, name, value)
        require(ends[0] < ends[1], "Normal.low, Normal.high", ends, "low must be below high")
        for name, value in zip(("low", "high"), ends, strict=True):
            object.__setattr__(self, name, value)
        share = np.diff(_normal_share(np.array(ends), self.mean, self.sd))[0]
        remedy = "they must leave more than a millionth of the distribution"
        require(bool(share > 1e-6), "Normal.low, Normal.high", ends, remedy)

    def quantile(self, share: Array) -> Array:
        """Values (n,) below which these shares (n,) of the distribution lie."""
        from scipy.special import ndtri

        first, last = _normal_share(np.array([self.low, self.high]), self.mean, self.sd)
        return np.asarray(self.mean + self.sd * ndtri(first + (last - first) * share))


@dataclass(frozen=True)
class LogNormal:
    """A log-normal distribution: what is known to within a factor, and is never negative.

    Parameters
    ----------
    median
        In the parameter's unit, positive.
    relative
        Standard deviation of the logarithm, positive: about the relative one of the parameter.

    Raises
    ------
    ValueError
        For values that are not positive.
    """

    median: float
    relative: float

    def __post_init__(self) -> None:
        positive("LogNormal.median", self.median)
        positive("LogNormal.relative", self.relative, "it must be a positive standard deviation")
        plausible("spread", "LogNormal.relative", self.relative)

    def quantile(self, share: Array) -> Array:
        """Values (n,) below which these shares (n,) of the distribution lie."""
        from scipy.special import ndtri

        return np.asarray(self.median * np.exp(self.relative * ndtri(share)))


@dataclass(frozen=True)
class Uniform:
    """A uniform distribution: a tolerance or a class of clearance of which only the limits are known.

    Parameters
    ----------
    low, high
        In the parameter's unit.

    Raises
    ------
    ValueError
        For a low that is not below high.
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        ends = (number("Uniform.low", self.low), number("Uniform.high", self.high))
        require(ends[0] < ends[1], "Uniform.low, Uniform.high", ends, "low must be below high")

    def quantile(self, share: Array) -> Array:
        """Values (n,) below which these shares (n,) of the distribution lie."""
        return np.asarray(self.low + (self.high - self.low) * share)


@dataclass(frozen=True, eq=False)
class Fitted:
    """Distribution of a material by what is not known of it, all its parameters together.

    Parameters
    ----------
    material
        A Maxwell model with a spread, that of its fit or of `with_spread`; or the doubts about one by name,
        as `bd.doubts` finds them.

    Raises
    ------
    ValueError
        For a material without spread.
    """

    material: Maxwell | Doubts

    __repr__ = short

    def __post_init__(self) -> None:
        remedy = "it must be a bd.Maxwell with a spread, or bd.doubts of one"
        require(isinstance(self.material, Maxwell | Doubts), "Fitted.material", self.material, remedy)
        assert self.axes > 0

    @property
    def axes(self) -> int:
        """Numbers that a draw takes."""
        return len(self.material if isinstance(self.material, Doubts) else self.material.uncertain().axes)

    def drawn(self, share: Array) -> list[Maxwell]:
        """Materials (n) of shares (n, axes)."""
        from scipy.special import ndtri

        points = share if isinstance(self.material, Doubts) else np.asarray(ndtri(share))
        return [self.material.drawn(point) for point in points]


Distribution: TypeAlias = Normal | LogNormal | Uniform | Fitted


def _normal_share(value: Array, mean: float, sd: float) -> Array:
    from scipy.special import ndtr

    return np.asarray(ndtr((value - mean) / sd))


@dataclass(frozen=True, eq=False)
class Box:
    """The unit box behind parameters with distributions: which of its columns each one takes.

    Parameters
    ----------
    parameters
        Distributions by name; anything else is a constant of every draw.

    Raises
    ------
    ValueError
        Where no parameter has a distribution.
    """

    parameters: Mapping[str, Any]

    def __post_init__(self) -> None:
        remedy = "give a mapping, name -> study.Normal(mean, sd), Uniform, LogNormal, Fitted or a constant"
        good = isinstance(self.parameters, Mapping) and bool(self.columns)
        require(good, "parameters", self.parameters, remedy)

    @property
    def columns(self) -> dict[str, slice]:
        """Columns of the box that each uncertain parameter takes."""
        found, at = {}, 0
        for name, given in self.parameters.items():
            if isinstance(given, Distribution):
                size = given.axes if isinstance(given, Fitted) else 1
                found[name] = slice(at, at + size)
                at += size
        return found

    @property
    def size(self) -> int:
        """Number of columns."""
        return max(int(c.stop) for c in self.columns.values())

    def cases(self, unit: Array) -> list[dict[str, Any]]:
        """Parameters of every draw, of points (n, size) of the box."""
        values: dict[str, Any] = {}
        columns = self.columns
        for name, given in self.parameters.items():
            if name not in columns:
                values[name] = [given] * len(unit)
            elif isinstance(given, Fitted):
                values[name] = given.drawn(unit[:, columns[name]])
            else:
                values[name] = given.quantile(unit[:, columns[name].start]).tolist()
        return [dict(zip(values, one, strict=True)) for one in zip(*values.values(), strict=True)]


def draw(
    n: int, parameters: Mapping[str, Any], *, seed: int = 0, method: str = "sobol"
) -> list[dict[str, Any]]:
    """Draw n times from distributions of parameters, as the cases of a study; the same for one seed.

    Parameters
    ----------
    n
        Number of draws, at least 1.
    parameters
        By name: `Normal`, `LogNormal` or `Uniform` of a number, `Fitted` of a material; anything else is the
        same in every draw.
    seed
        Of the scrambling, or of the random numbers.
    method
        "sobol", a scrambled Sobol sequence, whose means settle sooner (powers of two best); or "random",
        Monte Carlo.

    Returns
    -------
    list[dict[str, Any]]
        Parameters of each draw by name, for `sweep`.

    Raises
    ------
    ValueError
        For n below 1, or where no parameter has a distribution.

    Examples
    --------
    >>> from bearingdyn import study
    >>> draws = study.draw(256, {"clearance": study.Normal(10e-6, 1e-6), "width": 0.016})
    >>> f"{sum(d['clearance'] for d in draws) / 256 * 1e6:.3f} µm", draws[0]["width"]
    ('10.000 µm', 0.016)
    """
    box = Box(parameters)
    return box.cases(uniforms(n, box.size, seed, method))


# ends the message about a draw that cannot be computed
IMPOSSIBLE = "the draw is impossible: narrow the distribution, or cut it with low= and high="


def said_of(drawn: Mapping[str, Any]) -> str:
    """The parameters of a draw from distributions in one line, for messages."""
    return ", ".join(f"{name} = {label(value)}" for name, value in drawn.items())
