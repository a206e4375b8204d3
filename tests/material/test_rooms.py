"""The rooms of material/: which may import which, and what passes their doors."""

from __future__ import annotations

import importlib
import re
from pathlib import Path

import pytest

import bearingdyn.material

FOLDER = Path(__file__).parents[2] / "python" / "bearingdyn" / "material"
FOUND = re.compile(r"^from bearingdyn\.material\.(\w+)(\.\w+)? import (.+?)$", re.MULTILINE)

# A room may import those of earlier rows, by their doors.
ORDER = (
    ("doubt", "log_parameters", "random_numbers", "relaxation_spectrum"),
    ("amplitude", "bulk_relaxation", "isotherms", "low_end", "shear_from_tension", "spread"),
    ("creep", "dma", "elastic", "fit_report", "reach_of_data", "retuning", "shift_laws"),
    ("maxwell", "relaxation_data"),
    ("reading", "superposition", "volume"),
    ("doubts", "identification"),
    ("complex_moduli", "export"),
)
ROW = {room: row for row, rooms in enumerate(ORDER) for room in rooms}
FILES = sorted(path for path in FOLDER.rglob("*.py") if path != FOLDER / "__init__.py")


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.relative_to(FOLDER).as_posix())
def test_rooms_are_entered_by_their_doors_and_in_order(path):
    """Of another room only the names its door offers; nothing from beside or above."""
    here = path.relative_to(FOLDER).parts[0].removesuffix(".py")
    for room, inner, _ in FOUND.findall(path.read_text(encoding="utf-8")):
        if room != here:
            assert not inner, f"{path.name} goes past the door of {room}"
            assert ROW[room] < ROW[here], f"{here} imports {room}"


@pytest.mark.parametrize("room", ["identification", "reading", "superposition"])
def test_doors_say_what_they_offer(room):
    """Every name is there, and what material offers of a room comes through its door."""
    door = importlib.import_module(f"bearingdyn.material.{room}")
    assert all(hasattr(door, name) for name in door.__all__)
    inside = {
        name
        for name in bearingdyn.material.__all__
        if getattr(getattr(bearingdyn.material, name), "__module__", "").startswith(door.__name__)
    }
    assert inside
    assert inside <= set(door.__all__)
