"""An application: parts joined at rigid interfaces, bearings hung between them, loads applied."""

from bearingdyn.application.builder import Application
from bearingdyn.application.notes import (
    COMPONENTS,
    GRAVITY,
    GROUND,
    Bush,
    Connection,
    HungBearing,
    HungFit,
    Load,
    Part,
    Support,
)

__all__ = [
    "COMPONENTS",
    "GRAVITY",
    "GROUND",
    "Application",
    "Bush",
    "Connection",
    "HungBearing",
    "HungFit",
    "Load",
    "Part",
    "Support",
]
