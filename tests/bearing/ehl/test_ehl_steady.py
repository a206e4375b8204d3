"""The steady film against other programs, its closures, and its first answers to an approach."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy

from bearingdyn.bearing import ehl
from bearingdyn.bearing.ehl.dimensionless_groups import LOAD
from bearingdyn.bearing.ehl.newton import Border, newton
from bearingdyn.bearing.ehl.steady_film import _limit
from bearingdyn.bearing.film_thickness import dimensionless_film
from verified.ehl import CASES, OMEGA, TABLE, mourier


@pytest.fixture(scope="module")
def coarse() -> ehl.Steady:
    return ehl.steady(100, 10, grid=49)


@pytest.fixture(scope="module")
def fine() -> ehl.Steady:
    return ehl.steady(100, 10)


@pytest.mark.parametrize(
    "case", [c if c in ("100 rd", "20 bi") else pytest.param(c, marks=pytest.mark.slow) for c in CASES]
)
def test_film_stiffness_and_damping_are_those_of_an_independent_program(case: str) -> None:
    arguments, laws = CASES[case]
    found = ehl.steady(*arguments, **laws)
    Hc, Hmin, K0, C0 = TABLE[case]
    # what was asked of this program; the reference gives its own error as 0.2 %
    assert found.Hc == pytest.approx(Hc, rel=5e-3)
    assert found.Hmin == pytest.approx(Hmin, rel=5e-3)
    assert found.K0 == pytest.approx(K0, rel=1e-3)
    assert found.C0 == pytest.approx(C0, rel=2e-2)


def test_stiffness_and_damping_over_frequency_are_those_of_an_independent_program(fine: ehl.Steady) -> None:
    found = fine.stiffness(list(OMEGA))
    for k, (Omega, (C, K)) in zip(found, OMEGA.items(), strict=True):
        assert k.real == pytest.approx(K, rel=3e-3)
        assert 1.5 * k.imag / Omega == pytest.approx(C, rel=2e-2)


def test_one_grid_errs_by_no_more_than_it_says() -> None:
    found = ehl.steady(100, 10, grid=65)
    for value, error, exact in zip(
        found.figures, found.error, (3.844, 2.058, None, 0.979, 0.0695), strict=True
    ):
        if exact is not None:
            assert abs(value - exact) < (error + 2e-3) * exact  # 0.2 % is the reference's own


def _centre(level: ehl.Level) -> float:
    return float(level.state.H[0, level.equations.grid.origin])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("place", "laws"),
    [
        ((100.0, 10.0, 0.15), {}),
        ((1000.0, 10.0, 0.15), {"viscosity": "barus", "density": "incompressible"}),
        ((1000.0, 10.0, 1.0), {}),
        ((200.0, 5.0, 0.15), {"viscosity": "barus"}),
    ],
)
def test_finer_grids_find_the_same_contact(place: tuple[float, float, float], laws: dict[str, str]) -> None:
    usual = ehl.steady(*place, **laws).figures
    finer = ehl.steady(*place, **laws, accuracy=0.004).figures
    # what was asked of other programs: .5 % of films, .1 % of K0, 2 % of C0
    assert usual[:3] == pytest.approx(finer[:3], rel=5e-3)
    assert usual.K0 == pytest.approx(finer.K0, rel=1e-3)
    assert usual.C0 == pytest.approx(finer.C0, rel=2e-2)


def test_figures_that_settle_are_extrapolated_and_those_that_jump_are_averaged() -> None:
    """Pitch 4, 2 and 1: a film, a film with jumps, a K0 that settles, and one that jumps."""
    pitch, jumps = np.array([4.0, 2.0, 1.0]), np.array([0.0, 3e-3, 0.0])
    settling, jumping = 1 + 1e-2 * pitch**2, 1 + 1e-4 * pitch**2 + jumps
    grids = np.stack([settling, jumping, settling, jumping], axis=1)
    limit, error = _limit(grids, np.array([True, True, False, False]))
    assert limit[[0, 2]] == pytest.approx(1.0, abs=1e-12)
    # two grids make −jump/3 of a jump, least squares over three jump/2
    assert limit[[1, 3]] == pytest.approx([1 - 1e-3, 1 + 1.5e-3], abs=1e-12)
    assert (np.abs(limit - 1) <= error).all()
    assert error[1] > 3e-3
    first, unknown = _limit(grids[:1])
    assert (first == grids[0]).all()
    assert np.isnan(unknown).all()
    assert _limit(grids[:2])[0] == pytest.approx(grids[1] + (grids[1] - grids[0]) / 3)


@pytest.mark.parametrize("accuracy", [0.04, pytest.param(0.02, marks=pytest.mark.slow)])
def test_a_stiffness_that_jumps_from_grid_to_grid_errs_by_no_more_than_it_says(accuracy: float) -> None:
    """Of M = 10: on twenty grids it is .8312 ± 7e-4, and the independent program's is .831, to .0005."""
    found = ehl.steady(10, 0, accuracy=accuracy)
    assert abs(found.K0 - 0.831) < found.error.K0 * found.K0 + 5e-4
    assert 3e-4 < found.error.K0 < 4e-3
    # the answer at low frequency is the same figure
    slow = complex(found.stiffness(1e-3))
    assert slow.real == pytest.approx(found.K0, rel=1e-6)
    assert 1.5 * slow.imag / 1e-3 == pytest.approx(found.C0, rel=1e-5)


