"""One sweep as a master curve: a supplier's finished curve, or a measurement at the working temperature."""

from __future__ import annotations

import numpy as np

from bearingdyn.material.dma import DMAData
from bearingdyn.material.superposition.kramers_kronig import summary, suspects
from bearingdyn.material.superposition.master_curve import MasterCurve
from bearingdyn.notice import LeftOut, warn


def one_curve(data: MasterCurve | DMAData) -> MasterCurve:
    """A single sweep as a master curve without a shift law; a master curve as it is.

    Points with a modulus that is not positive are left out with a warning.

    Parameters
    ----------
    data
        Master curve, returned as it is, or a measurement of one isotherm.

    Raises
    ------
    ValueError
        If there are several isotherms, or data is neither.
    """
    if isinstance(data, MasterCurve):
        return data
    if not isinstance(data, DMAData):
        raise ValueError(
            f"master is {data!r}; it must be a MasterCurve, DMAData of one isotherm or RelaxationData"
        )
    T = data.isotherm_temperatures
    if T.size > 1:
        raise ValueError(
            f"{data.source}: {T.size} isotherms, {T[0]:.4g} to {T[-1]:.4g} °C; shift them first, "
            f"master_curve(dma), or take one, dma.select(T=({T[0] - 1:.4g}, {T[0] + 1:.4g}))"
        )
    bad, found = suspects(data)
    if bad.all():
        raise ValueError(f"{data.source}: no point has positive moduli: the columns or their signs are wrong")
    if found:
        warn(f"{data.source}: {len(found)} of {bad.size} points left out: {summary(found)}", LeftOut)
    used = data.take(np.flatnonzero(~bad))
    return MasterCurve(
        used.frequency,
        used.storage,
        used.loss,
        used.temperature,
        used.mode,
        float(T[0]),
        {float(T[0]): 0.0},
        {float(T[0]): 0.0},
        None,
        0.0,
        (0.0, 0.0),
        used.source,
        found,
        notes=used.notes,
        K=used.K,
    )
