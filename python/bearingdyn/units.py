"""Units at the door: plain factors to SI, as in ``30 * mm``; what a quantity of pint is in SI; and results in
other units.

Everything inside is SI. A factor is a number and nothing more: what a slip makes of it, typed twice or left
out, is a number of a wrong magnitude, which the checks of the input refuse by name (`magnitude`).
"""

from __future__ import annotations

import functools
import inspect
import math
import re
from collections.abc import Callable, Mapping
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

import numpy as np

from bearingdyn.checks import meant

if TYPE_CHECKING:
    import xarray

_Made = TypeVar("_Made", bound=Callable[..., Any])

m, cm, mm, um, nm, inch = 1.0, 1e-2, 1e-3, 1e-6, 1e-9, 0.0254
µm = um
kg, g, t = 1.0, 1e-3, 1e3
s, ms, us, minute, hour = 1.0, 1e-3, 1e-6, 60.0, 3600.0
Hz, kHz = 1.0, 1e3
rad, mrad, deg = 1.0, 1e-3, math.pi / 180
rpm = math.pi / 30
N, kN, mN = 1.0, 1e3, 1e-3
Nm, Nmm = 1.0, 1e-3
Pa, kPa, MPa, GPa, bar = 1.0, 1e3, 1e6, 1e9, 1e5
N_mm, N_um, kN_mm = 1e3, 1e6, 1e6
g_mm, kg_mm, kg_mm2 = 1e-6, 1e-3, 1e-6
g_cm3, t_mm3 = 1e3, 1e12
W, kW = 1.0, 1e3
cSt, cP, mPa_s = 1e-6, 1e-3, 1e-3
g_n = 9.80665

FACTORS = {
    "length, m": ("m", "cm", "mm", "um", "µm", "nm", "inch"),
    "mass, kg": ("kg", "g", "t"),
    "time, s": ("s", "ms", "us", "minute", "hour"),
    "frequency, Hz": ("Hz", "kHz"),
    "angle, rad": ("rad", "mrad", "deg"),
    "speed, rad/s": ("rpm",),
    "force, N": ("N", "kN", "mN"),
    "moment, N m": ("Nm", "Nmm"),
    "stress, Pa": ("Pa", "kPa", "MPa", "GPa", "bar"),
    "stiffness, N/m": ("N_mm", "N_um", "kN_mm"),
    "unbalance, kg m": ("g_mm", "kg_mm"),
    "inertia, kg m²": ("kg_mm2",),
    "density, kg/m³": ("g_cm3", "t_mm3"),
    "power, W": ("W", "kW"),
    "kinematic viscosity, m²/s": ("cSt",),
    "viscosity, Pa s": ("cP", "mPa_s"),
    "acceleration, m/s²": ("g_n",),
}
"""The factors, by what they are of and its unit in SI."""

__all__ = ["FACTORS", "Unit", "display", "read", "si", "takes"]

