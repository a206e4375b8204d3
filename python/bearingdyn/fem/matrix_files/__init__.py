"""Stiffness and mass matrices of other finite element programs: read, checked, brought to SI units."""

from bearingdyn.fem.matrix_files.abaqus import read_abaqus, read_nodes
from bearingdyn.fem.matrix_files.calculix import read_calculix
from bearingdyn.fem.matrix_files.fe_matrices import FEMatrices
from bearingdyn.fem.matrix_files.free_body_checks import check_matrices
from bearingdyn.fem.matrix_files.matrix_market import read_matrix_market
from bearingdyn.fem.matrix_files.nastran import read_op4
from bearingdyn.fem.matrix_files.npz import read_npz, write_npz
from bearingdyn.fem.matrix_files.read_matrices import read_matrices
from bearingdyn.fem.matrix_files.units import MM_TONNE, SI, Units

__all__ = [
    "MM_TONNE",
    "SI",
    "FEMatrices",
    "Units",
    "check_matrices",
    "read_abaqus",
    "read_calculix",
    "read_matrices",
    "read_matrix_market",
    "read_nodes",
    "read_npz",
    "read_op4",
    "write_npz",
]
