"""The README's ten lines run as they stand, and do what they say."""

from __future__ import annotations

import re
import tarfile
import warnings
from pathlib import Path

import numpy as np
import pytest

import make_sdist
from bearingdyn.notice import BeyondData

README = Path(__file__).resolve().parents[2] / "README.md"


def test_the_ten_lines_of_the_readme_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = README.read_text(encoding="utf-8")
    block = re.search(r"```python\n(.*?)```", text, re.DOTALL)
    assert block is not None
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error", BeyondData)
        exec(compile(block[1].replace("100_000", "4_000"), str(README), "exec"), names)
    run = names["run"]
    y = run["record"].values[:, 0]  # type: ignore[index]
    assert y.shape == (4000,)
    # the rotor hangs below its unloaded place and the passing balls move it
    assert -1e-3 < np.mean(y) < 0.0
    assert np.ptp(y) > 0.0
    assert (tmp_path / "motor.png").stat().st_size > 10_000
    assert "shaft.middle.y, spectrum" in (tmp_path / "motor.html").read_text(encoding="utf-8")


def test_your_own_machine_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = README.read_text(encoding="utf-8")
    _, block = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(compile(block, str(README), "exec"), names)
    state = names["state"]
    # the shaft hangs in two layers, one side as the other
    sides = [state.displacement(f"{side}_ring.centre")[1] for side in ("left", "right")]  # type: ignore[attr-defined]
    assert sides[0] == pytest.approx(sides[1], rel=0.05)  # the axial load tilts them a little
    assert -1e-3 < sides[0] < -1e-6
    assert "left_layer" in (tmp_path / "own.html").read_text(encoding="utf-8")


def test_the_readme_opens_with_figure_and_commands_that_exist() -> None:
    if (README.parent / "PKG-INFO").exists():
        pytest.skip("the README of a source archive has no pictures, for package indexes show none")
    text = README.read_text(encoding="utf-8")
    figure = re.search(r"!\[[^\]]+\]\(([^)]+)\)", text)
    assert figure is not None
    assert (README.parent / figure[1]).is_file()
    makefile = (README.parent / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"^make (\w+)", text, re.MULTILINE):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_the_archive_has_a_readme_without_pictures(tmp_path: Path) -> None:
    """Paths of this tree lead nowhere on a package index; the words stay as they are."""
    with tarfile.open(make_sdist.write(tmp_path)) as archive:
        (name,) = [one for one in archive.getnames() if one.count("/") == 1 and one.endswith("/README.md")]
        held = archive.extractfile(name)
        assert held is not None
        words = held.read().decode()
    assert "![" not in words
    whole = README.read_text(encoding="utf-8")
    assert words.split() == re.sub(r"^!\[.*$", "", whole, flags=re.MULTILINE).split()
