"""NumPy archives (.npz)."""

from __future__ import annotations

import io
import lzma
import math
import os
import re
import struct
import tokenize
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np
import scipy.sparse

from bearingdyn.checks import existing
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices, Points
from bearingdyn.fem.matrix_files.free_body_checks import checked_files
from bearingdyn.writing import write_whole

# what zipfile and NumPy raise for damage, which depends on where it is
UNREADABLE = (
    ValueError, OSError, EOFError, zipfile.BadZipFile, zlib.error, lzma.LZMAError, NotImplementedError,
    RuntimeError, TypeError, KeyError, struct.error, OverflowError, SyntaxError, tokenize.TokenError,
    MemoryError,
)  # fmt: skip

USED = re.compile(r"[KM](_(data|indices|indptr|shape))?|points|labels|internal")
# a dense matrix of zeros packs by 1000; small ones are let through, for large ones this is a trap or a waste
MOST_PACKED, SMALL = 100, 200_000_000


def _arrays(path: Path) -> dict[str, Any]:
    """Arrays of the archive by name, each as large as its own header says, the others left where they are."""
    try:
        with zipfile.ZipFile(path) as archive:
            found = {}
            for entry in archive.infolist():
                name = entry.filename.removesuffix(".npy")
                if not USED.fullmatch(name):
                    continue
                if entry.flag_bits & 1:
                    raise ValueError(f"{name} is encrypted; write the archive without a password")
                if entry.file_size > max(SMALL, MOST_PACKED * entry.compress_size):
                    raise ValueError(
                        f"{name} unpacks from {entry.compress_size} to {entry.file_size} bytes; "
                        "write K and M in compressed rows"
                    )
                with archive.open(entry) as stream:
                    found[name] = _one(name, stream, entry.file_size)
            if not found:
                raise ValueError(f"it holds {archive.namelist()[:10]}, nothing of K and M")
            return found
    except UNREADABLE as error:
        raise ValueError(f"{path} cannot be read as a NumPy archive (.npz): {error}") from None


def _one(name: str, stream: IO[bytes], size: int) -> Any:
    version = np.lib.format.read_magic(stream)
    if version not in ((1, 0), (2, 0)):
        raise ValueError(f"{name} is of NumPy's format {version}; 1.0 and 2.0 are read")
    read = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    shape, fortran, dtype = read(stream)
    if dtype.kind not in "biufc":
        raise ValueError(f"{name} holds {dtype}, not numbers")
    data = stream.read(size)
    if math.prod(shape) * dtype.itemsize != len(data):
        raise ValueError(f"{name} has {len(data)} bytes, which are not the shape {shape} of its header")
    flat = np.frombuffer(data, dtype).copy()
    return flat.reshape(shape[::-1]).T if fortran else flat.reshape(shape)


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
        for part in (indices, indptr, shape):
            if part.dtype.kind not in "iu":
                raise TypeError(f"indices, indptr and shape must be whole numbers, and one is {part.dtype}")
        n, m = (int(i) for i in shape.ravel())
        if len(indptr) != n + 1:  # before memory is taken for what the shape says
            raise ValueError(f"shape says {n} rows, and indptr has {len(indptr)} numbers, not {n + 1}")
        # SciPy checks what it has cast, where 2**63 is less than 0, and then reads anywhere
        if data.ndim != 1 or indices.shape != data.shape or indptr.ndim != 1:
            raise ValueError(f"data and indices have shapes {data.shape} and {indices.shape}; give (k,) each")
        if indptr[0] != 0 or indptr[-1] != len(indices) or not np.all(indptr[1:] >= indptr[:-1]):
            raise ValueError(f"indptr must rise from 0 to the number of entries, {len(indices)}")
        if len(indices) and not (indices.min() >= 0 and indices.max() < m):
            raise ValueError(f"indices must lie in 0...{m - 1}")
        A = scipy.sparse.csr_matrix((data, indices, indptr), shape=(n, m))
        A.check_format(full_check=True)
    except (ValueError, TypeError) as error:
        raise ValueError(f"{path} holds no compressed rows in {', '.join(parts)}: {error}") from error
    return A


def read_npz(path: str | Path, points: Points | None = None, **check: Any) -> FEMatrices:
    """Read a NumPy archive (.npz) with K and M, and perhaps points, labels and internal.

    K and M are each dense, or in compressed sparse rows: four arrays K_data, K_indices, K_indptr, K_shape.
    Pickled objects are not read.

    Parameters
    ----------
    path
        Path of the archive.
    points
        Positions of the nodes, as in check_matrices; None: those of the archive.
    **check
        Further arguments of check_matrices.

    Returns
    -------
    FEMatrices

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        For a file that is not such an archive, or where check_matrices does.
    """
    p = existing(path)
    arrays = _arrays(p)
    if "labels" in arrays:
        check.setdefault("labels", arrays["labels"])
    if "internal" in arrays:
        if arrays["internal"].size != 1:
            raise ValueError(f"{p} has internal of shape {arrays['internal'].shape}; it must be one number")
        check.setdefault("internal", arrays["internal"].item())
    points = arrays.get("points") if points is None else points
    return checked_files([p], _from_arrays(arrays, "K", p), _from_arrays(arrays, "M", p), points, **check)


def write_npz(path: str | Path, model: FEMatrices) -> None:
    """Write a finite element model to a NumPy archive (.npz), in compressed sparse rows and SI units.

    Parameters
    ----------
    path
        Of the archive; read_npz reads it.
    model
        The model.
    """
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
    made = io.BytesIO()
    np.savez(made, **arrays)
    place = os.fspath(path)
    write_whole(place if place.endswith(".npz") else place + ".npz", made.getbuffer())
