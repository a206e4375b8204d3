"""The figure of a march over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.checks import name_list
from bearingdyn.plot.arguments import figure, results
from bearingdyn.plot.frame import called, colour, engineering, finish, new_axes, some, stack, style
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


# of a trace; beyond, the smallest and largest sample of each stretch are drawn, which look the same
SAMPLES = 20_000
QUANTITIES = {
    "m": "displacement",
    "m/s": "velocity",
    "m/s²": "acceleration",
    "rad": "rotation",
    "rad/s": "angular velocity",
    "rad/s²": "angular acceleration",
    "N": "force",
    "W": "power",
    "1": "loaded balls",
}


@figure(datasets=results("bd.transient"))
def time(
    datasets: xarray.Dataset | Mapping[str, xarray.Dataset],
    channels: Sequence[str] | None = None,
    ax: Axes | None = None,
    *,
    span: tuple[float, float] | None = None,
    about_mean: bool = False,
) -> Axes:
    """Draw traces over time of recorded channels by bd.transient, several marches by label, every sample.

    Channels in one unit share axes; each further unit has its own below, in the order of the channels. A
    trace beyond 20 000 samples is drawn by the smallest and largest of each stretch: no peak is lost.

    Parameters
    ----------
    datasets
        A result of `bd.transient`, or several by label.
    channels
        Channels drawn; None: all that were recorded.
    ax
        Axes to draw into; None: those of a new figure.
    span
        First and last time drawn, s.
    about_mean
        Draw each trace less the mean of its record, so that small motion about a large deflection is seen.

    Returns
    -------
    Axes
        The uppermost axes.

    Raises
    ------
    ValueError
        For a channel that a march has not recorded, a result without a record, or a span without samples.
    """
    marches = some(datasets)
    for label, data in marches.items():
        if "record" not in data:
            raise ValueError(f"{called(label)} has no record over time; bd.transient makes one")
    first = next(iter(marches.values()))
    wanted = (
        [str(c) for c in first["channel"].values] if channels is None else name_list("channels", channels)
    )
    if not wanted:
        raise ValueError(f"channels is {channels!r}, there is no channel to draw; name one or more")
    units: dict[str, list[str]] = {}
    for label, data in marches.items():
        known = [str(c) for c in data["channel"].values]
        for name in wanted:
            if name not in known:
                raise ValueError(f"channel {name!r} of {called(label)} was not recorded; there are {known}")
    for name in wanted:
        units.setdefault(str(first["unit"].sel(channel=name).item()), []).append(name)
    traces = {
        (label, name): _trace(data, name, span, about_mean)
        for label, data in marches.items()
        for name in wanted
    }
    if span is not None and not all(t.size for t, _ in traces.values()):
        raise ValueError(f"span is {span}, in s; a march has no sample in it, it must hold one of each")
    from matplotlib.ticker import MaxNLocator

    title = f"{wanted[0] if len(wanted) == 1 else 'Recorded channels'} over time"
    title += ", less the mean" if about_mean else ""
    with style():
        ax = ax or new_axes(width=6.8, height=1.4 + 1.7 * len(units))
        panels = stack(ax, [1.0] * len(units))
        for panel, (unit, members) in zip(panels, units.items(), strict=True):
            drawn = [(label, name) for name in members for label in marches]
            for k, (label, name) in enumerate(drawn):
                said = name if len(marches) == 1 else label if len(wanted) == 1 else f"{label}: {name}"
                panel.plot(*traces[label, name], color=colour(k), linewidth=0.7, label=said)
            written = engineering(panel.yaxis, np.concatenate([traces[d][1] for d in drawn]), unit)
            quantity = QUANTITIES.get(unit, "value") + (" about its mean" if about_mean else "")
            panel.set_ylabel(quantity if written == "1" else f"{quantity}, {written}")
            if unit == "1" and not about_mean:
                panel.yaxis.set_major_locator(MaxNLocator(4, integer=True))
            finish(panel, title if panel is ax else "", legend=True)
        begin = min(float(t[0]) for t, _ in traces.values())
        end = max(float(t[-1]) for t, _ in traces.values())
        if end > begin:
            panels[-1].set_xlim(begin, end)
        panels[-1].set_xlabel("time, s")
    return ax


def _trace(
    data: xarray.Dataset, channel: str, span: tuple[float, float] | None, about_mean: bool
) -> tuple[Array, Array]:
    """Times, s, and samples to draw: all, or the extremes of each stretch in their order."""
    t = np.asarray(data["time"].values, dtype=np.float64)
    value = np.asarray(data["record"].sel(channel=channel).values, dtype=np.float64)
    if about_mean:
        value = value - value.mean()
    if span is not None:
        inside = (t >= span[0]) & (t <= span[1])
        t, value = t[inside], value[inside]
    if value.size <= SAMPLES:
        return t, value
    length = -(-2 * value.size // SAMPLES)
    whole = value.size // length * length
    stretches = value[:whole].reshape(-1, length)
    start = np.arange(0, whole, length)
    at = np.concatenate([start + stretches.argmin(axis=1), start + stretches.argmax(axis=1)])
    at = np.unique(np.concatenate([[0], at, np.arange(whole, value.size), [value.size - 1]]))
    return t[at], value[at]
