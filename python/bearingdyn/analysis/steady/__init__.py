"""Steady motions: the balance of harmonics, their stability, and how they change with speed."""

from bearingdyn.analysis.steady.march_start import beginning
from bearingdyn.analysis.steady.speed_map import parameter_map, speed_map
from bearingdyn.analysis.steady.steady_state import steady_state
from bearingdyn.analysis.steady.uniqueness import Approaches

__all__ = ["Approaches", "beginning", "parameter_map", "speed_map", "steady_state"]
