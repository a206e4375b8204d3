"""Jupyter shows every picture of a notebook: executed by a kernel, its images are counted."""

from __future__ import annotations

from pathlib import Path

import pytest

NOTEBOOKS = Path(__file__).resolve().parents[2] / "notebooks"


def pictures(path: Path) -> tuple[int, int]:
    """Cells that draw, and PNG images a kernel sent back."""
    nbclient = pytest.importorskip("nbclient")
    jupytext = pytest.importorskip("jupytext")
    pytest.importorskip("ipykernel")
    notebook = jupytext.read(path)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    drawing = sum("plot." in cell.source and "axes = " in cell.source for cell in cells)
    nbclient.NotebookClient(
        notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}
    ).execute()
    images = sum("image/png" in output.get("data", {}) for cell in cells for output in cell.outputs)
    return drawing, images


@pytest.mark.slow
@pytest.mark.parametrize("path", sorted(NOTEBOOKS.glob("*.py")), ids=lambda path: path.stem)
def test_a_kernel_shows_as_many_pictures_as_cells_draw(path: Path) -> None:
    drawing, images = pictures(path)
    assert drawing > 0
    assert images == drawing
