"""The paper's section 4: a motor on two ball bearings, with and without a rubber layer around each.

A flexible shaft turns in two 6305 bearings, each in a flexible pedestal. Between the outer ring and the bore
of the pedestal lies nothing, or a ring of rubber bonded to both. The equations of motion are

    M ẍ + (C + Ω G) ẋ + (K + Ω N) x + layers + balls = f(t)

with the layer's shear modulus G*(ω) in the frequency domain and its Maxwell branches in the time domain, the
same material in both. Here stand the model and what is asked of it; motor_report.py tells the story and
motor_figures.py draws it. Run it as `python examples/motor.py`; it writes out/motor.nc and the figures to
out/.

The paper does not publish its geometry. This one is our own: it bears 5 kN a bearing, and its layer-free
bending modes lie near the paper's 382, 1885, 2027 and 4756 Hz (the table says how near).
"""

from __future__ import annotations

import contextlib
import math
import sys
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import xarray

import bearingdyn as bd
from bearingdyn.examples import paper_motor
from bearingdyn.examples.paper import INNER_6305, LEFT_SEAT, OUTER_6305, plain_6305
from bearingdyn.notice import CutHarmonics, UnequalRuns

ROOT = Path(__file__).resolve().parents[1]
MEASURED = ROOT.parent / "shared" / "data" / "epdm70" / "dma.csv"

BAND = (10.0, 10e3)  # Hz, of the Maxwell fit: what the motor's response lives in
# s: how long the load rests when the layers' deflection is asked for. The data reach 570 s at 20 °C (the
# sample's 160 s, and a plateau); what creeps later, they do not say
RESTED = 300.0
K_RUBBER = 2e9  # Pa, bulk modulus of a filled rubber; DMA does not measure it
DENSITY = 1150.0  # kg/m³
ONE_KHZ = 2 * math.pi * 1e3
LOW, HIGH = 0.10, 0.30  # tan δ at 1 kHz of the two rubbers that are compared

RADIAL = 10e3  # N, at mid-shaft, half of it on each bearing
SPEED = 5000 * math.pi / 30  # rad/s

AUDIBLE = np.linspace(1000.0, 5000.0, 4001)  # Hz, over which the paper judges the housing

STEP, STEPS = 2.5e-6, 100_000
REMAINS = 0.03  # of the slowest mode, when recording begins
PASSAGES, PER_PASSAGE = 50, 1024  # of the march that checks a steady state, and its exact steps
# of a steady state, to 9.9 kHz, where the rubber was measured; and of each in the sweep: the housing hardly
# moves above them
HARMONICS, SWEPT = 46, 24
# rad/s of the sweep: 2.7 % from one to the next, as wide as a resonance of ζ = 1.3 %
SPEEDS = np.geomspace(500.0, 12_000.0, 120) * math.pi / 30
VELOCITIES = ("shaft.end.y.velocity", "left_housing.top.y.velocity", "left_housing.top.z.velocity")
PAPER_MODES = (382.0, 1885.0, 2027.0, 4756.0)  # Hz, bending modes of the paper's shaft without layers

RING, INNER, SEAT = OUTER_6305, INNER_6305, LEFT_SEAT


@dataclass(frozen=True)
class Design:
    """One variant of the motor: a layer's thickness and width, m, and its rubber; or none.

    bore: radius of the housing's bore, m, a sleeve of steel on the ring filling what ring and layer leave;
    0: as ring and layer need it. moduli, meshed_as: of the layer.
    """

    label: str
    thickness: float = 0.0
    width: float = 0.0
    rubber: bd.Maxwell | None = None
    bore: float = 0.0
    moduli: tuple[float, ...] | None = None
    meshed_as: tuple[float, float, float] | None = None

    @property
    def inside(self) -> float:
        """Inner radius of the layer, m."""
        return self.bore - self.thickness if self.bore else RING[1]

    @property
    def layer(self) -> bd.Layer | None:
        """The ring of rubber around the outer ring."""
        if self.rubber is None:
            return None
        outside = self.inside + self.thickness
        return bd.Layer(
            self.inside, outside, self.width, self.rubber, moduli=self.moduli, meshed_as=self.meshed_as
        )


def rubber(path: Path = MEASURED) -> tuple[bd.Maxwell, bd.DMAData, bd.MasterCurve]:
    """Measured rubber: its Maxwell model at 20 °C, the data and the master curve.

    Points above 20 Hz carry the resonance of the fixture and are left out. Where the measurement is absent,
    the sample shipped with the package serves: data made from a stated model, not measured.

    The rubber still relaxes at 10 Hz, where the band begins. The fit is pinned to the master curve's modulus
    after RESTED, which so is the model's relaxed modulus, and what its layers carry at rest.
    """
    measured = path.exists()
    table = bd.read_dma(path if measured else bd.sample_dma_path())
    # the measurement is two runs, 5.6 % apart where they meet; the band needs both
    dma = table.select(f_max=20.0, run=table.runs or None)
    with warnings.catch_warnings():
        # both runs are brought to the level of the first; motor_report says by how much
        warnings.simplefilter("ignore", UnequalRuns)
        master = bd.master_curve(dma, T_ref=20.0)
    return bd.fit_maxwell(master, n=5, band=BAND, K=K_RUBBER, density=DENSITY, pin=RESTED), dma, master


