"""Bodies of revolution by Fourier harmonics over (r, z): three-dimensional motion at two-dimensional cost.

Order n displaces by u_r = U cos nφ, u_θ = V sin nφ, u_z = W cos nφ. Turned a quarter wave, φ → φ − π/2n,
the same matrices serve the other family. In order 0, V is u_θ itself and does not couple with (U, W).

The strain energy is split as ½ K ∫(Πε_kk)² dV + G ∫ e:e dV, with Π the projection on pressures linear
in each element: the mixed element Q2/P1, its pressure condensed (Hughes, The Finite Element Method, 1987,
ch. 4), which does not lock as ν → ½. Bulk and shear modulus enter as scalars: assembly is done once.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from bearingdyn.checks import whole
from bearingdyn.fem.meshes.quadrilateral_element import shape_functions
from bearingdyn.fem.meshes.revolution_mesh import RevolutionMesh
from bearingdyn.fem.meshes.section_integrals import SectionIntegrals
from bearingdyn.types import Array, Index

AXIAL = (0, 2)  # components U, W of order 0
TORSION = (1,)  # component V of order 0
ALL_COMPONENTS = (0, 1, 2)
STEP = 1e-30  # m/m: of complex steps
KEPT_BELOW = 1000  # elements: their pattern takes some 6 MB


@dataclass(frozen=True, eq=False, kw_only=True)
class Harmonic:
    """Matrices of a body of revolution, of one Fourier harmonic (in order 0, of one of two families).

    Coordinate c of node k is number len(components)·k + c. The matrices of all regions share one sparsity
    pattern.

    Parameters
    ----------
    mesh
        Mesh of the section.
    order
        Fourier order n.
    components
        Those of U, V, W (0, 1, 2) that are carried.
    pattern
        Where element matrices add up in a csc matrix.
    mass, volumetric, deviatoric
        (regions, nonzeros) data per unit density, m³, per unit bulk modulus, m, and per 2G, m.
    free
        Coordinates that remain; on the axis r = 0 regularity removes some, and in order 1 ties V to −U.
    """

    mesh: RevolutionMesh
    order: int
    components: tuple[int, ...]
    pattern: Pattern
    mass: Array
    volumetric: Array
    deviatoric: Array
    free: Index

    @property
    def n(self) -> int:
        """Number of coordinates, those removed on the axis included."""
        return int(self.pattern.indptr.size - 1)

    def matrix(self, data: Any) -> Any:
        """Sparse (n, n) matrix of the shared pattern, with indices of its own: it may be changed in place."""
        of = self.pattern
        own = (data, of.indices.copy(), of.indptr.copy())
        return scipy.sparse.csc_matrix(own, shape=(self.n, self.n))

    def stiffness(self, bulk: ArrayLike, shear: ArrayLike) -> Any:
        """K = Σ bulk·volumetric + 2·shear·deviatoric over the regions, N/m, sparse; shear may be complex."""
        return self.matrix(
            _weighed(bulk, self.volumetric) + _weighed(2.0 * np.asarray(shear), self.deviatoric)
        )

    def mass_matrix(self, density: ArrayLike) -> Any:
        """M = Σ density·mass over the regions, kg, sparse."""
        return self.matrix(_weighed(density, self.mass))

    def coordinates(self, nodes: Index) -> Index:
        """Coordinates of some nodes, (nodes·components,)."""
        c = len(self.components)
        return (c * nodes[:, None] + np.arange(c)).ravel()

    def complete(self, u: Any) -> Any:
        """Fill in the coordinates tied on the axis (V = −U in order 1); u (n, ...) is changed."""
        if self.order == 1:
            axis = self.mesh.nodes_on((0.0, 0.0), (-np.inf, np.inf))
            u[3 * axis + 1] = -u[3 * axis]
        return u

    def rigid_shapes(self, nodes: Index, reference: float = 0.0) -> Array:
        """Rigid motions of some nodes about the point z = reference of the axis, (nodes·components, 1 or 2).

        Order 0: z, or θz. Order 1: x and θy of the cosine family; in the sine family the same shapes are
        y and −θx.
        """
        r, z = self.mesh.r[nodes], self.mesh.z[nodes] - reference
        one, zero = np.ones_like(r), np.zeros_like(r)
        if self.order == 1:
            return np.stack([[one, z], [-one, -z], [zero, -r]]).transpose(2, 0, 1).reshape(-1, 2)
        if self.order == 0 and self.components == TORSION:
            return r[:, None]
        if self.order == 0 and self.components == AXIAL:
            return np.stack([zero, one], axis=1).reshape(-1, 1)
        raise ValueError(f"order {self.order} with components {self.components} holds no rigid motion")

    def point_rows(self, r: float, z: float, phi: float, u: Array, sine: bool = False) -> Array:
        """Displacement x, y, z (3, m) at the point (r, z, φ) of shapes u (n, m); sine: the turned family.

        Raises
        ------
        ValueError
            For a point outside the section.
        """
        e, xi, eta = self.mesh.locate(r, z)
        N, _, _ = shape_functions(np.array([xi]), np.array([eta]))
        c = len(self.components)
        local = np.zeros((3, u.shape[1]))
        local[list(self.components)] = np.einsum(
            "a,acm->cm", N[0], u.reshape(-1, c, u.shape[1])[self.mesh.elements[e]]
        )
        return np.asarray(self.turned(phi, sine) @ local)

    def turned(self, phi: ArrayLike, sine: bool = False) -> Array:
        """Displacement x, y, z at azimuths φ (...,) of unit U, V, W, (..., 3, 3); sine: the turned family."""
        phi, n = np.asarray(phi, dtype=np.float64), self.order
        cos, sin = np.cos(n * phi), np.sin(n * phi)
        radial, hoop, axial = (sin, -cos, sin) if sine else (cos, sin if n else np.ones_like(phi), cos)
        A = np.zeros((*phi.shape, 3, 3))
        A[..., 0, 0], A[..., 0, 1] = np.cos(phi) * radial, -np.sin(phi) * hoop
        A[..., 1, 0], A[..., 1, 1] = np.sin(phi) * radial, np.cos(phi) * hoop
        A[..., 2, 2] = axial
        return A


def _weighed(weights: Any, data: Array) -> Any:
    """Σ weights·data over the regions; of one region a tenth of what the product of matrices takes."""
    return np.asarray(weights)[0] * data[0] if len(data) == 1 else np.asarray(weights) @ data


def _strain_operators(
    mesh: RevolutionMesh, n: int, components: tuple[int, ...]
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Of the 3×3 points q of every element m: N (q, 9), r, z, det (m, q), m³ of the order's integral over φ,
    and B (m, q, 6, 9c), amplitudes of the strains ε_rr, ε_θθ, ε_zz, γ_rz, γ_rθ, γ_θz."""
    x, w = np.polynomial.legendre.leggauss(3)
    xi, eta = np.repeat(x, 3), np.tile(x, 3)
    N, N_xi, N_eta = shape_functions(xi, eta)

    nodes = np.stack([mesh.r[mesh.elements], mesh.z[mesh.elements]])
    r, z = nodes @ N.T
    (r_xi, z_xi), (r_eta, z_eta) = nodes @ N_xi.T, nodes @ N_eta.T
    det = r_xi * z_eta - r_eta * z_xi
    around = 2 * np.pi if n == 0 else np.pi  # ∫cos² nφ dφ
    dV = around * det * np.outer(w, w).ravel() * r
    d_r = (z_eta / det)[:, :, None] * N_xi - (z_xi / det)[:, :, None] * N_eta
    d_z = (r_xi / det)[:, :, None] * N_eta - (r_eta / det)[:, :, None] * N_xi
    by_r = N / r[:, :, None]

    B = np.zeros((*d_r.shape[:2], 6, 9, 3))
    B[..., 0, :, 0] = d_r
    B[..., 1, :, 0], B[..., 1, :, 1] = by_r, n * by_r
    B[..., 2, :, 2] = d_z
    B[..., 3, :, 0], B[..., 3, :, 2] = d_z, d_r
    B[..., 4, :, 0], B[..., 4, :, 1] = -n * by_r, d_r - by_r
    B[..., 5, :, 1], B[..., 5, :, 2] = d_z, -n * by_r
    B = B[..., list(components)].reshape(*d_r.shape[:2], 6, -1)

    return N, r, z, det, dV, B


