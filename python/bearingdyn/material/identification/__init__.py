"""Maxwell models identified from a master curve, and the law of softening from a strain sweep.

`points` are the data inside the band, `bounds` what the parameters may be; `projection` and `polish` are the
two stages of the fit that `fit` makes of them.
"""

from bearingdyn.material.identification.fit_master_curve import fit_dense, fit_maxwell
from bearingdyn.material.identification.fit_payne import fit_payne

__all__ = ["fit_dense", "fit_maxwell", "fit_payne"]
