"""Figures of the motor, the paper's 6 to 10 and one more; motor_report.py gives them what they draw."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import motor
import motor_sound
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn import plot
from bearingdyn.examples.paper import paper_pedestal, paper_shaft
from bearingdyn.plot.frame import DASHES, colour, finish, new_axes, style

MODE_VIEW = (-45.0, 590.0)  # mm, along z
TALL = (-128.0, 92.0)  # mm
SWING = 60.0  # mm, as which the largest motion of a mode is drawn


@dataclass(frozen=True)
class Story:
    """What was computed, each by the label of its design: the four designs, and the layer's three losses."""

    dma: bd.DMAData
    master: bd.MasterCurve
    rubber: bd.Maxwell
    designs: Mapping[str, motor.Design]
    responses: Mapping[str, xarray.Dataset]
    losses: Mapping[str, xarray.Dataset]
    power: Mapping[str, np.ndarray]
    bending: Mapping[str, motor.Bending]
    motions: Mapping[str, xarray.Dataset]
    sweeps: Mapping[str, np.ndarray]
    sounds: Mapping[str, xarray.Dataset]  # levels in third octaves of each design


def draw(story: Story, out: Path) -> list[Path]:
    """Draw everything; returns the files written."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    made: list[Path] = []

    def keep(name: str, axes: Any) -> None:
        path = out / f"{name}.png"
        figure = np.ravel(np.asarray(axes, dtype=object))[0].figure
        figure.savefig(path, dpi=130, bbox_inches="tight")
        plt.close(figure)
        made.append(path)

    keep("rubber_isotherms", plot.isotherms(story.dma))
    keep("rubber_master_curve", plot.master(story.master, story.rubber))
    for output, name in (
        ("shaft.end.y", "fig06_shaft_vertical"),
        ("left_housing.top.y", "fig08_housing_vertical"),
        ("left_housing.top.z", "fig09_housing_axial"),
    ):
        keep(name, plot.frequency_response(story.responses, output, motor.INPUT))
    keep("fig06_08_09_loss_factor", loss_factors(story))
    keep("fig07_modes", mode_shapes(story, ("no layer", "layer, high loss")))
    keep("radiated_power", radiated_power(story))
    keep("fig10_orbit", orbit(story))
    keep("velocity_spectra", velocity_spectra(story))
    keep("velocity_over_speed", velocity_over_speed(story))
    keep("sound_thirds", motor_sound.picture(story.sounds))
    return made


def loss_factors(story: Story) -> Any:
    """The paper's figures 6, 8 and 9 for one layer and three loss factors."""
    import matplotlib.pyplot as plt

    outputs = {"shaft.end.y": "shaft, vertical", "left_housing.top.y": "housing, vertical"}
    outputs["left_housing.top.z"] = "housing, axial"
    with style():
        _, axes = plt.subplots(
            len(outputs), 1, sharex=True, figsize=(6.8, 7.6), layout="constrained", squeeze=False
        )
    panels = axes[:, 0]
    found = {label.removeprefix("layer, "): data for label, data in story.losses.items()}
    for ax, (output, name) in zip(panels, outputs.items(), strict=True):
        plot.frequency_response(found, output, motor.INPUT, ax)
        ax.set_xlim(100.0, 6000.0)
        _fit_height(ax)
        ax.set_ylabel(f"{name}, m/N")
        _retitle(ax, "The thick layer at three loss factors, |G*| at 1 kHz the same", ax is panels[0])
        if ax is not panels[-1]:
            ax.set_xlabel("")
    return axes


def _retitle(ax: Any, title: str, first: bool) -> None:
    """A title over the first panel of several; the others have neither that nor a legend."""
    ax.set_title(title if first else "", loc="left", fontsize=10, pad=22.0 if first else 4.0)
    if not first:
        ax.get_legend().remove()


def _fit_height(ax: Any) -> None:
    """A log axis over what its curves show in the range of frequencies drawn."""
    low, high = ax.get_xlim()
    shown = [
        np.asarray(line.get_ydata())[(np.asarray(line.get_xdata()) >= low) & (line.get_xdata() <= high)]
        for line in ax.get_lines()
    ]
    ax.set_ylim(0.6 * min(s.min() for s in shown), 1.8 * max(s.max() for s in shown))


def radiated_power(story: Story) -> Any:
    """Equivalent radiated power of both housings over frequency, by design."""
    with style():
        ax = new_axes(width=6.8, height=3.6)
        for k, (label, power) in enumerate(story.power.items()):
            frequency = story.responses[label]["frequency"].values
            ax.plot(frequency, power, color=colour(k), linestyle=DASHES[k], label=label)
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xlim(100.0, float(frequency[-1]))
        _fit_height(ax)
        ax.set_ylim(bottom=0.1 * ax.get_ylim()[0])  # room for the words below the curves
        band = (float(motor.AUDIBLE[0]), float(motor.AUDIBLE[-1]))
        ax.axvspan(*band, color="0.93", zorder=0, linewidth=0)
        ax.set_xlabel("frequency, Hz")
        ax.set_ylabel("equivalent radiated power, W/N²")
        finish(ax, "Outside of both housings, vertical force at mid-shaft; grey: 1–5 kHz", legend=True)
        # a sphere of a housing's size against this power: bearingdyn.analysis.equivalent_radiated_power
        ax.annotate(
            "an upper bound, not sound power: a Ø100 mm sphere radiates 35 dB less at 200 Hz, 8 dB at 1 kHz",
            (0.01, 0.02), xycoords="axes fraction", fontsize=7.5, color="0.35",
        )  # fmt: skip
    return ax


