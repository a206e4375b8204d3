"""How far the parameters of a Maxwell model may be off, and models drawn from that."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.checks import name_list, nonnegative, real, reals, require
from bearingdyn.material.log_parameters import moved, place_of
from bearingdyn.material.random_numbers import normals
from bearingdyn.plausible_ranges import plausible
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

if TYPE_CHECKING:
    from bearingdyn.material.fit_report import FitReport

# sd of a logarithm before any data: where they do not tell a branch, a draw leaves it within this
PRIOR = 1.0
# of the largest standard deviation: round-off of a covariance
NOTHING = 1e-7
STEPS, MET = 25, 1e-5


def _none() -> Array:
    return np.zeros((0, 0))


@dataclass(frozen=True, eq=False)
class Spread:
    """The spread of a Maxwell model's parameters about their values: what a fit or a laboratory leaves open.

    Parameters
    ----------
    names
        Logarithms of parameters that are known together: ln G0, ln G1 …, ln tau1 …, ln eta0.
    covariance
        (len(names), len(names)) of these, as a fit leaves it.
    level
        Relative standard deviation of all strengths together: what another sample, another clamp or another
        laboratory makes of the level of a DMA.
    K
        Relative standard deviation of the bulk modulus, which DMA does not measure.
    temperature
        Standard deviation of the temperature, °C; the material needs a shift law.

    Raises
    ------
    ValueError
        For a covariance that is none, a name that is no parameter's, or a negative deviation.
    """

    names: tuple[str, ...] = ()
    covariance: Array = field(default_factory=_none, repr=False)
    level: float = 0.0
    K: float = 0.0
    temperature: float = 0.0

    __repr__ = short

    def __post_init__(self) -> None:
        names = tuple(name_list("Spread.names", self.names, "parameters"))
        for name in names:
            plain = name.removeprefix("ln ")
            known = plain in ("G0", "eta0") or plain.removeprefix("tau").removeprefix("G").isdigit()
            require(
                known and plain != name, "Spread.names", name, "it must be ln G0, ln G1, ln tau1 … or ln eta0"
            )
        C = reals("Spread.covariance", self.covariance, "it must be real numbers")
        p = len(names)
        require(C.shape == (p, p), "Spread.covariance", C.shape, f"its shape must be {(p, p)}, as the names")
        scale = float(np.abs(C).max(initial=0.0))
        good = bool(np.isfinite(C).all() and (np.abs(C - C.T) <= 1e-6 * scale).all())
        good = good and bool((np.linalg.eigvalsh(C) >= -1e-6 * scale).all())
        require(good, "Spread.covariance", self.covariance, "it must be symmetric, and negative in no way")
        C.flags.writeable = False
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "covariance", C)
        for name in ("level", "K", "temperature"):
            remedy = "it must be a standard deviation, zero or positive"
            nonnegative(f"Spread.{name}", getattr(self, name), remedy)
        for name in ("level", "K"):
            plausible("spread", f"Spread.{name}", getattr(self, name))

    @classmethod
    def of(cls, fit: FitReport) -> Spread | None:
        """The spread that a fit reports: of its bootstrap where it has one, else of its residuals."""
        if not fit.names:
            return None
        if fit.bootstrap.shape[0] > 1:
            return cls(fit.names, np.atleast_2d(np.cov(fit.bootstrap, rowvar=False)))
        return cls(fit.names, (fit.covariance + fit.covariance.T) / 2)

    @property
    def told_as(self) -> dict[str, Any]:
        """Content by which `fingerprint` knows it."""
        return {
            "names": list(self.names),
            "covariance": self.covariance.tolist(),
            "level": self.level,
            "K": self.K,
            "temperature": self.temperature,
        }

    @property
    def fits(self) -> int:
        """Number of branches that a model must have at least for the names to mean something."""
        return max((place_of(name)[1] for name in self.names), default=0)

    @cached_property
    def factor(self) -> Array:
        """F (len(names), axes) with F Fᵀ the covariance, the widest axis first."""
        values, axes = np.linalg.eigh(self.covariance)
        sizes = np.sqrt(np.maximum(values, 0.0))[::-1]
        used = sizes > NOTHING * sizes.max(initial=0.0)
        return np.asarray(axes[:, ::-1][:, used] * sizes[used])

    @property
    def axes(self) -> tuple[str, ...]:
        """What a draw needs one standard normal number for each."""
        more = [name for name in ("level", "K", "temperature") if getattr(self, name) > 0]
        return (*(f"fit axis {k + 1}" for k in range(self.factor.shape[1])), *more)

    def renumbered(self, order: Index) -> Spread:
        """The spread of a model whose branch j was branch order[j]."""
        place = {int(old) + 1: new + 1 for new, old in enumerate(order)}

        def moved(name: str) -> str:
            stem = name.rstrip("0123456789")
            if name in ("ln G0", "ln eta0"):
                return name
            return f"{stem}{place[int(name[len(stem) :])]}"

        return replace(self, names=tuple(moved(n) for n in self.names))


class Drawable:
    """What a Maxwell model offers that is not exactly known: models drawn from its spread."""

    G0: float
    G: Array
    tau: Array
    eta0: float
    K: float
    temperature: float | None
    band: tuple[float, float] | None
    spread: Spread | None

    def with_spread(
        self, *, level: float = 0.0, K: float = 0.0, temperature: float = 0.0, fit: bool = True
    ) -> Any:
        """The same model, known less well: with a spread of its level, bulk modulus or temperature.

        Parameters
        ----------
        level
            Relative standard deviation of all strengths together.
        K
            Relative standard deviation of the bulk modulus.
        temperature
            Standard deviation of the temperature, °C.
        fit
            Keep what the fit leaves open; False: forget it.

        Returns
        -------
        Maxwell
            A normal distribution of the temperature, log-normal ones of the rest.

        Raises
        ------
        ValueError
            For a negative deviation, or one of the temperature where the model has no shift law.

        Examples
        --------
        >>> import bearingdyn as bd
        >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0).with_spread(level=0.1)
        >>> [f"{m.G0 / 1e6:.2f}" for m in rubber.draws(4)]
        ['0.98', '1.07', '1.02', '0.90']
        """
        known = self.spread if fit and self.spread is not None else Spread()
        found = replace(known, level=level, K=K, temperature=temperature)
        if temperature:
            law = getattr(self, "law", None)
            require(law is not None, "temperature", temperature, "the material has no shift law; leave it 0")
        return replace(self, spread=found)  # type: ignore[type-var]

    def draws(self, n: int, seed: int = 0, *, method: str = "sobol") -> list[Any]:
        """n models drawn from the spread, the same for one seed.

        Parameters
        ----------
        n
            Number of draws, at least 1.
        seed
            Of the scrambling, or of the random numbers.
        method
            "sobol", a scrambled Sobol sequence, whose means settle sooner; or "random".

        Returns
        -------
        list[Maxwell]
            Without spread of their own.

        Raises
        ------
        ValueError
            For a model without spread: nothing is known of how far it may be off.
        """
        spread = self.uncertain()
        return [self.drawn(z) for z in normals(n, len(spread.axes), seed, method)]

    def uncertain(self) -> Spread:
        """The spread of the model; ValueError for one without."""
        spread = self.spread
        require(
            spread is not None and bool(spread.axes),
            "Maxwell.spread",
            spread,
            "it must say how far the model may be off: fit it with fit_maxwell, or use with_spread(level=…)",
        )
        assert spread is not None
        return spread

    def drawn(self, z: Any) -> Any:
        """The model at standard normal numbers z, one for each of the spread's `axes`.

        The logarithm of G* follows the fit's covariance at every frequency of the band. A covariance is a
        linear statement, and few data tell branches apart: going along an axis by its standard deviation
        would leave the data far behind. So the parameters are those whose modulus is what the covariance
        says, nearest to the fitted ones.

        Parameters
        ----------
        z
            (len(spread.axes),).

        Returns
        -------
        Maxwell
        """
        spread, z = self.uncertain(), real(z)
        size = len(spread.axes)
        require(z.shape == (size,), "z", z, f"it must be ({size},), a number for each of {spread.axes}")
        fitted = spread.factor.shape[1]
        rest = dict(zip(spread.axes[fitted:], z[fitted:].tolist(), strict=True))
        parameters = _Parameters(self, spread)
        G0, G, tau, eta0 = moved(self, spread.names, parameters.nearest(spread.factor @ z[:fitted]))
        level = math.exp(spread.level * rest.get("level", 0.0))
        change: dict[str, Any] = {
            "G0": G0 * level,
            "G": G * level,
            "tau": tau,
            "eta0": eta0 * level,
            "K": self.K * math.exp(spread.K * rest.get("K", 0.0)),
        }
        low, law = getattr(self, "low_end", None), getattr(self, "payne", None)
        if low is not None and self.G0 > 0:
            change["low_end"] = low.moved(1.0, change["G0"] / self.G0)
        if law is not None:
            change["payne"] = law.scaled((change["G0"] + change["G"].sum()) / (self.G0 + self.G.sum()))
        found: Any = replace(self, fit=None, spread=None, **change)  # type: ignore[type-var]
        if "temperature" in rest:
            warm = found.at(found.temperature + spread.temperature * rest["temperature"])
            # what was measured stays measured
            found = replace(warm, band=self.band, low_end=found.low_end)
        return found


class _Parameters:
    """The logarithms that a spread names, in a model, and the modulus at a grid of its band."""

    def __init__(self, model: Drawable, spread: Spread) -> None:
        self.model = model
        self.names = spread.names
        self.place = [place_of(name) for name in spread.names]
        if model.band is not None:
            low, high = model.band
        else:
            times = model.tau if model.tau.size else np.ones(1)
            low, high = 0.1 / (2 * math.pi * times.max()), 10 / (2 * math.pi * times.min())
        self.omega = 2 * math.pi * np.geomspace(low, high, 40)
        # G0 carries what rests; where the band does not tell it, it is known by itself
        self.spring = next((k for k, p in enumerate(self.place) if p == ("G", 0)), None)
        jacobian = self._jacobian(np.zeros(len(self.names)))
        known = np.linalg.norm(jacobian @ spread.factor, axis=1)
        self.first = self._logarithms(np.zeros(len(self.names)))
        self.slope, self.sd = jacobian, np.maximum(known, 1e-3 * known.max(initial=1e-300))

    def _terms(self, step: Array) -> tuple[Complex, Complex]:
        """G* (f,), Pa, and what each logarithm adds to it (f, p)."""
        G0, G, tau, eta0 = moved(self.model, self.names, step)
        x = self.omega[:, None] * tau
        branch = G * (x / (1 + x * x) * (x + 1j))
        slope = G * (1j * x / (1 + 1j * x) ** 2)
        dashpot = 1j * self.omega * eta0
        columns = np.empty((self.omega.size, len(self.place)), dtype=np.complex128)
        for j, (kind, k) in enumerate(self.place):
            if kind == "tau":
                columns[:, j] = slope[:, k - 1]
            elif kind == "eta":
                columns[:, j] = dashpot
            else:
                columns[:, j] = branch[:, k - 1] if k else G0
        total = np.asarray(G0 + dashpot + branch.sum(axis=1))
        return total, columns

    def _logarithms(self, step: Array) -> Array:
        """ln |G*| and phase over the grid, and ln G0 where the band does not tell it."""
        total = self._terms(step)[0]
        rest = [] if self.spring is None else [step[self.spring]]
        return np.concatenate([np.log(np.abs(total)), np.angle(total), rest])

    def _jacobian(self, step: Array) -> Array:
        total, columns = self._terms(step)
        relative = columns / total[:, None]
        rest = np.zeros((0 if self.spring is None else 1, len(self.place)))
        if self.spring is not None:
            rest[0, self.spring] = 1.0
        return np.vstack([relative.real, relative.imag, rest])

    def nearest(self, step: Array) -> Array:
        """The smallest step of the logarithms whose modulus is what `step` says linearly."""
        if not step.size:
            return step
        target = self.first + self.slope @ step
        weight = 1.0 / self.sd
        if self.spring is not None:
            # of a spring that the data do not tell, no more than the prior
            weight[-1] = 1.0 / max(self.sd[-1], 1e-12) if self.sd[-1] < PRIOR else 0.0
        held = np.eye(step.size) / PRIOR
        found, damping = np.zeros(step.size), 1e-3

        def miss(at: Array) -> Array:
            return np.concatenate([weight * (self._logarithms(at) - target), held @ at])

        r = miss(found)
        for _ in range(STEPS):
            J = np.vstack([weight[:, None] * self._jacobian(found), held])
            A = J.T @ J
            move = np.linalg.solve(A + damping * np.diag(np.diag(A)), -J.T @ r)
            tried = miss(found + move)
            if tried @ tried < r @ r:
                found, damping = found + move, damping / 5
                settled = r @ r - tried @ tried <= MET * (r @ r)
                r = tried
                if settled:
                    break
            else:
                damping *= 5
        return found
