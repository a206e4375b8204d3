"""Deflection, Reynolds' equation and its Jacobian, on grids of their own."""

from __future__ import annotations

import numpy as np
import pytest

from bearingdyn.bearing.ehl.deflection import Deflection
from bearingdyn.bearing.ehl.dimensionless_groups import Groups, scales
from bearingdyn.bearing.ehl.grid import Grid
from bearingdyn.bearing.ehl.linearised import gmres
from bearingdyn.bearing.ehl.oil import Oil
from bearingdyn.bearing.ehl.reynolds import Reynolds, log_mean
from bearingdyn.bearing.hertz import PointContact


def grid_of(groups: Groups, n: int) -> Grid:
    return Grid(2 * n + 1, n + 1, n, 1.5 / n, 1.5 / n)


@pytest.mark.parametrize("D", [1.0, 0.2, 0.03])
def test_hertz_pressure_makes_both_bodies_touch_all_over_the_ellipse(D: float) -> None:
    groups = Groups(100.0, 10.0, D)
    gaps = []
    for n in (30, 60):
        grid = grid_of(groups, n)
        r2 = grid.X**2 + grid.Y[:, None] ** 2
        P = np.sqrt(np.maximum(0, 1 - r2))
        shape = grid.X**2 / 2 + groups.curvature * grid.Y[:, None] ** 2 / 2
        H = shape + Deflection(grid, groups)(P) - groups.approach
        gaps.append(np.abs(H[r2 < 0.8]).max())
        outside = [H[0, i] for i in (-1,)] + [H[-1, n]]
        exact = [groups.dry_gap(X=1.5), groups.dry_gap(Y=1.5)]
        # the square root at the ellipse's edge is sampled: an error of pitch^1.5
        assert np.allclose(outside, exact, rtol=0, atol=3e-3 * (30 / n) ** 1.4 * groups.approach)
    assert gaps[1] < 2e-3
    assert gaps[1] < gaps[0] / 2


def test_dry_gap_of_a_circular_contact_is_the_closed_form() -> None:
    groups = Groups(100.0, 10.0, 1.0)
    X = 2.5
    exact = (np.sqrt(X**2 - 1) + (X**2 - 2) * np.arccos(1 / X)) / np.pi  # K. L. Johnson, Contact Mechanics
    assert groups.dry_gap(X=X) == pytest.approx(exact, rel=1e-12)
    assert groups.dry_gap(Y=X) == pytest.approx(exact, rel=1e-12)
    assert groups.dry_gap(X=groups.reach(2.0, along=True)) == pytest.approx(2.0, rel=1e-10)


def test_deflection_by_fft_is_the_sum_over_the_whole_contact() -> None:
    groups = Groups(100.0, 10.0, 0.2)
    grid = Grid(11, 6, 6, 0.3, 0.2)
    P = np.random.default_rng(1).random(grid.shape)
    deflection = Deflection(grid, groups)
    summed = np.zeros(grid.shape)
    whole = np.concatenate([P[:0:-1], P])
    unit = np.array([[_influence(grid, groups, i, j) for j in range(11)] for i in range(11)])
    for j in range(6):
        for i in range(11):
            for jj in range(-5, 6):
                for ii in range(11):
                    summed[j, i] += whole[jj + 5, ii] * unit[abs(i - ii), abs(j - jj)]
    assert np.allclose(deflection(P), summed, rtol=1e-12, atol=0)


def _influence(grid: Grid, groups: Groups, i: int, j: int) -> float:
    """∫∫ dx dy/r over a cell: Gauss points where it is smooth, the closed form on the cell itself."""
    a, b = grid.dx, grid.dy / groups.k
    if i == j == 0:
        # 4 triangles: 2[a asinh(b/a) + b asinh(a/b)]
        return groups.compliance * 2 * (a * np.arcsinh(b / a) + b * np.arcsinh(a / b))
    t, w = np.polynomial.legendre.leggauss(60)
    x, y = a * (i + t / 2), b * (j + t / 2)
    return groups.compliance * float((w[:, None] * w / np.hypot(x[:, None], y)).sum() * a * b / 4)


