"""Solid elements at finite strain: the linear ones at rest, closed forms, derivatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq, root

from bearingdyn.fem import SolidElements, SolidMesh, assemble_solid, balance, box_mesh
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import NEO_HOOKE, Hyperelastic, MooneyRivlin, NeoHooke, Yeoh

pytest.importorskip("skfem")

G, K = 1e6, 2e9
LAWS = (NeoHooke(), MooneyRivlin(0.35, 0.15), Yeoh(0.5, -0.05, 0.02))
# a brick cut into each kind
PIECES = {
    "tet10": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
    "wedge15": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
    "pyramid13": None,
}
KINDS = ("hex27", "hex20", *PIECES)


def cube(kind: str, n: int = 2) -> SolidMesh:
    """A unit cube whose inner nodes are out of place."""
    x = np.linspace(0.0, 1.0, n + 1)
    mesh = box_mesh(x, x, x, "hex27" if kind == "hex27" else "hex20")
    if kind in PIECES:
        points = mesh.points[: mesh.elements[:, :8].max() + 1]
        corners = mesh.elements[:, :8]
        if kind == "pyramid13":
            tip = len(points) + np.arange(len(corners))
            points = np.vstack([points, points[corners].mean(axis=1)])
            faces = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
            cut = np.vstack([np.column_stack([corners[:, list(f)], tip]) for f in faces])
        else:
            pieces = PIECES[kind]
            assert pieces is not None
            cut = np.vstack([corners[:, list(t)] for t in pieces])
        points, elements, _ = second_order(points, cut)
        mesh = SolidMesh(points, elements)
    p = mesh.points
    inside = np.prod(p * (1.0 - p), axis=1, keepdims=True) * 64.0
    return replace(mesh, points=p + 0.05 * inside * np.stack([p[:, 1], p[:, 2] - 0.5, 0.7 - p[:, 0]], axis=1))


def elements(
    mesh: SolidMesh, law: Hyperelastic = NEO_HOOKE, bulk: float = K, soft: bool = True
) -> SolidElements:
    return SolidElements(mesh=mesh, laws=[law], shear=[G], bulk=[bulk], incompressible=[soft])


def wavy(mesh: SolidMesh) -> np.ndarray:
    p = mesh.points
    return 0.03 * np.stack([np.sin(2 * p[:, 1]), p[:, 0] * p[:, 2], p[:, 2] ** 2], axis=1).ravel()


def nominal(law: Hyperelastic, stretches: np.ndarray) -> np.ndarray:
    """Principal nominal stresses of ½K(J − 1)² and the laws as their authors write them, over G = 1."""
    J = float(np.prod(stretches))
    bar2 = (stretches / J ** (1 / 3)) ** 2
    I1, I2 = float(bar2.sum()), float((1 / bar2).sum())
    W1, W2 = 0.5, 0.0
    if isinstance(law, MooneyRivlin):
        W1, W2 = law.C10, law.C01
    elif isinstance(law, Yeoh):
        W1 = law.C10 + 2 * law.C20 * (I1 - 3) + 3 * law.C30 * (I1 - 3) ** 2
    tau = 2 * W1 * (bar2 - I1 / 3) - 2 * W2 * (1 / bar2 - I2 / 3) + K / G * (J - 1) * J
    return np.asarray(tau / stretches)


@pytest.mark.parametrize("soft", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_at_rest_they_are_the_linear_elements(kind: str, soft: bool) -> None:
    mesh = cube(kind)
    state = elements(mesh, soft=soft).state(np.zeros(mesh.points.size))
    linear = assemble_solid(mesh, incompressible=soft)
    wanted = K * linear.volumetric + 2 * G * linear.deviatoric
    # 1e-9: asked for; both integrate at the same points
    assert abs(state.tangent() - wanted).max() < 1e-9 * abs(wanted).max()
    assert abs(state.deviatoric([0]) - linear.deviatoric).max() < 1e-9 * abs(linear.deviatoric).max()
    assert not state.force.any()


@pytest.mark.parametrize("soft", [True, False])
@pytest.mark.parametrize("kind", KINDS)
def test_force_is_the_derivative_of_the_energy_and_tangent_that_of_the_force(kind: str, soft: bool) -> None:
    mesh = cube(kind)
    body, u = elements(mesh, LAWS[1], 50 * G, soft), wavy(mesh)
    d, h = np.random.default_rng(1).uniform(-1, 1, u.size), 1e-5
    ends, state = [body.state(u + s * h * d) for s in (-1, 1)], body.state(u)
    # central differences of step 1e-5: 1e-10 of the third derivative, and round-off over the step, 1e-7
    slope = (ends[1].energy - ends[0].energy) / (2 * h)
    assert slope == pytest.approx(state.force @ d, abs=1e-6 * np.linalg.norm(state.force) * np.linalg.norm(d))
    slope = (ends[1].force - ends[0].force) / (2 * h)
    np.testing.assert_allclose(state.tangent() @ d, slope, atol=1e-6 * np.abs(slope).max())


@pytest.mark.parametrize("kind", KINDS)
def test_a_turned_solid_has_its_forces_turned(kind: str) -> None:
    """Also where a bubble follows: it keeps J, which no rotation changes."""
    mesh = cube(kind)
    body, u = elements(mesh), wavy(mesh)
    c, s = np.cos(0.7), np.sin(0.7)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    turned = ((mesh.points + u.reshape(-1, 3)) @ R.T - mesh.points).ravel()
    wanted = body.state(u).force.reshape(-1, 3) @ R.T
    # 1e-10: round-off of 1e-16 over strains of .03, times K/G
    np.testing.assert_allclose(
        body.state(turned).force.reshape(-1, 3), wanted, atol=1e-10 * np.abs(wanted).max()
    )


@pytest.mark.parametrize("kind", KINDS)
def test_patch_test(kind: str) -> None:
    """With its surface held in an affine motion the inside follows, whatever the mesh; and what it costs."""
    mesh = cube(kind)
    body = elements(mesh)
    F = np.array([[1.1, 0.15, 0.0], [0.0, 0.95, 0.05], [0.02, 0.0, 1.0]])
    F /= np.cbrt(np.linalg.det(F))  # no change of volume: the pressure would drown the rest
    outside = np.unique(mesh.boundary)
    at = (3 * outside[:, None] + np.arange(3)).ravel()
    wanted = mesh.points @ (F - np.eye(3)).T
    n = mesh.points.size
    found = balance(body.state, n, np.arange(n), at, wanted.ravel()[at])
    np.testing.assert_allclose(
        found.u.reshape(-1, 3), wanted, atol=1e-9
    )  # the search's 1e-11, over stiffness
    assert found.state.energy == pytest.approx(0.5 * G * (np.trace(F @ F.T) - 3.0), rel=1e-9)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("free", [1, 2])
def test_uniaxial_and_plane_strain_compression(law: Hyperelastic, free: int) -> None:
    """Two sides free, or one and the other held: force, and the axial tangent, to 1e-6."""

    def closed(lam: float) -> tuple[float, np.ndarray]:
        def sides(t: np.ndarray) -> np.ndarray:
            stretches = np.array([lam, t[0], t[1] if free == 2 else 1.0])
            return nominal(law, stretches)[1 : 1 + free] if free == 2 else nominal(law, stretches)[1:2]

        if free == 2:
            t = brentq(lambda x: float(sides(np.array([x, x]))[0]), 1.0, 1.4, xtol=1e-15)
            stretches = np.array([lam, t, t])
        else:
            t = root(lambda x: sides(np.array([x[0]])), [lam**-1.0], tol=1e-14).x[0]
            stretches = np.array([lam, t, 1.0])
        return float(nominal(law, stretches)[0]), stretches

    mesh = cube("hex27")
    body = elements(mesh, law)
    p = mesh.points

    def face(axis: int, place: float) -> np.ndarray:
        return 3 * np.flatnonzero(np.abs(p[:, axis] - place) < 1e-12) + axis

    still = [face(0, 0.0), face(1, 0.0), face(2, 0.0)] + ([face(2, 1.0)] if free == 1 else [])
    pressed = face(0, 1.0)
    at = np.concatenate([*still, pressed])

    def force(depth: float) -> float:
        travel = np.concatenate([np.zeros(at.size - pressed.size), np.full(pressed.size, -depth)])
        n = p.size
        return float(balance(body.state, n, np.arange(n), at, travel).state.force[pressed].sum())

    assert force(0.2) == pytest.approx(closed(0.8)[0] * G, rel=1e-6)  # asked for; the state is homogeneous
    h = 1e-4
    slope = (force(0.2 - h) - force(0.2 + h)) / (2 * h)
    wanted = (closed(0.8 + h)[0] - closed(0.8 - h)[0]) * G / (2 * h)
    assert slope == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("law", LAWS)
def test_equibiaxial_compression(law: Hyperelastic) -> None:
    mesh = cube("hex27")
    body, p, lam = elements(mesh, law), mesh.points, 0.9
    t = brentq(lambda x: nominal(law, np.array([lam, lam, x]))[2], 1.0, 1.4, xtol=1e-15)
    held, travel = [], []
    for axis, place in ((0, 0.0), (1, 0.0), (2, 0.0), (0, 1.0), (1, 1.0)):
        nodes = np.flatnonzero(np.abs(p[:, axis] - place) < 1e-12)
        held.append(3 * nodes + axis)
        travel.append(np.full(nodes.size, -0.1 * place))
    n = p.size
    found = balance(body.state, n, np.arange(n), np.concatenate(held), np.concatenate(travel))
    force = found.state.force[held[3]].sum()
    assert force == pytest.approx(nominal(law, np.array([lam, lam, t]))[0] * G, rel=1e-6)
    assert found.u.reshape(-1, 3)[:, 2].max() == pytest.approx(t - 1.0, rel=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_incremental_shear_of_a_stretched_cube(kind: str) -> None:
    """Second variation for a further simple shear l = e_i ⊗ e_j: neo-Hooke's is G J^(−2/3) λ_j²."""
    mesh = cube(kind)
    stretches = np.array([1.2, 0.9, 0.0])
    stretches[2] = 1.0 / np.prod(stretches[:2])
    u = (mesh.points * (stretches - 1.0)).ravel()
    state = elements(mesh).state(u)
    K_t, H = state.tangent(), state.deviatoric([0])
    now = mesh.points * stretches
    for i, j in ((0, 1), (1, 0), (2, 0), (1, 2)):
        d = np.zeros_like(now)
        d[:, i] = now[:, j]
        d = d.ravel()
        assert d @ (K_t @ d) == pytest.approx(G * stretches[j] ** 2, rel=1e-6)
        assert 2.0 * (d @ (H @ d)) == pytest.approx(1.0, rel=1e-6)  # 2 dev d : dev d of a unit shear


def test_a_hinged_brick_is_not_stable_where_its_law_is_not() -> None:
    mesh = cube("hex27", 1)
    u = (mesh.points * (np.array([1.8, 1.8**-0.5, 1.8**-0.5]) - 1.0)).ravel()
    least = [float(d.stability.min()) for _, d in elements(mesh, Yeoh(0.5, -0.1)).state(u).elements]
    assert min(least) < 0.0
    least = [float(d.stability.min()) for _, d in elements(mesh).state(u).elements]
    assert min(least) > 0.0
