"""Warnings where an answer goes beyond the times or the frequencies that a material's data speak of."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from bearingdyn.material.low_end import SLACK, LowEnd
from bearingdyn.notice import BeyondData, OutsideBand, warn
from bearingdyn.types import Array, Complex


def warn_beyond(layers: Iterable[tuple[str, Any]], after: float, what: str, first: str = "") -> None:
    """Warn of materials whose data do not reach the time at which they are asked.

    Parameters
    ----------
    layers
        Name and material of each.
    after
        The time, s; inf: relaxed.
    what
        What rests on it.
    first
        The first remedy.

    Warns
    -----
    BeyondData
        Once for each call: it names all layers, and gives the numbers of the first.
    OutsideBand
        For a time before those that the band speaks of.
    """
    layers = list(layers)
    for name, material in layers:
        warn_before(material, after, f"{what} of {name}")
    found = [
        (name, material)
        for name, material in layers
        if (end := getattr(material, "low_end", None)) is not None and not end.covers(after)
    ]
    if not found:
        return
    material = found[0][1]
    warn(
        f"{what} of {', '.join(dict.fromkeys(name for name, _ in found))} leaves the data: "
        f"{_numbers(material, after)}; {first}fit from a lower frequency, pin the low end by "
        f"fit_maxwell(pin=...), or measure longer or warmer",
        BeyondData,
    )


def answer_of(law: Any, omega: Any) -> Complex:
    """G*(ω) of a law, Pa, ω rad/s of any shape, for an analysis that itself tells of rest beyond the data."""
    if hasattr(law, "low_end"):
        return np.asarray(law.complex_modulus(omega, doubt=False))
    return np.asarray(law.complex_modulus(omega))


def warn_before(material: Any, time: float, what: str) -> None:
    """Warn of a material asked at a time, s, before its data and band begin; zero asks by name for the limit.

    Parameters
    ----------
    material, time, what
        As in `warn_beyond`.

    Warns
    -----
    OutsideBand
        As a point at ω speaks of the time 1/ω, before that of the highest frequency.
    """
    band = getattr(material, "band", None)
    if band is not None and 0 < 2 * math.pi * band[1] * time < 1 / SLACK:
        warn(
            f"{what} is asked after {time:.3g} s, before {1 / (2 * math.pi * band[1]):.3g} s, of which the "
            f"highest frequency of the Maxwell model's band, {band[1]:.4g} Hz, speaks: there it extrapolates",
            OutsideBand,
        )


@contextmanager
def band_told_once(laws: Iterable[Any], omega: Array) -> Iterator[None]:
    """Warn once of laws asked beyond the band of their data, at ω (any shape), rad/s; not again within.

    Parameters
    ----------
    laws
        Complex moduli; one that stands several times is told once.
    omega
        All angular frequencies at which they will be asked, or the ends of their range.

    Warns
    -----
    OutsideBand
        Once for each law, with the whole range.
    """
    for law in {id(law): law for law in laws}.values():
        answer_of(law, omega)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", OutsideBand)
        yield


def _numbers(material: Any, after: float) -> str:
    """The value, what the data reach, and the interval."""
    end: LowEnd = material.low_end
    value = (
        float(answer_of(material, 0.0).real)
        if math.isinf(after)
        else float(material.relaxation(after, doubt=False))
    )
    low, high = end.bounds(after, value)
    state = "relaxed" if math.isinf(after) else f"after {after:.3g} s"
    at = "" if material.temperature is None else f" at {material.temperature:g} °C"
    falls = f", where G′ still falls {end.fall:.0%} a decade" if math.isfinite(end.fall) else ""
    longer = ""
    if end.measured < end.frequency / SLACK:
        longer = f" (the master curve reaches {1 / (2 * math.pi * end.measured):.3g} s)"
    return (
        f"{state} G = {value / 1e6:.3g} MPa, fitted to data that reach {end.reach:.3g} s, "
        f"{end.frequency:.3g} Hz{at}{falls}{longer}; they allow {low / 1e6:.3g} to {high / 1e6:.3g} MPa"
    )
