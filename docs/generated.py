"""What the pages show and a build makes: the picture of the rooms, and the first hour as it runs."""

from __future__ import annotations

import contextlib
import io
import runpy
import shutil
import tempfile
from pathlib import Path

import architecture

HERE = Path(__file__).parent
STATIC = HERE / "_static"


def make() -> None:
    """Write _static/architecture.svg, _static/first_hour.png and what the script printed."""
    import matplotlib

    matplotlib.use("Agg")
    STATIC.mkdir(exist_ok=True)
    architecture.draw(STATIC / "architecture.svg")
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            runpy.run_path(str(HERE.parent / "examples" / "first_hour.py"))
        shutil.copy(Path("out", "first_hour.png"), STATIC)
    (STATIC / "first_hour.txt").write_text(printed.getvalue(), encoding="utf-8")
