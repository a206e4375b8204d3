"""What the figures share: style, colours, panels, ticks and legend."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.types import Array
from bearingdyn.units import suited

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.ticker import Formatter

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
GREY = "0.35"  # of what explains a curve
DASHES = ("-", "--", "-.", (0, (1, 1)))
STYLE: Mapping[str, Any] = {
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.linewidth": 0.7,
    "axes.grid": False,
    "lines.linewidth": 1.1,
    "legend.fontsize": 8.5,
    "legend.frameon": False,
    "figure.dpi": 110.0,
    "savefig.dpi": 160.0,
}
LEGEND_COLUMNS = 4
WRITTEN_OUT = 4.0  # decades of a log axis; beyond, its ticks are powers of ten
RPM = 30.0 / math.pi  # per rad/s


@contextmanager
def style() -> Iterator[None]:
    """The style and frame of the figures, for as long as the context is open.

    Only these settings are put back at its end. The first figure of a session loads the backend, perhaps in
    here, and a notebook's backend then switches `interactive` on, without which it shows no further figure:
    `matplotlib.rc_context` would switch it off again.
    """
    import matplotlib

    settings: Any = matplotlib.rcParams  # its keys are matplotlib's, which a type would have to list
    before = {key: settings[key] for key in STYLE}
    settings.update(STYLE)
    try:
        yield
    finally:
        settings.update(before)


def new_axes(width: float = 6.2, height: float = 3.4, projection: str | None = None) -> Axes:
    """Axes in the frame of a new figure; width and height in inches."""
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(width, height), layout="constrained")
    return figure.add_subplot(projection=projection)


def halve(ax: Axes, share: float = 0.45) -> Axes:
    """Divide the frame of a figure in two: new axes take the lower share of `ax`, same horizontal axis."""
    return stack(ax, (1 - share, share))[1]


def stack(ax: Axes, shares: Sequence[float]) -> list[Axes]:
    """Stack panels in the frame of a figure: `ax` and new axes below it share its room."""
    figure = ax.figure
    spec = ax.get_subplotspec()
    panels = [ax]
    if spec is not None:
        rows = spec.subgridspec(len(shares), 1, height_ratios=shares)
        ax.set_subplotspec(rows[0])
        panels += [figure.add_subplot(rows[k], sharex=ax) for k in range(1, len(shares))]
    else:
        box = ax.get_position()
        gap = 0.03 * box.height
        edges = box.y1 - box.height * np.cumsum([0.0, *shares]) / sum(shares)
        for k in range(1, len(shares)):
            top, bottom = edges[k] - gap, edges[k + 1] + (gap if k + 1 < len(shares) else 0.0)
            panels.append(figure.add_axes((box.x0, bottom, box.width, top - bottom), sharex=ax))
        if len(shares) > 1:
            ax.set_position((box.x0, edges[1] + gap, box.width, box.y1 - edges[1] - gap))
    for panel in panels[:-1]:
        panel.tick_params(axis="x", which="both", labelbottom=False)
    return panels


def finish(ax: Axes, title: str = "", legend: bool = False) -> None:
    """Finish a figure: frame, ticks, grid; title on the left, the legend in rows between it and the data."""
    ax.spines[["top", "right"]].set_visible(False)
    # said here since ticks are made when they are drawn, outside the style's context
    ax.tick_params(which="both", labelsize=8.5, width=0.7)
    ax.tick_params(which="major", length=3.5)
    ax.tick_params(which="minor", length=2.0)
    ax.grid(which="major", color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    for axis in (ax.xaxis, ax.yaxis):
        axis.label.set_fontsize(STYLE["axes.labelsize"])
    rows = 0
    if legend:
        handles, labels = ax.get_legend_handles_labels()
        # about twelve letters an inch, five for the sample of the line
        room = max(1, int(12 * ax.bbox.width / ax.figure.dpi / (max(map(len, labels)) + 5)))
        columns = min(len(labels), LEGEND_COLUMNS, room)
        rows = -(-len(labels) // columns)
        columns = -(-len(labels) // rows)
        ax.legend(
            handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns,
            borderaxespad=0.2, borderpad=0.2, handlelength=2.2, columnspacing=1.4,
        )  # fmt: skip
    if title:
        ax.set_title(title, loc="left", pad=6.0 + 14.0 * rows)


def engineering(axis: Axis, values: Array, unit: str) -> str:
    """Ticks of a frame's axis in the multiple of its unit that suits the values; returns that multiple.

    What is drawn stays in the unit given. A unit without prefix gets a power of ten: "10⁶", "10⁻⁸ kg". No
    factor is printed elsewhere. To be called once the scale of the axis, linear or log, is set.
    """
    from matplotlib.ticker import FuncFormatter

    size = np.abs(values[np.isfinite(values) & (values != 0)])
    low, high = (float(size.min()), float(size.max())) if size.size else (1.0, 1.0)
    log = axis.get_scale() == "log"
    decades = math.log10(high / low)
    power, unit, prefixed = suited(high, unit)
    if power and not prefixed:
        unit = f"{_power_of_ten(power)} {unit}".rstrip()

    def written(value: float, _: object = None) -> str:
        shown = value / 10.0**power
        if log and decades > WRITTEN_OUT and shown > 0:
            return _power_of_ten(round(math.log10(shown)))
        return f"{shown:.10g}".replace("-", "−")

    if log:
        written_out(axis, decades, FuncFormatter(written))
    else:
        axis.set_major_formatter(FuncFormatter(written))
    return unit


def _power_of_ten(power: int) -> str:
    return "10" + str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def written_out(axis: Axis, decades: float, plain: Formatter | None = None) -> None:
    """A log axis of a figure's frame with its numbers written out, as many as these decades need."""
    from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter

    plain = plain or StrMethodFormatter("{x:g}")
    axis.set_major_formatter(plain)
    axis.set_minor_formatter(plain if decades < 1.5 else NullFormatter())
    if decades < 1.5:
        axis.set_minor_locator(LogLocator(subs=(1.5, 2, 3, 4, 6, 8) if decades < 0.8 else (2, 5)))


def frame_log(ax: Axes, values: Array) -> None:
    """Frame a log axis of a figure over the measured values, whatever else is drawn, numbers written out."""
    low, high = float(values.min()), float(values.max())
    margin = max((high / low) ** 0.06, 1.05)
    ax.set_ylim(low / margin, high * margin)
    written_out(ax.yaxis, np.log10(high / low))


def colour(k: int) -> str:
    """Colour of the k-th curve in a figure's frame."""
    return COLOURS[k % len(COLOURS)]


def is_result(datasets: object) -> bool:
    """For a figure's frame, whether one result is asked for, no mapping: a Dataset is a Mapping too."""
    return hasattr(datasets, "data_vars")


def some(datasets: Mapping[str, Any], name: str = "datasets") -> Mapping[str, Any]:
    """Frame of a figure: the results it shows, by label; ValueError if there are none, or one without."""
    if is_result(datasets):
        raise ValueError(
            f'{name} is a result without a label; give results by label, such as {{"run": result}}'
        )
    if not datasets:
        raise ValueError(
            f"{name} is empty, there is nothing to draw; give at least one result with its label"
        )
    return datasets


def kind_of(data: xarray.Dataset) -> str:
    """For a figure's frame, what a result is, with the band of an envelope."""
    kind = str(data.attrs.get("analysis", "spectrum"))
    if "band" in data.attrs:
        low, high = (float(f) for f in data.attrs["band"])
        kind += f" ({low:g} to {high:g} Hz)"
    return kind
