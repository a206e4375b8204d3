"""Derivatives of an equilibrium, and of the bearings' tangents in it, by the implicit function theorem."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import scipy.linalg

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.gradient.contact_tangent import STEP, grazing, tangent
from bearingdyn.analysis.gradient.parameters import Change, arm_slope, kernel_slope, relaxation_slope
from bearingdyn.analysis.static_balance import HOLD, diagonal_blocks
from bearingdyn.bearing import BallBearing
from bearingdyn.checks import require
from bearingdyn.material import Maxwell
from bearingdyn.system import System, natural
from bearingdyn.types import Array

# of a push, along a free motion: more than round-off
RESISTED = 1e-6


def coefficient_slope(system: System, change: Change) -> Array:
    """For implicit slopes, derivative of B (coefs, n) with the clearances: the arm of the tilts changes.

    Parameters
    ----------
    system
        The machine's.
    change
        With the clearances.
    """
    found = np.zeros_like(system.B)
    ends = np.cumsum([0, *(len(t.B) for t in system.bearings)])
    for i, weight in change.clearance.items():
        term = system.bearings[i]
        assert isinstance(term.bearing, BallBearing)
        tilts = np.array([(axial, order) == (1, 1) for axial, order, _ in term.series.terms])
        rate = weight * arm_slope(term.bearing)
        moved = sum((rows @ system.rows(name) for name, rows in term.ends.items()), np.zeros(term.B.shape))
        found[ends[i] : ends[i + 1]] = rate * tilts[:, None] * moved
    return found


def check_differentiable(eq: Equilibrium) -> None:
    """Check that implicit derivatives exist here; refuse what has none.

    Parameters
    ----------
    eq
        The equilibrium.

    Raises
    ------
    ValueError
        For averages over angles, lubricated bearings, waves, pits and unequal balls.
    """
    require(eq.average == 1, "average", eq.average, "it must be 1 for a derivative: one angle of the cages")
    for term in eq.system.bearings:
        name, b, flaws = f"bearing {term.name!r}", term.bearing, term.kernel().imperfections
        if isinstance(b, BallBearing):
            require(not b.lubrication, name, "lubricated", "give it film= and damping= for a derivative")
        law = term.kernel().damping_law
        known = law in ("constant", "load")
        require(known, f"{name}: damping", law, "give bd.ConstantDamping or bd.LoadDamping for a derivative")
        plain = not len(flaws.waves) and not len(flaws.pits) and not len(flaws.oversize)
        require(plain, name, "uneven", "a derivative is of smooth races and equal balls; leave them out")


def implicit_slopes(
    eq: Equilibrium, changes: Mapping[str, Change], slopes: Mapping[int, Array], side: str | None
) -> tuple[Array, Array, Array]:
    """Implicit derivatives of the state x (p, n) and the bearings' tangents K, C (p, coefs, coefs).

    Parameters
    ----------
    eq
        The equilibrium.
    changes
        What each parameter changes.
    slopes
        Derivatives of the bearings' coefficients (coefs, n), by the parameters that have one.
    side
        "parted": a ball that just touches counts as parted.

    Raises
    ------
    ValueError
        Where a ball just touches, and no side is asked for; at a fold, and where a contact is lost, so that
        nothing resists the motion a parameter would cause.
    """
    system, B = eq.system, eq.system.B
    when: str | float = eq.modulus if eq.after is None else float(eq.after)
    moduli = system.static_moduli(when)
    kernels = [t.kernel() for t in system.bearings]
    ends = np.cumsum([0, *(len(k.order) for k in kernels)])
    z = [eq.bearings[t.name].z for t in system.bearings]
    carrying: list[Any] = []
    for term, kernel, at in zip(system.bearings, kernels, z, strict=True):
        touching = grazing(kernel, at)
        if touching.size and side != "parted":
            raise ValueError(
                f"ball {int(touching[0]) + 1} of bearing {term.name!r} just touches its races: its stiffness "
                f"begins there with an infinite slope, and a derivative has two sides; ask for "
                f"side='parted', which counts it as parted, or move clearance, load or angle a little"
            )
        on = tangent(kernel, at).approach.real > 0
        on[touching] = False
        carrying.append(on)
    stiff = diagonal_blocks(
        [tangent(k, a, None, c).K.real for k, a, c in zip(kernels, z, carrying, strict=True)]
    )
    Kt = system.stiffness(moduli) + B.T @ stiff @ B
    squares, T = natural(Kt, system.M)
    force = np.concatenate([np.zeros(0), *(eq.bearings[t.name].g for t in system.bearings)])
    free = T[:, squares <= 0.0]
    held = system.M @ free
    try:
        factors = scipy.linalg.cho_factor(Kt + HOLD * (held @ held.T))
    except np.linalg.LinAlgError:
        raise ValueError(
            f"the equilibrium is at a fold or beyond it (its lowest ω² is {squares[0]:.3g} 1/s²), and has no "
            f"derivative; take it on the side where the machine still stands, at a smaller load"
        ) from None
    x = np.zeros((len(changes), system.n))
    K, C = (np.zeros((len(changes), ends[-1], ends[-1])) for _ in range(2))
    for p, change in enumerate(changes.values()):
        push = np.zeros(system.n) if change.load is None else change.load.copy()
        if change.inertia is not None:
            push += _gravity(system, change.inertia)
        if change.K is not None:
            push -= change.K @ eq.x
        for k, H in change.H.items():
            push -= 2.0 * moduli[k] * (H @ eq.x)
        for (k, name), weight in change.shear.items():
            layer = system.layers[k]
            assert isinstance(layer.material, Maxwell)
            dG = weight * relaxation_slope(layer.material, name, when)
            push -= 2.0 * dG * (layer.L @ (layer.L.T @ eq.x))
        fields: list[dict[str, complex]] = [{} for _ in kernels]
        for i, weight in change.clearance.items():
            bearing = system.bearings[i].bearing
            assert isinstance(bearing, BallBearing)
            for name, slope in kernel_slope(bearing).items():
                fields[i][name] = getattr(kernels[i], name) + 1j * STEP * weight * slope
            moved = tangent(kernels[i], z[i].astype(np.complex128), fields[i], carrying[i])
            push -= B[ends[i] : ends[i + 1]].T @ moved.g.imag / STEP
        turned = slopes[p] @ eq.x if p in slopes else np.zeros(ends[-1])
        if p in slopes:
            push -= slopes[p].T @ force + B.T @ (stiff @ turned)
        _check_resisted(system, list(changes)[p], push, free)
        x[p] = scipy.linalg.cho_solve(factors, push)
        for i, kernel in enumerate(kernels):
            own = slice(ends[i], ends[i + 1])
            moved = tangent(kernel, z[i] + 1j * STEP * (B[own] @ x[p] + turned[own]), fields[i], carrying[i])
            K[p, own, own], C[p, own, own] = moved.K.imag / STEP, moved.C.imag / STEP
    return x, K, C


def _check_resisted(system: System, name: str, push: Array, free: Array) -> None:
    """Refuse a parameter that pushes along a motion that nothing resists; free (n, modes)."""
    if not free.shape[1]:
        return
    driven = np.abs(push @ free)
    worst = int(np.argmax(driven))
    if not driven[worst] > RESISTED * np.abs(push).max() * np.abs(free[:, worst]).max():
        return
    places = [(float(np.abs(rows @ free[:, worst]).max()), place) for place, rows in system.outputs.items()]
    raise ValueError(
        f"{name!r} pushes {max(places)[1]} along a motion that no ball or support resists here (a contact is "
        f"lost, or the state is a fold): the equilibrium has no derivative by it; press the balls more, hold "
        f"that motion by a spring, or take differences to the side on which a ball comes to carry"
    )


def _gravity(system: System, inertia: Array) -> Array:
    """What a change of the masses adds to the constant loads that are a field of gravity."""
    total = np.zeros(system.n)
    for load in system.loads:
        if load.kind == "constant" and not load.part and system.inertia is not None:
            field = np.linalg.lstsq(system.inertia, load.p_cos, rcond=None)[0]
            missed = np.abs(system.inertia @ field - load.p_cos).max()
            if missed <= 1e-9 * np.abs(load.p_cos).max():
                total += inertia @ field
    return total
