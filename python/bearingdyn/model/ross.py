"""A rotor out of a file that ROSS saved: shaft, discs, and bearings by their coefficients."""

from __future__ import annotations

import json
import math
import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.application import Application
from bearingdyn.checks import existing, nonnegative, number, numbers, positive, whole
from bearingdyn.fem import Section
from bearingdyn.material import Elastic
from bearingdyn.model.key_lines import check_chains
from bearingdyn.parts import Disc, Shaft
from bearingdyn.types import Array

SLICES = 16  # of a tapered element: its ends' diameters then differ by a sixteenth of the taper
KIND = re.compile(r"(\w+?Element|PointMass|DiskElement\w*)_(.*)", re.DOTALL)
CROSSED = ("xy", "yx")


def read_ross(
    path: str | os.PathLike[str], *, speed: float = 0.0, damping: float = 0.0, f_max: float = 5e3
) -> Application:
    """Read a rotor that ROSS saved (`rotor.save("rotor.toml")`, or .json).

    Its axes are ours: x and y across, z along the shaft. A node that carries a bearing becomes a seat of the
    shaft, "shaft.n0" of node 0, held by springs and dampers; the other nodes are points of the same kind of
    name, where loads may act. A tapered element becomes 16 steps of the mean diameters.

    Parameters
    ----------
    path
        The file.
    speed
        rad/s, at which coefficients over the speed are taken, between the nearest two; outside, the nearest.
    damping
        Ratio ζ of the shaft's own modes; ROSS's alpha and beta are passed over where they are zero.
    f_max
        Of `bd.Shaft`, Hz.

    Returns
    -------
    Application

    Raises
    ------
    ValueError
        For what has no counterpart here, by the element's name: several materials, cross-coupled or mass
        coefficients, bearings on supports, point masses, couplings, axial force or torque.

    References
    ----------
    R. Timbó et al., J. Open Source Softw. 5 (2020) 2120 (ROSS).
    """
    file = existing(path, "ROSS file")
    speed, f_max = number("speed", speed, "it must be a speed in rad/s"), positive("f_max", f_max)
    damping = nonnegative("damping", damping)
    try:
        return _rotor(file, speed, damping, f_max)
    except ValueError as error:  # of a part, which does not know where its numbers stand
        if str(file) in str(error):
            raise
        raise ValueError(f"{file}: {error}") from error


def _rotor(file: Path, speed: float, damping: float, f_max: float) -> Application:
    """The rotor of the file."""
    elements = _elements(file)
    pieces = _pieces(file, elements)
    nodes = np.concatenate([[0.0], np.cumsum([piece[0][1] for piece in pieces])])
    sections = [section for _, steps in pieces for section in steps]
    metals = {_metal(file, name, one) for name, one in elements.items() if name.startswith("ShaftElement")}
    if len(metals) > 1:
        raise ValueError(f"{file}: its shaft elements are of {len(metals)} materials; bd.Shaft takes one")
    discs = [
        Disc(_node(file, name, one, nodes), *(float(_given(file, name, one, k)) for k in ("m", "Id", "Ip")))
        for name, one in elements.items()
        if name.startswith("DiskElement")
    ]
    held = {name: one for name, one in elements.items() if "kxx" in one}
    springs = {name: _coefficients(file, name, one, speed) for name, one in held.items()}
    seats: dict[str, float] = {}
    total: dict[str, Array] = {}
    for name, one in held.items():
        z = _node(file, name, one, nodes)
        place = f"n{int(one['n'])}"
        seats[place] = z
        total[place] = total.get(place, np.zeros((2, 6))) + springs[name]
    if not seats:
        raise ValueError(f"{file}: it has no bearing with coefficients; nothing would hold the shaft")
    points = {f"n{k}": float(z) for k, z in enumerate(nodes) if f"n{k}" not in seats}
    app = Application()
    shaft = Shaft(sections, seats, points, discs=discs, material=metals.pop(), damping=damping, f_max=f_max)
    app.add("shaft", shaft)
    for place, (stiffness, dampers) in total.items():
        app.ground(f"shaft.{place}", stiffness=stiffness, damping=dampers)
    return app


def _elements(file: Path) -> dict[str, dict[str, Any]]:
    """The elements of the file by their names."""
    try:
        text = file.read_text(encoding="utf-8-sig")
        if not text.lstrip().startswith("{"):
            check_chains(text)
        held = json.loads(text) if text.lstrip().startswith("{") else tomllib.loads(text)
    except (UnicodeDecodeError, ValueError, RecursionError) as error:
        raise ValueError(f"{file} is no TOML or JSON text: {error}; save it by ROSS's rotor.save") from None
    found = {name: one for name, one in held.items() if KIND.fullmatch(name) and isinstance(one, dict)}
    if not any(name.startswith("ShaftElement") for name in found):
        raise ValueError(f"{file} has no ShaftElement; it must be a rotor that ROSS saved")
    for name, one in found.items():
        if not name.startswith(("ShaftElement", "DiskElement")) and "kxx" not in one:
            raise ValueError(
                f"{file}, {name}: has no counterpart here; read are ShaftElement, DiskElement, and bearings "
                f"and seals with coefficients"
            )
    return found


