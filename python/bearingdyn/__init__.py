"""Dynamics of rotors on ball bearings with viscoelastic layers, from measured rubber to a running motor.

SI units everywhere; z along the shaft, y vertical; interfaces in the order (x, y, z, θx, θy, θz).
"""

from bearingdyn.analysis import (
    Equilibrium,
    equilibrium,
    frequency_response,
    modes,
    orbit,
    spectrum,
    transient,
    transients,
)
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, ConstantDamping, LoadDamping, Pit, TabulatedDamping, Waviness
from bearingdyn.cms import Superelement
from bearingdyn.core import Interrupted, Scheme, SolverError
from bearingdyn.material import (
    STEEL,
    DMAData,
    Elastic,
    FractionalZener,
    MasterCurve,
    Maxwell,
    PowerLaw,
    TabulatedModulus,
    fit_maxwell,
    master_curve,
    read_dma,
    sample_dma_path,
)
from bearingdyn.parts import (
    Cylinder,
    Disc,
    EndFace,
    Feet,
    Housing,
    Layer,
    Region,
    Revolved,
    RigidBody,
    Ring,
    Section,
    Shaft,
    damping_sample,
)
from bearingdyn.results import load, save

__all__ = [
    "STEEL",
    "Application",
    "BallBearing",
    "ConstantDamping",
    "Cylinder",
    "DMAData",
    "Disc",
    "Elastic",
    "EndFace",
    "Equilibrium",
    "Feet",
    "FractionalZener",
    "Housing",
    "Interrupted",
    "Layer",
    "LoadDamping",
    "MasterCurve",
    "Maxwell",
    "Pit",
    "PowerLaw",
    "Region",
    "Revolved",
    "RigidBody",
    "Ring",
    "Scheme",
    "Section",
    "Shaft",
    "SolverError",
    "Superelement",
    "TabulatedDamping",
    "TabulatedModulus",
    "Waviness",
    "damping_sample",
    "equilibrium",
    "fit_maxwell",
    "frequency_response",
    "load",
    "master_curve",
    "modes",
    "orbit",
    "read_dma",
    "sample_dma_path",
    "save",
    "spectrum",
    "transient",
    "transients",
]
