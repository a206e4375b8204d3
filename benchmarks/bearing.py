"""What a bearing of five coefficients costs in C: ns per basis, force, force and tangent, and of a film.

python benchmarks/bearing.py [--json] [--cc gcc]

Compiles bearing.c with the core's own files and flags, once per instruction set as the package does, and runs
it, with 4 to 64 balls. Balls fill vector lanes by eights, whatever the instruction set.
"""

from __future__ import annotations

import argparse
import json
import platform
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FLAGS = ["-std=c11", "-D_POSIX_C_SOURCE=200809L", "-O3", "-ffp-contract=off", "-fno-math-errno"]
# the files that the build compiles once per instruction set
HOT = re.findall(
    r"'(\w+)\.c'",
    re.findall(r"^hot = files\((.*?)\)", (ROOT / "csrc" / "meson.build").read_text(), re.M | re.S)[0],
)
SETS: list[tuple[str, str, list[str]]] = [("base", "2", [])]
if platform.machine().lower() in ("x86_64", "amd64"):
    FLAGS.append("-DBD_HAVE_X86_SETS")
    SETS += [("avx2", "4", ["-mavx2"]), ("avx512", "8", ["-mavx512f"])]
COLD = ("bearing", "grazing", "imperfection", "kernels", "maxwell")


def build(compiler: str, folder: Path) -> Path:
    """The program, compiled into a folder."""
    core, objects = ROOT / "csrc", []

    def compiled(source: Path, name: str, *extra: str) -> None:
        objects.append(str(folder / f"{name}.o"))
        subprocess.run(
            [compiler, *FLAGS, *extra, f"-I{core}", "-c", str(source), "-o", objects[-1]], check=True
        )

    for isa, width, flags in SETS:
        for name in HOT:
            compiled(core / f"{name}.c", f"{name}_{isa}", f"-DBD_ISA={isa}", f"-DBD_WIDTH={width}", *flags)
    for name in COLD:
        compiled(core / f"{name}.c", name)
    compiled(ROOT / "benchmarks" / "bearing.c", "bearing_benchmark")
    program = folder / "bearing_benchmark"
    subprocess.run([compiler, *objects, "-lm", "-o", str(program)], check=True)
    return program


def measure(compiler: str) -> list[dict[str, float | int | str]]:
    """One record per instruction set and number of balls; times in ns."""
    with tempfile.TemporaryDirectory() as folder:
        program = build(compiler, Path(folder))
        lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    records: list[dict[str, float | int | str]] = []
    for line in lines:
        isa, balls, turn, force, both, film, carried = line.split()
        records.append(
            {
                "isa": isa,
                "Z": int(balls),
                "turn_ns": float(turn),
                "force_ns": float(force),
                "force_and_tangent_ns": float(both),
                "with_film_damping_ns": float(film),
                "with_films_that_remember_ns": float(carried),
            }
        )
    return records


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON array")
    parser.add_argument("--cc", default="cc", help="C compiler")
    options = parser.parse_args()
    records = measure(options.cc)
    if options.json:
        print(json.dumps(records))
        return 0
    heads = f"{'isa':>8}{'Z':>4}{'turn':>9}{'force':>9}{'force + tangent':>18}"
    print(f"{heads}{'with a film':>14}{'that remembers, ns':>20}")
    for r in records:
        times = f"{r['turn_ns']:9.1f}{r['force_ns']:9.1f}{r['force_and_tangent_ns']:18.1f}"
        films = f"{r['with_film_damping_ns']:14.1f}{r['with_films_that_remember_ns']:20.1f}"
        print(f"{r['isa']:>8}{r['Z']:>4}{times}{films}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
