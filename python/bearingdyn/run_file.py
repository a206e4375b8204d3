"""The file of a running march: append-only chunks, each checked and on the disk before the next begins.

    magic | header | chunk | chunk | …

A block (header or chunk) is its length and CRC-32 (two unsigned little-endian numbers of 8 and 4 bytes) and
as many bytes. The CRC is of the block's place in the file, its length (8 bytes each) and its bytes: neither
zeros, as a power cut leaves them, nor a block that was moved pass for one. The header is JSON; a chunk is
rows of recorded channels and the state after them, so that the march goes on from it bit for bit, and before
both their sizes and what the core counted, by name, as JSON, with the largest ball load of each bearing, N
(`peaks`). Killed at any moment, the file holds every finished chunk; a torn tail is ignored.

One march at a time writes a file: it holds the system's lock (flock) on it, which ends with the process.

Files of version 2, whose CRC is of the bytes alone, are read and gone on from; files of version 1, whose
counts have no names, are read, not gone on from.
"""

from __future__ import annotations

import errno
import json
import math
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
from bearingdyn.writing import check_target

MAGIC = b"bearingdyn run 3\n"
_MAGICS = {3: MAGIC, 2: b"bearingdyn run 2\n", 1: b"bearingdyn run 1\n"}
_BLOCK = struct.Struct("<QI")
_PLACE = struct.Struct("<QQ")  # where a block begins, and its length
_CHUNK = struct.Struct("<QQQ")  # rows, words of the state, bytes of the counts
_CHUNK_1 = struct.Struct("<QQQQQQQ")
# what version 1 counted, in its order
_COUNTS_1 = ("steps", "iterations", "refreshes", "refactors", "grazing")
HEAD, TAIL = 29, 16  # bytes at both ends of the file that must still be there when it is written on
_LARGEST = 2**53  # of a count of steps: beyond, doubles no longer tell one from the next


@dataclass(frozen=True, eq=False)
class Chunk:
    """A chunk of a run file: rows (n, channels) recorded, the state after them, and the report's counts."""

    rows: Array
    state: Array
    report: Report

    def packed(self) -> bytes:
        """As bytes."""
        counted = {**self.report.counts, "peaks": list(self.report.peaks)}
        counts = json.dumps(counted).encode()
        counts += b" " * (-len(counts) % 8)  # numbers lie at multiples of their size
        front = _CHUNK.pack(len(self.rows), self.state.size, len(counts))
        return front + counts + self.rows.tobytes() + self.state.tobytes()

    @classmethod
    def unpacked(cls, data: bytes, channels: int, version: int) -> Chunk:
        """From bytes; a counter that the file does not know is 0.

        Raises
        ------
        ValueError
            For bytes that do not make a chunk of so many channels.
        """
        front = _CHUNK_1 if version == 1 else _CHUNK
        if len(data) < front.size:
            raise ValueError(f"it has {len(data)} bytes, fewer than the sizes at its beginning")
        n, words, *numbers = front.unpack_from(data)
        at = front.size
        if version > 1:
            at += numbers[0]
        if words < 3 or len(data) != at + 8 * (n * channels + words):
            raise ValueError(
                f"{n} rows of {channels} channels and {words} words of state do not fill {len(data)} bytes"
            )
        if version == 1:
            counts: Any = dict(zip(_COUNTS_1, numbers, strict=True))
        else:
            counts = _json(data[front.size : at])
        known = Report().counts
        # files written before peaks were kept have none
        peaks = counts.pop("peaks", []) if isinstance(counts, dict) else []
        if not (
            isinstance(peaks, list) and all(type(p) in (int, float) and 0 <= p < math.inf for p in peaks)
        ):
            raise ValueError(f"its peaks are {peaks!r:.200}; they must be the largest ball loads, N")
        if not isinstance(counts, dict) or not counts.keys() <= known.keys():
            raise ValueError(f"it counts {counts!r:.200}; known are {sorted(known)}")
        if not all(type(c) is int and 0 <= c <= _LARGEST for c in counts.values()):
            raise ValueError(f"it counts {counts!r:.200}; each must be a whole number of steps or so")
        rows = np.frombuffer(data, np.float64, n * channels, at).reshape(n, channels)
        state = np.frombuffer(data, np.float64, words, at + rows.nbytes)
        origin, count, dt = state[:3].tolist()
        t = origin + count * dt
        if not (math.isfinite(t) and 0 <= count <= _LARGEST):
            raise ValueError(f"its state begins with {[origin, count, dt]}, which cannot be a time")
        return cls(rows, state, Report(**counts, t=t, peaks=tuple(map(float, peaks))))


def report_of(chunks: Sequence[Chunk]) -> Report:
    """All chunks of a run file together, one or more, as one report of the march."""
    return sum((chunk.report for chunk in chunks[1:]), chunks[0].report)


