"""Steady motions: the balance of harmonics, their stability, and how they change with speed."""

from bearingdyn.analysis.steady.speed_map import parameter_map, speed_map
from bearingdyn.analysis.steady.steady_state import steady_state

__all__ = ["parameter_map", "speed_map", "steady_state"]
