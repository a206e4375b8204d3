"""Figures: each function draws one, into the axes it is given or a figure of its own, and returns the axes.

Amplitudes are zero-to-peak. Colours can be told apart by colour-blind readers (Okabe and Ito). The style
holds inside a call and leaves matplotlib's own settings alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn.analysis import BearingState
from bearingdyn.material import DMAData, MasterCurve, Maxwell, ShiftTable
from bearingdyn.parts import Layer

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.colors import Normalize

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
DASHES = ("-", "--", "-.", (0, (1, 1)))
GREY = "0.35"
TEMPERATURES = "cividis"
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
# a spectrum is drawn this far below its largest line: 120 dB, below which round-off begins
DEPTH = 1e-6
LEGEND_COLUMNS = 4
POINT = 1.0 / 72.0  # inch


@contextmanager
def style() -> Iterator[None]:
    """The package's own look, for as long as the context is open."""
    import matplotlib

    settings: Any = STYLE  # its keys are matplotlib's, which a type would have to list
    with matplotlib.rc_context(settings):
        yield


def isotherms(dma: DMAData, ax: Axes | None = None) -> Axes:
    """Storage modulus, and loss factor below it, of each isotherm against frequency, coloured by temperature.

    The axes given are halved; those of the storage modulus are returned.
    """
    letter = _letter(dma.mode)
    with style():
        ax = ax or _new(height=4.8)
        colours = _temperature_scale(dma.temperature)
        lower = _halve(ax)
        for sweep in dma.isotherms:
            look: dict[str, Any] = {"color": _colour(colours, float(sweep.temperature.mean())), "marker": "."}
            ax.loglog(sweep.frequency, sweep.storage, markersize=3, linewidth=0.8, **look)
            lower.loglog(sweep.frequency, sweep.tan_delta, markersize=3, linewidth=0.8, **look)
        _colourbar(ax, lower, colours)
        ax.set_ylabel(f"storage modulus {letter}′, Pa")
        lower.set_ylabel("loss factor tan δ, 1")
        lower.set_xlabel("frequency, Hz")
        _finish(ax, f"Isothermal sweeps in {dma.mode}")
        _finish(lower)
    return ax


def master(curve: MasterCurve, maxwell: Maxwell | None = None, ax: Axes | None = None) -> Axes:
    """Storage modulus, and loss factor below it, against reduced frequency, with a Maxwell model.

    Points are coloured by the temperature they were measured at. The band of the fit is shaded, and outside
    it the model is dashed: there it is an extrapolation. A curve measured in tension is compared with
    E* = 9 K G*/(3 K + G*) of the model. The axes given are halved; the upper ones are returned.

    Raises ValueError if the model holds at another temperature than the curve.
    """
    if maxwell is not None and maxwell.temperature not in (None, curve.T_ref):
        raise ValueError(
            f"maxwell holds at {maxwell.temperature} °C, the master curve at {curve.T_ref} °C; "
            f"pass maxwell.at({curve.T_ref})"
        )
    letter = _letter(curve.mode)
    with style():
        ax = ax or _new(height=4.8)
        colours = _temperature_scale(curve.temperature)
        lower = _halve(ax)
        for panel, values in ((ax, curve.storage), (lower, curve.tan_delta)):
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.scatter(
                curve.frequency,
                values,
                c=curve.temperature,
                norm=colours,
                cmap=TEMPERATURES,
                s=7,
                linewidths=0,
            )
        if maxwell is not None:
            _draw_model(ax, lower, curve, maxwell)
        _colourbar(ax, lower, colours)
        ax.set_ylabel(f"storage modulus {letter}′, Pa")
        lower.set_ylabel("loss factor tan δ, 1")
        lower.set_xlabel(f"reduced frequency at {curve.T_ref:g} °C, Hz")
        _finish(ax, f"Master curve at {curve.T_ref:g} °C, {curve.mode}", legend=maxwell is not None)
        _finish(lower)
    return ax


