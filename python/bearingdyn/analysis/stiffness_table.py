"""Stiffness of a bearing over load and speed, and files in which other programs take it."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.application import COMPONENTS
from bearingdyn.bearing import BallBearing, Running
from bearingdyn.checks import instance, numbers, one_of, real, require, whole
from bearingdyn.notice import UnloadedBearing, warn
from bearingdyn.types import Array
from bearingdyn.writing import write_whole

if TYPE_CHECKING:
    import xarray

Format = Literal["csv", "ross", "abaqus", "calculix", "nastran"]
_FORMATS: tuple[Format, ...] = ("csv", "ross", "abaqus", "calculix", "nastran")


def stiffness_table(
    bearing: BallBearing, loads: ArrayLike, speeds: ArrayLike = (0.0,), *, damping_time: float = 0.0
) -> xarray.Dataset:
    """Tangent stiffness (6, 6) of a bearing under each load and at each speed of the shaft.

    Parameters
    ----------
    bearing
        Ball bearing.
    loads
        (m, 6) on the inner ring, N and N m.
    speeds
        (k,) rad/s; at speed the balls have their inertia (`Running`), θz is free.
    damping_time
        s; the damping is this time the stiffness (0: none). Contacts have 1e-6 to 1e-5 s.

    Returns
    -------
    xarray.Dataset
        Over "speed" and "load": stiffness and damping ("row", "column"), displacement ("row"), and the load
        itself, in N, m, rad.

    Raises
    ------
    ValueError
        For loads of another shape, or as `BallBearing.displacement`.

    Warns
    -----
    UnloadedBearing
        For a load of zero.
    BearingWarning
        As `BallBearing.displacement`.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> ball = bd.catalogue.bearing("6205")
    >>> table = bd.stiffness_table(ball, [[0, -1000.0, 200.0, 0, 0, 0]], [0.0, 1000.0])
    >>> table["stiffness"].dims, table["stiffness"].shape
    (('speed', 'load', 'row', 'column'), (2, 1, 6, 6))
    """
    instance("bearing", bearing, BallBearing, "give a BallBearing")
    try:
        f = real(loads)
    except (TypeError, ValueError):
        f = np.zeros(0)
    good = f.ndim == 2 and f.shape[1:] == (6,) and len(f) > 0 and bool(np.isfinite(f).all())
    require(good, "loads", loads, "it must be (m, 6), finite, in N and N m")
    omega = numbers("speeds", speeds, "give one or more speeds in rad/s")
    tau = numbers("damping_time", damping_time, "it must be zero or positive, in s", 0.0)[0]
    K, q = np.zeros((len(omega), len(f), 6, 6)), np.zeros((len(omega), len(f), 6))
    if not f.any(axis=1).all():
        warn(
            f"loads[{int(np.argmin(f.any(axis=1)))}] is zero: a bearing that bears nothing has no stiffness, "
            f"unless it is clamped",
            UnloadedBearing,
        )
    for i, speed in enumerate(omega):
        state: BallBearing | Running = bearing if speed == 0 else Running(bearing, float(speed))
        for j, load in enumerate(f):
            q[i, j] = state.displacement(load)
            K[i, j] = state.stiffness(q[i, j])

    from bearingdyn.results import dataset

    names = list(COMPONENTS)
    at = ("speed", "load", "row", "column")
    return dataset(
        {
            "stiffness": (at, K, "N/m, N, N m", "∂force/∂displacement of the inner ring"),
            "damping": (at, tau * K, "N s/m, N s, N m s", "damping_time × stiffness"),
            "displacement": (at[:3], q, "m, rad", "of the inner ring"),
            "force": (("load", "row"), f, "N, N m", "on the inner ring"),
        },
        {"analysis": "stiffness table", "bearing": repr(bearing)},
        {
            "speed": (omega, "rad/s"),
            "load": (np.arange(len(f)), ""),
            "row": (names, ""),
            "column": (names, ""),
        },
    )


def export_stiffness(
    table: xarray.Dataset,
    path: str | os.PathLike[str],
    format: Format = "csv",
    *,
    nodes: tuple[int, int] = (1, 2),
    element: int = 1,
    case: tuple[int, int] = (0, 0),
) -> Path:
    """Write a stiffness table for another program.

    Parameters
    ----------
    table
        By `stiffness_table`.
    path
        Of the file.
    format
        "csv": every load and speed, 36 columns. "ross": kxx, kxy, kyx, kyy, kzz, cxx, … over the speed for
        one load, as `ross.BearingElement` takes them; see `ross_table`. For one load at one speed: "abaqus",
        a connector of type BUSHING with coupled elasticity; "calculix", springs along and about the axes
        (couplings are left out, and the file says so); "nastran", the 12×12 matrix of both rings as DMIG.
    nodes
        Inner and outer ring in the other program.
    element
        Number of the connector or the first spring.
    case
        Index of the speed and of the load, where one is written.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    ValueError
        For an unknown format, a table of another kind, or an index outside it.
    """
    one_of("format", format, _FORMATS)
    _check(table)
    instance("path", path, (str, os.PathLike), "give the name of a file")
    for field, pair in (("case", case), ("nodes", nodes)):
        good = isinstance(pair, Sequence) and len(pair) == 2
        require(good, field, pair, "it must be two whole numbers")
    speed, load = (
        whole(f"case[{k}]", index, 0, size - 1)
        for k, (index, size) in enumerate(zip(case, table["stiffness"].shape[:2], strict=True))
    )
    inner, outer = (whole(f"nodes[{k}]", node, 1) for k, node in enumerate(nodes))
    require(inner != outer, "nodes", nodes, "the rings are two nodes")
    first = whole("element", element, 1)
    K = np.asarray(table["stiffness"].values[speed, load])
    K = (K + K.T) / 2
    what = f"{table.attrs['bearing']}, load {load}, {float(table['speed'][speed]):g} rad/s; SI units"
    text = {
        "csv": lambda: _csv(table),
        "ross": lambda: _ross(table, load),
        "abaqus": lambda: _abaqus(K, what, inner, outer, first),
        "calculix": lambda: _calculix(K, what, inner, outer, first),
        "nastran": lambda: _nastran(K, what, inner, outer),
    }[format]()
    target = Path(path)
    write_whole(target, text.encode("utf-8"))
    return target


def ross_table(table: xarray.Dataset, load: int = 0) -> dict[str, Any]:
    """A stiffness table for ROSS: arguments of `ross.BearingElement`, kxx … cyy and "frequency", rad/s.

    Parameters
    ----------
    table
        By `stiffness_table`.
    load
        Index of the load.
    """
    _check(table)
    index = whole("load", load, 0, table["stiffness"].shape[1] - 1)
    found: dict[str, Any] = {"frequency": table["speed"].values.tolist()}
    for letter, name in (("k", "stiffness"), ("c", "damping")):
        values = table[name].values[:, index]
        for i, a in enumerate("xyz"):
            for j, b in enumerate("xyz"):
                if a == b or "z" not in a + b:
                    found[f"{letter}{a}{b}"] = values[:, i, j].tolist()
    return found


def _check(table: Any) -> None:
    kind = getattr(table, "attrs", {}).get("analysis")
    require(kind == "stiffness table", "table", kind, "it must be a Dataset of stiffness_table")


def _csv(table: xarray.Dataset) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    ascii_names = [c.replace("θ", "r") for c in COMPONENTS]
    pairs = [(i, j) for i in range(6) for j in range(6)]
    out.write(f"# {table.attrs['bearing']}; N, m, rad, rad/s; rx, ry, rz are rotations\n")
    writer.writerow(
        [
            "speed",
            *(f"F{c}" for c in ascii_names),
            *(f"q{c}" for c in ascii_names),
            *(f"k_{ascii_names[i]}_{ascii_names[j]}" for i, j in pairs),
        ]
    )
    K, q, f = (table[name].values for name in ("stiffness", "displacement", "force"))
    for i, speed in enumerate(table["speed"].values):
        for j in range(len(f)):
            row = [speed, *f[j], *q[i, j], *(K[i, j][pair] for pair in pairs)]
            writer.writerow([repr(float(x)) for x in row])
    return out.getvalue()


def _ross(table: xarray.Dataset, load: int) -> str:
    found = ross_table(table, load)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(found)
    for row in zip(*found.values(), strict=True):
        writer.writerow([repr(float(x)) for x in row])
    return out.getvalue()


def _lines(values: Sequence[float], per_line: int = 8) -> list[str]:
    return [", ".join(f"{v:.9e}" for v in values[k : k + per_line]) for k in range(0, len(values), per_line)]


def _abaqus(K: Array, what: str, inner: int, outer: int, element: int) -> str:
    # symmetric, by columns of the upper triangle: D11, D12, D22, D13, …
    upper = [float(K[i, j]) for j in range(6) for i in range(j + 1)]
    return "\n".join(
        [
            f"** {what}",
            "*ELEMENT, TYPE=CONN3D2, ELSET=BEARING",
            f"{element}, {outer}, {inner}",
            "*CONNECTOR SECTION, ELSET=BEARING, BEHAVIOR=BEARING",
            "BUSHING",
            "*CONNECTOR BEHAVIOR, NAME=BEARING",
            "*CONNECTOR ELASTICITY",
            *_lines(upper),
            "",
        ]
    )


def _calculix(K: Array, what: str, inner: int, outer: int, element: int) -> str:
    left = float(np.abs(K - np.diag(np.diag(K))).max())
    lines = [
        f"** {what}",
        f"** springs have no couplings: entries up to {left:.3e} beside the diagonal are left out",
    ]
    for k in range(6):
        if K[k, k] == 0:
            continue
        number, name = element + k, f"BEARING{k + 1}"
        lines += [
            f"*ELEMENT, TYPE=SPRING2, ELSET={name}",
            f"{number}, {outer}, {inner}",
            f"*SPRING, ELSET={name}",
            f"{k + 1}, {k + 1}",
            f"{K[k, k]:.9e}",
        ]
    return "\n".join([*lines, ""])


def _nastran(K: Array, what: str, inner: int, outer: int) -> str:
    """Both rings' matrix [K, −K; −K, K] as DMIG entries of its lower triangle, for K2GG=KBEARING."""
    both = np.block([[K, -K], [-K, K]])
    place = [(node, k + 1) for node in (inner, outer) for k in range(6)]
    lines = [f"$ {what}", "$ K2GG=KBEAR in the case control", "DMIG,KBEAR,0,6,2,0"]
    for column in range(12):
        node, component = place[column]
        rows = [r for r in range(column, 12) if both[r, column] != 0]
        if not rows:
            continue
        lines.append(f"DMIG*   KBEAR           {node:<16d}{component:<16d}")
        for r in rows:
            G, C = place[r]
            lines.append(f"*       {G:<16d}{C:<16d}{both[r, column]:<16.9E}")
    if not all(math.isfinite(float(x)) for x in both.ravel()):
        raise ValueError("table has a stiffness that is not finite")
    return "\n".join([*lines, ""])
