"""The motor's story: what examples/motor.py computes, in tables and figures, and what each stage costs."""

from __future__ import annotations

import math
import os
import time
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import motor
import motor_sound
import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn.examples.paper import PRELOAD, reduced_pedestal
from bearingdyn.notice import StrainedLayer

IN_MOTION = ("no layer", "layer, high loss")
SIDES = ("left", "right")
VELOCITIES = dict(zip(("shaft's end y", "housing's top y", "z"), motor.VELOCITIES, strict=True))
FREQUENCY = np.geomspace(10.0, 6000.0, 6000)  # Hz; a step is a third of the sharpest peak's width
STRAIN = 0.05  # static, above which the rubber is warned of


def spent() -> tuple[float, float]:
    """Seconds of the clock, and of the CPU, processes that have ended included."""
    return time.perf_counter(), sum(os.times()[:4])


@dataclass
class Stages:
    """Wall and CPU seconds of every stage, by name; a stage entered again adds up."""

    seconds: dict[str, tuple[float, float]] = field(default_factory=dict)
    began: tuple[float, float] = field(default_factory=spent)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what is done inside."""
        wall, cpu = spent()
        yield
        before, after = self.seconds.get(name, (0.0, 0.0)), spent()
        self.seconds[name] = (before[0] + after[0] - wall, before[1] + after[1] - cpu)

    def table(self) -> None:
        """Print them, and the whole."""
        print(f"\n{'what it took':<44}{'wall':>8}{'CPU':>10}")
        for name, (wall, cpu) in self.seconds.items():
            print(f"  {name:<42}{wall:6.1f} s{cpu:8.1f} s")
        now = spent()
        whole = now[0] - self.began[0], now[1] - self.began[1]
        print(f"  {'all of it':<42}{whole[0]:6.1f} s{whole[1]:8.1f} s")


@dataclass(frozen=True)
class State:
    """A design and its equilibria under the preload, and under the radial load as well."""

    design: motor.Design
    rest: bd.Equilibrium
    loaded: bd.Equilibrium

    @classmethod
    def of(cls, design: motor.Design, cache: Path) -> State:
        """Both equilibria; the parts are reduced and assembled once, the pedestals read from the cache."""
        app = motor.motor(design, cache=cache)
        rest = bd.equilibrium(app)
        app.load("shaft.middle", (0.0, -motor.RADIAL, 0.0, 0.0, 0.0, 0.0))
        with warnings.catch_warnings():
            # describe_layer says how far each layer strains, and from where on it is too far
            warnings.simplefilter("ignore", StrainedLayer)
            return cls(design, rest, bd.equilibrium(app))


@dataclass(frozen=True)
class Harmonic:
    """What a design answers to a vertical force at mid-shaft.

    still: static receptance (outputs,). response and power over FREQUENCY; audible: squared levels over
    motor.AUDIBLE, by name.
    """

    still: np.ndarray
    response: xarray.Dataset
    power: np.ndarray
    audible: Mapping[str, np.ndarray]

    @classmethod
    def of(cls, eq: bd.Equilibrium) -> Harmonic:
        """Responses about a state."""
        still = np.abs(motor.response(eq, np.zeros(1))["response"].values[0, :, 0])
        return cls(still, motor.response(eq, FREQUENCY), motor.radiated(eq, FREQUENCY), squared(eq))


@dataclass(frozen=True)
class Steady:
    """A steady motion, how far a march leads away from it, and what it replaces.

    motion: of motor.steady. departs: of motor.marched_on. slowest: frequency, Hz, and decay, 1/s, of the mode
    that rings longest. ring_down: s.
    """

    motion: xarray.Dataset
    departs: float
    slowest: tuple[float, float]
    ring_down: float


def describe_rubber(material: bd.Maxwell, master: bd.MasterCurve) -> None:
    """What the fit gave."""
    source = "epdm70 (measured)" if motor.MEASURED.exists() else "the shipped sample (made, not measured)"
    fit = material.fit
    print(f"rubber from {source}: five branches, {motor.BAND[0]:g}–{motor.BAND[1]:g} Hz, 20 °C")
    for run, factor in master.levels.items():
        if factor != 1.0:
            print(f"  run {run}: moduli times {factor:.3f}, to the level of the first run")
    if fit is not None:
        print(
            f"  error of the fit: G′ {100 * fit.storage_rms:.1f} % rms, "
            f"tan δ {100 * fit.tan_delta_rms:.1f} % rms"
        )
        end = fit.low_end
        assert end is not None
        print(
            f"  at rest: G after {motor.RESTED:g} s is {material.G0 / 1e6:.2f} MPa; the master curve "
            f"reaches {1 / (2 * math.pi * end.measured):.0f} s"
        )


def describe_layer(state: State) -> None:
    """Stiffness of a layer against the bearing's, and what it does under a radial load that rests."""
    design, loaded = state.design, state.loaded
    layer, material = design.layer, design.rubber
    assert layer is not None
    assert material is not None
    dynamic = abs(layer.stiffness(motor.ONE_KHZ)[0, 0])
    still = bd.static_summary(loaded).sel(layer="left_layer")
    strain = float(still["strain"])
    bearing_k = state.rest.bearings["left"].radial_stiffness
    print(
        f"  {design.label:<22}|k| at 1 kHz {dynamic / 1e6:5.1f} N/µm, {dynamic / bearing_k:.2f} of the "
        f"bearing's {bearing_k / 1e6:.0f}; tan δ {float(material.loss_factor(motor.ONE_KHZ)):.2f}; "
        f"after {float(still['time']):g} s at {float(still['temperature']):g} °C: "
        f"G {float(still['modulus']) / 1e6:.2f} MPa, {float(still['deflection']) * 1e6:.0f} µm, strain "
        f"{100 * strain:.1f} % ({100 * float(still['strain_low']):.1f} to "
        f"{100 * float(still['strain_high']):.1f})"
    )
    if strain > STRAIN:
        print(f"    warning: above {100 * STRAIN:g} %, where the measured rubber is no longer linear")