def _draw_model(ax: Axes, lower: Axes, curve: MasterCurve, maxwell: Maxwell) -> None:
    low, high = float(curve.frequency[0]), float(curve.frequency[-1])
    band = maxwell.fit.band if maxwell.fit else None
    if band is not None:
        low, high = min(low, band[0]), max(high, band[1])
    f = np.geomspace(low, high, 400)
    modulus = maxwell.complex_modulus(2 * np.pi * f)
    if curve.mode == "tension":
        modulus = 9 * maxwell.K * modulus / (3 * maxwell.K + modulus)
    values = ((ax, modulus.real), (lower, modulus.imag / modulus.real))
    name = f"Maxwell model, {maxwell.G.size} branches"
    for panel, value in values:
        value = np.where(value > 0, value, np.nan)
        if band is None:
            panel.plot(f, value, color=COLOURS[1], label=name)
            continue
        inside = (f >= band[0]) & (f <= band[1])
        panel.axvspan(*band, color="0.92", zorder=0, label=f"band of the fit, {band[0]:g} to {band[1]:g} Hz")
        panel.plot(f, value, color=COLOURS[1], linestyle=(0, (4, 2)), linewidth=0.8)
        panel.plot(f, np.where(inside, value, np.nan), color=COLOURS[1], linewidth=1.6, label=name)


def shifts(curve: MasterCurve, ax: Axes | None = None) -> Axes:
    """Free shifts log10 a_T of the isotherms, two standard errors each way, with the law fitted to them."""
    T = np.array(list(curve.shifts))
    values = np.array([curve.shifts[t] for t in T.tolist()])
    errors = np.array([curve.shift_errors[t] for t in T.tolist()])
    name = {"WLF": "WLF law", "Arrhenius": "Arrhenius law"}.get(type(curve.law).__name__, "interpolation")
    with style():
        ax = ax or _new()
        grid = np.linspace(T.min(), T.max(), 200)
        if isinstance(curve.law, ShiftTable):
            grid = np.clip(grid, curve.law.T[0], curve.law.T[-1])
        ax.axhline(0.0, color="0.8", linewidth=0.7, zorder=0)
        ax.plot(
            grid, curve.law.log_shift(grid), color=COLOURS[1], label=f"{name}, rms {curve.law_residual:.2g}"
        )
        ax.errorbar(
            T, values, 2 * errors, fmt="o", markersize=4, capsize=2, color=COLOURS[0],
            label="isotherms, ±2 standard errors",
        )  # fmt: skip
        ax.set_xlabel("temperature, °C")
        ax.set_ylabel("shift log₁₀ a_T, decades")
        _finish(ax, f"Time–temperature shifts to {curve.T_ref:g} °C", legend=True)
    return ax


def frequency_response(
    datasets: Mapping[str, xarray.Dataset],
    output: str,
    input: str,
    ax: Axes | None = None,
    *,
    phase: bool = False,
) -> Axes:
    """Magnitude of a response by bd.frequency_response against frequency, several by label, on a log axis.

    With `phase` the axes are halved and the phase, −180° to 180°, stands below; the axes of the magnitude are
    returned.

    Raises ValueError if a label lacks the output or the input, or if they are of different quantities.
    """
    curves = {}
    for label, data in _some(datasets).items():
        for kind, wanted in (("output", output), ("input", input)):
            known = [str(c) for c in data[kind].values]
            if wanted not in known:
                raise ValueError(f"{label!r} has no {kind} {wanted!r}; there are {known}")
        curves[label] = data["response"].sel(output=output, input=input)
    quantities = {str(data.attrs["quantity"]) for data in datasets.values()}
    if len(quantities) > 1:
        raise ValueError(f"responses of {sorted(quantities)} do not go into one figure; draw one of each")
    quantity = quantities.pop()
    unit = _response_unit(quantity, output, input)
    with style():
        ax = ax or _new(height=4.8 if phase else 3.4)
        lower = _halve(ax, share=0.3) if phase else None
        for k, (label, curve) in enumerate(curves.items()):
            look: dict[str, Any] = {"color": _cycle(k), "linestyle": DASHES[k % len(DASHES)]}
            f, value = curve["frequency"].values, curve.values
            ax.plot(f, np.abs(value), label=label, **look)
            if lower is not None:
                lower.plot(f, _cut_jumps(np.degrees(np.angle(value))), **look)
        ax.set_yscale("log")
        ax.set_ylabel(f"{quantity}, zero-to-peak, {unit}")
        bottom = lower or ax
        bottom.set_xlabel("frequency, Hz")
        _span(bottom, *(c["frequency"].values for c in curves.values()))
        if lower is not None:
            lower.set_ylabel("phase, °")
            lower.set_ylim(-190, 190)
            lower.set_yticks([-180, -90, 0, 90, 180])
            _finish(lower)
        _finish(ax, f"Response at {output} to a {_cause(input)} at {input}", legend=True)
    return ax