# exponents of kg, m, s, K, rad: an angle is a dimension of its own, so that rad/s is no Hz
_Exponents = tuple[float, ...]
_ROOTS: dict[str, tuple[float, _Exponents]] = {
    "m": (1.0, (0, 1, 0, 0, 0)),
    "g": (1e-3, (1, 0, 0, 0, 0)),
    "s": (1.0, (0, 0, 1, 0, 0)),
    "K": (1.0, (0, 0, 0, 1, 0)),
    "rad": (1.0, (0, 0, 0, 0, 1)),
    "N": (1.0, (1, 1, -2, 0, 0)),
    "Pa": (1.0, (1, -1, -2, 0, 0)),
    "J": (1.0, (1, 2, -2, 0, 0)),
    "W": (1.0, (1, 2, -3, 0, 0)),
    "Hz": (1.0, (0, 0, -1, 0, 0)),
    "St": (1e-4, (0, 2, -1, 0, 0)),
    "P": (0.1, (1, -1, -1, 0, 0)),
}
_OTHERS: dict[str, tuple[float, _Exponents]] = {
    "°": (deg, (0, 0, 0, 0, 1)),
    "deg": (deg, (0, 0, 0, 0, 1)),
    "cSt": (1e-6, (0, 2, -1, 0, 0)),
    "rpm": (rpm, (0, 0, -1, 0, 1)),
    "min": (60.0, (0, 0, 1, 0, 0)),
    "h": (3600.0, (0, 0, 1, 0, 0)),
    "t": (1e3, (1, 0, 0, 0, 0)),
    "bar": (1e5, (1, -1, -2, 0, 0)),
    "in": (0.0254, (0, 1, 0, 0, 0)),
    "inch": (0.0254, (0, 1, 0, 0, 0)),
    "%": (1e-2, (0, 0, 0, 0, 0)),
    "g_n": (g_n, (0, 1, -2, 0, 0)),
}
_PREFIXES = {"p": 1e-12, "n": 1e-9, "u": 1e-6, "µ": 1e-6, "μ": 1e-6, "m": 1e-3, "c": 1e-2}
_PREFIXES |= {"k": 1e3, "M": 1e6, "G": 1e9}
_RAISED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_TOKEN = re.compile(
    r"\s*(?:(?P<name>[^\W\d]+|°|%|1(?!\d))(?:(?:\^|\*\*)?(?P<power>-?\d+(?:\.\d+)?))?|(?P<sign>[/()]|·|\*(?!\*)))"
)
CELSIUS, KELVIN = "°C", 273.15


class Unit(NamedTuple):
    """A unit: its factor to SI and its exponents of kg, m, s, K and rad."""

    factor: float
    exponents: _Exponents

    def alike(self, other: Unit) -> bool:
        """Whether both measure the same."""
        return self.exponents == other.exponents


def read(text: str) -> Unit:
    """The unit that a text names, as "mm", "N/µm", "kg m²", "N m s/rad", "1/K"; "" is the number one.

    What stands behind a stroke divides: its next factor, or all of them in parentheses.

    Raises
    ------
    ValueError
        For a text that names no unit.

    Examples
    --------
    >>> from bearingdyn import units
    >>> units.read("N/µm").factor, units.read("rpm").alike(units.read("Hz"))
    (1000000.0, False)
    """
    if text.strip()[-1:] in ("*", "·"):
        raise ValueError(f"unit is {text!r}; something must stand behind its last sign")
    written = re.sub(r"([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", lambda found: "^" + found[0].translate(_RAISED), text.strip())
    at, levels, below = 0, [(1.0, np.zeros(5), 1)], False
    while at < len(written):
        found = _TOKEN.match(written, at)
        if not found:
            raise ValueError(f"unit is {text!r}; it must be one such as mm, N/µm, kg m², rpm, °C or 1/K")
        at = found.end()
        factor, exponents, sign = levels[-1]
        if found["sign"] == "/":
            if below:
                break
            below = True
        elif found["sign"] == "(":
            levels.append((1.0, np.zeros(5), -1 if below else 1))
            below = False
        elif found["sign"] == ")":
            if len(levels) == 1:
                break
            levels.pop()
            outer, theirs, own = levels[-1]
            levels[-1] = (outer * factor**sign, theirs + sign * exponents, own)
        elif found["name"]:
            power = float(found["power"] or 1) * (-1 if below else 1)
            size, dims = _root(found["name"], text)
            levels[-1] = (factor * size**power, exponents + power * np.array(dims, dtype=float), sign)
            below = False
    if len(levels) != 1 or below or at != len(written) or written.count("(") != written.count(")"):
        raise ValueError(f"unit is {text!r}; its parentheses or strokes do not close")
    return Unit(levels[0][0], tuple(float(x) for x in levels[0][1]))


