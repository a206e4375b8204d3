"""The shear moduli of the regions at which the shapes of a body of revolution are taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from bearingdyn.cms import modulus_levels
from bearingdyn.material import Elastic, Maxwell, answer_of
from bearingdyn.parts.regions import Patch, Region


def shape_moduli(regions: Sequence[Region | Patch], moduli: Sequence[float] | None) -> list[list[float]]:
    """Shear moduli, Pa, at which shapes of a revolved body are taken: a list over the regions per level."""
    soft = [i for i, q in enumerate(regions) if not isinstance(q.material, Elastic)]
    shear = [q.material.G if isinstance(q.material, Elastic) else 0.0 for q in regions]
    materials = [q.material for q in regions if not isinstance(q.material, Elastic)]
    levels = np.tile(shear, (len(given := modulus_levels(materials, moduli)), 1))
    levels[:, soft] = given
    return [level.tolist() for level in levels]


def moduli_at(regions: Sequence[Region | Patch], omega: float) -> list[complex]:
    """Moduli for shapes: shear moduli G*(ω), Pa, of the regions, also beyond a fit's band; ω in rad/s.

    Shapes are asked for at all frequencies: nothing warns here.
    """
    found: list[complex] = []
    for q in regions:
        if isinstance(q.material, Elastic):
            found.append(complex(q.material.G))
            continue
        material: Any = q.material
        bare = (
            replace(material, fit=None, band=None, spread=None) if isinstance(material, Maxwell) else material
        )
        found.append(complex(answer_of(bare, omega).item()))
    return found
