"""An application in words."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from bearingdyn.application.notes import GRAVITY, GROUND, Load
from bearingdyn.application.plan import Plan
from bearingdyn.application.rigid import free_motions
from bearingdyn.types import Array


def summary(app: Plan) -> str:
    """Parts with masses, joints, bearings, loads and free motions, one to a line."""
    lines = ["parts"]
    for name, element in app.parts.items():
        mass, T = app.mass(name), app.temperatures.get(name)
        lines.append(
            f"  {name:<16} {type(app.sources[name]).__name__:<12} {element.n:4d} coordinates"
            + ("" if mass is None else f"  {mass:9.4f} kg")
            + ("" if T is None else f"  {T:g} °C")
        )
    lines.append("joints")
    lines += [f"  {c.a} = {c.b}" for c in app.connections]
    for support in app.supports.values():
        held = "rigid" if support.rigid else "springs and dampers"
        lines.append(f"  {support.interface} = ground ({held}){_offset(support.offset)}")
    lines += [f"  {s.a} = {s.b} (springs and dampers){_offset(s.offset)}" for s in app.springs]
    lines += [f"  {name} free" for name in sorted(app.free_interfaces)]
    lines.append("bearings")
    for b in app.bearings.values():
        moved = f", offset {b.offset:g} m" if b.offset else ""
        lines.append(f"  {b.name}: {b.inner} in {b.outer}, {b.bearing.Z} balls{moved}")
    for f in app.fits.values():
        lines.append(f"  {f.name}: {f.ring} loose in {f.bore}, {f.fit.clearance * 1e6:g} µm")
    lines.append("loads")
    lines += [f"  {load.where}: {load.kind} {_number(load)}" for load in app.loads]
    lines.append("free motions")
    shapes = {name: app.rigid_shapes(name) for name in app.parts}
    motions = free_motions(shapes, _constraints(app))
    lines += ["  " + ", ".join(f"{part} {c}" for part, c in motion) for motion in motions] or ["  none"]
    return "\n".join(lines)


def _number(load: Load) -> str:
    if load.kind == "rotating":
        return f"{load.unbalance:g} kg m"
    size = 3 if load.where in (GROUND, GRAVITY) else 6
    return str(np.round(load.vector, 6).tolist()[:size])


def _offset(offset: Array | None) -> str:
    return f", offset {offset.tolist()}" if offset is not None and offset.any() else ""


def _constraints(app: Plan) -> Iterator[Mapping[str, Array]]:
    """Relative motions that a joint, a spring or a bearing holds, by part."""

    def rows(name: str) -> tuple[str, Array]:
        part, _, rest = name.partition(".")
        return part, app.parts[part].rows(rest)

    def between(a: str, b: str, pick: Array) -> Mapping[str, Array]:
        part, of_a = rows(a)
        both = {part: pick @ of_a}
        if b != GROUND:
            part, of_b = rows(b)
            both[part] = both.get(part, 0.0) - pick @ of_b
        return both

    whole = np.eye(6)
    for c in app.connections:
        yield between(c.a, c.b, whole)
    for support in app.supports.values():
        stiff = np.ones(6) if support.rigid else support.stiffness
        if stiff is not None and stiff.any():
            yield between(support.interface, GROUND, whole[stiff > 0])
    for spring in app.springs:
        if spring.stiffness.any():
            yield between(spring.a, spring.b, whole[spring.stiffness > 0])
    for b in app.bearings.values():
        raceway = app.raceway(b.outer)
        if raceway is None:
            yield between(b.inner, b.outer, b.bearing.coefficients())
        else:
            part, of_inner = rows(b.inner)
            held = b.bearing.coefficients(raceway.series) @ of_inner
            yield {part: held, b.outer.partition(".")[0]: -raceway.rows}
    for f in app.fits.values():
        raceway = app.raceway(f.ring)
        assert raceway is not None  # the application checked
        held_ring = {f.ring.partition(".")[0]: raceway.rows}
        if f.bore != GROUND:
            part, of_bore = rows(f.bore)
            held_ring[part] = -raceway.series.rigid(raceway.arm) @ of_bore
        yield held_ring
