"""What a material, a master curve, a fit and a reader cannot use they refuse by the argument's name."""

from __future__ import annotations

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.material import kk_ratio, suspects

DMA = bd.read_dma(bd.sample_dma_path())
SWEEP = bd.read_dma(
    np.column_stack([[1.0, 10.0, 100.0, 1e3], [20.0] * 4, [1e6, 1.2e6, 1.5e6, 2e6], [1e5, 1.5e5, 2e5, 3e5]]),
    "shear",
    units={"frequency": "Hz", "temperature": "C", "storage": "Pa", "loss": "Pa"},
)
RUBBER = {"K": 2e9, "density": 1100.0}
ALIENS = [5, "6205", [], object(), np.zeros(3), bd.STEEL, bd.Layer]
CALLS = {
    "dma": (bd.master_curve, kk_ratio, suspects),
    "law": (lambda x: bd.master_curve(DMA, law=x), lambda x: bd.Maxwell(1e6, [], [], law=x, **RUBBER)),
    "T_ref": (lambda x: bd.master_curve(DMA, T_ref=x),),
    "clean": (lambda x: bd.master_curve(DMA, clean=x),),
    "shifts": (lambda x: bd.master_curve(DMA, shifts=x),),
    "vertical": (lambda x: bd.master_curve(DMA, vertical=x),),
    "levels": (lambda x: bd.master_curve(DMA, levels=x),),
    "band": (lambda x: bd.fit_maxwell(SWEEP, n=1, band=x, **RUBBER),),
    "bounds": (lambda x: bd.fit_maxwell(SWEEP, n=1, bounds=x, **RUBBER),),
    "fixed": (lambda x: bd.fit_maxwell(SWEEP, n=1, fixed=x, **RUBBER),),
    "columns": (lambda x: bd.read_dma(bd.sample_dma_path(), columns=x),),
    "units": (lambda x: bd.read_dma(bd.sample_dma_path(), units=x),),
    "fit": (lambda x: bd.Maxwell(1e6, [], [], fit=x, **RUBBER),),
    "frequency": (lambda x: bd.TabulatedModulus(x, [1e6, 2e6], [1e5, 2e5], **RUBBER),),
    "exponent": (lambda x: bd.PowerLaw(1e6, x, 100.0, **RUBBER),),
    "alpha": (lambda x: bd.FractionalZener(1e6, 5e6, 1e-3, x, **RUBBER),),
    "a file": (bd.open_result, bd.read_nodes, bd.read_matrices),
    "a mesh": (bd.read_mesh,),
}  # fmt: skip


@pytest.mark.parametrize("key", CALLS)
@pytest.mark.parametrize("alien", ALIENS, ids=[type(x).__name__ for x in ALIENS])
def test_a_wrong_object_is_refused_by_name(key: str, alien: object) -> None:
    # what means something: nothing held, a temperature, the name of a file that is not there
    if (
        (key in ("bounds", "fixed", "columns", "units", "shifts") and isinstance(alien, list))
        or (key == "T_ref" and isinstance(alien, int))
        or (key.startswith("a ") and isinstance(alien, str))
    ):
        return
    for call in CALLS[key]:
        with pytest.raises(ValueError, match="path of a" if key.startswith("a ") else key):
            call(alien)


def test_a_fit_names_the_wrong_measurement() -> None:
    for alien in ALIENS:
        with pytest.raises(ValueError, match="master is "):
            bd.fit_maxwell(alien, n=1, **RUBBER)