def receptances(found: Mapping[str, Harmonic]) -> None:
    """Compliance at rest and at 10 Hz, and the highest peaks of the shaft's end and of the radiation."""
    print("\nreceptance, vertical force at mid-shaft (zero-to-peak, per N)")
    print(
        f"  {'':<24}{'mid y, rested':>14}{'mid y, 10 Hz':>14}"
        f"{'peak end y':>14}{'at':>9}{'peak ERP':>14}{'at':>8}"
    )
    for label, harmonic in found.items():
        H = np.abs(harmonic.response["response"].values[:, :, 0])
        peak, loud = int(np.argmax(H[:, 0])), int(np.argmax(harmonic.power))
        print(
            f"  {label:<24}{harmonic.still[3] * 1e9:11.2f} nm{H[0, 3] * 1e9:11.2f} nm"
            f"{H[peak, 0] * 1e9:11.1f} nm{FREQUENCY[peak]:6.0f} Hz"
            f"{harmonic.power[loud] * 1e9:8.1f} nW/N²{FREQUENCY[loud]:5.0f} Hz"
        )


def falls(bare: np.ndarray, layered: np.ndarray) -> tuple[float, float]:
    """Change of squared levels, dB: of their mean, and the mean of the change."""
    change = 10 * np.log10(layered / bare)
    return float(10 * np.log10(layered.mean() / bare.mean())), float(change.mean())


def squared(eq: bd.Equilibrium) -> dict[str, np.ndarray]:
    """Squared velocity of the housing's two points, and what its surface radiates, over AUDIBLE, per N²."""
    f = motor.AUDIBLE
    H = motor.response(eq, f)["response"].values[:, :, 0]
    points = {name: np.abs(2 * math.pi * f * H[:, k]) ** 2 for name, k in (("top y", 1), ("top z", 2))}
    return points | {"ERP": motor.radiated(eq, f)}


