"""Writes the source archive without git: python tests/make_sdist.py FOLDER.

Meson's own `dist` asks for a git or hg checkout, and a source archive has none. This one holds what a
checkout holds, with the metadata that PEP 643 asks for.
"""

from __future__ import annotations

import gzip
import io
import re
import sys
import tarfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HELD = (
    "CHANGELOG.md", "CITATION.cff", "CONTRIBUTING.md", "LICENSE", "Makefile", "README.md", "SECURITY.md",
    "VERIFICATION.md", "meson.build", "meson.options", "pyproject.toml",
    "benchmarks", "csrc", "docs", "examples", "notebooks", "python", "tests",
)  # fmt: skip
PICTURE = re.compile(rb"^!\[[^\n]*\n\n?", re.MULTILINE)
LEFT_OUT = re.compile(r"(^|/)(__pycache__|_static|\.[^/]+|[^/]+\.(pyc|so|pyd|o))(/|$)")


def write(folder: Path) -> Path:
    """Write the archive to a folder: the same bytes for the same files."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    version = re.search(r"version: '([^']+)'", (ROOT / "meson.build").read_text(encoding="utf-8"))
    assert version is not None
    name = f"bearingdyn-{version[1]}"
    lines = ["Metadata-Version: 2.2", "Name: bearingdyn", f"Version: {version[1]}"]
    lines += [f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {one}" for one in project["dependencies"]]
    target = folder / f"{name}.tar.gz"
    files = [path for top in HELD for path in _files(ROOT / top)]
    held = io.BytesIO()
    with tarfile.open(fileobj=held, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for path in sorted(files):
            inside = path.relative_to(ROOT).as_posix()
            # a package index shows no pictures by paths of this tree
            data = PICTURE.sub(b"", path.read_bytes()) if inside == "README.md" else path.read_bytes()
            _add(archive, f"{name}/{inside}", data)
        _add(archive, f"{name}/PKG-INFO", ("\n".join(lines) + "\n").encode())
    with target.open("wb") as raw, gzip.GzipFile(fileobj=raw, mode="wb", filename="", mtime=0) as packed:
        packed.write(held.getvalue())
    return target


def _files(top: Path) -> list[Path]:
    found = [top] if top.is_file() else [p for p in top.rglob("*") if p.is_file()]
    return [p for p in found if not LEFT_OUT.search(p.relative_to(ROOT).as_posix())]


def _add(archive: tarfile.TarFile, name: str, data: bytes) -> None:
    entry = tarfile.TarInfo(name)
    entry.size, entry.mode, entry.mtime = len(data), 0o644, 0
    archive.addfile(entry, io.BytesIO(data))


if __name__ == "__main__":
    print(write(Path(sys.argv[1])))
