"""The checks that matrices of another program are the stiffness and mass of one free body, in SI units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import ArrayLike

from bearingdyn.checks import positive, whole
from bearingdyn.fem.factors import pivots
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.units import SI, Units
from bearingdyn.fem.rigid_motion import rigid_body_residual
from bearingdyn.types import Array, Index

SIX_DIGITS = 5e-6  # a number written with six digits differs by up to so much of itself
RIGID = 1e-6  # relative force that a rigid motion may meet in a matrix with all its digits
SYMMETRY = 1e-6  # files often carry six digits or so: larger differences are errors, not round-off
SUPPORT = 1e30  # N/m: programs that keep a support in the matrix write such a number on its diagonal
EXPECTED = 0.05  # accepted difference from a mass the user states
DENSEST = 25e3  # kg/m³ over the box around all nodes; osmium has 22 600
SOUND = (200.0, 25e3)  # m/s, √(bulk modulus / density): stiff rubber 1300, steel 4600, diamond 11 000


def check_matrices(
    K: Any,
    M: Any,
    points: Points | None = None,
    *,
    labels: ArrayLike | None = None,
    internal: int = 0,
    units: Units = SI,
    expected_mass: float | None = None,
    sound: tuple[float, float] = SOUND,
) -> FEMatrices:
    """Check the stiffness and mass of a free body, make them sparse and bring them to SI units.

    K is factorised once for its pivots: some 8 s and 1.5 GB at 35 000 coordinates. Rotations with neither
    stiffness nor mass, which solids have in files of six coordinates a node, are left out.

    Parameters
    ----------
    K, M
        (n, n) dense or sparse, symmetric, in the file's units; one triangle alone is refused.
    points
        (k, 3) positions of the nodes, or node number -> position, in the file's unit of length. With points,
        K must not resist rigid motion (relative force up to 1e-6, or 5e-6 where
        the numbers have six digits), M must carry the
        same mass in all three directions, and density and speed of sound must be those of a solid.
    labels
        (n, 2) node number and direction 1...6 of each coordinate; they are put in rising order. None: there
        are three coordinates to a point, x, y, z, or six.
    internal
        Number of coordinates at the end that belong to no node (modal ones of a reduced model).
    units
        Units of the file.
    expected_mass
        Mass, kg, that M must have to 5 %; None: not checked.
    sound
        Accepted range of √(bulk modulus/density), m/s, the mean over the body; widen it for foams.

    Raises
    ------
    ValueError
        Naming the matrix, what is wrong with it and the remedy.
    """
    k, m = _sparse("K", K), _sparse("M", M)
    if k.shape != m.shape:
        raise ValueError(f"K has shape {k.shape} and M {m.shape}; they must be of one model, of equal size")
    k, m = _symmetric("K", k), _symmetric("M", m)
    model = _placed(k, m, points, labels, internal)
    _check_coordinates(model)
    model = _scaled(_without_empty_rotations(model), units)
    _check_mass_matrix(model)
    if model.points is not None:
        _check_free(model)
        _check_mass(model, expected_mass)
        _check_units(model, sound)
    elif expected_mass is not None:
        raise ValueError(
            f"expected_mass={expected_mass} kg cannot be compared without points; give the nodes' positions"
        )
    _check_pivots(model)
    return model


def checked_files(
    files: Sequence[str | Path], K: Any, M: Any, points: Points | None, **check: Any
) -> FEMatrices:
    """Check matrices that files gave, a free body's, as `check_matrices` does; errors name the files."""
    try:
        return check_matrices(K, M, points, **check)
    except ValueError as error:
        raise ValueError(f"{' and '.join(dict.fromkeys(str(f) for f in files))}: {error}") from None


def _sparse(name: str, value: Any) -> scipy.sparse.csr_matrix:
    kind = getattr(value, "dtype", np.dtype(np.float64)).kind
    if kind == "b":
        raise ValueError(f"{name} holds truth values, a pattern without numbers; export its values")
    try:
        A = scipy.sparse.csr_matrix(value)
        if np.iscomplexobj(A):
            raise ValueError(f"{name} is complex; a stiffness or mass matrix must be real")
        A = scipy.sparse.csr_matrix(A, dtype=np.float64)
    except TypeError as error:
        raise ValueError(f"{name} is no matrix of numbers: {error}") from None
    if A.shape[0] != A.shape[1] or A.shape[0] == 0:
        raise ValueError(f"{name} has shape {A.shape}; it must be square")
    if not np.isfinite(A.data).all():
        raise ValueError(f"{name} has an entry that is not finite; check the export")
    return A


