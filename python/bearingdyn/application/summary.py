"""An application in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from bearingdyn.application.channel import GROUND
from bearingdyn.application.free_motions import free_motions
from bearingdyn.application.place import Place
from bearingdyn.application.plan import Plan
from bearingdyn.bearing import RIGID
from bearingdyn.types import Array


def summary(plan: Plan) -> str:
    """Summary of an application: parts, masses, joints, bearings, loads, free motions, one to a line."""
    lines = ["parts"]
    for name, element in plan.parts.items():
        mass, T = plan.mass(name), plan.temperatures.get(name)
        lines.append(
            f"  {name:<16} {type(plan.sources[name]).__name__:<12} {element.n:4d} coordinates"
            + ("" if mass is None else f"  {mass:9.4f} kg")
            + ("" if T is None else f"  {T:g} °C")
        )
    lines.append("joints")
    lines += [f"  {c.a} = {c.b}" for c in plan.connections]
    for support in plan.supports.values():
        held = "rigid" if support.rigid else "springs and dampers"
        lines.append(f"  {support.interface} = ground ({held}){_offset(support.offset)}")
    lines += [f"  {s.a} = {s.b} (springs and dampers){_offset(s.offset)}" for s in plan.springs]
    lines += [f"  {place} free" for place in sorted(plan.free_interfaces)]
    lines.append("bearings")
    for b in plan.bearings.values():
        moved = (f", at {b.place:g} m" if b.place else "") + (f", offset {b.offset:g} m" if b.offset else "")
        lines.append(f"  {b.name}: {b.inner} in {b.outer}, {b.bearing.Z} balls{moved}")
    for f in plan.fits.values():
        lines.append(f"  {f.name}: {f.ring} loose in {f.bore}, {f.fit.clearance * 1e6:g} µm")
    lines.append("loads")
    lines += [f"  {load.where}: {load.kind} {load.size}" for load in plan.loads]
    lines.append("free motions")
    lines += [f"  {motion}" for motion in loose_motions(plan)] or ["  none"]
    return "\n".join(lines)


def loose_motions(plan: Plan) -> list[str]:
    """Summary's last lines: motions that nothing holds, each in words.

    Parameters
    ----------
    plan
        Of the application.
    """
    shapes = {name: plan.rigid_shapes(name) for name in plan.parts}
    motions = free_motions(shapes, _constraints(plan))
    return [", ".join(f"{part} {c}" for part, c in motion) for motion in motions]


def _offset(offset: Array | None) -> str:
    return f", offset {offset.tolist()}" if offset is not None and offset.any() else ""


def _constraints(plan: Plan) -> Iterator[Mapping[str, Array]]:
    """Relative motions that a joint, a spring or a bearing holds, by part."""

    def between(a: Place, b: Place, pick: Array) -> Mapping[str, Array]:
        both = {a.part: pick @ plan.rows(a)}
        if b != GROUND:
            both[b.part] = both.get(b.part, 0.0) - pick @ plan.rows(b)
        return both

    whole = np.eye(6)
    for c in plan.connections:
        yield between(c.a, c.b, whole)
    for support in plan.supports.values():
        stiff = np.ones(6) if support.rigid else support.stiffness
        if stiff is not None and stiff.any():
            yield between(support.interface, GROUND, whole[stiff > 0])
    for spring in plan.springs:
        if spring.stiffness.any():
            yield between(spring.a, spring.b, whole[spring.stiffness > 0])
    for b in plan.bearings.values():
        sides = [(b.inner, 1.0, plan.raceway(b.inner)), (b.outer, -1.0, plan.raceway(b.outer))]
        series = next((race.series for _, _, race in sides if race is not None), RIGID)
        rows: dict[str, Array] = {}
        for place, sign, race in sides:
            if place != GROUND:
                own = b.coefficients(series) @ plan.rows(place) if race is None else race.rows
                rows[place.part] = rows.get(place.part, 0.0) + sign * own
        yield rows
    for f in plan.fits.values():
        raceway = plan.raceway(f.ring)
        assert raceway is not None  # the application checked
        held_ring = {f.ring.part: raceway.rows}
        if f.bore != GROUND:
            held_ring[f.bore.part] = -raceway.series.rigid(raceway.arm) @ plan.rows(f.bore)
        yield held_ring