def designs(rubber: bd.Maxwell) -> list[Design]:
    """The four variants: none, low and high loss at equal |G*| at 1 kHz, and a second layer.

    The low one is the rubber as it is, unless that loses more than half of what the high one does: the
    shipped sample has tan δ 0.30 at 1 kHz of itself.
    """
    low = rubber if rubber.loss_factor(ONE_KHZ) < 0.5 * HIGH else rubber.with_loss_factor(LOW, ONE_KHZ)
    high = rubber.with_relaxation(HIGH, ONE_KHZ)
    return [
        Design("no layer"),
        Design("layer, low loss", 0.008, 0.0255, low),
        Design("layer, high loss", 0.008, 0.0255, high),
        Design("thin layer, high loss", 0.004, 0.017, high),
    ]


def loss_designs(rubber: bd.Maxwell) -> list[Design]:
    """The thick layer at three loss factors, equal |G*| at 1 kHz: the low one's, 0.3 and 0.6."""
    _, low, high, _ = designs(rubber)
    assert low.rubber is not None
    loss = float(low.rubber.loss_factor(ONE_KHZ))
    return [
        replace(low, label=f"layer, tan δ {loss:.2f}"),
        replace(high, label="layer, tan δ 0.30"),
        replace(high, label="layer, tan δ 0.60", rubber=rubber.with_relaxation(0.60, ONE_KHZ)),
    ]


def bore(design: Design) -> float:
    """Diameter of the bore that takes ring and layer."""
    return 2 * (design.inside + design.thickness)


def motor(design: Design, radial: float = 0.0, cache: Path | None = None) -> bd.Application:
    """The application: shaft, rings, layers, housings, bearings and loads; built in bearingdyn.examples.

    cache: a folder that keeps the reduced pedestals.
    """
    return paper_motor(design.layer, radial, sleeve=design.bore and design.inside, cache=cache)


INPUT = "shaft.middle.y"
OUTPUTS = ("shaft.end.y", "left_housing.top.y", "left_housing.top.z", "shaft.middle.y")
SURFACES = ("left_housing.outside", "right_housing.outside")


def response(eq: bd.Equilibrium, frequency: np.ndarray) -> xarray.Dataset:
    """Receptances at the shaft's end, the top of the left housing and mid-shaft to a vertical force there."""
    return bd.frequency_response(eq, frequency, [INPUT], OUTPUTS)


def radiated(eq: bd.Equilibrium, frequency: np.ndarray) -> np.ndarray:
    """Equivalent radiated power (frequency,) of both housings' outside surfaces, W/N², to the same force."""
    power = bd.radiated_power(eq, frequency, [INPUT], SURFACES)["power"].values
    return np.asarray(power.sum(axis=(1, 2)))


@dataclass(frozen=True)
class Bending:
    """Vertical bending modes of the shaft in a state: what bd.modes, mode_shapes and energy_shares say of
    those alone."""

    modes: xarray.Dataset
    shapes: xarray.Dataset
    shares: xarray.Dataset

    def of(self, kind: str, *parts: str) -> np.ndarray:
        """Share (modes,) of all parts whose names contain one of these in "strain", "dissipation" …"""
        names = [str(n) for n in self.shares["part"].values if any(p in str(n) for p in parts)]
        return np.asarray(self.shares[kind].sel(part=names).values.sum(axis=1))


def bending(eq: bd.Equilibrium, f_max: float = 6000.0, damped: bool = True) -> Bending:
    """Modes below f_max in which the shaft carries the kinetic energy and moves up and down most.

    Against the other motions of the shaft: sideways, along z, and turning, at the radius of its seats.
    """
    found = bd.modes(eq, damped=damped)
    shapes, shares = bd.mode_shapes(eq, found), bd.energy_shares(eq, found)
    on_shaft = [str(p) for p in shapes["place"].values if str(p).startswith("shaft.")]
    moved = shapes["motion"].sel(place=on_shaft)
    vertical, sideways, along, turned = (
        np.abs(moved.sel(component=c).values).max(axis=1) for c in ("y", "x", "z", "θz")
    )
    others = [sideways, along, INNER[0] * turned]
    chosen = np.flatnonzero(
        (vertical > np.max(others, axis=0))
        & (shares["kinetic"].sel(part="shaft").values > 0.5)
        & (found["frequency"].values < f_max)
    )
    return Bending(*(data.isel(mode=chosen) for data in (found, shapes, shares)))


