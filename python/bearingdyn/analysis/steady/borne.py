"""What the bearings bore along steady motions: loads over their rating, an open side, or nothing at all."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bearingdyn.analysis.equilibrium import PARTED
from bearingdyn.analysis.overload import warn_of_peak
from bearingdyn.analysis.steady.balance import Balance, Pressed
from bearingdyn.bearing import OPEN_SIDE_REMEDY, samples_off
from bearingdyn.notice import NothingPushes, OpenSideWarning, OutsideBand, warn
from bearingdyn.system import BearingTerm, System
from bearingdyn.types import Array, Complex

COUNTS = 0.01
"""Of the largest displacement or velocity of a layer: lines below are not told of."""
Borne: TypeAlias = tuple[Balance, Complex, str, Pressed | None]
"""A motion that was borne: its balance, amplitudes, which it is, and what the balls do along it if known."""
PUSH = "Add what pushes (app.gravity, app.load, app.unbalance)"


@dataclass
class _Worst:
    """Of one bearing: the largest load of a ball, N, and the first motion that pressed its open side."""

    term: BearingTerm
    peak: float = 0.0
    where: str = ""
    open_where: str = ""
    share: float = 0.0


def warn_of_band(system: System, omega: Array, x: Complex) -> None:
    """Warn of what layers have borne in a steady motion: lines that count, outside their material's band.

    Parameters
    ----------
    system
        With its layers.
    omega, x
        Lines (L,), rad/s, the mean first, and amplitudes (L, n) of the coordinates.

    Warns
    -----
    OutsideBand
        Once: it names the layers, and the lines of more than 1 % of the largest displacement or velocity.
    """
    found, lines = dict[str, tuple[float, float]](), []
    f = np.abs(omega[1:]) / (2 * np.pi)
    for layer in system.layers:
        band = getattr(layer.material, "band", None)
        size = np.sqrt((np.abs(x[1:] @ layer.L) ** 2).sum(axis=1))
        if band is None or not size.any():
            continue
        counts = (size > COUNTS * size.max()) | (f * size > COUNTS * (f * size).max())
        far = f[counts & ((f < band[0]) | (f > band[1]))]
        if far.size:
            found[layer.part] = band
            lines += far.tolist()
    if found:
        part, band = next(iter(found.items()))
        warn(
            f"{', '.join(map(repr, found))} moves at {min(lines):.4g} to {max(lines):.4g} Hz in this motion, "
            f"{len(set(lines))} lines outside of the band that the material of {part!r} is good for, "
            f"{band[0]:.4g} to {band[1]:.4g} Hz: there it extrapolates",
            OutsideBand,
        )


def pushed(balance: Balance, pressed: Pressed) -> bool:
    """Whether anything is borne in a steady motion: a load acts, or a ball is pressed."""
    loaded = any((along.loads > PARTED).any() for along in pressed.bearings)
    return loaded or any(force.any() for _, force in balance.loads)


def warn_of_motions(motions: Iterable[Borne]) -> None:
    """Warn of what bearings have borne along steady motions, once for each bearing.

    Parameters
    ----------
    motions
        Balance, amplitudes (L, m), m, which motion it is, such as "at 100 rad/s", and what the balls do
        along it, if that is known.

    Warns
    -----
    BearingWarning
        Where the contact pressure of a ball exceeds 4.2 GPa (ISO 76); the heaviest ball of all motions.
    OpenSideWarning
        Where balls of an angular contact bearing are pressed where it has no shoulder, or none onto it.
    NothingPushes
        Where no ball is pressed along a motion, and no load acts.
    """
    worst: dict[str, _Worst] = {}
    for balance, z, where, known in motions:
        pressed = known or balance.press(z, tangents=False)
        if not pushed(balance, pressed):
            warn(
                f"nothing pushes {where}: no ball is pressed along the motion, and no load acts; every "
                f"amplitude is zero. {PUSH}",
                NothingPushes,
            )
        moved = balance.lines.signals(z)
        for term, own, along, (angles, _) in zip(
            balance.system.bearings, balance.slots, pressed.bearings, balance.bodies, strict=True
        ):
            held = worst.setdefault(term.name, _Worst(term))
            peak = float(along.loads.max(initial=0.0))
            if peak > held.peak:
                held.term, held.peak, held.where = term, peak, where
            off = samples_off(term.kernel(), moved[:, own], along.loads, angles[:, 0])
            if off.any() and not held.open_where:
                held.open_where, held.share = where, float(np.mean(off))
    for name, held in worst.items():
        warn_of_peak(held.term, held.peak, held.where)
        if held.open_where:
            warn(
                f"bearing {name!r}: {held.open_where}, for {held.share:.2g} of the time, balls are pressed "
                f"onto its open side, where no shoulder holds them, or none of them onto its shoulder; "
                f"{OPEN_SIDE_REMEDY}",
                OpenSideWarning,
            )
