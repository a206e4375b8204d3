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
_TIME = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}
_STRAIN = {"%": 1e-2, "-": 1.0, "": 1.0, "1": 1.0, "m/m": 1.0, "mm/mm": 1.0}

UNITS: dict[str, dict[str, float]] = {
    "frequency": _FREQUENCY,
    "angular": _FREQUENCY,
    "temperature": _TEMPERATURE,
    "storage": _PRESSURE,
    "loss": _PRESSURE,
    "complex": _PRESSURE,
    "tan_delta": _NONE,
    "phase": _ANGLE,
    "time": _TIME,
    "relaxation": _PRESSURE,
    "strain": _STRAIN,
}
"""Factors to SI (to Hz; temperatures: the sum to °C) by quantity and unit in small letters."""

LABELS = ("isotherm", "run")
"""Quantities that label a point and have no unit."""

RELAXATION = ("time", "relaxation")
"""What a table of stress relaxation is made of."""

UNIT_WORDS = {unit for table in UNITS.values() for unit in table} - {"", "s", "h", "k", "c", "min"}
"""Units that no column is named by."""

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
_TIME_ENDING = re.compile(r"^(t|time|zeit)(?:[\s_,/]+| in )(s|sec|ms|min|h)$", re.IGNORECASE)
_NUMERIC = re.compile(r"\s*[-+−]?[.,]?\d")
LONGEST_TITLE = 120
_GERMAN = (
    (r"(mess|prüf|anregungs|reduzierte )?frequenz", "frequency"),
    (r"(kreis|winkel)frequency", "angular frequency"),
    (r"soll-?temperatur", "set temperature"),
    (r"(proben|prüf|mess|ist)?-?temperatur\b", "temperature"),
    (r"schub-?speicher-?modul", "shear storage modulus"),
    (r"schub-?verlust-?modul", "shear loss modulus"),
    (r"(dehn|zug)-?speicher-?modul", "tensile storage modulus"),
    (r"(dehn|zug)-?verlust-?modul", "tensile loss modulus"),
    (r"speicher-?(schub)?-?modul", "storage modulus"),
    (r"verlust-?(schub)?-?modul", "loss modulus"),
    (r"(verlust|dämpfungs)-?faktor", "loss factor"),
    (r"komplexe[rs]? schubmodul", "complex shear modulus"),
    (r"komplexe[rs]? (e-)?modul", "complex modulus"),
    (r"(phasen|verlust)-?winkel|phasenverschiebung", "phase angle"),
    (r"(schub)?relaxations-?modul", "relaxation modulus"),
    (r"\bzeit\b", "time"),
    (r"(scher|schub)-?(deformation|verformung|dehnung)|dehnung|deformation", "strain"),
    (r"\b(versuch|messung|lauf|probe|probenname)(\s*(nr\.?|nummer))?$", "run"),
)
_IS_GERMAN = re.compile(
    r"frequenz|temperatur\b|modul\b|faktor|winkel|verschiebung|zeit|dehnung|formation|formung|versuch|messung"
    r"|lauf|probe",
    re.IGNORECASE,
)
_SYMBOL = re.compile(r"[\s,:(\[-]*(\|?[GE]\s?['\"*]?\|?)[)\]]?$")
_RELAXED = re.compile(
    r"^(?P<letter>[GE])?\s*(?:\(t\)|relax|rel|relaxation|r)?(?:\s+modulus)?(?:\s*\(t\))?$", re.IGNORECASE
)
_STORAGE = re.compile(r"^(?P<letter>[GE])?\s*(?:'|1|p|prime|stor|storage)(?:\s+modulus)?$", re.IGNORECASE)
_LOSS = re.compile(r"^(?P<letter>[GE])?\s*(?:\"|2|pp|double prime|loss)(?:\s+modulus)?$", re.IGNORECASE)
_COMPLEX = re.compile(r"^(?P<letter>[GE])?\s*(?:\*|abs|complex|star)(?:\s+modulus)?$", re.IGNORECASE)
_KIND = re.compile(r"\b(shear|tensile|tension|young's)\b\s*", re.IGNORECASE)
_SHEAR_SIGNS = re.compile(
    r"shear|torque|parallel plate|plate-plate|cone|couette|torsion|schub|scher|drehmoment|platte-platte",
    re.IGNORECASE,
)