def orbit(datasets: Mapping[str, xarray.Dataset], ax: Axes | None = None) -> Axes:
    """Orbits by bd.orbit, several by label, in µm about their means, both axes to one scale."""
    first = next(iter(_some(datasets).values()))
    with style():
        ax = ax or _new(width=4.6, height=4.9)
        for k, (label, data) in enumerate(datasets.items()):
            ax.plot(
                data["x"].values * 1e6, data["y"].values * 1e6, color=_cycle(k), linewidth=0.8, label=label
            )
        for axis, name in ((ax.xaxis, "x"), (ax.yaxis, "y")):
            meanings = {str(data[name].attrs.get("long_name", name)) for data in datasets.values()}
            meaning = str(first[name].attrs["long_name"]) if len(meanings) == 1 else f"{name} about its mean"
            axis.set_label_text(f"{meaning}, µm")
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.08)
        _finish(ax, "Orbit about the static deflection", legend=True)
    return ax


def spectrum(
    datasets: Mapping[str, xarray.Dataset],
    lines: Mapping[str, float] | None = None,
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
) -> Axes:
    """Amplitude spectra by bd.spectrum, several by label, on a log axis 120 dB deep at most.

    lines: name -> frequency, Hz, such as {"BPFO": 107.4}: marked and named where they fall inside the figure.
    f_max: highest frequency drawn, Hz; the whole of the spectra when not given.

    Raises ValueError if f_max is not positive or the spectra have different units.
    """
    if f_max is not None and not f_max > 0:
        raise ValueError(f"f_max is {f_max}; it must be a positive frequency, in Hz")
    units = {str(data["amplitude"].attrs["units"]) for data in _some(datasets).values()}
    if len(units) > 1:
        raise ValueError(f"spectra in {sorted(units)} do not go into one figure; draw one of each")
    end = f_max or max(float(data["frequency"].values[-1]) for data in datasets.values())
    channels = sorted({str(data.attrs["channel"]) for data in datasets.values()})
    with style():
        ax = ax or _new(width=6.8)
        largest, smallest = 0.0, np.inf
        for k, (label, data) in enumerate(datasets.items()):
            shown = (data["frequency"].values > 0) & (data["frequency"].values <= end)
            f, amplitude = data["frequency"].values[shown], data["amplitude"].values[shown]
            ax.plot(f, amplitude, color=_cycle(k), linewidth=0.8, label=label, zorder=2 + 0.1 * k)
            largest = max(largest, float(amplitude.max(initial=0.0)))
            smallest = min(smallest, float(amplitude.min(initial=np.inf)))
        if largest > 0:
            ax.set_yscale("log")
            ax.set_ylim(max(0.5 * smallest, DEPTH * largest), 2 * largest)
        ax.set_xlim(0.0, end)
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel(f"amplitude, zero-to-peak, {units.pop()}")
        _mark(ax, {name: f for name, f in (lines or {}).items() if 0 <= f <= end})
        _finish(ax, f"Spectrum of {', '.join(channels)}", legend=True)
    return ax


