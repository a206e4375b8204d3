"""The paper's section 3.4: damping layers clamped between two steel rings, and their frequency responses.

A sample is three rings bonded one in the other, steel, rubber, steel, hanging free. It is struck on the
edge of its outer ring: along the axis, which moves the rings against each other along it and tilts them,
and radially. Run it as `python examples/damping_layer_sample.py`; it writes the figures to out/.

The paper prints neither dimensions nor moduli. Here the rubber is the measured EPDM of examples/motor.py
at 20 °C, and two of the layers are the motor's own, 8 mm thick and 25.5 mm wide, and 4 mm and 17 mm,
around a ring of 31 mm outside radius as the motor's bearings have it; the third stands between. The
rings' other radii, 24 mm and 11 mm beyond the layer, are ours. The thick layers' axial and tilting modes
come to lie where the paper has its two damped ones, 800 and 1000 Hz; the thin one's lie higher.

Orders 0 and 1 about the axis, in which the faces of the rings stay rigid, come from the superelement with
every branch of the rubber. A blow at a point also bends the rings: the full model adds orders 2 to 6. Higher
ones would add to the yielding under the blow, which moves the dips between resonances. The tables give each
mode the share of its strain energy in the shear of the rubber.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray

import bearingdyn as bd

sys.path.insert(0, str(Path(__file__).resolve().parent))

import motor

from bearingdyn.fem import assemble_harmonic, factorise
from bearingdyn.system import assemble

ROOT = Path(__file__).resolve().parents[1]

PAPER = {"axial": 800.0, "tilt": 1000.0}  # Hz, the two damped modes of the paper's samples
BORE, BOND, STEEL_OUTSIDE = (
    0.024,
    motor.RING[1],
    0.011,
)  # m: radii of the inner ring; thickness of the outer one
ZETA_STEEL = 0.001
LAYER_MODES = ("axial", "torsion", "tilt", "radial")  # the rings as rigid bodies against each other
ORDERS, MODES = range(2, 7), 4  # bending of the rings: orders about the axis, modes of each in the tables
KNOTS = np.linspace(250.0, 6250.0, 9)  # Hz
STEP = 1e-3  # of the modulus, in a difference quotient: its error is 1e-6
REFINEMENT = 0.7  # of the mesh: frequencies within 0.1 % of the default's

AXIAL, RADIAL = "sample.edge.z", "sample.edge.x"


@dataclass(frozen=True)
class Design:
    """One sample: thickness and width of the layer, m, and its rubber. The rings are as wide as the layer."""

    label: str
    thickness: float
    width: float
    rubber: bd.Maxwell

    @property
    def outside(self) -> float:
        """Outside radius of the sample, m."""
        return BOND + self.thickness + STEEL_OUTSIDE

    def body(self) -> bd.Revolved:
        """The three rings, with the edge where they are struck."""
        radii = (BORE, BOND, BOND + self.thickness, self.outside)
        rings = bd.damping_sample(self.rubber, radii, self.width, damping=ZETA_STEEL, refinement=REFINEMENT)
        return replace(rings, outputs={"edge": (self.outside, 0.5 * self.width, 0.0)})


def designs(rubber: bd.Maxwell) -> list[Design]:
    """The three samples."""
    return [
        Design("8 mm × 25.5 mm", 0.008, 0.0255, rubber),
        Design("8 mm × 17 mm", 0.008, 0.017, rubber),
        Design("4 mm × 17 mm", 0.004, 0.017, rubber),
    ]


@dataclass(frozen=True, eq=False)
class Mode:
    """One mode of a free sample.

    order: about the axis. frequency: Hz. shear: share of its strain energy in the shear of the rubber.
    damping_ratio: by that share, the rubber's loss factor and the steel's own. modulus: G′, Pa, taken there.
    """

    name: str
    order: int
    frequency: float
    shear: float
    damping_ratio: float
    modulus: float


def modulus(design: Design, frequency: float) -> complex:
    """G*, Pa, at a frequency, Hz; above the band of the fit, that of its end."""
    omega = 2 * math.pi * min(frequency, motor.BAND[1])
    return complex(design.rubber.complex_modulus(omega))


def free_modes(design: Design, order: int, first: int, count: int, names: tuple[str, ...] = ()) -> list[Mode]:
    """Modes `first` to first + count of one order, the rubber at G′ of the first one's frequency.

    The share of the energy in shear is d ln ω² / d ln G; the shape's own change does not count (Rayleigh).
    """
    body = design.body()
    last = first + count
    G = modulus(design, 1e3).real
    for _ in range(2):  # G′ hardly changes with frequency
        G = modulus(design, float(body.modes(order, last, modulus=G).frequency[first])).real
    at = body.modes(order, last, modulus=G)
    low, high = (body.modes(order, last, modulus=G * (1 + s)).frequency for s in (-STEP, STEP))
    corner = np.hypot(body.mesh.r - design.outside, body.mesh.z - 0.5 * design.width)
    node = int(np.argmin(corner))
    found = []
    for i in range(first, last):
        frequency = float(at.frequency[i])
        shear = 2 * math.log(high[i] / low[i]) / math.log((1 + STEP) / (1 - STEP))
        there = modulus(design, frequency)
        loss = there.imag / there.real
        U, _, W = at.shapes[i, node]
        name = names[i - first] if names else ("in plane" if abs(U) > abs(W) else "out of plane")
        zeta = 0.5 * shear * loss + (1 - shear) * ZETA_STEEL
        found.append(Mode(name, order, frequency, shear, zeta, G))
    return found


def layer_modes(design: Design) -> list[Mode]:
    """The rings as rigid bodies against each other: axial, torsion, tilt, radial."""
    return [
        *free_modes(design, 0, 2, 2, LAYER_MODES[:2]),
        *free_modes(design, 1, 2, 1, LAYER_MODES[2:3]),
        *free_modes(design, 1, 3, 1, LAYER_MODES[3:]),
    ]


def ring_modes(design: Design) -> list[Mode]:
    """Modes of orders 2 and more, in which the rings bend."""
    return [mode for order in ORDERS for mode in free_modes(design, order, 0, MODES)]


def application(design: Design) -> bd.Application:
    """The sample, hanging free."""
    app = bd.Application()
    app.add("sample", design.body())
    for face in ("inner", "outer"):
        app.free(f"sample.{face}")
    return app


def damped_modes(design: Design) -> dict[str, tuple[float, float]]:
    """Frequency, Hz, and damping ratio of the layer's modes, every branch of the rubber a state: exact.

    The faces of the rings are rigid here.
    """
    system = assemble(application(design))
    exact = bd.modes(system, damped=True)
    against = system.rows("sample.outer") - system.rows("sample.inner")
    motion = np.abs(against @ exact["shape"].values.T) * np.array([1.0] * 3 + [design.outside] * 3)[:, None]
    x, y, z, θx, θy, θz = motion
    kind = np.argmax([z, θz, np.maximum(θx, θy), np.maximum(x, y)], axis=0)
    found = {}
    for k, name in enumerate(LAYER_MODES):
        moving = exact["frequency"].values > 1.0  # round-off may leave rigid motion a frequency
        lowest = int(np.flatnonzero((kind == k) & moving)[0])
        found[name] = (float(exact["frequency"][lowest]), float(exact["damping_ratio"][lowest]))
    return found


def bending_receptance(design: Design, frequency: np.ndarray) -> np.ndarray:
    """Receptance (f, 2, 2), m/N, of the struck edge, axial and radial, of the orders in which the rings bend.

    The full model of each order with G*(ω), projected onto what it does under the two blows at KNOTS: exact
    there, and between them to four digits.
    """
    body, steel = design.body(), bd.STEEL
    node = int(np.argmin(np.hypot(body.mesh.r - design.outside, body.mesh.z - 0.5 * design.width)))
    omega = 2 * np.pi * frequency
    G = design.rubber.complex_modulus(omega)
    lossy = 1 + 2j * ZETA_STEEL
    total = np.zeros((frequency.size, 2, 2), dtype=np.complex128)
    for order in ORDERS:
        h = assemble_harmonic(body.mesh, order)
        elastic = h.stiffness([steel.K, 0.0, steel.K], [steel.G, 0.0, steel.G])
        volume = h.stiffness([0.0, design.rubber.K, 0.0], [0.0, 0.0, 0.0])
        shear = h.stiffness([0.0, 0.0, 0.0], [0.0, 1.0, 0.0])
        M = h.mass_matrix([steel.density, design.rubber.density, steel.density])
        blow = np.zeros((h.n, 2))
        blow[h.coordinates(np.array([node]))[[2, 0]], [0, 1]] = 1.0  # axial, radial, as the channels
        answers = []
        for knot in KNOTS:
            w = 2 * math.pi * knot
            D = elastic * lossy + volume + complex(design.rubber.complex_modulus(w)) * shear - w**2 * M
            u = factorise(D).solve(blow.astype(np.complex128))
            answers += [u.real, u.imag]
        basis = np.hstack(answers)
        basis, size, _ = np.linalg.svd(basis / np.linalg.norm(basis, axis=0), full_matrices=False)
        basis = basis[:, size > 1e-12 * size[0]]
        k, v, s, m = (basis.T @ (A @ basis) for A in (elastic, volume, shear, M))
        stiff = k * lossy + v + G[:, None, None] * s - (omega**2)[:, None, None] * m
        force = basis.T @ blow
        total += force.T @ np.linalg.solve(stiff, np.broadcast_to(force, (frequency.size, *force.shape)))
    return total


def response(design: Design, frequency: np.ndarray) -> xarray.Dataset:
    """Accelerance, (m/s²)/N, of the struck edge, axial and radial, orders 0 to 6."""
    channels = [AXIAL, RADIAL]
    data = bd.frequency_response(application(design), frequency, channels, channels, quantity="acceleration")
    bent = -((2 * np.pi * frequency) ** 2)[:, None, None] * bending_receptance(design, frequency)
    return data.assign(response=data["response"].copy(data=data["response"].values + bent))


# ---------------------------------------------------------------- the story told


def table(design: Design, bending: list[Mode]) -> None:
    """What the modes of a sample are."""
    exact = damped_modes(design)
    loss = float(design.rubber.loss_factor(motor.ONE_KHZ))
    print(f"\n{design.label}, tan δ at 1 kHz {loss:.2f}")
    print(f"  {'mode':<22}{'Hz':>8}{'ζ':>9}{'energy in shear of rubber':>28}")
    for mode in layer_modes(design):
        f, zeta = exact[mode.name]
        print(f"  {mode.name:<22}{f:8.1f}{100 * zeta:8.2f} %{100 * mode.shear:26.1f} %")
    for mode in sorted(bending, key=lambda m: m.frequency)[:5]:
        name = f"order {mode.order}, {mode.name}"
        print(f"  {name:<22}{mode.frequency:8.1f}{100 * mode.damping_ratio:8.2f} %{100 * mode.shear:26.1f} %")
    for name, wanted in PAPER.items():
        print(f"  {name}: {100 * (exact[name][0] / wanted - 1):+.1f} % of the paper's {wanted:g} Hz")


def figures(out: Path, responses: dict[str, xarray.Dataset], name: str, title: str) -> list[Path]:
    """Accelerances of several samples, axial and radial; returns the files written."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    from bearingdyn import plot

    made = []
    for channel, direction in ((AXIAL, "axial"), (RADIAL, "radial")):
        axes: Any = plot.frequency_response(responses, channel, channel)
        axes.set_xscale("linear")
        axes.set_title(f"{title}: {direction} blow on the outer edge", loc="left", fontsize=10, pad=20)
        axes.set_ylabel("accelerance, (m/s²)/N")
        path = out / f"{name}_{direction}.png"
        axes.figure.savefig(path, dpi=130, bbox_inches="tight")
        plt.close(axes.figure)
        made.append(path)
    return made


