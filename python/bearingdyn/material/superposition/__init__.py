"""Isotherms superposed: one master curve and its shift law from sweeps at many temperatures.

`kramers_kronig` finds the points to leave out, `free_shifts` the shift of each isotherm, `law_fit` the law
through the shifts; `master` makes the master curve.
"""

from bearingdyn.material.superposition.kramers_kronig import LIMIT, Suspect, kk_ratio, suspects
from bearingdyn.material.superposition.law_fit import LawName
from bearingdyn.material.superposition.master_curve import MasterCurve, master_curve
from bearingdyn.material.superposition.single_sweep import one_curve

__all__ = ["LIMIT", "LawName", "MasterCurve", "Suspect", "kk_ratio", "master_curve", "one_curve", "suspects"]
