"""The seal at the end of a saved result: a digest of the file, so that a damaged one is refused, not read.

HDF5 finds some damage itself, and reads other damage as numbers: a flipped bit, a stretch of zeros. The
digest stands behind what HDF5 takes for the end of its file, where other programs do not look; one that
writes into the file cuts the seal off, and leaves a file like any other.
"""

from __future__ import annotations

import hashlib
import os

MARK = b"\nbearingdyn sha256\n"
LENGTH = len(MARK) + 32
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
# place of the end-of-file address by the superblock's version (HDF5 file format specification, II.A)
_END_AT = {0: 40, 1: 44, 2: 28, 3: 28}


def seal(content: bytes | memoryview) -> bytes:
    """What is written behind the content of a result file."""
    return MARK + hashlib.sha256(content).digest()


def check_seal(path: str | os.PathLike[str]) -> None:
    """Check that a result file is as it was saved; one without a seal passes.

    Raises
    ------
    ValueError
        Where the seal is another than the content's, or is damaged itself.
    OSError
        Where the file cannot be read.
    """
    with open(path, "rb") as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(64)
        file.seek(max(size - LENGTH, 0))
        told = file.read(LENGTH)
        # a file without a seal ends where its head says; one whose mark is damaged does not
        if not told.startswith(MARK) and _end(head) in (0, size):
            return
        file.seek(0)
        digest, left = hashlib.sha256(), size - LENGTH
        while left > 0 and (part := file.read(min(left, 1 << 20))):
            digest.update(part)
            left -= len(part)
    if told != MARK + digest.digest():
        raise ValueError(
            f"{os.fspath(path)} cannot be read as a result: its content is not what was saved, the file was "
            f"damaged or cut since; use a copy, or compute it again"
        )


def _end(head: bytes) -> int:
    """Where HDF5's content ends, as the beginning of the file says; 0 where it says nothing."""
    if not head.startswith(_SIGNATURE) or len(head) < 52:
        return 0
    at = _END_AT.get(head[8], 0)
    return int.from_bytes(head[at : at + 8], "little") if at else 0
