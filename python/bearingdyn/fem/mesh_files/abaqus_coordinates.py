"""Where an input file of Abaqus puts what it numbers: systems of coordinates, and instances of parts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.fem.abaqus_input import Block, real
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class System:
    """A coordinate system of Abaqus: local axes as rows of `axes` (3, 3), and their origin (3,)."""

    origin: Array
    axes: Array


def _lines(block: Block, sizes: tuple[int, ...]) -> list[Array]:
    """Numbers of the data lines, a vector each of so many at most; blanks are zero."""
    found = []
    for k, line in enumerate(block.lines):
        words = [w.strip() for w in line.removesuffix(",").split(",")]
        if k >= len(sizes) or len(words) > sizes[k]:
            raise block.fault(f"{line[:60]!r}: the line has more numbers than it can use", k)
        try:
            found.append(np.array([real(w) for w in words]))
        except ValueError as error:
            raise block.fault(error, k) from error
    return found


def _unit(v: Array, block: Block, what: str) -> Array:
    length = float(np.linalg.norm(v))
    if not length > 0:
        raise block.fault(f"{what} has no length; the points must differ")
    return v / length


def system(block: Block) -> System | None:
    """The coordinates of *SYSTEM: origin a, b on the x axis, and c in the xy plane; None without data.

    With a alone the axes stay, and without c the z axis does (Abaqus Keywords Reference Guide, *SYSTEM).
    """
    data = _lines(block, (6, 3))
    if not data:
        return None
    if data[0].size not in (3, 6):
        raise block.fault("its first line holds a point a, or points a and b, of three numbers each", 0)
    a = data[0][:3]
    if data[0].size == 3:
        return System(a, np.eye(3))
    x = _unit(data[0][3:] - a, block, "its x axis")
    if len(data) == 1:
        if abs(x[2]) > 1e-9:
            raise block.fault("its x axis leaves the xy plane; give point c on a second line")
        y = np.array([-x[1], x[0], 0.0])
    else:
        c = np.pad(data[1], (0, 3 - data[1].size)) - a
        y = _unit(c - (c @ x) * x, block, "its y axis")
    return System(a, np.stack([x, y, np.cross(x, y)]))


def from_polar(points: Array, block: Block) -> Array:
    """Coordinates x, y, z of Abaqus' *NODE, SYSTEM=R, C (r, θ, z) or S (r, θ, φ); angles in degrees.

    φ of the spherical system rises from the xy plane to the pole.
    """
    kind = block.options.get("SYSTEM", "R").upper()
    if kind not in ("R", "C", "S"):
        raise block.fault(f"SYSTEM={kind}; it must be R, C or S")
    if kind == "R":
        return points
    r, theta = points[:, 0], np.radians(points[:, 1])
    if kind == "C":
        return np.stack([r * np.cos(theta), r * np.sin(theta), points[:, 2]], axis=1)
    phi = np.radians(points[:, 2])
    level = r * np.cos(phi)
    return np.stack([level * np.cos(theta), level * np.sin(theta), r * np.sin(phi)], axis=1)


def moved(block: Block) -> tuple[Array, Array]:
    """Coordinates of Abaqus' *INSTANCE: matrix (3, 3) and shift (3,), x' = matrix x + shift.

    The part is shifted first, then turned about the axis from a to b by an angle in degrees.
    """
    data = _lines(block, (3, 7))
    shift = np.pad(data[0], (0, 3 - data[0].size)) if data else np.zeros(3)
    if len(data) < 2:
        return np.eye(3), shift
    if data[1].size != 7:
        raise block.fault("its second line holds points a and b of the axis and the angle, seven numbers", 1)
    a, angle = data[1][:3], np.radians(data[1][6])
    x, y, z = _unit(data[1][3:6] - a, block, "its axis")
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return turn, turn @ (shift - a) + a
