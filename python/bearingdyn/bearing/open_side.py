"""The side on which a bearing has no shoulder, and whether balls are pressed onto it.

An angular contact bearing bears axial load one way. The other way there is no shoulder: the balls run off
the bottom of the groove and the bearing comes apart. A radial load alone does that too: nothing holds the
ring against the groove's flank, and it slides away from the shoulder until the balls stand on the bottom,
which is cut down to there.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import one_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    from bearingdyn.bearing.kernel import BearingKernel

Flags: TypeAlias = NDArray[np.bool_]
OpenSide: TypeAlias = Literal["auto", "+z", "-z"] | None

_BOTTOM = math.radians(5)
"""How far about the bottom of the groove a ball still finds it: half of a contact ellipse, some 0.1 Dw wide,
seen from the middle of the ball. The low shoulder of an angular contact bearing is cut down to there."""
_CARRIES = 0.01
"""Of the largest ball load: a ball that only brushes the groove does not carry."""
_LEANS = 0.2
"""Of the open sine, 1° of 5°: a ball that leans on the shoulder at all. Bearings in ordinary use have ten
times as much radial load as thrust, and contact angles of 4°."""


def shoulder(open_side: OpenSide, contact_angle: float | None) -> int:
    """Which side is open: +1, −1: axial load on the inner ring is borne towards +z, −z only; 0: both ways.

    Parameters
    ----------
    open_side
        As of a `BallBearing`: "-z", "+z", None for none, or "auto", which the contact angle decides.
    contact_angle
        rad; zero or None leaves no side open where "auto" is said.

    Raises
    ------
    ValueError
        For an unknown open side.
    """
    one_of("open_side", open_side, ("auto", "+z", "-z", None))
    if open_side == "auto":
        return 1 if contact_angle else 0
    return {"-z": 1, "+z": -1, None: 0}[open_side]


def open_sine(alpha0: float) -> float:
    """Sine of the angle on the open side from which a ball runs off, for a free contact angle in rad."""
    return math.sin(min(_BOTTOM, alpha0 / 2))


def runs_off(kernel: BearingKernel, z: Array, loads: Array, turn: float) -> str | None:
    """Why balls run off on the open side, in words; None where the bearing holds together on its shoulder.

    Either a ball that carries is pressed onto the open side, or none leans on the shoulder.

    Parameters
    ----------
    kernel
        The bearing.
    z
        Its relative raceway coefficients (n,), m.
    loads
        Of the balls (Z,), N.
    turn
        Azimuth of the first ball, rad.
    """
    if kernel.shoulder == 0 or not loads.max() > 0.0:
        return None
    alpha, carries, astray = (found[0] for found in _leaning(kernel, z[None], loads[None], np.array([turn])))
    if not _off(kernel, alpha, carries, astray):
        return None
    side = "−z" if kernel.shoulder > 0 else "+z"
    at_fault = astray if astray.any() else carries
    j = int(np.argmax(np.where(at_fault, loads, 0.0)))
    worst = f"(ball {j + 1}: {loads[j]:.4g} N at {math.degrees(alpha[j]):.1f}°)"
    if astray.any():
        return (
            f"{int(astray.sum())} of {kernel.Z} balls are pressed onto the open side, where no shoulder "
            f"holds them {worst}: the inner ring is not carried towards {side}"
        )
    return (
        f"none of its {int(carries.sum())} loaded balls leans on the shoulder, all stand on the bottom of "
        f"the groove {worst}: it bears no axial load to speak of, and nothing keeps the inner ring "
        f"from sliding off towards {side}"
    )


def samples_off(kernel: BearingKernel, z: Array, loads: Array, turn: Array) -> Flags:
    """Which samples (s,) of a motion run off on a bearing's open side; see `runs_off`.

    Parameters
    ----------
    kernel
        The bearing.
    z
        Its relative raceway coefficients (s, n), m.
    loads
        Of the balls (s, Z), N.
    turn
        Azimuth of the first ball (s,), rad.
    """
    if kernel.shoulder == 0:
        return np.zeros(len(z), dtype=np.bool_)
    return np.asarray(_off(kernel, *_leaning(kernel, z, loads, turn)) & (loads.max(axis=1) > 0.0))


def _leaning(kernel: BearingKernel, z: Array, loads: Array, turn: Array) -> tuple[Array, Flags, Flags]:
    """Angles (s, Z) of the balls in their grooves, which carry, and which of those do so on the open side."""
    psi = turn[:, None] + 2 * math.pi * np.arange(kernel.Z) / kernel.Z
    argument = kernel.order[:, None, None] * psi
    basis = np.where(kernel.sine[:, None, None] == 1, np.sin(argument), np.cos(argument))
    axial = kernel.x0 + np.einsum("sn,nsb->sb", z * (kernel.axial == 1), basis)
    radial = kernel.y0 + np.einsum("sn,nsb->sb", z * (kernel.axial == 0), basis)
    alpha = np.arctan2(axial, radial)
    carries = loads > _CARRIES * loads.max(axis=1, keepdims=True)
    return alpha, carries, carries & (kernel.shoulder * np.sin(alpha) < -kernel.open_sine)


def _off(kernel: BearingKernel, alpha: Array, carries: Flags, astray: Flags) -> Flags:
    """Whether a ball carries on the open side, or none leans on the shoulder."""
    leans = carries & (kernel.shoulder * np.sin(alpha) > _LEANS * kernel.open_sine)
    return np.asarray(astray.any(axis=-1) | ~leans.any(axis=-1))


OPEN_SIDE_REMEDY = (
    "load it towards its shoulder, hang it the other way round, bearing.mirrored(), or set it against a "
    "second one that carries this direction (a Pair, or a preload by offset=); one with shoulders on both "
    "sides has open_side=None"
)
