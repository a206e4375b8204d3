"""Materials: elastic ones, and viscoelastic ones from the measurement to the Maxwell model."""

from bearingdyn.material.amplitude import Payne, PayneFit, held_at
from bearingdyn.material.bulk_relaxation import BulkRelaxation
from bearingdyn.material.complex_moduli import FractionalZener, PowerLaw, TabulatedModulus
from bearingdyn.material.dma import DMAData
from bearingdyn.material.doubt import Doubt
from bearingdyn.material.doubts import Doubts, doubts
from bearingdyn.material.elastic import STEEL, Elastic
from bearingdyn.material.export import to_abaqus_frequency, to_abaqus_prony, to_ansys, to_calculix
from bearingdyn.material.fit_report import FitReport, OutsideBand
from bearingdyn.material.hyperelastic import NEO_HOOKE, Hyperelastic, MooneyRivlin, NeoHooke, Yeoh
from bearingdyn.material.identification import fit_dense, fit_maxwell, fit_payne
from bearingdyn.material.isotherms import group_isotherms
from bearingdyn.material.low_end import LowEnd
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.random_numbers import normals, uniforms
from bearingdyn.material.reach_of_data import answer_of, band_told_once, warn_beyond
from bearingdyn.material.reading import (
    ReadingError,
    StrainSweep,
    read_dma,
    read_strain_sweep,
    sample_dma_path,
)
from bearingdyn.material.relaxation_data import RelaxationData
from bearingdyn.material.shift_laws import WLF, Arrhenius, Joined, RhoT, ShiftTable
from bearingdyn.material.spread import Spread
from bearingdyn.material.superposition import LIMIT as KK_LIMIT
from bearingdyn.material.superposition import (
    MasterCurve,
    Suspect,
    kk_ratio,
    master_curve,
    one_curve,
    suspects,
)
from bearingdyn.material.volume import constant_bulk, is_volume, volume_of

__all__ = [
    "KK_LIMIT",
    "NEO_HOOKE",
    "STEEL",
    "WLF",
    "Arrhenius",
    "BulkRelaxation",
    "DMAData",
    "Doubt",
    "Doubts",
    "Elastic",
    "FitReport",
    "FractionalZener",
    "Hyperelastic",
    "Joined",
    "LowEnd",
    "MasterCurve",
    "Maxwell",
    "MooneyRivlin",
    "NeoHooke",
    "OutsideBand",
    "Payne",
    "PayneFit",
    "PowerLaw",
    "ReadingError",
    "RelaxationData",
    "RhoT",
    "ShiftTable",
    "Spread",
    "StrainSweep",
    "Suspect",
    "TabulatedModulus",
    "Yeoh",
    "answer_of",
    "band_told_once",
    "constant_bulk",
    "doubts",
    "fit_dense",
    "fit_maxwell",
    "fit_payne",
    "group_isotherms",
    "held_at",
    "is_volume",
    "kk_ratio",
    "master_curve",
    "normals",
    "one_curve",
    "read_dma",
    "read_strain_sweep",
    "sample_dma_path",
    "suspects",
    "to_abaqus_frequency",
    "to_abaqus_prony",
    "to_ansys",
    "to_calculix",
    "uniforms",
    "volume_of",
    "warn_beyond",
]
