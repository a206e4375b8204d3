"""Every class of warning says when it is raised and what helps, and is raised in a test."""

from __future__ import annotations

import ast
import inspect
import re
import sys
from pathlib import Path

import pytest

import bearingdyn
from bearingdyn import notice

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(bearingdyn.__file__).parent
CLASSES = {
    name: each
    for name, each in inspect.getmembers(notice, inspect.isclass)
    if issubclass(each, notice.Notice) and each is not notice.Notice
}


@pytest.mark.parametrize("name", CLASSES)
def test_a_warning_says_when_and_what_helps(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    import generated

    what, when, remedy = generated.told(CLASSES[name])
    assert what.endswith(".")
    assert when.endswith(".")
    assert remedy.endswith(".")
    row = next(line for line in generated.warnings_table().splitlines() if f"`{name}`" in line)
    assert what in row
    sys.modules.pop("generated", None)


@pytest.mark.parametrize("name", CLASSES)
def test_a_warning_is_raised_in_a_test(name: str) -> None:
    """By its name, in a `pytest.warns` or a record of warnings."""
    used = re.compile(rf"(warns\(\s*|category[^\n]*)(\w+\.)*{name}\b")
    files = (ROOT / "tests").rglob("test_*.py")
    assert any(used.search(path.read_text(encoding="utf-8")) for path in files)


def test_no_warning_is_without_a_class_and_none_stands_elsewhere() -> None:
    for path in PACKAGE.rglob("*.py"):
        if path.name == "notice.py":
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                called = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
                if called == "warn":
                    assert len(node.args) == 2, f"{path}, line {node.lineno}: warn(text, class)"
            if isinstance(node, ast.ClassDef):
                bases = {getattr(b, "id", getattr(b, "attr", "")) for b in node.bases}
                assert not any(b.endswith("Warning") or b == "Notice" for b in bases), f"{path}: {node.name}"


def test_the_old_places_of_the_classes_still_serve() -> None:
    from bearingdyn.bearing import BearingWarning
    from bearingdyn.material.fit_report import OutsideBand

    assert BearingWarning is notice.BearingWarning
    assert OutsideBand is notice.OutsideBand


def test_a_fit_that_cannot_follow_and_a_law_that_extrapolates_say_so() -> None:
    dma = bearingdyn.read_dma(bearingdyn.sample_dma_path())
    with pytest.warns(notice.OutsideIsotherms, match="T_ref is 70 °C, outside the measured"):
        bearingdyn.master_curve(dma, T_ref=70.0)
    master = bearingdyn.master_curve(dma)
    # the rubbery plateau lies above 1 MPa: a model held to 1 kPa there misses it by more than any tolerance
    with pytest.warns(notice.CoarseModel, match="no number of branches up to"):
        bearingdyn.fit_maxwell(
            master, "auto", K=2e9, density=1100.0, band=(1e-2, 1e2), bounds={"G0": (1e3, 1.1e3)}
        )
