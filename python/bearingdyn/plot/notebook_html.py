"""How objects show themselves in a notebook: a drawing or a curve as SVG, and tables; HTML, no scripts."""

from __future__ import annotations

import math
import warnings
from html import escape
from typing import Any

import numpy as np

from bearingdyn.analysis import Equilibrium, OperatingPoint, static_summary
from bearingdyn.application import GRAVITY, GROUND, Application, loose_motions
from bearingdyn.bearing import BallBearing
from bearingdyn.checks import instance
from bearingdyn.cms import Superelement
from bearingdyn.material import (
    DMAData,
    Elastic,
    FractionalZener,
    MasterCurve,
    Maxwell,
    PowerLaw,
    TabulatedModulus,
)
from bearingdyn.plot.drawing.bearing_section import draw_bearing
from bearingdyn.plot.drawing.loads import course, value
from bearingdyn.plot.drawing.machine_drawing import draw
from bearingdyn.plot.drawing.words import bearing_words, parts_list
from bearingdyn.plot.frame import finish, style
from bearingdyn.plot.html_blocks import box, canvas, rows, svg
from bearingdyn.plot.object_tables import (
    dma_html,
    fields_html,
    operating_point_html,
    shows_fields,
    superelement_html,
    system_html,
)
from bearingdyn.system import System
from bearingdyn.units import mm


def as_html(thing: object) -> str:
    """Any object in a notebook, as HTML.

    Parameters
    ----------
    thing
        An application, bearing, equilibrium, material or measurement, a part, reduced or not, a system, and
        whatever else shows itself in a notebook.

    Raises
    ------
    ValueError
        For anything else.
    """
    makers: dict[type, Any] = {
        Application: application_html,
        BallBearing: bearing_html,
        DMAData: dma_html,
        Elastic: elastic_html,
        Equilibrium: equilibrium_html,
        FractionalZener: zener_html,
        MasterCurve: master_html,
        Maxwell: maxwell_html,
        OperatingPoint: operating_point_html,
        PowerLaw: power_law_html,
        Superelement: superelement_html,
        System: system_html,
        TabulatedModulus: tabulated_html,
    }
    make = next((make for kind, make in makers.items() if isinstance(thing, kind)), None)
    if make is None and shows_fields(thing):
        make = fields_html
    if make is None:
        instance("thing", thing, tuple(makers), "give an application, part, bearing, material or state")
    page: str = make(thing)  # type: ignore[misc]
    return page


def application_html(app: Application) -> str:
    """HTML in a notebook of an application: drawing, parts, joints, loads, and what is to be warned of."""
    plan = app.plan
    if not plan.parts:
        return box("Application without parts")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UserWarning)
        picture = svg(draw(app, table=False).figure, "section of the machine along its shaft")  # type: ignore[arg-type]
    numbered = [(str(k), *row) for k, row in enumerate(parts_list(plan).values(), 1)]
    return box(
        f"Application of {len(plan.parts)} parts and {len(plan.bearings)} bearings",
        picture,
        rows(("no.", "name", "what, lengths in mm", "mass"), numbered),
        rows(("joint", "with", "how"), _joints(app)),
        rows(("load at", "what"), _loads(app)),
        _warned(app, [str(w.message) for w in caught]),
    )


def _joints(app: Application) -> list[tuple[str, str, str]]:
    plan = app.plan
    found = [(str(c.a), str(c.b), "rigid") for c in plan.connections]
    found += [
        (str(s.interface), "ground", "rigid" if s.rigid else "springs and dampers")
        for s in plan.supports.values()
    ]
    found += [(str(s.a), str(s.b), "springs and dampers") for s in plan.springs]
    found += [(str(b.inner), str(b.outer), f"bearing {b.name}") for b in plan.bearings.values()]
    found += [(str(f.ring), str(f.bore), f"loose fit {f.name}") for f in plan.fits.values()]
    return found + [(str(place), "", "free") for place in sorted(plan.free_interfaces)]