def test_grid_error_falls_with_the_square_of_the_pitch() -> None:
    for M, L, grid in ((100, 10, 129), (20, 10, 65)):
        H = [_centre(level) for level in ehl.steady(M, L, grid=grid).levels[-3:]]
        assert 1.7 < math.log2((H[1] - H[0]) / (H[2] - H[1])) < 2.3


def test_simulated_film_of_mourier_et_al() -> None:
    for case, expected, computed, tolerance in mourier():
        assert computed == pytest.approx(expected, rel=tolerance), case


@pytest.mark.parametrize("D", [1.0, 0.2])
def test_film_of_an_incompressible_oil_is_the_fit_of_nijenbanning_venner_and_moes(D: float) -> None:
    found = ehl.steady(200, 8, D, density="incompressible", accuracy=0.03)
    assert found.Hc == pytest.approx(dimensionless_film(200, 8, D), rel=0.04)  # 1 to 3 % is the fit's


def test_a_rigid_ball_floats_on_the_film_of_kapitza() -> None:
    """P. L. Kapitza 1955, D = 1: H = 128/4 φ² (.131 atan ½ + 1.683)²/M², φ = 3/5, oil from everywhere."""
    # oil that begins at a gap of g hc lacks what the rest would bear, as 1/√g: pressure falls as distance^−3
    near, far = (ehl.steady(0.5, 0, inlet=gap, accuracy=0.03).Hc for gap in (75.0, 300.0))
    endless = 2 * far - near
    # the next term, as 1/g, and sides at .4 of the gap
    assert endless == pytest.approx(32 * 0.36 * (0.131 * math.atan(0.5) + 1.683) ** 2 / 0.25, rel=0.05)


def test_pressure_film_and_reynolds_equation_close(coarse: ehl.Steady) -> None:
    level = coarse.levels[-1]
    grid, state = level.equations.grid, level.state
    assert (state.P >= 0).all()
    assert (state.H > 0).all()
    flow = state.H[0, grid.origin] / grid.dx
    assert np.abs(state.residual[state.P > 0]).max() < 1e-10 * flow
    assert state.residual[grid.inner].min() > -1e-10 * flow
    assert np.abs(state.P * state.residual).max() < 1e-10 * flow
    assert (grid.weights * state.P).sum() == pytest.approx(LOAD, rel=1e-10)


def test_mass_is_conserved_through_every_section_ahead_of_the_rupture(coarse: ehl.Steady) -> None:
    level = coarse.levels[-1]
    grid, state = level.equations.grid, level.state
    along, across = level.equations.fluxes(state.P, state.H)
    strip = np.full(grid.ny - 1, grid.dy)
    strip[0] /= 2
    ruptured = np.flatnonzero((state.P[:-1] == 0).any(axis=0) & (np.arange(grid.nx) > 2))[0]
    assert grid.X[ruptured] > -0.5
    enters = strip @ along[:-1, 1]
    for i in range(2, ruptured):
        beside = across[-1, 2 : i + 1].sum() * grid.dx
        assert strip @ along[:-1, i] + beside == pytest.approx(enters, rel=1e-8)


