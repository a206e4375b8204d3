"""A short verification of an installed package: published numbers and closed forms against what it computes.

The whole list, with the reasons of its tolerances, is VERIFICATION.md of the source tree.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from bearingdyn.analysis import equilibrium, frequency_response, modes, transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, PointContact, Walther
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.material import Elastic, Maxwell
from bearingdyn.parts import Disc, Layer, RigidBody, Section, Shaft
from bearingdyn.progress import Progress, told

RPM = math.pi / 30
HARRIS = "T. A. Harris, Rolling Bearing Analysis"
ISO = "ISO/TS 16281 case, commercial code"
FRISWELL = "Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines, example 5.9.1"
CLOSED = "closed form"


@dataclass(frozen=True)
class Check:
    """One check of the installed package. `tolerance` is of the relative error; NaN where the case raised."""

    case: str
    source: str
    expected: float
    computed: float
    tolerance: float
    raised: str = ""

    @property
    def error(self) -> float:
        """Relative error."""
        return abs(self.computed - self.expected) / abs(self.expected)

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance (NaN is not)."""
        return self.error <= self.tolerance


def hertz() -> Iterator[Check]:
    """Check of the installed package: three rows of Harris' table of the point contact; its last digits."""
    for F, *printed in ((0.4795, 1.4556, 0.7278, 0.9429), (0.90999, 3.233, 0.4499, 0.6636),
                        (0.9989156, 17.974, 0.18822, 0.2106)):  # fmt: skip
        contact = PointContact(Rx=1.0, Ry=(1 + F) / (1 - F), modulus=1.0)
        found = (contact.a_star, contact.b_star, contact.delta_star)
        for name, wanted, got in zip(("a*", "b*", "δ*"), printed, found, strict=True):
            yield Check(f"Hertz contact, F(ρ) = {F:g}, {name}", HARRIS, wanted, got, 4e-4)


def iso() -> Iterator[Check]:
    """Check of the installed package: a single bearing of ISO/TS 16281; the digits given."""

    def brg(clearance: float) -> BallBearing:
        return BallBearing(7, 11.5e-3, 43.5e-3, 0.52, 0.53, clearance=clearance)

    yield Check("ball bearing, contact stiffness, N/m^1.5", ISO, 1.054911e10, brg(0.0).kappa, 1e-5)
    radial = brg(0.0).displacement((1e3, 0, 0, 0, 0, 0))[0]
    yield Check("ball bearing, radial displacement under 1 kN, µm", ISO, 15.1101, 1e6 * radial, 1e-5)
    axial = brg(1e-5).displacement((0, 0, 1e3, 0, 0, 0))[2]
    yield Check("ball bearing, axial displacement under 1 kN, µm", ISO, 149.1717, 1e6 * axial, 1e-5)


def catalogue() -> Iterator[Check]:
    """Check of the installed package: ball pass of a catalogue bearing, an oil's viscosity."""
    passes = bearing("6205", clearance=1e-5).frequencies(1797 * RPM).BPFO
    source = "Case Western Reserve University, bearing data"
    yield Check("6205, ball pass of the outer race at 1797 rpm, Hz", source, 107.36, passes, 5e-5)
    oil = Walther.from_two_points(40.0, 32e-6, 100.0, 5.4e-6)
    # log log (ν + 0.7) is linear in log T, T in K
    y = [math.log10(math.log10(nu + 0.7)) for nu in (32.0, 5.4)]
    x = [math.log10(T + 273.15) for T in (40.0, 100.0, 70.0)]
    nu = 10**10 ** (y[0] + (y[1] - y[0]) * (x[2] - x[0]) / (x[1] - x[0])) - 0.7
    yield Check("VG 32, viscosity at 70 °C, mm²/s", "ASTM D341", nu, 1e6 * oil.viscosity(70.0), 1e-9)


def maxwell() -> Iterator[Check]:
    """Check of the installed package: branch stress under a strain at a constant rate; round-off."""
    G, tau = 1e6, 2e-3
    material = Maxwell(0.0, [G], [tau], K=2e9, density=1200.0)
    for ratio in (1e-4, 1.0, 30.0):
        steps = 3
        stress = material.stress(np.full(steps + 1, 3.0), ratio * tau)[-1]
        exact = 2 * G * tau * 3.0 * -math.expm1(-steps * ratio)
        yield Check(f"Maxwell branch under a ramp, Δt/τ = {ratio:g}", CLOSED, exact, float(stress), 1e-12)


def layers() -> Iterator[Check]:
    """Check of the installed package: torsion of a bonded ring, 4π G L a²b²/(b² − a²), by third order."""
    a, b, L, G = 0.026, 0.028, 0.016, 1.5e6
    K = Layer(a, b, L, Elastic(2 * G * 1.49, 0.49, 1200.0)).stiffness()
    exact = 4 * math.pi * G * L * a**2 * b**2 / (b**2 - a**2)
    yield Check("bonded rubber ring, torsion, N m/rad", CLOSED, exact, float(K[5, 5].real), 1e-6)


