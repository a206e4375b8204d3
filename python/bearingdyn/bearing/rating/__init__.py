"""What a bearing is rated for: ratings, equivalent loads, life, friction."""

from bearingdyn.bearing.rating.standard import (
    Ratings,
    dynamic_factors,
    equivalent_load,
    equivalent_static_load,
    iso_ratings,
    static_factor,
)

__all__ = [
    "Ratings",
    "dynamic_factors",
    "equivalent_load",
    "equivalent_static_load",
    "iso_ratings",
    "static_factor",
]
