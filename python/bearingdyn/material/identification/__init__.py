"""Maxwell models identified from a master curve, and the law of softening from a strain sweep.

`points_in_band` are the data, `bounds` what the parameters may be; `spectrum_start` and `projection` give
first guesses, `polish` moves all parameters together, and `fit_master_curve` chooses.
"""

from bearingdyn.material.identification.fit_master_curve import fit_dense, fit_maxwell
from bearingdyn.material.identification.fit_payne import fit_payne

__all__ = ["fit_dense", "fit_maxwell", "fit_payne"]
