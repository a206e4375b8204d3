"""Stress relaxation: the modulus against time after a step of strain, isothermal."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.checks import vector
from bearingdyn.material.dma import DMAData, Mode
from bearingdyn.material.isotherms import group_isotherms
from bearingdyn.material.relaxation_spectrum import dense_times, solve_strengths
from bearingdyn.notice import UnlikelyModulus, warn
from bearingdyn.pictures import page
from bearingdyn.types import Array

_CONVERTED = (
    "relaxation modulus turned into storage and loss modulus at 1/(2πt) by a non-negative spectrum; within "
    "half a decade of either end of each isotherm the loss modulus is uncertain"
)
# a relaxation modulus over the least one before it: beyond the scatter of instruments, and beyond doubt
_NOISE, _RISES = 1.1, 1.5
_SPAN = 1e15  # longest over shortest time; a spectrum over more takes minutes and means nothing


def _none() -> Array:
    return np.empty(0)


@dataclass(frozen=True, eq=False, repr=False)
class RelaxationData(DMAData):
    """Relaxation modulus at times and temperatures, one value per point; made by :meth:`of`.

    It is a :class:`DMAData` too: storage and loss modulus at f = 1/(2πt) follow from a non-negative
    relaxation spectrum through each isotherm, so that isotherms at several temperatures superpose like
    sweeps. A single isotherm is fitted by :func:`fit_maxwell` in time, to what was measured.

    Parameters
    ----------
    time
        Time since the step of strain, s, (n,), positive.
    relaxation
        Relaxation modulus G(t) or E(t), Pa, (n,), positive.
    """

    time: Array = field(default_factory=_none)
    relaxation: Array = field(default_factory=_none)

    PER_POINT: ClassVar[tuple[str, ...]] = (*DMAData.PER_POINT, "time", "relaxation")

    _repr_html_ = page

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in ("time", "relaxation"):
            values = vector(
                f"{self.source}: {name}", getattr(self, name), (self.frequency.size,), "one per point"
            )
            if not np.all(values > 0):
                i = int(np.argmin(values > 0))
                raise ValueError(f"{self.source}: {name}[{i}] is {values[i]:g}; it must be positive")
            self._store(name, values)

    @classmethod
    def of(
        cls,
        time: ArrayLike,
        relaxation: ArrayLike,
        temperature: ArrayLike,
        mode: Mode,
        *,
        source: str = "arrays",
        isotherm: NDArray[np.int64] | None = None,
        notes: tuple[str, ...] = (),
        run: NDArray[np.str_] | None = None,
    ) -> Self:
        """Times, s, and relaxation moduli, Pa, (n,), at a temperature, °C, or one per point.

        Raises
        ------
        ValueError
            If a time or modulus is not positive, lengths differ, the modulus of an isotherm rises by more
            than half, or as :class:`DMAData`.

        Warns
        -----
        UnlikelyModulus
            Where it rises by more than a tenth.

        Examples
        --------
        >>> import bearingdyn as bd, numpy as np
        >>> true = bd.Maxwell(1e6, [2e6], [0.1], K=2e9, density=1100.0)
        >>> t = np.geomspace(1e-3, 10, 30)
        >>> data = bd.RelaxationData.of(t, true.relaxation(t), 20.0, "shear")
        >>> found = bd.fit_maxwell(data, n=1, K=2e9, density=1100.0)
        >>> round(found.G0 / 1e6, 4), round(float(found.tau[0]), 4)
        (1.0, 0.1)
        """
        t = np.atleast_1d(np.asarray(time, dtype=np.float64))
        g = vector(f"{source}: relaxation", relaxation, t.shape, "as many as there are times")
        if not (np.all(t > 0) and np.all(np.isfinite(t)) and np.all(g > 0)):
            bad = int(np.argmin((t > 0) & np.isfinite(t) & (g > 0)))
            raise ValueError(
                f"{source}: at time {t[bad]:g} s the relaxation modulus is {g[bad]:g} Pa; both must be "
                "positive"
            )
        if not t.max() <= _SPAN * t.min():
            raise ValueError(
                f"{source}: times from {t.min():g} to {t.max():g} s: no relaxation is measured over more "
                f"than {_SPAN:g} in time; is a time wrong?"
            )
        _check_fall(source, t, g, temperature, run)
        T = np.broadcast_to(np.asarray(temperature, dtype=np.float64), t.shape).copy()
        labels = group_isotherms(T, run) if isotherm is None else isotherm
        modulus = np.zeros(t.size, dtype=np.complex128)
        for k in np.unique(labels):
            own = labels == k
            modulus[own] = _converted(t[own], g[own])
        return cls(
            1 / (2 * np.pi * t),
            T,
            modulus.real,
            modulus.imag,
            mode,
            source,
            labels,
            (*notes, _CONVERTED),
            run=run,
            time=t,
            relaxation=g,
        )


def _check_fall(
    source: str, t: Array, g: Array, temperature: ArrayLike, run: NDArray[np.str_] | None
) -> None:
    """Check that the relaxation modulus of each isotherm falls, as that of every passive material does."""
    T = np.broadcast_to(np.asarray(temperature, dtype=np.float64), t.shape)
    labels = group_isotherms(T, run)
    for k in np.unique(labels):
        own = np.flatnonzero(labels == k)
        own = own[np.argsort(t[own], kind="stable")]
        least = np.minimum.accumulate(g[own])
        rise = g[own] / least
        j = int(np.argmax(rise))
        if not rise[j] > _NOISE:
            continue
        first = own[int(np.flatnonzero(g[own[: j + 1]] == least[j])[-1])]
        text = (
            f"{source}: at {T[own[j]]:g} °C the relaxation modulus rises from {g[first]:.4g} Pa at "
            f"{t[first]:.4g} s to {g[own[j]]:.4g} Pa at {t[own[j]]:.4g} s; it must fall with time: is it a "
            "creep compliance, or time in another order, or two runs in one"
        )
        if rise[j] > _RISES:
            raise ValueError(f"{text}?")
        warn(f"{text}? As noise it is {rise[j] - 1:.0%}", UnlikelyModulus)


def _converted(t: Array, g: Array) -> NDArray[np.complex128]:
    """Complex modulus at ω = 1/t of the non-negative spectrum nearest to G(t), relatively."""
    tau = dense_times(float(1 / t.max()), float(1 / t.min()), 6, 0.5)
    A = np.hstack([np.ones((t.size, 1)), np.exp(-t[:, None] / tau)]) / g[:, None]
    x = solve_strengths(A, np.ones(t.size)).x
    z = 1j * tau / t[:, None]
    return np.asarray(x[0] + (z / (1 + z)) @ x[1:])
