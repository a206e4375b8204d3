"""Checks of input that name the field, the value and the remedy; NaN fails every one of them."""

from __future__ import annotations

import difflib
import math
import os
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.types import Array

_NO_NUMBERS = (str, bytes, bool, np.bool_)


def require(ok: bool, field: str, value: object, remedy: str) -> None:
    """Check a condition: raise a ValueError naming field, value and remedy unless `ok`."""
    if not ok:
        raise ValueError(f"{field} is {value!r}; {remedy}")


def number(field: str, value: object, remedy: str = "give one finite number") -> float:
    """Check a number: the value as a finite float; ValueError if it is anything else."""
    # True is no length, and an array of one entry no number
    try:
        # nor is a complex number, of which NumPy's own would lose the imaginary part
        other = isinstance(value, _NO_NUMBERS) or np.ndim(value) > 0 or np.iscomplexobj(value)  # type: ignore[arg-type]
        x = math.nan if other else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None
    require(math.isfinite(x), field, value, remedy)
    return x


def positive(field: str, value: object, remedy: str = "it must be positive and finite") -> float:
    """Check a positive number: the value as a float > 0; ValueError if it is anything else."""
    x = number(field, value, remedy)
    require(x > 0, field, value, remedy)
    return x


def nonnegative(field: str, value: object, remedy: str = "it must be zero or positive, and finite") -> float:
    """Check a number that is zero or more: the value as a float ≥ 0; ValueError if it is anything else."""
    x = number(field, value, remedy)
    require(x >= 0, field, value, remedy)
    return x