def _loads(app: Application) -> list[tuple[str, str]]:
    found = []
    for load in app.plan.loads:
        vector = getattr(load, "vector", None)
        if vector is None:
            found.append((str(load.where), f"unbalance {1e6 * load.moment:.4g} g mm"))  # type: ignore[attr-defined]
            continue
        of_all = load.where in (GRAVITY, GROUND)
        units = ("m/s²",) * 3 if of_all else ("N",) * 3 + ("N m",) * 3
        names = ("x", "y", "z", "about x", "about y", "about z")
        told = [
            f"{value(float(x), unit)} {name}"
            for x, unit, name in zip(vector, units, names, strict=False)
            if x
        ]
        found.append((str(load.where), ", ".join(told) + course(load)))
    return found


def _warned(app: Application, told: list[str]) -> str:
    """What is to be warned of: what the assembly refuses, and what nothing holds."""
    notes = list(dict.fromkeys(told))
    try:
        app.plan.check_joints()
    except ValueError as error:
        notes.append(str(error))
    # every rotor is free to spin: that is no reason for alarm
    spins = {f"{name} θz": name for name in app.plan.turning_parts()}
    loose = loose_motions(app.plan)
    free = [motion for motion in loose if all(one in spins for one in motion.split(", "))]
    notes += [f"nothing holds: {motion}" for motion in loose if motion not in free]
    items = "".join(f"<li>{escape(note)}</li>" for note in notes)
    turning = ", ".join(spins[one] for motion in free for one in motion.split(", "))
    return (f'<ul style="margin:.3em 0;color:#a3541b">{items}</ul>' if items else "") + (
        f'<p style="margin:.3em 0">free to turn about z: {escape(turning)}</p>' if turning else ""
    )


def bearing_html(bearing: BallBearing) -> str:
    """A bearing in a notebook: its section, and what follows from its geometry."""
    figure, ax = canvas(2.6, 2.6)
    ax.set_aspect("equal")
    ax.axis("off")
    bore, outside, width = draw_bearing(ax, bearing, np.zeros(2))
    ax.plot([-0.8 * width, 0.8 * width], [0, 0], color="0.3", linewidth=0.6, linestyle=(0, (14, 3, 2, 3)))
    ax.autoscale_view()
    g = bearing.geometry
    measures = f"{2 * bore:.4g}, {2 * outside:.4g}, {width:.4g} mm"
    told = [
        ("bore, outside, width", measures if bearing.boundary else "not known"),
        ("balls", f"{bearing.Z} of Ø{bearing.Dw / mm:.5g} mm on Ø{bearing.Dpw / mm:.5g} mm"),
        ("grooves", f"{bearing.fi:g} inside, {bearing.fo:g} outside"),
        ("free contact angle", f"{math.degrees(g.alpha0):.2f}°"),
        ("κ of a ball", f"{bearing.kappa:.4g} N/m^1.5"),
        ("cage, of the speed", f"{bearing.cage_ratio:.4f}"),
        ("static rating by 4.2 GPa", f"{bearing.static_rating / 1e3:.4g} kN"),
    ]
    return box(bearing_words(bearing), svg(figure, "section of the bearing"), rows(("", ""), told))


