"""Studies: one function over many cases, what came of them as a table, and the cases that no other beats."""

from bearingdyn.study.cases import Case, grid, sobol
from bearingdyn.study.pareto import pareto
from bearingdyn.study.sweep import sweep
from bearingdyn.study.table import table

__all__ = ["Case", "grid", "pareto", "sobol", "sweep", "table"]
