"""What the pages show and a build makes: pictures, tables, and the first hour as it runs."""

from __future__ import annotations

import contextlib
import inspect
import io
import math
import re
import runpy
import shutil
import tempfile
from pathlib import Path

import architecture
import contact_figure
import sheet_figure

HERE = Path(__file__).parent
STATIC = HERE / "_static"


def make() -> None:
    """Write _static/architecture.svg, _static/first_hour.png and what the script printed, and the tables."""
    import matplotlib

    matplotlib.use("Agg")
    STATIC.mkdir(exist_ok=True)
    (STATIC / "warnings.txt").write_text(warnings_table(), encoding="utf-8")
    (STATIC / "names.txt").write_text(names(), encoding="utf-8")
    architecture.draw(STATIC / "architecture.svg")
    sheet_figure.draw(STATIC / "sheet.svg")
    squeezed_picture(STATIC / "squeezed.png")
    ring_picture(STATIC / "ring.png")
    contact_figure.maps(STATIC / "contact_maps.png")
    contact_figure.damping(STATIC / "contact_damping.svg")
    sound_picture(STATIC / "sound.png")
    steady_picture(STATIC / "steady.png")
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            runpy.run_path(str(HERE.parent / "examples" / "first_hour.py"))
        shutil.copy(Path("out", "first_hour.png"), STATIC)
    (STATIC / "first_hour.txt").write_text(printed.getvalue(), encoding="utf-8")


def squeezed_picture(path: Path) -> None:
    """The rings of the guide's page on squeeze: bonded with recessed ends, and slid in without friction."""
    import matplotlib.pyplot as plt

    import bearingdyn as bd

    rubber = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.2), layout="constrained")
    for ax, recess, how, squeeze in ((axes[0], 1.2e-3, "bonded", 0.05), (axes[1], 0.0, "slip", 0.10)):
        ring = bd.Layer(r_inner=0.020, r_outer=0.024, width=0.012, material=rubber, recess=recess)
        bd.plot.squeezed_section(ring.assembled(squeeze=squeeze, inside=how, outside=how), ax=ax)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def ring_picture(path: Path) -> None:
    """The race of a 6305 whose ring stands on four feet, under 3 kN."""
    import matplotlib.pyplot as plt

    import bearingdyn as bd

    bearing = bd.catalogue.bearing("6305", clearance=10e-6)
    feet = bd.RingPoints([k * math.pi / 4 for k in (1, 3, 5, 7)], stiffness=2e8)
    ring = bd.FlexibleRing.of(bearing, outside=(feet, bd.RingBed(1e7)), f_max=0.0)
    ax = bd.plot.ring_shape(bd.FlexibleBearing(bearing, ring), (0, -3000, 0, 0, 0, 0), -0.5 * math.pi)
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)


def sound_picture(path: Path) -> None:
    """The guide's page on sound: a plate-like housing, its sound power and its equivalent radiated power."""
    import matplotlib.pyplot as plt
    import numpy as np

    import bearingdyn as bd

    housing = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, damping=0.01, f_max=3000.0)
    app = bd.Application()
    app.add("housing", housing.superelement())
    app.ground("housing.feet")
    app.free("housing.bore")
    f = np.geomspace(100.0, 2000.0, 300)
    found = bd.sound_power(app, f, ["housing.bore.z"], ["housing.outside"])
    figure, ax = plt.subplots(figsize=(7, 3.4), layout="constrained")
    for name, label in (("equivalent_radiated_power", "equivalent radiated power"), ("power", "sound power")):
        ax.semilogx(f, bd.sound.level(found[name].values[:, 0], "power"), label=label)
    ax.set_xlabel("frequency, Hz")
    ax.set_ylabel("level, dB re 1 pW, force 1 N at the bore")
    ax.legend(frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def steady_picture(path: Path) -> None:
    """The rotor of the guide's page on steady motions: its branches over speed."""
    import matplotlib.pyplot as plt
    import numpy as np

    import bearingdyn as bd

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


def warnings_table() -> str:
    """Every class of warning, Markdown: what it says, when it is raised, and what helps."""
    from bearingdyn import notice

    found = [c for _, c in inspect.getmembers(notice, inspect.isclass) if issubclass(c, notice.Notice)]
    rows = ["| class | what | when | remedy |", "|---|---|---|---|"]
    for each in found:
        if each is not notice.Notice:
            what, when, remedy = told(each)
            rows.append(f"| `{each.__name__}` | {what} | {when} | {remedy} |")
    return "\n".join(rows) + "\n"


def told(warning: type[Warning]) -> tuple[str, str, str]:
    """What a warning says, when it is raised and what helps; ValueError where its docstring lacks it."""
    text = inspect.getdoc(warning) or ""
    parts = re.split(r"^(When|Remedy): ", text, flags=re.MULTILINE)
    if parts[1::2] != ["When", "Remedy"]:
        raise ValueError(f"{warning.__name__}: its docstring needs a paragraph When: and then one Remedy:")
    what, when, remedy = (" ".join(part.split()).replace("|", "\\|") for part in parts[0::2])
    what = what.removeprefix("Notice: ")
    return what[0].upper() + what[1:], when, remedy


def names() -> str:
    """The public names by what they are about, Markdown, each with the first line of its docstring."""
    import bearingdyn

    lines = []
    for group, homes in bearingdyn.PUBLIC.items():
        lines += [f"## {group.capitalize()}", "", "| name | room | what |", "|---|---|---|"]
        for home, public in homes.items():
            for name in public:
                doc = inspect.getdoc(getattr(bearingdyn, name)) or ""
                first = doc.split("\n\n")[0].replace("\n", " ").replace("|", "\\|").replace("*", "\\*")
                lines.append(f"| `{name}` | `{home}` | {first} |")
        lines.append("")
    return "\n".join(lines)