def maxwell_html(material: Maxwell) -> str:
    """A Maxwell model in a notebook: its modulus over frequency, where it is known, and its branches."""
    times = material.tau if material.tau.size else np.array([1.0])
    low, high = 0.01 / (2 * np.pi * times.max()), 100.0 / (2 * np.pi * times.min())
    if material.band is not None:
        low, high = min(low, material.band[0] / 3), max(high, 3 * material.band[1])
    at = "" if material.temperature is None else f" at {material.temperature:g} °C"
    facts = [
        ("relaxed modulus G0", f"{material.G0 / 1e6:.4g} MPa"),
        ("at once", f"{(material.G0 + material.G.sum()) / 1e6:.4g} MPa"),
        *([("dashpot η0 (raises G″)", f"{material.eta0:.4g} Pa s")] if material.eta0 else []),
        *_stated(material),
    ]
    if material.fit is not None:
        fit = material.fit
        told = f"{fit.points} points, storage within {100 * fit.storage_rms:.2g} % rms"
        facts.append(("fit", f"{told}, from {fit.covered[0]:.4g} to {fit.covered[1]:.4g} Hz"))
    branches = [(f"{tau:.4g}", f"{G / 1e6:.4g}") for G, tau in zip(material.G, material.tau, strict=True)]
    return box(
        f"Maxwell model of rubber{at}",
        _modulus(material, low, high, material.band),
        rows(("", ""), facts),
        rows(("τ, s", "G, MPa"), branches),
    )


def _stated(material: Any) -> list[tuple[str, str]]:
    """What every rubber states beside its modulus."""
    facts = [("bulk modulus K", f"{material.K / 1e9:.4g} GPa"), ("density", f"{material.density:g} kg/m³")]
    if material.law is not None:
        facts.append(("shift law", type(material.law).__name__))
    if material.payne is not None:
        facts.append(("softens with strain", f"from {100 * material.payne.gamma_c:.3g} % on"))
    return facts


def _modulus(material: Any, low: float, high: float, band: tuple[float, float] | None) -> str:
    """The picture of a modulus over frequency."""
    f = np.geomspace(low, high, 200)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the picture shows the band itself
        G = np.asarray(material.complex_modulus(2 * np.pi * f))
    with style():
        figure, ax = canvas(5.6, 2.8)
        ax.loglog(f, G.real / 1e6, label="storage G′")
        ax.loglog(f, np.maximum(G.imag, 1e-12) / 1e6, "--", label="loss G″")
        if band is not None:
            ax.axvspan(*band, color="#f2b632", alpha=0.18, linewidth=0, label="band of the data")
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("MPa")
        ax.set_ylim(bottom=0.5 * min(float(G.real.min()), float(np.quantile(G.imag, 0.1)) or 1e3) / 1e6)
        finish(ax, legend=True)
    return svg(figure, "storage and loss modulus over frequency")


def zener_html(material: FractionalZener) -> str:
    """A fractional Zener model in a notebook: modulus over six decades about its transition, parameters."""
    middle = 1.0 / (2 * np.pi * material.tau)
    facts = [
        ("relaxed modulus G0", f"{material.G0 / 1e6:.4g} MPa"),
        ("at once", f"{material.G_inf / 1e6:.4g} MPa"),
        ("τ", f"{material.tau:.4g} s"),
        ("order α", f"{material.alpha:.4g}"),
        *_stated(material),
    ]
    picture = _modulus(material, 1e-3 * middle, 1e3 * middle, None)
    return box(f"Fractional Zener model of rubber{_at(material)}", picture, rows(("", ""), facts))


def power_law_html(material: PowerLaw) -> str:
    """A power law in a notebook: modulus over four decades about the frequency it is stated at."""
    facts = [
        (f"|G*| at {material.frequency:g} Hz", f"{material.modulus / 1e6:.4g} MPa"),
        ("exponent", f"{material.exponent:.4g}"),
        *_stated(material),
    ]
    picture = _modulus(material, 1e-2 * material.frequency, 1e2 * material.frequency, None)
    return box(f"Power law of rubber{_at(material)}", picture, rows(("", ""), facts))


def tabulated_html(material: TabulatedModulus) -> str:
    """A tabulated modulus in a notebook: its curve, and where it is known."""
    low, high = float(material.frequency[0]), float(material.frequency[-1])
    facts = [("points", f"{material.frequency.size}, {low:.4g} to {high:.4g} Hz"), *_stated(material)]
    picture = _modulus(material, low, high, (low, high))
    return box(f"Tabulated modulus of rubber{_at(material)}", picture, rows(("", ""), facts))


