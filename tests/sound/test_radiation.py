"""Sound outside spheres and above floors against closed forms, and what must hold for any surface."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.optimize

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.notice import CoarsePanels
from bearingdyn.sound import Radiation, TriangleSurface
from bearingdyn.sound.radiation import SAFE, SAFE_ON_FLOOR, below_resonances
from spheres import DENSITY, SPEED, decibels, impedance, power, shapes, sphere
from twins.radiation_twin import operators

RESONANCES = (
    math.pi,
    4.493409,
    5.763459,
    2 * math.pi,
    2.081576,
)  # inside a sphere: Dirichlet's and Neumann's


def solved(n: int, ka: float, floor: float | None = None, height: float = 0.0) -> Radiation:
    centre = (0.0, height, 0.0)
    points, faces = sphere(n, centre=centre)
    surface = TriangleSurface(points, faces, floor)
    return bd.sound.solve(surface, shapes(points, faces, centre), ka * SPEED / (2 * np.pi))


def errors(n: int, ka: float) -> list[float]:
    R = solved(n, ka).resistance
    return [decibels(0.5 * R[j, j], power(j, ka)) for j in range(3)]


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
@pytest.mark.parametrize("ka", [0.01, 0.1, math.pi, 5.763459])
def test_spheres_radiate_their_power(ka: float) -> None:
    """Pulsating, oscillating and as a quadrupole; inside resonances are no exception.

    At ka = .01 the power of the quadrupole is 4e-12 of what swings: a complex factor made it 25 dB too much.
    """
    # flat triangles render the shape of P2 worst: .043 dB with 800
    assert np.abs(errors(10, ka)) == pytest.approx(0.0, abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("ka", [0.01, 0.1, 0.3, 1.0, *RESONANCES, 8.0, 10.0])
def test_spheres_radiate_their_power_from_hundredth_to_ten(ka: float) -> None:
    """Theory.md, section 4.6, on 1568 triangles: .02 dB seen, from the shape of P2 on flat triangles."""
    assert np.abs(errors(14, ka)) == pytest.approx(0.0, abs=0.03)


def test_oscillating_sphere_has_the_closed_form_of_the_theory() -> None:
    """P = (2π/3) ρc a² v² (ka)⁴/(4 + (ka)⁴); the reference of the other tests is the same."""
    for ka in (0.1, 1.0, 3.0):
        closed = 2 * np.pi / 3 * DENSITY * SPEED * ka**4 / (4 + ka**4)
        assert power(1, ka) == pytest.approx(closed, rel=1e-12)
        assert power(0, ka) == pytest.approx(2 * np.pi * DENSITY * SPEED * ka**2 / (1 + ka**2), rel=1e-12)


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_power_at_the_surface_is_that_of_the_far_field() -> None:
    for ka in (0.5, math.pi):
        found = solved(6, ka)
        for v in np.eye(3):
            # the far field has the error of the pressure, which the power has only squared
            assert decibels(bd.sound.far_power(found, v), found.power(v)) == pytest.approx(0.0, abs=0.05)


def test_efficiency_of_a_pulsating_sphere() -> None:
    """(ka)²/(1 + (ka)²)."""
    assert solved(6, 0.5).efficiency([1.0, 0.0, 0.0]) == pytest.approx(0.2, rel=0.01)  # .04 dB of geometry


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_pressure_around_a_pulsating_sphere() -> None:
    ka = 2.0
    found = solved(6, ka)
    for r in (1.5, 3.0, 20.0):
        p = bd.sound.pressure_at(found, [[0.0, 0.0, r], [r, 0.0, 0.0]])[:, 0]
        closed = impedance(0, ka) / r * np.exp(-1j * ka * (r - 1))
        assert p == pytest.approx(np.full(2, closed), rel=5e-3)  # linear pressure on 288 triangles


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_reciprocity_above_a_floor() -> None:
    """Each velocity's pressure works on the other as much as the other's on it."""
    points, faces = sphere(4, centre=(0.0, 1.6, 0.3))
    other, more = sphere(3, 0.5, centre=(2.0, 0.7, 0.0))
    surface = TriangleSurface(np.vstack([points, other]), np.vstack([faces, more + len(points)]), 0.0)
    v = np.random.default_rng(3).standard_normal((len(surface.faces), 6))
    Z = bd.sound.solve(surface, v, 150.0).impedance
    assert np.abs(Z - Z.T).max() < 1e-12 * np.abs(Z).max()
    # and by the pressures themselves, of smooth motions on both, each with its own error
    v = np.zeros((len(surface.faces), 6))
    v[: len(faces), :3] = shapes(points, faces, (0.0, 1.6, 0.3))
    v[len(faces) :, 3:] = shapes(other, more, (2.0, 0.7, 0.0), 0.5)
    found = bd.sound.solve(surface, v, 150.0)
    Z = found.impedance
    assert np.abs(Z - Z.T).max() < 1e-12 * np.abs(Z).max()
    mean = found.pressure[surface.faces].mean(axis=1)
    work = v.T @ (surface.areas[:, None] * mean)
    assert np.abs(work - Z).max() < 0.02 * np.abs(Z).max()


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_resistance_is_positive_to_round_off_of_the_discretisation() -> None:
    points, faces = sphere(5)
    surface = TriangleSurface(points, faces)
    R = bd.sound.solve(surface, np.eye(len(faces)), 100.0).resistance
    w = np.linalg.eigvalsh(R)
    assert w[0] > -1e-6 * w[-1]


def test_small_source_above_a_floor_has_its_image() -> None:
    """P = P0 (1 + sin(2kh)/2kh) of a point at height h; a sphere of h/20 departs from that by (a/h)³."""
    a, h, k = 0.05, 1.0, 1.3
    points, faces = sphere(4, a, (0.0, h, 0.0))
    v = shapes(points, faces, (0.0, h, 0.0), a)[:, 0]
    found = bd.sound.radiated_power(points, faces, v, k * SPEED / (2 * np.pi), floor=0.0)
    expected = power(0, k * a, a) * (1 + math.sin(2 * k * h) / (2 * k * h))
    assert found == pytest.approx(expected, rel=2e-3)


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_a_floor_at_any_height_sends_the_power_far_away() -> None:
    """The image's phase counts from the floor; the far field has the error of the pressure, not squared."""
    found = solved(4, 1.0, floor=0.7, height=2.0)
    assert bd.sound.far_power(found, [1, 0, 0]) == pytest.approx(found.power([1, 0, 0]), rel=0.02)


