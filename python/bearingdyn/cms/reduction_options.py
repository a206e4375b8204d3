"""What a reduction is asked for, checked once for every part: modes up to f_max, damping, moduli, rounds.

One rule gives every part its default of f_max. A part joined at a few places of its surface keeps modes up to
F_MAX: Shaft, Housing, Solid, Imported. A body of revolution keeps none, for its faces are held all round: the
modes of a steel ring held so lie above F_MAX, and in rubber static shapes at several moduli do their work.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from bearingdyn.checks import number, numbers, require
from bearingdyn.plausible_ranges import plausible

F_MAX = 20e3  # Hz, the end of what is heard


def check_f_max(f_max: float, *, may_be_zero: bool = True, may_be_infinite: bool = False) -> None:
    """Check the option f_max of a reduction.

    Parameters
    ----------
    f_max
        Frequency, Hz, up to which modes are kept.
    may_be_zero
        Zero keeps no modes. A part whose mesh follows from f_max allows neither this nor infinity.
    may_be_infinite
        Infinity keeps all modes.

    Raises
    ------
    ValueError
        For a frequency that is not allowed, negative, or not a number.
    """
    f_max = _ordered("f_max", f_max, "it must be a frequency in Hz")
    good = (f_max >= 0 if may_be_zero else f_max > 0) and (may_be_infinite or f_max < math.inf)
    none, every = (
        ", 0 for no modes" if may_be_zero else " above 0",
        ", inf for all" if may_be_infinite else "",
    )
    require(good, "f_max", f_max, f"it must be a frequency in Hz{none}{every}")
    if not may_be_infinite:  # its mesh follows from f_max; of matrices all modes may be asked for
        plausible("band of a part", "f_max", f_max)


def _ordered(field: str, value: Any, remedy: str) -> float:
    """The value as a number, which may be infinite."""
    try:
        return math.inf if value == math.inf else number(field, value, remedy)
    except (TypeError, ValueError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None


def check_damping(damping: float, field: str = "damping") -> None:
    """Check the option damping of a reduction.

    Parameters
    ----------
    damping
        Ratio ζ of every elastic mode.
    field
        Its name in messages.

    Raises
    ------
    ValueError
        Unless 0 <= damping < 1.
    """
    number(field, damping, f"it must be a damping ratio, 0 <= {field} < 1")
    require(0 <= damping < 1, field, damping, f"it must be a damping ratio, 0 <= {field} < 1")


def check_held(held: str | None, interfaces: Iterable[str]) -> None:
    """Check the option held of a reduction.

    Parameters
    ----------
    held
        Name of the interface at which modal damping holds the body; None for a free one.
    interfaces
        Names that there are.

    Raises
    ------
    ValueError
        For an unknown name.
    """
    try:
        known = sorted(interfaces)
    except TypeError:
        raise ValueError(f"interfaces is {interfaces!r}; it must be a mapping of names") from None
    require(held is None or held in known, "held", held, f"the interfaces are {known}")


def check_rounds(inertia: Any) -> None:
    """Check the option inertia of a reduction.

    Parameters
    ----------
    inertia
        Rounds of inertia shapes.

    Raises
    ------
    ValueError
        Unless it is 0, 1, 2, …
    """
    number("inertia", inertia, "it must be a number of rounds: 0, 1, 2, ...")
    good = inertia >= 0 and inertia % 1 == 0
    require(good, "inertia", inertia, "it must be a number of rounds: 0, 1, 2, ...")


def check_moduli(moduli: Sequence[float]) -> tuple[float, ...]:
    """Check the option moduli of a reduction.

    Parameters
    ----------
    moduli
        Shear moduli, Pa, at which shapes are taken.

    Returns
    -------
    tuple of float

    Raises
    ------
    ValueError
        Unless they are one or more positive and finite numbers.
    """
    remedy = "it must hold one or more positive shear moduli, Pa"
    values = tuple(numbers("moduli", moduli, remedy).tolist())
    for value in values:
        if value > 0:
            plausible("shear modulus", "moduli", value)
    good = bool(values) and all(0 < G < math.inf for G in values)
    require(good, "moduli", values, "it must hold one or more positive shear moduli, Pa")
    return values
