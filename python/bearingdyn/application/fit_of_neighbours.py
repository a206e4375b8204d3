"""Whether neighbours fit: radius, side and axial position of what meets at one interface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, TypeAlias

from bearingdyn.application.channel import GROUND
from bearingdyn.application.joints import BearingJoint
from bearingdyn.application.place import Place
from bearingdyn.cms import RoundFace
from bearingdyn.notice import FitWarning, warn

Ring: TypeAlias = Literal["inner", "outer"]
RINGS: tuple[Ring, Ring] = ("inner", "outer")
DOUBTFUL = 0.01
"""Of the radius: the tightest press fits (ISO 286, u to zc) and the loosest running fits (c11) of machine
parts stay below it; a dimension rounded to a millimetre, or a sleeve left out, does not."""
IMPOSSIBLE = 0.05
"""Of the radius: nothing that is pressed, shrunk, glued or turned to size is that far off, rubber is hardly
squeezed more, a bearing of the next bore is. Of a bearing, whose bore and outside are standard, an overlap of
more than DOUBTFUL is impossible already; a gap may stand for a sleeve."""
HALF = 0.4
"""Of a ring's width, on its seat: below a half the force at mid-width acts beside the seat; the tenth to
spare is for a seat that ends at mid-width, as that of a shaft drawn from bearing to bearing."""
NEARLY = 0.9
"""Of a ring's width, on its seat: chamfers and reliefs take less than the rest."""
INTRUDES = 0.05
"""Of a ring's width under a shoulder: more than a fillet or the rounding of a drawing."""
WALL = 3.0
"""Ball diameters between a race and the seat of its ring: catalogue bearings have 0.25 to 0.60."""
OVERRIDE = "correct the dimension, or pass fits=False if they are meant to differ"


def check_connection(
    places: tuple[Place, Place], faces: tuple[Sequence[RoundFace], Sequence[RoundFace]]
) -> None:
    """Check that two rigidly joined neighbours fit; a part without known faces is taken to fit.

    Raises
    ------
    ValueError
        Where one cannot sit in the other: both radii, or the axial lengths, and the remedy are named.
    """
    first, second = faces
    if not (first and second):
        return
    pairs = [(i, o, places) for i in first for o in second if (i.kind, o.kind) == ("shaft", "bore")]
    pairs += [(i, o, places[::-1]) for i in second for o in first if (i.kind, o.kind) == ("shaft", "bore")]
    if not pairs:
        if not all(face.beside for face in (*first, *second)):
            way = "outwards" if first[0].kind == "shaft" else "inwards"
            warn(
                f"{places[0]} and {places[1]} both face {way}, with radii of {first[0].radius:.6g} and "
                f"{second[0].radius:.6g} m; one should sit in the other: are an inner and an outer interface "
                f"exchanged? {OVERRIDE}",
                FitWarning,
            )
        return
    inside, around, (a, b) = min(pairs, key=lambda pair: abs(_misfit(pair[0].radius, pair[1].radius)))
    _check_radii(str(a), inside.radius, str(b), around.radius)
    for own, other, name, neighbour in ((inside, around, a, b), (around, inside, b, a)):
        _check_shoulder(own, other.room, str(name), str(neighbour))
        if own.bonded:
            _check_carried(own, other, str(name), str(neighbour), least=0.0)


def check_bearing(joint: BearingJoint, ring: Ring, place: Place, faces: Sequence[RoundFace]) -> None:
    """Check that one ring of a bearing fits its neighbour: a seat, or a body that stands for the ring.

    Raises
    ------
    ValueError
        Where the ring cannot sit there: both radii, or the axial lengths, and the remedy are named.
    """
    if not faces or place == GROUND:
        return
    bearing, at = joint.bearing, joint.place
    title = f"the {ring} ring of bearing {joint.name!r}"
    half = 0.5 * (bearing.Dpw + (-1 if ring == "inner" else 1) * bearing.Dw)
    hollow = {face.kind for face in faces} == {"shaft", "bore"}
    if bearing.boundary is None:
        _check_race(title, ring, half, place, faces, Dw=bearing.Dw, at=at)
        return
    bore, outside, width = bearing.boundary
    own = RoundFace(
        "bore" if ring == "inner" else "shaft",
        0.5 * (bore if ring == "inner" else outside),
        (at - 0.5 * width, at + 0.5 * width),
    )
    # a ring of its own has the bearing's bore or outside, a seat meets it: the radius is the same
    candidates = [face for face in faces if face.kind != own.kind or (hollow and face.beside)]
    if not candidates:
        return
    seat = min(candidates, key=lambda face: abs(_misfit(own.radius, face.radius)))
    if seat.beside and not hollow and seat.room is None:
        return  # a solid body without a seat of its own: what carries the bearing is not drawn
    if own.kind == "bore":
        _check_radii(str(place), seat.radius, title, own.radius, DOUBTFUL)
    else:
        _check_radii(title, own.radius, str(place), seat.radius, DOUBTFUL)
    if seat.kind != own.kind:
        _check_shoulder(own, seat.room, title, str(place))
        _check_carried(own, seat, title, str(place), least=HALF)


def check_beside(
    joint: BearingJoint,
    others: Sequence[BearingJoint],
    faces: Callable[[Place], Sequence[RoundFace]],
) -> None:
    """Check that a bearing fits beside its neighbours that sit on the same shaft.

    Raises
    ------
    ValueError
        Where two rings would lie in one place.
    """
    here = _place_on_shaft(joint, faces(joint.inner))
    for other in others:
        there = _place_on_shaft(other, faces(other.inner))
        if here is None or there is None:
            continue
        room, needed = abs(here[0] - there[0]), 0.5 * (here[1] + there[1])
        if not room >= (1.0 - INTRUDES) * needed:
            raise ValueError(
                f"bearings {joint.name!r} and {other.name!r} sit {1e3 * room:.4g} mm apart on one shaft and "
                f"need {1e3 * needed:.4g} mm, for they are {1e3 * here[1]:.4g} and {1e3 * there[1]:.4g} mm "
                "wide; give each a seat of its own, or pass fits=False"
            )


