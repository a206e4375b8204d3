"""Loss in volume: a complex bulk modulus K*(ω) = K (1 + Σ g_i iωτ_i/(1 + iωτ_i))."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.checks import nonnegative, positive, reals, require, two
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

_PER_DECADE = 2  # relaxation times of a constant loss factor
_BEYOND = 10.0  # how far they reach beyond its band: a branch gives loss a decade to either side
_POINTS = 20  # per decade, at which it is met


@takes(tau="s")
@dataclass(frozen=True)
class BulkRelaxation:
    """The relaxation of a bulk modulus, in shares of its value at rest.

    Rubber in volume is some thousand times stiffer than in shear, and its loss factor there is small: 0.01 to
    0.03 where tan δ in shear is 0.1 to 0.3. It counts where a layer is thin, for there the radial stiffness
    is half volume.

    Parameters
    ----------
    share
        (n,), g_i ≥ 0: strength of each branch over K at rest.
    tau
        (n,), s: its relaxation time.

    Raises
    ------
    ValueError
        For a share that is negative, a time that is not positive, and unequal lengths.

    References
    ----------
    Tschoegl, Knauss, Emri, Mech. Time-Depend. Mater. 6 (2002) 3: bulk and shear relaxation of polymers.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> loss = bd.BulkRelaxation.of_loss_factor(0.02, (10.0, 10e3))
    >>> K = loss.modulus(2e9, 2 * 3.14159 * 1000.0)
    >>> f"{K.real / 1e9:.3f} GPa, loss factor {K.imag / K.real:.4f}"
    '2.184 GPa, loss factor 0.0200'
    """

    share: tuple[float, ...]
    tau: tuple[float, ...]

    _repr_html_ = page

    def __post_init__(self) -> None:
        for name in ("share", "tau"):
            remedy = "it must be numbers, one a branch"
            values = np.atleast_1d(reals(f"BulkRelaxation.{name}", getattr(self, name), remedy))
            require(values.ndim == 1, f"BulkRelaxation.{name}", getattr(self, name), "give a value a branch")
            object.__setattr__(self, name, tuple(map(float, values.tolist())))
        require(
            len(self.share) == len(self.tau),
            "BulkRelaxation.tau",
            self.tau,
            f"it must have as many values as share: {len(self.share)}",
        )
        for i, (g, tau) in enumerate(zip(self.share, self.tau, strict=True)):
            nonnegative(f"BulkRelaxation.share[{i}]", g, "it must be zero or positive, a share of K at rest")
            plausible("bulk branch", f"BulkRelaxation.share[{i}]", g)
            positive(f"BulkRelaxation.tau[{i}]", tau, "it must be positive and finite, s")
            plausible("relaxation time", f"BulkRelaxation.tau[{i}]", tau)

    @classmethod
    def of_loss_factor(cls, loss_factor: float, band: ArrayLike) -> BulkRelaxation:
        """A loss factor K″/K′ that is constant in a band, within 3 % of itself.

        The modulus rises through the band as causality demands: by (2/π) ln 10 · loss_factor a decade.

        Parameters
        ----------
        loss_factor
            Above 0, at most 0.2.
        band
            Lowest and highest frequency, Hz.

        Raises
        ------
        ValueError
            For values outside their ranges.
        """
        eta = positive("loss_factor", loss_factor, "it must be positive, and at most 0.2")
        require(
            eta <= 0.2, "loss_factor", loss_factor, "it must be at most 0.2: more no rubber has in volume"
        )
        low, high = two("band", band, "it must be a lower and a higher frequency, both positive, Hz")
        require(0 < low < high < math.inf, "band", band, "it must be a lower and a higher frequency, Hz")

        def spread(first: float, last: float, per_decade: int) -> Array:
            return np.geomspace(first, last, 1 + math.ceil(per_decade * math.log10(last / first)))

        tau = 1 / (2 * np.pi * spread(high * _BEYOND, low / _BEYOND, -_PER_DECADE))
        x = 2 * np.pi * spread(low, high, _POINTS)[:, None] * tau
        # K″ = η K′ is linear in the shares: Σ g x/(1 + x²) − η Σ g x²/(1 + x²) = η
        rows = (x - eta * x**2) / (1 + x**2)
        share = scipy.optimize.nnls(rows / eta, np.ones(len(x)))[0]
        kept = share > 0
        return cls(tuple(share[kept].tolist()), tuple(tau[kept].tolist()))

    def modulus(self, K: float, omega: ArrayLike) -> Complex:
        """K*(ω), Pa, of a bulk modulus K at rest, Pa; ω in rad/s, any shape."""
        x = np.asarray(omega, dtype=np.float64)[..., None] * np.array(self.tau)
        return np.asarray(K * (1.0 + (x / (1 + x * x) * (x + 1j)) @ np.array(self.share)))

    def moved(self, factor: float) -> BulkRelaxation:
        """With times multiplied by a shift factor a_T."""
        return replace(self, tau=tuple(t * factor for t in self.tau))
