"""Component mode synthesis: a finite element model becomes a superelement (paper section 3.3, (21)-(25)).

A superelement is what the rest of the package knows of a part: reduced matrices, the coordinates of its
rigid six-degree-of-freedom interfaces, and rows that give the motion of named points. Interface coordinates
come first, six after six in the order (x, y, z, θx, θy, θz), then the modal coordinates of the
fixed-interface modes (Craig & Bampton, AIAA Journal 6 (1968) 1313-1319) and of further shapes.
"""

from bearingdyn.cms.basis import Basis, basis_of, craig_bampton, inertia_shapes, modulus_levels, orthogonalise
from bearingdyn.cms.coordinate_coupling import coupled_blocks
from bearingdyn.cms.dynamic_stiffness import Dynamics, Transfer
from bearingdyn.cms.full_model import FullModel, RigidInterface
from bearingdyn.cms.kept_superelement import kept_superelement
from bearingdyn.cms.modal_damping import modal_damping
from bearingdyn.cms.part_march import March, march
from bearingdyn.cms.raceway import Raceway
from bearingdyn.cms.radiating_surface import Skin, Surface
from bearingdyn.cms.reduction import project, reduce, reduce_free_body
from bearingdyn.cms.reduction_error import ReductionError, reduction_error
from bearingdyn.cms.reduction_options import (
    F_MAX,
    check_damping,
    check_f_max,
    check_held,
    check_moduli,
    check_rounds,
)
from bearingdyn.cms.round_face import HasRoundFaces, RoundFace, face_of_nodes
from bearingdyn.cms.superelement import Superelement
from bearingdyn.cms.viscoelastic import ComplexModulus, Viscoelastic

__all__ = [
    "F_MAX",
    "Basis",
    "ComplexModulus",
    "Dynamics",
    "FullModel",
    "HasRoundFaces",
    "March",
    "Raceway",
    "ReductionError",
    "RigidInterface",
    "RoundFace",
    "Skin",
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
    "face_of_nodes",
    "inertia_shapes",
    "kept_superelement",
    "march",
    "modal_damping",
    "modulus_levels",
    "orthogonalise",
    "project",
    "reduce",
    "reduce_free_body",
    "reduction_error",
]
