"""Frequencies at which a bearing shows in a spectrum, by name."""

from __future__ import annotations

import math

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.checks import instance, number, require, whole


def fault_lines(
    bearing: BallBearing, speed: float, *, harmonics: int = 1, contact_angle: float | None = None
) -> dict[str, float]:
    """Name -> frequency, Hz, of localised defects and the cage: shaft, FTF, BPFO, BPFI, 2 BSF and multiples.

    A defect of a ball meets a race at twice the spin of the ball.

    Parameters
    ----------
    bearing, speed
        Inner ring at `speed`, rad/s, outer ring at rest.
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
    _whole("harmonics", harmonics)
    f = bearing.frequencies(number("speed", speed), contact_angle)
    lines = {"shaft": abs(speed) / (2 * math.pi), "FTF": f.FTF}
    for k in range(1, harmonics + 1):
        lines |= {
            f"{k} BPFO" if k > 1 else "BPFO": k * f.BPFO,
            f"{k} BPFI" if k > 1 else "BPFI": k * f.BPFI,
            f"{2 * k} BSF": 2 * k * f.BSF,
        }
    return lines


def waviness_lines(
    bearing: BallBearing,
    speed: float,
    *,
    multiples: int = 1,
    ball_orders: tuple[int, ...] = (2,),
    contact_angle: float | None = None,
) -> dict[str, float]:
    """Name -> frequency, Hz, at which waves of order n vibrate a uniformly loaded, elastically held ring.

    Inner race: n = qZ axial at qZ(ω_i − ω_c), n = qZ ± 1 radial at qZ(ω_i − ω_c) ± ω_i. Outer race: n = qZ
    axial and n = qZ ± 1 radial at qZω_c. Ball, even n: axial nω_b, radial nω_b ± ω_c (J. A. Wensing 1998;
    reference page §2). Names are body, order, direction; "outer 9(±1)" is 9 axial and 8, 10 radial.

    Parameters
    ----------
    bearing, speed
        Inner ring at `speed`, rad/s, outer ring at rest.
    multiples
        q = 1 … multiples.
    ball_orders
        Even orders of the balls' waves.
    contact_angle
        Of the loaded state, rad; None: nominal.

    Raises
    ------
    ValueError
        For an odd order of a ball, or a value that is no positive whole number.
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    _whole("multiples", multiples)
    for n in ball_orders:
        even = isinstance(n, int) and n > 0 and n % 2 == 0
        require(even, "ball_orders", ball_orders, "it must be even: odd orders cancel across a ball")
    f = bearing.frequencies(number("speed", speed), contact_angle)
    turn, Z = abs(speed) / (2 * math.pi), bearing.Z
    lines: dict[str, float] = {}
    for q in range(1, multiples + 1):
        lines |= {
            f"inner {q * Z} ax": q * f.BPFI,
            f"inner {q * Z - 1} rad": q * f.BPFI - turn,
            f"inner {q * Z + 1} rad": q * f.BPFI + turn,
            f"outer {q * Z}(±1)": q * f.BPFO,
        }
    for n in ball_orders:
        lines |= {
            f"ball {n} ax": n * f.BSF,
            f"ball {n} rad −": n * f.BSF - f.FTF,
            f"ball {n} rad +": n * f.BSF + f.FTF,
        }
    return lines


def _whole(field: str, value: object) -> None:
    whole(field, value, 1, 10_000)
