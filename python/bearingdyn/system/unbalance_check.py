"""Whether an unbalance suits its place: the mass that moves with it, and that it turns."""

from __future__ import annotations

from bearingdyn.application import Plan, Unbalance
from bearingdyn.notice import StandingUnbalance, warn
from bearingdyn.plausible_ranges import plausible


def check_unbalance(plan: Plan) -> None:
    """Check each unbalance against the mass that moves with its place: eccentricities are micrometres.

    Warns
    -----
    StandingUnbalance
        For one on a part that stands while others turn.

    Raises
    ------
    ValueError
        For an eccentricity that no rotor has; the unbalance was given in g mm or kg mm.
    """
    for load in plan.loads:
        if isinstance(load, Unbalance):
            masses = [plan.mass(part) for part in plan.joined_parts(load.where.part)]
            mass = sum(m for m in masses if m is not None)
            if mass > 0.0 and load.moment > 0.0:
                name = (
                    f"unbalance at {load.where} is {load.moment:.6g} kg m on {mass:.4g} kg; its eccentricity"
                )
                plausible("eccentricity", name, load.moment / mass)
            if load.moment > 0.0 and _stands(plan, load.where.part):
                turning = sorted(plan.turning_parts())
                what = f"{', '.join(turning)} turns" if turning else "the other ring of its bearing turns"
                warn(
                    f"unbalance at {load.where} is on {load.where.part!r}, which stands: {what}; its force "
                    f"goes round with the shaft all the same. Put it on the part that turns, or make "
                    f"{load.where.part!r} one that does (rotating=True)",
                    StandingUnbalance,
                )


def _stands(plan: Plan, part: str) -> bool:
    """Whether something turns, and neither a part nor what is connected to it does."""
    group, known = plan.joined_parts(part), plan.turning_parts()
    speeds = [
        speed
        for joint in plan.bearings.values()
        for end, speed in zip((joint.inner, joint.outer), plan.ring_speeds(joint), strict=True)
        if end.part in group
    ]
    return not group & known and not any(speeds) and bool(known or speeds)
