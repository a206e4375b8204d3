"""Deep groove and angular contact ball bearings by designation, and estimates from boundary dimensions.

Bore, outside diameter and width are standard (ISO 15). Balls, pitch and groove radii are not: makers differ,
and keep them to themselves. What they print tells the balls: C0 = f0 Z Dw² cosα names Z Dw², C another
product of the two, and f0 the ratio Dw cosα/Dpw. Each entry says where its geometry comes from and how far C
and C0 by ISO 281 and ISO 76 are off the print; series 64 is by a rule alone.

Grooves: .52 and .53 (ISO 76) in deep groove bearings; .52 and .525 in angular contact bearings, which render
the axial stiffness that NSK prints for 96 preloaded pairs of 15° within 2.1 % rms (.53 outside: 3.2 %).
"""

from __future__ import annotations

import csv
import difflib
import math
import re
from importlib.resources import files
from typing import Any, Literal, NamedTuple

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.designation import Designation, clearance_range, read_designation
from bearingdyn.bearing.rating.iso_ratings import Ratings, iso_ratings, static_factor
from bearingdyn.checks import number, positive, require
from bearingdyn.notice import PassedOver, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.units import takes

Kind = Literal["deep groove", "angular contact"]

ESTIMATE = "estimated from the boundary dimensions, not a maker's geometry"

_BALL_STEP = 25.4e-3 / 64
"""Balls are made in steps of 1/64 inch (among others: ISO 3290-1), m."""
_BALL_SHARE = 0.3
"""Ball diameter over the height of the section, at most: rings and balls take about a third each."""
_FILLING = math.radians(196)
"""Arc over which the balls of a deep groove bearing lie side by side when it is filled: above it the last
one cannot be put in between the rings."""
_CAGE = 1.1
"""Pitch of the balls of an angular contact bearing over their diameter: what a cage leaves between them."""
_RACES = (0.52, 0.53)
"""Groove radii over ball diameter up to which the ratings of ISO 76 and ISO 281 hold."""
_ANGULAR_RACES = (0.52, 0.525)


class Deviation(NamedTuple):
    """How far a catalogue's geometry is off the ratings that a maker prints, relative."""

    C: float
    """Of C by ISO 281."""
    C0: float
    """Of f0 Z Dw² cosα, with the f0 printed, or that of the inner race where none is."""


class Entry(NamedTuple):
    """An entry of the catalogue: boundary dimensions (standard) and internal geometry, m and rad."""

    bore: float
    outside: float
    width: float
    Z: int
    Dw: float
    Dpw: float
    fi: float
    fo: float
    contact_angle: float | None = None
    source: str = ESTIMATE
    printed: Ratings | None = None
    """C and C0, N, and f0 as NSK prints them; f0 is NaN where none is printed."""

    @property
    def ratings(self) -> Ratings:
        """C by ISO 281 and C0 by ISO 76 of this geometry, N."""
        return iso_ratings(self.Z, self.Dw, self.Dpw, self.contact_angle or 0.0)

    @property
    def deviation(self) -> Deviation | None:
        """By how much the printed ratings are missed; None where none are printed."""
        if self.printed is None:
            return None
        cosine = math.cos(self.contact_angle or 0.0)
        f0 = self.printed.f0
        if not f0 > 0:
            f0 = static_factor(self.Dw * cosine / self.Dpw, inner_only=True)
        C0 = f0 * self.Z * (self.Dw * 1e3) ** 2 * cosine
        return Deviation(self.ratings.C / self.printed.C - 1, C0 / self.printed.C0 - 1)

    @property
    def support(self) -> str:
        """What the geometry rests on, and how far its ratings are off the print."""
        off = self.deviation
        if off is None:
            return self.source
        return f"{self.source}; C {100 * off.C:+.1f} %, C0 {100 * off.C0:+.1f} % off NSK's"


