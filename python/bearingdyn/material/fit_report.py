"""How well a model renders what it was fitted to."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bearingdyn.material.low_end import LowEnd
from bearingdyn.notice import OutsideBand as OutsideBand
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.types import Array


def _none() -> Array:
    return np.empty((0, 0))


@dataclass(frozen=True)
class FitReport:
    """Report of a Maxwell fit: how well the model renders the master curve it was fitted to.

    Errors are relative deviations ln(model/measured) of the points inside the band.

    Attributes
    ----------
    band
        Lowest and highest frequency at the reference temperature the model is good for, Hz: as asked
        for, at most twice beyond the master curve.
    covered
        Lowest and highest frequency of the points inside it, Hz.
    points
        Number of points inside the band.
    storage_rms, storage_max
        Of the storage modulus G′.
    tan_delta_rms, tan_delta_max
        Of the loss factor tan δ.
    names
        Names of the fitted parameters: ln G0, ln G1 …, ln tau1 …, ln eta0; those at a bound are left out.
    covariance
        Of those parameters (len(names), len(names)), from the residuals' own scatter.
    floor
        rms deviation of G′ and of tan δ that the best dense non-negative spectrum leaves in the band.
    bootstrap
        Those parameters in refits to isotherms drawn with replacement, (refits, len(names)).
    low_end
        What the points say of the modulus at long times: plateau, reach, an interval for G0.
    """

    band: tuple[float, float]
    covered: tuple[float, float]
    points: int
    storage_rms: float
    storage_max: float
    tan_delta_rms: float
    tan_delta_max: float
    names: tuple[str, ...]
    covariance: Array = field(compare=False, repr=False)
    floor: tuple[float, float] = (0.0, 0.0)
    bootstrap: Array = field(default_factory=_none, compare=False, repr=False)
    low_end: LowEnd | None = None

    __repr__ = short
    _repr_html_ = page

    @property
    def standard_errors(self) -> dict[str, float]:
        """Relative standard error by name: the bootstrap's scatter if there is one, else the covariance's."""
        if self.bootstrap.shape[0] > 1:
            errors = np.std(self.bootstrap, axis=0, ddof=1)
        else:
            errors = np.sqrt(np.diag(self.covariance))
        return dict(zip(self.names, errors.tolist(), strict=True))
