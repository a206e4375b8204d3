"""The README's ten lines run as they stand, and do what they say."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np
import pytest

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


def test_the_readme_opens_with_figure_and_commands_that_exist() -> None:
    text = README.read_text(encoding="utf-8")
    figure = re.search(r"!\[[^\]]+\]\(([^)]+)\)", text)
    assert figure is not None
    assert (README.parent / figure[1]).is_file()
    makefile = (README.parent / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"^make (\w+)", text, re.MULTILINE):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)
