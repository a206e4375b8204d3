"""NumPy archives (.npz)."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points, check_matrices


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


def read_npz(path: str | Path, points: Points | None = None, **check: Any) -> FEMatrices:
    """Read a NumPy archive with K and M, and perhaps points, labels and internal.

    K and M are each dense, or in compressed sparse rows: four arrays K_data, K_indices, K_indptr, K_shape.
    Pickled objects are not read.

    Parameters
    ----------
    path
        Path of the archive.
    points
        Positions of the nodes, as in check_matrices; None: those of the archive.
    check
        Further arguments of check_matrices.

    Raises
    ------
    ValueError
        For a file that does not exist or is not such an archive, or where check_matrices does.
    """
    p = existing(path)
    try:
        with np.load(p, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    except (ValueError, OSError, EOFError, zipfile.BadZipFile, AttributeError, TypeError) as error:
        raise ValueError(f"{p} cannot be read as a NumPy archive (.npz): {error}") from error
    if "labels" in arrays:
        check.setdefault("labels", arrays["labels"])
    if "internal" in arrays:
        check.setdefault("internal", int(arrays["internal"]))
    points = arrays.get("points") if points is None else points
    return check_matrices(_from_arrays(arrays, "K", p), _from_arrays(arrays, "M", p), points, **check)


def write_npz(path: str | Path, model: FEMatrices) -> None:
    """Write a model as read_npz reads it, in compressed sparse rows and SI units."""
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
    if model.dofs is not None:
        row, direction = model.dofs[model.dofs[:, 0] >= 0].T
        numbers = row if model.nodes is None else model.nodes[row]
        arrays["labels"] = np.stack([numbers, direction + 1], axis=1)
        arrays["internal"] = np.array(model.n - row.size)
    np.savez(path, **arrays)
