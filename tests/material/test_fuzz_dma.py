"""The DMA reader against mutants: only ValueError or OSError that names file and line, and soon."""

from __future__ import annotations

import warnings

import pytest

from bearingdyn.material import read_dma
from fuzz_dma import fuzz_dma, seeds


def test_seeds_are_good_files(tmp_path):
    """Every seed is read as it stands, or the mutants would be refused at the first line."""
    for ending, content in seeds():
        path = tmp_path / f"seed{ending}"
        path.write_bytes(content)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert read_dma(path, mode="shear" if b"tan" not in content else None).frequency.size >= 5


def test_mutants_quick(tmp_path):
    """The first 200."""
    assert fuzz_dma(tmp_path, 200) == []


@pytest.mark.slow
def test_mutants(tmp_path):
    """Ten thousand others."""
    assert fuzz_dma(tmp_path, 10_000, seed=1) == []
