"""The bore of a solid that bends with a ring in it, against the same bush as a body of revolution."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import LooseFit
from bearingdyn.fem import SolidMesh, ring_mesh
from bearingdyn.material import STEEL
from bearingdyn.parts import Cylinder, FlexibleBore, Groove, Line, Region, Revolved, Solid
from flexible_rings import LOOSE, MM, loose

BORE, THICK, HALF = 31 * MM, 9 * MM, 8.5 * MM
ORDER = LOOSE.order
LOAD = 3000.0


@pytest.fixture(scope="module")
def mesh() -> SolidMesh:
    return ring_mesh((BORE, BORE + THICK), 2 * HALF, across=4, along=4, around=24)


@pytest.fixture(scope="module")
def bush(mesh: SolidMesh) -> Solid:
    """A steel bush, held at its outside."""
    return Solid(mesh, STEEL, {"foot": "outer"}, f_max=0.0, bores={"bore": FlexibleBore("inner", ORDER)})


@pytest.fixture(scope="module")
def revolved() -> Revolved:
    face = Groove(Line((BORE, -HALF), (BORE, HALF)), BORE, ORDER, z=0.0)
    region = Region((BORE, BORE + THICK), (-HALF, HALF), STEEL)
    return Revolved((region,), {"foot": Cylinder(BORE + THICK)}, grooves={"bore": face}, f_max=0.0)


def test_compliances_are_those_of_the_body_of_revolution(bush: Solid, revolved: Revolved) -> None:
    """Which plane elasticity confirms; order by order, radial and axial, none of them coupled."""
    element = bush.superelement()
    rows, inner = element.raceways["bore"].rows, np.arange(6, element.n)
    C = rows[:, inner] @ np.linalg.solve(element.K[np.ix_(inner, inner)], rows[:, inner].T)
    series = element.raceways["bore"].series
    for axial, n, sine in series.terms:
        k = series.index(axial, n, sine)
        whole = revolved.groove_compliances(n)
        # four elements through the wall: .01 to .3 %; at order 8, three around a wave
        assert C[k, k] == pytest.approx(whole[axial, axial], rel=0.01), (axial, n, sine)
        # orders that 24 elements do not fold into one another do not couple: round-off
        others = [j for j, term in enumerate(series.terms) if term[1:] != (n, sine)]
        assert np.abs(C[k, others]).max() < 1e-10 * C[k, k]


def test_a_rigid_motion_is_told_exactly(bush: Solid) -> None:
    element = bush.superelement()
    moved = element.raceways["bore"].rows[:, :6]
    series = element.raceways["bore"].series
    # quadrature on elements whose sides are parabolas, not arcs
    np.testing.assert_allclose(moved[:, :5], series.rigid(BORE)[:, :5], atol=1e-4, rtol=1e-4)


def test_a_ring_lies_in_it_as_in_the_body_of_revolution(bush: Solid, revolved: Revolved) -> None:
    clearance = 20e-6

    def rests(body: Solid | Revolved) -> bd.Equilibrium:
        app = loose(clearance)
        app.plan.fits.clear()
        app.add("housing", body)
        app.ground("housing.foot")
        app.fit("seat", LooseFit(clearance), ring="ring.outside", bore="housing.bore")
        return bd.equilibrium(app)

    rigid = bd.equilibrium(loose(clearance)).displacement("rotor.centre")[1]
    solid, round_body = (rests(b).displacement("rotor.centre")[1] for b in (bush, revolved))
    assert solid - rigid < -0.2e-6  # the bush gives
    # what the bush adds, to the mesh's error
    assert solid - rigid == pytest.approx(round_body - rigid, rel=0.01)


def test_a_bore_off_the_origin_is_known_by_its_own_middle(mesh: SolidMesh) -> None:
    away = replace(mesh, points=mesh.points + [0.1, -0.05, 0.02])
    bore = FlexibleBore("inner", 3)
    middle, radius = bore.place(away)
    np.testing.assert_allclose(middle, [0.1, -0.05, 0.02], atol=1e-9)
    assert radius == pytest.approx(BORE, rel=1e-9)
    np.testing.assert_allclose(bore.rows(away).toarray(), bore.rows(mesh).toarray(), atol=1e-8)


def test_a_housing_on_feet_couples_orders_of_one_symmetry() -> None:
    """A plane of symmetry x = 0 keeps cosines of even and sines of odd order from the others."""
    body = bd.Housing(0.1, 0.09, 2 * HALF, 2 * BORE, 0.048, STEEL, element_size=0.012).body
    bore = FlexibleBore("bore", 3)
    solid = Solid(body.mesh, STEEL, {"feet": "base"}, f_max=0.0, bores={"bore": bore})
    element = solid.superelement()
    rows, inner = element.raceways["bore"].rows, np.arange(6, element.n)
    C = rows[:, inner] @ np.linalg.solve(element.K[np.ix_(inner, inner)], rows[:, inner].T)
    even = np.array([n % 2 == sine for _, n, sine in bore.series.terms])
    size = np.sqrt(np.outer(np.diag(C), np.diag(C)))
    assert np.abs((C / size)[np.ix_(even, ~even)]).max() < 1e-8  # round-off
    one, three = (bore.series.index(0, n, 1) for n in (1, 3))
    assert abs(C[one, three]) > 0.01 * size[one, three]  # but the feet couple these


@pytest.mark.parametrize(
    ("surface", "order", "told"),
    [
        ("inner", 13, r"order is 13; .* every 7.5 degrees, which holds waves to order 12: give 12"),
        ("outer", 4, "faces outwards"),
        ("z-", 4, "off a circle"),
        ("hole", 4, "hole"),
        ("inner", 0, "order is 0"),
        (3, 4, "surface is 3; it must be the name of a surface"),
    ],
)
def test_what_is_no_bore_is_named(mesh: SolidMesh, surface: str, order: int, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        Solid(mesh, STEEL, {"foot": "outer"}, bores={"bore": FlexibleBore(surface, order)})


def test_names_and_kinds(mesh: SolidMesh) -> None:
    with pytest.raises(ValueError, match="bores has 'foot', the name of an interface"):
        Solid(mesh, STEEL, {"foot": "outer"}, bores={"foot": FlexibleBore("inner", 3)})
    with pytest.raises(ValueError, match="FlexibleBore"):
        Solid(mesh, STEEL, {"foot": "outer"}, bores={"bore": "inner"})


def test_a_ring_of_other_orders_is_refused(mesh: SolidMesh) -> None:
    app = loose(20e-6)
    app.plan.fits.clear()
    body = Solid(mesh, STEEL, {"foot": "outer"}, f_max=0.0, bores={"bore": FlexibleBore("inner", 4)})
    app.add("housing", body)
    app.ground("housing.foot")
    with pytest.raises(ValueError, match=f"housing.bore to 4; make the bore, .* with order={ORDER}"):
        app.fit("seat", LooseFit(20e-6), ring="ring.outside", bore="housing.bore")
