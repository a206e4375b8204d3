"""Figures: each function draws one, into the axes it is given or a figure of its own, and returns the axes.

Amplitudes are zero-to-peak. Colours can be told apart by colour-blind readers (Okabe and Ito). The style
holds inside a call and leaves matplotlib's own settings alone. Where a figure has two panels, the axes given
are halved and the upper ones returned; ``ax.figure`` is the whole.
"""

from bearingdyn.plot.bearing import bearing_spectrum, bearing_stiffness, film, load_distribution
from bearingdyn.plot.material import isotherms, layer_stiffness, master, shifts
from bearingdyn.plot.modes import campbell, mode_shape
from bearingdyn.plot.motion import ball_loads, frequency_response, orbit, spectrum, unbalance_response
from bearingdyn.plot.orders import order_spectrum, orders
from bearingdyn.plot.spectra import causality, cole_cole, spectrum_of, van_gurp_palmen
from bearingdyn.plot.surfaces import mode_geometry, mode_scene
from bearingdyn.plot.traces import time
from bearingdyn.plot.trade_off import trade_off
from bearingdyn.plot.waterfall import waterfall

__all__ = [
    "ball_loads",
    "bearing_spectrum",
    "bearing_stiffness",
    "campbell",
    "causality",
    "cole_cole",
    "film",
    "frequency_response",
    "isotherms",
    "layer_stiffness",
    "load_distribution",
    "master",
    "mode_geometry",
    "mode_scene",
    "mode_shape",
    "orbit",
    "order_spectrum",
    "orders",
    "shifts",
    "spectrum",
    "spectrum_of",
    "time",
    "trade_off",
    "unbalance_response",
    "van_gurp_palmen",
    "waterfall",
]