@dataclass(frozen=True)
class Column:
    """A recognised column; letter G or E of its modulus, if it says."""

    index: int
    title: str
    unit: str
    letter: str


def title_of(cell: str) -> tuple[str, str]:
    """Title of a column: name and unit of a header cell."""
    text = cell.strip().strip('"') if cell.count('"') == 2 else cell.strip()
    text = re.sub("[’′´`]", "'", re.sub("[″”“]", '"', text)).replace("''", '"')
    bracket = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", text)
    if bracket and bracket.start() > 0 and not _part_of_name(bracket.group(1).strip()):
        return text[: bracket.start()].strip(), bracket.group(1).strip()
    timed = _TIME_ENDING.match(text)
    if timed:
        return timed.group(1), timed.group(2)
    ending = _ENDING.search(text)
    if ending and ending.start() > 0:
        return re.sub(r"\s+in$", "", text[: ending.start()].strip()), ending.group(1)
    return text, ""


def _part_of_name(text: str) -> bool:
    """Whether what stands in brackets is a symbol, as in tan(δ), G(t), Storage modulus (G'), and no unit."""
    return text.lower() in ("δ", "delta", "d", "t") or bool(re.fullmatch(r"\|?[GE]\s?['\"*]?\|?", text))


def _in_english(words: str) -> str:
    """A title whose German words, if there are any, are English."""
    if not _IS_GERMAN.search(words):
        return words
    for pattern, english in _GERMAN:
        words = re.sub(pattern, english, words, flags=re.IGNORECASE)
    return words


def quantity_of(name: str) -> tuple[str, str] | None:
    """Quantity a column's name stands for, and the letter G or E of its modulus."""
    words = re.sub(r"[\s_\-]+", " ", _in_english(name)).strip()
    low = words.lower()
    if words == "f" or low in ("freq", "frequency", "reduced frequency", "test frequency"):
        return "frequency", ""
    angular = ("angular frequency", "ang frequency", "ang. frequency", "omega", "reduced angular frequency")
    if words in ("ω", "w") or low in angular:
        return "angular", ""
    if words in ("T", "Ts") or low in (
        "temp",
        "temp.",
        "temperature",
        "sample temperature",
        "test temperature",
    ):
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
    if low in ("run", "specimen", "run name", "specimen name", "sample", "sample name", "experiment"):
        return "run", ""
    if re.sub(r"[\s().]", "", low).removeprefix("lossfactor") in ("tandelta", "tanδ", "tand", ""):
        return "tan_delta", ""
    if low in ("phase", "phase angle", "δ", "delta", "loss angle", "phase angle δ", "phase angle delta"):
        return "phase", ""
    if words == "t" or low == "time":
        return "time", ""
    if low in ("strain", "oscillation strain", "strain amplitude", "shear strain", "strain dyn", "γ"):
        return "strain", ""
    return _modulus_of(words)


def _modulus_of(words: str) -> tuple[str, str] | None:
    """Storage, loss, complex or relaxation modulus, and its letter."""
    low = words.lower()
    symbol = _SYMBOL.search(words)
    if symbol and 0 < symbol.start():  # a name and its symbol: both must say the same
        named = _modulus_of(words[: symbol.start()].strip(" ,:-"))
        signed = _modulus_of(symbol.group(1))
        if named is not None and signed is not None and signed[0] in (named[0], "relaxation"):
            return named[0], signed[1]
    kind = _KIND.search(words)
    words = _KIND.sub("", words).strip().strip("|")
    for quantity, pattern in (("storage", _STORAGE), ("loss", _LOSS), ("complex", _COMPLEX)):
        match = pattern.match(words)
        if match:
            letter = (match.group("letter") or "").upper()
            if not letter and kind:
                letter = _letter_of(kind)
            if letter or "modulus" in low or low in ("storage", "loss"):
                return quantity, letter
    match = _RELAXED.match(words)
    if match and (match.group("letter") or "relax" in low) and low not in ("e", "g", "er", "gr", "e rel"):
        return "relaxation", (match.group("letter") or "").upper() or _letter_of(kind)
    if words in ("G", "E", "Er", "Gr"):
        return "relaxation", words[0]
    return None


