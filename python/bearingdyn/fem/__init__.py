"""Finite elements: beams, solids, bodies of revolution, their meshes, and matrices of other programs.

``meshes`` holds meshes and their makers, ``mesh_files`` and ``matrix_files`` read other programs' files;
``beam``, ``solid`` and ``revolution`` make the matrices, and ``rigid``, ``factors`` and ``eigen`` serve
all three.
"""

from bearingdyn.fem.beam import Section, assemble_beam, bending_wavelength
from bearingdyn.fem.factors import Factors, factorise, order_of
from bearingdyn.fem.finite_strain import (
    CURRENT,
    SEPARABLE,
    NoBalance,
    RevolvedElements,
    RevolvedState,
    SolidElements,
    SolidState,
    Wall,
    balance,
)
from bearingdyn.fem.held_harmonic import held_factors
from bearingdyn.fem.lowest_modes import lowest_modes
from bearingdyn.fem.matrix_files import (
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
from bearingdyn.fem.mesh_files import read_mesh
from bearingdyn.fem.meshes import (
    SAME,
    Rectangle,
    RevolutionMesh,
    SolidMesh,
    SurfaceSamples,
    block_with_bore,
    box_mesh,
    by_size,
    crowded,
    disc_section,
    face_points,
    face_shapes,
    lagrange,
    o_ring_mesh,
    quadrilaterals,
    revolution_mesh,
    ring_mesh,
)
from bearingdyn.fem.revolution_harmonics import (
    ALL_COMPONENTS,
    AXIAL,
    TORSION,
    Harmonic,
    assemble_harmonic,
    deviatoric_strains,
    harmonic_slopes,
    moved_sections,
)
from bearingdyn.fem.rigid_motion import rigid_body_inertia, rigid_body_residual, rigid_motion, rigid_transfer
from bearingdyn.fem.solid_matrices import SolidMatrices, assemble_elastic, assemble_solid

__all__ = [
    "ALL_COMPONENTS",
    "AXIAL",
    "CURRENT",
    "MM_TONNE",
    "SAME",
    "SEPARABLE",
    "TORSION",
    "FEMatrices",
    "Factors",
    "Harmonic",
    "NoBalance",
    "Rectangle",
    "RevolutionMesh",
    "RevolvedElements",
    "RevolvedState",
    "Section",
    "SolidElements",
    "SolidMatrices",
    "SolidMesh",
    "SolidState",
    "SurfaceSamples",
    "Units",
    "Wall",
    "assemble_beam",
    "assemble_elastic",
    "assemble_harmonic",
    "assemble_solid",
    "balance",
    "bending_wavelength",
    "block_with_bore",
    "box_mesh",
    "by_size",
    "check_matrices",
    "crowded",
    "deviatoric_strains",
    "disc_section",
    "face_points",
    "face_shapes",
    "factorise",
    "harmonic_slopes",
    "held_factors",
    "lagrange",
    "lowest_modes",
    "moved_sections",
    "o_ring_mesh",
    "order_of",
    "quadrilaterals",
    "read_matrices",
    "read_matrix_market",
    "read_mesh",
    "read_nodes",
    "read_npz",
    "revolution_mesh",
    "rigid_body_inertia",
    "rigid_body_residual",
    "rigid_motion",
    "rigid_transfer",
    "ring_mesh",
    "write_npz",
]
