"""Solids of one family, as housings of many bores: a few are reduced, the others interpolated between them.

All members have one mesh, whose nodes move with the parameter. The shapes of some members span a common basis
W within the body; on the interfaces the nodes follow these rigidly:

    u = T(x) q on the interfaces,  u = W w within.

In these coordinates the matrices of all members mean the same and are smooth functions of the parameter,
which polynomials through those of the samples follow. A member is then a reduction of the small model, made
as that of its full model would be; members between the samples are compared with their full models.

Projection on one basis and interpolation of the projected matrices, Benner, Gugercin & Willcox, SIAM Rev. 57
(2015) 483-531, section 4.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import number, numbers, positive, require
from bearingdyn.cms import (
    Basis,
    FullModel,
    ReductionError,
    RigidInterface,
    Superelement,
    basis_of,
    project,
    reduction_error,
)
from bearingdyn.fem import rigid_transfer
from bearingdyn.parts.housing import Housing
from bearingdyn.parts.solid import Solid
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index
from bearingdyn.units import takes

DISTINCT = 1e-8  # singular value, over the largest, of shapes of unit length that count as told apart
SAMPLES = (3, 5, 9)  # Chebyshev's points, each set within the next


@dataclass(frozen=True, eq=False)
class _Options:
    """How members are reduced, and what stands where: of all members alike."""

    f_max: float
    inertia: int
    attach: tuple[str, ...]
    damping: float
    held: str | None
    interfaces: tuple[str, ...]
    outputs: tuple[tuple[str, int], ...]  # with their numbers of rows


@dataclass(frozen=True, eq=False)
class SolidFamily:
    """Reduced solids of one parameter, from `solid_family`; called with a value, it gives that member.

    Attributes
    ----------
    build
        Function that builds the member of a value.
    places
        (s,) values of the samples.
    W
        (inner, m) common basis within the body.
    M, K
        (s, k, k) matrices of the samples in the common coordinates, k = 6 for each interface and m.
    rows
        (s, rows, k) of the outputs.
    rigid
        (s, k, 6) rigid motions.
    positions
        (s, interfaces, 3) references, m.
    errors
        Against full models, by their values.
    """

    build: Callable[[float], Housing | Solid]
    options: _Options
    places: Array
    W: Array
    M: Array
    K: Array
    rows: Array
    rigid: Array
    positions: Array
    errors: Mapping[float, ReductionError]

    __repr__ = short
    _repr_html_ = page

    @property
    def worst(self) -> float:
        """The largest error found against full models."""
        return max(error.worst for error in self.errors.values())

    def __call__(self, value: float) -> Superelement:
        """The member of a value, reduced; without surfaces that radiate.

        Parameters
        ----------
        value
            Of the parameter.

        Raises
        ------
        ValueError
            For a value outside of the samples.
        """
        element, _ = self._member(self._inside(value))
        part = self.build(value)
        return replace(element, faces=part.round_faces()) if isinstance(part, Housing) else element

    def error(self, value: float, frequency: ArrayLike, *, exact: bool = False) -> ReductionError:
        """Error of a member against its full model, which is made for it; see `reduction_error`.

        Parameters
        ----------
        value
            Of the parameter.
        frequency
            (f,), Hz.
        exact
            Solve the full model at each frequency.

        Raises
        ------
        ValueError
            For a value outside of the samples, and frequencies that are not positive.
        """
        value = self._inside(value)
        model = _solid(self.build(value)).full_model()
        element, basis = self._member(value)
        Psi = _common(model, self.W) @ basis.Psi
        own, held = Basis(Psi, basis.K, basis.frequency), self.options.held
        return reduction_error(
            model, own, frequency, damping=self.options.damping, held=held, exact=exact, element=element
        )

    def _inside(self, value: float) -> float:
        value = number("value", value)
        low, high = float(self.places.min()), float(self.places.max())
        remedy = f"it must lie within the family, {low:.6g} to {high:.6g}"
        require(low <= value <= high, "value", value, remedy)
        return value

    def _member(self, value: float) -> tuple[Superelement, Basis]:
        """The member of a value and its shapes in the common coordinates."""
        weights, of = _lagrange(self.places, value), self.options
        M, K, rows, rigid, positions = (
            np.tensordot(weights, A, 1) for A in (self.M, self.K, self.rows, self.rigid, self.positions)
        )
        # what interpolation leaves of the stiffness against rigid motion
        Q = np.linalg.qr(rigid)[0]
        K = K - Q @ (Q.T @ K)
        K = K - (K @ Q) @ Q.T
        starts = np.cumsum([0, *(count for _, count in of.outputs)])
        model = FullModel(
            M=0.5 * (M + M.T),
            K=0.5 * (K + K.T),
            interfaces={
                name: RigidInterface(np.arange(6 * i, 6 * i + 6), np.eye(6), positions[i])
                for i, name in enumerate(of.interfaces)
            },
            outputs={
                name: rows[at : at + count] for (name, count), at in zip(of.outputs, starts, strict=False)
            },
        )
        basis = _shapes(model, of)
        return project(model, basis, damping=of.damping, held=of.held), basis


@takes(frequency="Hz")
def solid_family(
    build: Callable[[float], Housing | Solid],
    low: float,
    high: float,
    *,
    frequency: ArrayLike,
    tolerance: float = 0.01,
) -> SolidFamily:
    """Family of solids of one parameter, interpolated between a few that are reduced.

    3, then 5, then 9 members at Chebyshev's points are reduced, until those half-way between them differ from
    their full models by less than the tolerance at all given frequencies.

    Parameters
    ----------
    build
        Function of a value that returns a `Housing` or a `Solid`: elastic, without bores that carry balls,
        of one mesh whose nodes move smoothly with the value. Give housings an `element_size`.
    low, high
        Range of the parameter.
    frequency
        (f,), Hz, at which members are compared with their full models (`reduction_error`).
    tolerance
        Largest error there; it includes that of the reduction itself.

    Returns
    -------
    SolidFamily
        Called with a value, it gives that member.

    Raises
    ------
    ValueError
        For members of unlike meshes, or of materials that are not elastic; and where nine samples leave more
        than the tolerance, saying where.

    Examples
    --------
    >>> import bearingdyn as bd, numpy as np
    >>> def pedestal(bore):
    ...     return bd.Housing(0.16, 0.2, 0.03, bore, f_max=4e3, element_size=0.03)
    >>> family = bd.solid_family(pedestal, 0.078, 0.080, frequency=[200.0, 1000.0])
    >>> len(family.places), bool(family.worst < 0.01)
    (3, True)
    >>> family(0.0787).interfaces.keys()
    dict_keys(['bore', 'feet'])
    """
    require(callable(build), "build", build, "it must be a function of a value that returns a part")
    low, high = number("low", low), number("high", high)
    require(low < high, "high", high, f"it must lie above low, {low:.6g}")
    tolerance = positive("tolerance", tolerance)
    f = numbers("frequency", frequency, "it must be one or more positive frequencies in Hz")
    require(f.size > 0 and bool((f > 0).all()), "frequency", frequency, "they must be positive, Hz")
    samples: dict[float, tuple[Solid, FullModel, Basis]] = {}
    for count in SAMPLES:
        angle = np.pi * np.arange(count) / (count - 1)
        places = np.sort(0.5 * (low + high) - 0.5 * (high - low) * np.cos(angle))
        places[0], places[-1] = low, high
        for value in places.tolist():
            if not any(math.isclose(value, known, rel_tol=1e-12) for known in samples):
                samples[value] = _sample(build, value, next(iter(samples.values()), None))
        family = _family(build, dict(sorted(samples.items())))
        between = 0.5 * (family.places[1:] + family.places[:-1])
        errors = {value: family.error(value, f) for value in between.tolist()}
        family = replace(family, errors=errors)
        if family.worst <= tolerance:
            return family
    value = max(errors, key=lambda v: errors[v].worst)
    raise ValueError(
        f"tolerance is {tolerance}; with {count} samples the member of {value:.6g} still errs by "
        f"{family.worst:.2g}: narrow the range, lower the frequencies, or raise f_max of the members"
    )


def _solid(part: Housing | Solid) -> Solid:
    return part.body if isinstance(part, Housing) else part


def _sample(
    build: Callable[[float], Housing | Solid], value: float, first: tuple[Solid, FullModel, Basis] | None
) -> tuple[Solid, FullModel, Basis]:
    """A member, its full model and shapes. Raises ValueError where it is not like the first."""
    part = build(value)
    require(isinstance(part, Housing | Solid), "build", part, "it must return a bd.Housing or a bd.Solid")
    solid = _solid(part)
    model = solid.full_model()
    require(not model.viscoelastic, "build", part, "its members must be elastic")
    plain = not solid.bores and not model.grounded
    require(plain, "build", part, "a member with bores that carry balls, or pressed, has no family")
    if first is not None:
        same = np.array_equal(first[0].mesh.elements, solid.mesh.elements)
        theirs = first[1].interfaces
        alike = same and list(model.interfaces) == list(theirs) and all(
            np.array_equal(face.dofs, theirs[name].dofs) for name, face in model.interfaces.items()
        )  # fmt: skip
        remedy = (
            f"the member of {value:.6g} has another mesh than the first; give all one (other) element_size"
        )
        require(alike, "build", part, remedy)
    return solid, model, solid.basis()


def _family(
    build: Callable[[float], Housing | Solid], samples: Mapping[float, tuple[Solid, FullModel, Basis]]
) -> SolidFamily:
    """The family of some members, not yet compared."""
    solid, model, _ = next(iter(samples.values()))
    inner = _inner(model)
    shapes = np.hstack([basis.Psi[inner] for _, _, basis in samples.values()])
    shapes = shapes / np.linalg.norm(shapes, axis=0)
    U, size, _ = np.linalg.svd(shapes, full_matrices=False)
    W = U[:, size > DISTINCT * size[0]]
    M, K, rows, rigid, positions = [], [], [], [], []
    for _, of, basis in samples.values():
        Phi = _common(of, W)
        M.append(Phi.T @ (of.M @ Phi))
        K.append(Phi.T @ (of.K @ Phi))
        rows.append(np.vstack([np.zeros((0, Phi.shape[1])), *(row @ Phi for row in of.outputs.values())]))
        faces = [face.position for face in of.interfaces.values()]
        R = rigid_transfer(faces, np.mean(faces, axis=0))
        # constraint modes of a rigid motion are rigid motion; W is orthonormal
        rigid.append(np.vstack([R, W.T @ (basis.Psi[inner, : len(R)] @ R)]))
        positions.append(np.array(faces))
    options = _Options(
        solid.f_max, solid.inertia, solid.attach, solid.damping, solid.held,
        tuple(model.interfaces), tuple((name, row.shape[0]) for name, row in model.outputs.items()),
    )  # fmt: skip
    return SolidFamily(
        build=build, options=options, places=np.array(list(samples)), W=W, M=np.array(M), K=np.array(K),
        rows=np.array(rows), rigid=np.array(rigid), positions=np.array(positions), errors={},
    )  # fmt: skip


def _inner(model: FullModel) -> Index:
    """Coordinates within the body."""
    held = np.concatenate([face.dofs for face in model.interfaces.values()])
    return np.setdiff1d(np.arange(model.n), held)


def _common(model: FullModel, W: Array) -> Array:
    """Φ(x) (n, k): the common coordinates' motion of all nodes."""
    faces = list(model.interfaces.values())
    Phi = np.zeros((model.n, 6 * len(faces) + W.shape[1]))
    Phi[np.concatenate([f.dofs for f in faces]), : 6 * len(faces)] = scipy.linalg.block_diag(
        *[f.T for f in faces]
    )
    Phi[_inner(model), 6 * len(faces) :] = W
    return Phi


def _shapes(model: FullModel, of: _Options) -> Basis:
    """The reduction of a small model, by the members' options."""
    return basis_of(
        model,
        f_max=of.f_max if of.f_max > 0 else None,
        n_modes=None if of.f_max > 0 else 0,
        inertia=of.inertia,
        attach=of.attach,
    )


def _lagrange(places: Array, value: float) -> Array:
    """Weights (s,) of the polynomial through the samples (s,), at a value."""
    apart = value - places
    return np.array(
        [np.prod(np.delete(apart, j) / np.delete(places[j] - places, j)) for j in range(places.size)]
    )
