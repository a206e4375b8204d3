"""The lubricated contact in motion: film, approach and dynamic stiffness of one ball on its race.

Reynolds' equation of an isothermal, fully flooded, Newtonian film between elastic bodies, round or
elliptic, rolling along the minor axis (D = Rx/Ry ≤ 1).
"""

from bearingdyn.bearing.ehl.dimensionless_groups import scales
from bearingdyn.bearing.ehl.figures import Figures
from bearingdyn.bearing.ehl.film_decays import DECAYS, FilmDecays
from bearingdyn.bearing.ehl.lubricated_contact import LubricatedContact, SolvedContact, look_up, solve
from bearingdyn.bearing.ehl.march import March, march
from bearingdyn.bearing.ehl.oil import relative_density
from bearingdyn.bearing.ehl.steady_film import Level, Steady, steady
from bearingdyn.bearing.ehl.table_lookup import Lookup, loads_between, lookup, nearest_in_table, table_ends
from bearingdyn.bearing.ehl.table_nodes import turning_load

__all__ = [
    "DECAYS",
    "Figures",
    "FilmDecays",
    "Level",
    "Lookup",
    "LubricatedContact",
    "March",
    "SolvedContact",
    "Steady",
    "loads_between",
    "look_up",
    "lookup",
    "march",
    "nearest_in_table",
    "relative_density",
    "scales",
    "solve",
    "steady",
    "table_ends",
    "turning_load",
]
