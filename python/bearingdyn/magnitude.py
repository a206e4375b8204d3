"""Magnitudes no machine has: a number in mm, µm, GPa or g/cm³ where an SI unit is asked for."""

from __future__ import annotations

LONGEST_SHAFT = 100.0  # m; a ship's line of shafts
THICKEST_SHAFT = 5.0  # m
LARGEST_BODY = 10.0  # m; housings, rings, layers
LARGEST_SOLID = 100.0  # m; of a mesh that read_mesh was told is that large
LARGEST_BALL = 0.5  # m
LIGHTEST, HEAVIEST = 10.0, 30000.0  # kg/m³; a foam, more than any metal
MASSLESS = (1e-4, 0.1)  # kg/m³; what stands for a body without inertia: neither t/mm³, kg/mm³ nor g/cm³
SOFTEST = 1e4  # Pa; below any rubber


def check_length(field: str, value: float, largest: float = LARGEST_BODY) -> None:
    """Raise ValueError for a length above `largest`, both in m: it was probably given in mm."""
    if not abs(value) <= largest:
        raise ValueError(
            f"{field} is {value:.6g} m, above {largest:g} m: is it in mm? lengths are in m, as "
            f"{value * 1e-3:.6g}"
        )


def check_density(field: str, density: float) -> None:
    """Raise ValueError for a density, kg/m³, that no solid has; 1e-4 to 0.1 mean a body without inertia."""
    if not (LIGHTEST <= density <= HEAVIEST or MASSLESS[0] <= density <= MASSLESS[1]):
        raise ValueError(
            f"{field} is {density!r} kg/m³; a solid has {LIGHTEST:g} to {HEAVIEST:g} kg/m³; is it in g/cm³ "
            f"or t/mm³? Water has 1000 kg/m³ (for a body without inertia give {MASSLESS[0]:g} to "
            f"{MASSLESS[1]:g})"
        )


def check_bulk(field: str, K: float, G: float) -> None:
    """Raise ValueError for a bulk modulus K that with the shear modulus G, both Pa, gives ν < 0."""
    if not K >= 2 / 3 * G:  # ν = (3K − 2G)/(6K + 2G)
        raise ValueError(
            f"{field} is {K:g} Pa, below 2/3 of the shear modulus, {G:.4g} Pa: Poisson's ratio would be "
            "negative; a rubber's bulk modulus is near 2e9 Pa"
        )