def estimate(
    bore: float,
    outside: float,
    width: float,
    *,
    kind: Kind = "deep groove",
    contact_angle: float | None = None,
) -> Entry:
    """A catalogue's entry for boundary dimensions in m: an estimate of typical geometry, no maker's design.

    Pitch diameter midway. Balls: the largest in steps of 1/64 inch up to 0.3 of the section (outside − bore);
    in narrow bearings, up to 0.7 of the width. Deep groove: as many as can be filled in over 196°; angular
    contact: as many as stand 1.1 diameters apart. Groove radii .52 and .53 (ISO 76), .52 and .525 with a
    contact angle. The rule is our own: of the bearings of CATALOGUE whose balls the makers' ratings name, it
    has the diameter within 7 % in 83 of 100, the number within one in 91 of 100; thin series miss by more.

    Parameters
    ----------
    bore, outside, width
        m.
    kind
        "deep groove" or "angular contact"; the latter needs a contact angle.
    contact_angle
        rad.

    Raises
    ------
    ValueError
        If a dimension is not positive, the section is too thin for balls, or the angle does not go with the
        kind.
    """
    d, D = positive("bore", bore), positive("outside", outside)
    B = positive("width", width)
    plausible("length", "outside", D)
    require(D > d, "outside", outside, f"it must exceed the bore of {bore!r} m")
    require(
        kind in ("deep groove", "angular contact"), "kind", kind, 'give "deep groove" or "angular contact"'
    )
    angular = kind == "angular contact"
    remedy = "give it in rad for an angular contact bearing, and for no other"
    require((contact_angle is not None) == angular, "contact_angle", contact_angle, remedy)
    Dpw = (d + D) / 2
    Dw = math.floor(min(_BALL_SHARE * (D - d), 0.7 * B) / _BALL_STEP) * _BALL_STEP
    require(Dw > 0, "outside", outside, "it must leave room for a ball of 1/64 inch")
    if angular:
        Z = math.floor(math.pi / math.asin(_CAGE * Dw / Dpw))
    else:
        Z = 1 + math.floor(_FILLING / (2 * math.asin(Dw / Dpw)))
    return Entry(d, D, B, Z, Dw, Dpw, *(_ANGULAR_RACES if angular else _RACES), contact_angle)


_SOURCES = {
    "maker": "C and C0 printed by NSK (E1102) name {Z} balls of {Dw:.4g} mm; pitch midway",
    "maker-pitch": "C and C0 printed by NSK (E1102) name {Z} balls of {Dw:.4g} mm, f0 their pitch",
    "stiffness": "NSK prints the stiffness of preloaded pairs, which names {Z} balls of {Dw:.4g} mm, as the "
    "ratings at 30° do",
    "dynamics": "typical 6202 of the dynamics literature; NSK's C and C0 name the same balls",
    "cwru": "Case Western Reserve University, {end} end bearing; groove radii as in ISO 76; NSK's C and C0 "
    "name the same balls",
    "jis": "races of 40.1 and 63.9 mm, the JIS 6306 of varying-compliance studies; groove radii as in ISO "
    "76; NSK's C and C0 name the same balls",
}
# Z Dw² alone leaves two; f0, which is told by Dw/Dpw, decides
_SECOND = {
    "6202": "7 balls of 6.35 mm have the same Z Dw², but an f0 .5 lower than printed",
    "6303": "6 balls of 9.525 mm have the same Z Dw², but an f0 .7 lower than printed",
    "6305": "7 balls of 11 mm have the same Z Dw², but an f0 .5 lower than printed",
    "6306": "7 balls of 12.7 mm have the same Z Dw², but an f0 .5 lower than printed",
}
# bare numbers: 15° is usual for spindles, 40° for general use
_USUAL_LETTER = {"70": "C", "72": "B", "73": "B"}
_SERIES_LETTERS = {15: "C", 25: "C", 30: "A", 40: "B"}


