"""The application as a whole: weight, a moving ground, whirl over speed, and one story in two domains."""

from __future__ import annotations

import math

import numpy as np

from bearingdyn.analysis import campbell, equilibrium, frequency_response, modes
from bearingdyn.application import Application
from bearingdyn.fem import Section
from bearingdyn.material import STEEL
from bearingdyn.parts import RigidBody, Shaft
from bearingdyn.system import System
from rotors import friswell
from verified.row import RPM, Row, rows

FORMULA = "closed form"


def weight() -> list[Row]:
    """Sag of a shaft under its own weight, and the transmissibility of a mass on a moving ground."""
    L, d = 0.6, 0.02
    shaft = Shaft([Section(L, d)], seats={"left": 0.0, "right": L}, points={"middle": L / 2}, f_max=3e4)
    app = Application()
    app.add("shaft", shaft)
    for end in ("left", "right"):
        app.ground(f"shaft.{end}", stiffness=(1e14, 1e14, 1e14, 0, 0, 1e8))
    app.gravity((0, -9.81, 0))
    A, second, nu = math.pi * d**2 / 4, math.pi * d**4 / 64, STEEL.nu
    q, shear = STEEL.density * A * 9.81, 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)
    sag = 5 * q * L**4 / (384 * STEEL.E * second) + q * L**2 / (8 * shear * STEEL.G * A)
    found = -equilibrium(app).displacement("shaft.middle")[1]
    made = rows(
        "§3.10",
        1e-4,
        "modes above 30 kHz are left out",
        "Timoshenko beam on two pins",
        [("sag of Ø20×600 under its own weight (m)", sag, found)],
    )
    m, c, k = 2.0, 40.0, 5e5
    body = Application()
    body.add("body", RigidBody(m, (1.0, 1.0, 1.0)))
    body.ground("body.centre", stiffness=(k,) * 6, damping=(c,) * 6)
    f = np.array([5.0, 79.6, 400.0])
    w = 2 * math.pi * f
    T = np.abs((k + 1j * w * c) / (k - m * w**2 + 1j * w * c))
    ratio = np.abs(frequency_response(body, f, ["ground.y"], ["body.centre.y"]).response.values[:, 0, 0])
    cases = [(f"transmissibility of a mass at {a:g} Hz", b, x) for a, b, x in zip(f, T, ratio, strict=True)]
    return made + rows("—", 1e-11, "round-off of a complex solution", FORMULA, cases)


def whirl() -> list[Row]:
    """The two-disc rotor of Friswell et al., its modes followed from standstill to 4000 rpm."""
    found = campbell(friswell(), np.linspace(0.0, 4000.0, 21) * RPM, count=8, damped=False)
    omega = 2 * math.pi * found.frequency.values
    names = ("1st, backward", "1st, forward", "2nd, backward", "2nd, forward", "torsion", "3rd, backward")
    published = (85.39, 87.80, 251.78, 294.71, 650.41, 600.18)
    elastic = omega[-1, omega[0] > 1.0][:6]
    ordered = [*np.sort(elastic[:2]), *np.sort(elastic[2:4]), *elastic[4:]]
    cases = [
        (f"two-disc rotor at 4000 rpm, {n} mode, followed (rad/s)", a, b)
        for n, a, b in zip(names, published, ordered, strict=True)
    ]
    return rows("§3.11", 1e-3, "another shear coefficient", "Friswell et al., example 5.9.1", cases)


def two_domains() -> list[Row]:
    """The layered motor: one march under forty sines against a dense solve of the paper's (20)."""
    from marches import BASE, OUTPUTS, lines, marched

    harmonics = lines(40)
    found, system = marched(1e-6, harmonics, 1e-3, linear=False)
    wanted = np.array([_receptance(system, BASE * k, OUTPUTS) for k in harmonics])
    error = np.linalg.norm(found - wanted, axis=1) / np.linalg.norm(wanted, axis=1)
    cases = [
        (
            f"layered motor at {BASE * harmonics[i]:.0f} Hz, norm of receptances, marched (m/N)",
            np.linalg.norm(wanted[i]),
            np.linalg.norm(wanted[i]) * (1 + error[i]),
        )
        for i in (0, 8, 16, 24, 32, 39)
    ]
    cases.append(
        (
            "the same at all 40 frequencies, 20–5000 Hz",
            np.linalg.norm(wanted),
            np.linalg.norm(wanted) + np.linalg.norm(found - wanted),
        )
    )
    return rows("—", 0.01, "asked for to 1 %; Δt = 1 µs", "paper (20), dense solve", cases)


def _receptance(system: System, f: float, outputs: list[str]) -> np.ndarray:
    """Response (o,) per N at mid-shaft: −ω²M + iωC + K + 2 G*(ω) H, term by term."""
    w = 2 * math.pi * f
    D = -(w**2) * system.M + 1j * w * system.C + system.K
    for term in system.layers:
        m = term.material
        branches = sum(g * 1j * w * t / (1 + 1j * w * t) for g, t in zip(m.G, m.tau, strict=True))
        D = D + 2 * (m.G0 + 1j * w * m.eta0 + branches) * term.L @ term.L.T
    x = np.linalg.solve(D, system.row("shaft.middle.y").astype(complex))
    return np.array([system.row(o) @ x for o in outputs])


def ring_down() -> list[Row]:
    """Poles fitted to the ring-down of a layered rotor, against roots of its dynamic stiffness nearby."""
    from marches import ring_down_of_a_layered_rotor

    fitted, state = ring_down_of_a_layered_rotor()
    system = state.linearised()
    found, cases = modes(state, damped=True), []
    for value, shape in zip(found.eigenvalue.values, found["shape"].values, strict=True):
        if abs(system.row("shaft.end.y") @ shape) > 1e-5 and abs(value) < 2 * math.pi * 3000.0:
            near = fitted[np.abs(fitted - value).argmin()]
            root = _root(system, near)
            name = f"layered rotor, mode at {abs(root) / 2 / math.pi:.0f} Hz, fitted to its ring-down"
            cases += [(f"{name} (Hz)", abs(root) / 2 / math.pi, abs(near) / 2 / math.pi)]
    return rows("—", 5e-3, "asked for to 0.5 %", "root of det D(λ) = 0 by Newton's iteration", cases)


def _root(system: System, value: complex) -> complex:
    """Eigenvalue near a guess: inverse iteration on D(λ), λ by Newton (residual inverse iteration)."""

    def dynamic(s: complex) -> np.ndarray:
        D = s**2 * system.M + s * system.C + system.K
        for term in system.layers:
            m = term.material
            G = m.G0 + m.eta0 * s + sum(g * s * t / (1 + s * t) for g, t in zip(m.G, m.tau, strict=True))
            D = D + 2 * G * term.L @ term.L.T
        return np.asarray(D)

    x = np.ones(system.n, dtype=complex)
    for _ in range(30):
        step = 1e-6 * abs(value)
        slope = (dynamic(value + step) - dynamic(value - step)) / (2 * step)
        y = np.linalg.solve(dynamic(value), slope @ x)
        change = (x @ x) / (x @ y)
        x = y / np.linalg.norm(y)
        value = value - change
        if abs(change) < 1e-12 * abs(value):
            break
    return complex(value)
