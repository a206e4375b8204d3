"""No example and no notebook raises a warning of ours, but where it says why and takes it away itself."""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from bearingdyn import notice

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = [p for p in sorted((ROOT / "examples").glob("*.py")) if "__main__" in p.read_text("utf-8")]
SCRIPTS = [*EXAMPLES, ROOT / "examples" / "first_hour.py", *sorted((ROOT / "notebooks").glob("*.py"))]
# as Python prints it: "file.py:12: StrainedLayer: layer …"; those of worker processes, too
NAMES = [n for n, c in inspect.getmembers(notice, inspect.isclass) if issubclass(c, Warning)]
OURS = re.compile(rf": ({'|'.join(NAMES)}): .*")


def run(script: Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """A script by itself, with every warning of ours shown each time."""
    at = ROOT / "notebooks" if script.parent.name == "notebooks" else folder
    path = os.pathsep.join([str(ROOT / "examples"), os.environ.get("PYTHONPATH", "")])
    return subprocess.run(
        [sys.executable, "-W", "always::UserWarning", str(script)],
        cwd=at,
        env={**os.environ, "PYTHONPATH": path, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_warning_would_be_seen(tmp_path: Path) -> None:
    script = tmp_path / "one.py"
    script.write_text("import bearingdyn as bd\nbd.ThermalNetwork(293.0)\n")
    assert [m[1] for m in OURS.finditer(run(script, tmp_path).stderr)] == ["UnusualMagnitude"]


@pytest.mark.slow
@pytest.mark.parametrize("script", SCRIPTS, ids=lambda p: p.stem)
def test_it_runs_without_a_warning_of_ours(script: Path, tmp_path: Path) -> None:
    done = run(script, tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    assert sorted({m[0] for m in OURS.finditer(done.stderr)}) == []