def mode_shapes(story: Story, labels: Sequence[str]) -> Any:
    """The paper's figure 7: its four bending modes, a column for each design.

    Grey: at rest, rubber orange. Blue: the shaft; green: the housings' feet, bores and tops; orange squares:
    the outer rings.
    """
    import matplotlib.pyplot as plt

    with style():
        _, axes = plt.subplots(
            4, len(labels), sharex=True, sharey=True, figsize=(9.4, 8.2), layout="constrained"
        )
    chosen = paper_modes(story.bending[labels[0]])
    for column, label in zip(axes.T, labels, strict=True):
        found = story.bending[label]
        for ax, k in zip(column, chosen, strict=True):
            _parts_at_rest(ax, story.designs[label])
            _parts_in_motion(ax, found.shapes.isel(mode=k))
            frequency, zeta = found.modes["frequency"].values[k], found.modes["damping_ratio"].values[k]
            share = found.of("strain", "layer")[k]
            text = f"{label}, mode {k + 1}: {frequency:.0f} Hz, ζ {100 * zeta:.2f} %"
            finish(ax)
            ax.set_title(
                text + (f", {100 * share:.0f} % of strain energy in layers" if share else ""),
                loc="left",
                fontsize=9,
            )
            ax.set_xlim(*MODE_VIEW)
            ax.set_ylim(*TALL)
            ax.set_aspect("equal")
            ax.set_xlabel("z, mm" if ax is column[-1] else "")
            ax.set_ylabel("y, mm" if label == labels[0] else "")
    handles, names = axes[0, 0].get_legend_handles_labels()
    axes[0, 0].figure.legend(
        handles, names, loc="outside upper left", ncols=len(names), frameon=False, fontsize=8.5,
        title=f"the largest motion of each mode is drawn {SWING:g} mm long; modes as numbered in the table",
        title_fontsize=8.5, alignment="left",
    )  # fmt: skip
    return axes


def _parts_in_motion(ax: Any, shape: xarray.Dataset) -> None:
    """Shaft, rings and housings in a mode, its largest motion SWING long, turned so that it is real."""
    from scipy.interpolate import CubicHermiteSpline

    motion = shape["motion"]
    lateral = motion.sel(component=["y", "z"]).values
    turn = SWING / lateral.ravel()[np.argmax(np.abs(lateral))]
    names = [str(p) for p in shape["place"].values]
    z = 1e3 * shape["position"].sel(axis="z").values
    y = 1e3 * shape["position"].sel(axis="y").values
    dy, dz = ((motion.sel(component=c).values * turn).real for c in "yz")

    along = np.array(sorted((i for i, n in enumerate(names) if n.startswith("shaft.")), key=lambda i: z[i]))
    # y′ = −θx, and mm of drawing per mm of z as for the motion itself
    slope = -(motion.sel(component="θx").values[along] * turn).real / 1e3
    curve = CubicHermiteSpline(z[along], dy[along], slope)
    fine = np.linspace(z[along][0], z[along][-1], 500)
    ends = 1e3 * (np.cumsum([s.length for s in paper_shaft().sections]) - motor.SEAT)
    radius = (
        500
        * np.array([s.d_outer for s in paper_shaft().sections])[
            np.minimum(np.searchsorted(ends, fine), len(ends) - 1)
        ]
    )
    ax.fill_between(
        fine, curve(fine) - radius, curve(fine) + radius, color=colour(0), alpha=0.35, linewidth=0
    )
    ax.plot(fine, curve(fine), color=colour(0), linewidth=1.2, label="shaft")
    for side in ("left", "right"):
        at = [names.index(f"{side}_housing.{place}") for place in ("feet", "bore", "top")]
        ax.plot(
            z[at] + dz[at],
            y[at] + dy[at],
            color=colour(2),
            linewidth=1.4,
            marker="o",
            markersize=3,
            label="housing: feet, bore, top" if side == "left" else None,
        )
        ring = names.index(f"{side}_ring.centre")
        ax.plot(
            z[ring] + dz[ring],
            y[ring] + dy[ring],
            color=colour(1),
            marker="s",
            markersize=5,
            linestyle="none",
            label="outer ring" if side == "left" else None,
        )


def paper_modes(bare: motor.Bending) -> list[int]:
    """Which of the bending modes without layer are the paper's four, each nearest in frequency."""
    frequency = np.log(bare.modes["frequency"].values)
    return [int(np.argmin(np.abs(frequency - np.log(f)))) for f in motor.PAPER_MODES]