def test_static_stiffness_is_the_slope_of_force_over_approach(coarse: ehl.Steady) -> None:
    level = coarse.levels[-1]
    equations, state = level.equations, level.state
    step = 1e-6 * equations.groups.approach
    forces = []
    for sign in (1, -1):
        held = Border(load=state.H0 - sign * step, mass=1.0, force=0.0)
        moved = newton(equations, state.P, state.H0, held)
        forces.append(float((equations.grid.weights * moved.P).sum()))
    slope = (forces[0] - forces[1]) / (2 * step) * equations.groups.approach / (1.5 * LOAD)
    assert coarse.K0 == pytest.approx(slope, rel=1e-5)


def test_damping_at_low_frequency_is_the_limit_of_the_harmonic_answer(coarse: ehl.Steady) -> None:
    Omega = 1e-3
    k = complex(coarse.stiffness(Omega))
    assert k.real == pytest.approx(coarse.K0, rel=1e-6)
    assert 1.5 * k.imag / Omega == pytest.approx(coarse.C0, rel=1e-5)


def test_answer_follows_the_film_carried_through_the_contact(coarse: ehl.Steady) -> None:
    # two constants, and the transport of the inlet's film at um: within .4 % of K to Ω = 1
    found = coarse
    A, B = found.K0 - 1, found.C0 / 1.5 + (found.K0 - 1) * math.pi / 4
    y, w = np.polynomial.legendre.leggauss(40)
    s = np.sqrt(1 - y**2)
    for Omega in (0.2, 0.5, 1.0):
        S = 0.5 * (w * scipy.special.j0(Omega * s) * np.exp(-1j * Omega * s)).sum()
        carried = 1 + (A + 1j * Omega * B) * S
        assert complex(found.stiffness(Omega)).real == pytest.approx(carried.real, rel=5e-3)


def test_whole_fields_are_symmetric_and_reach_hertz(coarse: ehl.Steady) -> None:
    assert coarse.pressure.shape == coarse.film.shape == (len(coarse.Y), len(coarse.X))
    assert (coarse.pressure == coarse.pressure[::-1]).all()
    assert 0.9 < coarse.pressure[len(coarse.Y) // 2, np.abs(coarse.X) < 0.1].max() < 1.1
    assert "Hc=" in repr(coarse)
    assert 0 < coarse.approach < 1


@pytest.mark.parametrize(
    ("arguments", "options", "message"),
    [
        ((-1, 10), {}, "M is -1"),
        ((math.nan, 10), {}, "M is nan"),
        ((1e6, 10), {}, r"M is 1000000.0; it must lie in"),
        ((100, 50), {}, r"L is 50.0; it must lie in 0\.\.30"),
        ((100, -1), {}, "L is -1"),
        ((100, 10, 2.0), {}, "D is 2.0"),
        ((100, 10), {"viscosity": "newton"}, "viscosity is 'newton'"),
        ((100, 10), {"density": 1.0}, "density is 1.0"),
        ((100, 10), {"grid": 64}, "grid is 64.*65"),
        ((100, 10), {"grid": "fine"}, "grid is 'fine'"),
        ((2000, 10), {"grid": 17}, r"grid is 17; too coarse.*give \d+ or more"),
        ((100, 10), {"accuracy": 0.0}, "accuracy is 0.0"),
        ((20000, 0), {"accuracy": 1e-3}, r"accuracy is 0.001; needs some .* nodes"),
        ((100, 10), {"inlet": 1.0}, "inlet is 1.0"),
        ((100, 10), {"eta0": 1e-6}, "eta0 is 1e-06"),
    ],
)
def test_bad_input_is_named(arguments: tuple[float, ...], options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ehl.steady(*arguments, **options)  # type: ignore[arg-type]
