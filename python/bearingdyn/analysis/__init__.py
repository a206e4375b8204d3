"""Analyses: static equilibrium, modes, harmonic response, transient, spectra."""

from bearingdyn.analysis.campbell import campbell
from bearingdyn.analysis.contact import ball_channels, contact_statistics
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.harmonic import frequency_response
from bearingdyn.analysis.losses import dissipation
from bearingdyn.analysis.modes import modes
from bearingdyn.analysis.radiation import radiated_power
from bearingdyn.analysis.shapes import MovedSurface, mode_shapes, mode_surfaces
from bearingdyn.analysis.shares import energy_shares
from bearingdyn.analysis.spectra import orbit, spectrum
from bearingdyn.analysis.spectra_orders import order_spectrum, shaft_angle, track_orders
from bearingdyn.analysis.spectra_time import envelope_spectrum, waterfall
from bearingdyn.analysis.static_summary import static_summary
from bearingdyn.analysis.statics import BearingState
from bearingdyn.analysis.steady import steady_state
from bearingdyn.analysis.transient import transient, transients
from bearingdyn.analysis.unbalance import unbalance_response

__all__ = [
    "BearingState",
    "Equilibrium",
    "MovedSurface",
    "ball_channels",
    "campbell",
    "contact_statistics",
    "dissipation",
    "energy_shares",
    "envelope_spectrum",
    "equilibrium",
    "frequency_response",
    "mode_shapes",
    "mode_surfaces",
    "modes",
    "orbit",
    "order_spectrum",
    "radiated_power",
    "shaft_angle",
    "spectrum",
    "static_summary",
    "steady_state",
    "track_orders",
    "transient",
    "transients",
    "unbalance_response",
    "waterfall",
]