def test_pressure_above_a_floor_does_not_depend_on_its_height() -> None:
    """Sphere, floor and place moved up together; the image's own place counts from the floor."""
    at = np.array([[1.5, 2.0, 0.4], [-3.0, 0.1, 1.0]])
    low, high = (solved(3, 0.5, floor=y, height=1.3 + y) for y in (0.0, 0.7))
    here, there = (bd.sound.pressure_at(one, at + [0.0, y, 0.0]) for one, y in ((low, 0.0), (high, 0.7)))
    assert there == pytest.approx(here, rel=1e-9)


@pytest.mark.parametrize(("volume", "limit"), [(1.0, SAFE), (2.0, SAFE_ON_FLOOR)])
def test_a_real_factor_ends_below_the_first_resonance_of_a_ball(volume: float, limit: float) -> None:
    """Among insides of a volume, of L³ or with the image 2 L³, the ball's is lowest: x cot x = 1 − a/L."""
    a = (0.75 * volume / math.pi) ** (1 / 3)  # over L
    x = scipy.optimize.brentq(lambda x: x / math.tan(x) - 1.0 + a, 0.1, 3.0)
    assert 0.9 * x / a < limit < x / a
    points, faces = sphere(2)
    surface = TriangleSurface(points, faces, None if volume == 1.0 else -1.5)
    f = limit / surface.extent * SPEED / (2 * math.pi)
    assert below_resonances(surface, 0.999 * f, SPEED)
    assert not below_resonances(surface, 1.001 * f, SPEED)


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_half_a_sphere_on_a_floor_radiates_half_of_the_sphere() -> None:
    """Triangles that meet their own images; the mesh is symmetric, so that only the quadrature differs."""
    points, faces = sphere(6)
    whole = bd.sound.solve(TriangleSurface(points, faces), shapes(points, faces), 60.0)
    above = (points[faces][:, :, 1] > -1e-12).all(axis=1)
    half = bd.sound.solve(TriangleSurface(points, faces[above], 0.0), shapes(points, faces)[above], 60.0)
    for j in (0, 2):
        assert half.resistance[j, j] == pytest.approx(0.5 * whole.resistance[j, j], rel=1e-6)
    assert bd.sound.far_power(half, [1, 0, 0]) == pytest.approx(half.power([1, 0, 0]), rel=5e-3)


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
def test_microphones_of_iso_3744_find_the_power() -> None:
    """A pulsating half sphere on the floor sounds the same all around: p²/2ρc times the area is the power."""
    points, faces = sphere(5)
    above = (points[faces][:, :, 1] > -1e-12).all(axis=1)
    found = bd.sound.solve(TriangleSurface(points, faces[above], 0.0), shapes(points, faces)[above, :1], 60.0)
    at, area = bd.sound.hemisphere_positions(8.0)
    assert np.linalg.norm(at, axis=1) == pytest.approx(np.full(10, 8.0))
    p = bd.sound.pressure_at(found, at)[:, 0]
    measured = float((np.abs(p) ** 2).mean()) / (2 * DENSITY * SPEED) * area
    assert decibels(measured, found.power()) == pytest.approx(0.0, abs=0.05)
    box, area = bd.sound.box_positions((-1, 0, -1), (1, 1, 1), 1.0)
    assert area == pytest.approx(4 * (2 * 2 + 2 * 2 + 2 * 2))
    assert box[0].tolist() == [2.0, 1.0, 0.0]
    assert box[8].tolist() == [0.0, 2.0, 0.0]


