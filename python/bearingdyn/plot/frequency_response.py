"""The figure of a frequency response: magnitude, and phase below it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.application import RATES, Channel
from bearingdyn.plot.arguments import figure, results
from bearingdyn.plot.frame import (
    DASHES,
    colour,
    finish,
    halve,
    is_result,
    kind_of,
    new_axes,
    some,
    style,
)
from bearingdyn.plot.phase_axis import continuous_phase, finish_phase
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes


# of levels, SI, by what is drawn: ISO 1683
REFERENCES = {
    "displacement": (1e-12, "1 pm"),
    "velocity": (1e-9, "1 nm/s"),
    "acceleration": (1e-6, "1 µm/s²"),
    "force": (1e-6, "1 µN"),
}


@figure(datasets=results("bd.frequency_response", "response", alone=True))
def frequency_response(
    datasets: xarray.Dataset | Mapping[str, xarray.Dataset],
    output: str,
    input: str,
    ax: Axes | None = None,
    *,
    phase: bool = False,
    decibels: bool = False,
) -> Axes:
    """Draw the magnitude of bd.frequency_response over frequency, several by label, on a log axis.

    With `phase` the axes are halved, and the phase stands below. It is unwrapped: it begins between −225° and
    135° and goes on without jumps. The band of a response with `uncertainty` is shaded.

    Parameters
    ----------
    datasets
        A result of `bd.frequency_response`, or several by label.
    output
        Channel of the response.
    input
        Channel of its cause.
    ax
        Axes to draw into; None: those of a new figure.
    phase
        Draw the phase too.
    decibels
        Draw the level of the zero-to-peak response to an input of one, dB, instead of the magnitude on a log
        axis: of displacement re 1 pm, velocity re 1 nm/s, acceleration re 1 µm/s², force re 1 µN (ISO 1683).

    Returns
    -------
    Axes
        The axes of the magnitude.

    Raises
    ------
    ValueError
        If a label lacks the output or the input, if they are of different quantities, or for a response
        over the speed, which `unbalance_response` draws.
    """
    curves = {}
    alone = is_result(datasets)
    several: Any = {"response": datasets} if alone else datasets
    for label, data in some(several).items():
        if "frequency" not in data.coords:
            hint = "; draw it with plot.unbalance_response" if "speed" in data.coords else ""
            raise ValueError(
                f"{label!r} is no response over the frequency, its kind is {kind_of(data)!r}{hint}"
            )
        for kind, wanted in (("output", output), ("input", input)):
            known = [str(c) for c in data[kind].values]
            if wanted not in known:
                raise ValueError(f"{label!r} has no {kind} {wanted!r}; there are {known}")
        curves[label] = data.sel(output=output, input=input)
    quantity = one_quantity(several)
    unit = _response_unit(quantity, output, input)
    kind = "force" if is_force(output) else quantity
    reference = REFERENCES[kind][0]
    with style():
        ax = ax or new_axes(height=4.8 if phase else 3.4)
        lower = halve(ax, share=0.3) if phase else None
        for k, (label, curve) in enumerate(curves.items()):
            look: dict[str, Any] = {"color": colour(k), "linestyle": DASHES[k % len(DASHES)]}
            f, value = curve["frequency"].values, curve["response"].values
            if "lower" in curve:
                low, high = curve["lower"].values, curve["upper"].values
                ax.fill_between(f, low, high, color=look["color"], alpha=0.2, linewidth=0)
            size = np.abs(value)
            if decibels:
                with np.errstate(divide="ignore"):
                    size = 20.0 * np.log10(size / reference)
            ax.plot(f, size, label=label, **look)
            if lower is not None:
                lower.plot(f, continuous_phase(value), **look)
        if decibels:
            ax.set_ylabel(f"{kind} level, zero-to-peak, dB re {REFERENCES[kind][1]}, input of 1")
        else:
            ax.set_yscale("log")
            ax.set_ylabel(f"{kind}, zero-to-peak, {unit}")
        bottom = lower or ax
        bottom.set_xlabel("frequency, Hz")
        _span(bottom, *(c["frequency"].values for c in curves.values()))
        if lower is not None:
            finish_phase(lower)
        finish(ax, f"Response at {output} to a {_cause(input)} at {input}", legend=not alone)
    return ax


def _span(ax: Axes, *grids: Array) -> None:
    """The whole frequency range of the curves, on a log axis where it is wide and does not touch zero."""
    low, high = min(float(g.min()) for g in grids), max(float(g.max()) for g in grids)
    if low > 0 and high / low >= 50:
        ax.set_xscale("log")
    if high > low:
        ax.set_xlim(low, high)


def one_quantity(datasets: Mapping[str, xarray.Dataset]) -> str:
    """Of frequency responses to plot, the one quantity; ValueError where there are several."""
    quantities = {str(data.attrs["quantity"]) for data in datasets.values()}
    if len(quantities) > 1:
        raise ValueError(f"responses of {sorted(quantities)} do not go into one figure; draw one of each")
    return quantities.pop()


def is_force(output: str) -> bool:
    """Whether the response that a figure shows is a force."""
    return Channel.parse(output).is_force


def _cause(input: str) -> str:
    given = Channel.parse(input)
    if given.of_ground:
        return "motion"
    return "moment" if given.is_rotation else "force"


def _response_unit(quantity: str, output: str, input: str) -> str:
    found, given = Channel.parse(output), Channel.parse(input)
    below = given.motion_unit(quantity) if given.of_ground else given.force_unit
    if found.is_force:
        return f"({found.force_unit})/({below})"
    above = found.motion_unit(quantity)
    if given.of_ground:
        return f"({above})/({below})"
    return f"{f'({above})' if RATES[quantity] else above}/{f'({below})' if given.is_rotation else below}"
