"""Timoshenko shafts: free modes, gyroscopic rotors, and what a shaft refuses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from bearingdyn.cms import Superelement, basis_of
from bearingdyn.fem import Section, assemble_beam, rigid_body_inertia, rigid_transfer
from bearingdyn.fem.beam import element_matrices
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts import Disc, RigidBody, Shaft

RPM = math.pi / 30.0


def frequencies(K, M):
    return np.sqrt(np.abs(scipy.linalg.eigh(K, M, eigvals_only=True))) / (2.0 * math.pi)


def whirl(s: Superelement, K, speed):
    """Positive natural frequencies, rad/s, of M ẍ + Ω G ẋ + K x = 0, rising."""
    n = s.n
    A = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(s.M, K), -np.linalg.solve(s.M, speed * s.G)]]
    )
    omega = np.sort(np.linalg.eigvals(A).imag)
    return omega[omega > 1.0]


def sprung(s: Superelement, springs):
    K = s.K.copy()
    for name, index, k in springs:
        K[s.interfaces[name][index], s.interfaces[name][index]] += k
    return K


@pytest.mark.parametrize(
    ("mode", "exact_3d", "tolerance"),
    # theory.md 3.10: the Timoshenko beam is within .01 %; the mesh adds as much to the third
    [(0, 2244.63, 1e-4), (1, 5929.7, 1e-4), (2, 11005.0, 2e-4)],
)
def test_free_shaft_has_the_bending_modes_of_the_three_dimensional_bar(mode, exact_3d, tolerance):
    n = 100
    M, _, K = assemble_beam(np.linspace(0.0, 0.2, n + 1), [Section(0.2, 0.02)] * n, STEEL)
    bending = [i for i in range(6 * (n + 1)) if i % 6 in (0, 4)]
    f = frequencies(K.toarray()[np.ix_(bending, bending)], M.toarray()[np.ix_(bending, bending)])[2:]
    assert f[mode] == pytest.approx(exact_3d, rel=tolerance)


def test_free_shaft_stretch_and_torsion_converge_with_the_fourth_power_of_the_length():
    # a free bar: f = c / 2L, c the bar or the shear wave speed
    exact = {2: math.sqrt(STEEL.E / STEEL.density) / 0.4, 5: math.sqrt(STEEL.G / STEEL.density) / 0.4}
    for axis, f_exact in exact.items():
        error = []
        for n in (5, 10):
            M, _, K = assemble_beam(np.linspace(0.0, 0.2, n + 1), [Section(0.2, 0.02)] * n, STEEL)
            at = np.arange(axis, 6 * (n + 1), 6)
            f = frequencies(K.toarray()[np.ix_(at, at)], M.toarray()[np.ix_(at, at)])[1]
            error.append(abs(f / f_exact - 1.0))
        # (k h)⁴/480 of ω² leaves 3.3e-4 at 5 elements; the order is 4 up to the next term, hence the band
        assert error[0] < 4e-4
        assert 3.8 < math.log2(error[0] / error[1]) < 4.2


def test_cantilever_deflects_by_bending_and_shear():
    section, L, F = Section(0.3, 0.04, 0.02), 0.3, 1000.0
    _, _, K = assemble_beam(np.array([0.0, 0.1, 0.3]), [section] * 2, STEEL)
    tip = np.zeros(18)
    tip[12], tip[13], tip[14] = F, F, F
    u = np.zeros(18)
    u[6:] = np.linalg.solve(K.toarray()[6:, 6:], tip[6:])
    EI = STEEL.E * math.pi / 64 * (0.04**4 - 0.02**4)
    A = math.pi / 4 * (0.04**2 - 0.02**2)
    w = F * L**3 / (3 * EI) + F * L / (section.shear_coefficient(0.3) * STEEL.G * A)
    slope = F * L**2 / (2 * EI)
    # exact at the nodes: only round-off of a solve with condition 1e6 remains
    expected = [w, w, F * L / (STEEL.E * A), -slope, slope, 0.0]
    np.testing.assert_allclose(u[12:], expected, rtol=1e-9, atol=1e-20)


@pytest.mark.parametrize(
    ("d_inner", "expected"),
    # solid: 6(1+ν)²/(7+12ν+4ν²); vanishing wall: (1+ν)/(2+ν) (Hutchinson 2001), 1e-3 for the finite wall
    [(0.0, 6 * 1.3**2 / (7 + 12 * 0.3 + 4 * 0.09)), (0.9999 * 0.05, 1.3 / 2.3)],
)
def test_shear_coefficient_has_the_solid_and_the_thin_limit(d_inner, expected):
    assert Section(1.0, 0.05, d_inner).shear_coefficient(0.3) == pytest.approx(expected, rel=1e-3)


def test_element_carries_its_rigid_motions_mass_and_inertia():
    section, L = Section(0.05, 0.03, 0.01), 0.05
    M, G, K = element_matrices(section, L, STEEL)
    R = rigid_transfer([[0, 0, -L / 2], [0, 0, L / 2]])
    m = STEEL.density * section.area * L
    It = m * ((0.03**2 + 0.01**2) / 16 + L**2 / 12)
    Ip = m * (0.03**2 + 0.01**2) / 8
    J = rigid_body_inertia(M, R)
    # closed forms of a hollow cylinder: round-off only
    np.testing.assert_allclose(J, np.diag([m, m, m, It, It, Ip]), rtol=1e-12, atol=1e-12 * m)
    assert np.abs(K @ R).max() < 1e-12 * np.abs(K).max()
    expected = np.zeros((6, 6))
    expected[3, 4], expected[4, 3] = Ip, -Ip  # theory.md section 1: It θ̈x + Ip Ω θ̇y
    np.testing.assert_allclose(R.T @ G @ R, expected, rtol=0, atol=1e-12 * Ip)


FRISWELL = Elastic(211e9, 211e9 / (2 * 81.2e9) - 1.0, 7810.0)


def friswell_rotor(element_length, f_max=5e3):
    discs = [Disc.cylinder(0.5, 0.28, 0.07, 0.05, FRISWELL), Disc.cylinder(1.0, 0.35, 0.07, 0.05, FRISWELL)]
    return Shaft(
        [Section(1.5, 0.05)],
        seats={"left": 0.0, "right": 1.5},
        discs=discs,
        material=FRISWELL,
        f_max=f_max,
        element_length=element_length,
    )


@pytest.mark.parametrize("element_length", [0.25, None])
@pytest.mark.parametrize(
    ("rpm", "published"),
    # theory.md 3.11, Friswell et al. example 5.9.1, rad/s; two decimals, six elements: .1 % covers both
    [
        (0.0, [86.66, 86.66, 274.31, 274.31, 650.41, 716.78]),
        (4000.0, [85.39, 87.80, 251.78, 294.71, 600.18, 650.41]),
    ],
)
def test_two_disc_rotor_whirls_as_published(rpm, published, element_length):
    s = friswell_rotor(element_length).superelement()
    K = sprung(s, [(name, i, 1e6) for name in ("left", "right") for i in (0, 1)])
    np.testing.assert_allclose(whirl(s, K, rpm * RPM)[:6], published, rtol=1e-3)


def test_first_forward_whirl_of_the_rotor_is_the_faster():
    s = friswell_rotor(0.25).superelement()
    K = sprung(s, [(name, i, 1e6) for name in ("left", "right") for i in (0, 1)])
    n, speed = s.n, 4000.0 * RPM
    A = np.block(
        [[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(s.M, K), -np.linalg.solve(s.M, speed * s.G)]]
    )
    lam, v = np.linalg.eig(A)
    for omega, forward in ((85.39, False), (87.80, True)):
        mode = v[:, np.argmin(np.abs(lam - 1j * omega))]
        x, y = mode[s.interfaces["left"][:2]]
        # ẋ ahead of y by a quarter turn in the sense of +z: y = -i x, so Im(y/x) < 0
        assert (np.imag(y / x) < 0) == forward


@pytest.mark.parametrize("speed", [0.0, 300.0, 3000.0])
def test_rigid_rotor_on_springs_tilts_at_the_formula(speed):
    # theory.md 3.10: ω = [± Ip Ω + √(Ip² Ω² + 8 It k a²)] / 2 It
    It, Ip, k, a = 0.02, 0.03, 1e6, 0.1
    s = RigidBody(5.0, (It, It, Ip), rotating=True).superelement()
    K = np.zeros((6, 6))
    K[[0, 1, 2], [0, 1, 2]] = 2 * k, 2 * k, 1.0
    K[[3, 4], [3, 4]] = 2 * k * a**2
    root = math.sqrt((Ip * speed) ** 2 + 8 * It * k * a**2)
    found = whirl(s, K, speed)
    for sign in (-1, 1):
        omega = (sign * Ip * speed + root) / (2 * It)
        assert np.min(np.abs(found - omega)) < 1e-9 * omega  # closed form: round-off of the eigensolver


def test_reduced_rotor_keeps_mass_inertia_and_polar_moment():
    shaft = Shaft(
        [Section(0.1, 0.03), Section(0.2, 0.05, 0.02), Section(0.1, 0.03)],
        seats={"a": 0.05, "b": 0.35},
        points={"end": 0.4},
        discs=[Disc(0.2, 3.0, 0.01, 0.018)],
    )
    s = shaft.superelement()
    ref = [0.0, 0.0, 0.2]
    R = np.zeros((s.n, 6))
    R[:12] = rigid_transfer([[0, 0, 0.05], [0, 0, 0.35]], ref)
    ends = STEEL.density * math.pi / 4 * 0.03**2 * 0.1
    middle = STEEL.density * math.pi / 4 * (0.05**2 - 0.02**2) * 0.2
    m = 2 * ends + middle + 3.0
    Ip = 2 * ends * 0.03**2 / 8 + middle * (0.05**2 + 0.02**2) / 8 + 0.018
    It = 2 * ends * (0.03**2 / 16 + 0.1**2 / 12 + 0.15**2)
    It += middle * ((0.05**2 + 0.02**2) / 16 + 0.2**2 / 12) + 0.01
    J = R.T @ s.M @ R
    # rigid motions are in the basis exactly: only round-off of the static solve remains
    np.testing.assert_allclose(np.diag(J), [m, m, m, It, It, Ip], rtol=1e-8)
    assert (R.T @ s.G @ R)[3, 4] == pytest.approx(Ip, rel=1e-8)
    np.testing.assert_allclose(s.outputs["end"] @ R, rigid_transfer([[0, 0, 0.4]], ref), atol=1e-8)
    np.testing.assert_allclose(s.K @ R, 0.0, atol=1e-12 * np.abs(s.K).max())


def test_reduced_shaft_has_the_static_flexibility_of_the_beam():
    # a simply supported uniform shaft under a force at mid-span: F L³/48EI + F L/4kGA
    section = Section(0.4, 0.03)
    s = Shaft([section], seats={"a": 0.0, "b": 0.4}, points={"mid": 0.2}, f_max=200e3).superelement()
    hold = [0, 1, 2, 5, 6, 7]
    free = [i for i in range(s.n) if i not in hold]
    load = s.outputs["mid"][1][free]
    w = load @ np.linalg.solve(s.K[np.ix_(free, free)], load)
    EI, A = STEEL.E * math.pi / 64 * 0.03**4, math.pi / 4 * 0.03**2
    exact = 0.4**3 / (48 * EI) + 0.4 / (4 * section.shear_coefficient(0.3) * STEEL.G * A)
    # an inner point is not an interface: its shear kink is a sum over the kept modes, which leaves a few 1e-3
    assert w == pytest.approx(exact, rel=5e-3)


def test_shaft_between_two_seats_is_exact_in_statics():
    # a unit force at a free overhanging seat: cantilever about two supports, a (L + a) a² / 3EI and shear
    section, L, a = Section(0.4, 0.03), 0.3, 0.1
    s = Shaft([section], seats={"l": 0.0, "m": L, "end": L + a}, f_max=10e3).superelement()
    hold = [0, 1, 2, 5, 6, 7]
    free = [i for i in range(s.n) if i not in hold]
    w = np.linalg.inv(s.K[np.ix_(free, free)])[free.index(13), free.index(13)]
    EI, kGA = (
        STEEL.E * math.pi / 64 * 0.03**4,
        section.shear_coefficient(0.3) * STEEL.G * math.pi / 4 * 0.03**2,
    )
    exact = a**2 * (L + a) / (3 * EI) + a / kGA + a**2 / (L * kGA)
    assert w == pytest.approx(
        exact, rel=1e-7
    )  # constraint modes are static: round-off of an 80-element solve


def test_internal_damping_turns_with_the_shaft():
    # with internal damping alone a forward whirl at exactly the shaft's speed is neutrally stable: in the
    # rotating frame nothing moves (Friswell et al., section 7.3)
    s = Shaft([Section(0.4, 0.02)], seats={"a": 0.0, "b": 0.4}, damping=0.01, f_max=5e3).superelement()
    assert s.N is not None
    K = sprung(s, [(name, i, 1e7) for name in ("a", "b") for i in (0, 1)])
    n = s.n

    def decay(speed):
        A = np.block(
            [
                [np.zeros((n, n)), np.eye(n)],
                [-np.linalg.solve(s.M, K + speed * s.N), -np.linalg.solve(s.M, s.C + speed * s.G)],
            ]
        )
        lam = np.linalg.eigvals(A)
        lam = lam[lam.imag > 100.0]
        return lam[np.argsort(lam.imag)][:2]

    critical = decay(0.0)[0].imag
    for _ in range(20):
        critical = decay(critical)[1].imag
    below, above = decay(0.9 * critical), decay(1.1 * critical)
    assert abs(decay(critical)[1].real) < 1e-6 * critical  # zero but for round-off; ζω is 1e-2 of it
    assert np.all(below.real < 0)
    assert above[1].real > 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seats": {"a": 0.05, "b": 0.5}}, r"seats\['b'\] is at z = 0.5 m.*0 to 0.2 m"),
        ({"seats": {"a": math.nan}}, r"seats\['a'\]"),
        ({"seats": {}}, "seats is empty"),
        ({"seats": {"a": 0.1, "b": 0.1}}, "'a' and 'b' are both at"),
        ({"points": {"a": 0.1}}, "points has 'a', the name of a seat"),
        ({"points": {"end": 0.3}}, r"points\['end'\] is at z = 0.3"),
        ({"discs": [Disc(0.9, 1.0, 1.0, 1.0)]}, r"discs\[0\].z is at z = 0.9"),
        ({"sections": []}, "sections is empty"),
        ({"damping": -0.1}, "damping is -0.1"),
        ({"damping": math.nan}, "damping is nan"),
        ({"f_max": 0.0}, "f_max is 0.0"),
        ({"element_length": -1.0}, "element_length is -1.0"),
    ],
)
def test_shaft_refuses(change, message):
    given = {"sections": [Section(0.2, 0.02)], "seats": {"a": 0.05}} | change
    with pytest.raises(ValueError, match=message):
        Shaft(**given)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Section(-0.1, 0.02), "length is -0.1"),
        (lambda: Section(math.nan, 0.02), "length is nan"),
        (lambda: Section(0.1, math.inf), "d_outer is inf"),
        (lambda: Section(0.1, 0.02, 0.02), "d_inner is 0.02"),
        (lambda: Disc(0.1, -1.0, 1.0, 1.0), "mass is -1.0"),
        (lambda: Disc(0.1, 1.0, 1.0, 3.0), "Ip is 3.0"),
        (lambda: RigidBody(0.0, (1, 1, 1)), "mass is 0.0"),
        (lambda: RigidBody(1.0, (1, 1)), "three moments"),
        (lambda: RigidBody(1.0, (1, 1, 3)), "sum of the other two"),
        (lambda: RigidBody(1.0, (1, math.nan, 1)), r"inertia is \(1, nan, 1\)"),
        (lambda: RigidBody(1.0, (1, 2, 2), rotating=True), "Ix = Iy"),
        (lambda: RigidBody.ring(0.03, 0.02, 0.01), "r_inner is 0.03"),
        (lambda: RigidBody.ring(0.01, 0.02, -0.01), "width is -0.01"),
    ],
)
def test_section_disc_and_body_refuse(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_bearing_ring_as_a_rigid_body():
    s = RigidBody.ring(0.02, 0.03, 0.016, rotating=True).superelement()
    m = 7850 * math.pi * (0.03**2 - 0.02**2) * 0.016
    Ip, It = m * (0.03**2 + 0.02**2) / 2, m * ((0.03**2 + 0.02**2) / 4 + 0.016**2 / 12)
    np.testing.assert_allclose(np.diag(s.M), [m, m, m, It, It, Ip], rtol=1e-14)  # closed form
    assert s.G[3, 4] == pytest.approx(Ip, rel=1e-14)
    assert s.G[4, 3] == -s.G[3, 4]


def test_the_default_elements_keep_the_promised_error() -> None:
    """Against elements a fifth as long: below 1e-3 at f_max and 2e-4 at half of it, for a slender shaft."""
    shaft = Shaft([Section(0.25, 0.012)], seats={"a": 0.0}, f_max=15e3)
    fifth = 0.2 * float(np.diff(shaft.nodes()[0]).max())
    coarse, fine = (
        basis_of(s.full_model(), f_max=15e3, inertia=0).frequency
        for s in (shaft, replace(shaft, element_length=fifth))
    )
    assert fine.size == coarse.size > 8
    error = np.abs(coarse / fine - 1.0)
    assert error.max() < 1e-3
    assert error[fine < 7.5e3].max() < 2e-4
