"""Finite elements: beams, solids, bodies of revolution, and matrices of other programs."""

from bearingdyn.fem.beam import Section
from bearingdyn.fem.exchange import (
    MM_TONNE,
    FEMatrices,
    Units,
    check_matrices,
    read_matrices,
    read_matrix_market,
    read_nodes,
    read_npz,
    write_npz,
)
from bearingdyn.fem.mesh_file import read_mesh
from bearingdyn.fem.solid import SolidMatrices, assemble_solid
from bearingdyn.fem.solid_mesh import SolidMesh, SurfaceSamples
from bearingdyn.fem.solid_meshers import block_with_bore, box_mesh, crowded, o_ring_mesh, ring_mesh

__all__ = [
    "MM_TONNE",
    "FEMatrices",
    "Section",
    "SolidMatrices",
    "SolidMesh",
    "SurfaceSamples",
    "Units",
    "assemble_solid",
    "block_with_bore",
    "box_mesh",
    "check_matrices",
    "crowded",
    "o_ring_mesh",
    "read_matrices",
    "read_matrix_market",
    "read_mesh",
    "read_nodes",
    "read_npz",
    "ring_mesh",
    "write_npz",
]
