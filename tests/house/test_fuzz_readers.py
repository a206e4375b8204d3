"""Damaged files: read, or refused by name; see tests/fuzz_readers.py for the rule."""

from __future__ import annotations

import importlib.util

import pytest

from damaged.measurements import XLS
from fuzz_readers import READERS, fuzz

pytest.importorskip("resource")
NEEDED = {"op4": "pyyeti", "xlsx": "openpyxl", "xls": "xlrd", "mesh_vtk": "meshio", "mesh_vtu": "meshio"}


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("count", [200, pytest.param(10_000, marks=pytest.mark.slow)])
def test_a_damaged_file_is_read_or_refused_by_name(reader: str, count: int) -> None:
    package = NEEDED.get(reader)
    if package is not None and importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} is not installed")
    if reader == "xls" and not XLS.exists():
        pytest.skip(f"{XLS} is not here")
    assert fuzz(reader, count) == []
