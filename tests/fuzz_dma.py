"""Mutants of DMA files for the reader: whatever stands in a file, data or an error that says where.

`fuzz_dma(folder, count)` is what a common fuzz harness registers: seeded, it writes and reads `count`
mutants and returns what broke the rule. The rule: only ValueError or OSError, naming the file and a line, in
less than 5 s and 1 GB each.
"""

from __future__ import annotations

import io
import random
import resource
import time
import warnings
from collections.abc import Callable
from pathlib import Path

from bearingdyn.material import read_dma

SECONDS, MEMORY = 5.0, 1e9  # a file; bytes by which the process may have grown
F = (0.1, 0.3, 1.0, 3.0, 10.0)


def _rows(form: str = "{f},{T},{s},{q}\n", point: str = ".") -> str:
    text = "".join(
        form.format(f=f, T=T, s=5e6 * f**0.1 * 0.99**T, q=1e6 * f**0.1 * 0.98**T)
        for T in (20.0, 40.0)
        for f in F
    )
    return text.replace(".", point)


def seeds() -> list[tuple[str, bytes]]:
    """Ending and content of good files, one of each kind that is understood."""
    plain = "frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa,run\n" + _rows("{f},{T},{s},{q},a\n")
    german = "Frequenz;Temperatur;Speichermodul G';Verlustmodul G''\nHz;°C;Pa;Pa\n" + _rows(
        "{f};{T};{s};{q}\n", ","
    )
    steps = "".join(
        f"[step]\nFrequency sweep - {k}\nAngular frequency\tTemperature\tStorage modulus "
        "G'\ttan(δ)\nrad/s\t°C\tMPa\t\n" + "".join(f"{f}\t{20 + k}\t{5 + f}\t0.{k}\n" for f in F)
        for k in (1, 2, 3)
    )
    compass = (
        "Project:\tx\nTemperature:\t25.0 °C\nInterval data:\tAngular "
        "Frequency\tG'\tG''\n\t[rad/s]\t[Pa]\t[Pa]\n" + "".join(f"\t{f}\t{1e6 + f}\t{1e5 + f}\n" for f in F)
    )
    relaxation = "t,G_relax,T\ns,MPa,°C\n" + "".join(f"{f},{5 - f / 9},20\n" for f in F)
    blanks = "# T = 23 °C\n f     E'     tan_delta\n [Hz]  [MPa]  []\n" + "".join(
        f" {f}   {9 + f}   0.3\n" for f in F
    )
    found = [
        (".csv", plain.encode()),
        (".csv", plain.encode("utf-8-sig")),
        (".csv", german.encode("latin-1").replace(b"\n", b"\r\n")),
        (".txt", steps.encode("utf-16")),
        (".txt", steps.encode()),
        (".csv", compass.encode("latin-1")),
        (".csv", relaxation.encode()),
        (".txt", blanks.encode()),
    ]
    try:
        import openpyxl
    except ImportError:  # an extra; text files alone then
        return found
    book, file = openpyxl.Workbook(), io.BytesIO()
    for row in plain.splitlines():
        book.active.append([float(c) if c[0].isdigit() else c for c in row.split(",")])
    book.save(file)
    return [*found, (".xlsx", file.getvalue())]


def _bytes(rng: random.Random, data: bytearray) -> None:
    for _ in range(rng.choice((1, 1, 3, 20))):
        data[rng.randrange(len(data))] = rng.randrange(256)


def _cut(rng: random.Random, data: bytearray) -> None:
    del data[rng.randrange(len(data)) :]


def _lose(rng: random.Random, data: bytearray) -> None:
    start = rng.randrange(len(data))
    del data[start : start + rng.randrange(1, 40)]


TOKENS = (
    b"nan", b"inf", b"-1", b"0", b"1e400", b"9" * 400, b"1e-320", b"", b'"', b'"""', b"\0", b"\xff\xfe",
    b"\xef\xbb\xbf",
    b",,,,", b";", b"\t", b"\n", b"\r", b"[step]\n", b"Step name\tx\n", b"f,T,G',G\"\n", b"\xe2\x80\xa8",
    b"1_000", b"1.234,5", b"1,234.5", b"Hz", b"rad/s", b"%", b"t,G\n", b"#", b"-" * 300, b"(" * 200, b"_" *
    5000, b" " * 5000,
)  # fmt: skip


def _insert(rng: random.Random, data: bytearray) -> None:
    for _ in range(rng.choice((1, 1, 4))):
        place = rng.randrange(len(data) + 1)
        data[place:place] = rng.choice(TOKENS)


def _replace(rng: random.Random, data: bytearray) -> None:
    cells = bytes(data).split(b",")
    cells[rng.randrange(len(cells))] = rng.choice(TOKENS)
    data[:] = b",".join(cells)


def _repeat(rng: random.Random, data: bytearray) -> None:
    lines = bytes(data).split(b"\n")
    k = rng.randrange(len(lines))
    data[:] = b"\n".join(lines[:k] + [lines[k]] * rng.choice((2, 3, 2000)) + lines[k + 1 :])


def _swap(rng: random.Random, data: bytearray) -> None:
    lines = bytes(data).split(b"\n")
    a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[a], lines[b] = lines[b], lines[a]
    data[:] = b"\n".join(lines)


def _long(rng: random.Random, data: bytearray) -> None:
    place = rng.randrange(len(data) + 1)
    data[place:place] = rng.choice((b"_", b" ", b"1", b"(", b",", b"'", b"[")) * rng.choice((10**3, 10**5))


MUTATIONS: tuple[Callable[[random.Random, bytearray], None], ...] = (
    _bytes, _cut, _lose, _insert, _insert, _replace, _repeat, _swap, _long,
)  # fmt: skip


def mutant(number: int, seed: int = 0) -> tuple[str, bytes]:
    """Ending and content of one mutant; the same for the same numbers."""
    rng = random.Random(f"dma {seed} {number}")
    ending, content = rng.choice(seeds())
    data = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 3))):
        if data:
            rng.choice(MUTATIONS)(rng, data)
    return ending, bytes(data)


OPTIONS = (
    {},
    {"mode": "shear", "temperature": 20.0},
    {"mode": "tension", "sort": True, "drop_invalid": True},
)


def fuzz_dma(folder: Path, count: int, seed: int = 0) -> list[str]:
    """Read `count` mutants; what broke the rule, a line each."""
    faults = []
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    for number in range(count):
        ending, content = mutant(number, seed)
        path = folder / f"mutant{ending}"
        path.write_bytes(content)
        start = time.perf_counter()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                read_dma(path, **OPTIONS[number % len(OPTIONS)])
        except (ValueError, OSError) as error:
            if not (path.name in str(error) and ("line " in str(error) or "sheet " in str(error))):
                faults.append(f"{number}: names no file and line: {error}")
        except Exception as error:
            faults.append(f"{number}: {type(error).__name__}: {error}")
        seconds = time.perf_counter() - start
        if seconds > SECONDS:
            faults.append(f"{number}: took {seconds:.1f} s")
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 - before
    if grown > MEMORY:
        faults.append(f"the process grew by {grown / 1e6:.0f} MB")
    return faults
