"""An application as plain arrays: what the C core and the analyses take."""

from bearingdyn.system.arrays import (
    BearingTerm,
    LayerTerm,
    LoadTerm,
    Modulus,
    PartTerm,
    SpringTerm,
    System,
    factor,
    natural,
)
from bearingdyn.system.assembly import assemble

__all__ = [
    "BearingTerm",
    "LayerTerm",
    "LoadTerm",
    "Modulus",
    "PartTerm",
    "SpringTerm",
    "System",
    "assemble",
    "factor",
    "natural",
]
