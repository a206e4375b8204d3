"""Bodies of revolution with rigid interfaces: rings, bonded samples, any rectangles in (r, z)."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from bearingdyn.cms import (
    Basis,
    FullModel,
    Superelement,
    Viscoelastic,
    inertia_shapes,
    modal_damping,
    modulus_levels,
    orthogonalise,
)
from bearingdyn.fem.eigen import factorise, lowest_modes, rigid_transfer
from bearingdyn.fem.revolution import AXIAL, TORSION, Harmonic, assemble
from bearingdyn.fem.revolution_mesh import RevolutionMesh, revolution_mesh
from bearingdyn.material import Elastic
from bearingdyn.parts.revolved_full import full_basis, full_model
from bearingdyn.parts.section import Cylinder, EndFace, Face, Region, find_face, shape_moduli

Float = NDArray[np.float64]
Index = NDArray[np.intp]

# Coordinates (of x, y, z, θx, θy, θz) and signs of an interface's rigid shapes, for each copy of a
# harmonic family. Order 1 turned a quarter wave carries y where it carried x, and −θx where it carried θy:
# u = t + θ × ρ.
FAMILIES: tuple[tuple[int, tuple[int, ...], tuple[tuple[tuple[int, ...], tuple[float, ...]], ...]], ...] = (
    (0, AXIAL, (((2,), (1.0,)),)),
    (0, TORSION, (((5,), (1.0,)),)),
    (1, (0, 1, 2), (((0, 4), (1.0, 1.0)), ((1, 3), (1.0, -1.0)))),
)


@dataclass(frozen=True, eq=False)
class RevolvedModes:
    """Undamped modes of one Fourier order.

    order: n; frequency: (m,), Hz, rising; shapes: (m, nodes, 3), the amplitudes U, V, W of unit modal mass
    at the mesh's nodes: u_r = U cos nφ, u_θ = V sin nφ (V itself for n = 0), u_z = W cos nφ. For n >= 1
    each mode is double.
    """

    order: int
    frequency: Float
    shapes: Float


@dataclass(frozen=True, eq=False)
class Revolved:
    """A body of revolution about z, not turning, of one or more regions bonded where they touch.

    regions: rings of rectangular section.
    interfaces: name -> Cylinder or EndFace, each moving as a rigid body with six coordinates (x, y, z, θx,
        θy, θz) about the point of the axis in the middle of the face. The rest of the surface is free.
    outputs: name -> point (r, z, φ), m, m, rad; its rows (3, n) give x, y, z. Orders 0 and 1 are carried,
        higher
        ones are not: a rigid interface does not excite them, but a force at a point would.
    damping: ratio ζ of the free elastic modes of the elastic regions (the rubber then being only mass).
    f_max: fixed-interface modes up to this frequency, Hz, join the static shapes; 0: none. They are taken
        at the lowest of the moduli.
    moduli: real shear moduli, Pa, of the viscoelastic regions at which static shapes are taken; None: the
        relaxed modulus and |G*| at the fastest relaxation time of each material, and their geometric mean
        if they are more than a hundredfold apart. Each modulus after the
        first adds up to five shapes for two interfaces.
    refinement: mesh density; 1 gives layer stiffnesses within some 0.02 %.
    inertia: rounds of cms.inertia_shapes of the static shapes at each modulus; 1 serves a layer or a sample
        better than many fixed-interface modes.

    Raises ValueError for regions that overlap, faces that are not part of the body or share a node, a
    point outside the section, and values outside their range.
    Reference: paper section 3.3; harmonics, Zienkiewicz & Taylor, The Finite Element Method, vol. 2, ch. 9.
    """

    regions: tuple[Region, ...]
    interfaces: Mapping[str, Cylinder | EndFace] = field(default_factory=dict)
    outputs: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    damping: float = 0.0
    f_max: float = 0.0
    moduli: tuple[float, ...] | None = None
    refinement: float = 1.0
    inertia: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "regions", tuple(self.regions))
        if not 0 <= self.damping < 1:
            raise ValueError(f"damping is {self.damping}; a damping ratio lies in 0 <= ζ < 1")
        if not 0 <= self.f_max < math.inf:
            raise ValueError(
                f"f_max is {self.f_max}; it must be a frequency in Hz, not negative, 0 for no modes"
            )
        if not self.inertia >= 0:
            raise ValueError(f"inertia is {self.inertia}; it must be a number of rounds, 0 or more")
        if self.moduli is not None:
            object.__setattr__(self, "moduli", tuple(float(G) for G in self.moduli))
            if not self.moduli or not all(0 < G < math.inf for G in self.moduli):
                raise ValueError(f"moduli is {self.moduli}; it needs one or more positive shear moduli, Pa")
        _ = self.mesh  # regions that overlap, and faces that are none, are refused here
        faces = self._faces
        owner: dict[int, str] = {}
        for name, face in faces.items():
            for node in face.nodes.tolist():
                if owner.setdefault(node, name) != name:
                    raise ValueError(
                        f"interfaces {owner[node]!r} and {name!r} share the circle "
                        f"r = {self.mesh.r[node]:g}, z = {self.mesh.z[node]:g} m; keep them apart"
                    )
        for name, (r, z, _) in self.outputs.items():
            if name in self.interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
            try:
                self.mesh.locate(r, z)
            except ValueError as error:
                raise ValueError(f"outputs[{name!r}]: {error}") from error

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return sum(q.mass for q in self.regions)

    @cached_property
    def mesh(self) -> RevolutionMesh:
        """The mesh of the section."""
        rectangles = [q.rectangle for q in self.regions]
        r_cuts = [r for f in self.interfaces.values() if isinstance(f, EndFace) and f.r for r in f.r]
        z_cuts = [z for f in self.interfaces.values() if isinstance(f, Cylinder) and f.z for z in f.z]
        return revolution_mesh(rectangles, self.refinement, r_cuts, z_cuts)

    @cached_property
    def _faces(self) -> dict[str, Face]:
        return {name: find_face(self.mesh, name, surface) for name, surface in self.interfaces.items()}

    @cached_property
    def _harmonics(self) -> dict[tuple[int, tuple[int, ...]], Harmonic]:
        return {}

    def _harmonic(self, order: int, components: tuple[int, ...]) -> Harmonic:
        key = (order, components)
        if key not in self._harmonics:
            self._harmonics[key] = assemble(self.mesh, order, components)
        return self._harmonics[key]

    @property
    def _bulk(self) -> list[float]:
        return [q.material.K for q in self.regions]

    @property
    def _density(self) -> list[float]:
        return [q.material.density for q in self.regions]

    def _boundary(self, h: Harmonic) -> tuple[Index, Float]:
        """Interface coordinates, without those removed on the axis, and their rigid shapes, a column each."""
        faces = self._faces.values()
        at = np.concatenate([h.coordinates(f.nodes) for f in faces])
        R = scipy.linalg.block_diag(*[h.rigid_shapes(f.nodes, f.reference) for f in faces])
        kept = np.isin(at, h.free)
        return at[kept], R[kept]

    def _constraint_shapes(self, h: Harmonic, shear: Sequence[complex]) -> tuple[Any, Any]:
        """Static shapes (n, columns) of unit interface motions at given moduli, and their stiffness."""
        K = h.stiffness(self._bulk, shear)
        at, R = self._boundary(h)
        inner = np.setdiff1d(h.free, at)
        u = np.zeros((h.n, R.shape[1]), dtype=K.dtype)
        u[at] = R
        if inner.size:
            u[inner] = -factorise(K[inner][:, inner]).solve(np.asarray(K[inner][:, at] @ R, dtype=K.dtype))
        return u, u.T @ (K @ u)

    def stiffness(self, omega: float = 0.0) -> NDArray[np.complex128]:
        """Quasi-static complex stiffness (6 i, 6 i) of the i interfaces at G*(ω), N/m, N, N m; ω in rad/s.

        The whole finite element model is solved anew at G*(ω), without inertia: exact but for the mesh.
        Raises ValueError where a viscoelastic material has no shear stiffness, as G0 = 0 at ω = 0.
        """
        if not self.interfaces:
            raise ValueError("interfaces is empty; a stiffness needs at least one")
        shear: list[complex] = []
        for q in self.regions:
            G = complex(
                q.material.G if isinstance(q.material, Elastic) else q.material.complex_modulus(omega)
            )
            if not abs(G) > 1e-12 * q.material.K:
                raise ValueError(
                    f"material has |G*| = {abs(G):.3g} Pa at omega = {omega} rad/s: no stiffness "
                    "in shear to solve with; give a material with G0 > 0, or omega > 0"
                )
            shear.append(G)
        S = np.zeros((6 * len(self.interfaces),) * 2, dtype=np.complex128)
        for order, components, copies in FAMILIES:
            _, k = self._constraint_shapes(self._harmonic(order, components), shear)
            for coordinates, signs in copies:
                index, sign = self._place(coordinates, signs)
                S[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (k + k.T)
        return S

    def _place(self, coordinates: Iterable[int], signs: Iterable[float]) -> tuple[Index, Float]:
        count = len(self.interfaces)
        index = (6 * np.arange(count)[:, None] + np.array(list(coordinates))).ravel()
        return index, np.tile(np.array(list(signs)), count)

    def _free_of_rigid_motion(self, n: int) -> Float:
        """Projector (n, n) that takes rigid motion out: what round-off leaves of its stiffness."""
        R = np.zeros((n, 6))
        transfer = rigid_transfer([(0.0, 0.0, f.reference) for f in self._faces.values()])
        R[: len(transfer)] = transfer
        Q = np.linalg.qr(R)[0]
        return np.asarray(np.eye(n) - Q @ Q.T)

    def _shapes(self, h: Harmonic, levels: Sequence[Sequence[float]]) -> tuple[Float, int]:
        """Basis (n, columns) of a family: constraint shapes, then internal ones; and the number of the first.

        Internal are the differences of constraint shapes between moduli, which vanish on the interfaces,
        and the fixed-interface modes. They are made modes of each other, of unit modal mass, and those
        without energy of their own are dropped (torsion has none: it changes no volume, so its shape does
        not depend on the modulus).
        """
        M = h.mass_matrix(self._density)
        inner = np.setdiff1d(h.free, self._boundary(h)[0])
        static, k = self._constraint_shapes(h, levels[0])
        unit = 1.0 / np.sqrt(np.diag(k))
        # Rigid motion of all interfaces has the same shape at every modulus: those of the first add nothing.
        relative = slice(len(unit) // len(self.interfaces), None)
        extra = [
            ((self._constraint_shapes(h, level)[0] - static) * unit)[:, relative] for level in levels[1:]
        ]
        if self.inertia and inner.size:
            for level in levels:
                K = h.stiffness(self._bulk, level)
                lu, shapes = factorise(K[inner][:, inner]), self._constraint_shapes(h, level)[0]
                extra += inertia_shapes(lu.solve, K, M, shapes, inner, self.inertia)
        K = h.stiffness(self._bulk, levels[0])
        if self.f_max > 0:
            frequency, phi = lowest_modes(K[inner][:, inner], M[inner][:, inner], f_max=self.f_max)
            modes = np.zeros((h.n, frequency.size))
            modes[inner] = phi / (2 * np.pi * frequency)
            extra.append(modes)
        internal = np.hstack(extra) if extra else np.zeros((h.n, 0))
        _, internal = orthogonalise(internal, K, M)
        return np.hstack([static, internal]), static.shape[1]

    def _families(self) -> list[tuple[Harmonic, Float, int, Any]]:
        """Each family with its shapes, the number of constraint shapes among them, and its copies."""
        levels = shape_moduli(self.regions, self.moduli)
        return [
            (h, *self._shapes(h, levels), copies)
            for h, copies in ((self._harmonic(n, components), copies) for n, components, copies in FAMILIES)
        ]

    def full_model(self) -> FullModel:
        """The unreduced equations of orders 0 and 1 (those that rigid interfaces excite), sparse."""
        families = [(self._harmonic(order, components), copies) for order, components, copies in FAMILIES]
        return full_model(families, self.regions, self._faces, self.outputs)

    def basis(self) -> Basis:
        """The shapes `superelement` takes, in the coordinates of `full_model`."""
        model = self.full_model()
        materials = [part.material for part in model.viscoelastic]
        level = modulus_levels(materials, self.moduli)[0]
        return full_basis(model, self._families(), level)

    def superelement(self) -> Superelement:
        """Reduced matrices with rigid interfaces, projections of the full model's (paper (21)-(23)).

        M includes the viscoelastic regions; K their volumetric part; G is zero, for the body does not
        turn. Condensed quasi-statically it is the matrix of `stiffness` exactly at the moduli of the
        shapes, and elsewhere too stiff: for two moduli 1:10 within 0.01 % from half the lower to twice
        the higher, for 1:100 within 0.3 % between them; for
        1:30:1000 within 0.2 % (radial, 26/28×16 mm layer, K = 2 GPa).

        Raises ValueError without an interface, or if moduli cannot be chosen for a material.
        """
        if not self.interfaces:
            raise ValueError("interfaces is empty; a part needs at least one to be joined by")
        families = self._families()
        n = sum(len(copies) * Psi.shape[1] for _, Psi, _, copies in families)
        rubbers: list[Any] = []
        owner = np.full(len(self.regions), -1)
        for i, q in enumerate(self.regions):
            if not isinstance(q.material, Elastic):
                if not any(q.material is m for m in rubbers):
                    rubbers.append(q.material)
                owner[i] = next(j for j, m in enumerate(rubbers) if q.material is m)
        bulk = np.array(self._bulk)
        shear = np.array([q.material.G if isinstance(q.material, Elastic) else 0.0 for q in self.regions])

        M, K, E = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n))
        H = [np.zeros((n, n)) for _ in rubbers]
        rows = {name: np.zeros((3, n)) for name in self.outputs}
        end = 6 * len(self.interfaces)
        for h, Psi, fixed, copies in families:
            parts = [(M, h.mass_matrix(self._density)), (K, h.stiffness(bulk, shear))]
            parts += [(E, h.stiffness(np.where(owner < 0, bulk, 0.0), shear))]
            parts += [
                (H[j], h.matrix((owner == j).astype(float) @ h.deviatoric)) for j in range(len(rubbers))
            ]
            reduced = [(full, Psi.T @ (A @ Psi)) for full, A in parts]
            whole = h.complete(Psi.copy())
            for copy, (coordinates, signs) in enumerate(copies):
                index, sign = self._place(coordinates, signs)
                internal = np.arange(end, end + Psi.shape[1] - fixed)
                index, sign = (
                    np.concatenate([index, internal]),
                    np.concatenate([sign, np.ones(internal.size)]),
                )
                end += internal.size
                for full, a in reduced:
                    full[np.ix_(index, index)] += np.outer(sign, sign) * 0.5 * (a + a.T)
                for name, (r, z, phi) in self.outputs.items():
                    rows[name][:, index] += sign * h.point_rows(r, z, phi, whole, sine=copy == 1)
        P = self._free_of_rigid_motion(n)
        return Superelement(
            M=M,
            C=modal_damping(M, P @ E @ P, self.damping),
            K=P @ K @ P,
            G=np.zeros((n, n)),
            interfaces={name: np.arange(6 * i, 6 * i + 6) for i, name in enumerate(self.interfaces)},
            outputs=rows,
            viscoelastic=tuple(Viscoelastic(m, P @ h @ P) for m, h in zip(rubbers, H, strict=True)),
        )

    def modes(
        self, order: int, count: int, modulus: float | None = None, fixed: Iterable[str] = ()
    ) -> RevolvedModes:
        """Lowest `count` undamped modes of Fourier order n = `order`, rigid motions (0 Hz) included.

        modulus: real shear modulus, Pa, of the viscoelastic regions; needed if there are any.
        fixed: interfaces held still. The others are free surfaces here, not rigid.

        Raises ValueError for a missing or non-positive modulus, an unknown interface, or a count below 1.
        """
        if not count >= 1:
            raise ValueError(f"count is {count}; ask for one mode or more")
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
            if name not in self._faces:
                raise ValueError(f"fixed has {name!r}; the interfaces are {sorted(self._faces)}")
        # A shift makes the stiffness of a free body definite; a tenth of the slowest shear wave's rate
        # keeps digits.
        rate = (
            0.1
            * min(math.sqrt(G / rho) for G, rho in zip(shear, self._density, strict=True))
            / self.mesh.size
        )
        found: list[tuple[float, Float]] = []
        for components in (AXIAL, TORSION) if order == 0 else ((0, 1, 2),):
            h = self._harmonic(order, components)
            held = [h.coordinates(self._faces[name].nodes) for name in names]
            free = np.setdiff1d(h.free, np.concatenate(held)) if held else h.free
            K, M = h.stiffness(self._bulk, shear)[free][:, free], h.mass_matrix(self._density)[free][:, free]
            frequency, phi = lowest_modes(K + rate**2 * M, M, n_modes=count)
            u = np.zeros((h.n, frequency.size))
            u[free] = phi
            shapes = np.zeros((frequency.size, self.mesh.r.size, 3))
            shapes[:, :, list(components)] = (
                h.complete(u).reshape(-1, len(components), frequency.size).transpose(2, 0, 1)
            )
            omega = np.sqrt(np.maximum((2 * np.pi * frequency) ** 2 - rate**2, 0.0))
            found += zip((omega / (2 * np.pi)).tolist(), shapes, strict=True)
        found = sorted(found, key=lambda mode: mode[0])[:count]
        return RevolvedModes(order, np.array([f for f, _ in found]), np.stack([u for _, u in found]))