def _place_on_shaft(joint: BearingJoint, faces: Sequence[RoundFace]) -> tuple[float, float] | None:
    """z along the shaft and width, m, of a bearing's inner ring; None where either is not known."""
    at = next((face.at for face in faces if face.at is not None and face.kind == "shaft"), None)
    boundary = joint.bearing.boundary
    return None if at is None or boundary is None else (at + joint.place, boundary[2])


def _misfit(inside: float, around: float) -> float:
    """How much larger the inside radius is than that around it, of the latter; < 0: a gap."""
    return (inside - around) / around


def _check_radii(
    inside: str, r_inside: float, around: str, r_around: float, overlap: float = IMPOSSIBLE
) -> None:
    off = _misfit(r_inside, r_around)
    if abs(off) <= DOUBTFUL:
        return
    what, size = "overlap" if off > 0 else "gap", ".2g" if abs(off) < 0.1 else ".0f"
    text = (
        f"{inside} has a radius of {r_inside:.6g} m, Ø{2e3 * r_inside:.6g} mm, and sits in {around} with a "
        f"radius of {r_around:.6g} m, Ø{2e3 * r_around:.6g} mm: {what} of "
        f"{1e3 * abs(r_inside - r_around):.4g} mm, {100 * abs(off):{size}} % of the radius"
    )
    ratio = max(r_inside / r_around, r_around / r_inside)
    if abs(ratio - 2.0) <= 2 * IMPOSSIBLE:
        text += "; is one of them a diameter? radii are asked for"
    if off > overlap or off < -IMPOSSIBLE:
        raise ValueError(f"{text}; {OVERRIDE}")
    warn(f"{text}; {OVERRIDE}", FitWarning)


def _check_race(
    title: str,
    ring: Ring,
    race: float,
    place: Place,
    faces: Sequence[RoundFace],
    *,
    Dw: float,
    at: float,
) -> None:
    """Check the seat of a bearing of unknown bore and outside: its race must lie beyond, a ring between."""
    seats = [face for face in faces if face.kind == ("shaft" if ring == "inner" else "bore")]
    if {face.kind for face in faces} == {"shaft", "bore"}:  # a hollow body may be the ring itself
        seats = [face for face in faces if face not in seats]
    if not seats or (len(faces) == 1 and seats[0].beside and seats[0].room is None):
        return  # a solid body has no seat
    seat = seats[0].radius
    remedy = f"the shaft must be thinner; {OVERRIDE}"
    beyond = seat < race
    if ring == "outer":
        remedy, beyond = f"the bore must be wider; {OVERRIDE}", seat > race
    if not beyond:
        raise ValueError(
            f"{place} has a radius of {seat:.6g} m, Ø{2e3 * seat:.6g} mm, and the race of {title} one of "
            f"{race:.6g} m, Ø{2e3 * race:.6g} mm: there is no room for a ring; {remedy}"
        )
    facing = next((face for face in faces if face.kind == ("shaft" if ring == "inner" else "bore")), None)
    if facing is None:
        return
    wall = (race - facing.radius) * (1 if ring == "inner" else -1)
    if wall > WALL * Dw:
        warn(
            f"{place} has a radius of {facing.radius:.6g} m, Ø{2e3 * facing.radius:.6g} mm, and the race of "
            f"{title} one of {race:.6g} m, Ø{2e3 * race:.6g} mm: its ring would be {1e3 * wall:.4g} mm "
            f"thick, {wall / Dw:.3g} ball diameters, where bearings have 0.25 to 0.6; {OVERRIDE}",
            FitWarning,
        )
    least = RoundFace(facing.kind, facing.radius, (at - 0.5 * Dw, at + 0.5 * Dw))  # no ring is narrower
    on = min(least.z[1], facing.z[1]) - max(least.z[0], facing.z[0])
    if not on >= HALF * Dw:
        _check_carried(least, facing, f"{title}, as wide as its balls at least,", str(place), least=HALF)


def _check_shoulder(own: RoundFace, room: tuple[float, float] | None, name: str, neighbour: str) -> None:
    """Refuse what would lie under a shoulder of its neighbour."""
    if room is None:
        return
    length = own.z[1] - own.z[0]
    under = max(room[0] - own.z[0], own.z[1] - room[1])
    if under > INTRUDES * length:
        raise ValueError(
            f"{name} is {1e3 * length:.6g} mm wide and would run {1e3 * under:.4g} mm into the shoulder "
            f"beside {neighbour}; lengthen or move the seat, or pass fits=False"
        )


def _check_carried(own: RoundFace, seat: RoundFace, name: str, neighbour: str, *, least: float) -> None:
    """Refuse a neighbour with less than the share `least` of its width on its seat; warn if not all is."""
    length = own.z[1] - own.z[0]
    on = min(own.z[1], seat.z[1]) - max(own.z[0], seat.z[0])
    share = max(on, 0.0) / length
    if share >= NEARLY:
        return
    text = (
        f"{name} is {1e3 * length:.6g} mm wide, and {1e3 * max(on, 0.0):.4g} mm of it lie on {neighbour}, "
        f"which reaches from {1e3 * seat.z[0]:.4g} to {1e3 * seat.z[1]:.4g} mm about its reference point; "
        f"lengthen or move the seat, or pass fits=False"
    )
    if share < least:
        raise ValueError(text)
    warn(text, FitWarning)
