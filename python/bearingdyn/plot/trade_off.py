"""What a design study found: one aim against another, the front marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.plot.arguments import figure, result
from bearingdyn.plot.frame import COLOURS, engineering, finish, new_axes, style

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


@figure(study=result("study.table"))
def trade_off(
    study: xarray.Dataset, x: str, y: str, colour: str | None = None, ax: Axes | None = None
) -> Axes:
    """Draw the trade-off in a study: two of its columns against each other, a third as colour.

    Where `bearingdyn.study.pareto` has marked the front, its cases are ringed, and joined if x and y were
    the only aims. An axis is logarithmic if its values are positive and span a decade or more. Units come
    from the columns' attribute "units". Ticks are written in a fitting multiple of them, µm for 1e-5 m,
    while the axes keep the study's own numbers for whatever else is drawn.

    Parameters
    ----------
    study
        Result of `bearingdyn.study.table`, its columns over "case".
    x
        Column drawn to the right.
    y
        Column drawn upwards.
    colour
        Column drawn as colour; None: one colour.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For a column that is not in the study or holds no finite number.
    """
    values = {name: _column(study, name) for name in (x, y, colour) if name is not None}
    whole = np.all([np.isfinite(column) for column in values.values()], axis=0)
    if not whole.any():
        raise ValueError(f"no case has a finite number in each of {list(values)}")
    with style():
        ax = new_axes() if ax is None else ax
        across, up = values[x], values[y]
        if colour is None:
            ax.scatter(across[whole], up[whole], s=18.0, color=COLOURS[0], linewidths=0.0, label="cases")
        else:
            shade = values[colour]
            norm = "log" if _wide(shade[whole]) else "linear"
            points = ax.scatter(
                across[whole], up[whole], s=22.0, c=shade[whole], norm=norm, cmap="viridis", linewidths=0.0
            )
            points.set_label("cases")
            bar = ax.figure.colorbar(points, ax=ax)
            bar.set_label(
                _label(study, colour, engineering(bar.ax.yaxis, shade[whole], _unit(study, colour)))
            )
        if "front" in study:
            front = whole & study["front"].values.astype(bool)
            order = np.flatnonzero(front)[np.argsort(across[front])]
            line = "-" if set(study["front"].attrs.get("aims", "").split(", ")) == {x, y} else "none"
            label = f"Pareto front, {front.sum()} of {whole.sum()}"
            ax.plot(
                across[order], up[order], linestyle=line, color=COLOURS[1], marker="o", markersize=7.0,
                markerfacecolor="none", markeredgewidth=1.2, label=label,
            )  # fmt: skip
        for axis, column in (("x", across[whole]), ("y", up[whole])):
            if _wide(column):
                ax.set(**{f"{axis}scale": "log"})
        ax.set_xlabel(_label(study, x, engineering(ax.xaxis, across[whole], _unit(study, x))))
        ax.set_ylabel(_label(study, y, engineering(ax.yaxis, up[whole], _unit(study, y))))
        finish(ax, legend=True)
    return ax


def _column(study: xarray.Dataset, name: str) -> np.ndarray:
    if name not in study.variables or study[name].dtype.kind not in "biuf" or study[name].dims != ("case",):
        numbers = [
            str(n) for n in study.variables
            if study[n].dtype.kind in "biuf" and study[n].dims == ("case",) and n not in ("case", "front")
        ]  # fmt: skip
        raise ValueError(f"{name!r} is no column of numbers in the study; there are {numbers}")
    return np.asarray(study[name].values, dtype=np.float64)


def _wide(values: np.ndarray) -> bool:
    return bool(values.min() > 0 and values.max() >= 10 * values.min())


def _unit(study: xarray.Dataset, name: str) -> str:
    return str(study[name].attrs.get("units", ""))


def _label(study: xarray.Dataset, name: str, unit: str) -> str:
    meaning = str(study[name].attrs.get("long_name", name)) or name
    return f"{meaning}, {unit}" if unit else meaning
