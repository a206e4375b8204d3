"""Finite static deformation of rubber, and the small motion about it."""

from bearingdyn.fem.finite_strain.deformed import CURRENT, SEPARABLE, Deformed
from bearingdyn.fem.finite_strain.point import Point
from bearingdyn.fem.finite_strain.revolved import RevolvedElements, RevolvedState
from bearingdyn.fem.finite_strain.solids import SolidElements, SolidState
from bearingdyn.fem.finite_strain.static import Balance, NoBalance, Wall, balance

__all__ = [
    "CURRENT",
    "SEPARABLE",
    "Balance",
    "Deformed",
    "NoBalance",
    "Point",
    "RevolvedElements",
    "RevolvedState",
    "SolidElements",
    "SolidState",
    "Wall",
    "balance",
]
