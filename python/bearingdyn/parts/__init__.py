"""Parts: everything an application is made of, each a frozen dataclass with `superelement()`."""

from bearingdyn.fem.beam import Section
from bearingdyn.parts.housing import Feet, Housing
from bearingdyn.parts.imported import Imported, NodeSet, at_radius
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.revolved import Revolved, RevolvedModes
from bearingdyn.parts.rigid_body import RigidBody
from bearingdyn.parts.ring import Ring, damping_sample
from bearingdyn.parts.section import Cylinder, EndFace, Region, ViscoelasticSolid
from bearingdyn.parts.shaft import Disc, Shaft
from bearingdyn.parts.solid import RigidSurface, Solid

__all__ = [
    "Cylinder",
    "Disc",
    "EndFace",
    "Feet",
    "Housing",
    "Imported",
    "Layer",
    "NodeSet",
    "Region",
    "Revolved",
    "RevolvedModes",
    "RigidBody",
    "RigidSurface",
    "Ring",
    "Section",
    "Shaft",
    "Solid",
    "ViscoelasticSolid",
    "at_radius",
    "damping_sample",
]
