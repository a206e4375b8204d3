"""A mass on two rubber rings on a shaker: its transmissibility predicted from the DMA measurement alone.

The mass sits between two rubber rings, bonded to it and, outside, to a base that is shaken across their axis,
so that the rings work in shear. What was measured is H = acceleration of the mass / acceleration of the base,
with four masses. Predicted it follows from

    [K + 2 G*(ω) H_dev − ω² M] x = 0

with the matrices of two finite element rings and the mass between them, the outer faces moved by one, and
G*(ω) from isotherms below 20 Hz shifted to 21 °C. Nothing is fitted to the shaker. Run it as `python
examples/shaker.py`; it prints the prediction beside the measurement, what each possible cause of their
difference would do, and writes out/shaker.png. The measurement lies beside the project, not in it.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import bearingdyn as bd
from bearingdyn.material.superposition import LawName

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data" / "epdm70"

Float = NDArray[np.float64]
Complex = NDArray[np.complex128]

MASSES = (118, 253, 573, 1196)  # g, the names of the four measurements
F_MAX = 20.0  # Hz: above, the DMA carries the resonance of its fixture
BAND, BRANCHES = (10.0, 10e3), 6  # Hz, of the Maxwell model
K_RUBBER = 2e9  # Pa, bulk modulus of a filled rubber; DMA does not measure it
DENSITY, NU = 1000.0, 0.474  # kg/m³, Poisson's ratio: they come with the measurement
STRAIN_DMA = 0.15  # %, of the isotherms
STEEL = 7850.0  # kg/m³, gives the radius of a mass and with it its inertia
HALF_POWER = 0.7  # the peak is fitted where |H| exceeds this share of its largest value


@dataclass(frozen=True)
class Rig:
    """Two rings and a mass between them.

    mass: kg, without the discs by which it touches the rings; discs: kg, both together. width: m, from ring
    to ring. thickness, r_inner, r_outer: m, of a ring; K, density: of its rubber, Pa, kg/m³. loose: m, rim
    of each face that is not bonded. inertia: of mass and discs about y, kg m²; None: that of a steel
    cylinder. unequal: one ring is stiffer, the other softer by this share. hinged: the mass does not hold
    the tilt of the rings' faces.
    """

    mass: float
    discs: float
    width: float
    thickness: float
    r_inner: float
    r_outer: float
    K: float = K_RUBBER
    density: float = DENSITY
    loose: float = 0.0
    inertia: float | None = None
    unequal: float = 0.0
    hinged: bool = False

    @property
    def moving(self) -> float:
        """Mass and discs, without the rubber, kg."""
        return self.mass + self.discs

    @property
    def area(self) -> float:
        """Section of one ring, m²."""
        return math.pi * (self.r_outer**2 - self.r_inner**2)

    @property
    def rotary_inertia(self) -> float:
        """Inertia of mass and discs about y, kg m²."""
        if self.inertia is not None:
            return self.inertia
        radius_squared = self.moving / (STEEL * math.pi * self.width)
        return self.moving * (radius_squared / 4 + self.width**2 / 12)

    @property
    def ring(self) -> bd.Revolved:
        """One ring with rigid faces "low", z = 0, and "high"; its modulus enters with the frequency."""
        bonded = (self.r_inner, self.r_outer - self.loose)
        rubber = bd.Maxwell(5e6, [], [], K=self.K, density=self.density)
        return bd.Revolved(
            (bd.Region((self.r_inner, self.r_outer), (0.0, self.thickness), rubber),),
            {"low": bd.EndFace(0.0, bonded), "high": bd.EndFace(self.thickness, bonded)},
            moduli=(5e6, 10e6),
        )

    @property
    def bending(self) -> float:
        """Stiffness of a ring across its axis over G A/t, that of pure shear."""
        pure = 5e6 * self.area / self.thickness
        return float(self.ring.stiffness()[6, 6].real / pure)


@dataclass(frozen=True)
class Measurement:
    """One mass on the shaker: frequency (n,), Hz; H (n,); acceleration of the base (n,), m/s²; the rig."""

    name: str
    frequency: Float
    response: Complex
    base: Float
    rig: Rig
    temperature: float


@dataclass(frozen=True)
class Peak:
    """The resonance: frequency, Hz, and height |H|."""

    frequency: float
    height: float


def measurement(grams: int) -> Measurement:
    """What was measured with one mass at 0.1 g."""
    said = json.loads((DATA / f"shaker_{grams}g.json").read_text(encoding="utf-8"))
    path = DATA / f"shaker_0.1g_{grams}g.csv"
    table = np.genfromtxt(path, delimiter=",", skip_header=1, usecols=range(1, 6))
    frequency, base, base_phase, mass, mass_phase = table.T
    rig = Rig(
        mass=said["mass_kg"],
        discs=said["mass_disks"],
        width=said["mass_width"],
        thickness=said["thickness_m"],
        r_inner=said["inner_diameter_m"] / 2,
        r_outer=said["outer_diameter_m"] / 2,
    )
    response = mass / base * np.exp(1j * (mass_phase - base_phase))
    return Measurement(f"{grams} g", frequency, response, base, rig, said["temperature"])


@cache
def rubber(T: float = 21.0, law: LawName = "wlf") -> bd.Maxwell:
    """The rubber at a temperature, °C, by the DMA measurement alone."""
    table = bd.read_dma(DATA / "dma.csv")
    dma = table.select(f_max=F_MAX, run=table.runs or None)  # two runs, 5.6 % apart where they meet
    master = bd.master_curve(dma, T_ref=T, law=law)
    return bd.fit_maxwell(master, n=BRANCHES, band=BAND, K=K_RUBBER, density=DENSITY)


def modulus(frequency: Float, T: float = 21.0, law: LawName = "wlf") -> Complex:
    """G* (n,), Pa, at frequency (n,), Hz, and a temperature, °C."""
    return np.asarray(rubber(T, law).complex_modulus(2 * np.pi * frequency))


@cache
def _element(rig: Rig) -> bd.Superelement:
    return rig.ring.superelement()


def transmissibility(rig: Rig, frequency: Float, G: Complex) -> Complex:
    """H (n,) at frequency (n,), Hz, with the rubber's shear modulus G (n,), Pa.

    Coordinates: x of the mass; θy of the mass, or of the rings' faces apart; the rings' internal ones.
    """
    ring = _element(rig)
    own = ring.n - 12
    count = 3 if rig.hinged else 2
    n = count + 2 * own
    K, H, M = np.zeros((3, n, n + 1))  # the last column belongs to the base
    for side, (outer, inner, z) in enumerate(
        (("low", "high", -rig.width / 2), ("high", "low", rig.width / 2))
    ):
        T = np.zeros((ring.n, n + 1))
        x, tilt = ring.interfaces[inner][[0, 4]]
        T[x, 0] = 1.0
        if rig.hinged:
            T[tilt, 1 + side] = 1.0
        else:
            T[[x, tilt], 1] = z, 1.0  # u = t + θ × ρ
        T[12:, count + side * own : count + (side + 1) * own] = np.eye(own)
        T[ring.interfaces[outer][0], n] = 1.0
        share = 1.0 + (rig.unequal, -rig.unequal)[side]
        K += share * (T.T @ ring.K @ T)[:n]
        H += share * (T.T @ ring.viscoelastic[0].H @ T)[:n]
        M += (T.T @ ring.M @ T)[:n]
    M[0, 0] += rig.moving
    if not rig.hinged:
        M[1, 1] += rig.rotary_inertia
    omega = 2 * np.pi * frequency[:, None, None]
    S = K + 2 * G[:, None, None] * H - omega**2 * M
    return np.asarray(np.linalg.solve(S[..., :n], -S[..., n:])[:, 0, 0])


def shear_spring(rig: Rig, frequency: Float, G: Complex) -> Complex:
    """H (n,) of the moving mass on two massless springs G* A/t."""
    k = 2 * G * rig.area / rig.thickness
    return np.asarray(k / (k - (2 * np.pi * frequency) ** 2 * rig.moving))


def peak(frequency: Float, response: Complex) -> Peak:
    """Resonance of a transmissibility, measured or computed, by its points down to half power.

    1/|H|² is a parabola in f² for a mass on a spring with a constant complex stiffness; its vertex is taken.
    """
    height = np.abs(response)
    top = int(np.argmax(height))
    near = (height > HALF_POWER * height[top]) & (np.abs(frequency / frequency[top] - 1) < 0.2)
    x = (frequency[near] / frequency[top]) ** 2 - 1
    a, b, c = np.polyfit(x, height[near] ** -2, 2)
    return Peak(float(frequency[top] * math.sqrt(1 - b / (2 * a))), float((c - b**2 / (4 * a)) ** -0.5))


def prediction(m: Measurement) -> Complex:
    """H (n,) at the measured frequencies from the DMA data, the dimensions and the weights."""
    return transmissibility(m.rig, m.frequency, modulus(m.frequency, m.temperature))


# ---------------------------------------------------------------- causes of a difference, one by one


@cache
def strain_sweep() -> tuple[Float, Complex]:
    """Strain (n,), %, rising, and G* (n,), Pa, at 10 Hz and 22 °C."""
    table = np.genfromtxt(DATA / "strain_sweep_10hz.csv", delimiter=",", skip_header=1)
    table = table[np.argsort(table[:, 8])]
    return table[:, 8], table[:, 3] + 1j * table[:, 4]


def at_strain(percent: float) -> complex:
    """G* of the strain sweep at a strain, %."""
    strain, G = strain_sweep()
    x = np.log(strain)
    return complex(np.interp(math.log(percent), x, G.real), np.interp(math.log(percent), x, G.imag))


def strain_at_peak(m: Measurement) -> float:
    """Nominal shear strain of the rings at the measured resonance, %, zero-to-peak."""
    top = int(np.argmax(np.abs(m.response)))
    relative = abs(m.response[top] - 1) * m.base[top] / (2 * math.pi * m.frequency[top]) ** 2
    return float(100 * relative / m.rig.thickness)


def inferred(ms: Sequence[Measurement]) -> tuple[float, float, float, float]:
    """Stiffness over the predicted one, and mass beside the plain one, kg, that the four peaks ask for.

    A line through four points: predicted stiffness / measured ω² = (plain mass + more) / share. Returns the
    share, its standard error, the mass, its standard error.
    """
    found = [peak(m.frequency, m.response).frequency for m in ms]
    G = modulus(np.array(found)).real
    stiffness = [2 * g * m.rig.bending * m.rig.area / m.rig.thickness for g, m in zip(G, ms, strict=True)]
    y = np.array(stiffness) / (2 * np.pi * np.array(found)) ** 2
    A = np.stack([[m.rig.mass for m in ms], np.ones(len(ms))], axis=1) / y[:, None]
    (slope, offset), *_ = np.linalg.lstsq(A, np.ones(len(ms)))
    misfit = A @ (slope, offset) - 1
    spread = np.linalg.inv(A.T @ A) * (misfit @ misfit) / (len(ms) - 2)
    more = offset / slope
    gradient = np.array([-more, 1.0]) / slope
    errors = math.sqrt(spread[0, 0]) / slope**2, math.sqrt(gradient @ spread @ gradient)
    return 1 / slope, errors[0], more, errors[1]


def causes(m: Measurement, share: float) -> dict[str, Peak]:
    """The peak if one thing were otherwise. share: of the predicted stiffness that the measurement shows."""
    f, rig = m.frequency, m.rig
    G = modulus(f, m.temperature)
    bare = replace(rig, discs=0.0)
    slim = 0.95  # of the thickness, at equal volume
    squeezed = math.sqrt(rig.r_inner**2 + rig.area / slim / math.pi)
    payne = at_strain(strain_at_peak(m)), at_strain(STRAIN_DMA)
    strained = G.real * payne[0].real / payne[1].real + 1j * G.imag * payne[0].imag / payne[1].imag
    sweep = payne[1].real / float(modulus(np.array([10.0]), 22.2)[0].real)
    lossless = share / (1 - share) * np.abs(G)  # a series spring that gives the measured frequency
    responses = {
        "pure shear spring, plain mass": shear_spring(bare, f, G),
        "pure shear spring, with discs": shear_spring(rig, f, G),
        "rings without inertia": transmissibility(replace(rig, density=1e-3), f, G),
        "without the discs": transmissibility(bare, f, G),
        "discs counted twice": transmissibility(replace(rig, discs=2 * rig.discs), f, G),
        "Poisson's ratio 0.474": transmissibility(
            replace(rig, K=2 * 6.5e6 * (1 + NU) / (3 * (1 - 2 * NU))), f, G
        ),
        "2 K warmer": transmissibility(rig, f, modulus(f, m.temperature + 2)),
        "2 K colder": transmissibility(rig, f, modulus(f, m.temperature - 2)),
        "shifts as found, without a law": transmissibility(rig, f, modulus(f, m.temperature, "free")),
        "at its own strain (sweep)": transmissibility(rig, f, strained),
        "stiffness of the strain sweep": transmissibility(rig, f, sweep * G),
        "rings unequal by ±10 %: rocking": transmissibility(replace(rig, unequal=0.1), f, G),
        "  and the stated inertia": transmissibility(replace(rig, unequal=0.1, inertia=13e-5), f, G),
        "faces free to tilt (bound)": transmissibility(replace(rig, hinged=True), f, G),
        "outer 0.5 mm not bonded": transmissibility(replace(rig, loose=0.5e-3), f, G),
        "rings squeezed by 5 %": transmissibility(
            replace(rig, thickness=slim * rig.thickness, r_outer=squeezed), f, G
        ),
        "lossless spring in series": transmissibility(rig, f, G / (1 + G / lossless)),
        "stiffness as the peaks ask": transmissibility(rig, f, share * G),
    }
    return {label: peak(f, H) for label, H in responses.items()}


# ---------------------------------------------------------------- the story told


def table(rows: Mapping[str, Sequence[Peak]], reference: Sequence[Peak]) -> None:
    """Differences of frequency and height from a reference, %, a column for each mass."""
    for label, peaks in rows.items():
        pairs = list(zip(peaks, reference, strict=True))
        frequency = "".join(f"{100 * (p.frequency / q.frequency - 1):+8.1f}" for p, q in pairs)
        height = "".join(f"{100 * (p.height / q.height - 1):+8.1f}" for p, q in pairs)
        print(f"  {label:<34}{frequency}   {height}")


def figure(ms: Sequence[Measurement], path: Path) -> None:
    """Magnitude and phase, measured and predicted, of all masses."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from bearingdyn.plot.frame import colour, finish, halve, new_axes, style

    with style():
        upper = new_axes(width=6.8, height=4.6)
        lower = halve(upper, 0.36)
        for k, m in enumerate(ms):
            f, H, look = m.frequency, prediction(m), colour(k)
            dots = np.searchsorted(f, f[0] * np.exp(np.arange(1e-6, math.log(f[-1] / f[0]), 0.025)))
            upper.plot(f[dots], np.abs(m.response[dots]), "o", color=look, markersize=2.4)
            upper.plot(f, np.abs(H), color=look)
            lower.plot(f[dots], np.angle(m.response[dots], deg=True), "o", color=look, markersize=2.4)
            lower.plot(f, np.angle(H, deg=True), color=look)
            upper.text(peak(f, m.response).frequency, 12.0, m.name, color=look, ha="center")
        upper.plot([], [], "o", color="0.3", markersize=2.4, label="measured")
        upper.plot([], [], color="0.3", label="predicted")
        upper.legend(loc="lower left")
        for ax in (upper, lower):
            ax.set_xscale("log")
            ax.minorticks_off()
        upper.set_yscale("log")
        upper.set_ylim(0.25, 17.0)
        upper.set_yticks([0.3, 1, 3, 10], ["0.3", "1", "3", "10"], minor=False)
        upper.set_ylabel("|H|, mass over base")
        lower.set_yticks([0, -90, -180])
        lower.set_ylim(-190, 15)
        lower.set_ylabel("phase, °")
        ticks = [100, 200, 300, 500, 700, 1000]
        lower.set_xticks(ticks, [str(f) for f in ticks])
        lower.set_xlim(80, 1200)
        lower.set_xlabel("frequency, Hz")
        finish(lower)
        finish(upper, "Transmissibility of a mass on two rubber rings in shear")
        path.parent.mkdir(exist_ok=True)
        plt.savefig(path, dpi=130)
        plt.close("all")


