"""Cleaning, shifting and shift laws: what is measured, what is set by hand, what is refused."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import make_sample_dma as made
from bearingdyn.material import (
    WLF,
    Arrhenius,
    DMAData,
    Joined,
    Maxwell,
    RhoT,
    fit_maxwell,
    kk_ratio,
    master_curve,
    read_dma,
    sample_dma_path,
    suspects,
)
from bearingdyn.notice import LeftOut, TensionAsShear, ThinIsotherm
from measured import DATA, measured, shift_table


@pytest.fixture(scope="module")
def sample():
    """The shipped, made measurement."""
    return read_dma(sample_dma_path())


# ---------------------------------------------------------------- cleaning


def test_ratio_of_a_lone_relaxation():
    """G″/((π/2) dG′/d ln ω) = (1 + x²)/(πx), x = ωτ, of one branch; the parabola smooths over a decade."""
    f = np.logspace(-3, 3, 241)
    x = 2 * np.pi * f * 0.1
    spring = 1e7  # a large one, so that ln G′ is a parabola to 1 %
    storage, loss = spring + 1e5 * x**2 / (1 + x**2), 1e5 * x / (1 + x**2)
    ratio = kk_ratio(DMAData(f, 20 + 0 * f, storage, loss, "shear"))
    near = (x > 0.5) & (x < 2.0)
    # half a decade to each side flattens the slope at its peak by some 10 %
    np.testing.assert_allclose(ratio[near], ((1 + x**2) / (np.pi * x))[near], rtol=0.2)
    far = (x > 1e-2) & (x < 3e-2)
    assert (ratio[far] > 5).all()  # a passive material may be far from one


def test_fixture_resonance_is_found_where_the_readme_says():
    """epdm70 above 20 Hz, adhesive at 46 and 100 Hz; nothing of the made material."""
    _, found = suspects(measured("epdm70"))
    assert {s.reason for s in found} == {"fixture resonance"}
    assert 20.0 < min(s.frequency for s in found) < 40.0
    _, found = suspects(measured("adhesive"))
    assert {round(s.frequency) for s in found} == {46, 100}
    assert suspects(read_dma(sample_dma_path()))[1] == ()


def test_suspect_points_are_left_out_listed_and_can_be_kept():
    """By default out, with a warning that counts; clean=False keeps them all."""
    dma = measured("epdm70")
    with pytest.warns(LeftOut, match="left out that no passive material could give: .*fixture resonance"):
        master = master_curve(dma)
    assert master.frequency.size + len(master.left_out) == dma.frequency.size
    assert all(s.ratio > 0 or np.isnan(s.ratio) for s in master.left_out)
    kept = master_curve(dma, clean=False)
    assert (kept.frequency.size, kept.left_out) == (dma.frequency.size, ())
    assert sum(master.kk_residual) < sum(kept.kk_residual)


def test_negative_moduli_are_flagged_never_fitted(sample):
    """Whether cleaned or not, with a warning."""
    loss = sample.loss.copy()
    loss[[3, 40]] *= -1
    dma = replace(sample, loss=loss)
    for clean in (True, False):
        with pytest.warns(LeftOut, match="2 of 135 points left out.*2 for negative modulus"):
            master = master_curve(dma, clean=clean)
        assert [s.reason for s in master.left_out] == ["negative modulus"] * 2
    with pytest.raises(ValueError, match="no point has positive moduli"):
        master_curve(replace(sample, loss=-sample.loss))


# ---------------------------------------------------------------- measured materials


@pytest.fixture(scope="module")
def glassy():
    """Master curve of the glassy polymer, all points."""
    return master_curve(measured("glassy_polymer"), T_ref=90.0, law="free", clean=False)


def test_glassy_polymer_superposes_through_its_transition(glassy):
    """All points; the misfit of the published shifts on the same measure is 0.041/0.071."""
    master = glassy
    assert master.frequency.size == 1320
    assert master.kk_residual[0] <= 0.045
    assert master.kk_residual[1] <= 0.077
    assert master.smoothness > 0  # the prior was needed
    assert (np.diff(shift_table(master)[1]) < 0).all()


def test_glassy_shifts_are_the_published_ones_where_those_are_smooth(glassy):
    """Within 0.3 decade at 0 to 40 and 65 to 105 °C.

    Between 40 and 65 °C the published steps run 1.52, 1.36, 0.84, 1.24, 1.44 decades per 5 K, where a curve
    between its neighbours needs about 1.6: 1.5 decades in all, of which the moduli, flat there, say little.
    """
    path = DATA / "glassy_polymer" / "published_shifts.csv"
    nominal, published = np.genfromtxt(path, delimiter=",", skip_header=1).T
    difference = shift_table(glassy)[1] - published
    smooth = (nominal <= 40) | (nominal >= 65)
    middle = (difference[smooth].max() + difference[smooth].min()) / 2  # they share no reference
    assert np.abs(difference - middle)[smooth].max() <= 0.3
    step = np.diff(published)
    assert np.abs(np.diff(step)[9:12]).max() > 0.3 > np.abs(np.diff(step)[:7]).max()  # what is not smooth


def test_adhesive_superposes():
    """All points up to 30 Hz, none dropped, through −50 to 100 °C."""
    master = master_curve(measured("adhesive").select(f_max=30.0), T_ref=80.0, law="free", clean=False)
    assert master.kk_residual[0] <= 0.030
    assert master.kk_residual[1] <= 0.035
    assert (np.diff(shift_table(master)[1]) < 0).all()


def test_same_input_same_output_bit_for_bit(sample):
    """Shifts, curve and fit."""
    first, second = (master_curve(sample) for _ in range(2))
    assert first.shifts == second.shifts
    assert first.frequency.tobytes() == second.frequency.tobytes()
    a, b = (fit_maxwell(m, "auto", K=2e9, density=1e3, bootstrap=3) for m in (first, second))
    assert a == b
    assert a.fit.bootstrap.tobytes() == b.fit.bootstrap.tobytes()


# ---------------------------------------------------------------- by hand, vertical, laws


def test_shifts_by_hand_are_kept_or_refined(sample):
    """Some held: those stay to the bit and the rest follow; all held: none moves; refined: found again."""
    exact = {T: float(made.log_shift(T)) for T in made.TEMPERATURES}
    held = {T: exact[T] for T in (-20.0, 20.0, 60.0)}
    some = master_curve(sample, shifts=held, refine=False)
    T, shifts = shift_table(some)
    for name, value in held.items():
        assert shifts[np.argmin(np.abs(T - name))] == value
    np.testing.assert_allclose(shifts, made.log_shift(T), atol=0.02)  # as the free ones
    every = master_curve(sample, shifts=exact, refine=False)
    assert shift_table(every)[1].tolist() == list(exact.values())
    wrong = {T: value + 0.3 * (-1) ** k for k, (T, value) in enumerate(exact.items())}
    np.testing.assert_allclose(
        shift_table(master_curve(sample, shifts=wrong))[1], made.log_shift(T), atol=0.02
    )
    with pytest.raises(ValueError, match=r"shifts: 33.0 °C names no isotherm"):
        master_curve(sample, shifts={33.0: 1.0})
    with pytest.raises(ValueError, match="must be a finite log10"):
        master_curve(sample, shifts={20.0: np.nan})


@pytest.mark.parametrize("offset", [1.0, 4.0])
@pytest.mark.parametrize("held", [(0, 1), (1, 2), (2, 3)])
def test_free_shifts_follow_those_set_by_hand(held, offset):
    """Two isotherms set decades off: the offset is anyone's choice, so all others move by it as well.

    Sweeps of a third of a decade hardly overlap: the others find their place only if they start near it.
    """
    sweep, T = np.logspace(0, 0.3, 3), np.array([-20.0, 0.0, 20.0, 40.0])
    f, temperature = np.tile(sweep, 4), np.repeat(T, 3)
    modulus = made.modulus(2 * np.pi * f * 10 ** made.log_shift(temperature))
    dma = DMAData(f, temperature, modulus.real, modulus.imag, "shear")
    exact = made.log_shift(T)
    by_hand = {T[k]: exact[k] + offset for k in held}
    _, found = shift_table(master_curve(dma, law="free", shifts=by_hand, refine=False))
    np.testing.assert_allclose(found, exact + offset, atol=0.02)  # what so little data tell


def test_vertical_shift_is_off_unless_asked_for():
    """Moduli proportional to ρT: rendered with it, not without; and the model carries it to other T."""
    f, T, _, _ = made.points(0, noise=0.0, jitter=0.0)
    shift = RhoT(20.0, 6e-4)
    modulus = made.modulus(2 * np.pi * f * 10 ** made.log_shift(T)) * shift.factor(T)
    dma = DMAData(f, T, modulus.real, modulus.imag, "shear")
    plain, master = master_curve(dma), master_curve(dma, vertical=shift)
    assert plain.vertical is None
    assert sum(master.kk_residual) < 0.3 * sum(plain.kk_residual)
    rubber = fit_maxwell(master, 5, K=2e9, density=1e3).at(60.0)
    omega = 2 * np.pi * 10.0
    exact = made.modulus(omega * 10 ** made.log_shift(60.0)) * shift.factor(60.0)
    assert complex(rubber.complex_modulus(omega)) == pytest.approx(complex(exact), rel=0.02)
    assert float(shift.factor(60.0)) == pytest.approx(333.15 / 293.15 / 1.024, rel=1e-14)
    assert master_curve(dma, vertical="rhoT").vertical == RhoT(20.0)


@pytest.mark.parametrize("source", ["shifts", "data"])
def test_laws_are_found_from_shifts_and_from_the_data(sample, source):
    """WLF constants within three standard errors either way, and the covariance is of a sensible size."""
    law = master_curve(sample, law_from=source).law
    assert isinstance(law, WLF)
    errors = np.sqrt(np.diag(law.covariance))
    assert abs(law.C1 - made.C1) < max(3 * errors[0], 0.02 * made.C1)
    assert abs(law.C2 - made.C2) < max(3 * errors[1], 0.02 * made.C2)
    assert (errors < 0.1 * np.array([made.C1, made.C2])).all()


@pytest.mark.parametrize("source", ["shifts", "data"])
def test_joined_law_is_found_again(source):
    """WLF above 10 °C, Arrhenius below, out of exact moduli."""
    exact = Joined(8.0, 60.0, 10.0, 1.2e5, 20.0)
    T = np.repeat(np.arange(-40.0, 71.0, 10.0), made.FREQUENCIES.size)
    f = np.tile(made.FREQUENCIES, 12)
    modulus = made.modulus(2 * np.pi * f * 10 ** exact.log_shift(T))
    master = master_curve(DMAData(f, T, modulus.real, modulus.imag, "shear"), law="joined", law_from=source)
    law = master.law
    assert isinstance(law, Joined)
    assert law.Tg == pytest.approx(10.0, abs=1.0)
    assert law.Ea == pytest.approx(1.2e5, rel=0.05)
    grid = np.linspace(-40, 70, 30)
    # shifts are good to some 0.01 decade (the density of the spectrum inside)
    np.testing.assert_allclose(law.log_shift(grid), exact.log_shift(grid), atol=0.03)


def test_joined_law_is_continuous_and_made_of_its_halves():
    """Either side of Tg it is the plain law, and zero at T_ref."""
    law = Joined(17.44, 51.6, 0.0, 2e5, 30.0)
    above = WLF(17.44, 51.6, 0.0)
    below = Arrhenius(2e5, 0.0)
    offset = above.log_shift(30.0)
    np.testing.assert_allclose(
        law.log_shift([10.0, 50.0]), above.log_shift([10.0, 50.0]) - offset, rtol=1e-14
    )
    np.testing.assert_allclose(
        law.log_shift([-30.0, -5.0]), below.log_shift([-30.0, -5.0]) - offset, rtol=1e-14
    )
    assert float(law.log_shift(30.0)) == 0.0
    rubber = Maxwell(1e6, [1e6], [1.0], K=2e9, density=1e3, law=law, vertical=RhoT(30.0), band=(1.0, 10.0))
    twin = Maxwell.from_json(rubber.to_json())
    assert (twin, twin.law, twin.vertical, twin.band) == (rubber, law, rubber.vertical, (1.0, 10.0))


def test_tension_is_converted_only_when_asked():
    """G* = 3KE*/(9K − E*) by K, E*/2(1 + ν) by ν; both refused together, or twice."""
    K = 2e9
    f = np.logspace(0, 2, 5)
    G = 1e6 + 1e5j * f
    E = 9 * K * G / (3 * K + G)
    dma = DMAData(f, 20 + 0 * f, E.real, E.imag, "tension")
    shear = dma.to_shear(K=K)
    np.testing.assert_allclose(shear.storage + 1j * shear.loss, G, rtol=1e-14)
    assert (shear.mode, shear.K, dma.mode) == ("shear", K, "tension")
    assert "K = 2e+09 Pa" in shear.notes[-1]
    np.testing.assert_allclose(dma.to_shear(nu=0.5).storage, E.real / 3, rtol=1e-15)
    for wrong in ({}, {"K": K, "nu": 0.5}, {"nu": 0.6}, {"K": -1.0}, {"K": 1e5}):
        with pytest.raises(ValueError, match=r"to_shear|nu is |K is "):
            dma.to_shear(**wrong)
    with pytest.raises(ValueError, match="only a measurement in tension"):
        shear.to_shear(K=K)


def test_curve_in_shear_keeps_the_bulk_modulus_it_was_made_with(sample):
    """A model with another K would not be the material measured."""
    tension = replace(sample, storage=3 * sample.storage, loss=3 * sample.loss, mode="tension")
    master = master_curve(tension)
    with pytest.warns(TensionAsShear, match="tension turned into shear by 3KE"):
        loud = fit_maxwell(master, 5, K=2e9, density=1e3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert fit_maxwell(master.to_shear(K=2e9), 5, K=2e9, density=1e3) == loud
    with pytest.raises(ValueError, match="both must be the same"):
        fit_maxwell(master.to_shear(K=2e9), 5, K=3e9, density=1e3)


def test_bad_measurements_are_refused_or_warned_of(sample):
    """One frequency, two isotherms at one temperature, one point in an isotherm, impossible options."""
    with pytest.raises(ValueError, match="one frequency per isotherm"):
        master_curve(sample.select(f_min=0.09, f_max=0.11))
    label = np.where(sample.frequency < 2, 2 * sample.labels, 2 * sample.labels + 1)
    T = sample.isotherm_temperatures[sample.labels]
    with pytest.raises(ValueError, match="two isotherms at"):
        master_curve(replace(sample, temperature=T, isotherm=label))
    keep = (sample.labels != 4) | (sample.frequency < 0.11)
    with pytest.warns(ThinIsotherm, match="one frequency only at 20"):
        master_curve(sample.take(np.flatnonzero(keep)))
    for change in ({"law_from": "guess"}, {"law": "free", "law_from": "data"}, {"smoothness": -1.0}):
        with pytest.raises(ValueError, match=r"law_from|smoothness"):
            master_curve(sample, **change)
    with pytest.raises(ValueError, match="its T_ref must be"):
        master_curve(sample, vertical=RhoT(25.0))
