"""Make the table of lubricated contacts: python -m bearingdyn.bearing.ehl.maketable table.csv

A line is written as soon as its point is solved, and what is there is not solved again: stopped, it is
started anew with the same command. Several processes may share the work: `1/4 table.csv` is one of four.
"""

from __future__ import annotations

import itertools
import sys
import time
from pathlib import Path

import numpy as np

from bearingdyn.bearing.ehl import harmonic_approach
from bearingdyn.bearing.ehl.steady_film import Figures, Steady, steady
from bearingdyn.bearing.ehl.table_lookup import OMEGA

M = (2.0, 3.7, 7.0, 14.0, 27.0, 52.0, 100.0, 192.0, 370.0, 709.0, 1360.0, 2607.0, 5000.0)
L = (0.0, 2.5, 5.0, 10.0, 15.0, 20.0)
D = (0.02, 0.037, 0.07, 0.13, 0.25, 0.5, 1.0)
ACCURACY = (0.02, 0.05)
"""What `steady` is asked for; the second where the first needs too many nodes."""
_NODES = 100_000
COLUMNS = (
    ("M", "L", "D", *Figures._fields)
    + tuple(f"error_{name}" for name in Figures._fields)
    + tuple(f"K_{x:g}" for x in OMEGA)
    + tuple(f"C_{x:g}" for x in OMEGA)
    + ("seconds",)
)


def point(M: float, L: float, D: float) -> list[float]:
    """One line of the table of lubricated contacts after its M, L, D; NaN where no grid resolves the film."""
    began = time.process_time()
    found: Steady | None = None
    for accuracy in ACCURACY:
        try:
            found = steady(M, L, D, accuracy=accuracy, nodes=_NODES)
            break
        except (ValueError, ArithmeticError) as failure:
            print(f"M={M:g} L={L:g} D={D:g}: {failure}", file=sys.stderr)
    if found is None:
        return (len(COLUMNS) - 4) * [float("nan")] + [time.process_time() - began]
    # the shape is that of the second grid: a ratio hardly depends on the pitch
    level = found.levels[-2]
    K0, C0 = level.figures.K0, level.figures.C0
    answers = [harmonic_approach.stiffness(level.equations, level.state, x) for x in OMEGA]
    K = [k.real - K0 for k in answers]
    C = [1.5 * k.imag / x / C0 for k, x in zip(answers, OMEGA, strict=True)]
    return [*found.figures, *found.error, *K, *C, time.process_time() - began]


def main(arguments: list[str]) -> int:
    """Make the table of lubricated contacts: solve the points that are missing."""
    part, parts = (int(x) for x in arguments[0].split("/")) if len(arguments) == 2 else (1, 1)
    path = Path(arguments[-1])
    if not path.exists():
        path.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    lines = path.read_text(encoding="utf-8").splitlines()[1:]
    done = {tuple(float(x) for x in line.split(",")[:3]) for line in lines}
    todo = [x for x in itertools.product(M, L, D) if x not in done]
    # the middle of the table first, what bearings need, and what costs most last
    todo.sort(key=lambda x: (x[0] > 1300 or x[1] == 0, abs(np.log(x[0] / 370)) + abs(x[1] - 10) / 5))
    for where in todo[part - 1 :: parts]:
        line = ",".join(f"{x:.7g}" for x in (*where, *point(*where)))
        with path.open("a", encoding="utf-8") as file:
            file.write(line + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
