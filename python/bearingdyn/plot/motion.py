"""Figures of responses, orbits, spectra and ball loads."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import BearingState
from bearingdyn.application import RATES, Channel
from bearingdyn.plot.frame import (
    COLOURS,
    DASHES,
    RPM,
    colour,
    engineering,
    finish,
    halve,
    is_result,
    new_axes,
    some,
    style,
)
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

GREY = "0.35"
# a spectrum is drawn this far below its largest line: 120 dB, below which round-off begins
DEPTH = 1e-6
# °; a phase begins in the turn below it
PHASE_END = 135.0
SMALL_PHASE = 15.0  # °; the axes of a phase show at least that much
POINT = 1.0 / 72.0  # inch
# names of lines: their size, points; what one takes along the axis, in that size; height of the leaders, of
# the axes
NAME, PITCH, LEADER = 8.0, 1.35, 0.07


def frequency_response(
    datasets: xarray.Dataset | Mapping[str, xarray.Dataset],
    output: str,
    input: str,
    ax: Axes | None = None,
    *,
    phase: bool = False,
) -> Axes:
    """Magnitude of a response by bd.frequency_response against frequency, several by label, on a log axis.

    With `phase` the axes are halved, and the phase stands below. It is unwrapped: it begins between −225° and
    135° and goes on without jumps.

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
                f"{label!r} is no response over the frequency, its kind is {_kind(data)!r}{hint}"
            )
        for kind, wanted in (("output", output), ("input", input)):
            known = [str(c) for c in data[kind].values]
            if wanted not in known:
                raise ValueError(f"{label!r} has no {kind} {wanted!r}; there are {known}")
        curves[label] = data["response"].sel(output=output, input=input)
    quantity = _one_quantity(several)
    unit = _response_unit(quantity, output, input)
    with style():
        ax = ax or new_axes(height=4.8 if phase else 3.4)
        lower = halve(ax, share=0.3) if phase else None
        for k, (label, curve) in enumerate(curves.items()):
            look: dict[str, Any] = {"color": colour(k), "linestyle": DASHES[k % len(DASHES)]}
            f, value = curve["frequency"].values, curve.values
            ax.plot(f, np.abs(value), label=label, **look)
            if lower is not None:
                lower.plot(f, continuous_phase(value), **look)
        ax.set_yscale("log")
        ax.set_ylabel(f"{'force' if _is_force(output) else quantity}, zero-to-peak, {unit}")
        bottom = lower or ax
        bottom.set_xlabel("frequency, Hz")
        _span(bottom, *(c["frequency"].values for c in curves.values()))
        if lower is not None:
            finish_phase(lower)
        finish(ax, f"Response at {output} to a {_cause(input)} at {input}", legend=not alone)
    return ax


def unbalance_response(
    datasets: Mapping[str, xarray.Dataset], output: str, ax: Axes | None = None, *, phase: bool = True
) -> Axes:
    """Magnitude of a response by bd.unbalance_response over the speed in rpm, several by label; log axis.

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
            raise ValueError(f"{label!r} is no response over the speed, its kind is {_kind(data)!r}{hint}")
        known = [str(c) for c in data["output"].values]
        if output not in known:
            raise ValueError(f"{label!r} has no output {output!r}; there are {known}")
        curve = data["response"].sel(output=output)
        order = np.argsort(curve["speed"].values)
        curves[label] = curve["speed"].values[order] * RPM, curve.values[order]
    quantity = "force" if _is_force(output) else _one_quantity(datasets)
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


def orbit(datasets: Mapping[str, xarray.Dataset], ax: Axes | None = None) -> Axes:
    """Orbits by bd.orbit, several by label, in µm, each about its own mean, both axes to one scale.

    The mean of the record is what bd.orbit subtracts and keeps as mean_x and mean_y. The paper subtracts the
    static deflection; from that the mean differs by what speed adds to it.

    Parameters
    ----------
    datasets
        Results of `bd.orbit` by label.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    first = next(iter(some(datasets).values()))
    with style():
        ax = ax or new_axes(width=4.6, height=4.9)
        curves = [(d["x"].values * 1e6, d["y"].values * 1e6) for d in datasets.values()]
        sizes = [float(np.hypot(x, y).max(initial=0.0)) for x, y in curves]
        for k, (label, (x, y)) in enumerate(zip(datasets, curves, strict=True)):
            above = 2.0 + sum(size > sizes[k] for size in sizes) / len(sizes)  # the smaller orbit on top
            ax.plot(x, y, color=colour(k), linewidth=0.6, label=label, zorder=above)
        for axis, name in ((ax.xaxis, "x"), (ax.yaxis, "y")):
            meanings = {str(data[name].attrs.get("long_name", name)) for data in datasets.values()}
            meaning = str(first[name].attrs["long_name"]) if len(meanings) == 1 else f"{name} about its mean"
            axis.set_label_text(f"{meaning}, µm")
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.08)
        finish(ax, "Orbit about its mean" if len(curves) == 1 else "Orbits about their means", legend=True)
    return ax