def _letter_of(kind: re.Match[str] | None) -> str:
    """Letter of a modulus by the word for its kind of loading."""
    if kind is None:
        return ""
    return "G" if kind.group(1).lower() == "shear" else "E"


def columns_of(
    cells: Sequence[str], wanted: Mapping[str, str | int]
) -> tuple[dict[str, Column], list[tuple[str, Column, Column]]]:
    """Recognised columns of a row taken for a header, and those that are two of a kind.

    A column is wanted by its title, or by its number, 1 the first.
    """
    found: dict[str, Column] = {}
    doubles: list[tuple[str, Column, Column]] = []
    for index, cell in enumerate(cells):
        title = cell.strip()
        if (
            not title
            or len(title) > LONGEST_TITLE
            or (_NUMERIC.match(title) and title not in wanted.values())
        ):
            continue
        name, unit = title_of(cell)
        if title.strip("[]()").lower() in UNIT_WORDS and title not in wanted.values():
            continue
        named = next((q for q, title in wanted.items() if title in (cell.strip(), name, index + 1)), None)
        recognised = quantity_of(name)
        if named is not None:
            letter = recognised[1] if recognised and recognised[0] == named else ""
        elif recognised is None or recognised[0] in wanted:
            continue
        else:
            named, letter = recognised
        if named == "frequency" and unit.lower() == "rad/s" and named not in wanted:
            named = "angular"
        if named in found and (named in UNITS or named in wanted):
            doubles.append((named, found[named], Column(index, cell.strip(), unit, letter)))
        found.setdefault(named, Column(index, cell.strip(), unit, letter))
    if wanted.get("frequency"):
        found.pop("angular", None)
    return found, doubles


def choose(columns: Mapping[str, Column]) -> tuple[str, ...] | None:
    """The columns chosen: frequency and a pair of moduli, or time and relaxation modulus; None if neither."""
    if not {"frequency", "angular"} & columns.keys():
        return RELAXATION if set(RELAXATION) <= columns.keys() else None
    frequency = next((q for q in ("frequency", "angular") if q in columns), None)
    pair = next((p for p in MODULI if set(p) <= columns.keys()), None)
    return None if frequency is None or pair is None else (frequency, *pair)


def names_shear(text: str) -> bool:
    """Whether the title of a column, or another text, speaks of shear: torque, plates, a cone."""
    return bool(_SHEAR_SIGNS.search(text))


def number_of(cell: str) -> float:
    """Column cells: the number in one, decimal comma or point; ValueError if there is none."""
    text = cell.strip().strip('"').replace("−", "-")
    if "," in text and "." not in text:
        text = text.replace(",", ".")
    elif "," in text:  # both: the last one is the decimal mark, if the other groups thousands
        thousand, mark = (",", ".") if text.rfind(".") > text.rfind(",") else (".", ",")
        if re.fullmatch(rf"[-+]?\d{{1,3}}(\{thousand}\d{{3}})+\{mark}\d*(e[-+]?\d+)?", text, re.IGNORECASE):
            text = text.replace(thousand, "").replace(mark, ".")
    if "_" in text:
        raise ValueError(cell)
    return float(text)


def is_number(cell: str) -> bool:
    """Column cells: whether one holds a number."""
    try:
        number_of(cell)
    except ValueError:
        return False
    return True
