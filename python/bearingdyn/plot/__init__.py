"""Figures: each function draws one, into the axes it is given or a figure of its own, and returns the axes.

Amplitudes are zero-to-peak. Colours can be told apart by colour-blind readers (Okabe and Ito). The style
holds inside a call and leaves matplotlib's own settings alone. Where a figure has two panels, the axes given
are halved and the upper ones returned; ``ax.figure`` is the whole.
"""

from bearingdyn.plot.ball_loads import ball_loads
from bearingdyn.plot.bearing_spectrum import bearing_spectrum
from bearingdyn.plot.bearing_stiffness import bearing_stiffness
from bearingdyn.plot.campbell import campbell
from bearingdyn.plot.contact_damping import contact_damping
from bearingdyn.plot.drawing import draw, scene
from bearingdyn.plot.film import film
from bearingdyn.plot.film_map import film_map
from bearingdyn.plot.frequency_response import frequency_response
from bearingdyn.plot.isotherms import isotherms, master, shifts
from bearingdyn.plot.layer_stiffness import layer_stiffness
from bearingdyn.plot.layer_strain import layer_strain
from bearingdyn.plot.load_distribution import load_distribution
from bearingdyn.plot.measurement_checks import causality, cole_cole, spectrum_of, van_gurp_palmen
from bearingdyn.plot.mode_geometry import mode_geometry, mode_scene
from bearingdyn.plot.mode_shape import mode_shape
from bearingdyn.plot.notebook_html import as_html
from bearingdyn.plot.orbit import orbit
from bearingdyn.plot.orders import order_spectrum, orders
from bearingdyn.plot.ring_shape import ring_shape
from bearingdyn.plot.sound_contributions import sound_contributions
from bearingdyn.plot.sound_intensity import sound_intensity
from bearingdyn.plot.spectrum import spectrum
from bearingdyn.plot.speed_map import speed_map, speed_waterfall
from bearingdyn.plot.squeezed_section import squeezed_section
from bearingdyn.plot.squeezed_solid import squeezed_solid
from bearingdyn.plot.strain_softening import strain_softening
from bearingdyn.plot.time_traces import time
from bearingdyn.plot.trade_off import trade_off
from bearingdyn.plot.unbalance_response import unbalance_response
from bearingdyn.plot.waterfall import waterfall

__all__ = [
    "as_html",
    "ball_loads",
    "bearing_spectrum",
    "bearing_stiffness",
    "campbell",
    "causality",
    "cole_cole",
    "contact_damping",
    "draw",
    "film",
    "film_map",
    "frequency_response",
    "isotherms",
    "layer_stiffness",
    "layer_strain",
    "load_distribution",
    "master",
    "mode_geometry",
    "mode_scene",
    "mode_shape",
    "orbit",
    "order_spectrum",
    "orders",
    "ring_shape",
    "scene",
    "shifts",
    "sound_contributions",
    "sound_intensity",
    "spectrum",
    "spectrum_of",
    "speed_map",
    "speed_waterfall",
    "squeezed_section",
    "squeezed_solid",
    "strain_softening",
    "time",
    "trade_off",
    "unbalance_response",
    "van_gurp_palmen",
    "waterfall",
]
