"""Random damages of a file's bytes, and how a damaged file is read."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

# what people and broken programs write for a number
NUMBERS = [
    b"1e400", b"-1", b"0", b"nan", b"inf", b"99999999999999999999", b"9" * 400, b"2,5", b"2.0D+08", b"",
    b"\0", b"1e-400", b"0x10", b"1.5", b"1_0", b"-0", b"1e", b"2147483648", b"9223372036854775807", b"true",
    b'"a"', b"[1]", b"{}", b"null", b"\xef\xbc\x91", b"1.0-100", b"1 2", b"1;2",
]  # fmt: skip


Mutate = Callable[[bytes], bytes]


@dataclass(frozen=True)
class Reader:
    """How a damaged file is read.

    Parameters
    ----------
    write
        Writes sound files into a folder.
    read
        Reads them from there.
    inside
        Mutates what is behind a checksum or a packing: (sound file, mutation) -> file; by turns with the
        plain mutation of the bytes.
    names_file
        Whether the reader knows a file, and must name it.
    """

    write: Callable[[Path], None]
    read: Callable[[Path], Any]
    inside: Callable[[bytes, Mutate], bytes] | None = None
    names_file: bool = True


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    """One to three random damages."""
    for _ in range(int(rng.integers(1, 4))):
        data = _damaged(data, rng)
    return data


def _damaged(data: bytes, rng: np.random.Generator) -> bytes:
    n = len(data)
    if n == 0:
        return bytes(rng.integers(0, 256, int(rng.integers(0, 50)), dtype=np.uint8))
    a, b = sorted(int(i) for i in rng.integers(0, n + 1, 2))
    b = min(b, a + int(rng.integers(1, 200)))
    kind = int(rng.integers(0, 14))
    if kind == 0:
        flipped = bytearray(data)
        flipped[min(a, n - 1)] ^= 1 << int(rng.integers(0, 8))
        return bytes(flipped)
    if kind == 1:
        return data[:a] + bytes(rng.integers(0, 256, b - a, dtype=np.uint8)) + data[b:]
    if kind == 2:
        return data[:a] + data[b:]
    if kind == 3:
        return data[:b] + data[a:b] * int(rng.integers(1, 5)) + data[b:]
    if kind == 4:
        return data[:a]
    if kind == 5:
        return data[:a] + bytes(n - a)
    if kind == 6:
        return data[:a] + bytes(int(rng.integers(1, 9))) + data[b:]
    if kind in (7, 8, 9):
        return _number_changed(data, rng)
    lines = data.split(b"\n")
    i, j = (int(k) for k in rng.integers(0, len(lines), 2))
    if kind == 10:
        lines[i], lines[j] = lines[j], lines[i]
    elif kind == 11:
        del lines[i]
    elif kind == 12:
        lines.insert(j, lines[i])
    else:
        whole = int(rng.integers(0, 5))
        text = data.decode("latin-1")
        return [data.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + data, text.encode("utf-16"), data.upper(),
                data.replace(b".", b",")][whole]  # fmt: skip
    return b"\n".join(lines)


def _number_changed(data: bytes, rng: np.random.Generator) -> bytes:
    digits = np.flatnonzero(np.isin(np.frombuffer(data, np.uint8), np.frombuffer(b"0123456789", np.uint8)))
    if not digits.size:
        return data
    a = b = int(rng.choice(digits))
    part = b"0123456789.+-eEdD"
    while a > 0 and data[a - 1] in part:
        a -= 1
    while b < len(data) and data[b] in part:
        b += 1
    return data[:a] + NUMBERS[int(rng.integers(0, len(NUMBERS)))] + data[b:]


def zip_changed(data: bytes, mutate: Mutate) -> bytes:
    """A packed file one of whose members was damaged before it was packed."""
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(made, "w") as new:
        members = old.infolist()
        k = zlib.crc32(mutate(b"which")) % len(members)
        for i, member in enumerate(members):
            content = old.read(member.filename)
            new.writestr(member.filename, mutate(content) if i == k else content, member.compress_type)
    return made.getvalue()