def _symmetric(name: str, A: scipy.sparse.csr_matrix) -> scipy.sparse.csr_matrix:
    scale = abs(A).max()
    if not scale > 0:
        raise ValueError(f"{name} is zero everywhere; check the export")
    error = abs(A - A.T).max() / scale
    if not error <= SYMMETRY:
        raise ValueError(
            f"{name} is not symmetric (relative difference {error:.2g}); if the file holds one triangle, "
            "say so in it (MatrixMarket 'symmetric') or add the other"
        )
    A = scipy.sparse.csr_matrix(0.5 * (A + A.T))
    A.eliminate_zeros()
    return A


def _positions(points: Points, numbers: Index | None) -> tuple[Array, Index | None]:
    """Positions (k, 3) in the order of the nodes' numbers, and the numbers."""
    if not isinstance(points, Mapping):
        p = np.asarray(points, dtype=np.float64)
        if p.ndim != 2 or p.shape[1] != 3 or not np.isfinite(p).all():
            raise ValueError(f"points has shape {p.shape}; it must be (nodes, 3) and finite")
        if numbers is not None and len(p) != numbers.size:
            raise ValueError(
                f"points has shape {p.shape}, while the matrices name {numbers.size} nodes; give a position "
                "for each in rising order of the numbers, or a mapping from number to position"
            )
        return p, numbers
    if numbers is None:
        numbers = np.array(sorted(points), dtype=np.intp)
    missing = [int(i) for i in numbers if int(i) not in points]
    if missing:
        raise ValueError(
            f"points has no node {missing[0]}; the matrices name it ({len(missing)} are missing)"
        )
    chosen = np.array([np.asarray(points[int(i)], dtype=np.float64) for i in numbers])
    return _positions(chosen, None)[0], numbers


def _placed(k: Any, m: Any, points: Points | None, labels: ArrayLike | None, internal: int) -> FEMatrices:
    """The model with its coordinates in the order of nodes and directions."""
    n = k.shape[0]
    internal = whole("internal", internal, 0, remedy=f"it must be a number of coordinates below {n}")
    if not internal < n:
        raise ValueError(f"internal is {internal}; it must be a number of coordinates below {n}")
    at_nodes = n - internal
    tail = np.stack([np.full(internal, -1), np.zeros(internal)], axis=1).astype(np.intp)
    if labels is None:
        if points is None:
            return FEMatrices(M=m, K=k)
        p, numbers = _positions(points, None)
        per = next((d for d in (3, 6) if d * len(p) == at_nodes), 0)
        if not per:
            raise ValueError(
                f"points has shape {p.shape}; for {at_nodes} coordinates of three or six a node it must be "
                f"({at_nodes / 3:g}, 3) or ({at_nodes / 6:g}, 3)"
            )
        place = np.stack(np.divmod(np.arange(at_nodes), per), axis=1).astype(np.intp)
        return FEMatrices(M=m, K=k, points=p, nodes=numbers, dofs=np.vstack([place, tail]))
    given = _whole_labels(labels)
    if given.shape != (at_nodes, 2):
        raise ValueError(f"labels has shape {given.shape}; it must be ({at_nodes}, 2): node and direction")
    wrong = given[(given[:, 1] < 1) | (given[:, 1] > 6)]
    if wrong.size:
        raise ValueError(f"labels has direction {wrong[0, 1]} at node {wrong[0, 0]}; it must be 1 to 6")
    order = np.lexsort((given[:, 1], given[:, 0]))
    ordered = given[order]
    twice = np.flatnonzero((np.diff(ordered, axis=0) == 0).all(axis=1))
    if twice.size:
        node, direction = ordered[twice[0]].tolist()
        raise ValueError(f"labels names node {node}, direction {direction} twice; each coordinate once")
    numbers, row = np.unique(ordered[:, 0], return_inverse=True)
    order = np.concatenate([order, np.arange(at_nodes, n)])
    positions = None if points is None else _positions(points, numbers)[0]
    dofs = np.vstack([np.stack([row.ravel(), ordered[:, 1] - 1], axis=1), tail]).astype(np.intp)
    return FEMatrices(M=m[order][:, order], K=k[order][:, order], points=positions, nodes=numbers, dofs=dofs)


