"""Columns of an instrument's table: which quantity a title stands for, in which unit."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

_FREQUENCY = {"hz": 1.0, "1/s": 1.0, "s^-1": 1.0, "khz": 1e3, "mhz": 1e-3, "rad/s": 1 / (2 * math.pi)}
_PRESSURE = {
    "pa": 1.0,
    "kpa": 1e3,
    "mpa": 1e6,
    "gpa": 1e9,
    "n/mm2": 1e6,
    "n/mm²": 1e6,
    "n/m2": 1.0,
    "n/m²": 1.0,
}
_TEMPERATURE = {"c": 0.0, "°c": 0.0, "degc": 0.0, "deg c": 0.0, "ºc": 0.0, "˚c": 0.0, "k": -273.15}
_ANGLE = {"rad": 1.0, "°": math.pi / 180, "deg": math.pi / 180, "º": math.pi / 180, "˚": math.pi / 180}
_NONE = {"": 1.0, "-": 1.0, "1": 1.0, "[]": 1.0}

UNITS: dict[str, dict[str, float]] = {
    "frequency": _FREQUENCY,
    "angular": _FREQUENCY,
    "temperature": _TEMPERATURE,
    "storage": _PRESSURE,
    "loss": _PRESSURE,
    "complex": _PRESSURE,
    "tan_delta": _NONE,
    "phase": _ANGLE,
}
"""Factors to SI (to Hz; temperatures: the sum to °C) by quantity and unit in small letters."""

MODULI = (
    ("storage", "loss"),
    ("storage", "tan_delta"),
    ("complex", "phase"),
    ("complex", "tan_delta"),
    ("storage", "phase"),
)
"""Pairs a complex modulus can be made of, the best first."""

_ENDING = re.compile(
    r"(?:[\s_,/]+|^)("
    + "|".join(
        re.escape(u) for u in sorted({*_FREQUENCY, *_PRESSURE, *_TEMPERATURE, *_ANGLE}, key=len, reverse=True)
    )
    + r")$",
    re.IGNORECASE,
)
_STORAGE = re.compile(r"^(?P<letter>[GE])?\s*(?:'|1|p|prime|stor|storage)(?:\s+modulus)?$", re.IGNORECASE)
_LOSS = re.compile(r"^(?P<letter>[GE])?\s*(?:\"|2|pp|double prime|loss)(?:\s+modulus)?$", re.IGNORECASE)
_COMPLEX = re.compile(r"^(?P<letter>[GE])?\s*(?:\*|abs|complex|star)(?:\s+modulus)?$", re.IGNORECASE)
_KIND = re.compile(r"\b(shear|tensile|tension|young's)\b\s*", re.IGNORECASE)
_SHEAR_SIGNS = re.compile(r"shear|torque|parallel plate|plate-plate|cone|couette|torsion", re.IGNORECASE)


@dataclass(frozen=True)
class Column:
    """A recognised column; letter G or E of its modulus, if it says."""

    index: int
    title: str
    unit: str
    letter: str


def title_of(cell: str) -> tuple[str, str]:
    """Name and unit of a header cell."""
    text = cell.strip().strip('"') if cell.count('"') == 2 else cell.strip()
    text = re.sub("[’′´`]", "'", re.sub("[″”“]", '"', text)).replace("''", '"')
    bracket = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", text)
    if bracket and bracket.start() > 0 and bracket.group(1).strip().lower() not in ("δ", "delta", "d"):
        return text[: bracket.start()].strip(), bracket.group(1).strip()
    ending = _ENDING.search(text)
    if ending and ending.start() > 0:
        return text[: ending.start()].strip(), ending.group(1)
    return text, ""


def quantity_of(name: str) -> tuple[str, str] | None:
    """Quantity a column's name stands for, and the letter G or E of its modulus."""
    words = re.sub(r"[\s_\-]+", " ", name).strip()
    low = words.lower()
    if words == "f" or low in ("freq", "frequency"):
        return "frequency", ""
    if words in ("ω", "w") or low in ("angular frequency", "ang frequency", "ang. frequency", "omega"):
        return "angular", ""
    if words in ("T", "Ts") or low in ("temp", "temp.", "temperature", "sample temperature"):
        return "temperature", ""
    if words == "Tr" or low in (
        "set",
        "t nominal",
        "nominal temperature",
        "t set",
        "set temperature",
        "isotherm",
    ):
        return "isotherm", ""
    if re.sub(r"[\s().]", "", low) in ("tandelta", "tanδ", "tand", "lossfactor"):
        return "tan_delta", ""
    if low in ("phase", "phase angle", "δ", "delta", "loss angle"):
        return "phase", ""
    kind = _KIND.search(words)
    words = _KIND.sub("", words).strip().strip("|")
    for quantity, pattern in (("storage", _STORAGE), ("loss", _LOSS), ("complex", _COMPLEX)):
        match = pattern.match(words)
        if match:
            letter = (match.group("letter") or "").upper()
            if not letter and kind:
                letter = "G" if kind.group(1).lower() == "shear" else "E"
            if letter or "modulus" in low or low in ("storage", "loss"):
                return quantity, letter
    return None


def columns_of(
    cells: Sequence[str], wanted: Mapping[str, str]
) -> tuple[dict[str, Column], list[tuple[str, str, str]]]:
    """Recognised columns of a row taken for a header, and those that are two of a kind."""
    found: dict[str, Column] = {}
    doubles: list[tuple[str, str, str]] = []
    for index, cell in enumerate(cells):
        name, unit = title_of(cell)
        named = next((q for q, title in wanted.items() if title in (cell.strip(), name)), None)
        recognised = quantity_of(name)
        if named is not None:
            letter = recognised[1] if recognised and recognised[0] == named else ""
        elif recognised is None or recognised[0] in wanted:
            continue
        else:
            named, letter = recognised
        if named == "frequency" and unit.lower() == "rad/s" and named not in wanted:
            named = "angular"
        if named in found and named in UNITS:
            doubles.append((named, found[named].title, cell.strip()))
        found.setdefault(named, Column(index, cell.strip(), unit, letter))
    if wanted.get("frequency"):
        found.pop("angular", None)
    return found, doubles


def choose(columns: Mapping[str, Column]) -> tuple[str, str, str] | None:
    """Frequency and the pair of moduli a header offers, None if it is not a header."""
    frequency = next((q for q in ("frequency", "angular") if q in columns), None)
    pair = next((p for p in MODULI if set(p) <= columns.keys()), None)
    return None if frequency is None or pair is None else (frequency, *pair)


def names_shear(text: str) -> bool:
    """Whether a text speaks of shear: torque, plates, a cone."""
    return bool(_SHEAR_SIGNS.search(text))


def number_of(cell: str) -> float:
    """Number in a cell, decimal comma or point; ValueError if there is none."""
    text = cell.strip().strip('"')
    if "," in text and "." not in text:
        text = text.replace(",", ".")
    if "_" in text:
        raise ValueError(cell)
    return float(text)


def is_number(cell: str) -> bool:
    """Whether a cell holds a number."""
    try:
        number_of(cell)
    except ValueError:
        return False
    return True
