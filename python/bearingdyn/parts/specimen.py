"""How much softer or stiffer a bonded specimen of rubber is than the formula its modulus is read by."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from bearingdyn.checks import nonnegative, one_of, positive, require, vector
from bearingdyn.fem import box_mesh
from bearingdyn.material import Maxwell
from bearingdyn.parts.regions import Region
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import EndFace
from bearingdyn.parts.solid import Solid
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array

_FINE = 1.5  # mesh density of a disc: its factor within 0.02 %
_ACROSS, _THROUGH = 8, 4  # bricks along the sides and through the thickness of a block, crowded to the edges


def specimen_factor(
    thickness: float,
    *,
    diameter: float | None = None,
    bore: float = 0.0,
    section: tuple[float, float] | None = None,
    mode: Literal["shear", "tension"] = "shear",
    G: float = 1e6,
    K: float = 2e9,
) -> float:
    """Stiffness of a specimen bonded on both faces over the plain G A/t, or E A/t in tension.

    An instrument that divides force by G A/t reads so much of the true modulus: divide its moduli by the
    factor. In shear the free edges do not carry, and a thick specimen bends: less than 1. In tension (and
    compression) the bonded faces hold the rubber from narrowing: more than 1. For a sandwich of two specimens
    the factor is that of one.

    Parameters
    ----------
    thickness
        Between the bonded faces, m.
    diameter, bore
        Of a disc or a ring, m; bore 0 for none.
    section
        Of a block instead: the side along which it is sheared, and the other one, m.
    mode
        "shear", or "tension".
    G, K
        Shear and bulk modulus, Pa; the factor in tension depends on their ratio, in shear hardly.

    Returns
    -------
    float
        Computed with the package's own elements: a body of revolution, or bricks.

    Raises
    ------
    ValueError
        For dimensions that are not positive, or neither or both of diameter and section.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> f"{bd.specimen_factor(1.965e-3, diameter=14e-3):.3f}"  # a disc 14 mm wide in shear
    '0.967'
    """
    t = positive("thickness", thickness, "it must be a positive length in m")
    plausible("specimen", "thickness", t)
    positive("G", G, "it must be positive and finite, Pa")
    positive("K", K, "it must be positive and finite, Pa")
    one_of("mode", mode, ("shear", "tension"))
    require((diameter is None) != (section is None), "diameter", diameter, "give either diameter or section")
    rubber = Maxwell(G, [], [], K=K, density=1000.0)
    E = 9 * K * G / (3 * K + G)
    along = 0 if mode == "shear" else 2
    if diameter is not None:
        D = positive("diameter", diameter, "it must be a positive length in m")
        plausible("specimen", "diameter", D)
        d = nonnegative("bore", bore, "it must be zero or a positive length in m")
        require(d < D, "bore", bore, f"it must be below the diameter, {D:g} m")
        body = Revolved(
            (Region((d / 2, D / 2), (0.0, t), rubber),),
            {"low": EndFace(0.0), "high": EndFace(t)},
            moduli=(G,),
            refinement=_FINE,
        )
        k, area = float(body.stiffness()[6 + along, 6 + along].real), math.pi / 4 * (D**2 - d**2)
    else:
        a, b = vector("section", section, (2,), "two sides in m").tolist()  # type: ignore[arg-type]
        for name, side in (("section[0]", a), ("section[1]", b)):
            positive(name, side, "it must be a positive length in m")
            plausible("specimen", name, side)
        k, area = _block(a, b, t, rubber, along), a * b
    return k * t / ((G if mode == "shear" else E) * area)


def _block(a: float, b: float, t: float, rubber: Maxwell, along: int) -> float:
    """Stiffness, N/m, of a block between rigid faces, its lines crowded towards the free edges."""

    def lines(side: float, count: int) -> Array:
        return np.asarray(0.5 * side * (1 - np.cos(np.pi * np.arange(count + 1) / count)))

    mesh = box_mesh(lines(a, _ACROSS), lines(b, _ACROSS), lines(t, _THROUGH), element="hex27")
    block = Solid(mesh, rubber, {"low": "z-", "high": "z+"}, f_max=0.0, moduli=(rubber.G0,))
    return float(block.stiffness()[6 + along, 6 + along].real)