@pytest.mark.parametrize("laws", [("roelands", "dowson-higginson"), ("barus", "incompressible")])
def test_jacobian_is_the_derivative_of_the_residual(laws: tuple[str, str]) -> None:
    groups = Groups(100.0, 10.0, 0.5)
    grid = Grid(24, 12, 14, 0.15, 0.12)
    equations = Reynolds(grid, groups, Oil(*laws, groups.piezo, 2.2e-8, 0.04))
    rng = np.random.default_rng(0)
    P = np.where(grid.inner, rng.random(grid.shape), 0.0) * 0.3
    H = 0.1 + rng.random(grid.shape)
    p, h = rng.standard_normal((2, *grid.shape)) * np.stack([grid.inner * P, H])
    by_P, by_H = equations.jacobian(P, H, 0.7)

    def full(P: np.ndarray, H: np.ndarray) -> np.ndarray:
        return (equations.residual(P, H) + 0.7 * equations.carried(P, H))[grid.inner]

    step = 1e-6
    for matrix, direction, ends in (
        (by_P, p, [full(P + s * step * p, H) for s in (1, -1)]),
        (by_H, h, [full(P, H + s * step * h) for s in (1, -1)]),
    ):
        numeric = (ends[0] - ends[1]) / (2 * step)
        exact = (matrix @ direction.ravel()).reshape(grid.shape)[grid.inner]
        assert np.abs(numeric - exact).max() < 1e-7 * np.abs(exact).max()


def test_logarithmic_mean_is_exact_for_an_exponential_fluidity() -> None:
    # ∫ e^{−cp} dp over the face over its pressure drop
    c, p = 7.0, np.array([0.2, 0.9])
    mean, _, _ = log_mean(-c * p[1:], -c * p[:1])
    assert mean[0] == pytest.approx((np.exp(-c * p[0]) - np.exp(-c * p[1])) / (c * (p[1] - p[0])), rel=1e-13)
    for t in (1e-3 * (1 - 1e-9), 1e-3 * (1 + 1e-9)):  # either side of the series
        mean, by_a, by_b = log_mean(np.array([t]), np.array([0.0]))
        assert mean[0] == pytest.approx(np.expm1(t) / t, rel=1e-12)
        assert by_a[0] + by_b[0] == pytest.approx(mean[0], rel=1e-9)


@pytest.mark.parametrize("dtype", [float, complex])
def test_gmres_solves(dtype: type) -> None:
    rng = np.random.default_rng(2)
    A = (
        np.eye(30, dtype=dtype) * 4
        + rng.standard_normal((30, 30)) * (1 + (1j if dtype is complex else 0)) / 6
    )
    b = rng.standard_normal(30).astype(dtype)
    x, _ = gmres(lambda v: A @ v, lambda v: v / 4, b, 1e-12)
    assert np.linalg.norm(A @ x - b) < 1e-11 * np.linalg.norm(b)
    with pytest.raises(ArithmeticError, match="3 iterations"):
        gmres(lambda v: A @ v, lambda v: v / 4, b, 1e-12, limit=3)


def test_groups_follow_from_the_contact_in_metres() -> None:
    contact = PointContact(Rx=2.5e-3, Ry=0.05, modulus=1.1e11)
    F, us, eta0, alpha = 40.0, 3.0, 0.03, 2e-8
    M, L, D = scales(contact, F, us, eta0, alpha)
    groups = Groups(M, L, D)
    b, a = contact.semi_axes(F)
    assert groups.k == pytest.approx(a / b, rel=1e-12)
    assert groups.piezo == pytest.approx(alpha * contact.pressure(F), rel=1e-12)
    assert groups.speed == pytest.approx(6 * eta0 * us * 2.5e-3**2 / (a**3 * contact.pressure(F)), rel=1e-12)
    assert groups.approach == pytest.approx(contact.approach(F) * 2.5e-3 / a**2, rel=1e-12)
    moes = a**2 / 2.5e-3 / (2.5e-3 * np.sqrt(eta0 * us / (2 * 1.1e11 * 2.5e-3)))
    assert groups.moes == pytest.approx(moes, rel=1e-12)
