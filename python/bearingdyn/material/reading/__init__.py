"""Measurements read: from a file, a frame or an array to :class:`DMAData`.

A file passes through once: `source` makes numbered rows of it, `block` finds the headers among them,
`columns` and `units` say what their columns mean, `table` reads the numbers, `read` makes DMAData of them.
"""

from bearingdyn.material.reading.errors import HeaderError, ReadingError
from bearingdyn.material.reading.read_dma import read_dma
from bearingdyn.material.reading.sample_dma import sample_dma_path
from bearingdyn.material.reading.strain_sweep import StrainSweep, read_strain_sweep

__all__ = [
    "HeaderError",
    "ReadingError",
    "StrainSweep",
    "read_dma",
    "read_strain_sweep",
    "sample_dma_path",
]