def is_run(path: str | os.PathLike[str]) -> bool:
    """Whether a file is (the beginning of) a run file."""
    try:
        if not os.path.isfile(path):
            return False
        with open(path, "rb") as file:
            return _version(file.read(len(MAGIC))) > 0
    except OSError:
        return False


def _version(data: bytes) -> int:
    """Of the format of a run file, by its first bytes; 0 if it is none."""
    return next((version for version, magic in _MAGICS.items() if data.startswith(magic)), 0)


def read(path: str | os.PathLike[str]) -> tuple[dict[str, Any], list[Chunk], int]:
    """Read a run file: header, every finished chunk, and where the last of them ends, in bytes.

    Raises
    ------
    ValueError
        If the file is none of ours, its header is damaged, or a block passes its checksum and yet holds no
        run.
    """
    return _parsed(existing(path, "run file").read_bytes(), path)


def _parsed(data: bytes, path: str | os.PathLike[str]) -> tuple[dict[str, Any], list[Chunk], int]:
    version = _version(data)
    if not version:
        raise ValueError(f"{os.fspath(path)} is not a run file of bearingdyn")
    header, at = _block(data, len(MAGIC), version)
    if header is None:
        raise ValueError(f"{os.fspath(path)}: the header of the run is damaged; start the run anew")
    try:
        facts = _facts(_json(header))
    except ValueError as error:
        raise ValueError(f"{os.fspath(path)} does not have the header of a run: {error}") from None
    chunks: list[Chunk] = []
    while True:
        block, after = _block(data, at, version)
        if block is None:
            return facts, chunks, at
        try:
            chunks.append(Chunk.unpacked(block, len(facts["channels"]), version))
        except ValueError as error:
            which = f"{os.fspath(path)}: chunk {len(chunks)}"
            raise ValueError(f"{which} does not belong to a run: {error}") from None
        if chunks[-1].state.size != chunks[0].state.size:
            raise ValueError(f"{os.fspath(path)}: chunk {len(chunks) - 1} has a state of another size")
        at = after


def _json(text: bytes) -> Any:
    """What JSON says; ValueError for anything that is not JSON, however deep or long."""
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("its JSON is nested too deeply") from None


def _facts(header: Any) -> dict[str, Any]:
    """The header, if it holds what `March.facts` gives."""

    def number(value: Any, least: float, whole: bool = False) -> bool:
        kinds = (int,) if whole else (int, float)
        return type(value) in kinds and least <= value <= (_LARGEST if whole else 1e300)

    def texts(value: Any) -> bool:
        return isinstance(value, list) and all(isinstance(part, str) for part in value)

    def course(value: Any) -> bool:
        lists = isinstance(value, list) and len(value) == 2 and all(isinstance(part, list) for part in value)
        return (
            lists
            and len(value[0]) == len(value[1]) > 0
            and all(number(part, -1e300) for part in (*value[0], *value[1]))
        )

    if not isinstance(header, dict):
        raise ValueError(f"it is {header!r:.80}")
    for name, good in (
        ("channels", texts(header.get("channels"))),
        ("units", texts(header.get("units"))),
        ("speed", course(header.get("speed"))),
        ("dt", number(header.get("dt"), 0.0)),
        ("decimate", number(header.get("decimate"), 1, whole=True)),
        ("settle", number(header.get("settle"), 0, whole=True)),
        ("steps", number(header.get("steps"), 0, whole=True)),
        ("inputs", isinstance(header.get("inputs", ""), str)),
        ("system_hash", isinstance(header.get("system_hash", ""), str)),
    ):
        if not good:
            raise ValueError(f"{name} is {header.get(name)!r:.80}")
    if len(header["channels"]) != len(header["units"]):
        raise ValueError(f"{len(header['channels'])} channels have {len(header['units'])} units")
    header["dt"] = float(header["dt"])  # a whole number of any length is JSON too
    return header


def _check(block: bytes, at: int, version: int) -> int:
    """CRC of a block that begins at a place in the file."""
    return zlib.crc32(block, zlib.crc32(_PLACE.pack(at, len(block)))) if version > 2 else zlib.crc32(block)


def _block(data: bytes, at: int, version: int) -> tuple[bytes | None, int]:
    """A whole and sound block at a place, and where it ends; None if there is none."""
    begin = at + _BLOCK.size
    if len(data) < begin:
        return None, at
    length, check = _BLOCK.unpack_from(data, at)
    block = data[begin : begin + length]
    # no block is empty; eight zeros and the CRC of nothing, 0, would be one in versions 1 and 2
    if length == 0 or len(block) < length or _check(block, at, version) != check:
        return None, at
    return block, begin + length


def _torn_header(data: bytes) -> bool:
    """Whether a file ends, but for zeros, within its header: then no chunk was ever behind it."""
    at = len(MAGIC) + _BLOCK.size
    return len(data) < at or len(data.rstrip(b"\0")) < at + _BLOCK.unpack_from(data, len(MAGIC))[0]


