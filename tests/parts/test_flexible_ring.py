"""The flexible outer ring by itself: ring theory, its modes, the reduced against the whole."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse.linalg

import bearingdyn as bd
from bearingdyn.bearing.raceway_series import RIGID, RacewaySeries
from bearingdyn.material import STEEL
from bearingdyn.parts import FlexibleBearing, FlexibleRing, Ring
from flexible_rings import (
    B6305,
    CUSHIONED,
    LAYER,
    MM,
    RING,
    RUBBER,
    SIZE,
)
from verified.ring_theory import annulus_compliance, thick_ring, thin_ring


def at(series: RacewaySeries, psi: float) -> np.ndarray:
    """Row that gives the radial displacement at an azimuth."""
    values = [(0 if a else 1) * (math.sin(n * psi) if s else math.cos(n * psi)) for a, n, s in series.terms]
    return np.array(values)


def pinched(a: float, b: float, width: float, P: float, order: int) -> tuple[float, float]:
    """Change of the bore's diameter along two opposed outward loads P, and across, of a ring by itself."""
    ring = FlexibleRing(a, b, width, arm=0.5 * (a + b), order=order, groove=width, outside="flexible")
    element = ring.superelement()
    raceway = element.raceways["raceway"]
    along = at(raceway.series, 0.0) + at(raceway.series, math.pi)
    across = at(raceway.series, math.pi / 2) + at(raceway.series, -math.pi / 2)
    # the loads balance: rigid motion, which the pseudo-inverse leaves out, is not asked for
    u = raceway.rows @ np.linalg.pinv(element.K, rcond=1e-12) @ raceway.rows.T @ (P * along)
    return float(along @ u), float(across @ u)


def test_thin_ring_between_two_opposed_loads() -> None:
    R, t = 50 * MM, 1 * MM
    expected = thin_ring(100.0, STEEL.E, t**4 / 12, R)
    # the 1 %; stretch, shear and orders beyond 16 are each below 0.1 % at R/t = 50
    np.testing.assert_allclose(pinched(R - t / 2, R + t / 2, t, 100.0, 16), expected, rtol=2e-3)


def test_thick_ring_between_two_opposed_loads() -> None:
    R, t, width = 50 * MM, 10 * MM, 3 * MM
    expected = thick_ring(100.0, STEEL.E, STEEL.nu, R - t / 2, R + t / 2, width)
    thin = thin_ring(100.0, STEEL.E, width * t**3 / 12, R)
    # the 1 %, at R/t = 5, where the thin formula is 6 % off
    np.testing.assert_allclose(pinched(R - t / 2, R + t / 2, width, 100.0, 32), expected, rtol=1e-2)
    assert expected[0] > 1.05 * thin[0]


@pytest.mark.parametrize("thickness", [12.5 * MM, 20 * MM])
def test_every_order_of_a_thick_ring_is_that_of_plane_elasticity(thickness: float) -> None:
    a, b, width = 50 * MM - thickness / 2, 50 * MM + thickness / 2, 1 * MM
    ring = FlexibleRing(a, b, width, arm=50 * MM, groove=width, outside="flexible", refinement=2.0)
    element = ring.superelement()
    raceway = element.raceways["raceway"]
    flexible = np.linalg.pinv(element.K, rcond=1e-13)
    for n in (0, 2, 3, 4, 6, 8):
        row = raceway.rows[raceway.series.index(0, n, 0)]
        pressure = 1.0 / (width * a * (math.pi if n else 2 * math.pi))  # of a unit load on the coefficient
        exact = pressure * annulus_compliance(n, STEEL.E, STEEL.nu, a, b)
        # a section this narrow is in plane stress but for (n·width/a)⁴, some 1e-5 at n = 8
        assert row @ flexible @ row == pytest.approx(exact, rel=2e-5)


