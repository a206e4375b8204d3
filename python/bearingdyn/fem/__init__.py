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
from bearingdyn.fem.solid import SolidMatrices, assemble_solid, block_with_bore

__all__ = [
    "MM_TONNE",
    "FEMatrices",
    "Section",
    "SolidMatrices",
    "Units",
    "assemble_solid",
    "block_with_bore",
    "check_matrices",
    "read_matrices",
    "read_matrix_market",
    "read_nodes",
    "read_npz",
    "write_npz",
]