def ball_loads(loads: BearingState | ArrayLike, ax: Axes | None = None, *, angle: float = 0.0) -> Axes:
    """Load of each ball, N, around the bearing: azimuth from x (right) towards y (up).

    loads: a bearing of an equilibrium, or (Z,) N. angle: azimuth of the first ball, rad. ax: polar.

    Raises ValueError if the loads are not a list of finite numbers or the axes are not polar.
    """
    Q = np.asarray(loads.loads if isinstance(loads, BearingState) else loads, dtype=np.float64)
    if Q.ndim != 1 or Q.size == 0 or not np.isfinite(Q).all():
        raise ValueError(f"loads has shape {Q.shape}; give one finite load per ball, N")
    if ax is not None and ax.name != "polar":
        raise ValueError(f"ax has the projection {ax.name!r}; ball loads need projection='polar'")
    psi = angle + 2 * np.pi * np.arange(Q.size) / Q.size
    loaded = Q > 0
    with style():
        ax = ax or _new(width=4.4, height=4.6, projection="polar")
        ax.bar(psi, Q, width=0.5 * 2 * np.pi / Q.size, color=COLOURS[0], linewidth=0)
        largest = float(Q.max())
        top = 1.1 * largest if largest > 0 else 1.0
        ax.plot(psi[~loaded], np.full(np.count_nonzero(~loaded), 0.0), "o", color=COLOURS[1], markersize=4)
        ax.set_ylim(0.0, top)
        # the scale stands between two balls, on the side that carries least
        neighbours = Q + np.roll(Q, -1)
        between = psi[int(np.argmin(neighbours))] + np.pi / Q.size
        ax.set_rlabel_position(float(np.degrees(between)) % 360)
        ax.set_xticks(psi % (2 * np.pi), [f"{k + 1}" for k in range(Q.size)])
        ax.set_xlabel(f"ball number at its azimuth; {np.count_nonzero(loaded)} of {Q.size} loaded")
        ax.set_title(f"Ball loads, N (largest {largest:.4g} N)", pad=14)
        ax.tick_params(labelsize=8, colors=GREY)
        ax.grid(color="0.85", linewidth=0.6)
        ax.set_axisbelow(True)
    return ax


def layer_stiffness(layers: Mapping[str, Layer], frequency: ArrayLike, ax: Axes | None = None) -> Axes:
    """|k| against frequency, radial (solid) and axial (dashed), of layers held outside and moved inside.

    frequency: (f,) Hz, positive; a static solution is made at each.

    Raises ValueError for frequencies that are not positive and finite.
    """
    f = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
    if f.ndim != 1 or f.size == 0 or not (np.isfinite(f).all() and (f > 0).all()):
        raise ValueError("frequency must be a list of positive, finite values, in Hz")
    with style():
        ax = ax or _new()
        for k, (label, layer) in enumerate(_some(layers).items()):
            stiffness = np.array([layer.stiffness(2 * np.pi * value) for value in f])
            for way, i, dash in (("radial", 0, "-"), ("axial", 2, "--")):
                ax.loglog(
                    f, np.abs(stiffness[:, i, i]), color=_cycle(k), linestyle=dash, label=f"{label}, {way}"
                )
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("dynamic stiffness |k|, N/m")
        _finish(ax, "Stiffness of layers", legend=True)
    return ax


# ---------------------------------------------------------------- what the figures share


def _some(datasets: Mapping[str, Any]) -> Mapping[str, Any]:
    if not datasets:
        raise ValueError("there is nothing to draw; give at least one result with its label")
    return datasets


def _letter(mode: str) -> str:
    return "G" if mode == "shear" else "E"


def _cycle(k: int) -> str:
    return COLOURS[k % len(COLOURS)]


def _new(width: float = 6.2, height: float = 3.4, projection: str | None = None) -> Axes:
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(width, height), layout="constrained")
    return figure.add_subplot(projection=projection)


def _halve(ax: Axes, share: float = 0.45) -> Axes:
    """New axes that take the lower share of the room of `ax`, on the same horizontal axis."""
    figure = ax.figure
    spec = ax.get_subplotspec()
    if spec is not None:
        halves = spec.subgridspec(2, 1, height_ratios=[1 - share, share])
        ax.set_subplotspec(halves[0])
        lower = figure.add_subplot(halves[1], sharex=ax)
    else:
        box = ax.get_position()
        gap = 0.03 * box.height
        cut = box.y0 + share * box.height
        ax.set_position((box.x0, cut + gap, box.width, box.y1 - cut - gap))
        lower = figure.add_axes((box.x0, box.y0, box.width, cut - gap - box.y0), sharex=ax)
    ax.tick_params(axis="x", which="both", labelbottom=False)
    return lower


