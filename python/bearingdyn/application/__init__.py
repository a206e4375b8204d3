"""An application: parts joined at rigid interfaces, bearings hung between them, loads applied."""

from bearingdyn.application.builder import Application
from bearingdyn.application.joints import BearingJoint, Bush, Connection, LooseJoint, Support
from bearingdyn.application.loads import ConstantLoad, CoreLoad, HarmonicLoad, Load, SampledLoad, Unbalance
from bearingdyn.application.place import COMPONENTS, GRAVITY, GROUND, QUANTITIES, RATES, Channel, Place
from bearingdyn.application.plan import Part, Plan
from bearingdyn.application.rigid import arm

__all__ = [
    "COMPONENTS",
    "GRAVITY",
    "GROUND",
    "QUANTITIES",
    "RATES",
    "Application",
    "BearingJoint",
    "Bush",
    "Channel",
    "Connection",
    "ConstantLoad",
    "CoreLoad",
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
]