def test_operators_equal_their_twin() -> None:
    """Between two tetrahedra, no pair of which touches."""
    one = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], dtype=np.int32)
    points = np.vstack([one, 0.7 * one + [2.2, 0.3, 0.4]])
    both = np.vstack([faces, faces + 4]).astype(np.int32)
    found = dict(zip(("V", "V1", "Kt", "K", "D"), core.helmholtz(points, both, 2.0), strict=True))
    twin = operators(points, both, 2.0)
    for name, cut in (("V", 4), ("V1", 4), ("Kt", 4), ("K", 4), ("D", 4)):
        for block in (np.s_[:cut, cut:], np.s_[cut:, :cut]):
            error = np.abs(found[name][block] - twin[name][block]).max()
            # degree 4 and 6 at distances of one to three sides
            assert error < 3e-4 * np.abs(twin[name][block]).max(), name


def test_small_panels_far_apart_see_the_point_sources_field() -> None:
    """V over both areas is exp(−ikr)/4πr: sides of 1e-8 m, 1 m apart, kr to 100."""
    small = 1e-8 * np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], dtype=np.int32)
    points = np.vstack([small, small + [0.6, 0.0, 0.8]])
    both = np.vstack([faces, faces + 4]).astype(np.int32)
    x = points[both]
    area = 0.5 * np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)
    r = np.linalg.norm(x.mean(axis=1)[:4, None] - x.mean(axis=1)[None, 4:], axis=2)
    for k in np.linspace(0.1, 100.0, 60):
        V = core.helmholtz(points, both, k)[0][:4, 4:] / (area[:4, None] * area[None, 4:])
        # the panels' own size is (k 1e-8)², round-off of the places k 1e-16; sine and cosine hold to 1e-13
        assert np.abs(V * 4 * np.pi * r - np.exp(-1j * k * r)).max() < 1e-12


def test_a_constant_pressure_inside_is_gauss_theorem() -> None:
    """K 1 = −½ and D 1 = 0 on any closed surface as k → 0."""
    points, faces = sphere(3)
    _, _, _, K, D = core.helmholtz(points, faces.astype(np.int32), 1e-7)
    x = points[faces]
    area = 0.5 * np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)
    mass = np.bincount(faces.ravel(), np.repeat(area / 3, 3))
    assert K.sum(axis=1).real == pytest.approx(-0.5 * mass, rel=2e-3)  # of singular pairs by 4 Gauss points
    assert np.abs(D.sum(axis=1)).max() < 1e-12


# ---------------------------------------------------------------- bad input


def test_an_open_surface_is_named() -> None:
    points, faces = sphere(2)
    with pytest.raises(ValueError, match=r"the surface is open; close it \(3 such edges\)"):
        TriangleSurface(points, faces[1:])


