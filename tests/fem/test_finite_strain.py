"""Finite strain: laws and moduli against their definitions, homogeneous states against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, root

from bearingdyn.fem.finite_strain import Point
from bearingdyn.material import Elastic, Hyperelastic, MooneyRivlin, NeoHooke, Yeoh
from bearingdyn.parts import Cylinder, EndFace, Region, Revolved

MM = 1e-3
G, K = 1e6, 2e9
RUBBER = Elastic(9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G), 1100.0)
LAWS = (NeoHooke(), MooneyRivlin(0.35, 0.15), Yeoh(0.5, -0.05, 0.02))


def invariants(stretches: np.ndarray) -> tuple[float, float]:
    bar = stretches / np.prod(stretches) ** (1 / 3)
    return float((bar**2).sum()), float((bar**-2.0).sum())


def energy(law: Hyperelastic, stretches: np.ndarray) -> float:
    """Strain energy per reference volume over G: the laws as their authors write them, and ½K(J − 1)²."""
    I1, I2 = invariants(stretches)
    volume = 0.5 * K / G * (np.prod(stretches) - 1) ** 2
    if isinstance(law, NeoHooke):
        return 0.5 * (I1 - 3) + volume
    if isinstance(law, MooneyRivlin):
        return law.C10 * (I1 - 3) + law.C01 * (I2 - 3) + volume  # 2(C10 + C01) = 1 here
    assert isinstance(law, Yeoh)
    return law.C10 * (I1 - 3) + law.C20 * (I1 - 3) ** 2 + law.C30 * (I1 - 3) ** 3 + volume


def nominal(law: Hyperelastic, stretches: np.ndarray) -> np.ndarray:
    """Nominal principal stresses over G: closed forms of ∂W/∂λ."""
    J = float(np.prod(stretches))
    bar2 = (stretches / J ** (1 / 3)) ** 2
    I1, I2 = invariants(stretches)
    if isinstance(law, MooneyRivlin):
        W1, W2 = law.C10, law.C01
    elif isinstance(law, Yeoh):
        W1, W2 = law.C10 + 2 * law.C20 * (I1 - 3) + 3 * law.C30 * (I1 - 3) ** 2, 0.0
    else:
        W1, W2 = 0.5, 0.0
    tau = 2 * W1 * (bar2 - I1 / 3) - 2 * W2 * (1 / bar2 - I2 / 3) + K / G * (J - 1) * J
    return np.asarray(tau / stretches)


def second_variation(law: Hyperelastic, F: np.ndarray, L: np.ndarray, h: float = 1e-4) -> float:
    """d²/ds² of W_iso((1 + s L) F) by central differences, over G."""

    def iso(s: float) -> float:
        stretches = np.linalg.svd((np.eye(3) + s * L) @ F, compute_uv=False)
        return energy(law, stretches) - 0.5 * K / G * (np.prod(stretches) - 1) ** 2

    return (iso(h) - 2 * iso(0.0) + iso(-h)) / h**2


@pytest.mark.parametrize("law", LAWS)
def test_moduli_are_the_second_variation_of_the_energy(law: Hyperelastic) -> None:
    rng = np.random.default_rng(3)
    for _ in range(5):
        F, L = np.eye(3) + 0.25 * rng.uniform(-1, 1, (3, 3)), rng.uniform(-1, 1, (3, 3))
        at = Point(F[None], law, np.ones(1))
        l = L.ravel()
        # 1e-5: second differences of step 1e-4 leave some 1e-7 of the energy's fourth derivative
        assert l @ at.tangent(np.zeros(1))[0] @ l == pytest.approx(second_variation(law, F, L), rel=1e-5)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("free", ["none", "one", "two"])
def test_stress_has_its_closed_form(law: Hyperelastic, free: str) -> None:
    """Uniaxial (two sides free), plane strain (one free), all held: nominal stresses."""
    stretches = np.array([0.8, 1.0, 1.0])
    if free == "two":
        stretches[1:] = brentq(lambda t: nominal(law, np.array([0.8, t, t]))[1], 1.0, 1.3, xtol=1e-15)
    elif free == "one":
        stretches[1] = brentq(lambda t: nominal(law, np.array([0.8, t, 1.0]))[1], 1.0, 1.4, xtol=1e-15)
    else:
        stretches[:] = 0.99, 1.004, 1.006
    at = Point(np.diag(stretches)[None], law, np.ones(1))
    J = np.prod(stretches)
    got = np.diag(at.stress[0] + K / G * (J - 1) * J * np.eye(3)) / stretches
    # 1e-9: K/G = 2000 times round-off
    np.testing.assert_allclose(got, nominal(law, stretches), atol=1e-9)


def pad() -> Revolved:
    return Revolved(
        (Region((0.0, 10 * MM), (0.0, 5 * MM), RUBBER, graded=True),),
        {"bottom": EndFace(0.0), "top": EndFace(5 * MM)},
        refinement=0.5,
    )


@pytest.mark.parametrize("law", LAWS)
def test_frictionless_pad_is_in_uniaxial_compression(law: Hyperelastic) -> None:
    """Force, axial tangent without friction, and torsion once it sticks, of 10 % squeeze."""
    lam = 0.9
    side = brentq(lambda t: nominal(law, np.array([lam, t, t]))[1], 1.0, 1.3, xtol=1e-15)
    area = np.pi * (10 * MM) ** 2
    squeezed = pad().assembled({"top": 0.5 * MM}, slip=("bottom", "top"), law=law)
    # 1e-6: asked for; the state is homogeneous and the elements hold it
    assert squeezed.force == pytest.approx(-nominal(law, np.array([lam, side, side]))[0] * G * area, rel=1e-6)
    assert squeezed.stretch == pytest.approx(side, rel=1e-9)
    J = lam * side**2
    # every law of Ī1 and Ī2 shears by its generalised modulus: τ = 2(W1 + W2 λ_t²/J^(2/3)...) between z and θ
    I1, _ = invariants(np.array([lam, side, side]))
    W1 = law.derivatives(I1, 0.0)[1]
    W2 = law.derivatives(I1, 0.0)[2]
    shear = 2 * (W1 * J ** (-2 / 3) + W2 * J ** (-4 / 3) * side**2) * G
    torsion = shear * side**2 * np.pi * (10 * MM) ** 4 / (2 * 5 * MM)
    assert squeezed.stiffness()[11, 11].real == pytest.approx(torsion, rel=1e-7)


@pytest.mark.parametrize("law", LAWS)
def test_disc_squeezed_round_its_rim_is_in_equibiaxial_compression(law: Hyperelastic) -> None:
    disc = Revolved(
        (Region((0.0, 10 * MM), (-2 * MM, 2 * MM), RUBBER),),
        {"rim": Cylinder(10 * MM)},
        refinement=0.5,
    )
    lam = 0.95
    height = brentq(lambda t: nominal(law, np.array([lam, lam, t]))[2], 1.0, 1.3, xtol=1e-15)
    squeezed = disc.assembled({"rim": 0.5 * MM}, slip=("rim",), law=law)
    wanted = -nominal(law, np.array([lam, lam, height]))[0] * G * 2 * np.pi * 10 * MM * 4 * MM
    assert squeezed.force == pytest.approx(wanted, rel=1e-6)
    assert squeezed.bulge == pytest.approx(2 * MM * (height - 1), rel=1e-6)


def test_axial_tangent_of_the_frictionless_pad_is_the_derivative_of_its_force() -> None:
    """The stuck pad is stiffer; the tangent that the search itself uses is the closed form's."""
    law = LAWS[0]

    def force(depth: float) -> float:
        return pad().assembled({"top": depth}, slip=("bottom", "top"), law=law).force

    def closed(depth: float) -> float:
        lam = 1 - depth / (5 * MM)
        side = root(lambda t: nominal(law, np.array([lam, t[0], t[0]]))[1], [1.0], tol=1e-14).x[0]
        return float(-nominal(law, np.array([lam, side, side]))[0] * G * np.pi * (10 * MM) ** 2)

    h = 1e-3 * MM
    got = (force(0.5 * MM + h) - force(0.5 * MM - h)) / (2 * h)
    assert got == pytest.approx((closed(0.5 * MM + h) - closed(0.5 * MM - h)) / (2 * h), rel=1e-6)
