"""A bearing some way into its turn."""

from __future__ import annotations

from dataclasses import replace

from bearingdyn.bearing.ball_bearing import BallBearing


def turned(bearing: BallBearing, angle: float) -> BallBearing:
    """The bearing as it stands with its cage at `angle` (rad) from now on called zero.

    The shaft has turned by angle/cage_ratio and the balls have spun: waves and pits stand accordingly.
    """
    shaft = angle / bearing.cage_ratio if bearing.cage_ratio else 0.0
    # a wave's argument is order·(azimuth − shaft) on the inner race and order·spin on a ball
    carried = {"inner": shaft, "outer": 0.0, "ball": -bearing.geometry.ball_spin(1.0) * shaft}
    return replace(
        bearing,
        angle0=bearing.angle0 + angle,
        waviness=tuple(replace(w, phase=w.phase - w.order * carried[w.body]) for w in bearing.waviness),
        defects=tuple(replace(p, angle=p.angle + carried[p.body]) for p in bearing.defects),
    )
