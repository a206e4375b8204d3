"""Ball bearings: internal geometry, Hertz contact, lubricant film, and the force law between the rings."""

from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.excitation import Imperfections, Pit, Waviness
from bearingdyn.bearing.geometry import Frequencies, Geometry
from bearingdyn.bearing.hertz import (
    PointContact,
    contact_modulus,
    resultant_damping,
    resultant_deflection_coefficient,
)
from bearingdyn.bearing.kernel import BearingKernel, ConstantDamping, Damping, LoadDamping, TabulatedDamping
from bearingdyn.bearing.lubricant import Film, Lubricant, Walther, hamrock_dowson, nijenbanning_venner_moes
from bearingdyn.bearing.mounting import Mounting, Seat
from bearingdyn.bearing.pairs import Pair
from bearingdyn.bearing.quasistatic import (
    BearingWarning,
    LoadDistribution,
    Passage,
    load_distribution,
    passage,
    without_spin,
)
from bearingdyn.bearing.running import Balls, Running

__all__ = [
    "BallBearing",
    "Balls",
    "BearingKernel",
    "BearingWarning",
    "ConstantDamping",
    "Damping",
    "Film",
    "Frequencies",
    "Geometry",
    "Imperfections",
    "LoadDamping",
    "LoadDistribution",
    "Lubricant",
    "Mounting",
    "Pair",
    "Passage",
    "Pit",
    "PointContact",
    "Running",
    "Seat",
    "TabulatedDamping",
    "Walther",
    "Waviness",
    "contact_modulus",
    "hamrock_dowson",
    "load_distribution",
    "nijenbanning_venner_moes",
    "passage",
    "resultant_damping",
    "resultant_deflection_coefficient",
    "without_spin",
]