def _make_deviatoric(B: Array) -> None:
    """Turn strains (m, q, 6, …) into numbers whose squares add up to e:e, in place."""
    B[:, :, :3] -= B[:, :, :3].sum(axis=2)[:, :, None] / 3
    B[:, :, 3:] *= np.sqrt(0.5)


def deviatoric_strains(
    mesh: RevolutionMesh, order: int, components: tuple[int, ...], u: Array
) -> tuple[Array, Array]:
    """Harmonics' deviatoric strain: of shapes u (n, k) at 3×3 points of each element, and their volumes.

    Parameters
    ----------
    mesh
        The section in (r, z).
    order, components
        Of the harmonic that u is of.
    u
        Shapes in its coordinates.

    Returns
    -------
    tuple of numpy.ndarray
        (m, 9, 6, k), amplitudes whose squares add up to e:e, the first four in cos nφ, the last two in sin nφ
        (without φ in order 0); and (m, 9), m³ per radian.
    """
    *_, dV, B = _strain_operators(mesh, order, components)
    _make_deviatoric(B)
    c = len(components)
    local = u.reshape(-1, c, u.shape[1])[mesh.elements].reshape(len(mesh.elements), 9 * c, -1)
    around = 2 * np.pi if order == 0 else np.pi
    return np.einsum("eqsa,eak->eqsk", B, local, optimize=True), dV / around