def main() -> int:
    """Run everything; returns the exit code."""
    out = ROOT / "out"
    out.mkdir(exist_ok=True)
    rubber, _, _ = motor.rubber()
    source = "epdm70 (measured)" if motor.MEASURED.exists() else "the shipped sample (made, not measured)"
    G = complex(rubber.complex_modulus(motor.ONE_KHZ))
    print(f"rubber from {source}: |G*| {abs(G) / 1e6:.2f} MPa, tan δ {G.imag / G.real:.3f} at 1 kHz, 20 °C")
    frequency = np.linspace(200.0, 6000.0, 1161)
    samples: dict[str, xarray.Dataset] = {}
    chosen = designs(rubber)
    for design in chosen:
        bending = ring_modes(design)
        table(design, bending)
        samples[design.label] = response(design, frequency)
    losses: dict[str, xarray.Dataset] = {f"tan δ {G.imag / G.real:.2f}": samples[chosen[0].label]}
    for loss in (0.3, 0.5):
        design = replace(chosen[0], rubber=rubber.with_relaxation(loss, motor.ONE_KHZ))
        bending = ring_modes(design)
        table(design, bending)
        losses[f"tan δ {loss:.2f}"] = response(design, frequency)
    made = figures(out, samples, "sample_frf", "Three samples")
    made += figures(out, losses, "sample_loss", "Loss factor varied, 8 mm × 25.5 mm")
    print("\n" + "\n".join(str(path.relative_to(ROOT)) for path in made))
    return 0


if __name__ == "__main__":
    sys.exit(main())
