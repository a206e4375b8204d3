"""Frequencies at which a bearing shows in a spectrum, by name."""

from __future__ import annotations

import math

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.checks import instance, items, number, require, whole


def fault_lines(
    bearing: BallBearing, speed: float, *, harmonics: int = 1, contact_angle: float | None = None
) -> dict[str, float]:
    """Name -> frequency, Hz, of the spectral lines of faults and the cage: shaft, FTF, BPFO, BPFI, 2 BSF …

    A defect of a ball meets a race at twice the spin of the ball.

    Parameters
    ----------
    bearing, speed
        Shaft at `speed`, rad/s; which ring turns with it is said by the bearing's `turning`.
    harmonics
        How many multiples of the ball passes and of 2 BSF.
    contact_angle
        Of the loaded state, rad; None: nominal.

    Raises
    ------
    ValueError
        If harmonics is no positive whole number or speed is not finite.

    Examples
    --------
    >>> import math
    >>> from bearingdyn.bearing import fault_lines
    >>> from bearingdyn.bearing.catalogue import bearing
    >>> lines = fault_lines(bearing("6205", clearance=10e-6), 1797 * math.pi / 30)
    >>> round(lines["BPFO"], 2), round(lines["BPFI"], 2)
    (107.36, 162.19)
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    return bearing.lines(speed, harmonics=harmonics, contact_angle=contact_angle)


def waviness_lines(
    bearing: BallBearing,
    speed: float,
    *,
    multiples: int = 1,
    ball_orders: tuple[int, ...] = (2,),
    contact_angle: float | None = None,
) -> dict[str, float]:
    """Name -> frequency, Hz, of the spectral lines of waviness of order n, ring uniformly loaded.

    A race whose ring turns at ω_r: n = qZ axial at qZ|ω_r − ω_c|, n = qZ ± 1 radial at |qZ(ω_r − ω_c) ± ω_r|.
    Ball, even n: axial nω_b, radial |nω_b ± ω_c| (J. A. Wensing 1998; reference page §2). Names are body,
    order, direction; "outer 9(±1)" is 9 axial and 8, 10 radial, which are one line where the ring stands.

    Parameters
    ----------
    bearing, speed
        Shaft at `speed`, rad/s; which ring turns with it is said by the bearing's `turning`.
    multiples
        q = 1 … multiples.
    ball_orders
        Even orders of the balls' waves.
    contact_angle
        Of the loaded state, rad; None: nominal.

    Raises
    ------
    ValueError
        For an odd order of a ball, or a value that is not a positive whole number.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    multiples, speed = whole("multiples", multiples, 1, 10_000), number("speed", speed)
    for n in items("ball_orders", ball_orders, "it must be even orders of the balls' waves"):
        even = isinstance(n, int) and n > 0 and n % 2 == 0
        require(even, "ball_orders", ball_orders, "it must be even: odd orders cancel across a ball")
    f = bearing.frequencies(speed, contact_angle)
    turn, Z = abs(speed) / (2 * math.pi), bearing.Z
    lines: dict[str, float] = {}
    inner, outer = bearing.ring_speeds
    # the ring's own turn counted along ω_r − ω_c: + where it runs ahead of the balls
    ahead = 1.0 if inner >= outer else -1.0
    rings = (("inner", f.BPFI, ahead * inner * turn), ("outer", f.BPFO, -ahead * outer * turn))
    for q in range(1, multiples + 1):
        for name, passes, own in rings:
            if own == 0.0:
                lines[f"{name} {q * Z}(±1)"] = q * passes
                continue
            lines |= {
                f"{name} {q * Z} ax": q * passes,
                f"{name} {q * Z - 1} rad": abs(q * passes - own),
                f"{name} {q * Z + 1} rad": abs(q * passes + own),
            }
    for n in ball_orders:
        lines |= {
            f"ball {n} ax": n * f.BSF,
            f"ball {n} rad −": abs(n * f.BSF - f.FTF),
            f"ball {n} rad +": n * f.BSF + f.FTF,
        }
    return lines


def _whole(field: str, value: object) -> None:
    whole(field, value, 1, 10_000)