def _table() -> dict[str, Entry]:
    table: dict[str, Entry] = {}
    text = files("bearingdyn.bearing").joinpath("catalogue.csv").read_text(encoding="utf-8")
    for row in csv.DictReader(text.splitlines()):
        name, basis = row["designation"], row["basis"]
        bore, outside, width = (float(row[key]) * 1e-3 for key in ("bore", "outside", "width"))
        if basis == "rule":
            table[name] = estimate(bore, outside, width)
            continue
        angle = math.radians(float(row["angle"])) if row["angle"] else None
        Z, Dw = int(row["Z"]), float(row["Dw"])
        source = _SOURCES[basis].format(Z=Z, Dw=Dw, end="drive" if name == "6205" else "fan")
        source = f"{source}; {_SECOND[name]}" if name in _SECOND else source
        printed = None
        if row["C"]:
            printed = Ratings(float(row["C"]), float(row["C0"]), float(row["f0"] or "nan"))
        races = _RACES if angle is None else _ANGULAR_RACES
        made = Entry(
            bore, outside, width, Z, Dw * 1e-3, float(row["Dpw"]) * 1e-3, *races, angle, source, printed
        )
        table[name] = made
        if name[:2] in _USUAL_LETTER and name[-1] == _USUAL_LETTER[name[:2]]:
            table[name[:-1]] = made
    return table


CATALOGUE: dict[str, Entry] = _table()
"""60, 62, 63, 618, 619, 160 (deep groove), 70 (15° or A, 30°), 72 and 73 (40° or A, C) with bores of 10 to
100 mm (70: to 120 mm) by makers' ratings; 64 by `estimate`. 72 and 73 alone are 40°, 70 alone is 15°."""

ALTERNATIVES: dict[str, tuple[Entry, ...]] = {
    "6209": (
        Entry(
            45e-3, 85e-3, 19e-3, 9, 12.7e-3, 65e-3, 0.52, 0.52, None,
            "T. A. Harris, Rolling Bearing Analysis, example of the 209",
        ),
    ),
    "6305": (
        Entry(
            25e-3, 62e-3, 17e-3, 7, 11.5e-3, 43.5e-3, 0.52, 0.53, None,
            "ISO/TS 16281, worked cases; SKF's C0 of 11.6 kN within .8 %",
        ),
    ),
    "6306": (
        Entry(
            30e-3, 72e-3, 19e-3, 7, 12.7e-3, 51e-3, 0.52, 0.53, None,
            "the second complement with the Z Dw² of NSK's C0",
        ),
    ),
}  # fmt: skip
"""Other internal geometries of the same designation, by number of balls: of textbooks and standards."""


def entry(designation: str | int, *, balls: int | None = None) -> Entry:
    """The catalogue's entry for a designation: typical geometry, and its source.

    Parameters
    ----------
    designation
        As people write it: "6305", "SKF 6203-2RS/C3", "7014 ACD"; the number 6305 will do.
    balls
        Number of balls, where another geometry of ALTERNATIVES is meant.

    Raises
    ------
    ValueError
        If the designation is not listed, or has no geometry with so many balls.
    """
    return _listed(designation, _read(designation), balls)


def _read(designation: str | int) -> Designation:
    """The designation taken apart; the error of an unknown one names the nearest listed."""
    try:
        return read_designation(designation)
    except ValueError as error:
        typed = str(designation).upper().replace(" ", "").replace("O", "0")
        near = difflib.get_close_matches(typed, CATALOGUE, n=1, cutoff=0.7)
        if near:
            raise ValueError(f"designation is {designation!r}; did you mean {near[0]!r}?") from error
        number = re.search(r"[0-9]{3,}", typed)  # of a series that is not listed: "205" of NU205
        near = difflib.get_close_matches(number[0], CATALOGUE, n=3, cutoff=0.6) if number else []
        if near and "ceramic" not in str(error):
            raise ValueError(f"{error}; the nearest are {', '.join(near)}") from error
        raise


def _listed(designation: str | int, read: Designation, balls: int | None) -> Entry:
    name, degrees = read.number, None
    if read.contact_angle is not None:
        degrees = round(math.degrees(read.contact_angle))
        name += _SERIES_LETTERS[degrees]
        if name not in CATALOGUE and read.number in CATALOGUE:
            name = read.number
    if name not in CATALOGUE:
        near = difflib.get_close_matches(read.number, CATALOGUE, n=3, cutoff=0.6)
        meant = f"the nearest are {', '.join(near)}; " if near else ""
        remedy = f"{meant}it must be a bearing of bd.catalogue.CATALOGUE, bore 10 to 100 mm"
        require(False, "designation", designation, remedy)
    found = CATALOGUE[name]
    if degrees is not None and found.contact_angle != read.contact_angle:
        origin = f"balls as of {name}, whose ratings are printed, at {degrees}°"
        found = found._replace(contact_angle=read.contact_angle, source=origin, printed=None)
    if balls is None or number("balls", balls) == found.Z:
        return found
    others = ALTERNATIVES.get(read.number, ())
    other = next((e for e in others if balls == e.Z), None)
    if other is None:
        counts = " or ".join(str(e.Z) for e in (found, *others))
        raise ValueError(f"balls is {balls!r}; {read.number} is known with {counts} balls")
    return other


