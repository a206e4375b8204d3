"""Studies: one function over many cases, what came of them as a table, and the cases that no other beats."""

from bearingdyn.study.cases import Case, grid, sobol
from bearingdyn.study.sweeping import sweep
from bearingdyn.study.tables import pareto, table

__all__ = ["Case", "grid", "pareto", "sobol", "sweep", "table"]