def _root(name: str, text: str) -> tuple[float, _Exponents]:
    if name == "1":
        return 1.0, (0, 0, 0, 0, 0)
    for known in (_ROOTS, _OTHERS):
        if name in known:
            return known[name]
    if len(name) > 1 and name[0] in _PREFIXES and name[1:] in _ROOTS:
        factor, dims = _ROOTS[name[1:]]
        return _PREFIXES[name[0]] * factor, dims
    raise ValueError(f"unit is {text!r}; {name!r} is none: {meant(name, [*_ROOTS, *_OTHERS, 'mm', 'MPa'])}")


def si(field: str, value: Any, unit: str | tuple[str, ...]) -> Any:
    """A value in units of SI: what is no quantity of pint stays as it is.

    Parameters
    ----------
    field
        Name of the input, for the message.
    value
        A number, an array, or a sequence or mapping of these; a quantity of pint anywhere in it is converted.
    unit
        In which the number is wanted; of each entry, where there are several.

    Raises
    ------
    ValueError
        For a quantity of something else.
    """
    if value is None or isinstance(value, str | int | float | np.ndarray | np.generic):
        return value
    if isinstance(value, Decimal | Fraction):  # which do not go with floats, or not into a format
        try:
            return float(value)
        except OverflowError:
            return value
    if hasattr(value, "dimensionality") and hasattr(value, "magnitude"):
        if isinstance(unit, str):
            return _of_pint(field, value, unit)
        if len(set(unit)) == 1:
            return _of_pint(field, value, unit[0])
        raise ValueError(f"{field} is {value}; give its entries one by one, in {', '.join(unit)}")
    if isinstance(value, list | tuple):
        own = unit if isinstance(unit, tuple) and len(unit) == len(value) else (unit,) * len(value)
        found = [si(f"{field}[{k}]", x, u) for k, (x, u) in enumerate(zip(value, own, strict=True))]
        same = all(a is b for a, b in zip(found, value, strict=True))
        return value if same else type(value)(found) if type(value) in (list, tuple) else found
    if isinstance(value, Mapping):
        moved = {k: si(f"{field}[{k!r}]", x, unit) for k, x in value.items()}
        return value if all(moved[k] is x for k, x in value.items()) else moved
    return value


def _of_pint(field: str, value: Any, unit: str) -> Any:
    """The magnitude of a pint quantity in a unit; angles and cycles are kept apart, which pint does not."""
    told = str(value.units)
    cycles = "hertz" in told or "count" in told
    if ("rad" in unit and cycles) or (unit == "Hz" and re.search("radian|revolution|turn|degree", told)):
        raise ValueError(
            f"{field} is {value}; it must be in {unit}, and 1 Hz is 2π rad/s: say which you mean"
        )
    written = unit.replace(CELSIUS, "degC").replace("²", "**2").replace("³", "**3").replace(" ", "*")
    try:
        return value.to(written or "dimensionless").magnitude
    except Exception as error:  # pint's own, which is not imported here
        if not type(error).__module__.startswith("pint"):
            raise
        raise ValueError(f"{field} is {value}; it must be in {unit or 'no unit'}") from None


def takes(**wanted: str | tuple[str, ...]) -> Callable[[_Made], _Made]:
    """Let a function or class take quantities of pint too: says in which unit each argument is wanted.

    Put above `@dataclass`. The units stand in `__units__`, for who reads models or shows them.
    """

    def wrap(made: _Made) -> _Made:
        if isinstance(made, type):
            setattr(made, "__init__", _converting(getattr(made, "__init__"), wanted))  # noqa: B009, B010
            setattr(made, "__units__", dict(wanted))  # noqa: B010
            return made
        return cast(_Made, _converting(made, wanted))

    return wrap


def _converting(
    function: Callable[..., Any], wanted: Mapping[str, str | tuple[str, ...]]
) -> Callable[..., Any]:
    order = list(inspect.signature(function).parameters)
    unknown = set(wanted) - set(order)
    if unknown:
        raise TypeError(f"{function.__qualname__} has no parameters {sorted(unknown)}")
    at = [(order.index(name), name, unit) for name, unit in wanted.items()]

    @functools.wraps(function)
    def convert(*args: Any, **kwargs: Any) -> Any:
        given = args
        for k, name, unit in at:
            if name in kwargs:
                kwargs[name] = si(name, kwargs[name], unit)
            elif k < len(given):
                value = si(name, given[k], unit)
                if value is not given[k]:
                    given = (*given[:k], value, *given[k + 1 :])
        return function(*given, **kwargs)

    return convert


PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
# units that take a prefix, to the first power, at the head of a compound; a long time stays in seconds
_PREFIXED = re.compile(r"^(\(?)(m|N|Pa|W|J|Hz|rad|s)(?=$|[/ )])")


def suited(largest: float, unit: str) -> tuple[int, str, bool]:
    """The multiple of a unit that suits values: power of ten, the unit with its prefix, and if it takes one.

    Parameters
    ----------
    largest
        Size of the largest value, in `unit`.
    unit
        As results have it, such as "m/N"; one that takes no prefix is returned as it is.
    """
    head = _PREFIXED.match(unit)
    least, most = (1.0, 1e4) if head else (1e-2, 1e5)
    known = 0.0 < largest < math.inf
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-9) if known and not least <= largest < most else 0
    if not head:
        return power, unit, False
    power = min(max(power, min(PREFIXES)), 0 if head[2] == "s" else max(PREFIXES))
    return power, f"{head[1]}{PREFIXES[power]}{unit[head.end(1) :]}", True


def display(result: xarray.Dataset, *wanted: str) -> xarray.Dataset:
    """Units for display: a result in others, such as "µm", "rpm", "kN", a copy for tables and figures.

    Variables and coordinates that measure what a unit measures are converted, the channels of a march each by
    its own; all else stays as it is. The package's own functions take results in SI only.

    Parameters
    ----------
    result
        Of any analysis.
    wanted
        Units.

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    ValueError
        For a text that is no unit, two units of the same, or one that nothing in the result has.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> response = bd.frequency_response(app, [50.0], ["mass.centre.y"], ["mass.centre.y"])
    >>> shown = bd.units.display(response, "µm/N", "kHz")
    >>> print(f"{abs(shown['response'].item()):.2f} {shown['response'].attrs['units']}")
    1.25 µm/N
    """
    units = {text: read(text) for text in wanted}
    by_kind: dict[_Exponents, str] = {}
    for text, unit in units.items():
        if unit.exponents in by_kind:
            raise ValueError(f"wanted has {by_kind[unit.exponents]!r} and {text!r} of the same; give one")
        by_kind[unit.exponents] = text
    used: set[str] = set()

    def change(known: str) -> tuple[float, str]:
        """Factor and new text of a unit; (1, the same) where none is wanted of it."""
        try:
            own = read(known)
        except ValueError:  # "m, rad": several at once
            return 1.0, known
        text = by_kind.get(own.exponents)
        if text is None or not known or known == "1":
            return 1.0, known
        used.add(text)
        return own.factor / units[text].factor, text

    shown = result.copy()
    for name in list(shown.variables):
        variable = shown[name]
        if variable.dtype.kind not in "fc":
            continue
        factor, text = change(str(variable.attrs.get("units", "")))
        if factor != 1.0 or text != variable.attrs.get("units", ""):
            attrs = {**variable.attrs, "units": text}
            if name in shown.coords:
                shown = shown.assign_coords({name: (variable.dims, factor * variable.values, attrs)})
            else:
                shown[name] = (variable.dims, factor * variable.values, attrs)
    if "unit" in shown.coords and "record" in shown:
        pairs = [change(str(each)) for each in shown["unit"].values]
        record = shown["record"]
        shown["record"] = (record.dims, record.values * np.array([p[0] for p in pairs]), record.attrs)
        shown = shown.assign_coords(unit=("channel", [p[1] for p in pairs], shown["unit"].attrs))
    idle = [text for text in wanted if text not in used]
    if idle:
        raise ValueError(f"wanted has {idle[0]!r}; nothing in this result is measured so")
    return shown
