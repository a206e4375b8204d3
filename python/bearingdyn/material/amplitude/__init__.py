"""Softening with amplitude (the Payne effect): its law, the report of its fit, and what the law leaves."""

from bearingdyn.material.amplitude.law import Payne, Softening
from bearingdyn.material.amplitude.report import PayneFit
from bearingdyn.material.amplitude.rest import Rest, held_at, rest_of

__all__ = ["Payne", "PayneFit", "Rest", "Softening", "held_at", "rest_of"]