def test_a_surface_inside_out_is_named() -> None:
    points, faces = sphere(2)
    with pytest.raises(ValueError, match="inside out: body 0, 32 triangles"):
        TriangleSurface(points, faces[:, ::-1])
    faces[3] = faces[3, ::-1]
    with pytest.raises(ValueError, match="numbered against one another"):
        TriangleSurface(points, faces)


@pytest.mark.parametrize("floor", [None, -2.0])
def test_a_body_inside_another_is_named(floor: float | None) -> None:
    """Both anticlockwise from outside; two bodies beside or above one another are none of it."""
    points, faces = sphere(2)
    other, more = sphere(2, 0.3, (0.1, 0.2, 0.0))
    both = np.vstack([faces, more + len(points)])
    with pytest.raises(ValueError, match="body 1 of the surface, 32 triangles, reaches into body 0 near"):
        TriangleSurface(np.vstack([points, other]), both, floor)
    for apart in ([2.0, 0.0, 0.0], [0.0, 3.0, 0.0]):
        assert len(TriangleSurface(np.vstack([points, other + apart]), both, floor).bodies) == 2


def test_a_half_ball_on_the_floor_hides_what_lies_in_it() -> None:
    points, faces = sphere(4)
    above = (points[faces][:, :, 1] > -1e-12).all(axis=1)
    other, more = sphere(2, 0.3, (0.0, 0.35, 0.0))
    both = np.vstack([faces[above], more + len(points)])
    with pytest.raises(ValueError, match="reaches into body"):
        TriangleSurface(np.vstack([points, other]), both, 0.0)
    TriangleSurface(np.vstack([points, other + [0.0, 2.0, 0.0]]), both, 0.0)


def test_a_surface_below_its_floor_is_named() -> None:
    points, faces = sphere(2)
    with pytest.raises(ValueError, match=r"floor is 0\.5; the surface reaches down to y = -1\."):
        TriangleSurface(points, faces, 0.5)


def test_coarse_panels_are_named() -> None:
    points, faces = sphere(3)
    with pytest.warns(CoarsePanels, match="a sixth of the wavelength at 500 Hz is 114 mm"):
        bd.sound.radiated_power(points, faces, np.ones(len(faces)), 500.0)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"points": [[0.0, math.nan, 0.0]]}, r"points has shape \(1, 3\); it must be corners"),
        ({"faces": [[0, 1, 99]]}, r"faces\[0\] is \[0, 1, 99\]; its corners must be in 0...17"),
        ({"faces": [[0.0, 1.0, 2.0]]}, "it must be triangles"),
        ({"velocity": np.ones(3)}, r"velocity has shape \(3,\); it must be \(32,\)"),
        ({"velocity": np.full(32, math.nan)}, r"shapes has shape \(32, 2\).* finite"),
        ({"frequency": 0.0}, "frequency is 0.0; it must be positive"),
        ({"frequency": math.nan}, "frequency is nan; it must be positive"),
        ({"density": -1.0}, "density is -1.0; it must be positive"),
        ({"sound_speed": math.inf}, "sound_speed is inf; it must be positive"),
        ({"floor": math.nan}, "floor is nan; it must be a height"),
    ],
)
def test_bad_input_is_named(change: dict[str, object], text: str) -> None:
    points, faces = sphere(2)
    given = {"points": points, "faces": faces, "velocity": np.ones(32), "frequency": 20.0} | change
    with pytest.raises(ValueError, match=text):
        bd.sound.radiated_power(**given)


def test_complex_shapes_are_named() -> None:
    """Z is bilinear in the shapes; what is complex are their amplitudes."""
    points, faces = sphere(2)
    with pytest.raises(ValueError, match=r"shapes has shape \(32, 1\).* real and finite"):
        bd.sound.solve(TriangleSurface(points, faces), np.full((32, 1), 1j), 20.0)


def test_a_point_too_near_is_named() -> None:
    found = solved(2, 0.2)
    with pytest.raises(ValueError, match="at least a triangle's length"):
        bd.sound.pressure_at(found, [[0.0, 1.1, 0.0]])
    with pytest.raises(ValueError, match="directions has a vector"):
        bd.sound.far_field(found, [[0.0, 2.0, 0.0]])
