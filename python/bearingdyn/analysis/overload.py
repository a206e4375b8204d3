"""Whether the bearings of a march bore what they were asked to, by all that is known at its end."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.march import March
from bearingdyn.analysis.shaft_speed import angle_turned
from bearingdyn.bearing import STATIC_PRESSURE, BallBearing
from bearingdyn.notice import BearingWarning, warn
from bearingdyn.types import Array


def warn_of_overload(
    march: March, model: core.Model, state: Array, record: Sequence[str], rows: Array
) -> None:
    """Warn of every bearing that a march overloaded: contacts over 4.2 GPa (ISO 76).

    Known are its balls' loads in the last state, those recorded, and, of a recorded force F along an axis,
    that one ball of Z bears F/Z or more. The pressures of the first state were checked with the equilibrium.

    Parameters
    ----------
    march, model, state
        As they ended.
    record, rows
        Channels and their samples (n, channels).

    Warns
    -----
    BearingWarning
        Naming the bearing, its pressure and its static rating.
    """
    finite = bool(np.isfinite(state).all())  # energies overflow before displacements do
    t, x = model.unpack(state)[:2] if finite else (0.0, np.zeros(0))
    turned = angle_turned(march.stepping, t)
    for term in march.modal.bearings:
        bearing = term.bearing
        if not isinstance(bearing, BallBearing):
            continue
        loads = [0.0]
        if finite:
            z, kernel = term.B @ x, term.kernel()
            cage = kernel.angle0 + bearing.cage_ratio * turned
            loads.append(core.bearing_force(kernel, z, np.zeros_like(z), cage, 0.0, turned)[3].max())
        for name, samples in zip(record, rows.T, strict=True):
            if samples.size and name.startswith(f"{term.name}.ball"):
                loads.append(samples.max())
            elif samples.size and name.startswith(f"{term.name}.force."):
                loads.append(np.abs(samples).max() / bearing.Z)
        peak = float(np.nanmax(loads))
        pressure = bearing.pressure(peak)
        if pressure > STATIC_PRESSURE:
            warn(
                f"bearing {term.name!r}: a ball bore {peak:.4g} N in this march, {pressure / 1e9:.3g} GPa, "
                f"over {STATIC_PRESSURE / 1e9:g} GPa (ISO 76); its static radial rating is "
                f"{bearing.static_rating:.3g} N: are the loads, the unbalance and the speed in SI units?",
                BearingWarning,
            )
