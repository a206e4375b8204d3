"""Rubber that an equilibrium strains so far that its linear stiffness is wrong, and by how much."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from bearingdyn.application import Application
from bearingdyn.cms import Superelement
from bearingdyn.fem import NoBalance
from bearingdyn.notice import StrainedLayer, warn
from bearingdyn.parts import Layer, Solid
from bearingdyn.types import Array

HARDENING = 2.0
"""Rise of a bonded layer's secant stiffness across the axis, over (displacement/thickness)²."""
STRAINED = 0.01
"""Error of a part's linear stiffness about a static state that is worth a warning."""
LEAST = 1e-3
"""Strain, rms over the rubber, below which no solid is solved anew: pressed rubber stiffens by some three
times its strain."""
LARGE = 12_000
"""Coordinates of a solid above which it is not solved anew for a warning: that takes longer than 5 s."""
DIRECTIONS = ("x", "y", "z", "θx", "θy", "θz")

Displacement = Callable[[str], Array]


def warn_of_strained_rubber(app: Application, displacement: Displacement, after: float | None) -> None:
    """Warn (StrainedLayer) of rubber strained so far by a static state that its linear stiffness is wrong.

    Parameters
    ----------
    app
        The application.
    displacement
        Its places' motion in the static state, (6,), m and rad.
    after
        The time at which it was found, s; None: relaxed.
    """
    for name, source in app.plan.sources.items():
        if isinstance(source, Layer):
            _check_layer(name, source, displacement)
        elif isinstance(source, Solid) and source.prestress is None:
            _check_solid(name, source, app.plan.parts[name], displacement, after)


def _check_layer(name: str, layer: Layer, displacement: Displacement) -> None:
    """Warn of a layer displaced across the axis.

    With e the displacement over the thickness, a layer pushes back 2e² more than linearly, and is 6e² stiffer
    for a small motion about that state (computed at finite strain for a bonded ring 20/24×12 mm; along the
    axis it is .06 e², which nobody notices).
    """
    e = float(layer.eccentricity(displacement(f"{name}.outer") - displacement(f"{name}.inner")))
    if HARDENING * 3.0 * e**2 <= STRAINED:
        return
    own = HARDENING * e**2
    told = (
        f"its linear stiffness is about {own:.1%} low for the state itself, and {3 * own:.1%} for a "
        "small motion about it"
        if e < 0.5
        else "its linear stiffness says nothing of such a state: make the layer stiffer, thicker or "
        "larger, or the load smaller"
    )
    warn(
        f"layer {name!r} is displaced across the axis by {e:.1%} of its thickness here; {told}", StrainedLayer
    )


def _check_solid(
    name: str, solid: Solid, element: Superelement, displacement: Displacement, after: float | None
) -> None:
    """Warn of a solid, from its own static state at finite strain under the motion of its interfaces."""
    motion = {face: displacement(f"{name}.{face}") for face in element.interfaces}
    strain = _rms_strain(element, motion)
    if not strain > LEAST:
        return
    where = f"solid {name!r} is strained by {strain:.1%} (rms over its rubber) here"
    remedy = "give the application what Solid.assembled returns for the motion of its interfaces"
    if 3 * len(solid.mesh.points) > LARGE:
        if 3.0 * strain > STRAINED:
            warn(f"{where}; its linear stiffness may be wrong by several times that: {remedy}", StrainedLayer)
        return
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what there is to say of the material was said
            linear = solid.stiffness(after=after).real
            found = solid.deformed({face: tuple(q) for face, q in motion.items()}, after=after)
            tangent = found.stiffness(after=after).real
    except NoBalance as failure:
        warn(
            f"{where}, and at finite strain it finds no balance beyond {failure.share:.0%} of that motion: "
            f"{failure.reason}",
            StrainedLayer,
        )
        return
    except ValueError:  # no static modulus: there is nothing to compare
        return
    q = np.concatenate(list(motion.values()))
    own = float(np.concatenate([found.forces[face] for face in motion]) @ q / (q @ linear @ q)) - 1.0
    ratio = np.diag(tangent) / np.diag(linear) - 1.0
    worst = int(np.argmax(np.abs(ratio)))
    if max(abs(own), abs(ratio[worst])) <= STRAINED:
        return
    face = list(motion)[worst // 6]
    warn(
        f"{where}; at finite strain, neo-Hookean, it pushes back by {own:+.1%} against its linear stiffness, "
        f"and is {ratio[worst]:+.1%} stiffer for a small motion about this state (most along "
        f"{DIRECTIONS[worst % 6]} of {face!r}): {remedy}",
        StrainedLayer,
    )


def _rms_strain(element: Superelement, motion: Mapping[str, Any]) -> float:
    """Shear strain of a solid's rubber, rms over its volume, by the motion of its interfaces alone."""
    x = np.zeros(element.n)
    for face, at in element.interfaces.items():
        x[at] = motion[face]
    known = [(part.H, part.volume) for part in element.viscoelastic if part.volume]
    if not known:
        return 0.0
    return math.sqrt(max(0.0, sum(2.0 * float(x @ H @ x) for H, _ in known)) / sum(v for _, v in known))
