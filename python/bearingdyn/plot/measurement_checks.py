"""Figures that judge a measurement: causality, Cole–Cole, van Gurp–Palmen, relaxation spectrum."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.material import KK_LIMIT, DMAData, MasterCurve, Maxwell, kk_ratio, suspects
from bearingdyn.plot.arguments import figure, maybe, one, several
from bearingdyn.plot.frame import COLOURS, colour, finish, new_axes, some, style, written_out
from bearingdyn.plot.isotherms import letter_of
from bearingdyn.plot.temperature_colours import temperature_bar, temperature_colour, temperature_scale
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASURED = one(DMAData, MasterCurve, maker="the result of `read_dma` or `master_curve`")
MODEL = one(Maxwell, maker="a bd.Maxwell(…)")


@figure(dma=one(DMAData, maker="the result of `read_dma`"))
def causality(dma: DMAData, ax: Axes | None = None) -> Axes:
    """Draw a check of a measurement's causality: Kramers–Kronig ratio G″/((π/2) dG′/d ln ω) by frequency.

    The ratio of a causal material with a broad spectrum is near one. Points that no passive material could
    give are crossed. The dotted line is the limit for the median over the isotherms.

    Parameters
    ----------
    dma
        Measured isotherms.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    ratio = kk_ratio(dma)
    flagged, _ = suspects(dma)
    with style():
        ax = ax or new_axes()
        scale = temperature_scale(dma.temperature)
        for k in range(int(dma.labels.max()) + 1):
            index = np.flatnonzero(dma.labels == k)
            look = temperature_colour(scale, float(dma.temperature[index].mean()))
            ax.loglog(dma.frequency[index], ratio[index], color=look, marker=".", markersize=3, linewidth=0.8)
        ax.axhline(1.0, color="0.5", linewidth=0.7, zorder=0)
        ax.axhline(KK_LIMIT, color="0.5", linewidth=0.7, linestyle=":", zorder=0)
        if flagged.any():
            crossed = flagged & np.isfinite(ratio)
            ax.plot(
                dma.frequency[crossed], ratio[crossed], "x", color=COLOURS[1], markersize=5, label="left out"
            )
        known = ratio[np.isfinite(ratio)]
        if known.size:
            ax.set_ylim(min(0.3, float(known.min())), float(np.clip(known.max() * 1.1, 3.0, 20.0)))
        temperature_bar([ax], scale)
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("local Kramers–Kronig ratio")
        finish(ax, "Causality of the isotherms", legend=bool(flagged.any()))
    return ax


@figure(data=MEASURED, maxwell=maybe(MODEL))
def cole_cole(data: DMAData | MasterCurve, maxwell: Maxwell | None = None, ax: Axes | None = None) -> Axes:
    """Draw a check of a measurement by Cole and Cole: loss over storage modulus, logarithmic, with a model.

    Shifts along the frequency do not move it: isotherms that do not form one curve do not superpose.

    Parameters
    ----------
    data
        Isotherms or a master curve.
    maxwell
        Model drawn over its band; None: points only.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    letter = letter_of(data.mode)
    with style():
        ax = _free_of_frequency(data, maxwell, ax, lambda G: (G.real / 1e6, G.imag / 1e6))
        ax.set_yscale("log")
        written_out(ax.yaxis, float(np.ptp(np.log10(data.loss))))
        ax.set_xlabel(f"storage modulus {letter}′, MPa")
        ax.set_ylabel(f"loss modulus {letter}″, MPa")
        finish(ax, "Cole–Cole", legend=maxwell is not None)
    return ax


@figure(data=MEASURED, maxwell=maybe(MODEL))
def van_gurp_palmen(
    data: DMAData | MasterCurve, maxwell: Maxwell | None = None, ax: Axes | None = None
) -> Axes:
    """Draw a check of a measurement by van Gurp and Palmen: phase angle against magnitude of the modulus.

    Like Cole–Cole it is free of frequency, so that no shift can hide scatter.

    Parameters
    ----------
    data
        Isotherms or a master curve.
    maxwell
        Model drawn over its band; None: points only.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    letter = letter_of(data.mode)
    with style():
        ax = _free_of_frequency(data, maxwell, ax, lambda G: (np.abs(G) / 1e6, np.degrees(np.angle(G))))
        ax.set_ylim(bottom=0.0)
        ax.set_xlabel(f"|{letter}*|, MPa")
        ax.set_ylabel("phase angle δ, °")
        finish(ax, "van Gurp–Palmen", legend=maxwell is not None)
    return ax


@figure(materials=several(Maxwell, maker="a bd.Maxwell(…)"))
def spectrum_of(materials: Mapping[str, Maxwell], ax: Axes | None = None) -> Axes:
    """Draw a check of a measurement's models, their relaxation spectra: strength over time, as stems.

    Parameters
    ----------
    materials
        Models by label.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If there is no model, or none has a branch.
    """
    if not any(m.G.size for m in some(materials).values()):
        raise ValueError("there is nothing to draw; no model has a branch")
    with style():
        ax = ax or new_axes()
        low = min(float(m.G[m.G > 0].min()) for m in materials.values() if (m.G > 0).any()) / 1e6
        for k, (label, material) in enumerate(materials.items()):
            tau, G = material.spectrum()
            ax.vlines(tau, low / 3, G / 1e6, color=colour(k), linewidth=1.0)
            ax.plot(tau, G / 1e6, "o", markersize=4, color=colour(k), label=f"{label}, {tau.size} branches")
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_ylim(bottom=low / 3)
        ax.set_xlabel("relaxation time τ, s")
        ax.set_ylabel("strength G, MPa")
        finish(ax, "Relaxation spectrum", legend=True)
    return ax


def _free_of_frequency(
    data: DMAData | MasterCurve,
    maxwell: Maxwell | None,
    ax: Axes | None,
    of: Callable[[Complex], tuple[Array, Array]],
) -> Axes:
    """Two figures of the complex modulus, Pa, against each other, the first on a log axis: data and model."""
    ax = ax or new_axes(width=5.0, height=4.0)
    x, y = of(data.storage + 1j * data.loss)
    _scatter(ax, data, x, y)
    if maxwell is not None:
        ax.plot(*of(np.asarray(_model(data, maxwell))), color=COLOURS[1], label=_name(maxwell))
    ax.set_xscale("log")
    written_out(ax.xaxis, float(np.ptp(np.log10(x))))
    return ax


def _scatter(ax: Axes, data: DMAData | MasterCurve, x: Array, y: Array) -> None:
    scale = temperature_scale(data.temperature)
    colours = [temperature_colour(scale, float(T)) for T in data.temperature]
    ax.scatter(x, y, c=colours, s=7, linewidths=0)
    temperature_bar([ax], scale)


def _model(data: DMAData | MasterCurve, maxwell: Maxwell) -> Complex:
    """Modulus of the model over its band, or the measured frequencies, in the mode of the data, Pa."""
    low, high = maxwell.band or (float(data.frequency.min()), float(data.frequency.max()))
    modulus = maxwell.complex_modulus(2 * np.pi * np.geomspace(low, high, 300))
    if data.mode == "tension":
        modulus = 9 * maxwell.K * modulus / (3 * maxwell.K + modulus)
    return modulus


def _name(maxwell: Maxwell) -> str:
    return f"Maxwell model, {maxwell.G.size} branches"