def spectrum(
    datasets: Mapping[str, xarray.Dataset],
    lines: Mapping[str, float] | None = None,
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
) -> Axes:
    """Amplitude spectra by bd.spectrum or bd.envelope_spectrum, several by label, 120 dB deep at most.

    Parameters
    ----------
    datasets
        Results of `bd.spectrum` or `bd.envelope_spectrum` by label, in one unit.
    lines
        Name -> frequency, Hz, such as {"BPFO": 107.4}: marked and named where they fall inside the figure.
    ax
        Axes to draw into; None: those of a new figure.
    f_max
        Highest frequency drawn, Hz; None: the whole of the spectra.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If f_max is not positive or the spectra have different units.
    """
    if f_max is not None and not f_max > 0:
        raise ValueError(f"f_max is {f_max}; it must be a positive frequency, in Hz")
    units = {str(data["amplitude"].attrs["units"]) for data in some(datasets).values()}
    if len(units) > 1:
        raise ValueError(f"spectra in {sorted(units)} do not go into one figure; draw one of each")
    end = f_max or max(float(data["frequency"].values[-1]) for data in datasets.values())
    channels = sorted({str(data.attrs["channel"]) for data in datasets.values()})
    with style():
        ax = ax or new_axes(width=6.8)
        largest, smallest = 0.0, np.inf
        for k, (label, data) in enumerate(datasets.items()):
            shown = (data["frequency"].values > 0) & (data["frequency"].values <= end)
            f, amplitude = data["frequency"].values[shown], data["amplitude"].values[shown]
            ax.plot(f, amplitude, color=colour(k), linewidth=0.8, label=label, zorder=2 + 0.1 * k)
            largest = max(largest, float(amplitude.max(initial=0.0)))
            smallest = min(smallest, float(amplitude.min(initial=np.inf)))
        ax.set_xlim(0.0, end)
        room = _mark(ax, {name: f for name, f in (lines or {}).items() if 0 <= f <= end})
        if largest > 0:
            ax.set_yscale("log")
            low = max(0.5 * smallest, DEPTH * largest)
            ax.set_ylim(low, low * (2 * largest / low) ** (1 / (1 - room)))
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel(f"amplitude, zero-to-peak, {units.pop()}")
        kinds = dict.fromkeys(_kind(data) for data in datasets.values())
        title = f"{' and '.join(kinds)} of {', '.join(channels)}"
        finish(ax, title[0].upper() + title[1:], legend=True)
    return ax


def ball_loads(loads: BearingState | ArrayLike, ax: Axes | None = None, *, angle: float = 0.0) -> Axes:
    """Load of each ball, N, around the bearing: azimuth from x (right) towards y (up).

    Parameters
    ----------
    loads
        A bearing of an equilibrium, or (Z,) N.
    ax
        Axes to draw into, polar; None: those of a new figure.
    angle
        Azimuth of the first ball, rad.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If the loads are not a list of finite numbers or the axes are not polar.
    """
    Q = np.asarray(loads.loads if isinstance(loads, BearingState) else loads, dtype=np.float64)
    if Q.ndim != 1 or Q.size == 0 or not np.isfinite(Q).all():
        raise ValueError(f"loads is an array of shape {Q.shape}; it must be one finite load per ball, in N")
    if ax is not None and ax.name != "polar":
        raise ValueError(f"ax has the projection {ax.name!r}; ball loads need projection='polar'")
    from matplotlib.ticker import MaxNLocator

    psi = angle + 2 * np.pi * np.arange(Q.size) / Q.size
    loaded = Q > 0
    with style():
        ax = ax or new_axes(width=4.4, height=4.6, projection="polar")
        scale: Any = ax  # polar
        ax.bar(psi, Q, width=0.5 * 2 * np.pi / Q.size, color=COLOURS[0], linewidth=0)
        largest = float(Q.max())
        top = 1.1 * largest if largest > 0 else 1.0
        ax.set_ylim(0.0, top)
        # the scale stands between two balls, on the side that carries least
        neighbours = Q + np.roll(Q, -1)
        between = psi[int(np.argmin(neighbours))] + np.pi / Q.size
        ax.yaxis.set_major_locator(MaxNLocator(4))
        scale.set_rlabel_position(float(np.degrees(between)) % 360)
        ax.set_xticks(psi % (2 * np.pi), [f"{k + 1}" for k in range(Q.size)])
        ax.set_xlabel(f"ball number at its azimuth; {np.count_nonzero(loaded)} of {Q.size} loaded")
        ax.set_ylabel("ball load, N", labelpad=24)
        ax.set_title(f"Ball loads, the largest {largest:.4g} N", pad=14)
        ax.tick_params(labelsize=8, colors=GREY)
        ax.grid(color="0.85", linewidth=0.6)
        ax.set_axisbelow(True)
    return ax


