"""Solids of any shape: a mesh with materials, surfaces that move as rigid bodies, and outputs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import NoneType
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse

from bearingdyn.checks import instance, name_list, named, require, vector
from bearingdyn.cms import (
    F_MAX,
    Basis,
    FullModel,
    RigidInterface,
    RoundFace,
    Skin,
    Superelement,
    Surface,
    Viscoelastic,
    basis_of,
    check_damping,
    check_f_max,
    check_held,
    check_moduli,
    check_rounds,
    face_of_nodes,
    project,
)
from bearingdyn.fem import (
    NoBalance,
    SolidElements,
    SolidMesh,
    SurfaceSamples,
    assemble_elastic,
    assemble_solid,
    factorise,
    rigid_motion,
)
from bearingdyn.material import NEO_HOOKE, Elastic, Hyperelastic, constant_bulk, volume_of
from bearingdyn.parts.flexible_bore import FlexibleBore
from bearingdyn.parts.outline import Outline
from bearingdyn.parts.prestress import check_branches, check_law, constant_volume
from bearingdyn.parts.quasi_static_modulus import quasi_static
from bearingdyn.parts.regions import ViscoelasticSolid, is_rubber
from bearingdyn.parts.solid_outline import solid_outline
from bearingdyn.parts.solid_prestress import Move, SolidPrestress, deform
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import check_reference, plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

Point = tuple[float, float, float]
Material = Elastic | ViscoelasticSolid


@dataclass(frozen=True)
class RigidSurface:
    """Surfaces of a solid that move together as one rigid body with six coordinates.

    Parameters
    ----------
    surface
        One name or several.
    reference
        The point (x, y, z), m, whose motion the coordinates are; "centroid": of the area; "axis": the point
        of the z axis at the centroid's height.
    """

    surface: str | tuple[str, ...]
    reference: Point | str = "centroid"

    def __post_init__(self) -> None:
        names = [self.surface] if isinstance(self.surface, str) else self.surface
        name_list("surface", names, "surfaces", least=1)
        if isinstance(self.reference, str):
            good = self.reference in ("centroid", "axis")
        else:
            where = vector("reference", self.reference, (3,), "(x, y, z) in m, or 'centroid' or 'axis'")
            object.__setattr__(self, "reference", tuple(where.tolist()))
            good = True
        if not good:
            raise ValueError(
                f"reference is {self.reference!r}; it must be (x, y, z) in m, 'centroid' or 'axis'"
            )

    @property
    def surfaces(self) -> tuple[str, ...]:
        """The names."""
        return (self.surface,) if isinstance(self.surface, str) else tuple(self.surface)

    def place(self, mesh: SolidMesh) -> tuple[Index, Array]:
        """Its nodes and reference point (3,), m. Raises ValueError as SolidMesh.surface does."""
        nodes = np.unique(np.concatenate([mesh.surface(name) for name in self.surfaces]))
        if not isinstance(self.reference, str):
            reference = np.array(self.reference, dtype=np.float64)
            check_reference("reference", reference, mesh.points)
            return nodes, reference
        area, moment = 0.0, np.zeros(3)
        for name in self.surfaces:
            if np.isin(mesh.boundary, mesh.surface(name)).all(axis=1).any():
                samples = mesh.samples(name)
                area, moment = area + samples.area, moment + samples.area * samples.centroid
        centre = moment / area if area > 0 else mesh.points[nodes].mean(axis=0)
        return nodes, centre * (1.0 if self.reference == "centroid" else np.array([0.0, 0.0, 1.0]))


@dataclass(frozen=True, eq=False)
class Solid:
    """A solid of one or more materials, of any shape, not turning, with rigid interfaces.

    Viscoelastic regions, and elastic ones with ν of 0.45 or more, are assembled as incompressible, so that
    they do not lock: see fem.assemble_solid. In rubber use 27-node bricks, which are some five times as
    accurate as 20-node ones; `mesh.with_centres()` makes them.

    Parameters
    ----------
    mesh
        SolidMesh, as read_mesh, box_mesh, ring_mesh or block_with_bore return it.
    materials
        Of each region by name, or one for all; Elastic, or viscoelastic in shear as Maxwell.
    interfaces
        name -> name of a surface, or RigidSurface. Feet are an interface too; the application grounds them.
        No two interfaces may share a node.
    f_max
        Modes with the interfaces held are kept up to this frequency, Hz; 0: none; by default 20 kHz. They are
        taken at the lowest of the moduli.
    outputs
        name -> (x, y, z), m: the nearest node; or name of a surface: its motion averaged over the area. Rows
        (3, n) give x, y, z.
    damping
        Ratio ζ of the elastic modes of the elastic regions, of the free body, or held at the interface
        `held`.
    moduli
        Real shear moduli, Pa, of the viscoelastic regions at which static shapes are taken; None: chosen from
        each material's range (cms.modulus_levels).
    attach
        Outputs at which loads act, whose static shapes then join the basis.
    radiating
        Surfaces of the mesh that the superelement carries for the power they radiate.
    inertia
        How many rounds of cms.inertia_shapes follow the static shapes of each modulus. One round serves
        better than many fixed-interface modes; 0 with moduli=(G,) is the paper's basis.
    bores
        name -> FlexibleBore, in which a flexible ring may lie (`Application.fit`).
    prestress
        The static state of a solid that `assembled` has deformed; its mesh is then where the state is. None:
        at rest, without stress.

    Raises
    ------
    ValueError
        For names that are not the mesh's, a region without material, interfaces that share a node or lie on a
        line, a point away from the body, and values outside their range.

    References
    ----------
    Paper (13), (14), (21)-(25).
    """

    mesh: SolidMesh
    materials: Mapping[str, Material] | Material
    interfaces: Mapping[str, str | RigidSurface]
    f_max: float = F_MAX
    outputs: Mapping[str, Point | str] = field(default_factory=dict)
    damping: float = 0.0
    held: str | None = None
    moduli: tuple[float, ...] | None = None
    attach: tuple[str, ...] = ()
    radiating: tuple[str, ...] = ()
    inertia: int = 1
    bores: Mapping[str, FlexibleBore] = field(default_factory=dict)
    prestress: SolidPrestress | None = field(default=None, repr=False)

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        check_f_max(self.f_max)
        check_rounds(self.inertia)
        check_damping(self.damping)
        if self.moduli is not None:
            object.__setattr__(self, "moduli", check_moduli(self.moduli))
        instance("mesh", self.mesh, SolidMesh, "it must be a bd.SolidMesh, as bd.read_mesh returns it")
        plausible("solid length", "the body's extent", float(np.ptp(self.mesh.points, axis=0).max()))
        self._check_materials()
        instance("prestress", self.prestress, (SolidPrestress, NoneType), "it comes of assembled(…)")
        for name, what in (("interfaces", "surfaces"), ("outputs", "points"), ("bores", "bd.FlexibleBore")):
            named(name, getattr(self, name), f"it must be a mapping, name -> {what}")
        for name in ("attach", "radiating"):
            object.__setattr__(self, name, tuple(name_list(name, getattr(self, name), "names")))
        if not self.interfaces:
            raise ValueError("interfaces is empty; a part needs at least one to be joined by")
        check_held(self.held, self.interfaces)
        owner: dict[int, str] = {}
        for name, face in self._faces.items():
            p = self.mesh.points[face[0]]
            spread = np.linalg.svd(p - p.mean(axis=0), compute_uv=False)
            if len(p) < 3 or not spread[1] > 1e-9 * spread[0]:
                raise ValueError(f"interfaces[{name!r}] is a point or a line; a rigid interface is a surface")
            for node in face[0].tolist():
                if owner.setdefault(node, name) != name:
                    x, y, z = self.mesh.points[node]
                    raise ValueError(
                        f"interfaces {owner[node]!r} and {name!r} share the node at "
                        f"({x:.6g}, {y:.6g}, {z:.6g}) m; keep them apart, or make them one RigidSurface"
                    )
        for name in self.outputs:
            if name in self.interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
        _ = self._rows
        for name, bore in self.bores.items():
            instance(f"bores[{name!r}]", bore, FlexibleBore, "it must be a bd.FlexibleBore(surface, order)")
            if name in self.interfaces or name in self.outputs:
                raise ValueError(f"bores has {name!r}, the name of an interface or output; choose another")
            try:
                bore.place(self.mesh)
            except ValueError as error:
                raise ValueError(f"bores[{name!r}]: {error}") from error
        for name in self.attach:
            if name not in self.outputs:
                raise ValueError(f"attach has {name!r}; the outputs are {sorted(self.outputs)}")

    def _check_materials(self) -> None:
        regions = sorted(self.mesh.regions)
        given = self.materials
        if not isinstance(given, Mapping):
            given = dict.fromkeys(regions, given)
            object.__setattr__(self, "materials", given)
        if sorted(given) != regions:
            raise ValueError(f"materials are of {sorted(given)}; the mesh has the regions {regions}")
        for name, material in given.items():
            if not isinstance(material, Elastic) and not callable(getattr(material, "complex_modulus", None)):
                raise ValueError(
                    f"materials[{name!r}] is {material!r}; it must be Elastic or have complex_modulus(omega)"
                )

    @property
    def _materials(self) -> Mapping[str, Material]:
        assert isinstance(self.materials, Mapping)
        return self.materials

    @cached_property
    def _faces(self) -> dict[str, tuple[Index, Array]]:
        if self.prestress is not None:
            return {name: (plate.nodes, plate.reference) for name, plate in self.prestress.plates.items()}
        found = {}
        for name, surface in self.interfaces.items():
            rigid = surface if isinstance(surface, RigidSurface) else RigidSurface(surface)
            try:
                found[name] = rigid.place(self.mesh)
            except ValueError as error:
                raise ValueError(f"interfaces[{name!r}]: {error}") from error
        return found

    @cached_property
    def _rows(self) -> dict[str, Any]:
        p = self.mesh.points
        found: dict[str, Any] = {}
        for name, place in self.outputs.items():
            if isinstance(place, str):
                try:
                    found[name] = self.mesh.samples(place).mean_rows
                except ValueError as error:
                    raise ValueError(f"outputs[{name!r}]: {error}") from error
                continue
            columns = 3 * self._nearest(name, place) + np.arange(3)
            found[name] = scipy.sparse.csr_matrix((np.ones(3), (np.arange(3), columns)), (3, 3 * len(p)))
        return found

    def _nearest(self, name: str, place: Point) -> int:
        """The node nearest to an output's point; ValueError for a point away from the body."""
        p = self.mesh.points
        at = np.asarray(place, dtype=np.float64)
        if at.shape != (3,) or not np.all(np.isfinite(at)):
            raise ValueError(f"outputs[{name!r}] is {place!r}; it must be (x, y, z), m, or a surface")
        distance = np.linalg.norm(p - at, axis=1)
        node = int(np.argmin(distance))
        near = self.mesh.elements[np.any(self.mesh.elements == node, axis=1)]
        of = p[np.where(near >= 0, near, near[:, :1])]
        if not distance[node] <= float(np.ptp(of, axis=1).max()):
            raise ValueError(
                f"outputs[{name!r}] is {place!r}, {distance[node]:.3g} m away from the nearest node at "
                f"{p[node].tolist()} m; it must lie in the body"
            )
        return node

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return sum(m.density * self.mesh.volume(name) for name, m in self._materials.items())

    @cached_property
    def _full_model(self) -> FullModel:
        n = 3 * len(self.mesh.points)
        M, E, bulk = None, None, None  # nothing is added to zeros, which takes as long as to anything else
        rubbers: list[tuple[ViscoelasticSolid, Any]] = []
        volumes: list[float] = []
        swelling: list[Viscoelastic] = []
        rest = self.mesh if self.prestress is None else self.prestress.state.body.mesh
        for region, (name, elements) in enumerate(self.mesh.regions.items()):
            material = self._materials[name]
            if isinstance(material, Elastic):
                mass, own = assemble_elastic(rest, elements, material, incompressible=is_rubber(material))
                if self.prestress is not None:
                    own = self.prestress.state.stiffness([region])
                M, E = _sum(M, mass), _sum(E, own)
                continue
            unit = assemble_solid(rest, elements, incompressible=is_rubber(material))
            M = _sum(M, material.density * unit.mass)
            H = unit.deviatoric
            if self.prestress is None:
                bulk = _sum(bulk, constant_bulk(material) * unit.volumetric)
            else:
                own, H = self.prestress.tangents(region)
                bulk = _sum(bulk, own)
            if (volume := volume_of(material)) is not None:
                swelling.append(Viscoelastic(volume, 0.5 * unit.volumetric))
            same = [k for k, (other, _) in enumerate(rubbers) if other is material]
            if same:
                rubbers[same[0]] = (material, rubbers[same[0]][1] + H)
                volumes[same[0]] += float(unit.mass.sum()) / 3
            else:
                rubbers.append((material, H))
                volumes.append(float(unit.mass.sum()) / 3)
        interfaces = {}
        for name, (nodes, reference) in self._faces.items():
            dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
            interfaces[name] = RigidInterface(
                dofs, rigid_motion(self.mesh.points[nodes], reference), reference
            )
        if self.prestress is not None:
            bulk = _sum(bulk, self.prestress.loads(interfaces))
        return FullModel(
            M=M,
            K=_sum(E, bulk),
            E=None if not rubbers else scipy.sparse.csr_matrix((n, n)) if E is None else E,
            interfaces=interfaces,
            outputs=self._rows,
            viscoelastic=(
                *(
                    Viscoelastic(material, H, volume)
                    for (material, H), volume in zip(rubbers, volumes, strict=True)
                ),
                *swelling,
            ),
            # plates that push turn with the body, and their forces resist or help
            grounded=self.prestress is not None and not self.prestress.self_balanced,
        )

    def full_model(self) -> FullModel:
        """The unreduced equations: sparse matrices, rigid interfaces, output rows."""
        return self._full_model

    @cached_property
    def _ports(self) -> dict[str, Any]:
        """Rows of the bores' coefficients."""
        return {name: bore.rows(self.mesh) for name, bore in self.bores.items()}

    @cached_property
    def _basis(self) -> Basis:
        return basis_of(
            self._full_model,
            f_max=self.f_max if self.f_max > 0 else None,
            n_modes=None if self.f_max > 0 else 0,
            moduli=self.moduli,
            inertia=self.inertia,
            attach=self.attach,
            ports=scipy.sparse.vstack(list(self._ports.values())) if self.bores else None,
        )

    def basis(self) -> Basis:
        """The shapes `superelement` takes, in the coordinates of `full_model`.

        Raises
        ------
        ValueError
            If moduli cannot be chosen for a material.
        """
        return self._basis

    def superelement(self) -> Superelement:
        """The body reduced onto its interfaces: static shapes at each modulus, and modes up to f_max.

        Raises
        ------
        ValueError
            If moduli cannot be chosen for a material.
        """
        element = project(self._full_model, self._basis, damping=self.damping, held=self.held)
        raceways = {
            name: bore.raceway(self.mesh, np.asarray(self._ports[name] @ self._basis.Psi))
            for name, bore in self.bores.items()
        }
        element = replace(element, raceways=raceways, faces=self.round_faces())
        if not self.radiating:
            return element
        surfaces = {name: self._radiation(name) for name in self.radiating}
        return replace(element, surfaces=surfaces, skin=self._skin())

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces and bores, against which an application checks the neighbours."""
        p, known = self.mesh.points, {}
        for name, (nodes, reference) in self._faces.items():
            radius = np.hypot(*(p[:, :2] - reference[:2]).T)
            around = self.mesh.elements[np.isin(self.mesh.elements, nodes).sum(axis=1) >= 3]
            known[name] = face_of_nodes(radius[nodes], p[nodes, 2], radius[around], float(reference[2]))
        return known | {name: (bore.face(self.mesh),) for name, bore in self.bores.items()}

    def outline(self) -> Outline:
        """The faces of its elements on the boundary, each as triangles around its middle."""
        return solid_outline(self.mesh, self._basis.Psi)

    def _radiation(self, name: str) -> Surface:
        samples, rows = self.surface(name)
        W = rows.T @ (samples.weights[:, None] * rows)
        return Surface(samples.area, np.asarray(0.5 * (W + W.T)))

    def _skin(self) -> Skin:
        boundary = self.mesh.boundary
        used, index = np.unique(boundary, return_inverse=True)
        rows = self._basis.Psi[(3 * used[:, None] + np.arange(3)).ravel()]
        on = {
            name: np.flatnonzero(np.isin(boundary, self.mesh.surface(name)).all(axis=1))
            for name in self.radiating
        }
        return Skin(self.mesh.points[used], index.reshape(boundary.shape), rows, on, self.f_max or math.inf)

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
        model = self._full_model
        shear = [quasi_static(part.material, omega, after) for part in model.viscoelastic]
        K = model.stiffness(shear).tocsr()
        faces = list(model.interfaces.values())
        at = np.concatenate([f.dofs for f in faces])
        u = np.zeros((model.n, 6 * len(faces)), dtype=K.dtype)
        u[at] = scipy.linalg.block_diag(*[f.T for f in faces])
        inner = np.setdiff1d(np.arange(model.n), at)
        if inner.size:
            load = np.ascontiguousarray(K[inner] @ u)
            u[inner] = -factorise(K[inner][:, inner]).solve(load)
        S = u.T @ (K @ u)
        return np.asarray(0.5 * (S + S.T), dtype=np.complex128)

    def assembled(
        self,
        press: Mapping[str, Move],
        *,
        slip: Iterable[str] = (),
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
    ) -> Squeezed:
        """The solid deformed by its rigid interfaces, at finite strain, to which it then sticks.

        Pads pressed, sheared or turned, mount blocks under their load: what the result is asked is of a small
        motion about the static state. Elements are those of the undeformed part.

        Parameters
        ----------
        press
            interface -> depth, m, by which it moves into the body, each node along its normal; or its motion
            (x, y, z), m, or (x, y, z, θx, θy, θz), m and rad, a rotation about its reference by the length of
            that vector. All others stay where they are.
        slip
            Plane interfaces, with normals along x, y or z, without friction while they are pressed on. The
            body may part from them, and more of its free surface come to touch their planes. All others are
            bonded from the start.
        law
            Strain energy of the viscoelastic regions, and of elastic ones with ν of 0.45 or more: NeoHooke(),
            the default, MooneyRivlin or Yeoh, scaled to the modulus of each. Other regions are neo-Hookean.
        branches, after
            As for Revolved.assembled.

        Returns
        -------
        Squeezed
            Its `part` is the deformed solid; of its forces, each is (6,), force and moment about the
            interface's reference, and `widths` and `lost` are areas, m².

        Raises
        ------
        ValueError
            Naming the share of the motion that was reached, where elements turn inside out, a free surface
            folds over the edge of a bond, or the law is not stable; for names of no interface, a solid with
            bores, or one that is deformed already.

        Examples
        --------
        >>> import bearingdyn as bd, numpy as np
        >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
        >>> lines = [np.linspace(0.0, size, n + 1) for size, n in ((0.04, 4), (0.01, 2), (0.04, 4))]
        >>> pad = bd.Solid(bd.box_mesh(*lines, element="hex27"), rubber, {"foot": "y-", "plate": "y+"})
        >>> clamped = pad.assembled({"plate": 0.5e-3})  # 5 % of its height
        >>> k, rest = clamped.stiffness()[7, 7].real, pad.stiffness()[7, 7].real
        >>> f"{clamped.force:.0f} N, along its height {k / rest - 1:.0%} stiffer"
        '870 N, along its height 19% stiffer'
        """
        try:
            return self.deformed(press, slip=slip, law=law, branches=branches, after=after)
        except NoBalance as failure:
            raise ValueError(
                f"press is {dict(press)}; {failure.share:.0%} of it is reached: {failure.reason}"
            ) from None

    def deformed(
        self,
        press: Mapping[str, Move],
        *,
        slip: Iterable[str] = (),
        law: Hyperelastic | None = None,
        branches: str = "current",
        after: float | None = None,
    ) -> Squeezed:
        """What `assembled` does, with a NoBalance that knows the share reached, for others to tell."""
        named("press", press, "it must be {interface: depth in m, or motion}")
        require(
            not self.bores, "bores", sorted(self.bores), "a solid with bores for rings cannot be deformed"
        )
        require(self.prestress is None, "prestress", "there", "deform the solid once, from its state at rest")
        require(bool(press), "press", press, f"name one of the interfaces {sorted(self.interfaces)}")
        check_branches(branches)
        rubber = check_law(law)
        materials = [self._materials[name] for name in self.mesh.regions]
        constant_volume(materials)
        soft = [is_rubber(m) for m in materials]
        body = SolidElements(
            mesh=self.mesh,
            laws=[rubber if own else NEO_HOOKE for own in soft],
            shear=[quasi_static(m, 0.0, after).real for m in materials],
            bulk=[m.K for m in materials],
            incompressible=soft,
        )
        prestress = deform(body, self._faces, press, slip, branches)
        now = prestress.mesh.points
        outputs = {
            name: place if isinstance(place, str) else tuple(now[self._nearest(name, place)].tolist())
            for name, place in self.outputs.items()
        }
        part = replace(self, mesh=prestress.mesh, outputs=outputs, prestress=prestress)
        return prestress.told(part, next(iter(press)))

    def surface(self, name: str) -> tuple[SurfaceSamples, Array]:
        """A surface's integration points, and rows (q, n) giving their outward normal displacement.

        The rows act on the coordinates of `superelement`: with v = rows @ q̇ the radiated power of a plane
        wave is ρ c Σ weights v². Raises ValueError for an unknown surface, or one not on the boundary.
        """
        samples = self.mesh.samples(name)
        return samples, samples.normal_of(self._basis.Psi)


def _sum(a: Any, b: Any) -> Any:
    """a + b of matrices, of which None is one of zeros."""
    return b if a is None else a if b is None else a + b
