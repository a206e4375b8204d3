"""Master curves and Maxwell fits: made materials found again, measured ones rendered."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.optimize import nnls

import make_sample_dma as made
from bearingdyn.material import (
    WLF,
    Arrhenius,
    DMAData,
    MasterCurve,
    ShiftTable,
    fit_maxwell,
    master_curve,
    read_dma,
    sample_dma_path,
)
from bearingdyn.notice import OutsideBand, PoorLaw
from measured import DATA, measured, shift_table


@pytest.fixture(scope="module")
def sample_master():
    """Master curve of the shipped sample."""
    return master_curve(read_dma(sample_dma_path()), T_ref=20.0)


@pytest.fixture(scope="module")
def epdm_master():
    """Master curve of the measured rubber, points above 20 Hz left out: a fixture's resonance (its
    README)."""
    return master_curve(measured("epdm70").select(f_max=20.0), T_ref=20.0)


def test_made_material_is_found_again(sample_master):
    """Five branches, nine isotherms, 1 % noise: shifts within 0.02 decade, fit within 1.5 % rms.

    1 % on either modulus is 1.4 % on tan δ and, over the slope of about 0.3 per decade of ln G′ and 15
    points, some 0.01 decade on a shift.
    """
    T, shifts = shift_table(sample_master)
    np.testing.assert_allclose(shifts, made.log_shift(T), atol=0.02)
    assert max(sample_master.kk_residual) < 0.015  # the noise, and that the data are causal
    rubber = fit_maxwell(sample_master, n=5, K=2e9, density=1200.0)
    assert rubber.fit.storage_rms < 0.015
    assert rubber.fit.tan_delta_rms < 0.015
    np.testing.assert_allclose(rubber.tau, made.TAU, rtol=0.1)  # 0.02 decade of shift is 5 %, and the noise
    np.testing.assert_allclose(rubber.G, made.G, rtol=0.05)
    omega = 2 * np.pi * np.logspace(-2, 5, 50)
    np.testing.assert_allclose(rubber.complex_modulus(omega), made.modulus(omega), rtol=0.03)


def test_noise_free_material_is_found_exactly():
    """Without noise or jitter the shifts are limited only by the density of the spectrum inside."""
    f, T, storage, loss = made.points(0, noise=0.0, jitter=0.0)
    master = master_curve(DMAData(f, T, storage, loss, "shear"))
    T, shifts = shift_table(master)
    np.testing.assert_allclose(
        shifts, made.log_shift(T), atol=4e-3
    )  # a twentieth of the spacing of the times
    assert max(master.kk_residual) < 2e-3
    # the model itself is in reach of the fit: what is left is the error of the shifts, 4e-3 decade or 1 %
    rubber = fit_maxwell(master, n=5, K=2e9, density=1200.0)
    np.testing.assert_allclose(rubber.tau, made.TAU, rtol=0.02)


def test_drift_within_an_isotherm_is_taken_into_account():
    """Points whose temperature drifts by 1 K are placed by their own temperature."""
    f, T, _, _ = made.points(0, noise=0.0, jitter=0.0)
    T = T + np.tile(np.linspace(-0.5, 0.5, made.FREQUENCIES.size), made.TEMPERATURES.size)
    modulus = made.modulus(2 * np.pi * f * 10 ** made.log_shift(T))
    master = master_curve(DMAData(f, T, modulus.real, modulus.imag, "shear"))
    assert max(master.kk_residual) < 5e-3  # uncorrected: 1 K is 0.1 decade at −20 °C, 3 % of G′
    T, shifts = shift_table(master)
    np.testing.assert_allclose(shifts, made.log_shift(T), atol=0.01)


def test_reference_temperature_need_not_be_measured(sample_master):
    """Moving T_ref moves the curve by the law, points and moduli staying."""
    moved = master_curve(read_dma(sample_dma_path()), T_ref=33.0)
    factor = moved.frequency / sample_master.frequency
    np.testing.assert_allclose(np.log10(factor), -made.log_shift(33.0), atol=0.02)
    assert float(moved.law.log_shift(33.0)) == 0.0
    np.testing.assert_array_equal(moved.storage, sample_master.storage)


def test_laws(sample_master):
    """WLF constants within three standard errors; the free table reproduces its shifts; Arrhenius finds
    its energy."""
    law = sample_master.law
    assert isinstance(law, WLF)
    C1, C2 = np.sqrt(np.diag(law.covariance))
    assert abs(law.C1 - made.C1) < max(3 * C1, 0.02 * made.C1)
    assert abs(law.C2 - made.C2) < max(3 * C2, 0.02 * made.C2)
    free = master_curve(read_dma(sample_dma_path()), law="free")
    assert isinstance(free.law, ShiftTable)
    T, shifts = shift_table(free)
    np.testing.assert_allclose(free.law.log_shift(T), shifts, atol=1e-12)
    energy = 1.2e5
    T = np.repeat([0.0, 20.0, 40.0, 60.0], 15)
    f = np.tile(made.FREQUENCIES, 4)
    aT = np.exp(energy / 8.31446261815324 * (1 / (T + 273.15) - 1 / 293.15))
    modulus = made.modulus(2 * np.pi * f * aT)
    arrhenius = master_curve(DMAData(f, T, modulus.real, modulus.imag, "shear"), law="arrhenius").law
    assert isinstance(arrhenius, Arrhenius)
    assert arrhenius.Ea == pytest.approx(energy, rel=0.01)  # 0.01 decade over 4


def test_measured_rubber_superposes(epdm_master):
    """All points up to 20 Hz within 1.2 % of G′ and 3.2 % of G″ of one causal spectrum."""
    storage, loss = epdm_master.kk_residual
    assert storage < 0.012
    assert loss < 0.032
    _, shifts = shift_table(epdm_master)
    assert (np.diff(shifts) < 0).all()  # hotter is softer


def test_five_branches_render_the_measured_rubber_over_four_decades(epdm_master):
    """10 Hz to 100 kHz at 20 °C: tan δ within 4 % rms and 12 % at worst; the points alone scatter by 3 %."""
    with pytest.warns(OutsideBand, match="beyond the master curve"):
        rubber = fit_maxwell(epdm_master, n=5, band=(10.0, 1e5), K=2e9, density=1000.0)
    assert rubber.fit.tan_delta_rms < 0.04
    assert rubber.fit.tan_delta_max < 0.12
    assert rubber.fit.storage_rms < 0.02
    assert rubber.temperature == 20.0
    assert rubber.law == epdm_master.law
    assert (np.diff(rubber.tau) > 0).all()


def test_glassy_polymer_follows_wlf_above_its_transition():
    """Shifts from 82 to 104 °C as published beside the data, and on a WLF curve to 0.02 decade."""
    published = DATA / "glassy_polymer" / "published_shifts.csv"
    master = master_curve(measured("glassy_polymer").select(T=(80.0, 110.0)), T_ref=90.0)
    nominal, expected = np.genfromtxt(published, delimiter=",", skip_header=1)[-5:].T
    assert nominal[0] == 85.0
    _, shifts = shift_table(master)
    # the sample drifts by up to 1 K within an isotherm, which shifts by 0.2 decade/K: half a kelvin
    np.testing.assert_allclose(shifts - shifts[-1], expected - expected[-1], atol=0.1)
    assert master.law_residual < 0.02


def test_wlf_does_not_hold_through_a_glass_transition():
    """From −50 to 100 °C the shifts still fall with temperature, and the poor law is reported."""
    with pytest.warns(PoorLaw, match="deviate from the wlf law"):
        master = master_curve(measured("adhesive").select(f_max=30.0), T_ref=80.0)
    _, shifts = shift_table(master)
    assert (np.diff(shifts) < 0).all()
    assert np.isfinite(master.frequency).all()


def equispaced_error(master, n):
    """rms of the deviations of ln G′ and ln tan δ of strengths by NNLS at times equispaced over the data."""
    omega = 2 * np.pi * master.frequency
    tau = np.logspace(*np.log10([1 / omega.max(), 1 / omega.min()]), n)
    x = omega[:, None] * tau
    unit = np.hstack([np.ones((omega.size, 1)), 1j * x / (1 + 1j * x), 1j * omega[:, None]])
    A = np.vstack([unit.real / master.storage[:, None], unit.imag / master.loss[:, None]])
    length = np.linalg.norm(A, axis=0)
    modulus = unit @ (nnls(A / length, np.ones(A.shape[0]))[0] / length)
    error = [np.log(modulus.real / master.storage), np.log(modulus.imag / modulus.real / master.tan_delta)]
    return np.sqrt(np.mean(np.square(error)))


@pytest.mark.parametrize("n", [3, 5, 7])
def test_free_times_beat_equispaced_ones(sample_master, n):
    """Searching the times pays: at least a third off the error of a non-negative fit at equispaced times."""
    fit = fit_maxwell(sample_master, n=n, K=2e9, density=1200.0).fit
    error = np.sqrt((fit.storage_rms**2 + fit.tan_delta_rms**2) / 2)
    assert error < 0.67 * equispaced_error(sample_master, n)


def test_fit_is_deterministic_and_reports_its_covariance(sample_master):
    """The same twice; covariance symmetric, of the size the noise gives, names in its order."""
    first = fit_maxwell(sample_master, n=5, K=2e9, density=1200.0)
    assert first == fit_maxwell(sample_master, n=5, K=2e9, density=1200.0)
    report = first.fit
    assert report.covariance.shape == (len(report.names),) * 2
    np.testing.assert_allclose(report.covariance, report.covariance.T, rtol=0, atol=1e-12)
    error = dict(zip(report.names, np.sqrt(np.diag(report.covariance)), strict=True))
    # 1 % noise, some tens of points to a branch, correlated with its neighbours: 0.2 % to 5 %
    assert 2e-3 < error["ln tau3"] < 0.05
    assert 1e-3 < error["ln G3"] < 0.05


def test_dashpot_is_found_or_left_out():
    """A Kelvin–Voigt dashpot beside one branch is recovered; forbidden, it is zero."""
    f = np.logspace(0, 4, 60)
    omega = 2 * np.pi * f
    modulus = 1e6 + 100j * omega + 2e6 / (1 + 1 / (1j * omega * 1e-2))
    table = ShiftTable((0.0, 40.0), (1.0, -1.0), 20.0)
    master = MasterCurve(
        f, modulus.real, modulus.imag, 20 + 0 * f, "shear", 20.0, {}, {}, table, 0.0, (0.0, 0.0)
    )
    found = fit_maxwell(master, n=1, K=2e9, density=1200.0)
    # exact data: what is left is the optimiser's tolerance
    np.testing.assert_allclose(
        [found.G0, found.G[0], found.tau[0], found.eta0], [1e6, 2e6, 1e-2, 100.0], rtol=1e-5
    )
    assert fit_maxwell(master, n=1, K=2e9, density=1200.0, dashpot=False).eta0 == 0.0
    with pytest.raises(ValueError, match="reaches from 1 to 1e"):
        fit_maxwell(master, n=5, band=(1e5, 1e6), K=2e9, density=1200.0)


def test_tension_becomes_shear():
    """E* = 9KG*/(3K + G*) put in, G* got out."""
    K, f = 2e9, np.logspace(-2, 5, 80)
    shear = made.modulus(2 * np.pi * f)
    tension = 9 * K * shear / (3 * K + shear)
    table = ShiftTable((0.0, 40.0), (1.0, -1.0), 20.0)
    master = MasterCurve(
        f, tension.real, tension.imag, 20 + 0 * f, "tension", 20.0, {}, {}, table, 0.0, (0.0, 0.0)
    )
    found = fit_maxwell(master, n=5, K=K, density=1200.0)
    np.testing.assert_allclose(
        found.complex_modulus(2 * np.pi * f), shear, rtol=1e-4
    )  # optimiser's tolerance


def test_bad_requests_are_refused(sample_master):
    """Messages naming the field, the value and what would be right."""
    dma = read_dma(sample_dma_path())
    with pytest.raises(ValueError, match="law is 'vft'"):
        master_curve(dma, law="vft")
    with pytest.raises(ValueError, match="T_ref is nan"):
        master_curve(dma, T_ref=np.nan)
    with pytest.raises(ValueError, match="one isotherm only"):
        master_curve(dma.select(T=(15.0, 25.0)))
    with pytest.raises(ValueError, match="the data 2 isotherms"):
        master_curve(dma.select(T=(5.0, 25.0)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that T_ref is outside
        with pytest.raises(ValueError, match="free shifts are known"):
            master_curve(dma, T_ref=90.0, law="free")
    for change, message in (
        ({"n": 0}, "n is 0"),
        ({"band": (10.0, 1.0)}, "must be a lower and a higher frequency"),
        ({"K": np.nan}, "K is nan"),
        ({"density": 0.0}, "density is 0.0"),
    ):
        with pytest.raises(ValueError, match=message):
            fit_maxwell(sample_master, **({"K": 2e9, "density": 1200.0} | change))
