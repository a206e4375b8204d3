"""Every reader against damaged files: seeded mutants of sound ones, read in a process of their own.

The rule: a mutant is read, or refused by a ValueError or OSError that names the file, within 5 s of processor
time and 1 GB of memory beyond what the process had; and the interpreter lives.

    python tests/fuzz_readers.py            # all readers, 200 mutants each
    python tests/fuzz_readers.py npz 10000  # one reader, more mutants

A reader is added by one function that writes sound files into a folder and returns how they are read; see
READERS. `python tests/fuzz_readers.py npz 1 4711` repeats mutant 4711 and shows the traceback.
"""

from __future__ import annotations

import functools
import json
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np

from damaged import machines, matrices, measurements, meshes, results
from damaged.mutations import Reader, mutated

SECONDS, BYTES = 5.0, 1 << 30
# a refused request would come out as an OSError and pass: a reader gets more, and what it takes is counted
LIMIT = 3 << 30
SEED = 20261129

READERS: dict[str, Callable[[], Reader]] = {
    "matrix_market": matrices.matrix_market,
    "matrix_market_array": matrices.matrix_market_array,
    "abaqus_matrices": matrices.abaqus,
    "abaqus_coordinate": matrices.abaqus_coordinate,
    "calculix": matrices.calculix,
    "npz": matrices.npz,
    "op4": matrices.op4,
    "nodes": matrices.nodes,
    "netcdf": results.netcdf,
    "hdf5_of_old": results.hdf5_of_old,
    "show": results.show,
    "run": results.run,
    "store": results.store,
    "material": measurements.material,
    "dma": measurements.dma,
    "dma_kinds": measurements.dma_kinds,
    "abaqus_mesh": meshes.abaqus_mesh,
    "gmsh": meshes.gmsh,
    "mesh_inp": functools.partial(meshes.mesh, ".inp"),
    "mesh_msh": functools.partial(meshes.mesh, ".msh"),
    "mesh_bdf": functools.partial(meshes.mesh, ".bdf"),
    "mesh_unv": functools.partial(meshes.mesh, ".unv"),
    "mesh_vtk": functools.partial(meshes.mesh, ".vtk"),
    "mesh_vtu": functools.partial(meshes.mesh, ".vtu"),
    "xlsx": measurements.xlsx,
    "xls": measurements.xls,
    "kept_part": results.kept_part,
    "strain_sweep": measurements.strain_sweep,
    "model": machines.model_file,
    "ross": machines.ross,
    "wav": results.wav,
    "map_store": results.map_store,
}


class TooLongError(BaseException):
    """Beyond SECONDS; no reader may catch it."""


def _alarm(*_: object) -> None:
    raise TooLongError


def sound_files(reader: Reader, folder: Path) -> dict[str, bytes]:
    reader.write(folder)
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def mutant(reader: Reader, files: dict[str, bytes], number: int) -> tuple[str, bytes]:
    """Name and content of the damaged file of mutant `number`."""
    rng = np.random.default_rng([SEED, number])
    name = sorted(files)[int(rng.integers(0, len(files)))]
    if reader.inside is not None and number % 2:
        return name, reader.inside(files[name], lambda data: mutated(data, rng))
    return name, mutated(files[name], rng)


def trial(reader: Reader, folder: Path, files: dict[str, bytes], number: int) -> str:
    """What mutant `number` did against the rule; empty where it did nothing."""
    name, content = mutant(reader, files, number)
    (folder / name).write_bytes(content)
    before = _most_memory()
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        reader.read(folder)
        if (taken := _most_memory(False) - before) > BYTES:
            return f"{taken / 1e6:.0f} MB"
    except (ValueError, OSError) as error:
        if (taken := _most_memory(False) - before) > BYTES:
            return f"{taken / 1e6:.0f} MB for {error!s:.200}"
        if reader.names_file and not any(known in str(error) for known in files):
            return f"{type(error).__name__} names no file: {error!s:.200}"
    except TooLongError:
        return f"more than {SECONDS} s\n{traceback.format_exc(limit=-4)}"
    except BaseException as error:
        return f"{type(error).__name__}: {error!s:.200}\n{traceback.format_exc(limit=-3)}"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        (folder / name).write_bytes(files[name])
        for path in folder.iterdir():
            if path.name not in files:
                path.unlink()
    return ""


def _most_memory(anew: bool = True) -> int:
    """Most memory this process has held, bytes; `anew`: what it holds now, from where the most is counted."""
    if anew:
        Path("/proc/self/clear_refs").write_text("5")
    status = Path("/proc/self/status").read_text()
    return 1024 * int(status.split("VmHWM:")[1].split()[0])


def _end_soon() -> None:
    """Have the process ended after 4 SECONDS more of processor time: no alarm reaches what is not Python."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    _, hard = resource.getrlimit(resource.RLIMIT_CPU)
    resource.setrlimit(resource.RLIMIT_CPU, (int(used.ru_utime + used.ru_stime + 4 * SECONDS), hard))


def child(name: str, first: int, last: int) -> None:
    """Trials of a reader; a line with the number of each, and JSON after one that breaks the rule."""
    warnings.simplefilter("ignore")
    reader = READERS[name]()
    signal.signal(signal.SIGPROF, _alarm)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        files = sound_files(reader, folder)
        reader.read(folder)  # the sound one must pass, and loads what is loaded late
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + LIMIT, resource.RLIM_INFINITY))
        for number in range(first, last):
            print(number, flush=True)
            _end_soon()
            wrong = trial(reader, folder, files, number)
            if wrong:
                print(json.dumps([number, wrong]), flush=True)


def fuzz(name: str, count: int, first: int = 0) -> list[tuple[int, str]]:
    """Number and fault of each mutant of a reader that breaks the rule."""
    faults: list[tuple[int, str]] = []
    last = first + count
    while first < last:
        run = subprocess.run(
            [sys.executable, __file__, "--child", name, str(first), str(last)],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        lines = run.stdout.splitlines()
        faults += [tuple(json.loads(line)) for line in lines if line.startswith("[")]
        begun = [int(line) for line in lines if line.isdigit()]
        if run.returncode == 0:
            return faults
        if not begun:
            raise RuntimeError(f"reader {name} does not read its sound files:\n{run.stderr}")
        faults.append((begun[-1], f"the process died ({run.returncode}): {run.stderr[-500:]}"))
        first = begun[-1] + 1
    return faults


def main(argv: list[str]) -> int:
    if argv[:1] == ["--child"]:
        child(argv[1], int(argv[2]), int(argv[3]))
        return 0
    names = argv[:1] or list(READERS)
    count = int(argv[1]) if len(argv) > 1 else 200
    first = int(argv[2]) if len(argv) > 2 else 0
    broken = 0
    for name in names:
        faults = fuzz(name, count, first)
        broken += len(faults)
        print(f"{name}: {count} mutants, {len(faults)} outside the rule", flush=True)
        for number, fault in faults[:8]:
            print(f"  {number}: {fault}")
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
