"""The figure of a response to unbalance over the speed of the shaft."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.plot.arguments import figure, results
from bearingdyn.plot.frame import (
    DASHES,
    RPM,
    colour,
    engineering,
    finish,
    halve,
    kind_of,
    new_axes,
    some,
    style,
)
from bearingdyn.plot.frequency_response import is_force, one_quantity
from bearingdyn.plot.phase_axis import continuous_phase, finish_phase

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


@figure(datasets=results("bd.unbalance_response", "response"))
def unbalance_response(
    datasets: Mapping[str, xarray.Dataset], output: str, ax: Axes | None = None, *, phase: bool = True
) -> Axes:
    """Draw the magnitude of bd.unbalance_response over the speed in rpm, several by label, logarithmic.

    With `phase` the axes are halved and the phase against the angle of the shaft stands below, unwrapped from
    the lowest speed that moves.

    Parameters
    ----------
    datasets
        Results of `bd.unbalance_response` by label.
    output
        Channel of the response.
    ax
        Axes to draw into; None: those of a new figure.
    phase
        Draw the phase too.

    Returns
    -------
    Axes
        The axes of the magnitude.

    Raises
    ------
    ValueError
        If a label lacks the output or is no unbalance response, or if their quantities differ.
    """
    curves = {}
    for label, data in some(datasets).items():
        if "speed" not in data.coords or "output" not in data.coords:
            hint = "; draw it with plot.frequency_response" if "frequency" in data.coords else ""
            raise ValueError(f"{label!r} is no response over the speed, its kind is {kind_of(data)!r}{hint}")
        known = [str(c) for c in data["output"].values]
        if output not in known:
            raise ValueError(f"{label!r} has no output {output!r}; there are {known}")
        curve = data["response"].sel(output=output)
        order = np.argsort(curve["speed"].values)
        curves[label] = curve["speed"].values[order] * RPM, curve.values[order]
    quantity = "force" if is_force(output) else one_quantity(datasets)
    unit = str(next(iter(datasets.values()))["unit"].sel(output=output).item())
    with style():
        ax = ax or new_axes(height=4.8 if phase else 3.4)
        lower = halve(ax, share=0.3) if phase else None
        for k, (label, (rpm, value)) in enumerate(curves.items()):
            look: dict[str, Any] = {"color": colour(k), "linestyle": DASHES[k % len(DASHES)]}
            ax.plot(rpm, np.abs(value), label=label, **look)
            moved = np.abs(value) > 0  # not at standstill
            if lower is not None and moved.any():
                lower.plot(rpm[moved], continuous_phase(value[moved]), **look)
        ax.set_yscale("log")
        sizes = np.concatenate([np.abs(value) for _, value in curves.values()])
        ax.set_ylabel(f"{quantity}, zero-to-peak, {engineering(ax.yaxis, sizes, unit)}")
        bottom = lower or ax
        bottom.set_xlabel("speed, rpm")
        ends = [rpm[k] for rpm, _ in curves.values() for k in (0, -1)]
        if max(ends) > min(ends):
            bottom.set_xlim(min(ends), max(ends))
        if lower is not None:
            finish_phase(lower)
        finish(ax, f"Response at {output} to the unbalance", legend=True)
    return ax
