"""Every recipe of the cookbook runs by itself; what is said to assistants names what exists."""

from __future__ import annotations

import re
import tomllib
import warnings
from pathlib import Path

import matplotlib
import pytest

import bearingdyn as bd
from bearingdyn.notice import Notice

matplotlib.use("Agg")
ROOT = Path(__file__).resolve().parents[2]
COOKBOOK = (ROOT / "docs" / "cookbook.md").read_text(encoding="utf-8")
RECIPES = re.findall(
    r"^## ([^\n]+)\n(?:(?!^## ).)*?^```python\n(.*?)^```$", COOKBOOK, re.DOTALL | re.MULTILINE
)
LLMS = (ROOT / "llms.txt").read_text(encoding="utf-8")


def test_there_are_recipes() -> None:
    assert len(RECIPES) == COOKBOOK.count("```python") >= 13


@pytest.mark.parametrize(("title", "code"), RECIPES, ids=[title for title, _ in RECIPES])
def test_a_recipe_runs_by_itself_and_without_a_warning(
    title: str, code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import matplotlib.pyplot as plt

    if "pandas" in code:
        pytest.importorskip("pandas")
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", Notice)
        exec(compile(code, title, "exec"), {"__name__": "recipe"})
    plt.close("all")


@pytest.mark.parametrize("text", [LLMS, COOKBOOK], ids=["llms.txt", "cookbook"])
def test_names_and_files_that_are_told_exist(text: str) -> None:
    for path in re.findall(r"\bbd((?:\.[A-Za-z_]\w*)+)", text):
        thing: object = bd
        for name in path[1:].split("."):
            assert hasattr(thing, name), f"bd{path}"
            thing = getattr(thing, name)
    for link in re.findall(r"\]\(([^)]+)\)", text):
        if not link.startswith("http"):
            assert (ROOT / link).exists() or (ROOT / "docs" / link).exists(), link


def test_the_warnings_that_the_cookbook_names_exist() -> None:
    from bearingdyn import notice

    for name in re.findall(r"^\| `(\w+)` \|", COOKBOOK, re.MULTILINE):
        assert issubclass(getattr(notice, name), Notice)


def test_the_conda_recipe_asks_for_what_the_project_does() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    recipe = (ROOT / "conda" / "meta.yaml").read_text(encoding="utf-8")
    run = re.findall(r"^    - (.+)$", recipe.partition("  run:\n")[2].partition("\ntest:")[0], re.MULTILINE)
    wanted = {one.replace("matplotlib-base", "matplotlib").replace(" ", "") for one in run} - {"python"}
    assert wanted == {one.replace(" ", "") for one in project["project"]["dependencies"]}
    host = re.findall(r"^    - (.+)$", recipe.partition("  host:\n")[2].partition("  run:")[0], re.MULTILINE)
    built = {one.replace(" ", "") for one in host} - {"python", "pip"}
    assert built == {one.replace(" ", "") for one in project["build-system"]["requires"]}
    version = re.search(r"version: '([^']+)'", (ROOT / "meson.build").read_text(encoding="utf-8"))
    assert version is not None
    assert f'version = "{version[1]}"' in recipe
