"""Exact derivatives of responses, modes and static states."""

from bearingdyn.analysis.gradient.gradient import Gradient, gradient

__all__ = ["Gradient", "gradient"]