def _span(ax: Axes, *grids: Array) -> None:
    """The whole frequency range of the curves, on a log axis where it is wide and does not touch zero."""
    low, high = min(float(g.min()) for g in grids), max(float(g.max()) for g in grids)
    if low > 0 and high / low >= 50:
        ax.set_xscale("log")
    if high > low:
        ax.set_xlim(low, high)


def _kind(data: xarray.Dataset) -> str:
    """What a result is, with the band of an envelope."""
    kind = str(data.attrs.get("analysis", "spectrum"))
    if "band" in data.attrs:
        low, high = (float(f) for f in data.attrs["band"])
        kind += f" ({low:g} to {high:g} Hz)"
    return kind


def _one_quantity(datasets: Mapping[str, xarray.Dataset]) -> str:
    quantities = {str(data.attrs["quantity"]) for data in datasets.values()}
    if len(quantities) > 1:
        raise ValueError(f"responses of {sorted(quantities)} do not go into one figure; draw one of each")
    return quantities.pop()


def _is_force(output: str) -> bool:
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


def continuous_phase(response: Complex) -> Array:
    """Unwrapped phase, °, its first value in the turn below PHASE_END: no curve begins at that angle."""
    degrees = np.degrees(np.unwrap(np.angle(response)))
    return np.asarray(degrees - 360.0 * np.ceil((degrees[0] - PHASE_END) / 360.0))


def finish_phase(ax: Axes) -> None:
    """Label, ticks and frame of the axes of a phase, °: right angles where it turns as far, 5° at least."""
    from matplotlib.ticker import MultipleLocator

    ax.set_ylabel("phase, °")
    low, high = ax.get_ylim()
    if high - low < SMALL_PHASE:
        low, high = ((low + high + side * SMALL_PHASE) / 2 for side in (-1, 1))
        ax.set_ylim(low, high)
    step = next((s for s in (5, 10, 15, 30, 45) if high - low <= 4 * s), 90)
    ax.yaxis.set_major_locator(MultipleLocator(step * max(1, math.ceil((high - low) / 540))))
    finish(ax)


def _mark(ax: Axes, lines: Mapping[str, float]) -> float:
    """Dashed verticals, each led to its name in one row at the top: no line goes through a name.

    The names keep the order of the lines; where those are closer than letters are wide, the names move apart
    and slanted leaders join them. Returns the share of the height of the axes that names and leaders take.
    """
    if not lines:
        return 0.0
    from matplotlib.patches import ConnectionPatch

    names = sorted(lines, key=lambda name: lines[name])
    at = np.array([lines[name] for name in names]) / ax.get_xlim()[1]
    # in shares of the axes: what a name takes along them; names too many for them are written smaller
    size = min(NAME, ax.bbox.width / (PITCH * len(names) * POINT * ax.figure.dpi))
    letter = size * POINT * ax.figure.dpi
    stands = _spread(at, PITCH * letter / ax.bbox.width)
    height = max(map(len, names)) * 0.6 * letter / ax.bbox.height + 0.02
    moved = bool(np.abs(stands - at).max() * ax.bbox.width > 0.5)  # pixels
    foot = 1.0 - height - (LEADER if moved else 0.01)
    for name, stand in zip(names, stands, strict=True):
        ax.axvline(
            lines[name], ymax=foot, color=GREY, linestyle=(0, (3, 3)), linewidth=0.7, zorder=1, gid=name
        )
        leader = ConnectionPatch(
            (lines[name], foot), (stand, 1.0 - height), ax.get_xaxis_transform(), ax.transAxes,
            color=GREY, linewidth=0.7, zorder=1, gid=name,
        )  # fmt: skip
        leader.set_in_layout(False)
        ax.add_artist(leader)
        ax.text(
            stand, 1.0 - height + 0.005, name, rotation=90, transform=ax.transAxes,
            ha="center", va="bottom", fontsize=size, color=GREY, zorder=5,
        )  # fmt: skip
    return min(1.0 - foot + 0.01, 0.5)


def _spread(at: Array, pitch: float) -> Array:
    """Places (n,) in 0 … 1, `pitch` apart at least, in the order of `at` and nearest to it in squares."""
    from scipy.optimize import isotonic_regression

    rank = np.arange(len(at)) * pitch
    most = max(1.0 - (len(at) - 0.5) * pitch, 0.5 * pitch)
    return np.asarray(np.clip(isotonic_regression(at - rank).x, 0.5 * pitch, most) + rank)
