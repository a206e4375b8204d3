"""Waves that the mesh of a section holds: the frequency up to which its elements are short beside them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bearingdyn.fem import RevolutionMesh
from bearingdyn.parts.regions import Patch, Region
from bearingdyn.parts.shape_moduli import moduli_at
from bearingdyn.types import Array

# in rubber 4 mm thick around a ring, receptances of order 0 err by 0.1 % where 2.8 of the longest elements
# lie in a wave, by 0.3 % at 2.1 and 2.6 % at 1.4; orders 2 and 8 by less (against a mesh 1.7 times as fine)
PER_WAVE = 2.0
MARGIN = 1.5  # of the refinement told: a line moved to the edge of a track lengthens its neighbour by half
FINEST = 8.0  # refinement of revolution_mesh


def check_waves(
    mesh: RevolutionMesh, regions: Sequence[Region | Patch], f_max: float, refinement: float
) -> None:
    """Check a mesh against its waves: ValueError where shear waves at f_max are under PER_WAVE elements.

    Parameters
    ----------
    refinement
        That of the mesh, told with what would do.
    """
    longest = _longest_sides(mesh, len(regions))
    short = _shear_waves(regions, f_max) / longest
    worst = int(np.argmin(short))
    if short[worst] >= PER_WAVE:
        return
    allowed = f_max
    for _ in range(100):  # from above: a rubber's waves are slower below
        allowed = float(np.min(allowed * _shear_waves(regions, allowed) / longest)) / PER_WAVE
    finer = math.ceil(1e2 * refinement * MARGIN * PER_WAVE / short[worst]) / 1e2
    wave, side = 1e3 * short[worst] * longest[worst], 1e3 * longest[worst]
    finer_mesh = f"give refinement={finer:g}, or " if finer <= FINEST else "give "
    raise ValueError(
        f"f_max is {f_max:g} Hz; shear waves of regions[{worst}] are {wave:.3g} mm long there and elements "
        f"of the mesh up to {side:.3g} mm, where {PER_WAVE:g} are to lie in a wave: "
        f"{finer_mesh}an f_max of at most {_rounded_down(allowed):g} Hz"
    )


def _longest_sides(mesh: RevolutionMesh, count: int) -> Array:
    """(count,) the longest side of an element of each region, m."""
    r, z = mesh.r[mesh.elements], mesh.z[mesh.elements]
    sides = [np.hypot(r[:, b] - r[:, a], z[:, b] - z[:, a]) for a, b in ((0, 6), (2, 8), (0, 2), (6, 8))]
    longest = np.max(sides, axis=0)
    return np.array([longest[mesh.region == k].max() for k in range(count)])


def _shear_waves(regions: Sequence[Region | Patch], frequency: float) -> Array:
    """Length of a shear wave of each region, m, by |G*|."""
    shear = np.abs(moduli_at(regions, 2.0 * math.pi * frequency))
    return np.asarray(np.sqrt(shear / [q.material.density for q in regions]) / frequency)


def _rounded_down(value: float) -> float:
    """To three digits."""
    step = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.floor(value / step) * step
