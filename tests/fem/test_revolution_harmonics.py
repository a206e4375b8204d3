"""Bodies of revolution: layers, rings, samples against formulas and the reference numbers of theory.md §3."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.linalg

from bearingdyn.fem import ALL_COMPONENTS, AXIAL, TORSION, Rectangle, assemble_harmonic, revolution_mesh
from bearingdyn.material import STEEL, Elastic, Maxwell
from bearingdyn.parts import Cylinder, EndFace, Layer, Region, Revolved, Ring, damping_sample

MM = 1e-3
KBULK, RHO = 2e9, 1200.0


def elastic(G: float, nu: float, density: float = RHO) -> Elastic:
    return Elastic(2 * G * (1 + nu), nu, density)


def rubber(G: complex) -> Maxwell:
    """G* = G at ω = 1 rad/s."""
    return Maxwell(G.real, [], [], eta0=G.imag, K=KBULK, density=RHO)


def test_torsion_of_a_smooth_field_converges_at_fourth_order() -> None:
    exact = 4 * math.pi / (1 - 1 / 4)
    errors = []
    for count in (2, 4, 8, 16):
        mesh = revolution_mesh([Rectangle((1.0, 2.0), (0.0, 1.0))], r_cuts=np.linspace(1, 2, count + 1))
        h = assemble_harmonic(mesh, 0, TORSION)
        K = h.stiffness([1.0], [1.0]).toarray()
        a, b = mesh.nodes_on((1, 1), (0, 1)), mesh.nodes_on((2, 2), (0, 1))
        u = np.zeros(h.n)
        u[a] = 1.0
        inner = np.setdiff1d(np.arange(h.n), np.concatenate([a, b]))
        u[inner] = -np.linalg.solve(K[np.ix_(inner, inner)], K[inner] @ u)
        errors.append(u @ K @ u / exact - 1)
    # Energy converges at twice the order of the strains, 2·2; 0.2: the coarsest are not yet asymptotic.
    assert np.log2(np.array(errors[1:-1]) / errors[2:]) == pytest.approx(4.0, abs=0.2)


@pytest.mark.parametrize("components", [AXIAL, TORSION, ALL_COMPONENTS])
def test_rigid_motion_costs_nothing_and_carries_the_inertia(components: tuple[int, ...]) -> None:
    mesh = revolution_mesh([Rectangle((0.0, 1.0), (0, 1)), Rectangle((1.0, 2.0), (0, 3), graded=True)])
    h = assemble_harmonic(mesh, 1 if components == ALL_COMPONENTS else 0, components)
    everywhere = np.arange(mesh.r.size)
    R = h.rigid_shapes(everywhere, 0.7)
    R[np.setdiff1d(np.arange(h.n), h.free)] = 0.0
    for bulk, shear in (([1.0, 1.0], [0.0, 0.0]), ([0.0, 0.0], [1.0, 1.0])):
        K = h.stiffness(bulk, shear)
        # 1e-12: round-off of a sum over 1e3 entries.
        assert np.abs(K @ R).max() <= 1e-12 * (abs(K) @ np.abs(R)).max()
        assert abs(K - K.T).max() <= 1e-14 * abs(K).max()
    mass = math.pi * (1 * 1 + 2.0 * 3 * 3)  # densities 1 and 2
    first = math.pi * (1 * 0.5 + 2.0 * 3 * 3 * 1.5) - 0.7 * mass
    polar = math.pi / 2 * (1 + 2.0 * 3 * (16 - 1))
    # 1e-13: Gauss's rule integrates these polynomials exactly.
    m = R.T @ (h.mass_matrix([1.0, 2.0]) @ R)
    if components == TORSION:
        assert m[0, 0] == pytest.approx(polar, rel=1e-13)
    else:
        assert m[0, 0] == pytest.approx(mass, rel=1e-13)
    if components == ALL_COMPONENTS:
        assert m[0, 1] == pytest.approx(first, rel=1e-12)
        along = math.pi * (1 / 3 + 2.0 * 3 * 9) - 2 * 0.7 * (first + 0.7 * mass) + 0.49 * mass
        assert m[1, 1] == pytest.approx(polar / 2 + along, rel=1e-12)


@pytest.mark.parametrize("bulk", [1.0, 1e4])
def test_patch_of_uniform_strain_is_in_equilibrium(bulk: float) -> None:
    mesh = revolution_mesh([Rectangle((0.5, 1.0), (0, 1)), Rectangle((1.0, 2.0), (0, 1), graded=True)])
    r, z = mesh.r, mesh.z
    edge = np.isin(r, [0.5, 2.0]) | np.isin(z, [0.0, 1.0])
    volume = math.pi * (4 - 0.25)
    # Uniform Cartesian strains of order n: (n, U, V, W, trace, e:e).
    zero = np.zeros_like(r)
    cases = [
        (0, r, zero, zero, 2.0, 2 - 4 / 3),  # ε_xx = ε_yy = 1
        (0, zero, zero, z, 1.0, 2 / 3),  # ε_zz = 1
        (1, z, -z, r, 0.0, 2.0),  # γ_xz = 2
        (2, r, -r, zero, 0.0, 2.0),  # ε_xx = −ε_yy = 1
    ]
    for n, U, V, W, trace, ee in cases:
        h = assemble_harmonic(mesh, n)
        K = h.stiffness([bulk, bulk], [1.0, 1.0])
        u = np.stack([U, V, W], axis=1).ravel()
        force = (K @ u).reshape(-1, 3)
        # 1e-11: round-off; the stresses of these fields are uniform and balance at every inner node.
        assert np.abs(force[~edge]).max() < 1e-11 * (abs(K) @ np.abs(u)).max()
        # At bulk 1e4 the energy of a shear is the rest of a cancellation of parts 2e7 times as large: it can
        # be known to half a unit in the last place of these.
        parts = np.abs(u) @ (abs(K) @ np.abs(u))
        assert abs(u @ (K @ u) - volume * (bulk * trace**2 + 2 * ee)) < 1e-16 * parts


def test_signs_follow_u_equals_t_plus_theta_cross_rho() -> None:
    # With the outer interface over the upper half only, the references are 2 mm apart and x couples with θy.
    half = Revolved(
        (Region((26 * MM, 28 * MM), (0.0, 8 * MM), rubber(1e6), graded=True),),
        {"inner": Cylinder(26 * MM), "outer": Cylinder(28 * MM)},
    )
    k0 = half.stiffness().real
    both = Revolved(
        half.regions,
        {"inner": Cylinder(26 * MM), "outer": Cylinder(28 * MM, (4 * MM, 8 * MM))},
        refinement=1.5,
    )
    K = both.stiffness().real
    scale = np.abs(K).max()
    rigid = np.zeros((12, 6))
    rigid[:6] = np.eye(6)
    rigid[6:] = np.eye(6)
    d = 2 * MM  # from the reference of "inner" at z = 4 mm to that of "outer" at 6 mm: t + θ × (0, 0, d)
    rigid[6, 4], rigid[7, 3] = d, -d
    assert np.abs(K @ rigid).max() < 1e-9 * scale  # round-off; a wrong sign leaves a force of the size of K d
    assert np.abs(k0 @ np.vstack([np.eye(6)] * 2)).max() < 1e-9 * np.abs(k0).max()
    assert abs(K[0, 4]) > 0.1 * K[0, 0] * d  # the body is not symmetric, so the test above sees the sign
    # Force on the held body: the same in both planes, (x, θy) as (y, −θx).
    np.testing.assert_allclose(
        K[np.ix_([1, 3], [7, 9])], K[np.ix_([0, 4], [6, 10])] * [[1, -1], [-1, 1]], rtol=1e-12
    )


def test_damping_sample_has_its_reference_modes() -> None:
    sample = damping_sample(elastic(1e6, 0.49))
    axial, torsion = sample.modes(0, 4).frequency[2:]
    tilt, radial = sample.modes(1, 4).frequency[2:]
    # theory.md §3.8; 5e-3 demanded, the printed digits reached: 1e-3.
    np.testing.assert_allclose([axial, torsion, tilt, radial], [839.6, 924.6, 973.1, 2371.8], rtol=1e-3)
    assert sample.modes(2, 1).frequency[0] == pytest.approx(5664, rel=1e-3)  # "next"
    rigid = np.concatenate([sample.modes(n, 2).frequency for n in (0, 1)])
    assert rigid.max() < 1.0  # Hz: round-off of a factorisation with a 40 Hz shift


def test_reduced_sample_keeps_its_modes() -> None:
    bulk = elastic(1e6, 0.49).K
    element = damping_sample(Maxwell(1e6, [], [], K=bulk, density=RHO)).superelement()
    K = element.K + 2e6 * element.viscoelastic[0].H
    frequency = np.sqrt(np.abs(scipy.linalg.eigvalsh(K, element.M))) / (2 * np.pi)
    assert np.all(frequency[:6] < 0.1)
    # 5e-3: bore and outside are rigid here, and inertia of the rubber is static: 0.3 % at the radial mode.
    expected = [839.6, 924.6, 973.1, 973.1, 2371.8, 2371.8]
    np.testing.assert_allclose(frequency[6:12], expected, rtol=5e-3)
    # Both are lower bounds of what a stiffer model gives; 1e-4: the printed digits.
    assert np.all(frequency[6:12] > np.array(expected) * (1 - 1e-4))


def test_free_steel_ring_has_its_reference_modes() -> None:
    ring = Ring(14 * MM, 17.5 * MM, 11 * MM)
    # theory.md §3.10; 2e-3 demanded; the reference digits are some 1e-3.
    np.testing.assert_allclose(ring.modes(2, 2).frequency, [8857, 14525], rtol=2e-3)
    np.testing.assert_allclose(ring.modes(3, 2).frequency, [24248, 37807], rtol=2e-3)
    modes = ring.modes(2, 1)
    h = assemble_harmonic(ring.body.mesh, 2)
    u = modes.shapes[0].ravel()
    assert u @ (h.mass_matrix([STEEL.density]) @ u) == pytest.approx(1.0, rel=1e-9)  # unit modal mass


def test_free_steel_shaft_bends_as_in_three_dimensions() -> None:
    shaft = Revolved((Region((0.0, 10 * MM), (-100 * MM, 100 * MM), STEEL),))
    # theory.md §3.10; 2e-3 on the default mesh: the third mode is 9e-4 high.
    np.testing.assert_allclose(shaft.modes(1, 5).frequency[2:], [2244.63, 5929.7, 11005], rtol=2e-3)
    torsion = math.sqrt(STEEL.G / STEEL.density) / (2 * 0.2)  # exact for a round bar
    assert shaft.modes(0, 3).frequency[2] == pytest.approx(torsion, rel=1e-4)


def test_fixed_interface_modes_and_damping_of_a_steel_body() -> None:
    body = Revolved(
        (Region((10 * MM, 12 * MM), (0.0, 60 * MM), STEEL),),
        {"foot": EndFace(0.0)},
        outputs={"tip": (12 * MM, 60 * MM, 0.5 * math.pi)},
        damping=0.01,
        f_max=40e3,
    )
    element = body.superelement()
    fixed = np.arange(6, element.n)
    frequency = np.sqrt(scipy.linalg.eigvalsh(element.K[6:, 6:], element.M[6:, 6:])) / (2 * np.pi)
    bending = body.modes(1, 2, fixed=["foot"]).frequency
    rest = body.modes(0, 4, fixed=["foot"]).frequency
    expected = np.sort(np.concatenate([bending, bending, rest]))
    expected = expected[expected <= 40e3]
    assert expected.size >= 4
    np.testing.assert_allclose(frequency[: expected.size], expected, rtol=1e-6)  # same model, other solver
    # Free modes of the reduced body have the damping ratio; rigid motion has none.
    lam, phi = scipy.linalg.eigh(element.K, element.M)
    c = np.diag(phi.T @ element.C @ phi)
    np.testing.assert_allclose(c[6:] / (2 * np.sqrt(lam[6:])), 0.01, rtol=1e-6)
    assert np.abs(c[:6]).max() < 1e-6 * c[6:].min()
    # Without deformation a point moves with the foot: u = t + θ × ρ.
    tip = element.outputs["tip"]
    np.testing.assert_allclose(tip[:, :6][:, [0, 1, 2]], np.eye(3), atol=1e-9)
    rho = np.array([0.0, 12 * MM, 60 * MM])
    np.testing.assert_allclose(tip[:, 3:6], np.cross(np.eye(3), rho).T, atol=1e-11)
    assert fixed.size == element.n - 6


def test_damping_of_the_metal_leaves_the_rubber_to_its_own_model() -> None:
    material = Maxwell(1e6, [], [], K=elastic(1e6, 0.49).K, density=RHO)
    element = damping_sample(material, damping=0.02, f_max=8e3).superelement()
    K = element.K + 2e6 * element.viscoelastic[0].H
    lam, phi = scipy.linalg.eigh(K, element.M)
    ratio = np.diag(phi.T @ element.C @ phi)[6:] / (2 * np.sqrt(lam[6:]))
    # The first six modes are all but rigid rings on rubber: of the metal's ζ they see a twentieth at most.
    assert np.abs(ratio[:6]).max() < 0.05 * 0.02
    assert ratio.max() < 0.02 * 1.001  # no mode has more than the metal gives
    assert np.linalg.eigvalsh(element.C).min() > -1e-9 * np.abs(element.C).max()


def test_output_point_takes_a_load_as_the_whole_body_does() -> None:
    # A force at the tip's rows has the moment ρ × f about the foot: rowsᵀ f on the foot's coordinates.
    body = Revolved(
        (Region((10 * MM, 12 * MM), (0.0, 60 * MM), STEEL),),
        {"foot": EndFace(0.0)},
        outputs={"side": (12 * MM, 45 * MM, 0.9)},
    )
    rows = body.superelement().outputs["side"]
    rho = np.array([12 * MM * math.cos(0.9), 12 * MM * math.sin(0.9), 45 * MM])
    force = np.array([3.0, -2.0, 5.0])
    np.testing.assert_allclose(
        rows[:, :6].T @ force, np.concatenate([force, np.cross(rho, force)]), rtol=1e-8
    )


def test_bad_input_is_named() -> None:
    ok = rubber(1e6)
    for arguments, name in (
        ((0.0, 0.02, 0.01), "r_inner"),
        ((math.nan, 0.02, 0.01), "r_inner"),
        ((0.02, 0.02, 0.01), "r_outer"),
        ((0.01, 0.02, -0.01), "width"),
        ((0.01, 0.02, math.nan), "width"),
    ):
        with pytest.raises(ValueError, match=name):
            Layer(*arguments, ok)
    with pytest.raises(ValueError, match="moduli"):
        Layer(0.01, 0.02, 0.01, ok, moduli=(0.0, 1e6))
    with pytest.raises(ValueError, match="refinement"):
        Layer(0.01, 0.02, 0.01, ok, refinement=math.nan)
    fluid = Maxwell(0.0, [1e6], [1e-3], K=KBULK, density=RHO)
    with pytest.raises(ValueError, match="G0"):
        Layer(0.026, 0.028, 0.016, fluid).stiffness(0.0)
    assert np.isfinite(Layer(0.026, 0.028, 0.016, fluid).stiffness(1.0)).all()
    block = Region((0.01, 0.02), (0.0, 0.01), STEEL)
    with pytest.raises(ValueError, match="overlap"):
        Revolved((block, Region((0.015, 0.03), (0.0, 0.01), STEEL)))
    with pytest.raises(ValueError, match="bore"):
        Revolved((block,), {"bore": Cylinder(0.005)})
    with pytest.raises(ValueError, match="bore"):
        Revolved((block,), {"bore": Cylinder(0.01, (0.0, 0.02))})
    with pytest.raises(ValueError, match="share"):
        Revolved((block,), {"bore": Cylinder(0.01), "end": EndFace(0.0)})
    with pytest.raises(ValueError, match="outside"):
        Revolved((block,), {"bore": Cylinder(0.01)}, outputs={"p": (0.03, 0.0, 0.0)})
    with pytest.raises(ValueError, match="interfaces"):
        Revolved((block,)).superelement()
    with pytest.raises(ValueError, match="modulus"):
        damping_sample(ok).modes(0, 2)
    with pytest.raises(ValueError, match="material"):
        Region((0.01, 0.02), (0.0, 0.01), "rubber")  # type: ignore[arg-type]
