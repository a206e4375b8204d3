"""Viscosity of an oil over pressure: the laws of Barus and Roelands."""

from __future__ import annotations

import math

from bearingdyn.checks import nonnegative, positive, require

_ROELANDS_PRESSURE = 1.96e8  # Pa
_ROELANDS_LOG_VISCOSITY = 9.67  # −ln(6.31e-5 Pa s)


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