def test_a_free_ring_of_raceways_alone_has_the_modes_of_the_whole_ring() -> None:
    a, b, width = 14 * MM, 17.5 * MM, 11 * MM
    ring = FlexibleRing(a, b, width, arm=12 * MM, order=3, outside="flexible", f_max=40e3, damping=0.01)
    element = ring.superelement()
    frequency = np.sqrt(np.abs(scipy.linalg.eigvalsh(element.K, element.M))) / (2 * np.pi)
    # x, y, z and two tilts; the spin about z moves no ball and is left out. Round-off of 40 kHz: 1e-2 Hz
    assert (frequency[:5] < 1.0).all()
    # theory.md §3.10: n = 2 in and out of plane, n = 3; to 0.2 %
    elastic = frequency[5:]
    for wanted in (8857.0, 14525.0, 24248.0, 37807.0):
        near = elastic[np.abs(elastic / wanted - 1) < 2e-3]
        assert near.size == 2  # cosine and sine
    whole = np.concatenate([Ring(a, b, width).modes(n, 2).frequency for n in (2, 3)])
    for f in whole:
        # the same mesh but for the groove's edges; modes up to f_max are in the basis: the mesh's 1e-4
        assert np.abs(elastic / f - 1).min() < 2e-4


def test_the_stiff_ring_moves_as_one_body() -> None:
    """Raceway rows of a rigid motion are those of a rigid ring, whatever the section does."""
    for ring in (RING, replace(RING, groove=9.2 * MM, groove_radius=6.1 * MM, r_inner=25.6 * MM)):
        boundaries = ring.body._boundaries
        track = boundaries.tracks["raceway"]
        for order in (0, 1):
            h = ring.body._harmonic(order, (0, 2) if order == 0 else (0, 1, 2))
            got = boundaries.averages(h) @ h.rigid_shapes(np.arange(h.mesh.r.size), 0.0)
            # order 0: z; order 1: x and θy, radial and axial cosine (−R θy); round-off
            expected = [[0.0], [1.0]] if order == 0 else [[1.0, 0.0], [0.0, -B6305.arm]]
            np.testing.assert_allclose(got, expected, atol=1e-13)
        # the frame of the kernel is the frame of the ring
        np.testing.assert_array_equal(
            RIGID.rigid(0.02), bd.BallBearing.coefficients(replace(B6305, arm=0.02))
        )
        assert track.arm == B6305.arm


@pytest.mark.parametrize("race", ["outer", "inner"])
def test_the_race_follows_the_interface_that_holds_the_ring(race: str) -> None:
    """A ring in rubber, its rigid interface moved: the race moves with it, tilts about x and y included."""
    layer = LAYER if race == "outer" else replace(LAYER, r_inner=23.5 * MM, r_outer=27.5 * MM)
    arm = 22 * MM if race == "outer" else 36 * MM
    ring = FlexibleRing(*SIZE, arm=arm, order=3, layer=layer, race=race, f_max=0.0)
    element = ring.superelement()
    raceway, held = element.raceways["raceway"], element.interfaces[race]
    wanted = np.zeros((len(raceway.series), 6))
    # z = y θx − x θy at the arm: axial sine and cosine of order 1
    terms = ((0, 1, 0), (0, 1, 1), (1, 0, 0), (1, 1, 1), (1, 1, 0))
    for at, (term, value) in enumerate(zip(terms, (1.0, 1.0, 1.0, arm, -arm), strict=True)):
        wanted[raceway.series.index(*term), at] = value
    # round-off of a static solution between steel and rubber
    np.testing.assert_allclose(raceway.rows[:, held], wanted, rtol=0, atol=1e-7)


