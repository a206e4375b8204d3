"""What the page shows of a machine: drawing, inputs with their sources and doubts, and its state at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from html import escape
from typing import Any

import numpy as np

from bearingdyn.analysis import Equilibrium, bearing_sheet, equilibrium, sheet_rows, static_summary
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.model import Model
from bearingdyn.reporting.blocks import paragraph, table, told
from bearingdyn.reporting.chart import Chart, Curve

TIMES = 12  # after which the layers' sag is computed


def drawing_html(app: Application) -> str:
    """The report's drawing of a machine, parts, joints and loads, as the application shows itself."""
    from bearingdyn.plot import as_html

    return as_html(app)


def inputs_html(model: Model) -> str:
    """The report's inputs of a machine: parameters, materials with band and doubt, bearings with sources."""
    from bearingdyn.plot import as_html

    blocks = []
    if model.parameters:
        blocks += [
            "<h3>Parameters</h3>",
            table(("name", "value"), [(k, f"{v}") for k, v in model.parameters.items()]),
        ]
    for name, material in materials(model).items():
        blocks += [f"<h3>Material {escape(name)}</h3>", as_html(material), paragraph(doubt(material))]
    seen: dict[str, str] = {}
    for name, joint in model.application.plan.bearings.items():
        shown = as_html(joint.bearing)
        if shown in seen:
            blocks.append(paragraph(f"Bearing {name} is of the same kind as {seen[shown]}.", "note"))
        else:
            seen[shown] = name
            blocks += [f"<h3>Bearing {escape(name)}</h3>", shown]
    return "".join(blocks)


def materials(model: Model) -> dict[str, Any]:
    """The report's materials of a machine by the names its file has; others by kind and number."""
    found: dict[str, Any] = {k: one for k, one in model.materials.items() if _shows(one)}
    for part in model.application.plan.sources.values():
        for field in ("material", "metal"):
            one = getattr(part, field, None)
            if _shows(one) and not any(one is known or one == known for known in found.values()):
                found[f"{type(one).__name__} of a {type(part).__name__}"] = one
    return found


def _shows(one: Any) -> bool:
    """Whether it is a material that shows itself."""
    return hasattr(one, "_repr_html_")


def doubt(material: Any) -> str:
    """The report's doubt of a machine's rubber: what data say of its modulus at rest; "" for nothing."""
    end = getattr(material, "low_end", None)
    if end is None:
        return ""
    low, high = (x / 1e6 for x in end.interval)
    if end.plateau:
        return f"The data reach {told(end.reach, 's')} and show a plateau: the relaxed modulus is known."
    said = f"The data reach {told(end.reach, 's')} and show no plateau: "
    if end.pinned is not None:
        time, modulus = end.pinned
        said += f"the relaxed modulus is that after {told(time, 's')}, {modulus / 1e6:.4g} MPa; "
    return said + f"after an infinite time it may be from {low:.3g} to {high:.3g} MPa."


def state_html(eq: Equilibrium, speed: float) -> str:
    """Report of a machine at rest: displacements, loads, layers, sag over time, bearings."""
    from bearingdyn.plot import as_html

    return as_html(eq) + sag_html(eq) + sheet_html(eq, speed)


def sag_html(eq: Equilibrium) -> str:
    """The report's sag of a machine's layers after a load has rested, with what the data leave open."""
    if not eq.system.layers:
        return ""
    ends = [
        end for layer in eq.system.layers if (end := getattr(layer.material, "low_end", None)) is not None
    ]
    if not ends:
        return ""
    reach = [max(end.reach, end.pinned[0] if end.pinned else 0.0) for end in ends]
    times = np.geomspace(min(1e-3, min(reach)), max(reach), TIMES)
    rows = [static_summary(equilibrium(eq.system, after=float(t))) for t in times]
    curves = []
    for name in map(str, rows[0]["layer"].values):
        for key, word in (
            ("deflection", ""),
            ("deflection_low", ", at least"),
            ("deflection_high", ", at most"),
        ):
            y = np.array([1e6 * float(one[key].sel(layer=name)) for one in rows])
            curves.append(Curve(f"{name}{word}", times, y))
    note = "Static loads rest for the time; at least and at most are what the data of the rubber leave open."
    return Chart(
        "Sag of the layers over time",
        "time after loading, s",
        "deflection, µm",
        curves,
        log_x=True,
        note=note,
    ).html()


def sheet_html(eq: Equilibrium, speed: float) -> str:
    """The report's sheet of a machine's bearings: loads, life, stiffness, lines where a speed is known."""
    if not any(isinstance(t.bearing, BallBearing) for t in eq.system.bearings):
        return ""
    sheet = bearing_sheet(eq, speed=abs(speed))
    names = [str(n) for n in sheet["bearing"].values]
    blocks = ["<h3>Bearings</h3>"]
    for heading, rows in sheet_rows(sheet).items():
        shown = [(f"{label}, {unit}" if unit else label, *values) for label, values, unit in rows]
        blocks.append(table((heading, *names), shown))
    for name in names:
        one = sheet.sel(bearing=name)
        blocks.append(paragraph(f"{name}: {one['source'].item()}", "note"))
        if one["warnings"].item():
            blocks.append(paragraph(f"{name}: {one['warnings'].item()}"))
    return "".join(blocks)


def speed_of(results: Mapping[str, Any]) -> float:
    """For the report of a machine, the one speed of its results, rad/s; 0 for none, or several."""
    speeds = set()
    for data in results.values():
        speed = data.attrs.get("speed")
        if speed is not None and np.ndim(speed) == 0 and math.isfinite(float(speed)) and float(speed) != 0.0:
            speeds.add(float(speed))
    return speeds.pop() if len(speeds) == 1 else 0.0