class Writer:
    """Writer of a run file: made anew, or opened behind its last finished chunk.

    Raises
    ------
    ValueError
        For a file that holds something else.
    OSError
        Naming the file, where it cannot be written, another march writes it, or it was removed, replaced or
        cut meanwhile; what was written before stays.
    """

    def __init__(self, path: str | os.PathLike[str], header: Mapping[str, Any]) -> None:
        self.path = Path(path)
        self.chunks: list[Chunk] = []
        self._file = self._opened()
        try:
            self._begin(json.dumps(header).encode())
        except BaseException:
            self._file.close()
            raise

    def _opened(self) -> Any:
        """The file, made where missing, with the lock on it."""
        try:
            check_target(self.path)
            descriptor = os.open(self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666)
        except OSError as error:
            raise _error(error.errno, f"cannot write the run: {error.strerror}", self.path) from None
        file = os.fdopen(descriptor, "r+b", buffering=0)
        try:
            _lock(descriptor)
        except BlockingIOError:
            file.close()
            raise _error(
                errno.EAGAIN, "another march writes this run now; wait for its end, or give another file",
                self.path,
            ) from None  # fmt: skip
        return file

    def _begin(self, header: bytes) -> None:
        data = self._file.read()
        self._version = _version(data) or 3
        if _version(data) == 1:
            raise ValueError(
                f"{self.path} was begun by an earlier version of bearingdyn: it can be read but not "
                f"gone on from; give another file, or remove this one to start anew"
            )
        if _version(data) and not _torn_header(data):
            known, self.chunks, self._end = _parsed(data, self.path)
            if known != json.loads(header):
                raise ValueError(
                    f"{self.path} holds another run; give another file, or remove this one to start anew"
                )
            self._file.truncate(self._end)
            self._head, self._tail = data[:HEAD], data[: self._end][-TAIL:]
            return
        # a beginning that never reached the disk whole leaves a piece of it, or zeros
        begun = data.rstrip(b"\0")
        ours = MAGIC.startswith(begun) or (_version(data) > 0 and _torn_header(data))
        if not ours:
            raise ValueError(f"{self.path} exists and is not a run file; give another file")
        self._file.truncate(0)
        self._version, self._end, self._head, self._tail = 3, 0, b"", b""
        self._put(MAGIC + self._blocked(header, len(MAGIC)))

    def append(self, chunk: Chunk) -> None:
        """Write a chunk and wait until it is on the disk."""
        self._put(self._blocked(chunk.packed(), self._end))
        self.chunks.append(chunk)

    def _blocked(self, block: bytes, at: int) -> bytes:
        return _BLOCK.pack(len(block), _check(block, at, self._version)) + block

    def _put(self, data: bytes) -> None:
        """Write behind the end, and wait until it is on the disk."""
        self._check_untouched()
        try:
            self._file.seek(self._end)
            left = memoryview(data)
            while left:
                left = left[self._file.write(left) :]
            os.fsync(self._file.fileno())
        except OSError as error:
            self._cut()
            raise _error(
                error.errno,
                f"the run could not be written on ({error.strerror}); {len(self.chunks)} chunks are kept, "
                f"and the run can go on from them",
                self.path,
            ) from None
        self._end += len(data)
        self._head, self._tail = self._head or data[:HEAD], data[-TAIL:]
        self._check_untouched()

    def _check_untouched(self) -> None:
        """The file is the one that was opened, and as long as it was made."""
        own = os.fstat(self._file.fileno())
        try:
            there = os.stat(self.path)
            gone = "" if os.path.samestat(own, there) else "replaced by another"
        except FileNotFoundError:
            gone = "removed"
        if gone:
            raise _error(
                errno.ENOENT,
                f"the run's file was {gone} while the march wrote it, and what it held with it; "
                f"march again, with a file that nothing else touches",
                self.path,
            )
        self._file.seek(0)
        same = self._file.read(len(self._head)) == self._head
        self._file.seek(self._end - len(self._tail))
        same = same and self._file.read(len(self._tail)) == self._tail
        if own.st_size != self._end or not same:
            raise _error(
                errno.EIO,
                f"the run's file was changed while the march wrote it: {self._end} bytes were in it, now "
                f"there are {own.st_size}; march again, and it goes on from the chunks that are left",
                self.path,
            )

    def _cut(self) -> None:
        """Drop what was half written, as far as the disk lets us; a torn tail does no harm."""
        try:
            self._file.truncate(self._end)
        except OSError:
            return

    def close(self) -> None:
        """Close the file, and with it the lock."""
        try:
            self._file.close()
        except OSError:
            return


def _error(number: int | None, text: str, path: Path) -> OSError:
    return OSError(number or errno.EIO, text, str(path))


def _lock(descriptor: int) -> None:
    """Take the lock of an open file; BlockingIOError where another has it.

    The system drops it when the file is closed or the process ends, however it ends. Where the system or the
    file system has no such lock, nothing is locked.
    """
    try:
        import fcntl
    except ImportError:
        return
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise
    except OSError:
        return
