"""Squeezed layers, pads and O-rings against rubber.md §2 and exact statements."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.material import Elastic, Maxwell
from bearingdyn.notice import BeyondData, MeshDependent, StrainedLayer
from bearingdyn.parts import Layer, Squeezed
from bearingdyn.parts.squeezed import compare_meshes

MM = 1e-3
G, K = 1e6, 2e9
RUBBER = Elastic(9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G), 1100.0)

# rubber.md §2, μ = 1: (case, squeeze): force N, axial, radial N/mm, torsion, tilt N mm/rad
TABLE = {
    ("flat", 0.0): (0.0, 381.80, 2748.1, 197406, 109575),
    ("R2", 0.0): (0.0, 346.59, 2352.6, 166204, 94763),
    ("R2", 0.02): (445.42, 343.97, 2645.0, 165670, 95858),
    ("R2", 0.05): (1225.1, 337.13, 3134.3, 164870, 97422),
    ("R3", 0.05): (395.63, 377.03, 3253.2, 195771, 112917),
    ("R3", 0.10): (865.84, 371.36, 3897.3, 194140, 118209),
}


def layer(recess: float = 0.0, material: object = RUBBER, refinement: float = 1.0) -> Layer:
    return Layer(20 * MM, 24 * MM, 12 * MM, material, recess=recess, refinement=refinement)  # type: ignore[arg-type]


def squeezed(case: str, squeeze: float, material: object = RUBBER, **options: object) -> Squeezed:
    how = "slip" if case == "R3" else "bonded"
    ring = layer(1.2 * MM if case == "R2" else 0.0, material)
    return ring.assembled(squeeze=squeeze, inside=how, outside=how, **options)  # type: ignore[arg-type]


def maxwell(relaxed: float = G) -> Maxwell:
    return Maxwell(relaxed, [2e6, 1e6], [1e-4, 1e-3], K=K, density=1100.0)


@pytest.mark.parametrize(("case", "squeeze"), TABLE)
def test_reference_table(case: str, squeeze: float) -> None:
    found = squeezed(case, squeeze)
    k = np.diag(found.stiffness().real)[6:]
    force, axial, radial, torsion, tilt = TABLE[case, squeeze]
    # 5e-3: asked for; the default mesh reaches 2e-4
    np.testing.assert_allclose(k[[0, 1]], radial * 1e3, rtol=5e-4)
    np.testing.assert_allclose(k[2], axial * 1e3, rtol=5e-4)
    np.testing.assert_allclose(k[[3, 4]], tilt / 1e3, rtol=5e-4)
    np.testing.assert_allclose(k[5], torsion / 1e3, rtol=5e-4)
    assert found.force == pytest.approx(force, rel=5e-4, abs=1e-6)


def test_separable_branches_and_a_complex_modulus() -> None:
    """R3 at 10 %, G*/G0 = 3 + .6i, over the static value; and Im K >= 0."""
    material = Maxwell(G, [], [], eta0=0.6e6, K=K, density=1100.0)
    whole = Maxwell(G, [2e6], [1e6], eta0=0.6e6, K=K, density=1100.0)  # G*(1) = 3 + .6i MPa
    assert complex(whole.complex_modulus(1.0)) == pytest.approx(3e6 + 0.6e6j, rel=1e-5)
    found = squeezed("R3", 0.10, whole)
    static, moving = found.stiffness().real, found.stiffness(1.0)
    ratio = moving[8, 8] / static[8, 8]
    assert (ratio.real, ratio.imag) == pytest.approx((3.58, 0.77), abs=0.01)  # digits given
    ratio = moving[6, 6] / static[6, 6]
    assert (ratio.real, ratio.imag) == pytest.approx((3.28, 0.67), abs=0.01)
    lowest = np.linalg.eigvalsh(moving.imag)
    assert lowest[0] > -1e-9 * lowest[-1]
    other = squeezed("R3", 0.10, whole, branches="separable").stiffness(1.0)
    # the two readings differ by 1 % at 10 % of squeeze, and not in the static state
    assert 0.002 < abs(other[6, 6] / moving[6, 6] - 1) < 0.02
    assert material.G0 == G


@pytest.mark.parametrize("recess", [0.0, 1.2 * MM])
def test_without_squeeze_it_is_the_linear_layer(recess: float) -> None:
    ring = layer(recess, maxwell(), 0.5)
    for how in ("bonded", "slip"):
        fitted = ring.assembled(squeeze=0.0, inside=how, outside=how)
        for omega in (0.0, 1e3, 1e5):
            a, b = ring.stiffness(omega), fitted.stiffness(omega)
            np.testing.assert_allclose(b, a, atol=1e-9 * np.abs(a).max())
        a, b = ring.superelement(), fitted.superelement()
        assert b.n == a.n
        for name in ("M", "C"):
            x, y = getattr(a, name), getattr(b, name)
            np.testing.assert_allclose(y[:12, :12], x[:12, :12], atol=1e-9 * np.abs(x).max())


def test_static_tangent_is_the_derivative_of_the_static_force() -> None:
    """The n = 0 harmonic at G0 against two further static states, moved along the axis; and dW/du = Q."""
    ring = layer(1.2 * MM, RUBBER, 0.5)
    depth, h = 0.2 * MM, 1e-3 * MM
    K_zz = ring.body.assembled({"outer": (-depth, 0.0)}).stiffness()[8, 8].real
    ends = [ring.body.assembled({"outer": (-depth, s * h)}) for s in (-1, 1)]
    slope = (ends[1].forces["outer"][1] - ends[0].forces["outer"][1]) / (2 * h)
    assert slope == pytest.approx(K_zz, rel=1e-7)  # asked for
    ends = [ring.body.assembled({"outer": depth + s * h}) for s in (-1, 1)]
    middle = ring.body.assembled({"outer": depth})
    # 1e-6: the third derivative of the energy over a step of 0.5 % of the depth
    assert (ends[1].energy - ends[0].energy) / (2 * h) == pytest.approx(middle.force, rel=1e-5)


@pytest.mark.parametrize(("case", "squeeze"), [("R2", 0.05), ("R3", 0.10)])
def test_rigid_motion_costs_nothing(case: str, squeeze: float) -> None:
    k = squeezed(case, squeeze).stiffness().real
    rigid = np.vstack([np.eye(6), np.eye(6)])  # both references are in one point
    scale = np.sqrt(np.outer(np.diag(k), np.diag(k)))
    assert np.abs((k @ rigid)[:, :3] / scale[:, :3]).max() < 1e-7
    assert np.abs((k @ rigid)[:, 3:] / scale[:, 3:6]).max() < 1e-7


def test_load_terms_carry_torsion() -> None:
    """Without what the forces on the rigid surfaces add, torsion at 20 % comes out a quarter low."""
    found = squeezed("R3", 0.20)
    terms = found.part.prestress.load_terms["outer"]  # type: ignore[attr-defined]
    torsion = found.stiffness()[11, 11].real
    assert terms[1] / torsion == pytest.approx(0.26, abs=0.01)


def test_superelement_condenses_to_the_stiffness_at_its_moduli() -> None:
    material = maxwell()
    found = squeezed("R2", 0.05, material)
    element = found.superelement()
    Ks = element.stiffness(0.0)
    condensed = Ks[:12, :12] - Ks[:12, 12:] @ np.linalg.solve(Ks[12:, 12:], Ks[12:, :12])
    exact = found.stiffness()
    np.testing.assert_allclose(condensed, exact, atol=1e-8 * np.abs(exact).max())
    lowest = np.linalg.eigvalsh(element.viscoelastic[0].H)
    assert lowest[0] > -1e-12 * lowest[-1]


def test_interference_is_diametral() -> None:
    ring = layer(1.2 * MM, RUBBER, 0.5)
    assert ring.assembled(interference=0.4 * MM).force == ring.assembled(squeeze=0.05).force


@pytest.mark.slow
def test_o_ring_has_its_reference_force() -> None:
    """d = 4 mm at 22 mm: 39.7 and 99.3 N at 5 and 10 %."""
    for squeeze, force in ((0.05, 39.7), (0.10, 99.3)):
        found = bd.ORing(22 * MM, 4 * MM, RUBBER).assembled(squeeze=squeeze)
        assert found.force == pytest.approx(force, rel=5e-3)  # asked for


def test_contact_is_lost_at_a_free_edge() -> None:
    """A ring bonded inside and pressed from outside over a part of its width alone lifts beside it."""
    ring = layer(0.0, RUBBER, 0.5)
    narrow = bd.Revolved(
        ring.body.regions,
        {"inner": bd.Cylinder(20 * MM), "outer": bd.Cylinder(24 * MM)},
        refinement=0.5,
    ).assembled({"inner": 0.1 * MM}, slip=("outer",))
    assert narrow.lost["outer"] >= 0.0
    assert narrow.pressures["outer"] > 0


def test_what_is_lost_and_what_touches_are_the_whole_surface() -> None:
    """A hollow-ended ring pressed into a bore parts from it at both ends; flat ends stay in touch."""
    hollow = layer(1.2 * MM, RUBBER, 0.5).assembled(squeeze=0.05, outside="slip", compare=False)
    assert hollow.lost["outer"] > 0.5 * MM
    # 12 mm wide, and no more than the squeeze, of which most goes to the ends, has made of it
    assert 12 * MM < hollow.lost["outer"] + hollow.widths["outer"] < 13.2 * MM
    flat = layer(0.0, RUBBER, 0.5).assembled(squeeze=0.05, outside="slip", compare=False)
    assert flat.lost == {"inner": 0.0, "outer": 0.0}


def test_pressure_is_force_over_the_area_that_it_is_on() -> None:
    """A frictionless pad: all of its face bears alike, π r² J/λ of it."""
    pad = bd.Revolved(
        (bd.Region((0.0, 10 * MM), (0.0, 5 * MM), RUBBER),),
        {"foot": bd.EndFace(0.0), "plate": bd.EndFace(5 * MM)},
        refinement=0.5,
    )
    found = pad.assembled({"plate": 0.25 * MM}, slip=("foot", "plate"))
    # J is 1 − p/3K, 2.5e-5 here
    area = np.pi * (10 * MM) ** 2 / 0.95
    assert found.pressures["plate"] == pytest.approx(found.force / area, rel=1e-4)
    assert found.lost["plate"] == 0.0


def test_squeezes_that_cannot_be_are_named() -> None:
    flat = layer(0.0, RUBBER, 0.5)
    with pytest.raises(
        ValueError, match=r"squeeze is 0\.2; 0\.\d+ of the thickness is reached: .*(fold|turn)"
    ):
        flat.assembled(squeeze=0.2)
    soft = bd.Yeoh(1.0, -2.0)
    with pytest.raises(ValueError, match=r"of the thickness is reached: the law is not stable"):
        flat.assembled(squeeze=0.3, inside="slip", outside="slip", law=soft)
    with pytest.raises(
        ValueError, match=r"squeeze is 0\.6; 0\.6 of the thickness is reached, and it buckles"
    ):
        layer().assembled(squeeze=0.6, inside="slip", outside="slip")
    for bad, text in (
        ({}, "exactly one"),
        ({"squeeze": 0.1, "interference": 1e-3}, "exactly one"),
        ({"squeeze": -0.1}, "squeeze is -0.1"),
        ({"squeeze": 1.0}, "squeeze is 1.0"),
        ({"squeeze": float("nan")}, "squeeze is nan"),
        ({"interference": 9 * MM}, "interference is 0.009"),
        ({"squeeze": 0.1, "inside": "glued"}, "inside is 'glued'"),
        ({"squeeze": 0.1, "branches": "both"}, "branches is 'both'"),
        ({"squeeze": 0.1, "law": "rubber"}, "law is 'rubber'"),
        ({"squeeze": 0.1, "law": bd.NeoHooke}, "law is <class"),
    ):
        with pytest.raises(ValueError, match=text):
            flat.assembled(**bad)
    with pytest.raises(ValueError, match=r"recess is 0\.006"):
        layer(6 * MM)
    with pytest.raises(ValueError, match=r"press is 'middle'"):
        flat.body.assembled({"middle": 1e-4})
    for motion, size in ((0.25, "0.004 m deep"), (0.005, "0.004 m deep"), ((0.25, 0.0), "0.012 m large")):
        with pytest.raises(ValueError, match=rf"press\['outer'\] is .*; the body is {size}.*is it in mm"):
            flat.body.assembled({"outer": motion})
    with pytest.raises(ValueError, match=r"slip is 'outer'; give a list of interfaces"):
        flat.body.assembled({"outer": 1e-4}, slip="outer")
    with pytest.raises(ValueError, match="no stiffness"):
        layer(0.0, Maxwell(0.0, [1e6], [1e-3], K=K, density=1100.0)).assembled(squeeze=0.1)


def test_static_state_beyond_the_data_warns() -> None:
    rubber = Maxwell(G, [2e6], [1e-4], K=K, density=1100.0, band=(10.0, 5e3))
    with pytest.warns(BeyondData):
        layer(0.0, rubber, 0.5).assembled(squeeze=0.05, inside="slip", outside="slip")


def test_a_mesh_that_decides_warns() -> None:
    """Two answers 2 % apart are told of; two of the same ring on neighbouring meshes are not."""
    fine, other = (
        layer(0.0, RUBBER, 0.5).assembled(squeeze=s, inside="slip", outside="slip", compare=False)
        for s in (0.100, 0.102)
    )
    with pytest.warns(MeshDependent, match=r"times its refinement, \d"):
        compare_meshes(fine, lambda: other)
    with warnings.catch_warnings():
        warnings.simplefilter("error", MeshDependent)
        layer(0.0, RUBBER, 1.0).assembled(squeeze=0.03)


def test_an_equilibrium_tells_of_a_layer_strained_beyond_its_linear_stiffness() -> None:
    """rubber.md: secant +.5 % at 5 %, +2 % at 10 % of the thickness; the tangent three times that."""
    for share, told in ((0.05, ("5.0%", "0.5%", "1.5%")), (0.10, ("10.0%", "2.0%", "6.0%"))):
        ring = layer(0.0, maxwell(), 0.5)
        app = bd.Application()
        app.add("ring", ring)
        app.free("ring.inner")
        app.ground("ring.outer")
        force = share * ring.thickness * ring.stiffness()[0, 0].real
        app.load("ring.inner", (0.0, -force, 0.0, 0.0, 0.0, 0.0))
        with pytest.warns(StrainedLayer) as caught:
            bd.equilibrium(app)
        text = str(caught[0].message)
        assert all(figure in text for figure in told), text


def test_a_squeezed_layer_takes_the_place_of_the_layer() -> None:
    material = maxwell()
    ring = layer(0.0, material, 0.5)
    fitted = ring.assembled(squeeze=0.10, inside="slip", outside="slip", compare=False)
    sag = []
    for part in (ring, fitted):
        app = bd.Application()
        app.add("ring", part)
        app.free("ring.inner")
        app.ground("ring.outer")
        app.load("ring.inner", (0.0, -10.0, 0.0, 0.0, 0.0, 0.0))
        sag.append(bd.equilibrium(app).displacement("ring.inner")[1])
        assert -10.0 / part.stiffness()[1, 1].real == pytest.approx(sag[-1], rel=1e-6)
    assert sag[1] / sag[0] == pytest.approx(2748.1 / 3897.3, rel=5e-3)  # rubber.md §2


def test_the_squeezed_section_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    fitted = layer(1.2 * MM, RUBBER, 0.5).assembled(squeeze=0.05, compare=False)
    ax = bd.plot.squeezed_section(fitted)
    labels = [line.get_label() for line in ax.lines]
    assert f"outer: {fitted.pressure / 1e6:.2f} MPa" in labels
    assert "before" in labels
    with pytest.raises(ValueError, match="squeezed is"):
        bd.plot.squeezed_section(layer())  # type: ignore[arg-type]
    matplotlib.pyplot.close("all")
