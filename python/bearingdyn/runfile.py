"""The file of a running march: append-only chunks, each checked and on the disk before the next begins.

    magic | header | chunk | chunk | …

A block (header or chunk) is its length and CRC-32 (two unsigned little-endian numbers of 8 and 4 bytes) and
as many bytes. The header is JSON; a chunk is rows of recorded channels and the state after them, so that the
march goes on from it bit for bit, and before both their sizes and what the core counted, by name, as JSON.
Killed at any moment, the file holds every finished chunk; a torn tail is ignored.

Files of version 1, whose counts have no names, are read, not gone on from.
"""

from __future__ import annotations

import json
import os
import struct
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.checks import existing
from bearingdyn.core import Report
from bearingdyn.types import Array

MAGIC = b"bearingdyn run 2\n"
_MAGIC_1 = b"bearingdyn run 1\n"
_BLOCK = struct.Struct("<QI")
_CHUNK = struct.Struct("<QQQ")  # rows, words of the state, bytes of the counts
_CHUNK_1 = struct.Struct("<QQQQQQQ")
# what version 1 counted, in its order
_COUNTS_1 = ("steps", "iterations", "refreshes", "refactors", "grazing")


@dataclass(frozen=True, eq=False)
class Chunk:
    """Rows (n, channels) recorded, the state after them, and the report; of that the counts are kept."""

    rows: Array
    state: Array
    report: Report

    def packed(self) -> bytes:
        """As bytes."""
        counts = json.dumps(self.report.counts).encode()
        counts += b" " * (-len(counts) % 8)  # numbers lie at multiples of their size
        front = _CHUNK.pack(len(self.rows), self.state.size, len(counts))
        return front + counts + self.rows.tobytes() + self.state.tobytes()

    @classmethod
    def unpacked(cls, data: bytes, channels: int, version: int) -> Chunk:
        """From bytes; a counter that the file does not know is 0."""
        if version == 1:
            n, words, *numbers = _CHUNK_1.unpack_from(data)
            at, counts = _CHUNK_1.size, dict(zip(_COUNTS_1, numbers, strict=True))
        else:
            n, words, length = _CHUNK.unpack_from(data)
            at = _CHUNK.size + length
            counts = json.loads(data[_CHUNK.size : at])
        rows = np.frombuffer(data, np.float64, n * channels, at).reshape(n, channels)
        state = np.frombuffer(data, np.float64, words, at + rows.nbytes)
        return cls(rows, state, Report(**counts, t=float(state[0] + state[1] * state[2])))


def report_of(chunks: Sequence[Chunk]) -> Report:
    """The report of all chunks together, one or more."""
    return sum((chunk.report for chunk in chunks[1:]), chunks[0].report)


def is_run(path: str | os.PathLike[str]) -> bool:
    """Whether a file is (the beginning of) a run file."""
    try:
        with open(path, "rb") as file:
            return _version(file.read(len(MAGIC))) > 0
    except OSError:
        return False


def _version(data: bytes) -> int:
    """Of the format of a run file, by its first bytes; 0 if it is none."""
    return 2 if data.startswith(MAGIC) else int(data.startswith(_MAGIC_1))


def read(path: str | os.PathLike[str]) -> tuple[dict[str, Any], list[Chunk], int]:
    """Header, every finished chunk, and where the last of them ends, in bytes.

    Raises
    ------
    ValueError
        If the file is none of ours or its header is damaged.
    """
    data = existing(path, "run file").read_bytes()
    version = _version(data)
    if not version:
        raise ValueError(f"{os.fspath(path)} is not a run file of bearingdyn")
    header, at = _block(data, len(MAGIC))
    if header is None:
        raise ValueError(f"{os.fspath(path)}: the header of the run is damaged; start the run anew")
    facts: dict[str, Any] = json.loads(header)
    chunks: list[Chunk] = []
    while True:
        block, after = _block(data, at)
        if block is None:
            return facts, chunks, at
        chunks.append(Chunk.unpacked(block, len(facts["channels"]), version))
        at = after


def _block(data: bytes, at: int) -> tuple[bytes | None, int]:
    """A whole and sound block at a place, and where it ends; None if there is none."""
    begin = at + _BLOCK.size
    if len(data) < begin:
        return None, at
    length, check = _BLOCK.unpack_from(data, at)
    block = data[begin : begin + length]
    if len(block) < length or zlib.crc32(block) != check:
        return None, at
    return block, begin + length


class Writer:
    """Appends to a run file; made anew, or opened behind its last finished chunk.

    Raises
    ------
    OSError
        Naming the file, where it cannot be written; what was written before stays.
    """

    def __init__(self, path: str | os.PathLike[str], header: Mapping[str, Any]) -> None:
        self.path = Path(path)
        self.chunks: list[Chunk] = []
        if is_run(path):
            with self._open("rb") as file:
                if _version(file.read(len(MAGIC))) == 1:
                    raise ValueError(
                        f"{self.path} was begun by an earlier version of bearingdyn: it can be read but not "
                        f"gone on from; give another file, or remove this one to start anew"
                    )
            known, self.chunks, end = read(path)
            if known != json.loads(json.dumps(header)):
                raise ValueError(
                    f"{self.path} holds another run; give another file, or remove this one to start anew"
                )
            self._file = self._open("r+b")
            self._file.truncate(end)
            self._file.seek(end)
        elif self.path.exists() and self.path.stat().st_size > 0:
            if not MAGIC.startswith(self.path.read_bytes()[: len(MAGIC)]):
                raise ValueError(f"{self.path} exists and is not a run file; give another file")
            self._file = self._open("wb")
            self._begin(header)
        else:
            self._file = self._open("wb")
            self._begin(header)

    def _open(self, mode: str) -> Any:
        try:
            return open(self.path, mode)
        except OSError as error:
            raise type(error)(
                error.errno, f"cannot write the run: {error.strerror}", str(self.path)
            ) from None

    def _begin(self, header: Mapping[str, Any]) -> None:
        self._file.write(MAGIC)
        self._append(json.dumps(header).encode())

    def append(self, chunk: Chunk) -> None:
        """Write a chunk and wait until it is on the disk."""
        self._append(chunk.packed())
        self.chunks.append(chunk)

    def _append(self, block: bytes) -> None:
        end = self._file.tell()
        try:
            self._file.write(_BLOCK.pack(len(block), zlib.crc32(block)) + block)
            self._file.flush()
            os.fsync(self._file.fileno())
        except OSError as error:
            self._cut(end)
            raise type(error)(
                error.errno,
                f"the run could not be written on ({error.strerror}); {len(self.chunks)} chunks are kept, "
                f"and the run can go on from them",
                str(self.path),
            ) from None

    def _cut(self, end: int) -> None:
        """Drop what was half written, as far as the disk lets us; a torn tail does no harm."""
        descriptor = os.open(self.path, os.O_RDWR)
        try:
            os.ftruncate(descriptor, end)
        except OSError:
            return
        finally:
            os.close(descriptor)

    def close(self) -> None:
        """Close the file; a flush that fails has been reported by `append`."""
        try:
            self._file.close()
        except OSError:
            return
