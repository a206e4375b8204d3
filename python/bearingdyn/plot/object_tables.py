"""Pages in notebooks of measurements, parts, systems and whatever else is told by its fields."""

from __future__ import annotations

import inspect
import re
from dataclasses import is_dataclass
from typing import Any

from bearingdyn.analysis import OperatingPoint
from bearingdyn.cms import Superelement
from bearingdyn.material import DMAData
from bearingdyn.pictures import page
from bearingdyn.plot.html_blocks import box, canvas, rows, svg
from bearingdyn.plot.isotherms import isotherms
from bearingdyn.short_repr import stated, told
from bearingdyn.system import System

FIRST_CLAUSE = re.compile(r"[^.;]*(?:[.](?! |$)[^.;]*)*")  # a point within a number ends no clause


def shows_fields(thing: object) -> bool:
    """Whether an object's page in a notebook is the table of its fields."""
    return is_dataclass(thing) and getattr(type(thing), "_repr_html_", None) is page


def fields_html(thing: Any) -> str:
    """An object in a notebook by its fields: name, value, and what its docstring says of it."""
    said = parameters_of(type(thing))
    cells = [(name, told(value), said.get(name, "")) for name, value in stated(thing)]
    return box(type(thing).__name__, rows(("field", "value", "what it is"), cells))


def parameters_of(kind: type) -> dict[str, str]:
    """Parameters of a class for its notebook page: name -> the first clause of what its docstring says."""
    lines = (inspect.getdoc(kind) or "").splitlines()
    if "Parameters" not in lines:
        return {}
    found: dict[str, str] = {}
    names: list[str] = []
    start = lines.index("Parameters") + 2
    for k, line in enumerate(lines[start:], start):
        if set(lines[k + 1 : k + 2]) & {"-" * n for n in range(3, 20)}:
            break
        if line and not line.startswith(" "):
            names = [name.strip() for name in line.split(",")]
        elif line:
            found.update({name: f"{found.get(name, '')} {line.strip()}".strip() for name in names})
    clauses = {name: FIRST_CLAUSE.match(text) for name, text in found.items()}
    return {name: clause.group() for name, clause in clauses.items() if clause is not None}


def dma_html(dma: DMAData) -> str:
    """A measurement in a notebook: storage modulus and loss factor by isotherm, reach and doubts."""
    T, f = dma.isotherm_temperatures, dma.frequency
    figure, ax = canvas(5.6, 3.8)
    isotherms(dma, ax)
    facts = [
        ("measured in", dma.mode),
        ("points", f"{f.size} in {T.size} isotherms, {T.min():.4g} to {T.max():.4g} °C"),
        ("frequency", f"{f.min():.3g} to {f.max():.3g} Hz"),
        ("storage modulus", f"{dma.storage.min() / 1e6:.4g} to {dma.storage.max() / 1e6:.4g} MPa"),
        *([("runs", ", ".join(dma.runs))] if dma.runs else []),
        ("source", dma.source),
    ]
    noted = rows(("noted",), [(note,) for note in dma.notes])
    picture = svg(figure, "storage modulus and loss factor over frequency, a curve for each isotherm")
    return box(f"DMA measurement in {dma.mode}", picture, rows(("", ""), facts), noted)


def superelement_html(part: Superelement) -> str:
    """A reduced part in a notebook: coordinates, interfaces, outputs, materials, mass."""
    inner = part.n - 6 * len(part.interfaces)
    areas = ", ".join(f"{name}, {one.area:.4g} m²" for name, one in part.surfaces.items())
    facts = [
        ("coordinates", f"{part.n}, {inner} of them internal"),
        ("interfaces", ", ".join(part.interfaces)),
        *([("outputs", ", ".join(part.outputs))] if part.outputs else []),
        *([("raceways", ", ".join(part.raceways))] if part.raceways else []),
        *([("surfaces", areas)] if areas else []),
        *[("viscoelastic", told(term.material)) for term in part.viscoelastic],
        ("turns with gyroscopic terms", "yes" if part.G.any() else "no"),
    ]
    return box("Superelement", rows(("", ""), facts))


def system_html(system: System) -> str:
    """A system in a notebook: what it was assembled from, and the channels it has."""
    facts = [
        ("coordinates", f"{system.n}"),
        ("parts", ", ".join(term.name for term in system.parts)),
        ("bearings", ", ".join(term.name for term in system.bearings)),
        ("layers", f"{len(system.layers)}"),
        ("loads", f"{len(system.loads)}"),
        ("turning", ", ".join(system.turning)),
        ("interfaces and outputs", ", ".join(system.outputs)),
    ]
    return box("System", rows(("", ""), [fact for fact in facts if fact[1] not in ("", "0")]))


def operating_point_html(point: OperatingPoint) -> str:
    """A warm running state in a notebook: temperatures by node; heat, oil and clearance by bearing."""
    nodes = [(name, f"{T:.1f}") for name, T in point.temperatures.items()]
    bearings = [
        (
            name,
            f"{point.heat[name]:.4g}",
            f"{1e3 * point.friction[name].moment:.4g}",
            f"{1e6 * point.viscosity[name]:.4g}",
            f"{1e6 * point.clearance[name]:.3g}",
        )
        for name in point.friction
    ]
    layers = [(name, f"{W:.4g}") for name, W in point.heat.items() if name not in point.friction]
    return box(
        repr(point).strip("<>"),
        rows(("node", "°C"), nodes),
        rows(("bearing", "heat, W", "moment, N mm", "oil, cSt", "clearance, µm"), bearings),
        rows(("layer", "heat, W"), layers),
    )
