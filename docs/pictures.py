"""Pictures of the guide, each made by the public functions that its page explains, written as PNG."""

from __future__ import annotations

import contextlib
import io
import math
import re
import warnings
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

import bearingdyn as bd


def drawing(path: Path) -> None:
    """The guide's page on models: a ready motor as it is drawn."""
    ax = bd.examples.motor().draw()
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def squeezed(path: Path) -> None:
    """The rings of the guide's page on squeeze: bonded with recessed ends, and slid in without friction."""
    rubber = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.2), layout="constrained")
    for ax, recess, how, squeeze in ((axes[0], 1.2e-3, "bonded", 0.05), (axes[1], 0.0, "slip", 0.10)):
        ring = bd.Layer(r_inner=0.020, r_outer=0.024, width=0.012, material=rubber, recess=recess)
        bd.plot.squeezed_section(ring.assembled(squeeze=squeeze, inside=how, outside=how), ax=ax)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def deformed(path: Path) -> None:
    """The pad of the guide's page on squeeze: pressed, sheared and turned."""
    rubber = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)
    lines = [np.linspace(0.0, size, n + 1) for size, n in ((0.040, 8), (0.012, 4), (0.030, 6))]
    pad = bd.Solid(bd.box_mesh(*lines, element="hex27"), rubber, {"foot": "y-", "plate": "y+"})
    ax = bd.plot.squeezed_solid(pad.assembled({"plate": (0.004, -0.0006, 0.001, 0.0, 0.15, 0.0)}))
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def stiffness(path: Path) -> None:
    """The page on how stiff a rubber is: effects by size, and the law of softening with its sweep."""
    text = (Path(__file__).parent / "guide" / "stiffness.md").read_text("utf-8")
    names: dict[str, Any] = {"__name__": "stiffness"}
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for code in re.findall(r"^```python\n(.*?)^```$", text, re.S | re.M):
            exec(compile(code, "stiffness.md", "exec"), names)
    figure, axes = plt.subplots(2, 2, figsize=(11, 7.6), layout="constrained")
    rows = names["ordered"][::-1]
    for k, (_, low, high) in enumerate(rows):
        axes[0, 0].barh(k, 100 * (high - low), left=100 * low, color=bd.plot.frame.COLOURS[0])
    axes[0, 0].set_yticks(range(len(rows)), [name for name, _, _ in rows])
    axes[0, 0].axvline(0.0, color="0.3", linewidth=0.8)
    axes[0, 0].set_xlabel("change of the stiffness, %")
    axes[0, 0].set_title("What one does not know, by size", loc="left", fontsize=10)
    bd.plot.strain_softening(names["law"], ax=axes[0, 1])
    bd.plot.layer_strain(names["layer"], names["motion"], ax=axes[1, 0])
    bd.plot.frequency_response(names["levels"], "mass.centre.x", "mass.centre.x", ax=axes[1, 1])
    axes[1, 1].set_title("A mass on the layer, by level", loc="left", fontsize=10, pad=20)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def ring(path: Path) -> None:
    """The race of a 6305 whose ring stands on four feet, under 3 kN."""
    bearing = bd.catalogue.bearing("6305", clearance=10e-6)
    feet = bd.RingPoints([k * math.pi / 4 for k in (1, 3, 5, 7)], stiffness=2e8)
    ring = bd.FlexibleRing.of(bearing, outside=(feet, bd.RingBed(1e7)), f_max=0.0)
    ax = bd.plot.ring_shape(bd.FlexibleBearing(bearing, ring), (0, -3000, 0, 0, 0, 0), -0.5 * math.pi)
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def sound(path: Path) -> None:
    """The guide's page on sound: a plate-like housing, its sound power and its equivalent radiated power."""
    housing = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, damping=0.01, f_max=3000.0)
    app = bd.Application()
    app.add("housing", housing.superelement())
    app.ground("housing.feet")
    app.free("housing.bore")
    f = np.geomspace(100.0, 2000.0, 300)
    found = bd.sound_power(app, f, ["housing.bore.z"], ["housing.outside"], element_size=0.019)
    figure, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
    for name, label in (("equivalent_radiated_power", "equivalent radiated power"), ("power", "sound power")):
        ax.semilogx(f, bd.sound.level(found[name].values[:, 0], "power"), label=label)
    ax.set_xlabel("frequency, Hz")
    ax.set_ylabel("level, dB re 1 pW, force 1 N at the bore")
    ax.legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def sound_paths(path: Path) -> None:
    """The guide's page on sound: two plates, one with a layer, and the bearings their sound takes."""
    found = bd.sound_contributions(
        _two_plates(), np.geomspace(250.0, 1200.0, 300), "shaft.middle.y", ["left.outside", "right.outside"],
        element_size=0.02,
    )  # fmt: skip
    ax = bd.plot.sound_contributions(found)
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def sound_intensity(path: Path) -> None:
    """The guide's page on sound: where on the softly borne plate the sound leaves."""
    found = bd.sound_intensity(_two_plates(), 700.0, "shaft.middle.y", ["left.outside"])
    ax = bd.plot.sound_intensity(found)
    ax.view_init(elev=20.0, azim=-35.0)
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def _two_plates() -> bd.Equilibrium:
    """The machine of the guide's page on sound, as its block builds it."""
    page = (Path(__file__).parent / "guide" / "sound.md").read_text(encoding="utf-8")
    block = next(b for b in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "machine = " in b)
    housing = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, damping=0.01, f_max=3000.0)
    names: dict[str, object] = {"bd": bd, "housing": housing}
    exec(block[: block.index("outside = ")], names)
    eq = names["eq"]
    assert isinstance(eq, bd.Equilibrium)
    return eq


def steady(path: Path) -> None:
    """The rotor of the guide's page on steady motions: its branches over speed."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(mass=20.0, inertia=(0.1, 0.1, 0.1)))
    app.ground("rotor.centre", stiffness=(0, 0, 1e7, 1e5, 1e5, 1e5), damping=(200, 200, 1e4, 50, 50, 50))
    race = {"Z": 8, "Dw": 11.9e-3, "Dpw": 52e-3, "fi": 0.52, "fo": 0.52, "cage_ratio": 40.1 / 104.0}
    jis_6306 = bd.BallBearing(**race, clearance=40e-6, kappa=13.34e9)
    app.bearing("ball", jis_6306, inner="rotor.centre", outer="ground")
    app.load("rotor.centre", (196.0, 0, 0, 0, 0, 0))
    speeds = (4000 * np.pi / 30, 6500 * np.pi / 30)
    found = bd.speed_map(
        app, speeds=speeds, record=["rotor.centre.x"], several=False, doublings=0, progress=False
    )
    ax = bd.plot.speed_map(found)
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def report(path: Path) -> None:
    """The drawing as the head of the guide's page on reports shows it."""
    ax = bd.examples.fan().draw()
    ax.figure.savefig(path, dpi=90)
    plt.close(ax.figure)


def gallery(page: Path, folder: Path) -> None:
    """The pictures of the gallery: what each block of its page draws, in order."""
    names: dict[str, object] = {"__name__": "gallery"}
    blocks = re.findall(
        r"^```python\n(.*?)^```\n\n!\[[^]]*\]\(_static/([\w.]+)\)", page.read_text("utf-8"), re.S | re.M
    )
    for code, name in blocks:
        exec(compile(code, str(page), "exec"), names)
        ax = names["ax"]
        figure = getattr(ax, "figure", None) or np.ravel(ax)[0].figure  # type: ignore[arg-type, attr-defined]
        figure.savefig(folder / name, dpi=100)
        plt.close("all")