def _at(material: Any) -> str:
    return "" if material.temperature is None else f" at {material.temperature:g} °C"


def elastic_html(material: Elastic) -> str:
    """A metal in a notebook: its constants."""
    facts = [
        ("E", f"{material.E / 1e9:.4g} GPa"),
        ("ν", f"{material.nu:.4g}"),
        ("G", f"{material.G / 1e9:.4g} GPa"),
        ("K", f"{material.K / 1e9:.4g} GPa"),
        ("density", f"{material.density:g} kg/m³"),
    ]
    return box("Elastic material", rows(("", ""), facts))


def master_html(curve: MasterCurve) -> str:
    """A master curve in a notebook: its points, the law of its shifts, and what is doubted of it."""
    with style():
        figure, ax = canvas(5.6, 2.8)
        ax.loglog(curve.frequency, curve.storage / 1e6, ".", markersize=3, label="storage")
        ax.loglog(curve.frequency, curve.loss / 1e6, ".", markersize=3, label="loss")
        ax.set_xlabel(f"frequency at {curve.T_ref:g} °C, Hz")
        ax.set_ylabel("MPa")
        finish(ax, legend=True)
    reach = f"{curve.frequency.min():.3g} to {curve.frequency.max():.3g} Hz"
    facts = [
        ("measured in", curve.mode),
        ("points", f"{curve.frequency.size} of {len(curve.shifts)} isotherms, {reach}"),
        (
            "shift law",
            f"{type(curve.law).__name__}, rms {curve.law_residual:.2g} decades" if curve.law else "none",
        ),
        ("G′ and G″ against causality, rms", ", ".join(f"{100 * x:.3g} %" for x in curve.kk_residual)),
        ("source", curve.source or "not stated"),
    ]
    notes = "".join(f"<li>{escape(note)}</li>" for note in curve.notes)
    doubts = f'<ul style="margin:.3em 0;color:#a3541b">{notes}</ul>' if notes else ""
    title = f"Master curve at {curve.T_ref:g} °C"
    return box(
        title, svg(figure, "storage and loss modulus of the master curve"), rows(("", ""), facts), doubts
    )


def equilibrium_html(eq: Equilibrium) -> str:
    """HTML in a notebook of an equilibrium: how far places move, and what the bearings bear."""
    layers: list[tuple[str, ...]] = []
    if eq.system.layers:
        found = static_summary(eq)
        for name in found["layer"].values:
            one = found.sel(layer=name)
            x, low, high = (1e6 * float(one[k]) for k in ("deflection", "deflection_low", "deflection_high"))
            doubt = "" if low == high else f"{low:.4g} to {high:.4g}"
            strain = float(one["strain"])
            layers.append(
                (
                    str(name),
                    f"{x:.4g}",
                    doubt,
                    "" if math.isnan(strain) else f"{100 * strain:.3g} %",
                    f"{float(one['modulus']) / 1e6:.4g}",
                )
            )
    moved, motions = [], {name: eq.displacement(name)[:3] for name in eq.system.outputs}
    # what is a millionth of the largest, or a picometre, is round-off
    least = max([1e-12, *(1e-6 * float(np.abs(u).max()) for u in motions.values())])
    for name, u in motions.items():
        moved.append((name, *(f"{1e6 * x:.4g}" if abs(x) > least else "0" for x in u)))
    borne = []
    for name, state in eq.bearings.items():
        loads = state.loads
        pressed = int(np.count_nonzero(loads > 1e-9))
        borne.append((name, f"{pressed} of {loads.size}", f"{loads.max():.4g}" if loads.size else ""))
    return box(
        repr(eq).strip("<>"),
        rows(("bearing", "balls pressed", "heaviest ball, N"), borne),
        rows(("place", "x, µm", "y, µm", "z, µm"), moved),
        rows(("layer", "deflection, µm", "by its data", "strain", "modulus, MPa"), layers),
    )
