"""Figures of bearings: who carries the load, stiffness, film, and the lines they leave in a spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.bearing import BallBearing, LoadDistribution, Lubricant, Running, fault_lines, lubricate
from bearingdyn.bearing import waviness_lines as lines_of_waviness
from bearingdyn.plot.frame import DASHES, colour, finish, halve, new_axes, some, style
from bearingdyn.plot.motion import spectrum
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

STIFFNESSES = {"x": 0, "y": 1, "z": 2, "θx": 3, "θy": 4}


def load_distribution(distributions: Mapping[str, LoadDistribution], ax: Axes | None = None) -> Axes:
    """Loads of the inner contacts, N, around the bearing, several states by label: azimuth from x towards y.

    Parameters
    ----------
    distributions
        States by label, each by `bearing.load_distribution`.
    ax
        Axes to draw into, polar; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        If there are none or the axes are not polar.
    """
    if ax is not None and ax.name != "polar":
        raise ValueError(f"ax has the projection {ax.name!r}; a load distribution needs projection='polar'")
    from matplotlib.ticker import MaxNLocator

    with style():
        ax = ax or new_axes(width=4.8, height=4.8, projection="polar")
        scale: Any = ax  # polar
        largest = max(float(d.load_inner.max()) for d in some(distributions).values())
        for k, (label, d) in enumerate(distributions.items()):
            # out and back at each ball: a line without area, so that several states stay readable
            psi = np.repeat(d.azimuth, 3)
            spokes = np.column_stack([0 * d.load_inner, d.load_inner, 0 * d.load_inner]).ravel()
            ax.plot(psi, spokes, color=colour(k), linewidth=max(4.0 - 1.6 * k, 0.8))
            around = np.append(d.azimuth, d.azimuth[0] + 2 * np.pi)
            ring = np.append(d.load_inner, d.load_inner[0])
            name = f"{label}: {d.loaded} of {d.azimuth.size} loaded"
            ax.plot(
                around, ring, color=colour(k), linestyle=DASHES[k % len(DASHES)], marker="o", ms=3, label=name
            )
        ax.set_ylim(0.0, 1.05 * largest if largest > 0 else 1.0)
        ax.yaxis.set_major_locator(MaxNLocator(4))
        scale.set_rlabel_position(200.0)
        ax.set_xticks(np.radians([0, 90, 180, 270]), ["x", "y", "−x", "−y"])
        ax.set_xlabel("load of the inner contact, N, over the azimuth")
        ax.set_title(f"Load distribution, the largest {largest:.4g} N", pad=14)
        ax.tick_params(labelsize=8)
        ax.grid(color="0.85", linewidth=0.6)
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12))
    return ax


def bearing_stiffness(
    bearings: Mapping[str, BallBearing | Running],
    direction: ArrayLike,
    loads: ArrayLike,
    component: str = "x",
    ax: Axes | None = None,
) -> Axes:
    """Diagonal stiffness against load, several bearings by label, both axes logarithmic.

    Parameters
    ----------
    bearings
        Bearings by label, at rest, or with the inertia of their balls.
    direction
        (6,) load per unit of `loads`, N and N m; (1, 0, 0, 0, 0, 0) for a radial load.
    loads
        (n,) increasing and positive.
    component
        "x", "y", "z" (N/m), "θx" or "θy" (N m).
    ax
        Axes to draw into; None: those of a new figure.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        For an unknown component or loads that do not increase from above zero.
    """
    F = np.asarray(loads, dtype=np.float64)
    if component not in STIFFNESSES:
        raise ValueError(f"component is {component!r}; it must be one of {', '.join(STIFFNESSES)}")
    if F.ndim != 1 or F.size < 2 or not (F > 0).all() or not (np.diff(F) > 0).all():
        raise ValueError("loads must be two or more positive numbers that increase, in N")
    k = STIFFNESSES[component]
    unit = np.asarray(direction, dtype=np.float64)
    curves = {
        label: [float(b.stiffness(b.displacement(force * unit))[k, k]) for force in F]
        for label, b in some(bearings).items()
    }
    with style():
        ax = ax or new_axes()
        for j, (label, values) in enumerate(curves.items()):
            ax.plot(F, values, color=colour(j), linestyle=DASHES[j % len(DASHES)], label=label)
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlim(float(F[0]), float(F[-1]))
        ax.set_xlabel("load, N")
        ax.set_ylabel(f"stiffness {component}{component}, {'N/m' if k < 3 else 'N m'}")
        finish(ax, "Stiffness of the bearing at its equilibrium", legend=True)
    return ax


def film(
    bearing: BallBearing,
    lubricant: Lubricant,
    temperatures: ArrayLike,
    speeds: ArrayLike,
    load: ArrayLike,
    ax: Axes | None = None,
    *,
    roughness: tuple[float, float] | None = None,
    starvation: float = 1.0,
) -> Axes:
    """Central films of both races against speed, rpm, a colour for each temperature in °C; with roughness, λ.

    With a roughness the axes are halved, and λ, the film over the composite roughness, stands below.

    Parameters
    ----------
    bearing
        Its own film and damping are not used.
    lubricant
        Oil, or base oil of a grease.
    temperatures
        (k,) at the inlet of the contacts, °C.
    speeds
        (n,) of the inner ring, rad/s, increasing and positive.
    load
        (6,) on the inner ring, N and N m.
    ax
        Axes to draw into; None: those of a new figure.
    roughness
        Rms roughness of race and ball, m.
    starvation
        Film over fully flooded film, in 0..1.

    Returns
    -------
    Axes
        The axes of the film.

    Raises
    ------
    ValueError
        For speeds that do not increase from above zero, and as `bearing.lubricate`.
    """
    omega = np.asarray(speeds, dtype=np.float64)
    if omega.ndim != 1 or omega.size < 2 or not (omega > 0).all() or not (np.diff(omega) > 0).all():
        raise ValueError("speeds must be two or more positive numbers that increase, in rad/s")
    grid: Array = np.atleast_1d(np.asarray(temperatures, dtype=np.float64))
    found = {
        float(T): [
            lubricate(
                bearing, lubricant, float(T), float(s), load, roughness=roughness, starvation=starvation
            )
            for s in omega
        ]
        for T in grid
    }
    rpm = omega * 30 / np.pi
    with style():
        ax = ax or new_axes(height=3.4 if roughness is None else 4.8)
        lower = None if roughness is None else halve(ax)
        for k, (T, points) in enumerate(found.items()):
            for race, dash in (("inner", "-"), ("outer", "--")):
                h = [getattr(point, f"film_{race}") * 1e6 for point in points]
                ax.plot(rpm, h, color=colour(k), linestyle=dash, label=f"{race} race, {T:g} °C")
                if lower is not None:
                    ratio = [getattr(point, f"lambda_{race}") for point in points]
                    lower.plot(rpm, ratio, color=colour(k), linestyle=dash)
        ax.set_yscale("log")
        ax.set_ylabel("central film, µm")
        bottom = lower or ax
        bottom.set_xscale("log")
        bottom.set_xlim(float(rpm[0]), float(rpm[-1]))
        bottom.set_xlabel("speed of the inner ring, rpm")
        if lower is not None:
            lower.set_yscale("log")
            lower.axhline(1.0, color="0.35", linewidth=0.7)
            lower.set_ylabel("λ ratio")
            finish(lower)
        finish(ax, "Lubricant film", legend=True)
    return ax


def bearing_spectrum(
    datasets: Mapping[str, xarray.Dataset],
    bearing: BallBearing,
    speed: float,
    ax: Axes | None = None,
    *,
    f_max: float | None = None,
    harmonics: int = 1,
    waviness: bool = False,
    contact_angle: float | None = None,
) -> Axes:
    """Spectra as `spectrum` draws them, with the lines of the bearing's faults, or waviness, named.

    A wave at the frequency of a fault goes by the name of the fault.

    Parameters
    ----------
    datasets
        Spectra by label, as `spectrum` takes them.
    bearing
        The bearing whose lines are named.
    speed
        Of the inner ring, rad/s.
    ax
        Axes to draw into; None: those of a new figure.
    f_max
        Highest frequency drawn, Hz; None: the whole of the spectra.
    harmonics
        Multiples of the ball passes.
    waviness
        Name the lines of waviness too.
    contact_angle
        Of the loaded state, rad.

    Returns
    -------
    Axes
        The axes drawn into.

    Raises
    ------
    ValueError
        As `spectrum`, `fault_lines` and `waviness_lines`.
    """
    lines = fault_lines(bearing, speed, harmonics=harmonics, contact_angle=contact_angle)
    if waviness:
        waves = lines_of_waviness(bearing, speed, multiples=harmonics, contact_angle=contact_angle)
        known = list(lines.values())
        lines |= {name: f for name, f in waves.items() if not np.isclose(known, f, rtol=1e-9).any()}
        if ax is None:
            with style():
                ax = new_axes(width=6.8, height=4.8)  # room for the names
    return spectrum(datasets, lines, ax, f_max=f_max)
