"""The lubricated contact in motion: film, approach and dynamic stiffness of one ball on its race.

Reynolds' equation of an isothermal, fully flooded, Newtonian film between elastic bodies, circular or elliptic, with
the rolling along the minor axis (D = Rx/Ry ≤ 1).
"""

from bearingdyn.bearing.ehl.steady import Figures, Steady, steady

__all__ = ["Figures", "Steady", "steady"]
