"""Meshes: of solids, of sections of bodies of revolution, and the built-in makers of both."""

from bearingdyn.fem.meshes.block_with_bore import block_with_bore
from bearingdyn.fem.meshes.box_mesh import box_mesh
from bearingdyn.fem.meshes.disc_section import disc_section
from bearingdyn.fem.meshes.grid_lines import crowded
from bearingdyn.fem.meshes.o_ring_mesh import o_ring_mesh
from bearingdyn.fem.meshes.quadrilateral_element import lagrange
from bearingdyn.fem.meshes.quadrilaterals import quadrilaterals
from bearingdyn.fem.meshes.revolution_mesh import SAME, Rectangle, RevolutionMesh, revolution_mesh
from bearingdyn.fem.meshes.ring_mesh import ring_mesh
from bearingdyn.fem.meshes.solid_element import by_size, face_points, face_shapes
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
    "face_points",
    "face_shapes",
    "lagrange",
    "o_ring_mesh",
    "quadrilaterals",
    "revolution_mesh",
    "ring_mesh",
]