def bending_modes(eq: bd.Equilibrium, count: int = 4) -> np.ndarray:
    """Frequencies (count,), Hz, of the vertical bending modes nearest the paper's, by their peaks.

    A peak of the receptance of the shaft's end, as the paper reads its own, each used once.
    """
    frequency = np.geomspace(50.0, 7000.0, 6000)
    level = np.abs(response(eq, frequency)["response"].values[:, 0, 0])
    peaks = frequency[1:-1][(level[1:-1] > level[:-2]) & (level[1:-1] > level[2:])]
    found = []
    for wanted in PAPER_MODES[:count]:
        nearest = peaks[np.argmin(np.abs(np.log(peaks / wanted)))]
        found.append(float(nearest))
        peaks = peaks[peaks != nearest]
    return np.array(found)


def slowest(eq: bd.Equilibrium) -> tuple[float, float]:
    """Frequency, Hz, and rate of decay, 1/s, of the damped mode at speed that rings longest."""
    modes = bd.modes(eq, speed=SPEED, damped=True)
    rate = -modes["eigenvalue"].values.real
    k = int(np.argmin(rate))
    return float(modes["frequency"].values[k]), float(rate[k])


def ring_down(eq: bd.Equilibrium) -> int:
    """Steps until the slowest damped mode has fallen to REMAINS of what the start gave it."""
    return math.ceil(-math.log(REMAINS) / slowest(eq)[1] / STEP)


def run(
    eq: bd.Equilibrium,
    settle: int,
    steps: int = STEPS,
    progress: Callable[[int, int], object] | None = None,
) -> xarray.Dataset:
    """The transient at 5000 rpm under the radial load, the first `settle` steps thrown away."""
    return bd.transient(
        eq, speed=SPEED, dt=STEP, steps=steps, settle=settle, record=recorded(eq), progress=progress
    )


def recorded(eq: bd.Equilibrium) -> list[str]:
    """The channels of a motion at speed."""
    return [
        "shaft.middle.x",
        "shaft.middle.y",
        "shaft.end.x",
        "shaft.end.y",
        *VELOCITIES,
        "left.loaded",
        "right.loaded",
        *bd.ball_channels(eq, "left"),
        *bd.ball_channels(eq, "right"),
    ]


def steady(eq: bd.Equilibrium) -> xarray.Dataset:
    """The steady motion at 5000 rpm under the radial load: where a ring-down would end."""
    return bd.steady_state(eq, speed=SPEED, record=recorded(eq), harmonics=HARMONICS)


def marched_on(eq: bd.Equilibrium, motion: xarray.Dataset) -> float:
    """How far PASSAGES of exact steps lead away from a steady motion.

    The largest change of a line of the velocities, by the largest line of the same channel.
    """
    dt = 1 / float(motion["base_frequency"].values[0]) / PER_PASSAGE
    run = bd.transient(
        eq,
        speed=SPEED,
        dt=dt,
        steps=PASSAGES * PER_PASSAGE,
        record=VELOCITIES,
        initial=motion,
        method="exact",
        progress=False,
    )
    wanted = np.abs(motion["amplitude"].sel(channel=list(VELOCITIES)).values[1:])
    last = run["record"].values[-PER_PASSAGE:]
    found = np.abs(np.fft.rfft(last, axis=0))[1 : len(wanted) + 1] * (2 / PER_PASSAGE)
    return float((np.abs(found - wanted) / wanted.max(axis=0)).max())


def sweep(eq: bd.Equilibrium, progress: Callable[[int, int], object] | None = None) -> np.ndarray:
    """Velocities (speed, channel) over SPEEDS, m/s rms, as a slow run-up meets them.

    Each motion begins from that of the speed below, where that leads to none from the equilibrium; NaN where
    neither does.
    """
    rms = np.full((SPEEDS.size, len(VELOCITIES)), np.nan)
    motion = None
    for k, speed in enumerate(SPEEDS.tolist()):
        # lines beyond the band that the rubber was measured for say nothing
        lines = min(SWEPT, int(BAND[1] / (ball_pass() * speed / SPEED)))
        before, motion = motion, None
        for start in (None,) if before is None else (before, None):
            with warnings.catch_warnings(), contextlib.suppress(bd.SolverError):
                # so that those left out are left out on purpose
                warnings.simplefilter("ignore", CutHarmonics)
                motion = bd.steady_state(
                    eq, speed=speed, record=VELOCITIES, harmonics=lines, start=start, stability=False
                )
                break
        if motion is None:
            continue
        rms[k] = np.sqrt(0.5 * (np.abs(motion["amplitude"].values[1:]) ** 2).sum(axis=0))
        if progress is not None:
            progress(k + 1, SPEEDS.size)
    return rms


def ball_pass() -> float:
    """Ball-pass frequency of the outer race, Hz."""
    brg = plain_6305()
    return brg.Z * brg.cage_ratio * SPEED / (2 * math.pi)


if __name__ == "__main__":
    import motor_report

    sys.exit(motor_report.main())