def test_a_cut_groove_takes_its_mass_out() -> None:
    ring = replace(RING, r_inner=25.6 * MM, groove=9.2 * MM, groove_radius=6.1 * MM)
    R, half, a = 6.1 * MM, 4.6 * MM, 25.6 * MM
    d = math.sqrt(R**2 - half**2)
    # ∫π[(a + s)² − a²]dz, s = √(R² − z²) − d: the segment, and ∫s² dz
    segment = R**2 * math.asin(half / R) - half * d
    square = 2 * (R**2 * half - half**3 / 3) - 2 * d * (segment + 2 * half * d) + 2 * half * d**2
    cut = math.pi * (2 * a * segment + square)
    whole = math.pi * ((31 * MM) ** 2 - a**2) * 17 * MM
    # parabolas for arcs: fourth order, some 1e-5 of the cut
    assert ring.body.mass == pytest.approx(STEEL.density * (whole - cut), rel=1e-5)
    assert ring.depth == pytest.approx(R - d)
    # the rubber around it is a plain tube: the groove ends in the steel
    around = LAYER.r_outer**2 - LAYER.r_inner**2
    rubber = RUBBER.density * math.pi * around * LAYER.width
    assert replace(ring, layer=LAYER).body.mass == pytest.approx(
        STEEL.density * (whole - cut) + rubber, rel=1e-5
    )


@pytest.mark.parametrize("frequency", [300.0, 2e3, 5e3])
def test_the_reduced_ring_in_rubber_answers_as_the_whole_one(frequency: float) -> None:
    """Receptance on the raceway, the outside held, against the whole model order by order."""
    omega = 2 * np.pi * frequency
    ring = replace(CUSHIONED, bearing=None, order=4)
    element, body = ring.superelement(), ring.body
    D = element.stiffness(omega) - omega**2 * element.M
    inner = np.setdiff1d(np.arange(element.n), element.interfaces["outer"])
    raceway = element.raceways["raceway"]
    rows = raceway.rows[:, inner]
    reduced = rows @ np.linalg.solve(D[np.ix_(inner, inner)], rows.T.astype(complex))
    assert np.abs(D - D.T).max() < 1e-9 * np.abs(D).max()
    G = complex(RUBBER.complex_modulus(omega))
    for n in range(5):
        h = body._harmonic(n, (0, 2) if n == 0 else (0, 1, 2))
        K = h.stiffness([STEEL.K, RUBBER.K], [STEEL.G, G])
        at, _ = body._boundaries.held(h)
        free = np.setdiff1d(h.free, at)
        L = body._boundaries.averages(h)[:, free]
        A = (K - omega**2 * h.mass_matrix([STEEL.density, RUBBER.density]))[free][:, free]
        whole = L @ scipy.sparse.linalg.spsolve(A.tocsc(), L.T.astype(complex))
        for sine in (0, 1) if n else (0,):
            own = [raceway.series.index(axial, n, sine) for axial in (0, 1)]
            # the 1 %, in the norm of the outputs
            assert np.linalg.norm(reduced[np.ix_(own, own)] - whole) < 0.01 * np.linalg.norm(whole)
            others = np.setdiff1d(np.arange(len(raceway.series)), own)  # orders do not mix
            assert np.abs(reduced[np.ix_(own, others)]).max() < 1e-9 * np.abs(whole).max()


@pytest.mark.parametrize("G", [2e6, 3.7e6, 7e6])
def test_rubber_around_the_ring_keeps_its_stiffness_at_every_modulus(G: float) -> None:
    rubber = bd.Maxwell(G, [], [], K=2e9, density=1200.0)
    exact = FlexibleBearing(B6305, replace(CUSHIONED, layer=replace(LAYER, material=rubber)))
    element = replace(CUSHIONED, layer=replace(LAYER, moduli=(2e6, 7e6))).superelement()
    K = element.K + 2 * G * element.viscoelastic[0].H
    inner = np.setdiff1d(np.arange(element.n), element.interfaces["outer"])
    flexible = np.linalg.inv(K[np.ix_(inner, inner)])
    at_raceway = element.raceways["raceway"].rows[:, inner]
    S = np.linalg.inv(at_raceway @ flexible @ at_raceway.T)
    # shapes at 2 and 7 MPa, chosen to 2e-4 there and between (STILL): 2.6e-4 is the worst by this measure
    worst = np.linalg.eigvals(np.linalg.solve(exact.raceway_stiffness, S))
    assert np.abs(worst - 1).max() < 5e-4