def _given(file: Path, name: str, one: Mapping[str, Any], key: str) -> float:
    """A number of an element."""
    return number(f"{file}, {name}: {key}", one.get(key), "it must be a finite number")


def _pieces(
    file: Path, elements: Mapping[str, dict[str, Any]]
) -> list[tuple[tuple[int, float], list[Section]]]:
    """Number and length of each element of the shaft, in order, and its sections."""
    found = []
    for k, (name, one) in enumerate((n, e) for n, e in elements.items() if n.startswith("ShaftElement")):
        for key in ("axial_force", "torque", "alpha", "beta"):
            if one.get(key):
                raise ValueError(f"{file}, {name}: {key} is {one[key]!r}; only 0 has a counterpart here")
        L, idl, odl = (_given(file, name, one, key) for key in ("L", "idl", "odl"))
        idr, odr = (_given(file, name, {**one, key: one.get(key, other)}, key) for key, other in
                    (("idr", idl), ("odr", odl)))  # fmt: skip
        n = SLICES if (idl, odl) != (idr, odr) else 1
        middle = (np.arange(n) + 0.5) / n
        try:
            steps = [Section(L / n, odl + t * (odr - odl), idl + t * (idr - idl)) for t in middle]
        except ValueError as error:
            raise ValueError(f"{file}, {name}: {error}") from None
        found.append(((whole(f"{file}, {name}: n", one.get("n", k), 0), L), steps))
    found.sort(key=lambda piece: piece[0][0])
    if [piece[0][0] for piece in found] != list(range(len(found))):
        raise ValueError(f"{file}: its shaft elements must follow each other from node 0, one at each")
    return found


def _metal(file: Path, name: str, one: Mapping[str, Any]) -> Elastic:
    held = one.get("material")
    if not isinstance(held, dict):
        raise ValueError(f"{file}, {name}: material is {held!r}; it must be a table of rho, E and G_s")
    rho, E, G = (_given(file, name, held, key) for key in ("rho", "E", "G_s"))
    try:
        return Elastic(E=E, nu=E / (2.0 * G) - 1.0, density=rho)
    except (ValueError, ZeroDivisionError) as error:
        raise ValueError(f"{file}, {name}: material: {error}") from None


def _node(file: Path, name: str, one: Mapping[str, Any], nodes: Array) -> float:
    n = one.get("n")
    if not isinstance(n, int) or isinstance(n, bool) or not 0 <= n < nodes.size:
        raise ValueError(f"{file}, {name}: n is {n!r}; it must be a node of the shaft, 0 to {nodes.size - 1}")
    return float(nodes[n])


def _coefficients(file: Path, name: str, one: Mapping[str, Any], speed: float) -> Array:
    """Stiffness and damping (2, 6) at a speed."""
    if one.get("n_link") is not None:
        raise ValueError(f"{file}, {name}: n_link is {one['n_link']}; a bearing here is held by the ground")
    at = one.get("frequency")
    grid = numbers(f"{file}, {name}: frequency", at if at else 0.0, "it must be ascending, rad/s")

    def value(key: str) -> float:
        given = one.get(key, 0.0)
        try:
            row = np.atleast_1d(np.asarray(given if given is not None else 0.0, dtype=np.float64))
        except (TypeError, ValueError, OverflowError):
            row = np.array([math.nan])
        if row.ndim != 1 or row.size not in (1, grid.size) or not np.isfinite(row).all():
            raise ValueError(f"{file}, {name}: {key} is {given!r}; it must be {grid.size} finite numbers")
        return float(np.interp(speed, grid, np.broadcast_to(row, grid.shape)))

    if not (np.isfinite(grid).all() and (np.diff(grid) > 0).all()):
        raise ValueError(f"{file}, {name}: frequency must be ascending, rad/s")
    for key in (
        *(f"{k}{p}" for k in "kc" for p in CROSSED),
        *(f"m{p}" for p in ("xx", "xy", "yx", "yy", "zz")),
    ):
        if value(key) != 0.0:
            raise ValueError(
                f"{file}, {name}: {key} is {value(key):g} at {speed:g} rad/s; springs and dampers of an "
                f"application have no cross-coupling and no mass: only 0 has a counterpart"
            )
    return np.array([[value(f"{k}{p}{p}") for p in "xyz"] + [0.0] * 3 for k in "kc"])
