"""Materials: elastic ones, and viscoelastic ones from the measurement to the Maxwell model."""

from bearingdyn.material.dma import DMAData, group_isotherms, read_dma, sample_dma_path
from bearingdyn.material.elastic import STEEL, Elastic
from bearingdyn.material.fit import fit_maxwell
from bearingdyn.material.maxwell import FitReport, Maxwell
from bearingdyn.material.shift import WLF, Arrhenius, ShiftTable
from bearingdyn.material.tts import MasterCurve, master_curve

__all__ = [
    "STEEL",
    "WLF",
    "Arrhenius",
    "DMAData",
    "Elastic",
    "FitReport",
    "MasterCurve",
    "Maxwell",
    "ShiftTable",
    "fit_maxwell",
    "group_isotherms",
    "master_curve",
    "read_dma",
    "sample_dma_path",
]
