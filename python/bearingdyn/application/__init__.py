"""An application: parts joined at rigid interfaces, bearings hung between them, loads applied."""

from bearingdyn.application.application import Application
from bearingdyn.application.applied_loads import AppliedLoads
from bearingdyn.application.channel import COMPONENTS, GROUND, QUANTITIES, RATES, Channel
from bearingdyn.application.free_motions import arm
from bearingdyn.application.joints import BearingJoint, Bush, Connection, LooseJoint, Support
from bearingdyn.application.loads import (
    ConstantLoad,
    CoreLoad,
    DirectedLoad,
    HarmonicLoad,
    Load,
    SampledLoad,
    Unbalance,
)
from bearingdyn.application.part import Part
from bearingdyn.application.place import GRAVITY, Place
from bearingdyn.application.plan import Plan
from bearingdyn.application.summary import loose_motions

__all__ = [
    "COMPONENTS",
    "GRAVITY",
    "GROUND",
    "QUANTITIES",
    "RATES",
    "Application",
    "AppliedLoads",
    "BearingJoint",
    "Bush",
    "Channel",
    "Connection",
    "ConstantLoad",
    "CoreLoad",
    "DirectedLoad",
    "HarmonicLoad",
    "Load",
    "LooseJoint",
    "Part",
    "Place",
    "Plan",
    "SampledLoad",
    "Support",
    "Unbalance",
    "arm",
    "loose_motions",
]
