"""Softening with amplitude (the Payne effect): its law, the strain sweep it comes from, and what is left."""

from bearingdyn.material.amplitude.fit import PayneFit, fit_payne
from bearingdyn.material.amplitude.law import Payne, Softening
from bearingdyn.material.amplitude.sweep import StrainSweep, read_strain_sweep

__all__ = ["Payne", "PayneFit", "Softening", "StrainSweep", "fit_payne", "read_strain_sweep"]