def numbers(field: str, value: ArrayLike, remedy: str, least: float = -math.inf) -> Array:
    """Check one or more finite numbers ≥ `least`, as an array (n,); ValueError if they are anything else."""
    try:
        x = np.atleast_1d(real(value))
    except (TypeError, ValueError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None
    require(x.ndim == 1 and x.size > 0, field, value, remedy)
    require(bool(np.isfinite(x).all() and (x >= least).all()), field, value, remedy)
    return x


def real(value: ArrayLike) -> Array:
    """Check real numbers, as a new array; TypeError or ValueError for text, bools, None and ragged lists."""
    found = np.asarray(value)
    if found.dtype.kind not in "iuf" and found.size:
        # numbers of another kind, as Fraction, come as objects
        if found.dtype.kind != "O" or any(isinstance(x, str | bool) or x is None for x in found.flat):
            raise TypeError(f"{found.dtype} are no real numbers")
    try:
        return np.array(found, dtype=np.float64)
    except OverflowError as error:
        raise ValueError(str(error)) from None


def reals(field: str, value: ArrayLike, remedy: str) -> Array:
    """Check real numbers of any shape, finite or not, as a new array; ValueError for anything else."""
    try:
        return real(value)
    except (TypeError, ValueError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None


def indices(field: str, value: ArrayLike, remedy: str) -> NDArray[np.intp]:
    """Check whole numbers of any shape, as a new array; ValueError for anything else."""
    try:
        x = np.asarray(value)
        if x.dtype.kind not in "iu":
            x = real(value)
            require(bool((x % 1 == 0).all()) and bool((np.abs(x) < 2**53).all()), field, value, remedy)
        return np.array(x, dtype=np.intp)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None


def vector(field: str, value: ArrayLike, shape: Sequence[int], meaning: str) -> Array:
    """Check a vector: a finite float array of the given shape; ValueError if it is anything else."""
    try:
        x = real(value)
    except (TypeError, ValueError):
        raise ValueError(f"{field} is {value!r}; it must be real numbers, {meaning}") from None
    require(
        x.shape == tuple(shape), field, value, f"its shape is {x.shape}, it must be {tuple(shape)}: {meaning}"
    )
    require(bool(np.isfinite(x).all()), field, value, f"all entries must be finite: {meaning}")
    return x


def two(field: str, value: object, remedy: str) -> tuple[float, float]:
    """Check two numbers of any size, as floats; ValueError for anything else."""
    try:
        low, high = (x if isinstance(x, float) else _no_text(x) for x in value)  # type: ignore[attr-defined]
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{field} is {value!r}; {remedy}") from None
    return low, high


def _no_text(value: Any) -> float:
    """A number as a float; TypeError for a text and a truth, which `float` would take."""
    if isinstance(value, str | bytes | bool | np.bool_):
        raise TypeError(f"{value!r} is no number")
    return float(value)


def name_list(field: str, value: object, what: str = "channels", least: int = 0) -> list[str]:
    """Check a list of names; ValueError for one name alone, too few, one twice, or what is no text."""
    if isinstance(value, str):
        raise ValueError(f"{field} is {value!r}; give a list of {what}, [{value!r}]")
    try:
        found = list(value)  # type: ignore[call-overload]
    except TypeError:
        found = [None]
    wrong = next((name for name in found if not isinstance(name, str)), "")
    remedy = f"it must be a list of {what}, each a text"
    require(isinstance(wrong, str), field, value, remedy)
    twice = next((name for i, name in enumerate(found) if name in found[:i]), None)
    require(twice is None, field, value, f"it names {twice!r} twice; name each once")
    require(len(found) >= least, field, value, f"it must be a list of {what}, of at least {least}")
    return [str(name) for name in found]


def items(field: str, value: object, remedy: str) -> list[Any]:
    """Check a list, tuple or array, as a list; ValueError for a text, a mapping and what has no entries."""
    try:
        require(not isinstance(value, str | bytes | Mapping), field, value, remedy)
        return list(value)  # type: ignore[call-overload, no-any-return]
    except TypeError:
        raise ValueError(f"{field} is {value!r}; {remedy}") from None


def instance(field: str, value: object, kinds: type | tuple[type, ...], remedy: str) -> None:
    """Check that the value is an instance of one of the kinds, else raise ValueError."""
    require(isinstance(value, kinds), field, value, remedy)


def truth(field: str, value: object) -> bool:
    """Check a truth: True or False, or 1 or 0; ValueError for anything else."""
    good = isinstance(value, bool | np.bool_) or (isinstance(value, int) and value in (0, 1))
    require(good, field, value, "it must be True or False")
    return bool(value)


def named(field: str, value: object, remedy: str) -> dict[str, Any]:
    """Check a mapping with names as keys, as a dict; ValueError for anything else."""
    require(isinstance(value, Mapping), field, value, remedy)
    found = dict(cast(Mapping[str, Any], value))
    require(all(isinstance(name, str) and name for name in found), field, value, remedy)
    return found


def whole(field: str, value: object, least: int, most: int | None = None, remedy: str = "") -> int:
    """Check a whole number in least … most; ValueError if it is anything else."""
    limit = f"of at least {least}" if most is None else f"in {least}...{most}"
    remedy = remedy or f"it must be a whole number {limit}"
    x = number(field, value, remedy)
    require(x % 1 == 0 and x >= least and (most is None or x <= most), field, value, remedy)
    return int(value)  # type: ignore[call-overload, no-any-return]


def meant(name: str, known: Collection[str]) -> str:
    """The end of a check's message that a name is not known: the nearest that is, and all there are."""
    near = difflib.get_close_matches(name, known, n=1)
    return (f"did you mean {near[0]!r}? " if near else "") + f"there are {sorted(known)}"


def existing(path: str | os.PathLike[str], what: str = "file") -> Path:
    """Check that a file is there: its path.

    Raises
    ------
    FileNotFoundError
        Where nothing is there: every reader of this package says it so.
    IsADirectoryError
        Where a folder is.
    ValueError
        Where a device or a pipe is, and for what is no path.
    """
    require(isinstance(path, str | os.PathLike), f"the path of a {what}", path, "give a text or a Path")
    p = Path(path)
    try:
        p.stat()
    except FileNotFoundError:
        pass
    except OSError as error:  # a name too long, a folder that may not be entered
        text = f"cannot be read ({error.strerror}); give the path of a {what}"
        raise OSError(error.errno, text, str(p)) from None
    except ValueError:
        raise ValueError(f"{str(p)!r} holds a NUL; give the path of a {what}") from None
    if p.is_dir():
        raise IsADirectoryError(f"{p} is a folder; give the path of a {what}")
    if not p.exists():
        raise FileNotFoundError(f"{p}: no such file; give the path of a {what}")
    if not p.is_file():
        raise ValueError(f"{p} is not a file; give the path of a {what}")
    return p


def one_of(field: str, value: object, choices: Sequence[object]) -> None:
    """Check that the value is one of the choices, else raise ValueError."""
    require(
        isinstance(value, str | int | float | None) and value in choices,
        field,
        value,
        f"it must be {' or '.join(repr(c) for c in choices)}",
    )


def one_speed(speed: Any, rpm: Any, default: float | None = None, what: str = "speed") -> Any:
    """Check two arguments of which one must be given: `speed` in rad/s, or `rpm`.

    Parameters
    ----------
    speed, rpm
        A number, several, or (times in s, speeds); None where it is not given.
    default
        rad/s, where neither is; None where one must be.
    what
        Name of the argument in rad/s.

    Returns
    -------
    Any
        In rad/s, as it was given.

    Raises
    ------
    ValueError
        For both, for none, and for an `rpm` that is no number.
    """
    if rpm is None:
        remedy = "give it in rad/s, or rpm= in revolutions a minute"
        require(speed is not None or default is not None, what, speed, remedy)
        return default if speed is None else speed
    if speed is not None:
        raise ValueError(f"rpm is {rpm!r}; it must be left out, as {what} is given too: give one of them")
    remedy = "it must be finite, in revolutions a minute"
    try:
        profile = isinstance(rpm, tuple) and len(rpm) == 2 and np.ndim(rpm[1]) > 0
        several = np.ndim(rpm) > 0
    except (TypeError, ValueError):  # of what NumPy makes no array, such as a Dataset
        raise ValueError(f"rpm is {rpm!r}; {remedy}") from None
    if profile:
        return rpm[0], numbers("rpm", rpm[1], remedy) * (math.pi / 30)
    return (numbers if several else number)("rpm", rpm, remedy) * (math.pi / 30)
