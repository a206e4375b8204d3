"""Meshes: of solids, of sections of bodies of revolution, and the built-in makers of both."""

from bearingdyn.fem.meshes.built_in import (
    block_with_bore,
    box_mesh,
    crowded,
    disc_section,
    o_ring_mesh,
    ring_mesh,
)
from bearingdyn.fem.meshes.quadrilaterals import quadrilaterals
from bearingdyn.fem.meshes.revolution_mesh import SAME, Rectangle, RevolutionMesh, revolution_mesh
from bearingdyn.fem.meshes.solid_element import by_size, face_shapes
from bearingdyn.fem.meshes.solid_mesh import SolidMesh, SurfaceSamples

__all__ = [
    "SAME",
    "Rectangle",
    "RevolutionMesh",
    "SolidMesh",
    "SurfaceSamples",
    "block_with_bore",
    "box_mesh",
    "by_size",
    "crowded",
    "disc_section",
    "face_shapes",
    "o_ring_mesh",
    "quadrilaterals",
    "revolution_mesh",
    "ring_mesh",
]
