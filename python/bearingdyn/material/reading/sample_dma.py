"""The sample table that is shipped with the package."""

from __future__ import annotations

import importlib.resources
from pathlib import Path


def sample_dma_path() -> Path:
    """Path of the sample table that is shipped with the package.

    Its values are computed from a model, which its header states, and not measured.

    Returns
    -------
    Path
        Of a CSV: frequency, Hz, temperature, °C, storage and loss modulus in shear, Pa.
    """
    return Path(str(importlib.resources.files("bearingdyn.material") / "sample_dma.csv"))
