"""A stepped flexible shaft with discs, reduced onto its bearing seats."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import scipy

from bearingdyn.checks import instance, items, named, number, positive
from bearingdyn.cms import (
    F_MAX,
    Basis,
    FullModel,
    RigidInterface,
    RoundFace,
    Superelement,
    basis_of,
    check_damping,
    check_f_max,
    project,
)
from bearingdyn.fem import Section, assemble_beam, bending_wavelength
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.disc import Disc
from bearingdyn.parts.outline import Outline, carried, cylinder, revolved
from bearingdyn.parts.profile import Profile, rectangle
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index
from bearingdyn.units import takes

KINDS: tuple[Literal["shaft", "bore"], ...] = ("shaft", "bore")
_SAME_SEAT = 0.01  # of the radius: a taper or a relief, no shoulder
ELEMENTS_PER_WAVE = 30  # error of a bending frequency: 1.3e-3 at most at f_max, 3.3e-4 at half of it


@takes(seats="m", points="m", f_max="Hz", element_length="m")
@dataclass(frozen=True)
class Shaft:
    """A flexible shaft along z, from z = 0 upward, turning about z.

    Parameters
    ----------
    sections
        Stacked one on the other.
    material
        Of all sections.
    seats
        name -> z, m: rigid six-coordinate interfaces, to be joined or to carry a bearing's ring.
    points
        name -> z, m: outputs, rows (6, n), where loads may act and motion is read.
    discs
        Rigid discs.
    damping
        Ratio ζ of every free elastic mode, turning with the shaft.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; by default 20 kHz. It must be above
        0, for the elements are chosen by it. Three to four times the highest frequency of interest keeps
        frequencies to about 0.1 %.
    element_length
        Longest beam element, m; by default 1/30 of the shortest bending wave at f_max.

    Raises
    ------
    ValueError
        For a position off the shaft, a name used twice, two seats in one place, values that are not positive
        and finite, more than 100 m in all, or an element longer than the shaft.

    References
    ----------
    J. S. Przemieniecki, Theory of Matrix Structural Analysis (Timoshenko element); H. D. Nelson, J. Mech.
    Design 102 (1980) 793 (gyroscopic terms).

    Examples
    --------
    >>> import bearingdyn as bd
    >>> seats = {"left": 0.02, "right": 0.28}
    >>> element = bd.Shaft([bd.Section(0.3, 0.03)], seats, points={"middle": 0.15}).superelement()
    >>> sorted(element.interfaces), sorted(element.outputs)
    (['left', 'right'], ['middle'])
    """

    sections: Sequence[Section]
    seats: Mapping[str, float]
    points: Mapping[str, float] = field(default_factory=dict)
    discs: Sequence[Disc] = ()
    material: Elastic = STEEL
    damping: float = 0.0
    f_max: float = F_MAX
    element_length: float | None = None

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        instance(
            "material", self.material, Elastic, "it must be a bd.Elastic(E, nu, density), such as bd.STEEL"
        )
        for name, kind in (("sections", Section), ("discs", Disc)):
            remedy = f"it must be a list of bd.{kind.__name__}"
            given = tuple(items(name, getattr(self, name), remedy))
            for k, one in enumerate(given):
                instance(f"{name}[{k}]", one, kind, f"it must be a bd.{kind.__name__}(…)")
            object.__setattr__(self, name, given)
        for name in ("seats", "points"):
            by_name = named(name, getattr(self, name), "it must be a dict, name -> position z in m")
            found = {
                k: number(f"{name}[{k!r}]", z, "it must be a position z in m") for k, z in by_name.items()
            }
            object.__setattr__(self, name, found)
        if not self.sections:
            raise ValueError("sections is empty; a shaft needs at least one Section")
        if not self.seats:
            raise ValueError("seats is empty; a shaft needs at least one seat to be joined by")
        L = self.length
        plausible("shaft length", "the length of all sections", L)
        places = [(f"seats[{k!r}]", v) for k, v in self.seats.items()]
        places += [(f"points[{k!r}]", v) for k, v in self.points.items()]
        places += [(f"discs[{i}].z", d.z) for i, d in enumerate(self.discs)]
        for name, z in places:
            if not -1e-9 * L <= z <= L * (1.0 + 1e-9):
                slip = f"; is it in mm? give {1e-3 * z:.6g} m" if 0 <= 1e-3 * z <= L and z >= 1 else ""
                raise ValueError(f"{name} is at z = {z} m; it must lie on the shaft, 0 to {L:.6g} m{slip}")
        for name in self.points:
            if name in self.seats:
                raise ValueError(f"points has {name!r}, the name of a seat already; choose another name")
        by_place = sorted(self.seats.items(), key=lambda item: item[1])
        for (a, za), (b, zb) in itertools.pairwise(by_place):
            if not zb - za > 1e-6 * L:
                raise ValueError(f"seats {a!r} and {b!r} are both at z = {za} m; move one, or keep one")
        check_damping(self.damping)
        check_f_max(self.f_max, may_be_zero=False)
        if self.element_length is not None:
            longest = positive("element_length", self.element_length)
            if not 1e-4 * L < longest <= L * (1.0 + 1e-9):
                raise ValueError(
                    f"element_length is {longest} m; it must exceed {1e-4 * L:.3g} m, and not the shaft's "
                    f"length, {L:.6g} m; is it in mm?"
                )

    @property
    def length(self) -> float:
        """Length of the shaft, m."""
        return math.fsum(s.length for s in self.sections)

    def nodes(self) -> tuple[Array, list[Section]]:
        """Node positions z (n,), m, rising, and the section of each of the n - 1 elements between them."""
        ends = np.concatenate([[0.0], np.cumsum([s.length for s in self.sections])])
        special = np.array([*self.seats.values(), *self.points.values(), *(d.z for d in self.discs)])
        wanted = np.sort(np.clip(np.concatenate([ends, special]), 0.0, ends[-1]))
        stops = wanted[np.concatenate([[True], np.diff(wanted) > 1e-6 * ends[-1]])]
        longest = self.element_length or min(
            bending_wavelength(s, self.material, self.f_max) / ELEMENTS_PER_WAVE for s in self.sections
        )
        z = [stops[:1]]
        sections: list[Section] = []
        for a, b in itertools.pairwise(stops):
            count = max(1, math.ceil((b - a) / longest * (1.0 - 1e-9)))
            z.append(np.linspace(a, b, count + 1)[1:])
            own = int(np.searchsorted(ends, 0.5 * (a + b))) - 1
            sections += [self.sections[own]] * count
        return np.concatenate(z), sections

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        return {name: self._seat_faces(z) for name, z in self.seats.items()}

    def _seat_faces(self, place: float) -> tuple[RoundFace, ...]:
        """Outside and bore of the section at a place, m; of both where two meet."""
        ends = [0.0, *itertools.accumulate(s.length for s in self.sections)]
        spans = list(itertools.pairwise(ends))
        near = 1e-6 * self.length
        found = []
        for k, (low, high) in enumerate(spans):
            if not low - near <= place <= high + near:
                continue
            for kind in KINDS:
                own = _radius(self.sections[k], kind)
                if own == 0.0:
                    continue
                # sections of the same diameter are one seat; thinner ones, or wider bores, leave room
                same = [abs(_radius(s, kind) - own) <= _SAME_SEAT * own for s in self.sections]
                sign = 1.0 if kind == "shaft" else -1.0
                open_ = [sign * (_radius(s, kind) - own) <= _SAME_SEAT * own for s in self.sections]
                z, room = (_reach(spans, yes, k) for yes in (same, open_))
                # nothing stands beyond the ends of the shaft
                room = (
                    -math.inf if room[0] == 0.0 else room[0] - place,
                    math.inf if room[1] == ends[-1] else room[1] - place,
                )
                found.append(RoundFace(kind, own, (z[0] - place, z[1] - place), room, beside=True, at=place))
        return tuple(found)

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it: its outside, step by step, and its discs; bores are hidden."""
        ends = np.cumsum([0.0, *(s.length for s in self.sections)])
        start = next(iter(self.seats.values()))
        shown = [
            Profile(rectangle((a - start, b - start), (-0.5 * s.d_outer, 0.5 * s.d_outer)), "shaft")
            for s, (a, b) in zip(self.sections, itertools.pairwise(ends.tolist()), strict=True)
        ]
        for disc in self.discs:
            radius, half = _cylinder_of(disc)
            z = (disc.z - start - half, disc.z - start + half)
            shown.append(Profile(rectangle(z, (-radius, radius)), "shaft"))
        return shown

    def full_model(self) -> FullModel:
        """The unreduced equations: sparse matrices, six coordinates at each of `nodes`."""
        z, sections = self.nodes()
        M, G, K = assemble_beam(z, sections, self.material)
        n = 6 * len(z)

        def coordinates(place: float) -> Index:
            return 6 * int(np.argmin(np.abs(z - place))) + np.arange(6)

        mass, gyro = np.zeros(n), scipy.sparse.lil_matrix((n, n))
        for disc in self.discs:
            at = coordinates(disc.z)
            mass[at] += [disc.mass] * 3 + [disc.Id, disc.Id, disc.Ip]
            gyro[at[3], at[4]] += disc.Ip
            gyro[at[4], at[3]] -= disc.Ip
        M, G = M + scipy.sparse.diags(mass), G + gyro.tocsr()

        def selection(place: float) -> scipy.sparse.csr_matrix:
            return scipy.sparse.csr_matrix((np.ones(6), (np.arange(6), coordinates(place))), shape=(6, n))

        seats = {
            name: RigidInterface(coordinates(place), np.eye(6), np.array([0.0, 0.0, place]))
            for name, place in self.seats.items()
        }
        points = {name: selection(place) for name, place in self.points.items()}
        return FullModel(M=M, G=G, K=K, interfaces=seats, outputs=points, spin=spin_generator(len(z)))

    def superelement(self) -> Superelement:
        """The shaft reduced onto its seats and the fixed-interface modes up to f_max."""
        model = self.full_model()
        element = project(model, self._basis(model), damping=self.damping)
        return replace(element, faces=self.round_faces())

    def _basis(self, model: FullModel) -> Basis:
        return basis_of(model, f_max=self.f_max, inertia=0)

    def outline(self) -> Outline:
        """Its surface at every node, plane sections staying plane.

        Discs, of which no more is known, are solid cylinders of their mass and moments.
        """
        z, sections = self.nodes()
        motion = self._basis(self.full_model()).Psi.reshape(len(z), 6, -1)
        # once around the section: out along the outside, back along the bore
        ends = np.repeat(np.arange(len(z)), 2)[1:-1]
        d = np.repeat([(s.d_outer, s.d_inner) for s in sections], 2, axis=0)
        corners = np.array([[*ends, *ends[::-1]], [*d[:, 0], *d[::-1, 1]]])
        (own, d_at), line = np.unique(corners, axis=1, return_inverse=True)
        line = line.ravel()
        nodes = own.astype(np.intp)
        points, faces, used = revolved(0.5 * d_at, z[nodes], np.stack([line, np.roll(line, -1)], axis=-1))
        drawn = [(points, faces, np.repeat(nodes[used], len(points) // used.size))]
        for disc in self.discs:
            radius, half = _cylinder_of(disc)
            node = int(np.argmin(np.abs(z - disc.z)))
            points, faces = cylinder(0.0, radius, (disc.z - half, disc.z + half))
            drawn.append((points, faces, np.full(len(points), node)))
        points, owner = (np.concatenate([each[k] for each in drawn]) for k in (0, 2))
        starts = np.cumsum([0, *(len(each[0]) for each in drawn)])
        faces = np.concatenate([each[1] + start for each, start in zip(drawn, starts, strict=False)])
        arms = points - z[owner, None] * np.array([0.0, 0.0, 1.0])
        return Outline(points, faces, carried(motion[owner], arms))


def _cylinder_of(disc: Disc) -> tuple[float, float]:
    """Radius and half the width, m, of the solid cylinder that has a disc's mass and moments."""
    radius = math.sqrt(2.0 * disc.Ip / disc.mass)
    return radius, 0.5 * math.sqrt(max(12.0 * disc.Id / disc.mass - 3.0 * radius**2, 0.0))


def _radius(section: Section, kind: str) -> float:
    """Of its outside ("shaft") or of its bore, m."""
    return 0.5 * (section.d_outer if kind == "shaft" else section.d_inner)


def _reach(spans: Sequence[tuple[float, float]], yes: Sequence[bool], k: int) -> tuple[float, float]:
    """From where to where the sections next to the k-th go on with yes, m."""
    first = last = k
    while first > 0 and yes[first - 1]:
        first -= 1
    while last + 1 < len(yes) and yes[last + 1]:
        last += 1
    return spans[first][0], spans[last][1]


def spin_generator(n_nodes: int) -> scipy.sparse.csr_matrix:
    """Shaft's spin as a matrix: J (6 n, 6 n) with ẋ = Ω J x when all nodes turn as one body about z."""
    one = np.zeros((6, 6))
    one[1, 0] = one[4, 3] = 1.0
    one[0, 1] = one[3, 4] = -1.0
    return scipy.sparse.csr_matrix(scipy.sparse.kron(scipy.sparse.eye(n_nodes), one))
