"""Damaged files: read, or refused by name; see tests/fuzz_readers.py for the rule."""

from __future__ import annotations

import importlib.util

import pytest

from fuzz_readers import READERS, fuzz

pytest.importorskip("resource")


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("count", [200, pytest.param(10_000, marks=pytest.mark.slow)])
def test_a_damaged_file_is_read_or_refused_by_name(reader: str, count: int) -> None:
    if reader == "op4" and importlib.util.find_spec("pyyeti") is None:
        pytest.skip("pyyeti is not installed")
    assert fuzz(reader, count) == []
