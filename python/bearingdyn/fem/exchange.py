"""Stiffness and mass matrices of other finite element programs, read from files and checked."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse
from numpy.typing import ArrayLike, NDArray

from bearingdyn.fem.eigen import rigid_body_residual, rigid_motion

Float = NDArray[np.float64]

SYMMETRY = 1e-6  # files often carry six digits or so: larger differences are errors, not round-off


@dataclass(frozen=True, eq=False)
class FEMatrices:
    """A finite element model read from elsewhere.

    K, M: (n, n) sparse stiffness, N/m, and mass, kg, made exactly symmetric.
    points: (n / 3, 3) node positions, m, when given: coordinate 3 i + a is node i along axis a.
    """

    K: scipy.sparse.csr_matrix
    M: scipy.sparse.csr_matrix
    points: Float | None = None


def _sparse(name: str, value: Any) -> scipy.sparse.csr_matrix:
    A = scipy.sparse.csr_matrix(value)
    if np.iscomplexobj(A):
        raise ValueError(f"{name} is complex; a stiffness or mass matrix must be real")
    A = scipy.sparse.csr_matrix(A, dtype=np.float64)
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
    return scipy.sparse.csr_matrix(0.5 * (A + A.T))


def check_matrices(K: Any, M: Any, points: ArrayLike | None = None) -> FEMatrices:
    """Check a stiffness and mass pair and make it sparse.

    K, M: (n, n) dense or sparse. points: (n / 3, 3) node positions, m, of a body free in space; then K must
    not resist rigid motion (relative force below 1e-6) and M must carry one mass in all three directions.

    Raises ValueError naming the matrix and what is wrong with it.
    """
    k, m = _sparse("K", K), _sparse("M", M)
    if k.shape != m.shape:
        raise ValueError(f"K has shape {k.shape} and M {m.shape}; they must be of one model, of equal size")
    k, m = _symmetric("K", k), _symmetric("M", m)
    if k.diagonal().min() < 0 or m.diagonal().min() < 0:
        name = "K" if k.diagonal().min() < 0 else "M"
        raise ValueError(f"{name} has a negative diagonal entry; it must be positive semi-definite")
    if points is None:
        return FEMatrices(k, m)
    p = np.asarray(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] != 3 or 3 * len(p) != k.shape[0] or not np.isfinite(p).all():
        raise ValueError(f"points has shape {p.shape}; it must be ({k.shape[0] / 3:g}, 3) and finite")
    R = rigid_motion(p, p.mean(axis=0))
    residual = rigid_body_residual(k, R)
    if not residual < 1e-6:
        raise ValueError(
            f"K resists rigid motion (relative force {residual:.2g}); export the model without supports, "
            "with coordinates in the order x, y, z of each of points"
        )
    mass = np.diag(R[:, :3].T @ (m @ R[:, :3]))
    if not np.ptp(mass) <= 1e-6 * mass.max():
        raise ValueError(f"M has the masses {mass.tolist()} kg along x, y, z; they must be equal")
    return FEMatrices(k, m, p)


def _read_mtx(path: Path) -> Any:
    try:
        return scipy.io.mmread(path)
    except (ValueError, OSError, StopIteration, OverflowError) as error:
        raise ValueError(f"{path} cannot be read as a MatrixMarket file: {error}") from error


def _existing(path: str | Path) -> Path:
    p = Path(path)
    if not p.is_file():
        raise ValueError(f"{p} is not a file; check the path")
    return p


def read_matrix_market(
    stiffness: str | Path, mass: str | Path, points: ArrayLike | None = None
) -> FEMatrices:
    """Read a stiffness and a mass matrix from two MatrixMarket files (.mtx) in SI units.

    Raises ValueError for a file that is not there, not MatrixMarket, or fails check_matrices.
    """
    files = [_existing(stiffness), _existing(mass)]
    return check_matrices(_read_mtx(files[0]), _read_mtx(files[1]), points)


def _from_arrays(arrays: Mapping[str, Any], name: str, path: Path) -> Any:
    if name in arrays:
        return arrays[name]
    parts = [f"{name}_{key}" for key in ("data", "indices", "indptr", "shape")]
    if not all(part in arrays for part in parts):
        raise ValueError(
            f"{path} has no {name}; it must hold {name}, or {', '.join(parts)} in compressed rows; "
            f"it holds {sorted(arrays)}"
        )
    data, indices, indptr, shape = (arrays[part] for part in parts)
    try:
        A = scipy.sparse.csr_matrix((data, indices, indptr), shape=tuple(int(i) for i in shape))
        A.check_format(full_check=True)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{path} holds no compressed rows in {', '.join(parts)}: {error}") from error
    return A


def read_npz(path: str | Path) -> FEMatrices:
    """Read a NumPy archive with K and M, in SI units, and perhaps points.

    K and M are each dense, or in compressed sparse rows: four arrays K_data, K_indices, K_indptr, K_shape.
    Pickled objects are not read.

    Raises ValueError for a file that is not there, not such an archive, or fails check_matrices.
    """
    p = _existing(path)
    try:
        with np.load(p, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, AttributeError, TypeError) as error:
        raise ValueError(f"{p} cannot be read as a NumPy archive (.npz): {error}") from error
    return check_matrices(_from_arrays(arrays, "K", p), _from_arrays(arrays, "M", p), arrays.get("points"))


def write_npz(path: str | Path, model: FEMatrices) -> None:
    """Write a model as read_npz reads it, in compressed sparse rows."""
    arrays: dict[str, Any] = {}
    for name, A in (("K", model.K), ("M", model.M)):
        arrays |= {
            f"{name}_data": A.data,
            f"{name}_indices": A.indices,
            f"{name}_indptr": A.indptr,
            f"{name}_shape": np.array(A.shape),
        }
    if model.points is not None:
        arrays["points"] = model.points
    np.savez(path, **arrays)
