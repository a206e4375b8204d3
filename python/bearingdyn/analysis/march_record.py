"""The record of a march: samples, unit and sampling time of its channels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import table
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


def recorded(result: object) -> None:
    """Check the record of a march, what `transient` returned; ValueError for anything else."""
    table("result", result, ["record", "channel", "time"], "transient")


def signal_of(result: xarray.Dataset, channel: str) -> Array:
    """Samples (n,) of a recorded channel; ValueError for one that was not recorded."""
    recorded(result)
    known = [str(c) for c in result["channel"].values]
    if channel not in known:
        raise ValueError(f"channel {channel!r} was not recorded; there are {known}")
    return np.asarray(result["record"].sel(channel=channel).values, dtype=np.float64)


def unit_of(result: xarray.Dataset, channel: str) -> str:
    """Unit of a channel in a march's record."""
    return str(result["unit"].sel(channel=channel).item())


def sampling_time(result: xarray.Dataset) -> float:
    """Time between two samples of a march's record, s."""
    return float(result.attrs["dt"]) * int(result.attrs["decimate"])
