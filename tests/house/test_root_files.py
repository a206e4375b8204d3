"""What may stand in the project's root: a file that some run left there, and that was committed, is not."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = {
    ".clang-format", ".gitattributes", ".gitignore", ".pre-commit-config.yaml", "CHANGELOG.md",
    "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "Makefile", "README.md", "SECURITY.md", "VERIFICATION.md",
    "llms.txt", "meson.build", "meson.options", "pyproject.toml",
}  # fmt: skip
FOLDERS = {
    ".ci", ".github", "benchmarks", "conda", "csrc", "docs", "examples", "notebooks", "python", "tests",
}  # fmt: skip
# what runs write: kept parts, results, streams, drawings of a moment, and what an editor or a crash leaves
WRITTEN = set(".arrays .nc .run .h5 .npz .npy .wav .unv .uff .log .orig .rej .tmp".split())


def tracked() -> list[Path]:
    """Files under version control, relative to the root."""
    if not (ROOT / ".git").exists() or shutil.which("git") is None:
        pytest.skip("no git tree: what is under version control is not known")
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True)
    return [Path(name) for name in done.stdout.decode().split("\0") if name]


def test_nothing_stands_in_the_root_but_what_is_listed_here() -> None:
    paths = tracked()
    assert {p.name for p in paths if len(p.parts) == 1} == FILES
    assert {p.parts[0] for p in paths if len(p.parts) > 1} == FOLDERS


def test_no_result_of_a_run_is_under_version_control() -> None:
    assert [str(p) for p in tracked() if p.suffix in WRITTEN] == []