def _whole_labels(labels: ArrayLike) -> Index:
    try:
        numbers = np.asarray(labels, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError("labels must be whole numbers, of node and direction of each coordinate") from None
    wrong = numbers[~((np.rint(numbers) == numbers) & (np.abs(numbers) < 2**53))]
    if wrong.size:
        raise ValueError(
            f"labels has {wrong.flat[0]:g}; node and direction of each coordinate must be whole numbers"
        )
    return numbers.astype(np.intp)


def _check_coordinates(model: FEMatrices) -> None:
    """No coordinate is supported, unconnected, or of negative stiffness or mass."""
    k, m = model.K.diagonal(), model.M.diagonal()
    for name, diagonal in (("K", k), ("M", m)):
        if diagonal.min() < 0:
            at = int(np.argmin(diagonal))
            raise ValueError(
                f"{name} has a negative diagonal entry, {diagonal[at]:.3g} at {model.name(at)}; it must be "
                "positive semi-definite"
            )
    if k.max() > SUPPORT:
        at = int(np.argmax(k))
        raise ValueError(
            f"K has {k[at]:.3g} at {model.name(at)}: a support is in it; export the model without supports"
        )
    turning = model.places[:, 1] >= 3
    loose = np.flatnonzero((k == 0) & ~((m == 0) & turning))
    if loose.size:
        what = "mass but no stiffness" if m[loose[0]] > 0 else "neither stiffness nor mass"
        raise ValueError(
            f"K has no stiffness at {model.name(loose[0])}, which has {what} ({loose.size} such "
            "coordinates); connect the node or leave it out of the export"
        )


def _without_empty_rotations(model: FEMatrices) -> FEMatrices:
    kept = np.flatnonzero(model.K.diagonal() > 0)
    if kept.size == model.n:
        return model
    return replace(model, M=model.M[kept][:, kept], K=model.K[kept][:, kept], dofs=model.places[kept])


def _scaled(model: FEMatrices, units: Units) -> FEMatrices:
    """In SI: a matrix of energy mass·length²/time² for translations in length and angles in radian."""
    if units == SI:
        return model
    D = scipy.sparse.diags(np.where(model.places[:, 1] < 3, 1.0, units.length))
    M = scipy.sparse.csr_matrix(units.mass * (D @ model.M @ D))
    K = scipy.sparse.csr_matrix(units.mass / units.time**2 * (D @ model.K @ D))
    points = None if model.points is None else units.length * model.points
    return replace(model, M=M, K=K, points=points)


def _check_mass_matrix(model: FEMatrices) -> None:
    """M is positive semi-definite: by its least eigenvalue, scaled to a unit diagonal."""
    m = model.M.diagonal()
    at = np.flatnonzero(m > 0)
    d = scipy.sparse.diags(1.0 / np.sqrt(m[at]))
    scaled = scipy.sparse.csc_matrix(d @ model.M[at][:, at] @ d)
    if at.size <= 50:
        least = float(np.linalg.eigvalsh(scaled.toarray())[0])
    else:
        start = np.random.default_rng(0).standard_normal(at.size)
        least = float(
            scipy.sparse.linalg.eigsh(scaled, 1, which="SA", tol=0.03, v0=start, return_eigenvectors=False)[0]
        )
    if not least > -SYMMETRY:
        raise ValueError(
            f"M is indefinite: scaled to a unit diagonal it has the eigenvalue {least:.2g}; check the export"
        )


def _check_free(model: FEMatrices) -> None:
    assert model.points is not None
    R = model.rigid_motion(model.points.mean(axis=0))
    residual = rigid_body_residual(model.K, R)
    # what six digits leave of the balance at worst; numbers with more digits balance better
    most = SIX_DIGITS if _of_six_digits(model.K.data) else RIGID
    if not residual <= most:
        raise ValueError(
            f"K resists rigid motion (relative force {residual:.2g}); export the model without supports, "
            "with coordinates in the order x, y, z of each of points"
        )


def _check_mass(model: FEMatrices, expected: float | None) -> None:
    assert model.points is not None
    T = model.rigid_motion(model.points.mean(axis=0))[:, :3]
    mass = np.diag(T.T @ (model.M @ T))
    if not np.ptp(mass) <= 2.0 * SIX_DIGITS * mass.max():  # each sum within SIX_DIGITS
        raise ValueError(f"M has the masses {mass.tolist()} kg along x, y, z; they must be equal")
    if expected is None:
        return
    positive("expected_mass", expected, "it must be a positive mass in kg")
    ratio = float(mass[0]) / expected
    if not abs(ratio - 1.0) <= EXPECTED:
        thousand = abs(abs(np.log10(ratio)) - 3.0) < 0.1
        hint = "the file is in other units: pass units=Units(length=..., mass=..., time=...)"
        if thousand and ratio < 1:
            hint = "a thousandth: the file is in mm, t, s; pass units=MM_TONNE"
        elif thousand:
            hint = "a thousand times that: the file is in SI, or in grams; check units"
        raise ValueError(f"M totals {mass[0]:.6g} kg where {expected:.6g} kg is expected: {hint}")


def _check_units(model: FEMatrices, sound: tuple[float, float]) -> None:
    """A uniform swelling u = p has the energy 9/2 K V, the bulk modulus K over the mass ρ V."""
    assert model.points is not None
    size = np.ptp(model.points, axis=0)
    own = model.places[:, 1]
    flat = not np.all(size > 0) or np.any(own >= 3) or np.any(model.places[:, 0] < 0)
    if flat:  # beams, shells and reduced matrices do not fill a box, and swell otherwise
        return
    T = model.rigid_motion(model.points.mean(axis=0))[:, :3]
    mass = float(T[:, 0] @ (model.M @ T[:, 0]))
    if not mass <= DENSEST * float(np.prod(size)):
        raise ValueError(
            f"M totals {mass:.3g} kg in a box of {' × '.join(f'{s:.3g}' for s in size)} m, denser than any "
            "solid; pass the units of the file, such as units=MM_TONNE"
        )
    u = model.points[model.places[:, 0], own] - model.points.mean(axis=0)[own]
    speed = float(np.sqrt(u @ (model.K @ u) / (9.0 * mass)))
    if not sound[0] <= speed <= sound[1]:
        raise ValueError(
            f"K, M and points together give a speed √(bulk modulus/density) of {speed:.3g} m/s, where solids "
            f"have {sound[0]:g} to {sound[1]:g}; pass the file's units, such as units=MM_TONNE (mm, t, s)"
        )


def _check_pivots(model: FEMatrices) -> None:
    """K is positive semi-definite, by its pivots, but for what the digits of its file make of rigid motion.

    Scaled to a unit diagonal, S with orthonormal rigid motions Q, an exact K has S Q = 0. Rounding leaves
    e = ‖S Q‖, which is measured, and an S whose elastic part is positive semi-definite then has no eigenvalue
    below −(1 + √5)/2 e, the least one of [[−e, −e], [−e, 0]]; rounding shifts the elastic part by about e
    more. So 3 e, or a millionth if that is more, is added before the pivots are looked at. Where positions
    are not known and the numbers have six digits or fewer, it is the bound of Weyl: 5e-6 times the largest
    row sum of |S|.
    """
    root = np.sqrt(model.K.diagonal())
    S = scipy.sparse.csr_matrix(scipy.sparse.diags(1.0 / root) @ model.K @ scipy.sparse.diags(1.0 / root))
    left = 0.0
    if model.points is not None:
        R = root[:, None] * model.rigid_motion(model.points.mean(axis=0))
        u, sizes, _ = np.linalg.svd(R, full_matrices=False)
        left = 3.0 * float(np.linalg.norm(S @ u[:, sizes > 1e-9 * sizes[0]], 2))
    elif _of_six_digits(model.K.data):
        left = SIX_DIGITS * float(abs(S).sum(axis=1).max())
    try:
        pivot = pivots(S + max(left, SYMMETRY) * scipy.sparse.eye(model.n))
    except RuntimeError as error:
        raise ValueError(f"K is singular beyond rigid motion ({error}); check the export") from error
    negative = np.flatnonzero(~(pivot > 0))
    if negative.size:
        raise ValueError(
            f"K is indefinite: {negative.size} negative pivots, one at {model.name(int(negative[0]))}; "
            "a stress-free structure has none: check signs, contact and preload of the export"
        )


def _of_six_digits(values: Array) -> bool:
    """Whether no number has more than six digits, or is the mean of two of them.

    What is zero but for round-off says nothing.
    """
    v = np.abs(values)
    v = v[v > 1e-9 * v.max()]
    mantissa = 2.0 * v * 10.0 ** (5.0 - np.floor(np.log10(v)))
    return bool(np.all(np.abs(mantissa - np.rint(mantissa)) < 1e-3))