def rotors() -> Iterator[Check]:
    """Check of the installed package: whirl of a rigid rotor, exact; of one with two discs, 4 to 5 digits."""
    m, It, Ip, k, a, speed = 5.0, 0.02, 0.03, 1e6, 0.1, 700.0
    app = Application()
    app.add("rotor", RigidBody(m, (It, It, Ip), rotating=True))
    app.ground("rotor.centre", stiffness=(2 * k, 2 * k, k, 2 * k * a**2, 2 * k * a**2, 1e6))
    omega = 2 * math.pi * modes(app, speed=speed).frequency.values
    root = math.sqrt((Ip * speed) ** 2 + 8 * It * k * a**2)
    for name, sign in (("backward", -1), ("forward", 1)):
        exact = (root + sign * Ip * speed) / (2 * It)
        got = float(omega[np.argmin(np.abs(omega - exact))])
        yield Check(f"rigid rotor, {name} conical whirl, rad/s", CLOSED, exact, got, 1e-12)

    metal = Elastic(211e9, 211e9 / (2 * 81.2e9) - 1, 7810.0)
    app = Application()
    app.add(
        "rotor",
        Shaft(
            [Section(1.5, 0.05)],
            seats={"left": 0.0, "right": 1.5},
            discs=[Disc.cylinder(0.5, 0.28, 0.07, 0.05, metal), Disc.cylinder(1.0, 0.35, 0.07, 0.05, metal)],
            material=metal,
            f_max=3e3,
            element_length=0.25,
        ),
    )
    for end in ("left", "right"):
        app.ground(f"rotor.{end}", stiffness=(1e6, 1e6, 0, 0, 0, 0))
    omega = 2 * math.pi * modes(app, speed=4000 * RPM).frequency.values
    for j, wanted in enumerate((85.39, 87.80, 251.78, 294.71, 600.18, 650.41)):
        got = float(omega[omega > 1.0][j])
        yield Check(f"two-disc rotor at 4000 rpm, mode {j + 1}, rad/s", FRISWELL, wanted, got, 1e-3)


def responses() -> Iterator[Check]:
    """Check of the installed package: one mass on spring and damper, harmonic, and marched by the scheme."""
    m, k, c, f, dt = 2.0, 2e5, 120.0, 80.0, 2e-4
    app = Application()
    app.add("mass", RigidBody(m, (1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=(k, k, k, 1e3, 1e3, 1e3), damping=(c, c, c, 1.0, 1.0, 1.0))
    omega = 2 * math.pi * f
    H = complex(
        frequency_response(app, [f], ["mass.centre.y"], ["mass.centre.y"])["response"].values[0, 0, 0]
    )
    exact = 1 / (k - omega**2 * m + 1j * omega * c)
    yield Check("mass on a spring, harmonic response, |H|, m/N", CLOSED, abs(exact), abs(H), 1e-12)

    app.load("mass.centre", (0, 1.0, 0, 0, 0, 0), frequency=f)
    # c/2m = 30/s: after one second e^{-30} is left of the start; then whole periods, 125 steps being two
    run = transient(equilibrium(app), speed=0.0, dt=dt, settle=5000, steps=125, record=["mass.centre.y"])
    t, y = run["time"].values, run["record"].values[:, 0]
    amplitude = 2 * abs(np.mean(y * np.exp(-1j * omega * t)))
    warped = 2 / dt * math.tan(omega * dt / 2)  # average acceleration sees this frequency
    discrete = abs(1 / (k - warped**2 * m + 1j * warped * c))
    yield Check("mass on a spring, march in steps of 0.2 ms, m/N", CLOSED, discrete, float(amplitude), 1e-9)


FAMILIES: tuple[Callable[[], Iterator[Check]], ...] = (
    hertz, iso, catalogue, maxwell, layers, rotors, responses,
)  # fmt: skip


def check(progress: Progress | bool | None = None) -> list[Check]:
    """Check the installed package: every case; one that raises an exception is a row that does not hold.

    Parameters
    ----------
    progress
        True for a bar, False for none, or a function called with (families done, families in all); None for
        a bar where standard error is a terminal.
    """
    found: list[Check] = []
    with told(progress, "family") as tell:
        for done, family in enumerate(FAMILIES):
            try:
                found += family()
            except Exception as error:
                raised = f"{type(error).__name__}: {error}"
                found.append(Check(family.__name__, "", math.nan, math.nan, 0.0, raised))
            if tell is not None:
                tell(done + 1, len(FAMILIES))
    return found
