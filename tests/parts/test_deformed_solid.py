"""Solids deformed between rigid plates, and small motion about that state."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import bearingdyn as bd
from bearingdyn.analysis import strained_rubber
from bearingdyn.fem import SolidMesh, box_mesh, rigid_transfer, ring_mesh
from bearingdyn.fem.meshes.solid_mesh import second_order
from bearingdyn.material import STEEL, Elastic, Maxwell
from bearingdyn.notice import StrainedLayer
from bearingdyn.parts import Layer, RigidSurface, Solid, Squeezed

pytest.importorskip("skfem")

MM = 1e-3
G, K = 1e6, 2e9
RUBBER = Elastic(9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G), 1100.0)
MAXWELL = Maxwell(G, [2e6, 1e6], [1e-4, 1e-3], K=K, density=1100.0)
AXES = {"inner": RigidSurface("inner", "axis"), "outer": RigidSurface("outer", "axis")}
A, T, W = 40 * MM, 10 * MM, 30 * MM  # a pad, its height along y


def crowded(length: float, n: int) -> np.ndarray:
    return np.asarray(length * 0.5 * (1 - np.cos(np.pi * np.arange(n + 1) / n)))


def pad(material: object = RUBBER, n: int = 4, **options: object) -> Solid:
    mesh = box_mesh(crowded(A, n), crowded(T, 2), crowded(W, n - 1), "hex27")
    return Solid(mesh, material, {"foot": "y-", "plate": "y+"}, **options)  # type: ignore[arg-type]


def rigid_residual(found: Squeezed) -> float:
    """Of rigid motion of all plates: forces turn with them, θ × F and ½ θ × M, and nothing else comes.

    Over the stiffness of the plates in each direction.
    """
    k = found.stiffness().real
    plates = found.part.prestress.plates  # type: ignore[attr-defined]
    R = rigid_transfer([p.reference for p in plates.values()])
    turned = np.zeros_like(R)
    for i, name in enumerate(plates):
        F, M = np.array(found.forces[name]).reshape(2, 3)
        for a, axis in enumerate(np.eye(3)):
            turned[6 * i : 6 * i + 3, 3 + a] = np.cross(axis, F)
            turned[6 * i + 3 : 6 * i + 6, 3 + a] = 0.5 * np.cross(axis, M)
    own = np.diag(k)
    return float(np.abs((k @ R - turned) / np.sqrt(np.outer(own, np.diag(R.T @ np.diag(own) @ R)))).max())


@pytest.mark.parametrize("move", [0.0, (0.0, 0.0, 0.0), (0.0,) * 6])
def test_undeformed_it_is_the_linear_solid(move: object) -> None:
    block = pad(MAXWELL, f_max=500.0)
    still = block.assembled({"plate": move})  # type: ignore[dict-item]
    for omega in (0.0, 1e3, 1e5):
        a, b = block.stiffness(omega), still.stiffness(omega)
        np.testing.assert_allclose(b, a, atol=1e-9 * np.abs(a).max())  # asked for
    a, b = block.superelement(), still.superelement()
    assert a.n == b.n
    np.testing.assert_allclose(b.M[:12, :12], a.M[:12, :12], atol=1e-9 * np.abs(a.M).max())
    for omega in (0.0, 3e3):  # what the plates feel, whichever signs the inner shapes have
        x, y = (
            np.linalg.inv(e.stiffness(omega) - omega**2 * e.M + 1e6 * np.eye(e.n))[:12, :12] for e in (a, b)
        )
        np.testing.assert_allclose(y, x, atol=1e-9 * np.abs(x).max())


@pytest.mark.parametrize(
    "move", [0.5 * MM, (2 * MM, -0.5 * MM, 1 * MM), (1 * MM, -0.5 * MM, 0.0, 0.05, 0.2, 0.03)]
)
def test_rigid_motion_turns_the_loads_and_costs_nothing_else(move: object) -> None:
    assert rigid_residual(pad().assembled({"plate": move})) < 1e-7  # type: ignore[dict-item]  # asked for


def test_tangent_is_the_derivative_of_force_and_moment() -> None:
    """About a pad that is pressed, sheared and turned, each of six further motions of its plate."""
    block, base = pad(n=3), np.array([0.5 * MM, -0.4 * MM, 0.3 * MM, 0.02, 0.05, 0.03])
    here = block.assembled({"plate": tuple(base)})
    wanted = here.stiffness().real[6:, 6:]
    M = np.array(here.forces["plate"])[3:]
    # a moment in the fixed frame: the symmetric tangent by the rotation vector, and half the turned moment
    wanted[3:, 3:] -= 0.5 * np.array([[0, -M[2], M[1]], [M[2], 0, -M[0]], [-M[1], M[0], 0]])

    def forces(step: np.ndarray) -> np.ndarray:
        turn = (Rotation.from_rotvec(step[3:]) * Rotation.from_rotvec(base[3:])).as_rotvec()
        return np.array(block.assembled({"plate": (*(base + step)[:3], *turn)}).forces["plate"])

    scale = np.sqrt(np.diag(wanted))
    for j in range(6):
        step = np.zeros(6)
        step[j] = 1 * MM * MM if j < 3 else 1e-4
        slope = (forces(step) - forces(-step)) / (2 * step[j])
        # 1e-6: third derivatives over a step of 1e-4 of the height
        np.testing.assert_allclose(slope / scale, wanted[:, j] / scale, atol=1e-6 * scale[j])


def test_work_of_the_plate_is_the_energy_stored() -> None:
    block, h = pad(n=3), 1e-3 * MM
    ends = [block.assembled({"plate": 0.5 * MM + s * h}).energy for s in (-1, 1)]
    assert (ends[1] - ends[0]) / (2 * h) == pytest.approx(
        block.assembled({"plate": 0.5 * MM}).force, rel=1e-6
    )


@pytest.mark.parametrize("law", [bd.NeoHooke(), bd.Yeoh(0.5, -0.05, 0.02)])
def test_frictionless_pad_is_in_uniaxial_compression(law: bd.NeoHooke | bd.Yeoh) -> None:
    """Force, bulge and stretch; nothing but friction would hold it sideways, and it does not slide away."""
    lam = 0.9

    def nominal(side: float) -> tuple[float, float]:
        J = lam * side**2
        bar = np.array([lam, side]) ** 2 * J ** (-2 / 3)
        W1 = float(law.derivatives(bar[0] + 2 * bar[1], 0.0)[1])
        tau = 2 * G * W1 * (bar - (bar[0] + 2 * bar[1]) / 3) + K * (J - 1) * J
        return float(tau[0] / lam), float(tau[1] / side)

    side = brentq(lambda s: nominal(s)[1], 1.0, 1.2, xtol=1e-15)
    found = pad().assembled({"plate": 0.1 * T}, slip=("foot", "plate"), law=law)
    assert found.force == pytest.approx(-nominal(side)[0] * A * W, rel=1e-6)  # asked for
    assert found.stretch == pytest.approx(side, rel=1e-9)
    assert found.widths["plate"] == pytest.approx(A * W * side**2, rel=1e-9)
    assert found.pressure == pytest.approx(-nominal(side)[0] / side**2, rel=1e-6)
    assert found.lost["plate"] == 0.0
    assert rigid_residual(found) < 1e-7


@pytest.mark.slow
def test_ring_of_bricks_is_squeezed_as_the_body_of_revolution() -> None:
    """R2 of rubber.md at 5 %: force and five stiffnesses."""
    layer = Layer(20 * MM, 24 * MM, 12 * MM, RUBBER, recess=1.2 * MM)
    plain = ring_mesh((20 * MM, 24 * MM), 12 * MM, across=4, along=6, around=16)
    p = plain.points.copy()
    across = (2 * np.hypot(p[:, 0], p[:, 1]) - 44 * MM) / (4 * MM)
    z = p[:, 2] - p[:, 2].mean()
    z = np.sign(z) * 6 * MM * (1 - (1 - np.abs(z) / (6 * MM)) ** 1.7)  # crowded to the ends
    p[:, 2] = z * (1 - 0.2 * (1 - across**2))
    ring = Solid(replace(plain, points=p), RUBBER, AXES, 0.0)
    found, wanted = ring.assembled({"outer": 0.2 * MM}), layer.assembled(squeeze=0.05, compare=False)
    ratio = np.diag(found.stiffness().real)[6:] / np.diag(wanted.stiffness().real)[6:]
    print("ring of bricks over revolution, squeezed by 5 %:", ratio, found.force / wanted.force)
    # 4×6×16 bricks are .1 % off without squeeze, and .5 % under it, where the ends are strained most
    np.testing.assert_allclose(ratio, 1.0, atol=6e-3)
    assert found.force == pytest.approx(wanted.force, rel=5e-3)
    assert found.bulge == pytest.approx(wanted.bulge, rel=5e-3)
    assert found.pressure == pytest.approx(wanted.pressure, rel=5e-3)
    assert rigid_residual(found) < 1e-7
    assert found.part.prestress.self_balanced  # type: ignore[attr-defined]


def test_bonded_pads_have_the_published_stiffness() -> None:
    """Gent & Lindley 1959: E(1 + 2S²) A/t, the shape factor S the loaded over the free area; square pads.

    Their sum of two energies is no exact solution, and is taken to 15 %. A thin square pad has
    6.73 G S² A/t (Kelly, Earthquake-Resistant Design with Rubber, 1997), to terms of the order 1/S².
    """
    stiff = Elastic(3e6 * (1 - 1e-6 / 6), 0.5 - 1e-6 / 2, 1100.0)  # K/G = 1e6: incompressible at these S
    for S in (0.5, 1.0, 2.0, 8.0):
        t = A / 4 / S
        mesh = box_mesh(crowded(A, 6), crowded(t, 3), crowded(A, 6), "hex27")
        k = Solid(mesh, stiff, {"foot": "y-", "plate": "y+"}, 0.0).stiffness()[7, 7].real * t / A**2 / G
        print(f"square pad of S = {S:g}: {k / (3 * (1 + 2 * S**2)):.3f} of Gent–Lindley")
        if S <= 2.0:
            assert k == pytest.approx(3 * (1 + 2 * S**2), rel=0.15)
        else:
            assert k == pytest.approx(6.73 * S**2, rel=0.03)


def test_pressed_pad_stiffens_as_published() -> None:
    """Gent–Lindley at finite strain: force E_c A (λ⁻² − λ)/3, E_c that of a small one, for a cubic pad."""
    t = 20 * MM
    mesh = box_mesh(crowded(A, 6), crowded(t, 4), crowded(A, 6), "hex27")
    block = Solid(mesh, RUBBER, {"foot": "y-", "plate": "y+"}, 0.0)
    small = block.stiffness()[7, 7].real
    for e in (0.05, 0.10):
        lam = 1 - e
        ratio = block.assembled({"plate": e * t}).force / (small * e * t)
        print(f"pad of S = .5 pressed by {e:.0%}: {ratio:.4f}, Gent–Lindley {(lam**-2 - lam) / 3 / e:.4f}")
        assert ratio == pytest.approx((lam**-2 - lam) / 3 / e, rel=0.02)  # a formula for engineers


@pytest.mark.slow
def test_tetrahedra_and_wedges_do_not_lock_at_finite_strain() -> None:
    """A thin bonded pad, pressed by 1.5 % and sheared by 10 %: each kind against 27-node bricks."""
    pieces = {
        "tet": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
        "wedge": [(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
    }
    lines = crowded(20 * MM, 8), crowded(2 * MM, 4), crowded(20 * MM, 8)
    faces = {"foot": "y-", "plate": "y+"}
    move = (0.2 * MM, -0.03 * MM, 0.0)
    fine = Solid(box_mesh(*lines, "hex27"), RUBBER, faces, 0.0)
    wanted, linear = fine.assembled({"plate": move}), fine.stiffness()[7, 7].real
    box = box_mesh(*lines)
    for name, cut in pieces.items():
        corners = np.vstack([box.elements[:, list(t)] for t in cut])
        points, elements, _ = second_order(box.points[: corners.max() + 1], corners)
        ends = {
            f"y{s}": np.flatnonzero(np.abs(points[:, 1] - y) < 1e-9) for s, y in (("-", 0), ("+", 2 * MM))
        }
        part = Solid(SolidMesh(points, elements, surfaces=ends), RUBBER, faces, 0.0)
        own = part.stiffness()[7, 7].real / linear
        found = part.assembled({"plate": move})
        got = -found.forces["plate"][1] / -wanted.forces["plate"][1]
        k = found.stiffness()[7, 7].real / wanted.stiffness()[7, 7].real
        print(f"{name}: linear {own:.4f}, force {got:.4f}, tangent {k:.4f} of bricks")
        # what they are off without deformation, and little more: locked they would be 20 % too stiff
        assert abs(got - own) < 0.01
        assert abs(k - own) < 0.01


def test_steel_in_the_rubber_stays_as_it_is() -> None:
    """A steel plate in the middle halves the height that can bulge; under load it turns with the rubber."""
    mesh = box_mesh(crowded(A, 4), [0, 2.5 * MM, 4.5 * MM, 5.5 * MM, 7.5 * MM, T], crowded(W, 3), "hex27")
    mesh = mesh.with_region("plate", lambda p: np.abs(p[:, 1] - 5 * MM) < 0.4 * MM)
    block = Solid(mesh, {"body": RUBBER, "plate": STEEL}, {"foot": "y-", "plate": "y+"}, 0.0, damping=0.01)
    found = block.assembled({"plate": (1 * MM, -0.1 * MM, 0.0)})
    assert rigid_residual(found) < 1e-7
    u = found.part.prestress.state.u  # type: ignore[attr-defined]
    steel = np.unique(mesh.elements[mesh.regions["plate"]])
    middle = u[steel].mean(axis=0)
    np.testing.assert_allclose(middle, (0.5 * MM, -0.05 * MM, 0.0), atol=1e-6)  # by symmetry
    blocks = found.part.prestress.state.elements  # type: ignore[attr-defined]
    own = [d.stretches for nodes, d in blocks if np.isin(nodes, steel).all()]
    assert len(own) == 1
    assert np.abs(own[0] - 1).max() < 1e-3  # MPa over 200 GPa, bent over forty times its thickness
    assert found.superelement().n >= 12


def test_only_the_change_of_shape_follows_the_frequency() -> None:
    """K*(ω) − K(0) = 2(G* − G0) H, H the same at all frequencies; Im K >= 0; "separable" differs a little."""
    found = pad(MAXWELL).assembled({"plate": 0.5 * MM})
    model = found.part.full_model()  # type: ignore[attr-defined]
    held = np.concatenate([f.dofs for f in model.interfaces.values()])
    assert len(model.viscoelastic) == 1
    assert abs(model.viscoelastic[0].H).sum() > 0
    assert held.size
    moving = found.stiffness(1e3)
    lowest = np.linalg.eigvalsh(moving.imag)
    assert lowest[0] > -1e-9 * lowest[-1]
    whole = found.stiffness().real[7, 7] * abs(MAXWELL.complex_modulus(1e3)) / G
    other = pad(MAXWELL).assembled({"plate": 0.5 * MM}, branches="separable").stiffness(1e3)
    assert 0.0 < 1 - abs(moving[7, 7]) / whole < 0.2  # scaling the whole tangent would be too much here
    assert 1e-4 < abs(other[7, 7] / moving[7, 7] - 1) < 0.05
    element = found.superelement()
    s = element.stiffness(0.0)
    condensed = s[:12, :12] - s[:12, 12:] @ np.linalg.solve(s[12:, 12:], s[12:, :12])
    exact = found.stiffness()
    np.testing.assert_allclose(condensed, exact, atol=1e-8 * np.abs(exact).max())


def test_it_takes_the_place_of_the_solid_in_an_application() -> None:
    block = pad(MAXWELL, f_max=500.0, outputs={"middle": (0.5 * A, 0.5 * T, W)})
    found = block.assembled({"plate": (3 * MM, -0.5 * MM, 0.0)})
    place = np.array(found.part.outputs["middle"])  # type: ignore[attr-defined]
    assert 1 * MM < place[0] - 0.5 * A < 2 * MM  # it went along with half of the shear
    frequency = []
    for part in (block, found):
        app = bd.Application()
        app.add("pad", part)
        app.add("mass", bd.RigidBody(2.0, (1e-3, 1e-3, 1e-3)))
        app.connect("mass.centre", "pad.plate")
        app.ground("pad.foot")
        frequency.append(float(bd.modes(app).frequency.values[-1]))
        app.load("mass.centre", (0.0, -1.0, 0.0, 0.0, 0.0, 0.0))
        sag = bd.equilibrium(app).displacement("pad.plate")[1]
        k = part.stiffness().real[6:, 6:]
        assert sag == pytest.approx(-np.linalg.inv(k)[1, 1], rel=1e-6)
        app.draw()
    assert frequency[1] != pytest.approx(frequency[0], rel=1e-3)


def test_an_equilibrium_tells_of_a_solid_strained_beyond_its_linear_stiffness(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    block = pad(MAXWELL, f_max=500.0)
    k = block.stiffness().real[6:, 6:]

    def state(depth: float) -> None:
        app = bd.Application()
        app.add("pad", block)
        app.free("pad.plate")
        app.ground("pad.foot")
        app.load("pad.plate", (0.0, -depth / np.linalg.inv(k)[1, 1], 0.0, 0.0, 0.0, 0.0))
        bd.equilibrium(app)

    with pytest.warns(StrainedLayer, match=r"solid 'pad' is strained by .* it pushes back by \+") as caught:
        state(0.3 * MM)
    found = block.assembled({"plate": 0.3 * MM})
    stiffer = found.force / (k[1, 1] * 0.3 * MM) - 1
    assert f"{stiffer:+.1%}" in str(caught[0].message)
    with warnings.catch_warnings():
        warnings.simplefilter("error", StrainedLayer)
        state(0.01 * MM)
    with pytest.warns(StrainedLayer, match="finds no balance beyond"):
        state(0.6 * T)
    monkeypatch.setattr(strained_rubber, "LARGE", 0)  # too many coordinates to be solved for a warning
    with pytest.warns(StrainedLayer, match="may be wrong by several times that"):
        state(0.3 * MM)


def test_deformations_that_cannot_be_are_named() -> None:
    block = pad()
    for bad, text in (
        ({"press": {}}, "press is"),
        ({"press": {"top": 1e-4}}, r"press is 'top'"),
        ({"press": {"plate": float("nan")}}, r"press\['plate'\]"),
        ({"press": {"plate": (1e-4, 0.0)}}, r"press\['plate'\].*it must be \(3,\)"),
        ({"press": {"plate": "deep"}}, r"press\['plate'\]"),
        ({"press": {"plate": None}}, r"press\['plate'\]"),
        ({"press": [1e-4]}, "press is"),
        ({"press": {"plate": 1e-4}, "slip": ("side",)}, "slip is 'side'"),
        ({"press": {"plate": (0.0, -1e-4, 0.0)}, "slip": ("plate",)}, "a depth of 0 or more"),
        ({"press": {"plate": -1e-4}, "slip": ("plate",)}, "a depth of 0 or more"),
        ({"press": {"plate": 1e-4}, "slip": "plate"}, "slip is 'plate'; give a list of interfaces"),
        ({"press": {"plate": 0.5}}, r"press\['plate'\] is 0\.5; the body is 0\.04 m large; is it in mm"),
        (
            {"press": {"plate": 0.05}},
            r"press\['plate'\] is 0\.05; the body is 0\.01 m deep there; is it in mm",
        ),
        ({"press": {"plate": (0, 0, 0, 0, 30.0, 0)}}, r"it turns by 30 rad; is it in degrees"),
        ({"press": {"plate": 1e-4}, "law": "rubber"}, "law is 'rubber'"),
        ({"press": {"plate": 1e-4}, "law": bd.NeoHooke}, "law is <class"),
        ({"press": {"plate": 1e-4}, "branches": "both"}, "branches is 'both'"),
        ({"press": {"plate": 1e-4}, "after": -1.0}, "after"),
        ({"press": {"plate": 0.9 * T}}, r"press is .* \d+% of it is reached: .*(fold|inside out)"),
        ({"press": {"plate": (0.0, 5 * T, 0.0)}, "law": bd.Yeoh(0.5, -0.05)}, "law is not stable"),
    ):
        with pytest.raises(ValueError, match=text):
            (pad(MAXWELL) if "after" in bad else block).assembled(**bad)  # type: ignore[arg-type]
    found = block.assembled({"plate": 0.1 * MM})
    with pytest.raises(ValueError, match="deform the solid once"):
        found.part.assembled({"plate": 0.1 * MM})  # type: ignore[attr-defined]
    ring = Solid(ring_mesh((20 * MM, 24 * MM), 12 * MM, across=1, along=2, around=8), RUBBER, AXES, 0.0)
    with pytest.raises(ValueError, match=r"slip is 'outer'; a plate that slips must be plane"):
        ring.assembled({"outer": 0.1 * MM}, slip=("outer",))
    soft = Maxwell(0.0, [1e6], [1e-3], K=K, density=1100.0)
    with pytest.raises(ValueError, match="no stiffness"):
        pad(soft).assembled({"plate": 0.1 * MM})


def test_the_deformed_solid_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    found = pad().assembled({"plate": 0.5 * MM})
    ax = bd.plot.squeezed_solid(found)
    assert f"{found.force:.4g} N" in ax.get_title(loc="left")
    for other in (pad(), Layer(20 * MM, 24 * MM, 12 * MM, RUBBER)):
        with pytest.raises(ValueError, match="squeezed is"):
            bd.plot.squeezed_solid(other)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="squeezed is"):
        bd.plot.squeezed_section(found)
    matplotlib.pyplot.close("all")


def test_turned_pad_twists_back_at_its_closed_form() -> None:
    """Torsion of a thin square pad, G/t ∫r² dA = G a⁴/6t: also about a pad that is turned by .1 rad."""
    t = 1 * MM
    mesh = box_mesh(crowded(A, 6), np.linspace(0, t, 3), crowded(A, 6), "hex27")
    thin = Solid(mesh, RUBBER, {"foot": "y-", "plate": "y+"}, 0.0)
    turned = thin.assembled({"plate": (0.0, 0.0, 0.0, 0.0, 0.005, 0.0)})
    # free edges: of the order of t/a = 1/40
    assert turned.forces["plate"][4] == pytest.approx(G * A**4 / 6 / t * 0.005, rel=0.03)
    assert math.isclose(turned.stiffness()[10, 10].real, thin.stiffness()[10, 10].real, rel_tol=0.03)
