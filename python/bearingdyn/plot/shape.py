"""Mode shapes of shafts, drawn on their own outline."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from bearingdyn.analysis import Equilibrium
from bearingdyn.application import Application
from bearingdyn.parts import Shaft
from bearingdyn.plot.frame import COLOURS, finish, new_axes, style
from bearingdyn.system import System

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

HEIGHT = 0.35  # largest deflection drawn, of the longest shaft's length
STATIONS = 30  # points drawn between two places whose motion is known, and for each section


def mode_shape(
    app: Application,
    source: Equilibrium | System,
    modes: xarray.Dataset,
    mode: int = 0,
    ax: Axes | None = None,
) -> Axes:
    """Shape of one mode on the shafts of an application: outline at rest, and deflected where it moves most.

    app: what `source` was made from; its shafts give the outline: sections, and for each disc the cylinder
    of its mass and moments. modes: by bd.modes of `source`; mode: which, from 0. The motion is known at seats
    and points, with its slope; between them a cubic is drawn, beyond them a line: give a shaft more points
    where that is too coarse. Both lateral directions are drawn, at the instant of the largest motion, and the
    place of each bearing's outer ring, where it moves.

    Raises ValueError if there is no shaft or no such mode.
    """
    shafts = {name: part for name, part in app.sources.items() if isinstance(part, Shaft)}
    if not shafts:
        raise ValueError("the application has no Shaft; mode shapes are drawn on shafts")
    count = modes.sizes["mode"]
    if not 0 <= mode < count:
        raise ValueError(f"mode is {mode}; there are {count}, counted from 0")
    system = source.system if isinstance(source, Equilibrium) else source
    shape = modes["shape"].values[mode]
    motions = {name: _stations(name, part, system, shape) for name, part in shafts.items()}
    # the instant of the largest lateral motion: the phase that makes the sum of squares real
    lateral = np.concatenate([u[:, [0, 1]].ravel() for _, u in motions.values()])
    turn = np.exp(-0.5j * np.angle((lateral**2).sum()))
    largest = float(np.abs((lateral * turn).real).max()) or 1.0
    length = max(part.length for part in shafts.values())
    scale = HEIGHT * length / largest
    total = {axis: sum(float((np.real(u[:, k] * turn) ** 2).sum()) for _, u in motions.values())
             for k, axis in enumerate("xy")}  # fmt: skip
    main = max(total, key=lambda axis: total[axis])
    from matplotlib.patches import Rectangle

    with style():
        ax = ax or new_axes(width=6.6, height=3.2)
        for part in shafts.values():
            z, r = _outline(part)
            ax.fill_between(z, -r, r, color="0.92", linewidth=0, zorder=0)
            ax.plot(z, r, color="0.6", linewidth=0.6, zorder=1)
            ax.plot(z, -r, color="0.6", linewidth=0.6, zorder=1)
            for disc in part.discs:
                radius = np.sqrt(2 * disc.Ip / disc.mass)
                width = np.sqrt(max(12 * disc.Id / disc.mass - 3 * radius**2, 0.0))
                corner = (disc.z - width / 2, -radius)
                ax.add_patch(Rectangle(corner, width, 2 * radius, facecolor="0.86", edgecolor="0.6", lw=0.6))
        for k, axis in enumerate("xy"):
            for i, (name, part) in enumerate(shafts.items()):
                place, u = motions[name]
                z, line = _curve(place, np.real(u * turn) * scale, k, part.length)
                label = f"{axis}, {'horizontal' if axis == 'x' else 'vertical'}" if i == 0 else None
                ax.plot(z, line, color=COLOURS[k], linewidth=1.4, label=label, zorder=3)
                ax.plot(place, np.real(u[:, k] * turn) * scale, "o", color=COLOURS[k], markersize=3, zorder=3)
                if axis == main:
                    at, r = _outline(part)
                    middle = np.interp(at, z, line)
                    ax.fill_between(at, middle - r, middle + r, color=COLOURS[k], alpha=0.14, linewidth=0)
        marked = False
        for hung in app.bearings.values():
            owner, _, seat = hung.inner.partition(".")
            known = shafts.get(owner)
            if known is None or seat not in known.seats or hung.outer not in system.outputs:
                continue
            ring = np.real(system.rows(hung.outer)["xy".index(main)] @ shape * turn) * scale
            label = None if marked else f"outer rings, {main}"
            ax.plot(
                known.seats[seat], ring, "s", color="k", markerfacecolor="none", markersize=6, label=label
            )
            marked = True
        ax.set_xlabel("z, m")
        ax.set_yticks([])
        f, zeta = float(modes["frequency"][mode]), float(modes["damping_ratio"][mode])
        finish(
            ax,
            f"Mode {mode + 1}: {f:.4g} Hz, damping ratio {zeta:.2g}; scale arbitrary",
            legend=True,
        )
        ax.spines["left"].set_visible(False)
    return ax


def _stations(name: str, part: Shaft, system: System, shape: NDArray[Any]) -> tuple[Array, NDArray[Any]]:
    """Places (s,), m, rising, and motions (s, 6), complex, at the seats and points of a shaft."""
    places = sorted({**part.points, **part.seats}.items(), key=lambda item: item[1])
    z = np.array([at for _, at in places])
    return z, np.array([system.rows(f"{name}.{key}") @ shape for key, _ in places])


def _curve(z: Array, u: Array, k: int, length: float) -> tuple[Array, Array]:
    """Centre line over the whole shaft: cubics between stations, by values and slopes; lines at the ends."""
    # u = θ × z: ∂u_x/∂z = θ_y, ∂u_y/∂z = −θ_x
    value, slope = u[:, k], u[:, 4] if k == 0 else -u[:, 3]
    if z.size == 1:
        at = np.array([0.0, length])
        return at, value[0] + slope[0] * (at - z[0])
    from scipy.interpolate import CubicHermiteSpline

    spline = CubicHermiteSpline(z, value, slope)
    inner = np.unique(np.concatenate([np.linspace(a, b, STATIONS) for a, b in pairwise(z.tolist())]))
    at = np.concatenate([[0.0], inner, [length]])
    ends = value[0] + slope[0] * (0.0 - z[0]), value[-1] + slope[-1] * (length - z[-1])
    return at, np.concatenate([[ends[0]], spline(inner), [ends[1]]])


def _outline(part: Shaft) -> tuple[Array, Array]:
    """Radius (p,), m, along z (p,), m, many points for each section."""
    ends = np.concatenate([[0.0], np.cumsum([section.length for section in part.sections])])
    z = [np.linspace(a, b, STATIONS) for a, b in pairwise(ends.tolist())]
    r = [np.full(STATIONS, section.d_outer / 2) for section in part.sections]
    return np.concatenate(z), np.concatenate(r)