@dataclass(frozen=True, eq=False)
class Pattern:
    """Pattern of a harmonic's matrix: where element matrices (m, 9c, 9c) add up in csc.

    Parameters
    ----------
    indices, indptr
        Of the csc matrix.
    place
        (m, 81 c²) place of each entry of each element among the data.
    """

    indices: NDArray[np.intc]
    indptr: NDArray[np.intc]
    place: Index

    @cached_property
    def held(self) -> dict[bytes, Any]:
        """How matrices are factorised with some coordinates held, by the numbers of the others."""
        return {}

    def add(self, blocks: Array, region: Index) -> Array:
        """Data (regions, nonzeros) of the sums over the elements of each region."""
        size, regions = self.indices.size, int(region.max()) + 1
        place = self.place + (region * size)[:, None]
        summed = np.bincount(place.ravel(), weights=blocks.ravel(), minlength=regions * size)
        return np.asarray(summed, dtype=np.float64).reshape(regions, -1)


def pattern(mesh: RevolutionMesh, c: int) -> Pattern:
    """The pattern of a harmonic's matrix for a mesh with c components at each node.

    It depends on the elements' nodes alone, which designs of different dimensions share: those of small
    meshes are kept.
    """
    if len(mesh.elements) > KEPT_BELOW:
        return _pattern(mesh.elements, mesh.r.size, c)
    return _known_pattern(mesh.elements.tobytes(), mesh.r.size, c)


@functools.lru_cache(maxsize=24)
def _known_pattern(elements: bytes, nodes: int, c: int) -> Pattern:
    return _pattern(np.frombuffer(elements, dtype=np.intp).reshape(-1, 9), nodes, c)


def _pattern(elements: Index, nodes: int, c: int) -> Pattern:
    key = (elements[:, None, :] * nodes + elements[:, :, None]).ravel()  # column node major, row node minor
    pairs, where = np.unique(key, return_inverse=True)
    column, row = pairs // nodes, pairs % nodes
    count = np.bincount(column, minlength=nodes)
    start = np.concatenate([[0], np.cumsum(count)])
    rank = np.arange(pairs.size) - start[column]

    # Pair (row, column) of nodes holds c×c numbers: column b of it begins at c²·start + b·c·count, row a
    # at c·rank + a.
    a, b = np.arange(c)[:, None], np.arange(c)
    at = (c * c * start[column] + c * rank)[:, None, None] + a + b * (c * count[column])[:, None, None]
    indices = np.empty(pairs.size * c * c, dtype=np.intc)
    indices[at] = (c * row)[:, None, None] + a
    per_column = np.repeat(c * count, c)
    indptr = np.concatenate([[0], np.cumsum(per_column)]).astype(np.intc)

    # Element entry (9c, 9c) as (node i, a, node j, b); `where` runs over (element, i, j).
    place = at[where.reshape(-1, 9, 9)].transpose(0, 1, 3, 2, 4).reshape(len(elements), -1)
    return Pattern(indices, indptr, place)


