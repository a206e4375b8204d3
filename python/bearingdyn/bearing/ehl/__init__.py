"""The lubricated contact in motion: film, approach and dynamic stiffness of one ball on its race.

Reynolds' equation of an isothermal, fully flooded, Newtonian film between elastic bodies, round or
elliptic, rolling along the minor axis (D = Rx/Ry ≤ 1).
"""

from bearingdyn.bearing.ehl.lubricated_contact import LubricatedContact, solve
from bearingdyn.bearing.ehl.march import March, march
from bearingdyn.bearing.ehl.steady_film import Figures, Level, Steady, steady
from bearingdyn.bearing.ehl.table_lookup import Lookup, lookup

__all__ = [
    "Figures",
    "Level",
    "Lookup",
    "LubricatedContact",
    "March",
    "Steady",
    "lookup",
    "march",
    "solve",
    "steady",
]
