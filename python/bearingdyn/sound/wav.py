"""Sound files: a pressure in Pa as a .wav with its calibration in it."""

from __future__ import annotations

import math
import os
import re
import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import existing, items, number, one_of, positive, require
from bearingdyn.notice import ClippedSound, warn
from bearingdyn.plausible_ranges import plausible
from bearingdyn.sound.signal_check import signal
from bearingdyn.types import Array
from bearingdyn.writing import check_target, write_whole

FLOAT, PCM = 3, 1  # WAVE_FORMAT_IEEE_FLOAT and WAVE_FORMAT_PCM
FULL = 32767.0


def write_wav(
    path: str | os.PathLike[str],
    pressure: ArrayLike | Sequence[ArrayLike],
    rate: float,
    *,
    bits: int = 32,
    full_scale: float | None = None,
    pause: float = 0.5,
) -> float:
    """Write a sound pressure as a .wav that can be listened to and measured.

    The file's comment (chunk LIST INFO ICMT) says what pressure the value 1.0 stands for, so that `read_wav`
    gives Pa again.

    Parameters
    ----------
    path
        The file; an old one is replaced.
    pressure
        Samples (n,), Pa; or several signals, one after the other: before and after at one calibration.
    rate
        Samples a second, a whole number.
    bits
        32: floats, in Pa themselves unless `full_scale` is given; 16: whole numbers.
    full_scale
        Pressure, Pa, that is the value 1.0; None: 1 Pa for floats, and for 16 bits the largest pressure.
    pause
        Between several signals, s.

    Returns
    -------
    float
        The full scale, Pa.

    Raises
    ------
    ValueError
        For a rate that is no whole number, a signal of one sample, and other bits.

    Warns
    -----
    ClippedSound
        Where 16 bits cannot hold a pressure above `full_scale`.

    References
    ----------
    Multimedia Programming Interface and Data Specifications 1.0, IBM and Microsoft 1991 (RIFF WAVE).
    """
    one_of("bits", bits, (16, 32))
    rate = positive("rate", rate, "it must be samples a second, a whole number")
    require(rate % 1 == 0 and rate < 2**31, "rate", rate, "it must be samples a second, a whole number")
    plausible("sample rate", "rate", rate)
    pause = number("pause", pause, "it must be seconds of zero or more")
    require(pause >= 0, "pause", pause, "it must be seconds of zero or more")
    given = items("pressure", pressure, "it must be samples (n,), Pa, or a list of such signals")
    several = len(given) > 0 and np.ndim(given[0]) == 1
    parts = [signal("pressure", one) for one in (given if several else [given])]
    silence = np.zeros(round(pause * rate))
    joined = parts[0]
    for one in parts[1:]:
        joined = np.concatenate([joined, silence, one])
    largest = float(np.abs(joined).max())
    if full_scale is None:
        full_scale = (largest or 1.0) if bits == 16 else 1.0
    full_scale = positive("full_scale", full_scale, "it must be a pressure in Pa")
    if bits == 16:
        if largest > full_scale * (1 + 1e-12):
            over = int(np.count_nonzero(np.abs(joined) > full_scale))
            warn(
                f"{over} of {joined.size} samples exceed the full scale of {full_scale:.4g} Pa, the largest "
                f"{largest:.4g} Pa, and are clipped; give full_scale={largest:.4g}, or bits=32",
                ClippedSound,
            )
        data = np.round(np.clip(joined / full_scale, -1.0, 1.0) * FULL).astype("<i2").tobytes()
    else:
        data = (joined / full_scale).astype("<f4").tobytes()
    check_target(path)
    write_whole(path, _riff(data, int(rate), bits, full_scale))
    return full_scale


def _chunk(name: bytes, data: bytes) -> bytes:
    return name + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def _riff(data: bytes, rate: int, bits: int, full_scale: float) -> bytes:
    size = bits // 8
    form = struct.pack("<HHIIHH", PCM if bits == 16 else FLOAT, 1, rate, rate * size, size, bits)
    text = f"full scale 1.0 = {full_scale:.9e} Pa\0".encode("ascii")
    info = _chunk(b"LIST", b"INFO" + _chunk(b"ICMT", text))
    fact = _chunk(b"fact", struct.pack("<I", len(data) // size)) if bits == 32 else b""
    body = b"WAVE" + _chunk(b"fmt ", form) + fact + info + _chunk(b"data", data)
    return b"RIFF" + struct.pack("<I", len(body)) + body


def read_wav(path: str | os.PathLike[str]) -> tuple[Array, int]:
    """Read a .wav that `write_wav` wrote: the pressure and its rate.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    tuple
        Pressure (n,), Pa, and samples a second.

    Raises
    ------
    ValueError
        For a file that is no such .wav, was cut, or holds no calibration.
    """
    raw = existing(path, ".wav").read_bytes()
    chunks: dict[bytes, bytes] = {}
    at = 12
    if raw[:4] == b"RIFF" and raw[8:12] == b"WAVE":
        while at + 8 <= len(raw):
            (size,) = struct.unpack_from("<I", raw, at + 4)
            chunks[raw[at : at + 4]] = raw[at + 8 : at + 8 + size]
            at += 8 + size + size % 2
    if at != len(raw) or not {b"fmt ", b"data"} <= chunks.keys():
        raise ValueError(f"{path} is no whole .wav file; write it by bd.write_wav")
    if len(chunks[b"fmt "]) < 16:
        raise ValueError(f"{path} is no whole .wav file: it does not say its form; write it by bd.write_wav")
    form, channels, rate, _, _, bits = struct.unpack_from("<HHIIHH", chunks[b"fmt "])
    text = chunks.get(b"LIST", b"").decode("latin-1")
    if "full scale 1.0 = " not in text or (form, bits) not in ((PCM, 16), (FLOAT, 32)) or channels != 1:
        raise ValueError(f"{path} holds no calibration; write it by bd.write_wav")
    scale = re.match(r"[0-9.]+(e[+-]?[0-9]{1,3})?(?= Pa)", text.split("full scale 1.0 = ")[1])
    full_scale = float(scale[0]) if scale and scale[0].count(".") < 2 else 0.0
    if not (0.0 < full_scale < math.inf) or len(chunks[b"data"]) % (bits // 8):
        raise ValueError(f"{path} holds no calibration, or no whole samples; write it by bd.write_wav")
    kind, divisor = ("<i2", FULL) if bits == 16 else ("<f4", 1.0)
    return np.frombuffer(chunks[b"data"], kind).astype(np.float64) / divisor * full_scale, int(rate)
