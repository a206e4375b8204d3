"""The style holds inside a call and touches nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

# three cells, and how many figures the stand-in of Jupyter's backend showed
SCRIPT = """
import sys
import numpy as np
from bearingdyn import plot
from bearingdyn.material import Maxwell

rubber = Maxwell(G0=1e6, G=[2e6, 1e6], tau=[1e-3, 1e-1], K=2e9, density=1100.0)
assert "inline_like" not in sys.modules, "the backend has to be loaded by the first figure"
for cell in range(3):
    plot.spectrum_of({"rubber": rubber})
import inline_like
print(len(inline_like.shown))
"""


def test_a_notebook_shows_every_figure_not_only_the_first() -> None:
    environment = os.environ | {
        "MPLBACKEND": "module://inline_like",
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]),
    }
    run = subprocess.run(
        [sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip() == "3"
