"""An application as plain arrays: what the C core and the analyses take."""

from bearingdyn.system.assembly import assemble
from bearingdyn.system.layer_static_modulus import Modulus, warn_at_rest
from bearingdyn.system.matrix_factor import factor
from bearingdyn.system.natural_modes import natural
from bearingdyn.system.system import System
from bearingdyn.system.system_of import system_of
from bearingdyn.system.terms import BearingTerm, Contacts, LayerTerm, LoadTerm, PartTerm, SpringTerm

__all__ = [
    "BearingTerm",
    "Contacts",
    "LayerTerm",
    "LoadTerm",
    "Modulus",
    "PartTerm",
    "SpringTerm",
    "System",
    "assemble",
    "factor",
    "natural",
    "system_of",
    "warn_at_rest",
]