def series_of(bearing: BallBearing) -> str | None:
    """Series in the catalogue that has these boundary dimensions, such as "62" or "619", or None.

    Parameters
    ----------
    bearing
        With its boundary known.
    """
    if bearing.boundary is None:
        return None
    angular = bearing.contact_angle is not None
    for name, listed in CATALOGUE.items():
        same = all(
            math.isclose(a, b, rel_tol=1e-9)
            for a, b in zip(bearing.boundary, (listed.bore, listed.outside, listed.width), strict=True)
        )
        if same and angular == (listed.contact_angle is not None):
            return name.rstrip("ABC")[:-2]
    return None


@takes(clearance="m")
def bearing(
    designation: str | int, *, clearance: float | None = None, balls: int | None = None, **keywords: Any
) -> BallBearing:
    """Catalogue's bearing by its designation: a BallBearing with its internal geometry.

    Parameters
    ----------
    designation
        As people write it: "6305", "7205B", "SKF 6203-2RS/C3"; the number 6305 will do.
    clearance
        Diametral clearance, m: of a deep groove bearing, and of no other. None: the mid value of the class
        that the designation names, CN where it names none (ISO 5753-1, before mounting).
    balls
        Number of balls, where another geometry of ALTERNATIVES is meant.
    **keywords
        Passed to BallBearing: material, film, damping, and so on.

    Raises
    ------
    ValueError
        If the designation is not listed, the clearance is out of place, or from BallBearing.

    Warns
    -----
    PassedOver
        For what a designation says and a BallBearing does not know: maker, seals, cage, tolerance class.

    Examples
    --------
    >>> from bearingdyn.bearing.catalogue import bearing, entry
    >>> bearing("6205/C3")
    <BallBearing: 9 balls of Ø7.94 mm on Ø39.04 mm, grooves 0.52 and 0.53, clearance 20.5 µm>
    >>> entry("6209").support
    "C and C0 printed by NSK (E1102) name 10 balls of 11.91 mm; pitch midway; C -0.8 %, C0 +0.1 % off NSK's"
    """
    read = _read(designation)
    found = _listed(designation, read, balls)
    group, ignored = read.clearance_class, list(read.ignored)
    if found.contact_angle is None:
        if clearance is None:
            clearance = sum(clearance_range(found.bore, group or "CN")) / 2
        elif group:
            ignored.append(f"{group}, as clearance is given")
    elif group:
        ignored.append(f"{group}, as the contact angle fixes the clearance")
    if ignored:
        meaning = read.number + read.letter + (f" with clearance {group}" if group else "")
        warn(
            f"designation {str(designation)!r} is read as {meaning}; passed over: {', '.join(ignored)}",
            PassedOver,
        )
    return from_entry(found, clearance=clearance, **keywords)


def from_entry(entry: Entry, *, clearance: float | None = None, **keywords: Any) -> BallBearing:
    """Catalogue entry, or one by `estimate`, as a BallBearing.

    Parameters
    ----------
    entry
        Dimensions, listed or by `estimate`.
    clearance
        Diametral clearance, m: of a deep groove bearing, and of no other.
    **keywords
        Passed to BallBearing.
    """
    e = entry
    if e.contact_angle is None:
        require(
            clearance is not None,
            "clearance",
            clearance,
            "it must be given, diametral, in m, for a deep groove bearing",
        )
    else:
        require(clearance is None, "clearance", clearance, "it must not be given: the contact angle fixes it")
    return BallBearing(
        e.Z,
        e.Dw,
        e.Dpw,
        e.fi,
        e.fo,
        clearance=clearance,
        contact_angle=e.contact_angle,
        **{"boundary": (e.bore, e.outside, e.width), **keywords},
    )