def levels(found: Mapping[str, Harmonic]) -> None:
    """How much less the housing moves and radiates over 1–5 kHz."""
    bare = found["no layer"].audible
    print(f"\nhousing over {motor.AUDIBLE[0] / 1e3:g}–{motor.AUDIBLE[-1] / 1e3:g} kHz against no layer, dB")
    print(f"  {'':<24}{'of the mean square':>27}{'mean of the curve':>30}")
    print(f"  {'':<24}" + 2 * ("".join(f"{name:>9}" for name in bare) + "   "))
    for label, harmonic in found.items():
        if label == "no layer":
            continue
        pairs = [falls(bare[name], harmonic.audible[name]) for name in bare]
        means, curves = ("".join(f"{pair[k]:>9.1f}" for pair in pairs) for k in (0, 1))
        print(f"  {label:<24}{means}   {curves}")
    print("  top y, z: velocity of the left housing's top; ERP: all the outside of both, as plane waves")
    print(
        "  ERP is no sound power: a sphere of Ø100 mm radiates 35 dB less at 200 Hz, 8 at 1 kHz, 1 at 2 kHz"
    )


def modes_table(bending: Mapping[str, motor.Bending]) -> None:
    """Bending modes, without layer and with, paired by their order."""
    bare = bending["no layer"].modes["frequency"].values
    print("\nvertical bending modes: Hz, ζ, share of strain energy and of the loss in the layers")
    print(f"  {'':<24}" + "".join(f"{k + 1:>10}" for k in range(bare.size)))
    for label, found in bending.items():
        rows = {
            "Hz": found.modes["frequency"].values,
            "ζ, %": 100 * found.modes["damping_ratio"].values,
        }
        if label != "no layer":
            rows |= {
                f"{word} in layers, %": 100 * found.of(kind, "layer")
                for word, kind in (("strain", "strain"), ("loss", "dissipation"))
            }
        for k, (name, values) in enumerate(rows.items()):
            cells = "".join(f"{v:>10.0f}" if name == "Hz" else f"{v:>10.2f}" for v in values)
            print(f"  {label if k == 0 else '  ' + name:<24}" + cells)


def papers_modes(eq: bd.Equilibrium) -> None:
    """The peaks of the shaft's end without layer beside the paper's."""
    print("\nbending modes without layer, Hz (paper / here / difference)")
    for paper, here in zip(motor.PAPER_MODES, motor.bending_modes(eq), strict=True):
        print(f"  {paper:6.0f} {here:8.1f} {100 * (here / paper - 1):+6.1f} %")


def line(result: xarray.Dataset, channel: str) -> np.ndarray:
    """Sizes of the lines of a steady motion, the mean left out."""
    return np.asarray(np.abs(result["amplitude"].sel(channel=channel).values[1:]))


def rms(result: xarray.Dataset, channel: str) -> tuple[float, float]:
    """Effective value of a velocity about its mean, and of what of it lies above 2 kHz, µm/s."""
    power = 0.5 * line(result, channel) ** 2
    above = power[result["frequency"].values[1:] > 2000.0]
    return 1e6 * math.sqrt(power.sum()), 1e6 * math.sqrt(above.sum())