def main() -> int:
    """Run everything; returns the exit code."""
    if not DATA.exists():
        print(f"skipped: the measurement is not here, {DATA}")
        return 0
    ms = [measurement(grams) for grams in MASSES]
    measured = [peak(m.frequency, m.response) for m in ms]
    predicted = [peak(m.frequency, prediction(m)) for m in ms]
    share, share_error, more, more_error = inferred(ms)
    print("resonance: measured, predicted from DMA data alone, difference; strain of the rings at the peak")
    for m, p, q in zip(ms, measured, predicted, strict=True):
        print(
            f"  {m.name:>7} {p.frequency:7.1f} Hz {q.frequency:7.1f} Hz "
            f"{100 * (q.frequency / p.frequency - 1):+5.1f} %   "
            f"|H| {p.height:5.2f} {q.height:6.2f} {100 * (q.height / p.height - 1):+5.1f} %   "
            f"{strain_at_peak(m):.3f} %"
        )
    names = "".join(f"{m.name:>8}" for m in ms)
    print(f"\nagainst the measurement, %{'':<10}{names}    {names}\n{'':<36}{'frequency':<35}height")
    found = [causes(m, share) for m in ms]
    rows = {label: [c[label] for c in found] for label in found[0]}
    built = list(rows)[:2]
    table({label: rows.pop(label) for label in built}, measured)
    table({"prediction": predicted}, measured)
    print("one thing changed, against the prediction, %")
    table(rows, predicted)
    rig = ms[0].rig
    print(
        f"\na ring is {100 * (1 - rig.bending):.1f} % softer than pure shear. By themselves the peaks ask "
        f"for {share:.3f} ± {share_error:.3f} of the stiffness\nand, beside the plain mass, for "
        f"{1e3 * more:.1f} ± {1e3 * more_error:.1f} g: the discs have {1e3 * rig.discs:.1f} g, a third of "
        f"the rubber {2e3 / 3 * rig.density * rig.area * rig.thickness:.1f} g"
    )
    out = ROOT / "out" / "shaker.png"
    figure(ms, out)
    print(f"\nwrote {out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
