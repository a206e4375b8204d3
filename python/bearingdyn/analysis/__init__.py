"""Analyses: static equilibrium, modes, harmonic response, transient, spectra."""

from bearingdyn.analysis.campbell import campbell
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.harmonic import frequency_response
from bearingdyn.analysis.modes import modes
from bearingdyn.analysis.radiation import radiated_power
from bearingdyn.analysis.shares import energy_shares
from bearingdyn.analysis.spectra import orbit, spectrum
from bearingdyn.analysis.statics import BearingState
from bearingdyn.analysis.transient import transient, transients
from bearingdyn.analysis.unbalance import unbalance_response

__all__ = [
    "BearingState",
    "Equilibrium",
    "campbell",
    "energy_shares",
    "equilibrium",
    "frequency_response",
    "modes",
    "orbit",
    "radiated_power",
    "spectrum",
    "transient",
    "transients",
    "unbalance_response",
]
