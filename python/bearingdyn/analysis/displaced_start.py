"""Whether the step of a march follows the swings that a displaced start lets go, said before it runs."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.step_size import SHARE, modal_decays, rounded_down
from bearingdyn.application import QUANTITIES, Channel
from bearingdyn.material import answer_of
from bearingdyn.notice import CoarseStep, OutsideBand, untold, warn
from bearingdyn.system import System, natural
from bearingdyn.types import Array

# of a channel's swing (rms over the modes) that modes too fast for the step may carry: 1 % of its power
CARRIED = 0.1


def warn_if_start_is_coarse(
    source: Equilibrium | System, dt: float, displaced: Array, rows: Mapping[str, Array], settled: float
) -> None:
    """Warn of a step too coarse for a displaced start: modes with fewer than twenty steps carry its swing.

    Modes are those of the structure on the balls' tangents, with layers as stiff as they are at the frequency
    that the step just follows.

    Parameters
    ----------
    source
        What marches: an equilibrium, or a system at zero.
    dt
        Step, s.
    displaced
        Displacement (n,) of the start from rest, in the system's own coordinates.
    rows
        Row (n,) of each recorded motion, by its channel's name.
    settled
        Time before the record begins, s, in which swings decay.
    """
    system = source.system if isinstance(source, Equilibrium) else source
    fastest = 2 * math.pi * SHARE / dt
    with untold(OutsideBand):
        moduli = [
            float(answer_of(t.material if t.strain is None else t.material.rest, np.array([fastest]))[0].real)
            for t in system.layers
        ]
    K = system.stiffness(moduli)
    if isinstance(source, Equilibrium):
        K = K + system.B.T @ source.bearing_K @ system.B
    squares, shapes = natural(K, system.M)
    moving = squares > 0.0
    omega, shapes = np.sqrt(squares[moving]), shapes[:, moving]
    if not (fast := omega > fastest).any():
        return
    swing = np.abs(shapes.T @ (system.M @ displaced))
    if settled > 0.0:
        contacts = source.bearing_C if isinstance(source, Equilibrium) else None
        swing *= np.exp(-np.maximum(modal_decays(system, contacts, omega, shapes), 0.0) * settled)
    told, enough = [], dt
    for name, row in rows.items():
        order = QUANTITIES.index(Channel.parse(name).quantity or QUANTITIES[0])
        reach = row @ shapes * swing
        power = (reach * omega**order) ** 2
        # what only round-off moves has no swing
        if (
            np.abs(reach).max() < 1e-9 * np.abs(displaced).max()
            or not power[fast].sum() > CARRIED**2 * power.sum()
        ):
            continue
        told.append(f"{name} {100 * math.sqrt(power[fast].sum() / power.sum()):.0f} %")
        above = np.cumsum(power[::-1])[::-1]  # of each mode and those faster than it
        quick = omega[above > CARRIED**2 * power.sum()][-1]
        enough = min(enough, rounded_down(2 * math.pi * SHARE / quick))
    if told:
        warn(
            f"dt = {dt:g} s is too coarse for the start that initial= gives: modes from "
            f"{omega[fast][0] / (2 * math.pi):.4g} Hz on have fewer than twenty steps a period, and carry of "
            f"the swing of {', '.join(told[:8])}{' and others' if len(told) > 8 else ''}; march with "
            f"dt={enough:g} or less, with method='exact', or start from a place that a load would give",
            CoarseStep,
        )
