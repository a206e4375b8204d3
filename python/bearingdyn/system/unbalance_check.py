"""Whether an unbalance suits the mass that moves with it."""

from __future__ import annotations

from bearingdyn.application import Plan, Unbalance
from bearingdyn.plausible_ranges import MAGNITUDES, plausible


def check_unbalance(plan: Plan) -> None:
    """Check each unbalance against the mass that moves with its place: eccentricities are micrometres.

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
                e, row = load.moment / mass, MAGNITUDES["eccentricity"]
                units = (("g mm", 1e-6), ("kg mm", 1e-3))
                slips = [
                    f"; is the unbalance in {unit}? give {load.moment * scale:.4g} kg m"
                    for unit, scale in units
                    if row.within(e * scale, row.usual)
                ]
                plausible("eccentricity", name, e, hint=slips[0] if slips else "")
