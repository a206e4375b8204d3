"""Parts: everything an application is made of, each a frozen dataclass with `superelement()`."""

from bearingdyn.fem import Section, quadrilaterals
from bearingdyn.parts.bore_shape import BoreShape
from bearingdyn.parts.damping_sample import damping_sample
from bearingdyn.parts.disc import Disc
from bearingdyn.parts.flexible_bearing import FlexibleBearing
from bearingdyn.parts.flexible_bore import FlexibleBore
from bearingdyn.parts.flexible_ring import FlexibleRing
from bearingdyn.parts.housing import Feet, Housing
from bearingdyn.parts.imported import Imported
from bearingdyn.parts.layer import Layer
from bearingdyn.parts.layer_slopes import DIMENSIONS, LayerSlopes, layer_slopes
from bearingdyn.parts.node_set import NodeSet, at_radius
from bearingdyn.parts.o_ring import ORing
from bearingdyn.parts.outline import Outline, Outlined
from bearingdyn.parts.prestress import Prestress
from bearingdyn.parts.profile import HasProfile, Matter, Profile, cut
from bearingdyn.parts.regions import Patch, Region, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder, EndFace, Groove, Line, MeshNodes, Where
from bearingdyn.parts.revolved_modes import RevolvedModes
from bearingdyn.parts.rigid_body import RigidBody
from bearingdyn.parts.ring import Ring
from bearingdyn.parts.ring_compliance import RingCompliance
from bearingdyn.parts.ring_support import RingBed, RingPoints
from bearingdyn.parts.rubber_zones import RubberZone
from bearingdyn.parts.shaft import Shaft
from bearingdyn.parts.solid import RigidSurface, Solid
from bearingdyn.parts.solid_family import SolidFamily, solid_family
from bearingdyn.parts.solid_prestress import SolidPrestress
from bearingdyn.parts.specimen import specimen_factor
from bearingdyn.parts.squeezed import Squeezed
from bearingdyn.parts.strain import Strain

__all__ = [
    "DIMENSIONS",
    "BoreShape",
    "Cylinder",
    "Disc",
    "EndFace",
    "Feet",
    "FlexibleBearing",
    "FlexibleBore",
    "FlexibleRing",
    "Groove",
    "HasProfile",
    "Housing",
    "Imported",
    "Layer",
    "LayerSlopes",
    "Line",
    "Matter",
    "MeshNodes",
    "NodeSet",
    "ORing",
    "Outline",
    "Outlined",
    "Patch",
    "Prestress",
    "Profile",
    "Region",
    "Revolved",
    "RevolvedModes",
    "RigidBody",
    "RigidSurface",
    "Ring",
    "RingBed",
    "RingCompliance",
    "RingPoints",
    "RubberZone",
    "Section",
    "Shaft",
    "Solid",
    "SolidFamily",
    "SolidPrestress",
    "Squeezed",
    "Strain",
    "ViscoelasticSolid",
    "Where",
    "at_radius",
    "cut",
    "damping_sample",
    "layer_slopes",
    "quadrilaterals",
    "solid_family",
    "specimen_factor",
]
