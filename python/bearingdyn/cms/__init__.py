"""Component mode synthesis: a finite element model becomes a superelement (paper section 3.3, (21)-(25)).

A superelement is what the rest of the package knows of a part: reduced matrices, the coordinates of its
rigid six-degree-of-freedom interfaces, and rows that give the motion of named points. Interface coordinates
come first, six after six in the order (x, y, z, θx, θy, θz), then the modal coordinates of the
fixed-interface modes (Craig & Bampton, AIAA Journal 6 (1968) 1313-1319) and of further shapes.
"""

from bearingdyn.cms.basis import Basis, basis_of, craig_bampton, inertia_shapes, modulus_levels, orthogonalise
from bearingdyn.cms.damping import coupled_blocks, modal_damping
from bearingdyn.cms.dynamics import Dynamics, Transfer
from bearingdyn.cms.estimate import ReductionError, reduction_error
from bearingdyn.cms.full import FullModel, RigidInterface
from bearingdyn.cms.history import March, march
from bearingdyn.cms.options import F_MAX, check_damping, check_f_max, check_held, check_moduli, check_rounds
from bearingdyn.cms.reduction import project, reduce, reduce_free_body
from bearingdyn.cms.superelement import ComplexModulus, Raceway, Superelement, Surface, Viscoelastic

__all__ = [
    "F_MAX",
    "Basis",
    "ComplexModulus",
    "Dynamics",
    "FullModel",
    "March",
    "Raceway",
    "ReductionError",
    "RigidInterface",
    "Superelement",
    "Surface",
    "Transfer",
    "Viscoelastic",
    "basis_of",
    "check_damping",
    "check_f_max",
    "check_held",
    "check_moduli",
    "check_rounds",
    "coupled_blocks",
    "craig_bampton",
    "inertia_shapes",
    "march",
    "modal_damping",
    "modulus_levels",
    "orthogonalise",
    "project",
    "reduce",
    "reduce_free_body",
    "reduction_error",
]