def steady_table(label: str, found: Steady) -> None:
    """A steady motion: how it was found and checked, its orbit, contact loss by bearing and heat by part."""
    result = found.motion
    data = {str(c): result["record"].sel(channel=c).values for c in result["channel"].values}
    frequency = result["frequency"].values
    strongest = float(frequency[1:][np.argmax(line(result, "shaft.middle.y"))])
    slow, rate = found.slowest
    print(
        f"  {label}\n"
        f"    found        {result.attrs['iterations']} iterations, residual {result.attrs['residual']:.0e}, "
        f"energy balance {result.attrs['energy_balance']:.0e}; "
        f"{'stable' if result.attrs['stable'] == 1 else 'unstable'}, largest multiplier "
        f"{result.attrs['multiplier']:.4f}\n"
        f"    check        marched on from it, {motor.PASSAGES} passages of {motor.PER_PASSAGE} exact steps: "
        f"lines of velocity to {1e-3 * frequency[-1]:.1f} kHz stay within {100 * found.departs:.2g} % of the "
        f"largest\n"
        f"    replaced     a ring-down of {found.ring_down:.2f} s to {100 * motor.REMAINS:g} % of its start, "
        f"slowest mode {slow:.0f} Hz, ζ {100 * rate / (2 * math.pi * slow):.3f} %\n"
        f"    orbit        {np.ptp(data['shaft.middle.x']) * 1e6:.3f} × "
        f"{np.ptp(data['shaft.middle.y']) * 1e6:.3f} µm about ({data['shaft.middle.x'].mean() * 1e6:.1f}, "
        f"{data['shaft.middle.y'].mean() * 1e6:.1f}) µm; strongest line {strongest:.0f} Hz"
    )
    speeds = [
        f"{name} {v:.1f} ({above:.1f})"
        for name, channel in VELOCITIES.items()
        for v, above in [rms(result, channel)]
    ]
    print(f"    velocity     µm/s rms (above 2 kHz): {', '.join(speeds)}")
    for side in SIDES:
        balls = bd.contact_statistics(result, side)
        counts = ", ".join(
            f"{int(n)} for {100 * share:.0f} %"
            for n, share in zip(balls["count"].values, balls["loaded"].values, strict=True)
            if share > 0
        )
        print(
            f"    {side + ' balls':<12} unloaded {100 * float(balls['free'].mean()):.1f} % of the time; peak "
            f"{float(balls['peak'].max()) / 1e3:.2f} kN; loaded: {counts}"
        )
    power = 1e3 * result["power"].values
    parts = zip(result["part"].values, power, strict=True)
    print(f"    heat         {power.sum():.3f} mW: " + ", ".join(f"{p} {w:.3f}" for p, w in parts))


def harmonic_part(states: Mapping[str, State], clock: Stages) -> tuple[dict[str, Harmonic], dict[str, Any]]:
    """The paper's section 4.1: responses and modes of every design, in tables."""
    print(
        f"\nlayers ({PRELOAD:g} N axial, shared by both bearings; {motor.RADIAL / 1e3:g} kN radial for "
        f"the strain)"
    )
    bare = states["no layer"].rest
    axial = [bare.bearings[side].g[2] for side in SIDES]
    print(f"  axial load of the bearings: {axial[0]:.1f} and {axial[1]:.1f} N")
    for state in states.values():
        if state.design.layer is not None:
            describe_layer(state)
    with clock.stage("harmonic responses and radiated power"):
        harmonics = {label: Harmonic.of(state.rest) for label, state in states.items()}
    receptances(harmonics)
    levels(harmonics)
    with clock.stage("damped modes, their shapes and energies"):
        bending = {label: motor.bending(state.rest) for label, state in states.items()}
        papers_modes(bare)
    modes_table(bending)
    return harmonics, bending


def steady_part(states: Mapping[str, State], clock: Stages) -> dict[str, Steady]:
    """The paper's section 4.2: the motion at speed without layer and with."""
    print(
        f"\n{motor.SPEED * 30 / math.pi:.0f} rpm, {motor.RADIAL / 1e3:g} kN: steady motions of "
        f"{motor.HARMONICS} harmonics of the ball pass, {motor.ball_pass():.1f} Hz"
    )
    found = {}
    for label in IN_MOTION:
        eq = states[label].loaded
        with clock.stage("steady motions and their stability"):
            motion = motor.steady(eq)
        with clock.stage("marches that check them"):
            departs = motor.marched_on(eq, motion)
        found[label] = Steady(motion, departs, motor.slowest(eq), motor.ring_down(eq) * motor.STEP)
        steady_table(label, found[label])
    return found


