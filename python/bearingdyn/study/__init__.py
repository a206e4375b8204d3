"""Studies: one function over many cases, what came of them as a table, and the cases that no other beats;
draws of what is not exactly known, and what they leave of a result."""

from bearingdyn.study.cases import Case, grid, sobol
from bearingdyn.study.curve_band import band
from bearingdyn.study.distributions import Fitted, LogNormal, Normal, Uniform, draw
from bearingdyn.study.doubt_effects import doubt_effects
from bearingdyn.study.indices import sobol_indices
from bearingdyn.study.optimum import Optimum, front, optimise
from bearingdyn.study.pareto import pareto
from bearingdyn.study.robust import Robust
from bearingdyn.study.store import StudyStatus, status
from bearingdyn.study.study_table import table
from bearingdyn.study.sweep import sweep

__all__ = [
    "Case",
    "Fitted",
    "LogNormal",
    "Normal",
    "Optimum",
    "Robust",
    "StudyStatus",
    "Uniform",
    "band",
    "doubt_effects",
    "draw",
    "front",
    "grid",
    "optimise",
    "pareto",
    "sobol",
    "sobol_indices",
    "status",
    "sweep",
    "table",
]