def _parts_at_rest(ax: Any, design: motor.Design) -> None:
    """Side view of shaft, rings, layers and housings, mm, z from the left seat."""
    from matplotlib.patches import Rectangle

    def box(z: float, y: float, length: float, height: float, shade: str) -> None:
        ax.add_patch(
            Rectangle((1e3 * z, 1e3 * y), 1e3 * length, 1e3 * height, color=shade, linewidth=0, zorder=0)
        )

    house, seats = paper_pedestal(motor.bore(design)), paper_shaft().seats
    below = house.bore_height if house.bore_height is not None else house.height / 2
    inner, above = motor.bore(design) / 2, house.height - below
    for seat in (seats["left"], seats["right"]):
        z = seat - motor.SEAT
        for low, high in ((-below, -inner), (inner, above)):
            box(z - house.length / 2, low, house.length, high - low, "0.90")
        for inside, outside, width, shade in (
            (motor.RING[1], motor.RING[1] + design.thickness, design.width, "#F5C9A8"),
            (motor.RING[0], motor.RING[1], motor.RING[2], "0.80"),
        ):
            for low in (inside, -outside):
                box(z - width / 2, low, width, outside - inside, shade)
    z = -motor.SEAT
    for section in paper_shaft().sections:
        box(z, -section.d_outer / 2, section.length, section.d_outer, "0.84")
        z += section.length


def orbit(story: Story) -> Any:
    """The paper's figure 10: the orbit of mid-shaft, its mean, which is the static deflection, taken off."""
    orbits = {}
    for label, run in story.motions.items():
        x, y = (1e6 * float(run["record"].sel(channel=f"shaft.middle.{c}").mean()) for c in "xy")
        orbits[f"{label}, about ({x:.1f}, {y:.1f}) µm"] = bd.orbit(run, "shaft.middle.x", "shaft.middle.y")
    with style():
        ax = new_axes(width=6.8, height=3.8)
    return plot.orbit(orbits, ax)


def velocity_spectra(story: Story) -> Any:
    """Lines of the velocities of shaft's end and housing's top in the steady motions."""
    import matplotlib.pyplot as plt

    names = ("shaft's end, y", "housing's top, y", "housing's top, z")
    with style():
        _, axes = plt.subplots(
            len(names), 1, sharex=True, figsize=(6.8, 8.4), layout="constrained", squeeze=False
        )
        for ax, channel, name in zip(axes[:, 0], motor.VELOCITIES, names, strict=True):
            sizes = {
                label: 1e6 * np.abs(found["amplitude"].sel(channel=channel).values[1:])
                for label, found in story.motions.items()
            }
            floor = 0.5 * min(float(size.min()) for size in sizes.values())
            for k, (label, size) in enumerate(sizes.items()):
                kilohertz = story.motions[label]["frequency"].values[1:] / 1e3
                # side by side: they are at the same frequencies
                ax.vlines(kilohertz + 0.04 * k, floor, size, color=colour(k), linewidth=2.0, label=label)
            ax.set_yscale("log")
            ax.set_xlim(0.0, 1e-3 * motor.HARMONICS * motor.ball_pass() + 0.1)
            ax.set_ylim(bottom=floor)
            ax.set_ylabel(f"{name}, µm/s")
            first = ax is axes[0, 0]
            finish(ax, f"lines at {motor.SPEED * 30 / np.pi:.0f} rpm" if first else "", legend=first)
        axes[-1, 0].set_xlabel("frequency, kHz")
    return axes


def velocity_over_speed(story: Story) -> Any:
    """What the layer buys over the whole range: velocity of shaft's end and housing's top over speed."""
    import matplotlib.pyplot as plt

    names = ("shaft's end, y", "housing's top, y", "housing's top, z")
    with style():
        _, axes = plt.subplots(
            len(names), 1, sharex=True, figsize=(6.8, 8.0), layout="constrained", squeeze=False
        )
        for column, (ax, name) in enumerate(zip(axes[:, 0], names, strict=True)):
            curves = [1e6 * rms[:, column] for rms in story.sweeps.values()]
            rpm = motor.SPEEDS * 30 / np.pi
            for k, (label, curve) in enumerate(zip(story.sweeps, curves, strict=True)):
                ax.plot(rpm, curve, color=colour(k), linestyle=DASHES[k], label=label)
            bare, layered = curves
            ax.fill_between(
                rpm, layered, bare, where=layered < bare, color=colour(1), alpha=0.15, linewidth=0,
                label="less with the layer",
            )  # fmt: skip
            ax.set_xscale("log")
            ax.set_yscale("log")
            ax.set_xlim(float(rpm[0]), float(rpm[-1]))
            ax.set_xticks([500, 1000, 2000, 5000, 10_000], ["500", "1000", "2000", "5000", "10 000"])
            ax.minorticks_off()
            ax.set_ylabel(f"{name}, µm/s rms")
            first = column == 0
            finish(ax, f"steady motions under {motor.RADIAL / 1e3:g} kN" if first else "", legend=first)
        axes[-1, 0].set_xlabel("speed, rpm")
    return axes
