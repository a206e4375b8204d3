"""Arrays kept in a folder between calls: a file that was cut or damaged is none, by the digest before it."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.writing import write_whole

MAGIC = b"bearingdyn arrays 1\n"
START = len(MAGIC) + 32
"""Bytes before the arrays."""


def kept(content: bytes) -> bytes:
    """Bytes of a file of kept arrays: its kind, the SHA-256 of the content, and the content, an .npz."""
    return MAGIC + hashlib.sha256(content).digest() + content


def write_arrays(path: Path, arrays: Mapping[str, Any]) -> None:
    """Keep arrays by their names, the file whole or not at all; its folder is made.

    Parameters
    ----------
    path
        The file.
    arrays
        What `np.asarray` takes, but no objects.

    Raises
    ------
    OSError
        Where it cannot be written.
    """
    held = io.BytesIO()
    np.savez(held, **arrays)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_whole(path, kept(held.getvalue()))


def read_arrays(path: Path, names: Iterable[str] | None = None) -> dict[str, Any] | None:
    """Arrays that a file has kept; None where there is none, and of one that was cut or damaged.

    Parameters
    ----------
    path
        The file.
    names
        Of arrays that it must hold; None: all that it has.

    Raises
    ------
    ValueError
        For a whole file that holds something else.
    """
    if not path.exists():
        return None
    raw = path.read_bytes()
    if raw[:START] != kept(raw[START:])[:START]:
        return None
    try:
        with np.load(io.BytesIO(raw[START:]), allow_pickle=False) as held:
            # written unpacked: what is packed may grow without end
            if any(member.compress_type != zipfile.ZIP_STORED for member in held.zip.infolist()):
                raise ValueError("its arrays are packed")
            return {name: held[name] for name in (held.files if names is None else names)}
    except Exception as error:  # NumPy's reader raises whatever the damage of a file leads to
        raise ValueError(f"{path} holds no arrays of this kind ({error}); delete it") from error
