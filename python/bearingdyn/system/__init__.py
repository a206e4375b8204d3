"""An application as plain arrays: what the C core and the analyses take."""

from bearingdyn.system.arrays import (
    QUANTITIES,
    RATES,
    BearingTerm,
    LayerTerm,
    LoadTerm,
    PartTerm,
    SpringTerm,
    System,
    component_of,
    factor,
    is_rotation,
)
from bearingdyn.system.assembly import assemble

__all__ = [
    "QUANTITIES",
    "RATES",
    "BearingTerm",
    "LayerTerm",
    "LoadTerm",
    "PartTerm",
    "SpringTerm",
    "System",
    "assemble",
    "component_of",
    "factor",
    "is_rotation",
]
