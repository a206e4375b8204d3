"""A Maxwell model with few branches fitted to a master curve.

The dense non-negative spectrum, merged to n branches, is polished on the deviations of ln G′ and ln tan δ,
which are what the user is told. Where branches are left over, those that help most are added. Where n are too
few for the data, the times are sought by variable projection too, from fixed starts: the relative deviations
of G′ and G″, the strengths being a non-negative least-squares problem inside. The best of all is taken.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from bearingdyn.checks import named, positive, require, truth, two, whole
from bearingdyn.material.dma import DMAData
from bearingdyn.material.fit_report import FitReport, OutsideBand
from bearingdyn.material.identification.bounds import Limits
from bearingdyn.material.identification.fit_relaxation import fit_relaxation, warn_of_fewer
from bearingdyn.material.identification.low_end_of_fit import low_end
from bearingdyn.material.identification.points_in_band import Points
from bearingdyn.material.identification.polish import Polished, polish
from bearingdyn.material.identification.projection import Projection
from bearingdyn.material.identification.spectrum_start import merged_spectrum, most_useful
from bearingdyn.material.low_end import SLACK
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.relaxation_data import RelaxationData
from bearingdyn.material.shear_from_tension import shear_modulus
from bearingdyn.material.superposition import MasterCurve, one_curve
from bearingdyn.notice import CoarseModel, TensionAsShear, warn
from bearingdyn.plausible_ranges import check_bulk
from bearingdyn.types import Array

MOST_BRANCHES = 200
_MOST = 20  # branches tried by n = "auto"
_SPREADS = (0.0, 0.4)  # decades by which the starts are wider than the band
# Shares of the sum of squares; its own standard error is sqrt(2 / points), some tens of per cent. A gain
# below the first is no reason for a branch more; of fits closer than the second the first is taken: where the
# later ones end may hang on the last bits of the arithmetic.
_WORTH = 1e-4
_TIE = 2e-3


def fit_maxwell(
    master: MasterCurve | DMAData,
    n: int | Literal["auto"] = 5,
    band: tuple[float, float] | None = None,
    *,
    K: float,
    density: float,
    dashpot: bool = True,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    fixed: Mapping[str, float] | None = None,
    tolerance: float = 0.02,
    bootstrap: int = 0,
    pin: float | Sequence[float] | None = None,
) -> Maxwell:
    """Fit a Maxwell model to the points of a master curve inside a band: spring, n branches and dashpot.

    Parameters
    ----------
    master
        Master curve, or a single sweep as it was read (a supplier's finished curve, one temperature): then
        the model has no shift law. RelaxationData of one temperature is fitted in time, by least squares of
        ln G(t), without dashpot; `fit` then reports G(t) as storage, and of `bounds`, `fixed` and `bootstrap`
        only fixed={"G0": ...} is offered. A curve measured in tension is turned into shear by G* = 3KE*/(9K
        − E*) with the K below, and a warning says so; :meth:`MasterCurve.to_shear` beforehand is silent.
    n
        Number of branches; those to which the data give no strength are left out of the result, with a
        warning.
        "auto": the smallest number whose rms deviations of G′ and of tan δ are within `tolerance`, or
        within 1.2 times what the best dense spectrum leaves.
    band
        Lowest and highest frequency at T_ref, Hz; all points when not given.
    K
        Bulk modulus, Pa.
    density
        Mass density, kg/m³.
    dashpot
        Whether η0 is fitted too; otherwise it is zero.
    bounds, fixed
        Ranges and values of parameters by name: G0, G1 …, tau1 …, eta0, in SI units. Branches are numbered
        by rising time at the start; the result is sorted. fixed={"G0": 0.0} is a fluid.
    tolerance
        Relative rms deviation that is good enough for n="auto".
    bootstrap
        Number of refits to isotherms drawn with replacement, for standard errors that know of the
        correlation within isotherms. Shifts are kept; the draws are the same every time.
    pin
        Hold the low end: a time, s, and the relaxation modulus, Pa, that the model shall have there, from a
        relaxation test or a static one, say; a time alone takes the modulus from the whole master curve, its
        points below the band too. It is for models that live in a band far above the load's duration: few
        branches, and the right sag. A pin ten times later than the points reach is the relaxed modulus:
        branches may relax up to a tenth of its time.

    Returns
    -------
    Maxwell
        Relaxation times rising; `fit` reports the errors inside the band, the covariance, and in `low_end`
        what the points say of long times; `law` is the master curve's, so that ``.at(T)`` works. The same
        data give the same model, bit for bit.

    Raises
    ------
    ValueError
        If the band is empty or holds too few points, a value is out of range, or a pin lies at a time that
        the master curve does not reach and has no modulus.

    Warns
    -----
    FewerBranches
        Where the data hold fewer branches than n.
    CoarseModel
        Where n="auto" finds no number that is within the tolerance.
    TensionAsShear
        Where a curve was measured in tension.

    References
    ----------
    Paper §3.2, eqs 18 and 19.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> curve = bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)
    >>> rubber = bd.fit_maxwell(curve, n=5, band=(1.0, 5e3), K=2e9, density=1150.0)
    >>> rubber.G.size, rubber.fit.storage_rms < 0.02
    (5, True)
    """
    remedy = "the number of branches must be a positive integer, or 'auto'"
    dashpot = truth("dashpot", dashpot)
    some = isinstance(n, int) and not isinstance(n, bool) and 1 <= n <= MOST_BRANCHES
    require(some or (isinstance(n, str) and n == "auto"), "n", n, remedy)
    K, density = positive("K", K), positive("density", density)
    positive("tolerance", tolerance)
    remedy = "it is a share of the moduli, such as 0.02; was it in per cent?"
    require(tolerance <= 0.5, "tolerance", tolerance, remedy)
    remedy = "the number of refits must be zero or a positive integer"
    require(isinstance(bootstrap, int) and 0 <= bootstrap <= 10_000, "bootstrap", bootstrap, remedy)
    if isinstance(master, RelaxationData):
        require(not bounds, "bounds", bounds, "a fit to relaxation takes none")
        require(not bootstrap, "bootstrap", bootstrap, "a fit to relaxation has one isotherm; leave it out")
        require(pin is None, "pin", pin, "a fit to relaxation reaches as far down as its data; leave it out")
        return fit_relaxation(master, n, band, K=K, density=density, fixed=fixed, tolerance=tolerance)
    master = one_curve(master)
    fixed = named(
        "fixed", {} if fixed is None else fixed, "it must be a mapping, parameter -> value, or None"
    )
    bounds = named(
        "bounds",
        {} if bounds is None else bounds,
        "it must be a mapping, parameter -> (lowest, highest), or None",
    )
    points = replace(_inside(master, band, K, 1 if n == "auto" else n), pin=_pinned(master, K, pin))
    held = dict(fixed) | ({} if dashpot else {"eta0": 0.0})
    limits = {k: v for k, v in bounds.items() if dashpot or k != "eta0"}
    floor = points.floor()
    if n == "auto":
        best, bound = _smallest(points, limits, held, tolerance, floor)
    else:
        bound = Limits.of(n, points.limits, limits, held)
        best = _best(points, bound)
    warn_of_fewer(n, best.tau.size)
    return Maxwell(
        float(best.strengths[0]),
        best.strengths[1:-1],
        best.tau,
        float(best.strengths[-1]),
        K=K,
        density=density,
        law=master.law,
        temperature=master.T_ref,
        vertical=master.vertical,
        fit=_report(points, best, floor, _refits(points, best, bound, bootstrap), float(master.frequency[0])),
    )


def fit_dense(
    master: MasterCurve | DMAData,
    band: tuple[float, float] | None = None,
    *,
    K: float,
    density: float,
    per_decade: int = 12,
) -> Maxwell:
    """Fit of a master curve by a dense spectrum: spring, branches at times equispaced in the logarithm.

    Non-negative least squares of the deviations of G′ and tan δ, to first order; branches without strength
    are left out. No Maxwell model with non-negative strengths does much better; `fit` says how well, without
    covariance, since such strengths are not determined one by one.

    Parameters
    ----------
    master, band, K, density
        As for :func:`fit_maxwell`.
    per_decade
        Relaxation times per decade.

    Returns
    -------
    Maxwell
        As many branches as have strength, times rising; `law` is the master curve's.

    Raises
    ------
    ValueError
        As :func:`fit_maxwell`.
    """
    K, density = positive("K", K), positive("density", density)
    per_decade = whole("per_decade", per_decade, 1, 1000)
    master = one_curve(master)
    points = _inside(master, band, K, "dense")
    times, x = points.dense(per_decade)
    model = Maxwell(float(x[0]), x[1:-1], times, float(x[-1]), K=K, density=density)
    storage, tan = points.deviations(model.complex_modulus(points.omega))
    rms = [float(np.sqrt(np.mean(r**2))) for r in (storage, tan)]
    report = FitReport(
        points.band,
        _covered(points),
        points.omega.size,
        rms[0],
        float(np.abs(storage).max()),
        rms[1],
        float(np.abs(tan).max()),
        (),
        np.empty((0, 0)),
        (rms[0], rms[1]),
        low_end=low_end(points, float(x[0]), storage, float(master.frequency[0])),
    )
    used = x[1:-1] > 0
    return Maxwell(
        float(x[0]),
        x[1:-1][used],
        times[used],
        float(x[-1]),
        K=K,
        density=density,
        law=master.law,
        temperature=master.T_ref,
        vertical=master.vertical,
        fit=report,
    )


def _covered(points: Points) -> tuple[float, float]:
    """Lowest and highest frequency of the points, Hz."""
    f = points.omega / (2 * np.pi)
    return float(f.min()), float(f.max())


def _best(points: Points, limits: Limits) -> Polished:
    """The best fit with n branches, by a path that the last bits of the data do not turn."""
    found = polish(points, limits, *merged_spectrum(points, limits))
    found, settled = _completed(points, limits, found)
    if settled:
        return found
    others = [polish(points, limits, *Projection(points, limits).run(spread)) for spread in _SPREADS]
    tried = [found, *others]
    least = min(fit.cost for fit in tried)
    return next(fit for fit in tried if (1 - _TIE) * fit.cost <= least)


def _completed(points: Points, limits: Limits, fit: Polished) -> tuple[Polished, bool]:
    """The fit with the branches, spring or dashpot it lacks, and whether nothing more would help it."""
    while limits.plain:
        gain, tau, strengths = most_useful(points, fit, limits)
        if not gain > _WORTH:
            return fit, True
        if tau.size > limits.log_lower.size:
            return fit, False
        more = polish(points, limits.alike(tau.size), tau, strengths)
        if not more.cost < (1 - _WORTH / 10) * fit.cost:
            return fit, True
        fit = more
    return fit, False


def _smallest(
    points: Points,
    bounds: Mapping[str, tuple[float, float]],
    fixed: Mapping[str, float],
    tolerance: float,
    floor: tuple[float, float],
) -> tuple[Polished, Limits]:
    """The fit with the fewest branches that is good enough, with a warning if none is."""
    named = [int(k.lstrip("Gtau")) for k in (*bounds, *fixed) if k.lstrip("Gtau").isdigit()]
    most = max(min(_MOST, points.omega.size - 2), 1)
    best: tuple[float, Polished, Limits] | None = None
    for n in range(max([1, *named]), max([most, *named]) + 1):
        limits = Limits.of(n, points.limits, bounds, fixed)
        found = _best(points, limits)
        storage, tan = (float(np.sqrt(np.mean(r**2))) for r in found.deviations)
        excess = max(storage / max(tolerance, 1.2 * floor[0]), tan / max(tolerance, 1.2 * floor[1]))
        if best is None or excess < best[0]:
            best = excess, found, limits
        if excess <= 1:
            return found, limits
    assert best is not None  # at least one number was tried
    warn(
        f"n = 'auto': no number of branches up to {most} comes within the tolerance of {tolerance:g} or 1.2 "
        f"times the floor {floor[0]:.3g}, {floor[1]:.3g}; the best is {best[0]:.2g} times that",
        CoarseModel,
    )
    return best[1], best[2]


def _pinned(master: MasterCurve, K: float, pin: float | Sequence[float] | None) -> tuple[float, float] | None:
    """Time, s, and modulus, Pa, of a pin; of a time alone by the best dense spectrum of the whole curve."""
    if pin is None:
        return None
    given = list(pin) if isinstance(pin, Sequence) and not isinstance(pin, bytes) else [pin]
    remedy = "it must be a time, or a time and a modulus, both positive and finite, s and Pa"
    require(len(given) in (1, 2) and not isinstance(pin, str), "pin", pin, remedy)
    time, *modulus = (positive("pin", value, remedy) for value in given)
    if modulus:
        return time, modulus[0]
    reach = 1 / (2 * math.pi * float(master.frequency[0]))
    require(
        time <= SLACK * reach,
        "pin",
        pin,
        f"the master curve reaches {reach:.4g} s; for longer times give the modulus too, pin=(time, modulus)",
    )
    tau, x = _points(master, np.ones(master.frequency.size, dtype=np.bool_), K)[0].dense()
    return time, float(x[0] + np.exp(-time / tau) @ x[1:-1])


def _inside(master: MasterCurve, band: tuple[float, float] | None, K: float, n: int | str) -> Points:
    """The points inside the band, in shear."""
    low, high = float(master.frequency[0]), float(master.frequency[-1])
    if band is None:
        band = (low, high)
    f_lo, f_hi = two("band", band, "it must be a lower and a higher frequency, both positive, Hz")
    if not 0 < f_lo < f_hi < math.inf:
        raise ValueError(f"band is {band!r} Hz; it must be a lower and a higher frequency, both positive")
    keep = (master.frequency >= f_lo) & (master.frequency <= f_hi)
    count = int(np.count_nonzero(keep))
    needed = n + 2 if isinstance(n, int) else 3
    if not count >= needed:
        raise ValueError(
            f"band is {f_lo:g} to {f_hi:g} Hz; it holds {count} points of the master curve, which reaches "
            f"from {low:.4g} to {high:.4g} Hz; {n} branches need at least {needed}"
        )
    if not (f_lo >= 0.5 * low and f_hi <= 2 * high):
        warn(
            f"band is {f_lo:g} to {f_hi:g} Hz, which goes beyond the master curve, {low:.4g} to {high:.4g} "
            "Hz: no point was measured outside it, and the model's band is cut to twice beyond it",
            OutsideBand,
        )
        f_lo, f_hi = max(f_lo, 0.5 * low), min(f_hi, 2 * high)
    points, note = _points(master, keep, K)
    if note:
        warn(f"{note}; master.to_shear(K=...) or to_shear(nu=...) beforehand", TensionAsShear)
    return replace(points, band=(f_lo, f_hi))


def _points(master: MasterCurve, keep: NDArray[np.bool_], K: float) -> tuple[Points, str]:
    """Points of a master curve in shear, and what was converted for it."""
    modulus, note = master.storage[keep] + 1j * master.loss[keep], ""
    if master.mode == "tension":
        modulus, note = shear_modulus(modulus, K, None)
    elif master.K is not None and not math.isclose(master.K, K, rel_tol=1e-6):
        raise ValueError(
            f"K is {K:g} Pa; the curve was turned into shear with K = {master.K:g} Pa; both must be the same"
        )
    check_bulk("K", K, float(np.abs(modulus).max()))
    T = master.temperature[keep]
    if master.shifts:
        means = np.array(list(master.shifts))
        isotherm = np.argmin(np.abs(T[:, None] - means), axis=1).astype(np.int64)
    else:
        isotherm = np.unique(T, return_inverse=True)[1].reshape(-1).astype(np.int64)
    omega = 2 * np.pi * master.frequency[keep]
    band = (float(master.frequency[0]), float(master.frequency[-1]))
    return Points(omega, modulus.real, modulus.imag, isotherm, band), note


def _refits(points: Points, best: Polished, limits: Limits, count: int) -> Array:
    """Parameters, in the order of the names, of refits to isotherms drawn with replacement; (count, p)."""
    kinds = np.unique(points.isotherm)
    if count and kinds.size < 3:
        raise ValueError(
            f"bootstrap is {count}; it needs points of three isotherms, the band holds {kinds.size}"
        )
    rng = np.random.default_rng(0)
    found: list[Array] = []
    tries = 0
    while len(found) < count and tries < 10 * count:
        tries += 1
        drawn = rng.choice(kinds, kinds.size)
        index = np.concatenate([np.flatnonzero(points.isotherm == k) for k in drawn])
        if index.size < best.theta.size // 2 + 1 or np.unique(drawn).size < 2:
            continue
        again = polish(points.take(index), limits.alike(best.tau.size), best.tau, best.strengths)
        if again.names == best.names:
            found.append(again.theta)
    return np.array(found).reshape(len(found), best.theta.size)


def _report(
    points: Points, best: Polished, floor: tuple[float, float], refits: Array, measured: float
) -> FitReport:
    """Errors inside the band, covariance, bootstrap, and the low end; the curve's lowest frequency, Hz."""
    J = best.jacobian
    freedom = max(1, J.shape[0] - J.shape[1])
    covariance = float(best.residual @ best.residual) / freedom * np.linalg.pinv(J.T @ J)
    storage, tan_delta = best.deviations
    return FitReport(
        points.band,
        _covered(points),
        points.omega.size,
        float(np.sqrt(np.mean(storage**2))),
        float(np.abs(storage).max()),
        float(np.sqrt(np.mean(tan_delta**2))),
        float(np.abs(tan_delta).max()),
        best.names,
        covariance,
        floor,
        refits,
        low_end(points, float(best.strengths[0]), storage, measured),
    )
