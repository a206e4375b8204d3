"""Figures of measured isotherms and their superposition: isotherms, master curve, shifts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.material import DMAData, MasterCurve, Maxwell, OutsideBand, ShiftTable
from bearingdyn.notice import untold
from bearingdyn.plot.arguments import figure, maybe, one
from bearingdyn.plot.frame import COLOURS, finish, frame_log, halve, new_axes, style
from bearingdyn.plot.temperature_colours import (
    temperature_bar,
    temperature_colour,
    temperature_colours,
    temperature_scale,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@figure(dma=one(DMAData, maker="the result of `read_dma`"))
def isotherms(dma: DMAData, ax: Axes | None = None) -> Axes:
    """Draw isotherms: storage modulus, and loss factor below it, against frequency, coloured by temperature.


    Parameters
    ----------
    dma
        Measured isotherms.
    ax
        Axes to draw into, halved; None: those of a new figure.

    Returns
    -------
    Axes
        The axes of the storage modulus.
    """
    letter = letter_of(dma.mode)
    with style():
        ax = ax or new_axes(height=4.8)
        colours = temperature_scale(dma.temperature)
        lower = halve(ax)
        for sweep in dma.isotherms:
            look: dict[str, Any] = {
                "color": temperature_colour(colours, float(sweep.temperature.mean())),
                "marker": ".",
            }
            ax.loglog(sweep.frequency, sweep.storage / 1e6, markersize=3, linewidth=0.8, **look)
            lower.loglog(sweep.frequency, sweep.tan_delta, markersize=3, linewidth=0.8, **look)
        temperature_bar([ax, lower], colours)
        ax.set_ylabel(f"storage modulus {letter}′, MPa")
        lower.set_ylabel("loss factor tan δ")
        frame_log(ax, dma.storage / 1e6)
        frame_log(lower, dma.tan_delta)
        lower.set_xlabel("frequency, Hz")
        finish(ax, f"Isothermal sweeps in {dma.mode}")
        finish(lower)
    return ax


@figure(
    curve=one(MasterCurve, maker="the result of `master_curve`"),
    maxwell=maybe(one(Maxwell, maker="a bd.Maxwell(…)")),
)
def master(curve: MasterCurve, maxwell: Maxwell | None = None, ax: Axes | None = None) -> Axes:
    """Draw isotherms as a master curve: storage modulus and loss factor against reduced frequency.

    Points are coloured by the temperature they were measured at. The band of the fit is shaded. Outside it
    the model is an extrapolation, and dashed. A curve measured in tension is compared with
    E* = 9 K G*/(3 K + G*) of the model.

    Parameters
    ----------
    curve
        Master curve.
    maxwell
        Model at the reference temperature of the curve; None: points only.
    ax
        Axes to draw into, halved; None: those of a new figure.

    Returns
    -------
    Axes
        The axes of the storage modulus.

    Raises
    ------
    ValueError
        If the model holds at another temperature than the curve.
    """
    if maxwell is not None and maxwell.temperature not in (None, curve.T_ref):
        raise ValueError(
            f"maxwell holds at {maxwell.temperature} °C, the master curve at {curve.T_ref} °C; "
            f"pass maxwell.at({curve.T_ref})"
        )
    letter = letter_of(curve.mode)
    with style():
        ax = ax or new_axes(height=4.8)
        colours = temperature_scale(curve.temperature)
        lower = halve(ax)
        for panel, values in ((ax, curve.storage / 1e6), (lower, curve.tan_delta)):
            panel.set_xscale("log")
            panel.set_yscale("log")
            panel.scatter(
                curve.frequency,
                values,
                c=curve.temperature,
                norm=colours,
                cmap=temperature_colours(),
                s=7,
                linewidths=0,
            )
        if maxwell is not None:
            _draw_model(ax, lower, curve, maxwell)
        temperature_bar([ax, lower], colours)
        ax.set_ylabel(f"storage modulus {letter}′, MPa")
        lower.set_ylabel("loss factor tan δ")
        frame_log(ax, curve.storage / 1e6)
        frame_log(lower, curve.tan_delta)
        lower.set_xlabel(f"reduced frequency at {curve.T_ref:g} °C, Hz")
        finish(ax, f"Master curve at {curve.T_ref:g} °C, {curve.mode}", legend=maxwell is not None)
        finish(lower)
    return ax


def _draw_model(ax: Axes, lower: Axes, curve: MasterCurve, maxwell: Maxwell) -> None:
    low, high = float(curve.frequency[0]), float(curve.frequency[-1])
    band = maxwell.band
    if band is not None:
        low, high = min(low, band[0]), max(high, band[1])
    f = np.geomspace(low, high, 400)
    with untold(OutsideBand):  # it is drawn dashed
        modulus = maxwell.complex_modulus(2 * np.pi * f)
    if curve.mode == "tension":
        modulus = 9 * maxwell.K * modulus / (3 * maxwell.K + modulus)
    values = ((ax, modulus.real / 1e6), (lower, modulus.imag / modulus.real))
    name = f"Maxwell model, {maxwell.G.size} branches"
    edges = "" if band is None else " to ".join(f"{float(f'{edge:.3g}'):g}" for edge in band)
    for panel, value in values:
        value = np.where(value > 0, value, np.nan)
        if band is None:
            panel.plot(f, value, color=COLOURS[1], label=name)
            continue
        inside = (f >= band[0]) & (f <= band[1])
        panel.axvspan(*band, color="0.92", zorder=0, label=f"band of the fit, {edges} Hz")
        panel.plot(f, value, color=COLOURS[1], linestyle=(0, (4, 2)), linewidth=0.8)
        panel.plot(f, np.where(inside, value, np.nan), color=COLOURS[1], linewidth=1.6, label=name)


@figure(curve=one(MasterCurve, maker="the result of `master_curve`"))
def shifts(curve: MasterCurve, ax: Axes | None = None) -> Axes:
    """Draw the shifts of isotherms, log10 a_T, two standard errors each way, with the law fitted to them.

    Parameters
    ----------
    curve
        Master curve.
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.
    """
    if curve.law is None:
        raise ValueError("curve is one sweep, which has no shifts; draw it by plot.master(curve)")
    T = np.array(list(curve.shifts))
    values = np.array([curve.shifts[t] for t in T.tolist()])
    errors = np.array([curve.shift_errors[t] for t in T.tolist()])
    name = {"WLF": "WLF law", "Arrhenius": "Arrhenius law", "Joined": "WLF and Arrhenius"}.get(
        type(curve.law).__name__
    )
    label = f"{name}, rms {curve.law_residual:.2g} decades" if name else "interpolation"
    with style():
        ax = ax or new_axes()
        grid = np.linspace(T.min(), T.max(), 200)
        if isinstance(curve.law, ShiftTable):
            grid = np.clip(grid, curve.law.T[0], curve.law.T[-1])
        ax.axhline(0.0, color="0.8", linewidth=0.7, zorder=0)
        ax.plot(grid, curve.law.log_shift(grid), color=COLOURS[1], label=label)
        ax.errorbar(
            T, values, 2 * errors, fmt="o", markersize=4, capsize=2, color=COLOURS[0],
            label="isotherms, ±2 standard errors",
        )  # fmt: skip
        ax.set_xlabel("temperature, °C")
        ax.set_ylabel(r"shift $\log_{10}\,a_T$, decades")
        finish(ax, f"Time–temperature shifts to {curve.T_ref:g} °C", legend=True)
    return ax


def letter_of(mode: str) -> str:
    """Letter of the modulus that a figure of isotherms shows: G in shear, E in tension."""
    return "G" if mode == "shear" else "E"
