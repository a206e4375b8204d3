"""Sliders for a machine: response and sag drawn anew while layer, rubber and preload are turned."""

from bearingdyn.explorer.exploration import View
from bearingdyn.explorer.explorer import Explorer
from bearingdyn.explorer.server import address, served
from bearingdyn.explorer.sliders import Slider

__all__ = ["Explorer", "Slider", "View", "address", "served"]
