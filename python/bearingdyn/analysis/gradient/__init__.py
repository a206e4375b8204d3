"""Exact derivatives of responses, modes, radiated power and static states."""

from bearingdyn.analysis.gradient.gradient import Gradient, gradient
from bearingdyn.analysis.gradient.power_slopes import power_slopes, power_table

__all__ = ["Gradient", "gradient", "power_slopes", "power_table"]
