"""Studies: one function over many cases, what came of them as a table, and the cases that no other beats."""

from bearingdyn.study.cases import Case, grid, sobol
from bearingdyn.study.doubt_effects import doubt_effects
from bearingdyn.study.pareto import pareto
from bearingdyn.study.sweep import sweep
from bearingdyn.study.table import table

__all__ = ["Case", "doubt_effects", "grid", "pareto", "sobol", "sweep", "table"]
