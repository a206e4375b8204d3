"""The documentation: its snippets run and print what stands beside them, and it builds without a warning."""

from __future__ import annotations

import contextlib
import io
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path
from urllib.parse import unquote

import matplotlib
import pytest

from bearingdyn.notice import BeyondData

matplotlib.use("Agg")

ROOT = Path(__file__).resolve().parents[2]
GUIDE = [
    *sorted((ROOT / "docs" / "guide").glob("*.md")),
    *(ROOT / "docs" / f"{name}.md" for name in ("gallery", "from_ross", "from_fe")),
]
BLOCK = re.compile(r"^```(python|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def test_there_is_a_guide_for_every_room() -> None:
    assert {page.stem for page in GUIDE} >= {"material", "bearing", "parts", "application", "results"}


@pytest.mark.parametrize("page", GUIDE, ids=lambda page: page.stem)
def test_the_snippets_of_the_guide_run_and_print_what_stands_beside_them(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The python blocks of a page run in order, as one script; a text block is what the one before prints."""
    import matplotlib.pyplot as plt

    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": page.stem}
    text = page.read_text(encoding="utf-8")
    blocks = [(m[1], m[2], text.count("\n", 0, m.start()) + 1) for m in BLOCK.finditer(text)]
    assert any(kind == "python" for kind, _, _ in blocks)
    printed = ""
    for kind, body, line in blocks:
        if kind == "text":
            assert printed == body, f"{page.name}, line {line}: printed\n{printed}"
            continue
        with contextlib.redirect_stdout(io.StringIO()) as out, warnings.catch_warnings():
            warnings.simplefilter("error", BeyondData)
            exec(compile("\n" * line + body, str(page), "exec"), names)
        printed = out.getvalue()
    plt.close("all")


@pytest.mark.slow
def test_the_documentation_builds_without_a_warning(tmp_path: Path) -> None:
    for package in ("sphinx", "myst_nb", "furo", "latex2mathml"):
        pytest.importorskip(package, reason=f"{package} is not installed; pip install bearingdyn[docs]")
    # what the notebooks show is tested by test_notebooks; here they are only rendered
    path = os.pathsep.join(map(os.path.abspath, sys.path))
    options = ["-W", "--keep-going", "-n", "-D", "nb_execution_mode=off", "-d", tmp_path / "doctrees"]
    build = subprocess.run(
        [sys.executable, "-m", "sphinx", *options, ROOT / "docs", tmp_path / "html"],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": path},
        check=False,
    )
    assert build.returncode == 0, build.stderr[-4000:]
    index = (tmp_path / "html" / "index.html").read_text(encoding="utf-8")
    assert "master_curve(dma" in re.sub(r"<[^>]+>", "", index)  # the ten lines
    assert (tmp_path / "html" / "api" / "material.html").stat().st_size > 50_000
    assert (tmp_path / "html" / "notebooks" / "03_motor.html").is_file()
    assert "<math" in (tmp_path / "html" / "theory.html").read_text(encoding="utf-8")
    assert not loaded_from_elsewhere(tmp_path / "html")
    assert not dead_links(tmp_path / "html")


def loaded_from_elsewhere(pages: Path) -> list[str]:
    """What the pages would fetch from a network: scripts, styles and pictures."""
    found = []
    for page in pages.rglob("*.html"):
        tags = re.findall(r"<(?:script|img|link|source|audio)\b[^>]*>", page.read_text(encoding="utf-8"))
        found += [tag for tag in tags if re.search(r'(?:src|href)="(?:https?:)?//', tag)]
    return found


def dead_links(pages: Path) -> list[str]:
    """Links from page to page whose file or heading is not there."""
    known: dict[Path, set[str]] = {}
    dead = []
    for page in pages.rglob("*.html"):
        for link in re.findall(r'(?:href|src)="([^"]+)"', page.read_text(encoding="utf-8")):
            if re.match(r"[a-z]+:", link):
                continue
            file, _, mark = link.partition("#")
            target = (page.parent / unquote(file.partition("?")[0])).resolve() if file else page.resolve()
            if target.suffix == ".html" and target.is_file() and target not in known:
                known[target] = set(re.findall(r'\bid="([^"]+)"', target.read_text(encoding="utf-8")))
            if not target.exists() or (mark and unquote(mark) not in known.get(target, set())):
                dead.append(f"{page.name}: {link}")
    return dead
