"""Make the table of lubricated contacts: python -m bearingdyn.bearing.ehl.maketable table.csv

A line is written as soon as its point is solved, and what is there is not solved again: stopped, it is
started anew with the same command. Several processes may share the work: `1/4 table.csv` is one of four.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from bearingdyn.bearing.ehl import harmonic_approach
from bearingdyn.bearing.ehl.figures import Figures
from bearingdyn.bearing.ehl.steady_film import Steady, steady
from bearingdyn.bearing.ehl.table_lookup import OMEGA
from bearingdyn.bearing.ehl.table_nodes import HIGHEST, D, L, loads, place

ACCURACY = (0.02, 0.05, 0.1)
"""What `steady` is asked for; the next where one needs too many nodes."""
_NODES = (70_000, 70_000, 300_000)
# C0 jumps by a per cent where the rupture passes a node: about the turn, up to this place of the load axis, a
# round contact, which is cheap, takes the mean of grids of these shares of the accuracy.
_ROUGH, _OTHERS = 0.45, (0.93, 0.86)
COLUMNS = (
    ("M", "L", "D", *Figures._fields)
    + tuple(f"error_{name}" for name in Figures._fields)
    + tuple(f"K_{x:g}" for x in OMEGA)
    + tuple(f"C_{x:g}" for x in OMEGA)
    + ("seconds",)
)


def point(M: float, L: float, D: float) -> list[float]:
    """Make one line of the table of contacts; NaN where no grid of a bearable size resolves the film."""
    began = time.process_time()
    found: list[Steady] = []
    for accuracy, nodes in zip(ACCURACY, _NODES, strict=True):
        try:
            found = [steady(M, L, D, accuracy=accuracy, nodes=nodes)]
            if D > 0.5 and place(np.log(M), np.log(D)) < _ROUGH:
                found += [steady(M, L, D, accuracy=share * accuracy, nodes=2 * nodes) for share in _OTHERS]
            break
        except (ValueError, ArithmeticError) as failure:
            print(f"M={M:g} L={L:g} D={D:g}: {failure}", file=sys.stderr, flush=True)
    if not found:
        return (len(COLUMNS) - 4) * [float("nan")] + [time.process_time() - began]
    # the shape is that of the second grid: a ratio hardly depends on the pitch
    level = found[0].levels[-2]
    K0, C0 = level.figures.K0, level.figures.C0
    answers = [harmonic_approach.stiffness(level.equations, level.state, x) for x in OMEGA]
    K = [k.real - K0 for k in answers]
    C = [1.5 * k.imag / x / C0 for k, x in zip(answers, OMEGA, strict=True)]
    figures = np.array([s.figures for s in found])
    errors = np.array([s.error for s in found]).max(axis=0)
    # where there are several grids, their scatter is an error too
    spread = np.ptp(figures, axis=0) / figures.mean(axis=0) / 2
    return [
        *figures.mean(axis=0),
        *np.maximum(errors, spread),
        *K,
        *C,
        time.process_time() - began,
    ]


def main(arguments: list[str]) -> int:
    """Make the table of contacts: solve the points that are missing."""
    part, parts = (int(x) for x in arguments[0].split("/")) if len(arguments) == 2 else (1, 1)
    path = Path(arguments[-1])
    if not path.exists():
        path.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    lines = [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()[1:]]
    done = {(float(M), float(L), float(D)) for M, L, D, *_ in lines}
    todo = [at for ratio in D for M in loads(ratio) for oil in L if (at := (M, oil, ratio)) not in done]
    # what costs most last, and of the others what bearings need most first
    todo.sort(key=lambda at: (at[1] == 0, at[0] == HIGHEST, abs(at[1] - 10), -at[2]))
    for where in todo[part - 1 :: parts]:
        line = ",".join(f"{v:.7g}" for v in (*where, *point(*where)))
        with path.open("a", encoding="utf-8") as file:
            file.write(line + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
