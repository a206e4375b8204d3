"""Steady motions: the balance of harmonics, their stability, and how they change with speed."""

from bearingdyn.analysis.steady.steady_state import steady_state

__all__ = ["steady_state"]
