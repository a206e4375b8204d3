"""Maxwell models identified from a master curve.

`points` are the data inside the band, `bounds` what the parameters may be; `projection` and `polish` are the
two stages of the fit that `fit` makes of them.
"""

from bearingdyn.material.identification.fit_master_curve import fit_dense, fit_maxwell

__all__ = ["fit_dense", "fit_maxwell"]
