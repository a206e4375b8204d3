"""Measurements beside the project, for the tests that need one: a skip, said so, where they are absent."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from bearingdyn.material import DMAData, MasterCurve, read_dma

DATA = Path(__file__).parents[2] / "shared" / "data"


def measured(name: str) -> DMAData:
    """A measured table, or a skip."""
    path = DATA / name / "dma.csv"
    if not path.exists():
        pytest.skip(f"measured data {path} are not here")
    return read_dma(path)


def shift_table(master: MasterCurve) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Temperatures, °C, and shifts, decades."""
    return np.array(list(master.shifts)), np.array(list(master.shifts.values()))


def written(folder: Path, text: str, encoding: str = "utf-8") -> Path:
    """A file with this text in a folder."""
    path = folder / "table.csv"
    path.write_bytes(text.encode(encoding))
    return path
