"""Where the parts of a plan stand, and what the plane x = 0 shows of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bearingdyn.application import BearingJoint, Place, Plan, arm
from bearingdyn.parts import HasProfile, Matter, Outline, Outlined, Profile, cut
from bearingdyn.types import Array


@dataclass(frozen=True)
class Shown:
    """What is drawn of one part of a machine: outlines in mm from the first interface of the first part."""

    name: str
    profiles: tuple[Profile, ...]

    def reach(self, z: float, near: float = 0.0) -> tuple[float, float] | None:
        """Lowest and highest y, mm, of the part at a z, mm; None where it is not there."""
        found = [
            p.corners[:, 1]
            for p in self.profiles
            if p.corners[:, 0].min() - near <= z <= p.corners[:, 0].max() + near
        ]
        if not found:
            return None
        y = np.concatenate(found)
        return float(y.min()), float(y.max())


@dataclass(frozen=True)
class Machine:
    """A machine as it is drawn: places by name, (3,) mm, and the parts that can be shown."""

    plan: Plan
    places: dict[str, Array]
    parts: tuple[Shown, ...]

    @property
    def missing(self) -> list[str]:
        """Parts without a known place or shape."""
        return [name for name in self.plan.parts if name not in {p.name for p in self.parts}]

    def reach(self, z: float, part: str | None = None) -> tuple[float, float] | None:
        """Lowest and highest y, mm, of all parts or of one at a z, mm."""
        found = [p.reach(z) for p in self.parts if part in (None, p.name)]
        known = [f for f in found if f is not None]
        return (min(f[0] for f in known), max(f[1] for f in known)) if known else None

    def balls(self, joint: BearingJoint) -> Array | None:
        """Centre (3,) of a bearing's balls, mm, beside its interface where it is a row of a set; or None."""
        at = self.places.get(str(joint.inner))
        return None if at is None else at + (0.0, 0.0, 1e3 * joint.place)

    def corners(self) -> Array:
        """All corners (k, 2), mm."""
        return np.concatenate([q.corners for p in self.parts for q in p.profiles] or [np.zeros((1, 2))])


def machine(plan: Plan) -> Machine:
    """The machine of a plan, ready to be drawn."""
    places = {name: 1e3 * at for name, at in plan.positions().items()}
    return Machine(plan, places, tuple(_shown(plan, places)))


def _shown(plan: Plan, places: dict[str, Array]) -> Iterator[Shown]:
    for name, element in plan.parts.items():
        first = next(iter((*element.interfaces, *element.raceways)), None)
        at = places.get(f"{name}.{first}")
        if at is None:
            continue
        source = plan.sources[name]
        own = source.profile() if isinstance(source, HasProfile) else ()
        if own:
            yield Shown(name, tuple(Profile(at[[2, 1]] + 1e3 * p.corners, p.matter) for p in own))
        elif isinstance(source, Outlined):
            matter: Matter = "rubber" if element.viscoelastic else "metal"
            points = 1e3 * placed(plan, name, source.outline()) + at
            lines = cut(points, source.outline().faces)
            if lines:
                yield Shown(name, tuple(Profile(each, matter) for each in lines))


def placed(plan: Plan, name: str, outline: Outline) -> Array:
    """Points (p, 3) of the outline of a part of a drawn machine from its first interface, m."""
    rigid = plan.rigid_shapes(name)
    assert rigid is not None  # the part has a known place
    mean = outline.rows.reshape(-1, 3, outline.rows.shape[1]).mean(axis=0)
    return np.asarray(outline.points + arm(mean, rigid) - outline.points.mean(axis=0))


def surface(machine: Machine, place: Place) -> tuple[float, float, float, float] | None:
    """For a shown machine: sign, radius and reach along z, mm, of the cylinder by which a part is held."""
    faces, at = machine.plan.faces(place), machine.places.get(str(place))
    if not faces or at is None:
        return None
    face = faces[-1]
    sign = 1.0 if face.kind == "shaft" else -1.0
    low, high = (float(np.clip(1e3 * z, -1e4, 1e4)) for z in face.z)
    return sign, 1e3 * face.radius, at[2] + low, at[2] + high