def _finish(ax: Axes, title: str = "", legend: bool = False) -> None:
    """Frame, ticks and grid; title on the left, the legend in rows between it and the data."""
    ax.spines[["top", "right"]].set_visible(False)
    # said here since ticks are made when they are drawn, outside the style's context
    ax.tick_params(which="both", labelsize=8.5, width=0.7)
    ax.tick_params(which="major", length=3.5)
    ax.tick_params(which="minor", length=2.0)
    ax.grid(which="major", color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    rows = 0
    if legend:
        handles, labels = ax.get_legend_handles_labels()
        # about twelve letters an inch, five for the sample of the line
        room = max(1, int(12 * ax.bbox.width / ax.figure.dpi / (max(map(len, labels)) + 5)))
        columns = min(len(labels), LEGEND_COLUMNS, room)
        rows = -(-len(labels) // columns)
        ax.legend(
            handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns,
            borderaxespad=0.2, borderpad=0.2, handlelength=2.2, columnspacing=1.4,
        )  # fmt: skip
    if title:
        ax.set_title(title, loc="left", pad=6.0 + 14.0 * rows)


def _temperature_scale(temperature: NDArray[np.float64]) -> Normalize:
    from matplotlib.colors import Normalize

    return Normalize(float(temperature.min()), float(temperature.max()))


def _colour(scale: Normalize, temperature: float) -> tuple[float, ...]:
    import matplotlib

    return tuple(matplotlib.colormaps[TEMPERATURES](float(scale(temperature))))


def _colourbar(ax: Axes, lower: Axes, scale: Normalize) -> None:
    from matplotlib.cm import ScalarMappable

    bar = ax.figure.colorbar(ScalarMappable(scale, TEMPERATURES), ax=[ax, lower], aspect=35, pad=0.02)
    bar.set_label("temperature, °C")
    bar.outline.set_visible(False)  # type: ignore[operator]
    bar.ax.tick_params(labelsize=8.5, width=0.7)


def _span(ax: Axes, *grids: NDArray[np.float64]) -> None:
    """The whole frequency range of the curves, on a log axis where it is wide and does not touch zero."""
    low, high = min(float(g.min()) for g in grids), max(float(g.max()) for g in grids)
    if low > 0 and high / low >= 50:
        ax.set_xscale("log")
    if high > low:
        ax.set_xlim(low, high)


def _is_rotation(channel: str) -> bool:
    return channel.rpartition(".")[2] in ("θx", "θy", "θz", "rx", "ry", "rz")


def _cause(channel: str) -> str:
    return "moment" if _is_rotation(channel) else "force"


def _response_unit(quantity: str, output: str, input: str) -> str:
    motion = "rad" if _is_rotation(output) else "m"
    motion += {"displacement": "", "velocity": "/s", "acceleration": "/s²"}[quantity]
    return f"{motion} per {'N m' if _is_rotation(input) else 'N'}"


def _cut_jumps(degrees: NDArray[np.float64]) -> NDArray[np.float64]:
    """A phase whose curve is broken where it wraps from one end of the scale to the other."""
    broken = degrees.copy()
    broken[1:][np.abs(np.diff(degrees)) > 180] = np.nan
    return broken


def _mark(ax: Axes, lines: Mapping[str, float]) -> None:
    """Dashed verticals with their names along them; a name that would touch its neighbour stands lower."""
    if not lines:
        return
    # in shares of the axes: height of the longest name, a letter being 0.62 of its size wide, and a line's width
    letter = 8.0 * POINT * ax.figure.dpi
    row_height = max(map(len, lines)) * 0.62 * letter / ax.bbox.height + 0.03
    width = 1.6 * letter / ax.bbox.width
    taken: list[float] = []
    high = ax.get_xlim()[1]
    for name, frequency in sorted(lines.items(), key=lambda item: item[1]):
        x = frequency / high
        row = next((r for r, last in enumerate(taken) if x - last >= width), len(taken))
        taken[row : row + 1] = [x]
        ax.axvline(frequency, color=GREY, linestyle=(0, (3, 3)), linewidth=0.7, zorder=1)
        ax.text(
            frequency, 0.985 - row * row_height, f"{name} ", rotation=90, rotation_mode="default",
            transform=ax.get_xaxis_transform(), ha="right", va="top", fontsize=8, color=GREY, zorder=5,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.5},
        )  # fmt: skip
