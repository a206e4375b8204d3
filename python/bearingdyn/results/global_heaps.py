"""The global heaps of an HDF5 file, walked before HDF5 does.

A heap is a row of objects, each with its own length (HDF5 file format specification, III.E). HDF5 2.0
follows the lengths it finds: where one has been damaged it may stand still at a place and never return.
"""

from __future__ import annotations

import os
from typing import BinaryIO

_SIGNATURE = b"GCOL\x01\x00\x00\x00"
_PART = 1 << 22
_HEAD = 16  # of a heap, and of each object in it: 8 bytes, then its length


def check_global_heaps(path: str | os.PathLike[str]) -> None:
    """Check that each global heap of a file is filled by its objects, one behind the other.

    Raises
    ------
    ValueError
        Where an object reaches beyond its heap, or a heap beyond the file.
    OSError
        Where the file cannot be read.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        for begin in _heaps(file):
            file.seek(begin + 8)
            told = int.from_bytes(file.read(8), "little")
            file.seek(begin)
            if told > size or not _filled(file.read(told), told):
                raise ValueError(
                    f"{os.fspath(path)} cannot be read as a result: the lengths in its heap of texts and "
                    f"references at byte {begin} do not fit into it, the file is damaged; use a copy, or "
                    f"compute it again"
                )


def _heaps(file: BinaryIO) -> list[int]:
    """Where the heaps of a file begin."""
    found: list[int] = []
    begin, kept = 0, b""
    while part := file.read(_PART):
        # a signature may lie across two parts
        block, at = kept + part, -1
        while (at := block.find(_SIGNATURE, at + 1)) >= 0:
            found.append(begin - len(kept) + at)
        begin += len(part)
        kept = block[-len(_SIGNATURE) + 1 :]
    return found


def _filled(heap: bytes, told: int) -> bool:
    """Whether a heap of the length it tells is filled by its objects."""
    at = _HEAD
    while at + _HEAD <= len(heap):
        index, length = heap[at : at + 2], int.from_bytes(heap[at + 8 : at + 16], "little")
        # object 0 is the free space, and counts its head; another is padded to 8 bytes
        step = length if index == b"\0\0" else _HEAD + (length + 7) // 8 * 8
        if step < _HEAD:
            return False
        at += step
    return len(heap) == told >= _HEAD and at <= len(heap)
