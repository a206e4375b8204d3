"""Draws film and pressure of a 6205's contact, and its damping by frequency, load, speed and temperature."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

INK, BLUE, ORANGE, GREEN = "#22313f", "#2b6ea6", "#c9692c", "#3a8a6e"
RPM = math.pi / 30
LOAD, SPEED, TEMPERATURE = 100.0, 3000.0, 60.0  # N on a ball, rpm, °C
OIL = {"density": 870.0, "alpha": 2.0e-8}  # as in the guide


def maps(path: Path) -> None:
    """Write the maps of film and pressure of the inner contact as PNG."""
    import matplotlib.pyplot as plt

    import bearingdyn as bd
    from bearingdyn.bearing import ehl

    ball = bd.catalogue.bearing("6205", clearance=10e-6)
    oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32), **OIL)
    us = surface_speed(ball, SPEED)
    found = ehl.solve(ball.inner_contact, oil, LOAD, us, TEMPERATURE, accuracy=0.02)
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 4.2), layout="constrained")
    bd.plot.film_map(found, axes[0])
    bd.plot.film_map(found, axes[1], quantity="pressure")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def surface_speed(ball: object, rpm: float) -> float:
    """Sum of the surface speeds in each contact, m/s, by `lubricate` at a light axial load."""
    import bearingdyn as bd

    oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32), **OIL)
    return bd.bearing.lubricate(ball, oil, TEMPERATURE, rpm * RPM, (0, 0, 500.0, 0, 0, 0)).us


def damping(path: Path) -> None:
    """Write c of a 6205 over frequency, load, speed and temperature as SVG or PNG."""
    import matplotlib.pyplot as plt

    import bearingdyn as bd
    from bearingdyn.bearing import OilSupply, ehl
    from bearingdyn.bearing.lubrication import lubricated

    ball = bd.catalogue.bearing("6205", clearance=10e-6)
    walther = bd.bearing.Walther
    oils = {f"VG {vg}": bd.bearing.Lubricant(walther.iso_vg(vg), **OIL) for vg in (32, 100)}
    oil = oils["VG 32"]
    figure, axes = plt.subplots(2, 2, figsize=(9.6, 6.2), layout="constrained")

    ax, us = axes[0, 0], surface_speed(ball, SPEED)
    f = np.geomspace(50, 20e3, 300)
    for T, colour in ((40.0, BLUE), (60.0, GREEN), (80.0, ORANGE)):
        one = ehl.look_up(ball.inner_contact, oil, LOAD, us, T)
        ax.semilogx(f, one.stiffness(f).imag / (2 * np.pi * f), color=colour, label=f"{T:.0f} °C")
    ax.set_xlabel("frequency, Hz")
    ax.set_title(f"inner contact, {LOAD:.0f} N, {SPEED:.0f} rpm, VG 32", fontsize=10)

    def of_ball(oil: object, Q: float, rpm: float, T: float) -> float:
        return lubricated(ball, OilSupply(oil, T, rpm * RPM), Q, 0.2).damping

    ax = axes[0, 1]
    for rpm, colour in ((1000.0, BLUE), (3000.0, GREEN), (8000.0, ORANGE)):
        loads = np.geomspace(1, 1000, 60)
        law = lubricated(ball, OilSupply(oil, TEMPERATURE, rpm * RPM), LOAD, 0.2).law
        ax.semilogx(loads, law.at((loads / ball.kappa) ** (2 / 3)), color=colour, label=f"{rpm:.0f} rpm")
    ax.set_xlabel("load of the ball, N")
    ax.set_title("both contacts in series, VG 32, 60 °C", fontsize=10)

    ax = axes[1, 0]
    speeds = np.geomspace(1000, 8000, 30)
    for T, colour in ((40.0, BLUE), (60.0, GREEN), (80.0, ORANGE)):
        ax.plot(speeds, [of_ball(oil, LOAD, rpm, T) for rpm in speeds], color=colour, label=f"{T:.0f} °C")
    ax.axhline(30.0, color=INK, lw=0.7, ls="--")
    ax.set_xlabel("speed, rpm")
    ax.set_title(f"both contacts, {LOAD:.0f} N, VG 32; dashed: 30 N s/m", fontsize=10)

    ax = axes[1, 1]
    T = np.linspace(40, 100, 31)
    for (name, each), colour in zip(oils.items(), (BLUE, ORANGE), strict=True):
        ax.plot(T, [of_ball(each, LOAD, SPEED, t) for t in T], color=colour, label=name)
    ax.axhline(30.0, color=INK, lw=0.7, ls="--")
    ax.set_xlabel("temperature, °C")
    ax.set_title(f"both contacts, {LOAD:.0f} N, {SPEED:.0f} rpm; dashed: 30 N s/m", fontsize=10)

    for ax in axes.flat:
        ax.set_ylabel("c, N s/m")
        ax.legend(frameon=False, fontsize=8)
        ax.spines[["top", "right"]].set_visible(False)
    figure.savefig(path)
    plt.close(figure)


def in_time(path: Path) -> None:
    """Write how a mass on oiled balls rings down, and c(ω) as a film's decays give it, as SVG or PNG."""
    import matplotlib.pyplot as plt

    import bearingdyn as bd
    from bearingdyn.bearing import FilmMemory, OilSupply

    oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32), **OIL)
    ball = bd.catalogue.bearing("6202", clearance=10e-6, lubrication=OilSupply(oil, TEMPERATURE, 500.0))
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=0.006, inertia=(1e-6, 1e-6, 1e-6)))
    app.ground("mass.centre", stiffness=(1e3, 1e3, 0, 1e3, 1e3, 1e3))
    app.bearing("ball", ball, inner="mass.centre", outer="ground")
    app.load("mass.centre", (0, 0, 300.0, 0, 0, 0))
    rest = bd.equilibrium(app)
    start = {"mass.centre": (0, 0, rest.x @ rest.system.rows("mass.centre")[2] + 1e-7, 0, 0, 0)}
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 3.6), layout="constrained")
    ways = (("viscous", ORANGE), ("film", BLUE))
    for contacts, colour in ways:
        run = bd.transient(
            rest,
            speed=500.0,
            dt=1e-6,
            steps=1500,
            record=["mass.centre.z"],
            contacts=contacts,  # type: ignore[arg-type]
            initial=start,
            filter=False,
        )
        z = 1e9 * run["record"].values[:, 0]
        axes[0].plot(1e3 * run["time"], z - z[-500:].mean(), color=colour, lw=0.9, label=contacts)
    axes[0].set(xlabel="time, ms", ylabel="displacement, nm", title="6 g on a 6202, 300 N, VG 32, 60 °C")

    kernel, law = rest.system.bearings[0].kernel(), rest.system.bearings[0].bearing.damping
    memory = FilmMemory.of(law, kernel.kappa)
    f = np.geomspace(100, 30e3, 200)
    dry = 1.5 * kernel.kappa ** (2 / 3) * memory.load ** (1 / 3)
    table = law.answer.under(np.array([memory.load])).stiffness(2 * np.pi * f)[:, 0]
    for k, style, label in (
        (table, {"lw": 3, "alpha": 0.35}, "films"),
        (memory.stiffness(2 * np.pi * f), {"lw": 1}, "decays"),
    ):
        axes[1].semilogx(f, dry * k.imag / (2 * np.pi * f), color=BLUE, label=label, **style)
    axes[1].axhline(
        float(law.at((memory.load / kernel.kappa) ** (2 / 3))), color=ORANGE, lw=1, label="viscous"
    )
    axes[1].set(
        xlabel="frequency, Hz", ylabel="c of a ball, N s/m", title=f"both contacts, {memory.load:.0f} N"
    )
    for ax in axes:
        ax.title.set_fontsize(10)
        ax.legend(frameon=False, fontsize=8)
        ax.spines[["top", "right"]].set_visible(False)
    figure.savefig(path)
    plt.close(figure)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    maps(folder / "contact_maps.png")
    damping(folder / "contact_damping.png")
    in_time(folder / "films_in_time.png")
