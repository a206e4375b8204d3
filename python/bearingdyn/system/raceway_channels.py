"""Channels of a raceway: its motion by a Fourier coefficient, or at an azimuth."""

from __future__ import annotations

import math
import re

import numpy as np

from bearingdyn.cms import Raceway
from bearingdyn.types import Array

_COEFFICIENT = re.compile(r"(radial|axial)-(cos|sin)(\d+)")
_AZIMUTH = re.compile(r"(radial|axial)@([+-]?\d+)")


def raceway_row(place: str, raceway: Raceway, component: str) -> Array:
    """Row (n,) of one component of the raceway at a place, on the coordinates of its part.

    Parameters
    ----------
    place
        Its name, "ring.raceway".
    raceway
        Its rows.
    component
        "radial-cos2", "axial-sin3": the coefficient of cos 2ψ, sin 3ψ; "radial@-90": at that azimuth, whole
        degrees from x towards y.

    Raises
    ------
    ValueError
        For another component, or an order that the ring does not carry.
    """
    series = raceway.series
    if at := _AZIMUTH.fullmatch(component):
        psi, wanted = math.radians(int(at[2])), int(at[1] == "axial")
        shares = [
            (math.sin(n * psi) if sine else math.cos(n * psi)) * (axial == wanted)
            for axial, n, sine in series.terms
        ]
        return np.asarray(np.array(shares) @ raceway.rows)
    highest = max(n for _, n, _ in series.terms)
    if of := _COEFFICIENT.fullmatch(component):
        term = int(of[1] == "axial"), int(of[3]), int(of[2] == "sin")
        if term in series.terms:
            return np.asarray(raceway.rows[series.index(*term)])
    raise ValueError(
        f"{f'{place}.{component}'!r}: {place} is a raceway; it offers radial-cos0 to radial-sin{highest}, "
        f"axial-cos0 to axial-sin{highest}, and radial@-90 or axial@-90 at an azimuth in whole degrees"
    )
