"""Motions of layers whose moduli have changed (csrc/changed_layers.c) against NumPy's dense solutions."""

import numpy as np
import pytest

from bearingdyn import core


def layers(ranks, seed, entries=7, frequencies=3):
    """Receptances, frequencies of the entries, motions, changes, slopes and ends."""
    rng = np.random.default_rng(seed)

    def complex_numbers(*shape):
        return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)

    r, count = sum(ranks), len(ranks)
    return (
        complex_numbers(frequencies, r, r),
        rng.integers(0, frequencies, entries),
        complex_numbers(entries, r),
        complex_numbers(entries, count),
        complex_numbers(entries, count),
        np.cumsum(ranks).tolist(),
    )


def solved(R, which, alone, change, ranks):
    d = np.repeat(2 * change, ranks, axis=1)
    return np.linalg.solve(np.eye(R.shape[1]) + R[which] * d[:, None, :], alone[..., None])[..., 0]


@pytest.mark.parametrize("ranks", [[1], [6], [8], [11, 11], [3, 6, 1], [0, 5]])
def test_motions_are_the_dense_solution_and_derivatives_its_differences(ranks):
    R, which, alone, change, slope, end = layers(ranks, 1)
    y, moved = core.changed_layers(R, which, alone, change, slope, end)
    # conditions of some 1e3 leave 1e-12 of rounding
    assert y == pytest.approx(solved(R, which, alone, change, ranks), rel=1e-9, abs=1e-11)
    for layer in range(len(ranks)):
        h = np.zeros_like(change)
        h[:, layer] = 1e-5 * slope[:, layer]
        ahead, back = (solved(R, which, alone, change + s * h, ranks) for s in (1, -1))
        # central differences: 1e-10 of curvature, 1e-11 of rounding over 1e-5, times the size
        size = np.abs(moved[:, layer]).max() + np.abs(y).max()
        assert moved[:, layer] == pytest.approx((ahead - back) / 2e-5, abs=1e-6 * size)


@pytest.mark.parametrize("isa", ["avx2", "avx512", "best"])
def test_every_instruction_set_gives_the_same_bits(isa):
    given = layers([11, 6], 4)
    try:
        found = core.changed_layers(*given, isa)
    except ValueError:
        pytest.skip(f"this machine has no {isa}")
    for a, b in zip(found, core.changed_layers(*given, "base"), strict=True):
        assert (a == b).all()


def test_receptances_are_read_where_they_lie():
    """The part of a larger response that the layers' coordinates are."""
    R, which, alone, change, slope, end = layers([4, 5], 2)
    whole = np.zeros((3, 12, 11), dtype=complex)
    whole[:, 3:, 2:] = R
    found = core.changed_layers(whole[:, 3:, 2:], which, alone, change, slope, end)
    turned = core.changed_layers(
        np.swapaxes(np.swapaxes(R, 1, 2).copy(), 1, 2), which, alone, change, slope, end
    )
    for a, b, c in zip(found, core.changed_layers(R, which, alone, change, slope, end), turned, strict=True):
        assert (a == b).all()
        assert (a == c).all()


def test_rows_are_exchanged_where_the_first_pivot_vanishes():
    R = np.array([[[-0.5, 1.0], [1.0, 3.0]]], dtype=complex)  # 1 + 2 R00 = 0
    y, _ = core.changed_layers(R, [0], np.array([[1.0, 2.0]], complex), [[1.0]], [[0.0]], [2])
    # [[0, 2], [2, 7]] y = [1, 2]
    assert y[0] == pytest.approx([-0.75, 0.5])


def test_a_singular_change_is_said():
    R = np.full((1, 1, 1), -0.5 + 0j)
    with pytest.raises(ArithmeticError, match="singular"):
        core.changed_layers(R, [0], np.ones((1, 1), complex), [[1.0]], [[0.0]], [1])


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"which": [3] * 7}, r"which\[0\] names a frequency outside 0\.\.\.2"),
        ({"end": [4, 8]}, "end must rise"),
        ({"end": [5, 4, 9]}, "change"),
        ({"R": np.zeros((3, 9, 8), complex)}, "receptance must be"),
        ({"R": np.zeros((3, 9, 9))}, "receptance must be"),
        ({"isa": "none"}, "isa"),
    ],
)
def test_what_does_not_fit_is_refused(bad, message):
    R, which, alone, change, slope, end = layers([4, 5], 3)
    given = {"R": R, "which": which, "alone": alone, "change": change, "slope": slope, "end": end} | bad
    with pytest.raises(ValueError, match=message):
        core.changed_layers(*given.values())
