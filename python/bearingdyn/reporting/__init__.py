"""A report: one HTML page that needs nothing else, of a machine, its inputs and what was computed of it."""

from bearingdyn.reporting.report import report

__all__ = ["report"]
