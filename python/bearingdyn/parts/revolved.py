"""Bodies of revolution with rigid interfaces and raceways: rings, bonded samples, any section in (r, z)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import NoneType

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, items, named, require, vector, whole
from bearingdyn.cms import (
    Basis,
    FullModel,
    RoundFace,
    Superelement,
    check_damping,
    check_f_max,
    check_moduli,
    check_rounds,
    face_of_nodes,
    modulus_levels,
)
from bearingdyn.fem import (
    ALL_COMPONENTS,
    AXIAL,
    TORSION,
    Harmonic,
    NoBalance,
    RevolutionMesh,
    assemble_harmonic,
    revolution_mesh,
)
from bearingdyn.material import NEO_HOOKE, Elastic, Hyperelastic
from bearingdyn.parts.groove_compliance import carried_compliance, groove_compliances
from bearingdyn.parts.hoop_stress import hoop_stress_rows
from bearingdyn.parts.mesh_waves import check_waves
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.prestress import Prestress, Travel, check_branches, check_law, constant_volume, squeeze
from bearingdyn.parts.profile import Profile
from bearingdyn.parts.quasi_static_modulus import quasi_static, quasi_static_bulk
from bearingdyn.parts.raceway_shapes import Order, PortShapes, port_shapes
from bearingdyn.parts.regions import Patch, Region, is_rubber, soft_elements
from bearingdyn.parts.revolved_drawing import section_profile, surface_outline
from bearingdyn.parts.revolved_faces import FACES, Cylinder, EndFace, Face, Groove
from bearingdyn.parts.revolved_full import full_basis, full_model
from bearingdyn.parts.revolved_joints import RIGID_SHAPES, Boundaries, find_boundaries
from bearingdyn.parts.revolved_matrices import reduced
from bearingdyn.parts.revolved_modes import RevolvedModes, modes_of_order
from bearingdyn.parts.revolved_shapes import ShapeMaker
from bearingdyn.parts.revolved_strain import strain_of_motion
from bearingdyn.parts.rubber_zones import RubberZone, rubber_zones
from bearingdyn.parts.shape_moduli import moduli_at, shape_moduli
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.parts.strain import Strain
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index


@dataclass(frozen=True, eq=False)
class Revolved:
    """A body of revolution about z, not turning, of one or more regions bonded where they touch.

    Parameters
    ----------
    regions
        Rings of rectangular section; or, with a mesh in `section`, a Patch for each of its regions.
    interfaces
        name -> Cylinder, EndFace, Line, Where or MeshNodes, each moving as a rigid body with six coordinates
        (x, y, z, θx, θy, θz) about the point of the axis in the middle of the face.
    outputs
        name -> point (r, z, φ), m, m, rad; its rows (3, n) give x, y, z, in the orders that are carried: 0
        and 1, and those of the grooves.
    damping
        Ratio ζ of the free elastic modes of the elastic regions, to which the rubber adds its mass alone.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none, the default of bodies of
        revolution. They are taken at the lowest of the moduli. With grooves: what raceways and interfaces
        feel is right to 1 % up to there, see raceway_shapes.
    moduli
        Real shear moduli, Pa, of the viscoelastic regions at which static shapes are taken; None: the relaxed
        modulus and |G*| at the fastest relaxation time of each material, and their geometric mean if they are
        more than a hundredfold apart. Each modulus after the first adds up to five shapes for two interfaces.
    refinement
        Mesh density; 1 gives layer stiffnesses within some 0.02 %. A mesh in `section` is taken as it is.
    grooves
        name -> Groove, a face that carries balls by its Fourier orders. The rest of the surface is free.
    section
        A mesh of the section, as `quadrilaterals` makes it; None: the regions are meshed.
    inertia
        How many rounds of cms.inertia_shapes follow the static shapes of each modulus. One round serves a
        layer or a sample better than many fixed-interface modes.
    prestress
        The static state of a body that `assembled` has squeezed; its mesh is then where the state is. None:
        at rest, without stress.

    Raises
    ------
    ValueError
        For regions that overlap, faces that are not part of the body or share a node, a point outside the
        section, a mesh whose regions do not fit, values outside their range, and, with grooves, an f_max
        whose shear waves the mesh does not hold.

    References
    ----------
    Paper section 3.3; harmonics, Zienkiewicz & Taylor, The Finite Element Method, vol. 2, ch. 9.
    """

    regions: tuple[Region | Patch, ...]
    interfaces: Mapping[str, Face] = field(default_factory=dict)
    outputs: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    damping: float = 0.0
    f_max: float = 0.0
    moduli: tuple[float, ...] | None = None
    refinement: float = 1.0
    grooves: Mapping[str, Groove] = field(default_factory=dict)
    section: RevolutionMesh | None = None
    inertia: int = 0
    prestress: Prestress | None = field(default=None, repr=False)

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "regions", tuple(items("regions", self.regions, "it must be a list of Region"))
        )
        instance("prestress", self.prestress, (Prestress, NoneType), "it comes of assembled(…)")
        instance("section", self.section, (RevolutionMesh, NoneType), "it must be of bd.quadrilaterals(…)")
        for name, face in named("interfaces", self.interfaces, "it must be a mapping, name -> face").items():
            remedy = "it must be a Cylinder, EndFace, Line, Where or MeshNodes"
            instance(f"interfaces[{name!r}]", face, FACES, remedy)
        for name, groove in named("grooves", self.grooves, "it must be a mapping, name -> Groove").items():
            instance(f"grooves[{name!r}]", groove, Groove, "it must be a Groove")
        check_damping(self.damping)
        check_f_max(self.f_max)
        check_rounds(self.inertia)
        if self.moduli is not None:
            object.__setattr__(self, "moduli", check_moduli(self.moduli))
        self._check_regions()
        mesh = self.mesh  # refuses regions that overlap and faces that do not exist
        if self.grooves and self.f_max > 0:
            check_waves(mesh, self.regions, self.f_max, self.refinement)
        owner: dict[int, str] = {}
        for name, nodes in self._boundaries.nodes():
            for node in nodes.tolist():
                if owner.setdefault(node, name) != name:
                    raise ValueError(
                        f"interfaces {owner[node]!r} and {name!r} share the circle "
                        f"r = {self.mesh.r[node]:g}, z = {self.mesh.z[node]:g} m; keep them apart"
                    )
        remedy = "it must be places (r, z, azimuth) in m and rad, by name"
        for name, place in named("outputs", self.outputs, remedy).items():
            r, z, _ = vector(f"outputs[{name!r}]", place, (3,), "r and z in m, azimuth in rad").tolist()
            if name in self.interfaces or name in self.grooves:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
            try:
                self.mesh.locate(r, z)
            except ValueError as error:
                raise ValueError(f"outputs[{name!r}]: {error}") from error

    def _check_regions(self) -> None:
        twice = sorted(set(self.interfaces) & set(self.grooves))
        if twice:
            raise ValueError(f"grooves has {twice[0]!r}, the name of an interface; choose another")
        kind = Region if self.section is None else Patch
        for k, q in enumerate(self.regions):
            if not isinstance(q, kind):
                where = "without a mesh in section" if self.section is None else "for a mesh in section"
                raise ValueError(f"regions[{k}] is {q!r}; {where} it must be a {kind.__name__}")
        if self.section is not None:
            plausible("length", "the size of the section", self.section.size)
        if self.section is not None and int(self.section.region.max()) + 1 != len(self.regions):
            raise ValueError(
                f"section has {int(self.section.region.max()) + 1} regions and there are materials for "
                f"{len(self.regions)}; give a Patch for each"
            )

    @property
    def mass(self) -> float:
        """Mass, kg."""
        ring = self._harmonic(0, TORSION).mass
        return float(np.array(self._density) @ ring.sum(axis=1))

    @property
    def polar_inertia(self) -> float:
        """Moment of inertia about the axis, kg m²."""
        h = self._harmonic(0, TORSION)
        return float(self.mesh.r @ (h.mass_matrix(self._density) @ self.mesh.r))

    @cached_property
    def mesh(self) -> RevolutionMesh:
        """The mesh of the section."""
        if self.section is not None:
            return self.section
        rectangles = [q.rectangle for q in self.regions if isinstance(q, Region)]
        tracks = [g.surface for g in self.grooves.values()]
        r_cuts = [
            r for f in (*self.interfaces.values(), *tracks) if isinstance(f, EndFace) and f.r for r in f.r
        ]
        z_cuts = [z for f in self.interfaces.values() if isinstance(f, Cylinder) and f.z for z in f.z]
        z_near = [z for f in tracks if isinstance(f, Cylinder) and f.z for z in f.z]
        for groove in self.grooves.values():
            if groove.footprint is not None:
                z_near += groove.footprint.lines()
        return revolution_mesh(rectangles, self.refinement, r_cuts, z_cuts, z_near)

    @cached_property
    def _boundaries(self) -> Boundaries:
        if self.prestress is not None:
            return Boundaries(self.prestress.faces, {})
        return find_boundaries(self.mesh, self.interfaces, self.grooves)

    @property
    def _load_terms(self) -> Array:
        """What the forces of a prestress add to the stiffness of its faces' coordinates, (6 i,)."""
        terms = np.zeros((len(self.interfaces), 6))
        if self.prestress is not None:
            for row, name in zip(terms, self._boundaries.faces, strict=True):
                tilt, torsion = self.prestress.load_terms[name]
                row[3:] = tilt, tilt, torsion
        return terms.ravel()

    @cached_property
    def _harmonics(self) -> dict[tuple[int, tuple[int, ...]], Harmonic]:
        return {}

    def _harmonic(self, order: int, components: tuple[int, ...]) -> Harmonic:
        key = (order, components)
        if key not in self._harmonics:
            self._harmonics[key] = (
                assemble_harmonic(self.mesh, order, components)
                if self.prestress is None
                else self.prestress.state.harmonic(order, components, self.prestress.branches)
            )
        return self._harmonics[key]

    @property
    def _bulk(self) -> list[float]:
        return [q.material.K for q in self.regions]

    @property
    def _density(self) -> list[float]:
        return [q.material.density for q in self.regions]

    def _shape_maker(self) -> ShapeMaker:
        return ShapeMaker(
            boundaries=self._boundaries,
            bulk=self._bulk,
            density=self._density,
            f_max=self.f_max,
            size=self.mesh.size,
            inertia_rounds=self.inertia,
        )

    def stiffness(self, omega: float = 0.0, after: float | None = None) -> Complex:
        """Quasi-static complex stiffness (6 i, 6 i) of the i interfaces at G*(ω), N/m, N, N m; ω in rad/s.

        The whole finite element model is solved anew at G*(ω), without inertia: exact but for the mesh.
        `after` takes G(t) after that time, s, instead of the relaxed modulus that ω = 0 has.

        Raises
        ------
        ValueError
            Where a viscoelastic material has no shear stiffness, as G0 = 0 at ω = 0.

        Warns
        -----
        BeyondData
            At rest, where the data of a material do not speak of the time.
        """
        if not self.interfaces:
            raise ValueError("interfaces is empty; a stiffness needs at least one")
        shear = [quasi_static(q.material, omega, after) for q in self.regions]
        bulk = [quasi_static_bulk(q.material, omega, after) for q in self.regions]
        maker = replace(self._shape_maker(), bulk=bulk)
        rigid = Boundaries(self._boundaries.faces, {})
        S = np.zeros((rigid.n, rigid.n), dtype=np.complex128)
        for order, components, copies in rigid.families():
            h = self._harmonic(order, components)
            _, k = maker.constraint_shapes(h, shear)
            for copy in range(copies):
                index, sign = rigid.place(h, copy)
                S[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (k + k.T)
        return S + np.diag(self._load_terms)

    def assembled(
        self,
        press: Mapping[str, Travel],
        *,
        slip: Iterable[str] = (),
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
    ) -> Squeezed:
        """The body squeezed by its rigid interfaces, at finite strain, to which it then sticks.

        Parameters
        ----------
        press
            interface -> how far it moves into the body along its normal, r or z, m; or its motion (dr, dz),
            m. All others stay where they are.
        slip
            Interfaces without friction while they are pressed on. The body may part from them, and more of
            its free surface come to touch them: of an O-ring they are the lines of first contact, and the
            rigid surfaces the cylinders, or planes, that touch the body there. All others are bonded from
            the start.
        law
            Strain energy of the viscoelastic regions, and of elastic ones with ν of 0.45 or more: NeoHooke(),
            the default, MooneyRivlin or Yeoh, scaled to the modulus of each. Other regions are neo-Hookean.
        branches
            What of the stiffness depends on the frequency. "current": the branches have relaxed, and start
            anew about the static state, as the linear law in its deformed place. "separable": the static
            law's moduli times a function of time (Simo, Morman). They differ by 1 % at 10 % of squeeze.
        after
            Take the static modulus G(t) after this time, s, instead of the relaxed one.

        Raises
        ------
        ValueError
            Naming the share of the squeeze that was reached, where elements turn inside out, a free surface
            folds over the edge of a bond, or the law is not stable; for names of no interface, a body
            with raceways, or one that is squeezed already.

        References
        ----------
        Simo & Hughes, Computational Inelasticity, 1998, ch. 9; Morman, 7th Int. Conf. on Vehicle Structural
        Mechanics, 1988.
        """
        try:
            return self.squeezed(press, slip=slip, law=law, branches=branches, after=after)
        except NoBalance as failure:
            raise ValueError(
                f"press is {dict(press)} m; {failure.share:.0%} of it is reached: {failure.reason}"
            ) from None

    def squeezed(
        self,
        press: Mapping[str, Travel],
        *,
        slip: Iterable[str] = (),
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
    ) -> Squeezed:
        """What `assembled` does, with a NoBalance that knows the share reached, for ready forms to tell."""
        named("press", press, "it must be {interface: depth in m}")
        require(not self.grooves, "grooves", sorted(self.grooves), "a body with raceways cannot be squeezed")
        require(self.prestress is None, "prestress", "there", "squeeze the body once, from its state at rest")
        require(bool(press), "press", press, f"name one of the interfaces {sorted(self.interfaces)}")
        constant_volume(q.material for q in self.regions)
        check_branches(branches)
        rubber = check_law(law)
        prestress = squeeze(
            self.mesh,
            self._boundaries.faces,
            press,
            slip,
            [rubber if is_rubber(q.material) else NEO_HOOKE for q in self.regions],
            [quasi_static(q.material, 0.0, after).real for q in self.regions],
            self._bulk,
            branches,
        )
        deformed = replace(
            self,
            regions=tuple(Patch(q.material) for q in self.regions),
            section=prestress.state.mesh,
            outputs={name: prestress.moved(p) for name, p in self.outputs.items()},
            prestress=prestress,
        )
        return prestress.told(deformed, next(iter(press)))

    def _free_of_rigid_motion(self, n: int) -> Array:
        """Projector (n, n) that takes rigid motion out: what round-off leaves of its stiffness.

        A prestress that pushes its faces apart along the axis turns with them: there it takes out nothing.
        """
        if self.prestress is not None and not self.prestress.self_balanced:
            return np.eye(n)
        R = self._boundaries.rigid_motion(n) if self.interfaces else np.zeros((n, 0))
        moving = [
            index[k]
            for (_, _, places), shapes in zip(
                self._placed(), self._ports if self.grooves else (), strict=False
            )
            for index, _ in places
            for k in range(shapes.faces, shapes.faces + shapes.rigid)
        ]
        Q = np.linalg.qr(np.hstack([R, np.eye(n)[:, moving]]))[0]
        return np.asarray(np.eye(n) - Q @ Q.T)

    @cached_property
    def _families(self) -> list[tuple[Harmonic, Array, int, int]]:
        """Each family with its shapes, the number of constraint shapes among them, and its copies."""
        if self.grooves:
            return [
                (o.h, s.Psi, s.faces, copies)
                for (o, copies), s in zip(self._orders, self._ports, strict=True)
            ]
        levels = shape_moduli(self.regions, self.moduli)
        found = []
        for order, components, copies in self._boundaries.families():
            h = self._harmonic(order, components)
            found.append((h, *self._shape_maker().basis(h, levels), copies))
        return found

    def order(self, n: int, components: tuple[int, ...] | None = None) -> Order:
        """The whole model of order n: its matrices, what is held, and the rows of the raceways' coefficients.

        Raises
        ------
        ValueError
            For components that do not make up an order.
        """
        h = self._harmonic(n, (AXIAL if n == 0 else ALL_COMPONENTS) if components is None else components)
        held, R = self._boundaries.held(h)
        ports = self._boundaries.averages(h)
        return Order(h=h, bulk=self._bulk, density=self._density, held=held, R=R, ports=ports)

    def groove_compliance(self, n: int, groove: str, direction: Array) -> float:
        """Static compliance of order n of a groove along a direction (r, z), the interfaces held, m/N.

        Of any order, carried or not; rubber at its relaxed modulus. Of a body that nothing holds, order 0 is
        that of the radial part alone.

        Raises
        ------
        ValueError
            In an order in which nothing holds the body.
        """
        at = 2 * list(self.grooves).index(groove)
        return float(direction @ self.groove_compliances(n)[at : at + 2, at : at + 2] @ direction)

    def groove_compliances(self, n: int) -> Array:
        """The same of all grooves together: (2 grooves, 2 grooves), m/N, radial and axial of each in turn.

        Of order 0 of a body that nothing holds only the radial part is there, its axial one zero.

        Raises
        ------
        ValueError
            In an order in which nothing holds the body.
        """
        shear = shape_moduli(self.regions, self.moduli)[0]
        return groove_compliances(self.mesh, self._boundaries, self._bulk, shear, n)

    def carried_compliance(self, n: int, groove: str, direction: Array) -> float:
        """The same of an order that is carried, from its shapes, which have it exactly: m/N."""
        shear = shape_moduli(self.regions, self.moduli)[0]
        for (order, _), shapes in zip(self._orders, self._ports, strict=True):
            if order.h.order == n and order.h.components != TORSION:
                return carried_compliance(
                    order, shapes, shear, 2 * list(self.grooves).index(groove), direction
                )
        raise ValueError(f"order {n} is not carried")

    @cached_property
    def _orders(self) -> list[tuple[Order, int]]:
        return [(self.order(n, components), copies) for n, components, copies in self._boundaries.families()]

    @cached_property
    def _ports(self) -> list[PortShapes]:
        """Shapes of each family of a body with grooves."""
        levels = shape_moduli(self.regions, self.moduli)
        slow = self._shape_maker().slow_rate(levels[-1])
        return [
            port_shapes(order, levels, lambda omega: moduli_at(self.regions, omega), self.f_max, slow)
            for order, _ in self._orders
        ]

    @property
    def error(self) -> dict[int, float]:
        """Estimate, by order, of the largest relative error over 0…f_max of what raceways and interfaces
        feel.

        Raises
        ------
        ValueError
            For a body without grooves: `cms.reduction_error` tells it of the basis.
        """
        if not self.grooves:
            raise ValueError("grooves is empty; ask reduction_error(part.full_model(), part.basis(), …)")
        found: dict[int, float] = {}
        for (order, _), shapes in zip(self._orders, self._ports, strict=True):
            found[order.h.order] = max(shapes.error, found.get(order.h.order, 0.0))
        return found

    @property
    def _size(self) -> int:
        """Number of coordinates of the superelement."""
        internal = (copies * int(Psi.shape[1] - fixed) for _, Psi, fixed, copies in self._families)
        return self._boundaries.n + sum(internal)

    def _placed(self) -> Iterator[tuple[Harmonic, Array, list[tuple[Index, Array]]]]:
        """Each family with its shapes, and the coordinates and signs of these in each of its copies."""
        end = self._boundaries.n
        for h, Psi, fixed, copies in self._families:
            places = []
            for copy in range(copies):
                index, sign = self._boundaries.place(h, copy)
                internal = np.arange(end, end + Psi.shape[1] - fixed)
                end += internal.size
                places.append(
                    (np.concatenate([index, internal]), np.concatenate([sign, np.ones(internal.size)]))
                )
            yield h, Psi, places

    def full_model(self) -> FullModel:
        """The unreduced equations of orders 0 and 1 (those that rigid interfaces excite), sparse.

        Raises
        ------
        ValueError
            For a body with grooves: a full model is joined by rigid interfaces only.
        """
        if self.grooves:
            raise ValueError(
                f"grooves are {sorted(self.grooves)}; an unreduced model has rigid interfaces only"
            )
        families = [
            (self._harmonic(order, components), copies)
            for (order, components), copies in RIGID_SHAPES.items()
        ]
        model = full_model(families, self.regions, self._boundaries.faces, self.outputs)
        if self.prestress is None:
            return model
        extra = scipy.sparse.lil_matrix((model.n, model.n))
        for face, terms in zip(model.interfaces.values(), self._load_terms.reshape(-1, 6), strict=True):
            turn = np.linalg.pinv(face.T)
            extra[np.ix_(face.dofs, face.dofs)] = turn.T @ (terms[:, None] * turn)
        return replace(model, K=model.K + extra.tocsr())

    def basis(self) -> Basis:
        """The shapes `superelement` takes, in the coordinates of `full_model`."""
        model = self.full_model()
        materials = [part.material for part in model.viscoelastic]
        level = modulus_levels(materials, self.moduli)[0]
        families = [
            (h, Psi, fixed, RIGID_SHAPES[h.order, h.components]) for h, Psi, fixed, _ in self._families
        ]
        return full_basis(model, families, level)

    def superelement(self) -> Superelement:
        """Reduced matrices with rigid interfaces, projections of the full model's (paper (21)-(23)).

        M includes the viscoelastic regions; K their volumetric part, unless their bulk modulus relaxes: it
        then is a term of its own after those in shear; G is zero, for the body does not
        turn. Condensed quasi-statically it is the matrix of `stiffness` exactly at the moduli of the
        shapes, and elsewhere too stiff: for two moduli 1:10 within 0.01 % from half the lower to twice
        the higher, for 1:100 within 0.3 % between them; for
        1:30:1000 within 0.2 % (radial, 26/28×16 mm layer, K = 2 GPa).

        Raises
        ------
        ValueError
            Without an interface, or if moduli cannot be chosen for a material.
        """
        if not self.interfaces and not self.grooves:
            raise ValueError("interfaces is empty; a part needs at least one to be joined by")
        n = self._size
        return reduced(
            list(self._placed()),
            self.mesh,
            self.regions,
            self._boundaries,
            outputs=self.outputs,
            load_terms=self._load_terms,
            still=self._free_of_rigid_motion(n),
            damping=self.damping,
            faces=self.round_faces(),
        )

    def zones(self, count: int, rubber: int = 0) -> list[RubberZone]:
        """Zones of the rubber, in the coordinates of the superelement.

        Parameters
        ----------
        count
            Zones of the section, 1 or more, from where a radial motion strains it least to where most; each
            is cut into 8 sectors around the axis.
        rubber
            Which of the viscoelastic materials, numbered as in the superelement.

        Raises
        ------
        ValueError
            For no zones, and for a body with raceways or one that is squeezed.
        """
        count = whole("count", count, 1)
        require(not self.grooves, "grooves", sorted(self.grooves), "the zones of such a body are not known")
        require(self.prestress is None, "prestress", "there", "the zones of a squeezed body are not known")
        elements = soft_elements(self.mesh, self.regions, rubber)
        require(elements.size > 0, "rubber", rubber, "there is no such viscoelastic material in the body")
        if (count, rubber) not in self._zones:
            placed = list(self._placed())
            self._zones[count, rubber] = rubber_zones(self.mesh, elements, placed, self._size, count)
        return self._zones[count, rubber]

    @cached_property
    def _zones(self) -> dict[tuple[int, int], list[RubberZone]]:
        return {}

    def strain_field(self, motion: ArrayLike, modulus: float | None = None) -> tuple[Array, Array]:
        """Shear strain amplitude γ = √(2 e:e) of the rubber under motions of the interfaces, point by point.

        Parameters
        ----------
        motion
            (6 i,) real or complex, zero-to-peak: x, y, z, θx, θy, θz of each interface in their order.
        modulus
            Shear modulus, Pa, of the rubber, on which its shape depends; None: the lowest of `moduli`.

        Returns
        -------
        tuple of numpy.ndarray
            γ (azimuths, points) at evenly spaced azimuths and the points of integration, and the points'
            volumes (points,), m³, all around.
        """
        q = np.asarray(motion)
        count = 6 * len(self.interfaces)
        if q.shape != (count,) or not np.isfinite(q).all():
            raise ValueError(
                f"motion has shape {q.shape}; it must be ({count},), finite: six of each interface"
            )
        levels = shape_moduli(self.regions, self.moduli if modulus is None else (modulus,))
        rigid = Boundaries(self._boundaries.faces, {})

        def placed() -> Iterator[tuple[Harmonic, Array, list[tuple[Index, Array]]]]:
            for order, components, copies in rigid.families():
                h = self._harmonic(order, components)
                u, _ = self._shape_maker().constraint_shapes(h, levels[0])
                yield h, u, [rigid.place(h, copy) for copy in range(copies)]

        return strain_of_motion(self.mesh, soft_elements(self.mesh, self.regions), placed(), q)

    def hoop_stress(self, r: float, z: tuple[float, float], azimuth: Array, material: Elastic) -> Array:
        """Stress along a circle on the surface, (azimuths, coordinates); see `hoop_stress_rows`."""
        return hoop_stress_rows(self._placed(), self._size, material, r, z, azimuth)

    def strain(self, motion: ArrayLike, modulus: float | None = None) -> Strain:
        """The rubber's strain in one number, under motions as in `strain_field`."""
        gamma, volume = self.strain_field(motion, modulus)
        return Strain.of_field(gamma.ravel(), np.tile(volume / len(gamma), len(gamma)))

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        mesh, known = self.mesh, {}
        for name, face in self._boundaries.faces.items():
            around = mesh.elements[np.isin(mesh.elements, face.nodes).sum(axis=1) >= 3]
            known[name] = face_of_nodes(
                mesh.r[face.nodes], mesh.z[face.nodes], mesh.r[around], face.reference
            )
        return known

    def profile(self) -> list[Profile]:
        """What the plane x = 0 shows of it: the section of each region, above the axis and below."""
        faces = self._boundaries.faces
        origin = next(iter(faces.values())).reference if faces else 0.0
        return section_profile(self.mesh, self.regions, origin)

    def outline(self) -> Outline:
        """Its surface, revolved.

        Raises
        ------
        ValueError
            If moduli cannot be chosen for a material.
        """
        return surface_outline(self.mesh, self._placed(), self._size)

    def modes(
        self, order: int, count: int, modulus: float | None = None, fixed: Iterable[str] = ()
    ) -> RevolvedModes:
        """Lowest `count` undamped modes of Fourier order n = `order`, rigid motions (0 Hz) included.

        Parameters
        ----------
        modulus
            Real shear modulus, Pa, of the viscoelastic regions; needed if there are any.
        fixed
            Interfaces held still. The others are free surfaces here, not rigid.

        Raises
        ------
        ValueError
            For a missing or non-positive modulus, an unknown interface, or a count below 1.
        """
        whole("count", count, 1)
        shear: list[float] = []
        for q in self.regions:
            G = q.material.G if isinstance(q.material, Elastic) else modulus
            if G is None or not 0 < G < math.inf:
                raise ValueError(
                    f"modulus is {modulus}; the viscoelastic regions need a positive shear modulus, Pa"
                )
            shear.append(G)
        names = list(fixed)
        for name in names:
            if name not in self.interfaces:
                raise ValueError(f"fixed has {name!r}; the interfaces are {sorted(self.interfaces)}")
        return modes_of_order(
            self._harmonic,
            order,
            count,
            [self._boundaries.faces[name].nodes for name in names],
            (self._bulk, shear, self._density),
            self._shape_maker().slow_rate(shear),
        )