def _kept_on_axis(mesh: RevolutionMesh, order: int, components: tuple[int, ...]) -> tuple[Index, Index]:
    """Coordinates kept, and the nodes on the axis.

    A regular field has U = V = 0 there in order 0, V = −U and W = 0 in order 1, and vanishes in higher ones.
    """
    axis = np.flatnonzero(mesh.r <= 1e-9 * mesh.size)
    keep = np.ones((mesh.r.size, len(components)), dtype=bool)
    for at, component in enumerate(components):
        regular = (order == 0 and component == 2) or (order == 1 and component == 0)
        if not regular:
            keep[axis, at] = False
    return np.flatnonzero(keep.ravel()), axis


def assemble_harmonic(
    mesh: RevolutionMesh, order: int, components: tuple[int, ...] = ALL_COMPONENTS
) -> Harmonic:
    """Matrices of a body of revolution for one Fourier harmonic.

    Parameters
    ----------
    mesh
        The section in (r, z).
    order
        Of the harmonic in the azimuth, 0, 1, 2, …
    components
        The motions that are left free, 0: radial U, 1: tangential V, 2: axial W.

    Returns
    -------
    Harmonic

    Raises
    ------
    ValueError
        For a negative order, or components that couple with ones left out.
    """
    whole("order", order, 0, remedy="it must be a Fourier order: 0, 1, 2, ...")
    if components != ALL_COMPONENTS and (order > 0 or components not in (AXIAL, TORSION)):
        raise ValueError(
            f"components is {components}; orders above 0 need (0, 1, 2), order 0 takes (0, 2) or (1,) too"
        )
    mass, volumetric, deviatoric = mesh.integrals.matrices(order, components)
    return gathered_harmonic(mesh, order, components, mass, volumetric, deviatoric)


def moved_sections(mesh: RevolutionMesh, rates: Iterable[tuple[Array, Array]]) -> list[SectionIntegrals]:
    """Integrals over a section whose nodes move at rates dr, dz (nodes,) each, a complex step of STEP on.

    Parameters
    ----------
    mesh
        The section where it is.
    rates
        Of its nodes, by each parameter.
    """
    r, z = mesh.element_nodes
    return [
        SectionIntegrals.of(r + 1j * STEP * dr[mesh.elements], z + 1j * STEP * dz[mesh.elements])
        for dr, dz in rates
    ]


def harmonic_slopes(h: Harmonic, moved: Iterable[SectionIntegrals]) -> list[Harmonic]:
    """Derivatives of a harmonic's matrices where the nodes of its mesh move.

    By a complex step of the nodes within the element matrices, which is exact to round-off.

    Parameters
    ----------
    h
        Matrices of the mesh where it is.
    moved
        By each parameter, of `moved_sections`.

    References
    ----------
    W. Squire and G. Trapp, SIAM Rev. 40 (1998) 110.
    """
    found = []
    for section in moved:
        mass, volumetric, deviatoric = (A.imag / STEP for A in section.matrices(h.order, h.components))
        found.append(
            gathered_harmonic(h.mesh, h.order, h.components, mass, volumetric, deviatoric, h.pattern)
        )
    return found


def gathered_harmonic(
    mesh: RevolutionMesh,
    order: int,
    components: tuple[int, ...],
    mass: Array,
    volumetric: Array,
    deviatoric: Array,
    known: Pattern | None = None,
) -> Harmonic:
    """A harmonic of element matrices; some are changed here, where the axis ties coordinates.

    Parameters
    ----------
    mass
        (m, 9, 9) of one component.
    volumetric, deviatoric
        (m, 9c, 9c) stiffness per unit bulk modulus and per 2G.
    known
        The pattern of the mesh with c components, if it is at hand.
    """
    c = len(components)
    mass = (mass[:, :, None, :, None] * np.eye(c)[:, None, :]).reshape(len(mass), 9 * c, 9 * c)
    free, axis = _kept_on_axis(mesh, order, components)
    blocks = [mass, volumetric, deviatoric]
    if order == 1 and axis.size:
        e, k = np.nonzero(np.isin(mesh.elements, axis))
        for A in blocks:  # V = −U: rows and columns of V join those of U
            A[e, 3 * k] -= A[e, 3 * k + 1]
            A[e, :, 3 * k] -= A[e, :, 3 * k + 1]
            A[e, 3 * k + 1] = 0
            A[e, :, 3 * k + 1] = 0
    where = pattern(mesh, c) if known is None else known
    data = [where.add(A, mesh.region) for A in blocks]
    return Harmonic(
        mesh=mesh,
        order=order,
        components=components,
        pattern=where,
        mass=data[0],
        volumetric=data[1],
        deviatoric=data[2],
        free=free,
    )
