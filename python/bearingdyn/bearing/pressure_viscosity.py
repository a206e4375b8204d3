"""Viscosity of an oil over pressure: the laws of Barus and Roelands, and α by Wooster."""

from __future__ import annotations

import math

from bearingdyn.checks import nonnegative, positive, require

_ROELANDS_PRESSURE = 1.96e8  # Pa
_ROELANDS_LOG_VISCOSITY = 9.67  # −ln(6.31e-5 Pa s)


def wooster(eta0: float) -> float:
    """α of a mineral oil, 1/Pa: (0.6 + 0.965 lg η0)·1e-8, η0 in mPa s (Wooster).

    Stachowiak and Batchelor, Engineering Tribology (chapter on lubricants), give it so, η0 in cP.
    At 40 °C 1.98e-8 for VG 32, at 70 °C 1.54e-8. Synthetic oils lie lower, naphthenic ones higher.

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure and the temperature of the oil, Pa s.

    Raises
    ------
    ValueError
        At 0.24 mPa s or less, where it would not be positive.
    """
    remedy = "α by Wooster's rule needs more than 0.24e-3 Pa s (density in kg/m³?); give alpha"
    alpha = (0.6 + 0.965 * math.log10(1e3 * positive("eta0", eta0))) * 1e-8
    require(alpha > 0, "eta0", eta0, remedy)
    return alpha


def barus(eta0: float, alpha: float, p: float) -> float:
    """Viscosity under pressure by Barus, η0 e^{αp}, Pa s; far too high above some 0.1 GPa.

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.
    p
        Pressure, Pa, zero or more.
    """
    return positive("eta0", eta0) * math.exp(positive("alpha", alpha) * nonnegative("p", p))


def roelands(eta0: float, z: float, p: float) -> float:
    """Viscosity under pressure, η0 exp{(ln η0 + 9.67)[(1 + p/1.96e8)^z − 1]}, Pa s (C. J. A. Roelands 1966).

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s, above 6.31e-5.
    z
        Exponent, dimensionless.
    p
        Pressure, Pa, zero or more.
    """
    growth = (1 + nonnegative("p", p) / _ROELANDS_PRESSURE) ** positive("z", z) - 1
    return eta0 * math.exp(_roelands_log(eta0) * growth)


def roelands_exponent(eta0: float, alpha: float) -> float:
    """Exponent z that gives the pressure–viscosity coefficient α at p = 0: α = z (ln η0 + 9.67)/1.96e8.

    Parameters
    ----------
    eta0
        Viscosity at ambient pressure, Pa s.
    alpha
        Pressure–viscosity coefficient, 1/Pa.
    """
    return positive("alpha", alpha) * _ROELANDS_PRESSURE / _roelands_log(eta0)


def _roelands_log(eta0: float) -> float:
    log = math.log(positive("eta0", eta0, "it must be positive, in Pa s"))
    log += _ROELANDS_LOG_VISCOSITY
    require(log > 0, "eta0", eta0, "it must exceed 6.31e-5 Pa s for Roelands' law (give Pa s, not mPa s)")
    return log
