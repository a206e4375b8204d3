"""Ball bearings: internal geometry, Hertz contact, lubricant film, and the force law between the rings."""

from importlib import import_module
from types import ModuleType

from bearingdyn.bearing import catalogue
from bearingdyn.bearing.ball_bearing import BallBearing
from bearingdyn.bearing.ball_inertia import Balls, Running
from bearingdyn.bearing.ball_passage import Passage, passage, without_spin
from bearingdyn.bearing.characteristic_frequencies import Frequencies
from bearingdyn.bearing.contact_damping import (
    ConstantDamping,
    Damping,
    FilmDamping,
    LoadDamping,
    TabulatedDamping,
    resultant_damping,
)
from bearingdyn.bearing.contact_pressure import STATIC_PRESSURE, check_bearing_pressure, check_light
from bearingdyn.bearing.designation import clearance_range, read_designation
from bearingdyn.bearing.energy_minimum import NoBalance, minimum
from bearingdyn.bearing.film_answer import AnswerUnderLoads, FilmAnswer
from bearingdyn.bearing.film_memory import FilmMemory, carried
from bearingdyn.bearing.film_thickness import Film, hamrock_dowson, nijenbanning_venner_moes
from bearingdyn.bearing.geometry import Geometry
from bearingdyn.bearing.half_space import footprint_profile, half_space_orders
from bearingdyn.bearing.hertz import PointContact, contact_modulus, resultant_deflection_coefficient
from bearingdyn.bearing.imperfections import Imperfections, Pit, Waviness
from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.bearing.load_and_motion_checks import warn_of_lean
from bearingdyn.bearing.load_distribution import LoadDistribution, load_distribution
from bearingdyn.bearing.loose_fit import LooseFit
from bearingdyn.bearing.lubricant import Lubricant, Walther
from bearingdyn.bearing.lubrication import Lubrication, film_by_formula, lubricate, lubricated
from bearingdyn.bearing.mounting import Mounting, Seat
from bearingdyn.bearing.oil_supply import OilSupply
from bearingdyn.bearing.open_side import OPEN_SIDE_REMEDY, runs_off, samples_off, shoulder
from bearingdyn.bearing.pairs import Pair, Triplet
from bearingdyn.bearing.raceway_series import NET, RIGID, RacewaySeries
from bearingdyn.bearing.random_surfaces import WavinessSpectrum, diameter_scatter
from bearingdyn.bearing.rating import (
    Friction,
    FrictionModel,
    LoadCases,
    Phase,
    Ratings,
    Supply,
    check_given,
    contamination_factor,
    equivalent_life,
    equivalent_load,
    equivalent_static_load,
    friction,
    in_hours,
    iso_ratings,
    life_factor,
    life_of_loads,
    lives,
    load_cases,
    modified_life,
    rating_life,
    ratings_of,
    reliability_factor,
)
from bearingdyn.bearing.rigid_ring_law import RigidRingLaw
from bearingdyn.bearing.row_set import Row, RowSet, at_distance
from bearingdyn.bearing.spectral_lines import fault_lines, waviness_lines
from bearingdyn.bearing.surface_damage import dent, spall
from bearingdyn.notice import BearingWarning

__all__ = [
    "NET",
    "OPEN_SIDE_REMEDY",
    "RIGID",
    "STATIC_PRESSURE",
    "AnswerUnderLoads",
    "BallBearing",
    "Balls",
    "BearingKernel",
    "BearingWarning",
    "ConstantDamping",
    "Damping",
    "Film",
    "FilmAnswer",
    "FilmDamping",
    "FilmMemory",
    "Frequencies",
    "Friction",
    "FrictionModel",
    "Geometry",
    "Imperfections",
    "LoadCases",
    "LoadDamping",
    "LoadDistribution",
    "LooseFit",
    "Lubricant",
    "Lubrication",
    "Mounting",
    "NoBalance",
    "OilSupply",
    "Pair",
    "Passage",
    "Phase",
    "Pit",
    "PointContact",
    "RacewaySeries",
    "Ratings",
    "RigidRingLaw",
    "Row",
    "RowSet",
    "Running",
    "Seat",
    "Supply",
    "TabulatedDamping",
    "Triplet",
    "Walther",
    "Waviness",
    "WavinessSpectrum",
    "at_distance",
    "carried",
    "catalogue",
    "check_bearing_pressure",
    "check_given",
    "check_light",
    "clearance_range",
    "contact_modulus",
    "contamination_factor",
    "dent",
    "diameter_scatter",
    "equivalent_life",
    "equivalent_load",
    "equivalent_static_load",
    "fault_lines",
    "film_by_formula",
    "footprint_profile",
    "friction",
    "half_space_orders",
    "hamrock_dowson",
    "in_hours",
    "iso_ratings",
    "life_factor",
    "life_of_loads",
    "lives",
    "load_cases",
    "load_distribution",
    "lubricate",
    "lubricated",
    "minimum",
    "modified_life",
    "nijenbanning_venner_moes",
    "passage",
    "rating_life",
    "ratings_of",
    "read_designation",
    "reliability_factor",
    "resultant_damping",
    "resultant_deflection_coefficient",
    "runs_off",
    "samples_off",
    "shoulder",
    "spall",
    "warn_of_lean",
    "waviness_lines",
    "without_spin",
]


def __getattr__(name: str) -> ModuleType:
    """The lubricated contact's room, loaded when it is first asked for."""
    if name != "ehl":
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module("bearingdyn.bearing.ehl")
