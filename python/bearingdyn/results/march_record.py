"""The record of a march as a Dataset: how it is made, and samples, unit and sampling time of its channels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.core import Report
from bearingdyn.results.datasets import check_dataset, dataset
from bearingdyn.results.provenance import inputs_of
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


def march_dataset(
    facts: Mapping[str, Any],
    rows: np.ndarray,
    state: np.ndarray,
    report: Report,
    attrs: Mapping[str, Any] | None = None,
) -> xarray.Dataset:
    """The record of a march (time, channel) as a Dataset, with its state, units, and how it ended.

    Parameters
    ----------
    facts
        Channels, units, dt, speed (times and speeds), decimate, settle, steps and, where known, inputs and
        system_hash, as in a run file's header.
    rows
        (samples, channels) recorded.
    state
        State at the end, from which a march goes on.
    report
        What the core counted.
    attrs
        Further attributes.
    """
    origin, count = float(state[0]), int(state[1])
    decimate = int(facts["decimate"])
    times, speeds = (np.asarray(part, dtype=np.float64) for part in facts["speed"])
    last = count - count % decimate
    time = origin + (last - decimate * np.arange(len(rows))[::-1]) * facts["dt"]
    constant = len(speeds) == 1
    return dataset(
        {
            "record": (("time", "channel"), rows, "", "recorded channels; their units are in `unit`"),
            "state": ("word", state, "", "state of the march in the core's own order"),
        },
        {
            "analysis": "transient",
            "speed": float(speeds[0]) if constant else speeds,
            **({} if constant else {"speed_time": times}),
            "dt": facts["dt"],
            "decimate": decimate,
            **({"filter": int(facts["filter"])} if "filter" in facts else {}),
            **({"method": facts["method"]} if "method" in facts else {}),
            "settle": facts["settle"],
            **report.counts,
            "steps": max(report.steps - facts["settle"], 0),
            "complete": int(report.status == 0 and report.steps == facts["settle"] + facts["steps"]),
            "status": report.text,
            **inputs_of(facts.get("inputs", "")),
            **{name: facts[name] for name in ("system_hash",) if name in facts},
            **(attrs or {}),
        },
        {
            "time": (time, "s"),
            "channel": (facts["channels"], ""),
            "unit": ("channel", facts["units"], "", "unit of each channel"),
        },
    )


def recorded(result: object) -> None:
    """Check the record of a march.

    Parameters
    ----------
    result
        What `transient` returned.

    Raises
    ------
    ValueError
        For anything else.
    """
    check_dataset("result", result, ["record", "channel", "time"], "transient")


def signal_of(result: xarray.Dataset, channel: str) -> Array:
    """Samples (n,) of a channel in a march's record.

    Parameters
    ----------
    result
        What `transient` returned.
    channel
        Name of the channel.

    Raises
    ------
    ValueError
        For a channel that was not recorded.
    """
    recorded(result)
    known = [str(c) for c in result["channel"].values]
    if channel not in known:
        raise ValueError(f"channel {channel!r} was not recorded; there are {known}")
    return np.asarray(result["record"].sel(channel=channel).values, dtype=np.float64)


def unit_of(result: xarray.Dataset, channel: str) -> str:
    """Unit of a channel in a march's record.

    Parameters
    ----------
    result
        What `transient` returned.
    channel
        Name of a recorded channel.
    """
    return str(result["unit"].sel(channel=channel).item())


def sampling_time(result: xarray.Dataset) -> float:
    """Time between two samples of a march's record, s.

    Parameters
    ----------
    result
        What `transient` returned.
    """
    return float(result.attrs["dt"]) * int(result.attrs["decimate"])
