"""Results as xarray Datasets: named dimensions, units, and what they were made from and by."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bearingdyn.core import Report
from bearingdyn.results.provenance import inputs_of, stamp, versions

if TYPE_CHECKING:
    import xarray


Variable: TypeAlias = tuple[str | tuple[str, ...], Any, str, str]
"""dims, values, unit, meaning"""


def dataset(
    variables: Mapping[str, Variable],
    attrs: Mapping[str, Any],
    coords: Mapping[str, tuple[Any, str] | Variable] | None = None,
) -> xarray.Dataset:
    """A result as a Dataset whose variables carry units and meaning, and what made it, and when (UTC).

    Parameters
    ----------
    variables
        Name -> (dimensions, values, unit, meaning).
    attrs
        Attributes of the whole.
    coords
        Name -> (values, unit) of a dimension; or, beside one, as a variable.
    """
    import xarray

    def whole(name: str, coord: tuple[Any, str] | Variable) -> tuple[Any, ...]:
        if len(coord) == 2:
            return name, np.asarray(coord[0]), {"units": coord[1]}
        dims, values, unit, meaning = coord
        return dims, values, {"units": unit, "long_name": meaning}

    made_by = ", ".join(f"{name} {number}" for name, number in versions().items())
    # all at once: each assignment to a Dataset aligns and copies all that it holds
    return xarray.Dataset(
        {
            name: (dims, values, {"units": unit, "long_name": meaning})
            for name, (dims, values, unit, meaning) in variables.items()
        },
        {name: whole(name, coord) for name, coord in (coords or {}).items()},
        {"made_by": made_by, "made_at": stamp(), **attrs},
    )


def march_dataset(
    facts: Mapping[str, Any],
    rows: np.ndarray,
    state: np.ndarray,
    report: Report,
    attrs: Mapping[str, Any] | None = None,
) -> xarray.Dataset:
    """Dataset of results for a march: record (time, channel), state, units, and how it ended.

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