def sweep_part(states: Mapping[str, State], clock: Stages) -> dict[str, np.ndarray]:
    """Velocities over speed without layer and with."""
    with clock.stage("sweeps of steady motions"):
        rms = {label: motor.sweep(states[label].loaded) for label in IN_MOTION}
    rpm = motor.SPEEDS * 30 / math.pi
    print(
        f"\n{rpm[0]:.0f}–{rpm[-1]:.0f} rpm, {motor.RADIAL / 1e3:g} kN: {rpm.size} steady motions of each "
        f"design; with the layer against without, dB"
    )
    bare, layered = (rms[label] for label in IN_MOTION)
    for k, name in enumerate(VELOCITIES):
        known = np.isfinite(bare[:, k] + layered[:, k])
        # of the curves; the mean square hangs on which sharp resonances the speeds happen to meet
        curve = falls(bare[known, k] ** 2, layered[known, k] ** 2)[1]
        less = np.mean(layered[known, k] < bare[known, k])
        print(f"  {name:<16}{curve:6.1f} in the mean over the speeds; less at {100 * less:.0f} % of them")
    for label, found in rms.items():
        lost = int(np.isnan(found[:, 0]).sum())
        if lost:
            print(f"  {label}: no motion found at {lost} of {rpm.size} speeds")
    return rms


def main() -> int:
    """Run everything; returns the exit code.

    What costs most and depends on nothing else, the reduced pedestals and what they radiate, is kept in
    out/kept for the next run; `make` empties that folder when it installs the package anew.
    """
    out = motor.ROOT / "out"
    kept = out / "kept"
    kept.mkdir(parents=True, exist_ok=True)
    clock = Stages()
    with clock.stage("rubber: master curve and fit"):
        low, dma, master = motor.rubber()
    describe_rubber(low, master)
    four, losses = motor.designs(low), motor.loss_designs(low)
    with clock.stage("housings reduced, one for each bore"):
        for design in four:
            reduced_pedestal(motor.bore(design), str(kept))
    with clock.stage("other parts, assembly and equilibria"):
        states = {design.label: State.of(design, kept) for design in (*four, losses[-1])}
    harmonics, bending = harmonic_part(states, clock)
    motions = steady_part(states, clock)
    sweeps = sweep_part(states, clock)

    with clock.stage("sound power of the pedestals"):
        sounds = {label: motor_sound.heard(state.rest, kept) for label, state in states.items()}
    motor_sound.table(sounds)

    stored = {f"response/{label}": found.response for label, found in harmonics.items()}
    stored |= {f"steady/{label}": found.motion for label, found in motions.items()}
    stored |= {f"sound/{label}": found for label, found in sounds.items()}
    stored["sweep"] = xarray.Dataset(
        {"rms": (("design", "speed", "channel"), np.array(list(sweeps.values())), {"units": "m/s"})},
        {"design": list(sweeps), "speed": motor.SPEEDS, "channel": list(motor.VELOCITIES)},
    )
    with clock.stage("result file"):
        bd.save(
            {name.replace(", ", "_").replace(" ", "_"): data for name, data in stored.items()},
            out / "motor.nc",
        )
    with clock.stage("figures"):
        import motor_figures

        # the first two losses are the thick layers of the four, under another name
        same = zip(losses, (four[1].label, four[2].label, losses[2].label), strict=True)
        story = motor_figures.Story(
            dma,
            master,
            low,
            designs={design.label: design for design in four},
            responses={design.label: harmonics[design.label].response for design in four},
            losses={design.label: harmonics[known].response for design, known in same},
            power={design.label: harmonics[design.label].power for design in four},
            bending={design.label: bending[design.label] for design in four},
            motions={label: found.motion for label, found in motions.items()},
            sweeps=sweeps,
            sounds=sounds,
        )
        made = motor_figures.draw(story, out)
    clock.table()
    print(f"\nwrote {out / 'motor.nc'} and {len(made)} figures to {out}")
    return 0
