"""Analyses: static equilibrium, modes, harmonic response, transient, spectra."""

from bearingdyn.analysis.bearing_sheet import bearing_sheet, single_bearing
from bearingdyn.analysis.bearing_state import BearingState
from bearingdyn.analysis.campbell import campbell
from bearingdyn.analysis.dissipation import dissipation
from bearingdyn.analysis.energy_shares import energy_shares
from bearingdyn.analysis.envelope import envelope_spectrum
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium, state_of
from bearingdyn.analysis.equivalent_radiated_power import radiated_power
from bearingdyn.analysis.frequency_response import frequencies, frequency_response
from bearingdyn.analysis.gradient import Gradient, gradient, power_slopes, power_table
from bearingdyn.analysis.inputs_outputs import Input
from bearingdyn.analysis.linearised import Linear, linear
from bearingdyn.analysis.loaded_cage import cage_ratios, with_loaded_cages
from bearingdyn.analysis.mode_shapes import MovedSurface, mode_shapes, mode_surfaces
from bearingdyn.analysis.modes import modes
from bearingdyn.analysis.operating_point import (
    OperatingPoint,
    operating_point,
)
from bearingdyn.analysis.orbit import orbit
from bearingdyn.analysis.orders import order_spectrum, track_orders
from bearingdyn.analysis.part_velocities import part_velocities, surface_of
from bearingdyn.analysis.recorded_ball_loads import ball_channels, contact_statistics
from bearingdyn.analysis.response_band import Band, band_of
from bearingdyn.analysis.sheet_pages import sheet_html, sheet_rows, sheet_text
from bearingdyn.analysis.spectrum import spectrum
from bearingdyn.analysis.speed_profile import shaft_angle
from bearingdyn.analysis.state_space import StateSpace, state_space
from bearingdyn.analysis.static_summary import static_summary
from bearingdyn.analysis.steady import parameter_map, speed_map, steady_state
from bearingdyn.analysis.stiffness_table import export_stiffness, ross_table, stiffness_table
from bearingdyn.analysis.thermal_network import ThermalNetwork, ThermalRunaway, estimated_network
from bearingdyn.analysis.transient import transient, transients
from bearingdyn.analysis.unbalance_response import unbalance_response
from bearingdyn.analysis.waterfall import waterfall

__all__ = [
    "Band",
    "BearingState",
    "Equilibrium",
    "Gradient",
    "Input",
    "Linear",
    "MovedSurface",
    "OperatingPoint",
    "StateSpace",
    "ThermalNetwork",
    "ThermalRunaway",
    "ball_channels",
    "band_of",
    "bearing_sheet",
    "cage_ratios",
    "campbell",
    "contact_statistics",
    "dissipation",
    "energy_shares",
    "envelope_spectrum",
    "equilibrium",
    "estimated_network",
    "export_stiffness",
    "frequencies",
    "frequency_response",
    "gradient",
    "linear",
    "mode_shapes",
    "mode_surfaces",
    "modes",
    "operating_point",
    "orbit",
    "order_spectrum",
    "parameter_map",
    "part_velocities",
    "power_slopes",
    "power_table",
    "radiated_power",
    "ross_table",
    "shaft_angle",
    "sheet_html",
    "sheet_rows",
    "sheet_text",
    "single_bearing",
    "spectrum",
    "speed_map",
    "state_of",
    "state_space",
    "static_summary",
    "steady_state",
    "stiffness_table",
    "surface_of",
    "track_orders",
    "transient",
    "transients",
    "unbalance_response",
    "waterfall",
    "with_loaded_cages",
]
