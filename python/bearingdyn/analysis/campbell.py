"""Natural frequencies over the speed of the shaft: the Campbell diagram."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy.optimize
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.mode_directions import directions
from bearingdyn.analysis.mode_whirl import whirl
from bearingdyn.analysis.modes import modes
from bearingdyn.application import Application
from bearingdyn.checks import numbers, one_speed, truth, whole
from bearingdyn.system import System, system_of
from bearingdyn.types import Array, Complex, Index
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


# further modes followed, so that one that comes into the lowest `count` is known from where it came
MARGIN = 12
# what an octave between two frequencies costs of the modes' assurance: it decides where shapes do not
OCTAVE = 0.1
DOUBLE = 1e-6  # relative distance of two frequencies that are one but for round-off, 1e-16 of the highest λ²


@takes(speeds="rad/s")
def campbell(
    source: Equilibrium | Application | System,
    speeds: ArrayLike | None = None,
    count: int = 12,
    *,
    damped: bool = True,
    modulus: str = "relaxed",
    rpm: ArrayLike | None = None,
) -> xarray.Dataset:
    """Find the Campbell diagram: the modes at each speed, followed from speed to speed by their shapes.

    The bearings keep the tangents of the equilibrium. Modes that are double at standstill are distinct at
    speed, where gyroscopic forces part them: they are therefore followed from the highest speed down, by the
    modal assurance criterion weighted with the mass.

    Parameters
    ----------
    source
        As in `modes`.
    speeds
        (s,) rad/s of the shaft.
    count
        How many modes: the lowest ones at the lowest speed.
    damped, modulus
        As in `modes`.
    rpm
        The speeds in revolutions a minute, instead of `speeds`.

    Returns
    -------
    xarray.Dataset
        Over (speed, mode): frequency (Hz, |λ|/2π); damping_ratio; eigenvalue (rad/s); whirl of the parts that
        turn (of all parts, if none turns): +1 a circle in the sense of the shaft, from x to y, −1 a circle
        against it, 0 a line; mac, the modal assurance to the same mode at the next higher speed, 0 … 1. Over
        "mode": direction, "lateral", "axial" or "torsional", in which the parts that turn move most at the
        lowest speed.

    Raises
    ------
    ValueError
        For speeds that are not finite, a count below 1, and as `modes`.
    """
    given = numbers(
        "speeds", one_speed(speeds, rpm, what="speeds"), "speeds must be one or more finite values, in rad/s"
    )
    count, damped = whole("count", count, 1), truth("damped", damped)
    if not isinstance(source, Equilibrium):
        source = system_of("source", source)
    system = source.system if isinstance(source, Equilibrium) else source

    order = np.argsort(-np.abs(given), kind="stable")
    values: list[Complex] = [np.zeros(0, dtype=np.complex128)] * given.size
    shapes: list[Complex] = [np.zeros((0, 0), dtype=np.complex128)] * given.size
    assurance = [np.zeros(0)] * given.size
    above = None
    for i in order:
        pool = count + MARGIN * (1 if above is None else 2)
        found = modes(source, pool, speed=float(given[i]), damped=damped, modulus=modulus)
        value, shape = found["eigenvalue"].values, found["shape"].values
        if above is None:
            values[i], shapes[i], assurance[i] = value, shape, np.ones(value.size)
        else:
            mac = _assurance(system.M, shapes[above], shape)
            with np.errstate(divide="ignore"):
                apart = np.abs(np.log2(np.abs(values[above])[:, None] / np.abs(value)[None, :]))
            score = mac - OCTAVE * np.minimum(np.nan_to_num(apart, nan=0.0), 10.0)
            row, column = scipy.optimize.linear_sum_assignment(-score)
            values[i], shapes[i] = value[column], shape[column]
            assurance[i] = mac[row, column]
            if row.size < len(values[above]):  # fewer modes swing here than above: drop those that ended
                for j in order[: int(np.flatnonzero(order == i)[0])]:
                    values[j], shapes[j], assurance[j] = values[j][row], shapes[j][row], assurance[j][row]
        above = i
    slowest = order[-1]
    keep = _lowest(np.abs(values[slowest]), np.abs(values[order[0]]))[:count]
    eigenvalue = np.array([v[keep] for v in values])
    size = np.abs(eigenvalue)

    from bearingdyn.results import dataset, inputs_of

    over = ("speed", "mode")
    return dataset(
        {
            "frequency": (over, size / (2 * np.pi), "Hz", "undamped natural frequency |λ|/2π"),
            "damping_ratio": (
                over,
                np.divide(-eigenvalue.real, size, out=np.zeros_like(size), where=size > 0),
                "1",
                "−Re λ/|λ|",
            ),
            "eigenvalue": (over, eigenvalue, "rad/s", "λ of exp(λt)"),
            "whirl": (
                over,
                np.array([whirl(system, s[keep]) for s in shapes]),
                "1",
                "+1 forward circle, −1 backward circle, 0 a line",
            ),
            "mac": (
                over,
                np.array([a[keep] for a in assurance]),
                "1",
                "modal assurance criterion with the next higher speed",
            ),
            "direction": (
                "mode",
                directions(system, shapes[slowest][keep]),
                "",
                "which way the parts that turn move most, at the lowest speed",
            ),
        },
        {
            "analysis": "Campbell diagram",
            "damped": int(damped),
            "modulus": modulus,
            **state_of(source),
            **inputs_of(system.inputs),
        },
        {"speed": (given, "rad/s")},
    )


def _lowest(slowest: Array, fastest: Array) -> Index:
    """The order of modes, by their frequencies at the lowest speed; double ones by those at the highest.

    Which of two is lower by round-off would depend on the machine, and with it the one that `count` cuts off.
    """
    order = np.argsort(slowest, kind="stable")
    rising = slowest[order]
    rank = np.empty(order.size, dtype=np.intp)
    rank[order] = np.cumsum(np.diff(rising, prepend=rising[:1]) > DOUBLE * rising)
    return np.lexsort((fastest, rank))


def _assurance(M: Array, a: Complex, b: Complex) -> Array:
    """Modal assurance criterion (a, b) of shapes (a, n) and (b, n), the mass as weight."""
    cross = np.abs(a.conj() @ M @ b.T) ** 2
    own = [np.einsum("mi,ij,mj->m", s.conj(), M, s).real for s in (a, b)]
    return np.asarray(cross / np.outer(*own))
