"""Materials: elastic ones, and viscoelastic ones from the measurement to the Maxwell model."""

from bearingdyn.material.dma import DMAData, group_isotherms
from bearingdyn.material.elastic import STEEL, Elastic
from bearingdyn.material.fit import fit_maxwell
from bearingdyn.material.kk import Suspect, kk_ratio, suspects
from bearingdyn.material.maxwell import FitReport, Maxwell
from bearingdyn.material.read import read_dma, sample_dma_path
from bearingdyn.material.shift import WLF, Arrhenius, Joined, RhoT, ShiftTable
from bearingdyn.material.tts import MasterCurve, master_curve

__all__ = [
    "STEEL",
    "WLF",
    "Arrhenius",
    "DMAData",
    "Elastic",
    "FitReport",
    "Joined",
    "MasterCurve",
    "Maxwell",
    "RhoT",
    "ShiftTable",
    "Suspect",
    "fit_maxwell",
    "group_isotherms",
    "kk_ratio",
    "master_curve",
    "read_dma",
    "sample_dma_path",
    "suspects",
]
