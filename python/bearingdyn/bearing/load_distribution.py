"""Which balls carry the load: forces, contact angles and pressures of all contacts, at rest or at speed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.ball_inertia import Running
from bearingdyn.bearing.contact_pressure import check_pressure
from bearingdyn.bearing.hertz import PointContact
from bearingdyn.checks import instance, number, positive
from bearingdyn.notice import BearingWarning as BearingWarning
from bearingdyn.notice import warn
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class LoadDistribution:
    """How a bearing's load is distributed over its balls, in the order of their azimuth; all arrays (Z,)."""

    azimuth: Array
    """rad, from x towards y."""
    load_inner: Array
    """Load of the inner contact, N."""
    load_outer: Array
    """Load of the outer contact, N; the same but for a Running bearing."""
    angle_inner: Array
    """Contact angle at the inner race, rad; of an open contact, that of the line of the groove centres."""
    angle_outer: Array
    """Contact angle at the outer race, rad."""
    pressure_inner: Array
    """Largest pressure of the inner contact, Pa."""
    pressure_outer: Array
    """Largest pressure of the outer contact, Pa."""

    def __repr__(self) -> str:
        """One line: the loaded balls, and the largest load and pressure."""
        p = max(self.pressure_inner.max(), self.pressure_outer.max())
        return (
            f"<LoadDistribution: {self.loaded} of {self.azimuth.size} balls loaded, at most "
            f"{self.load_outer.max():.4g} N and {p / 1e9:.3g} GPa>"
        )

    @property
    def loaded(self) -> int:
        """Number of balls between both races."""
        return int(np.count_nonzero(self.load_inner > 0))


def load_distribution(
    bearing: BallBearing | Running, q: ArrayLike, angle: float = 0.0, *, shoulder: float | None = None
) -> LoadDistribution:
    """Load, contact angle and pressure of each ball with the inner ring at q (6,), m and rad.

    Parameters
    ----------
    bearing
        At rest, or with the inertia of its balls.
    q
        (6,) inner relative to outer ring.
    angle
        Cage angle, rad.
    shoulder
        Height of the shoulders over the bottom of their grooves, m; None: not checked. The ellipse ends at
        α + arcsin(a/R), R = 2fDw/(2f + 1), the shoulder at arccos(1 − height/fDw) (Harris).

    Raises
    ------
    ValueError
        On a wrong shape, a pressure above 21 GPa, or where a ball runs beyond the shoulder: the axial load
        is more than it can hold.

    Warns
    -----
    BearingWarning
        Where a pressure exceeds 4.2 GPa (ISO 76), or the shoulder cuts an ellipse; the ball is named,
        counted from 1.
    """
    instance("bearing", bearing, (BallBearing, Running), "give a BallBearing, or it Running")
    if shoulder is not None:
        shoulder = positive("shoulder", shoulder, "it must be positive and finite, in m")
    if isinstance(bearing, Running):
        brg, b = bearing.bearing, bearing.balls(q, angle)
        psi, Q_i, Q_o, a_i, a_o = b.azimuth, b.Q_i, b.Q_o, b.alpha_i, b.alpha_o
    else:
        brg = bearing
        Q_i = Q_o = brg.ball_loads(q, angle)  # pressures are checked below
        psi, a_i = _angles(brg, q, angle)
        a_o = a_i
    pressures = []
    for race, contact, f, Q, alpha in (
        ("inner", brg.inner_contact, brg.fi, Q_i, a_i),
        ("outer", brg.outer_contact, brg.fo, Q_o, a_o),
    ):
        p = contact.pressure(1.0) * np.cbrt(Q)
        check_pressure(race, p)
        if shoulder is not None:
            _check_shoulder(race, contact, f * brg.Dw, 2 * f * brg.Dw / (2 * f + 1), Q, alpha, shoulder)
        pressures.append(p)
    return LoadDistribution(psi, Q_i, Q_o, a_i, a_o, *pressures)


def _angles(brg: BallBearing, q: ArrayLike, angle: float) -> tuple[Array, Array]:
    """Azimuths and angles of the lines between the groove centres (Z,), rad; surfaces taken as smooth."""
    kernel, z = brg.kernel(), brg.relative(q)
    psi = brg.angle0 + number("angle", angle) + 2 * math.pi * np.arange(brg.Z) / brg.Z
    axial = kernel.x0 + z[2] + z[3] * np.cos(psi) + z[4] * np.sin(psi)
    radial = kernel.y0 + z[0] * np.cos(psi) + z[1] * np.sin(psi)
    return psi, np.arctan2(axial, radial)


def _check_shoulder(
    race: str, contact: PointContact, groove: float, surface: float, Q: Array, alpha: Array, shoulder: float
) -> None:
    edge = math.acos(max(1 - shoulder / groove, 0.0))
    half = np.array([contact.semi_axes(float(load))[0] for load in Q])
    reach = np.where(Q > 0, np.abs(alpha) + np.arcsin(np.minimum(half / surface, 1.0)), 0.0)
    j = int(np.argmax(reach))
    where = f"ball {j + 1}: contact angle {math.degrees(abs(alpha[j])):.3g}° on the {race} race"
    limit = f"the shoulder begins at {math.degrees(edge):.3g}°"
    if Q[j] > 0 and abs(alpha[j]) >= edge:
        raise ValueError(f"load beyond the shoulder: {where}, {limit}; less axial load, or a higher shoulder")
    if reach[j] > edge:
        text = f"{where}, the ellipse ends at {math.degrees(reach[j]):.3g}°, {limit} and cuts it"
        warn(text, BearingWarning)
