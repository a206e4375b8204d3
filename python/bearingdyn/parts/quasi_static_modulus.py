"""The modulus of a viscoelastic region in a part that is asked by itself."""

from __future__ import annotations

import math
from typing import Any

from bearingdyn.checks import positive, require
from bearingdyn.material import Elastic, answer_of, volume_of, warn_beyond


def quasi_static(material: Any, omega: float, after: float | None) -> complex:
    """Static modulus of a part by itself, G*(ω), Pa, or G(t) after a time, s; warns beyond the data."""
    if isinstance(material, Elastic):
        return complex(material.G)
    if after is not None:
        positive("after", after, "it must be a positive and finite time, s")
        require(omega == 0, "omega", omega, f"with after={after!r} the part is at rest: leave it out")
        if not callable(getattr(material, "relaxation", None)):
            raise ValueError(
                f"material is {type(material).__name__}; after= needs a relaxation modulus: take "
                f"material.maxwell(n, band=...)"
            )
    if omega == 0:
        warn_beyond(
            [("the part", material)],
            math.inf if after is None else after,
            "the static stiffness",
            "ask for stiffness(after=...) at a time that the data reach, ",
        )
    if after is None:
        G = complex(answer_of(material, omega).item())
    else:
        G = complex(float(material.relaxation(after, doubt=False)))
    if not abs(G) > 1e-12 * getattr(material, "K", 0.0):
        raise ValueError(
            f"material has |G*| = {abs(G):.3g} Pa at omega = {omega} rad/s: no stiffness "
            "in shear to solve with; give a material with G0 > 0, or omega > 0"
        )
    return G


def quasi_static_bulk(material: Any, omega: float, after: float | None) -> complex:
    """Quasi-static bulk modulus of a region, Pa: K, or where it relaxes K*(ω), or K(t) after a time, s."""
    volume = volume_of(material)
    if volume is None:
        return complex(material.K)
    return complex(answer_of(volume, omega).item() if after is None else float(volume.relaxation(after)))
