"""Maxwell fits with bounds, of any number of branches; other moduli; creep; exports."""

from __future__ import annotations

import math
import re
import warnings
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import make_sample_dma as made
from bearingdyn.material import (
    WLF,
    Arrhenius,
    DMAData,
    FractionalZener,
    MasterCurve,
    Maxwell,
    OutsideBand,
    PowerLaw,
    RelaxationData,
    ShiftTable,
    TabulatedModulus,
    fit_dense,
    fit_maxwell,
    master_curve,
    read_dma,
    sample_dma_path,
    to_abaqus_frequency,
    to_abaqus_prony,
    to_ansys,
    to_calculix,
)
from bearingdyn.notice import BeyondData, FewerBranches
from measured import DATA

SOLID = {"K": 2e9, "density": 1200.0}


@pytest.fixture(scope="module")
def master():
    """Master curve of the made material."""
    return master_curve(read_dma(sample_dma_path()))


# ---------------------------------------------------------------- fit


def test_branches_that_the_data_do_not_hold_are_said():
    """Data made from two branches: of eight asked for a few come out, in frequency and in time.

    Twins of nearly one relaxation time may stay, so that their number hangs on the arithmetic; what they
    make together is the material.
    """
    model = Maxwell(1e6, [2e6, 1e6], [1e-4, 1e-2], 0.0, **SOLID)
    f = np.geomspace(0.1, 1e5, 60)
    G = model.complex_modulus(2 * np.pi * f)
    data = DMAData(f, np.full(f.size, 20.0), G.real, G.imag, "shear")
    with pytest.warns(FewerBranches, match=r'n is 8, and the data hold [2-6] branches.*, or n="auto"'):
        found = fit_maxwell(data, n=8, dashpot=False, **SOLID)
    np.testing.assert_allclose(found.complex_modulus(2 * np.pi * f), G, rtol=1e-3)
    t = np.geomspace(1e-5, 10.0, 60)
    relaxed = RelaxationData.of(t, model.relaxation(t), np.full(t.size, 20.0), "shear")
    with pytest.warns(FewerBranches, match="n is 6, and the data hold"):
        fit_maxwell(relaxed, n=6, **SOLID)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fit_maxwell(data, n=2, dashpot=False, **SOLID)
        fit_maxwell(data, n="auto", dashpot=False, **SOLID)


def test_measured_rubber_in_five_branches():
    """Four decades around 1 kHz at 20 °C: tan δ 4 % rms, 12 % at most."""
    if not (DATA / "epdm70" / "dma.csv").exists():
        pytest.skip("measured data epdm70 are not here")
    curve = master_curve(read_dma(DATA / "epdm70" / "dma.csv").select(f_max=20.0), clean=False)
    with pytest.warns(OutsideBand, match="beyond the master curve"):
        rubber = fit_maxwell(curve, 5, (10.0, 1e5), **SOLID)
    assert curve.frequency.size == 170
    assert rubber.fit.tan_delta_rms <= 0.04
    assert rubber.fit.tan_delta_max <= 0.12


def test_auto_takes_the_fewest_branches_that_do(master):
    """One branch fewer is not good enough; the floor is a floor."""
    found = fit_maxwell(master, "auto", **SOLID)
    limit = [max(0.02, 1.2 * floor) for floor in found.fit.floor]
    assert found.fit.storage_rms <= limit[0]
    assert found.fit.tan_delta_rms <= limit[1]
    fewer = fit_maxwell(master, found.G.size - 1, **SOLID).fit
    assert fewer.storage_rms > limit[0] or fewer.tan_delta_rms > limit[1]
    many = fit_maxwell(master, 8, **SOLID).fit
    # the floor is linear in the deviations, so right to second order; its times are a grid
    assert math.hypot(many.storage_rms, many.tan_delta_rms) > 0.97 * math.hypot(*many.floor)


def test_fixed_values_and_bounds_hold(master):
    """G0 = 0 is allowed; a fixed time stays, to round-off; strengths keep their range."""
    fluid = fit_maxwell(master, 6, fixed={"G0": 0.0}, **SOLID)
    assert fluid.G0 == 0.0
    assert "ln G0" not in fluid.fit.names
    held = fit_maxwell(master, 5, fixed={"tau3": 2e-3, "eta0": 0.0}, bounds={"G0": (1.3e6, 2e6)}, **SOLID)
    assert np.min(np.abs(held.tau / 2e-3 - 1)) < 1e-14  # exp(ln τ)
    assert held.eta0 == 0.0
    assert 1.3e6 * (1 - 1e-12) <= held.G0 <= 2e6 * (1 + 1e-12)
    assert "ln tau3" not in held.fit.names
    exact = fit_maxwell(
        master, 1, fixed={"G0": 1e6, "G1": 2e6, "tau1": 1e-3, "eta0": 5.0}, **SOLID
    )  # nothing is left to fit
    assert (exact.G0, exact.eta0) == pytest.approx((1e6, 5.0), rel=1e-14)
    assert (exact.G[0], exact.tau[0]) == pytest.approx((2e6, 1e-3), rel=1e-14)
    for wrong in (
        {"G9": (0, 1)},
        {"G0": (2.0, 1.0)},
        {"tau1": (0.0, 0.0)},
        {"G1": (-1.0, 1.0)},
        {"G0": (1.0,)},
    ):
        with pytest.raises(ValueError, match="bounds"):
            fit_maxwell(master, 5, bounds=wrong, **SOLID)
    with pytest.raises(ValueError, match="both in bounds and in fixed"):
        fit_maxwell(master, 5, bounds={"G0": (0, 1e6)}, fixed={"G0": 0.0}, **SOLID)


def exact_curve(material, frequency):
    """Master curve of a material, without noise."""
    G = material.complex_modulus(2 * np.pi * frequency)
    law = ShiftTable((0.0, 40.0), (1.0, -1.0), 20.0)
    return MasterCurve(
        frequency, G.real, G.imag, 20 + 0 * frequency, "shear", 20.0, {}, {}, law, 0.0, (0.0, 0.0)
    )


def test_floor_knows_of_the_dashpot():
    """Of exact data made with a dashpot that is most of G″ at the top a dense spectrum leaves less than 1 %.

    Without the dashpot tan δ would miss by a factor of three and more.
    """
    lossy = Maxwell(1e6, [2e6], [1e-2], 100.0, **SOLID)
    omega = 2e4 * np.pi
    assert 100.0 * omega > 0.9 * complex(lossy.complex_modulus(omega)).imag
    floor = fit_maxwell(exact_curve(lossy, np.geomspace(1.0, 1e4, 60)), 1, **SOLID).fit.floor
    assert max(floor) < 0.01  # twelve times per decade


def test_a_time_may_be_bounded_below_the_band():
    """A branch far faster than the band acts as a dashpot G τ: with G known its time is found in (0, 1e-7].

    By itself the search goes a decade beyond the band, here to 1.6e-6 s.
    """
    fast = Maxwell(1e6, [1e8, 2e6], [5e-8, 1e-2], **SOLID)
    found = fit_maxwell(
        exact_curve(fast, np.geomspace(1.0, 1e4, 60)),
        2,
        bounds={"tau1": (0.0, 1e-7)},
        fixed={"G1": 1e8, "eta0": 0.0},
        **SOLID,
    )
    np.testing.assert_allclose(found.tau, fast.tau, rtol=1e-5)  # the optimiser's tolerance
    assert "ln tau1" in found.fit.names


def test_bootstrap_knows_of_isotherms(master):
    """As many refits as asked; standard errors of the size the noise gives, near those of the covariance."""
    report = fit_maxwell(master, 5, bootstrap=20, **SOLID).fit
    assert report.bootstrap.shape == (20, len(report.names))
    plain = np.sqrt(np.diag(report.covariance))
    drawn = np.array(list(report.standard_errors.values()))
    sure = plain < 0.1  # what the data determine
    # white noise: no correlation within isotherms, so the two agree but for 20 draws and uneven coverage
    ratio = np.median(drawn[sure] / plain[sure])
    assert 0.4 < ratio < 2.5
    with pytest.raises(ValueError, match="bootstrap is -1"):
        fit_maxwell(master, 5, bootstrap=-1, **SOLID)


def test_use_outside_the_band_warns_inside_and_at_rest_not(master):
    """The band moves with temperature; of rest, which lies below every band, the low end speaks instead."""
    rubber = fit_maxwell(master, 5, (1.0, 1e3), **SOLID)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rubber.complex_modulus([2 * np.pi, 2e3 * np.pi])
    with pytest.warns(BeyondData) as told:
        rubber.complex_modulus([0.0, 2 * np.pi, 2e3 * np.pi])
    assert [w.category for w in told] == [BeyondData]
    with pytest.warns(OutsideBand, match=r"1e.04 Hz lies outside the band .* 1 to 1000 Hz"):
        rubber.complex_modulus(2e4 * np.pi)
    warm = rubber.at(40.0)
    aT = float(10 ** rubber.law.log_shift(40.0))
    assert warm.band == pytest.approx((1 / aT, 1e3 / aT), rel=1e-12)


def test_dense_spectrum_renders_the_data_as_well_as_any(master):
    """No worse than eight free branches, but for the measure it minimises; its report says so."""
    dense = fit_dense(master, **SOLID)
    few = fit_maxwell(master, 8, **SOLID).fit
    assert dense.G.size > 8
    assert math.hypot(dense.fit.storage_rms, dense.fit.tan_delta_rms) < 1.03 * math.hypot(
        few.storage_rms, few.tan_delta_rms
    )
    tau, G = dense.spectrum()
    assert (np.diff(tau) > 0).all()
    assert G.size == dense.G.size


# ---------------------------------------------------------------- creep


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"eta0": 50.0},
        {"G0": 0.0},
        {"G0": 0.0, "eta0": 50.0},
        {"G": [], "tau": [], "eta0": 10.0},
        {"G0": 0.0, "G": [2e6], "tau": [0.1]},
        {"G": [1e6, 1e6, 0.0], "tau": [0.1, 0.1, 3.0]},
        {"G": [1e6, 1e-3], "tau": [0.1, 1.0]},
    ],
)
def test_creep_is_the_inverse_of_relaxation(change):
    """s²·L[J]·L[G] = 1 for the Laplace transforms, at a few s, by QUADPACK."""
    values = {"G0": 1e6, "G": [3e6, 1e6, 5e5], "tau": [1e-4, 1e-2, 1.0], "eta0": 0.0} | change
    m = Maxwell(**values, **SOLID)
    for s in (0.5, 30.0, 2e3):
        modulus = m.G0 + m.eta0 * s + float(np.sum(m.G * s * m.tau / (1 + s * m.tau)))
        edges = [0.0, 1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 60.0]
        J = sum(
            quad(lambda x, s=s: float(m.creep(x / s)) * math.exp(-x), a, b, epsrel=1e-10)[0]
            for a, b in pairwise(edges)
        )
        assert J * modulus == pytest.approx(1.0, rel=1e-8)  # the quadrature


def test_creep_has_the_closed_forms_of_simple_models():
    """Standard linear solid, Kelvin–Voigt, Maxwell element."""
    t = np.array([0.0, 1e-3, 0.1, 5.0])
    G0, G, tau = 1e6, 3e6, 0.01
    sls = Maxwell(G0, [G], [tau], **SOLID)
    slow = tau * (G0 + G) / G0
    np.testing.assert_allclose(sls.creep(t), 1 / G0 - (1 / G0 - 1 / (G0 + G)) * np.exp(-t / slow), rtol=1e-12)
    kelvin = Maxwell(G0, [], [], 1e4, **SOLID)
    np.testing.assert_allclose(kelvin.creep(t), (1 - np.exp(-t * G0 / 1e4)) / G0, rtol=1e-12, atol=1e-22)
    np.testing.assert_allclose(Maxwell(0.0, [G], [tau], **SOLID).creep(t), (1 + t / tau) / G, rtol=1e-12)
    with pytest.raises(ValueError, match="t >= 0"):
        sls.creep(-1.0)


# ---------------------------------------------------------------- other moduli


@pytest.mark.parametrize(
    "modulus",
    [
        PowerLaw(4e6, 0.2, 1e3, 2e9, 1200.0),
        FractionalZener(1e6, 1e8, 1e-4, 0.6, 2e9, 1200.0),
        TabulatedModulus([1.0, 10.0, 1e4], [1e6, 2e6, 5e6], [1e5, 5e5, 2e6], 2e9, 1200.0),
        Maxwell(1e6, [3e6, 5e5], [1e-3, 0.1], 20.0, **SOLID),
    ],
    ids=lambda m: type(m).__name__,
)
def test_modulus_is_conjugate_at_negative_frequencies(modulus):
    """G*(−ω) is the conjugate of G*(ω): a real strain makes a real stress. Passive: G″ > 0 at ω > 0."""
    omega = 2 * np.pi * np.geomspace(1.0, 1e4, 9)
    forward = modulus.complex_modulus(omega)
    assert (forward.imag > 0).all()
    np.testing.assert_allclose(modulus.complex_modulus(-omega), forward.conj(), rtol=1e-15)


def test_power_law_has_one_loss_factor_and_a_maxwell_approximation():
    """tan(απ/2) everywhere, |G*| by ω^α; five branches over three decades to 1 %."""
    law = PowerLaw.of_loss_factor(4e6, 0.3, 1000.0, **SOLID)
    omega = 2 * np.pi * np.logspace(0, 5, 9)
    modulus = law.complex_modulus(omega)
    np.testing.assert_allclose(modulus.imag / modulus.real, 0.3, rtol=1e-12)
    np.testing.assert_allclose(np.abs(modulus), 4e6 * (omega / 2e3 / np.pi) ** law.exponent, rtol=1e-12)
    np.testing.assert_array_equal(law.complex_modulus(-omega), modulus.conj())
    model = law.maxwell(5, band=(10.0, 1e4))
    error = model.complex_modulus(2 * np.pi * np.logspace(1, 4, 50)) / law.complex_modulus(
        2 * np.pi * np.logspace(1, 4, 50)
    )
    assert np.abs(error - 1).max() < 0.02
    assert model.fit.tan_delta_rms < 0.01


def test_fractional_zener_contains_the_maxwell_branch():
    """α = 1 is spring and branch; α = ½ goes from G0 to G∞ and is approximated with its error told."""
    one = FractionalZener(1e6, 4e6, 1e-3, 1.0, 2e9, 1200.0)
    omega = np.logspace(0, 6, 13)
    branch = Maxwell(1e6, [3e6], [1e-3], **SOLID)
    np.testing.assert_allclose(one.complex_modulus(omega), branch.complex_modulus(omega), rtol=1e-12)
    half = FractionalZener(1e6, 1e9, 1e-6, 0.5, 2e9, 1200.0)
    assert complex(half.complex_modulus(0.0)) == 1e6
    model = half.maxwell("auto", band=(1.0, 1e5))
    f = np.geomspace(1.0, 1e5, 200)
    worst = np.abs(
        np.log(
            model.tan_delta(2 * np.pi * f)
            * half.complex_modulus(2 * np.pi * f).real
            / half.complex_modulus(2 * np.pi * f).imag
        )
    ).max()
    assert worst == pytest.approx(
        model.fit.tan_delta_max, rel=0.05
    )  # the fit's points are these, but for spacing
    assert model.fit.tan_delta_rms <= 0.02


def test_table_interpolates_and_refuses_what_it_does_not_hold(master):
    """Exact at its points, close between, refused outside; moved by a law; made of a master curve."""
    f = np.logspace(0, 4, 41)
    law = WLF(8.0, 120.0, 20.0)
    G = made.modulus(2 * np.pi * f)
    held = TabulatedModulus(f, G.real, G.imag, 2e9, 1200.0, law, 20.0)
    np.testing.assert_allclose(held.complex_modulus(2 * np.pi * f), G, rtol=1e-12)
    middle = np.sqrt(f[:-1] * f[1:])
    # PCHIP over 0.1 decade: third order in a spacing of 0.23 in ln f
    np.testing.assert_allclose(
        held.complex_modulus(2 * np.pi * middle), made.modulus(2 * np.pi * middle), rtol=2e-3
    )
    assert complex(held.complex_modulus(0.0)) == pytest.approx(G[0].real)
    with pytest.raises(ValueError, match=r"the table reaches from 1 to 10000 Hz"):
        held.complex_modulus(1.0)
    aT = float(10 ** law.log_shift(40.0))
    omega = 2 * np.pi * 100.0 / aT
    assert complex(held.at(40.0).complex_modulus(omega)) == pytest.approx(
        complex(made.modulus(omega * aT)), rel=1e-2
    )
    np.testing.assert_allclose(
        held.maxwell(5).complex_modulus(2 * np.pi * f), G, rtol=5e-3
    )  # the made branches, in part
    table = TabulatedModulus.from_master(master, **SOLID)
    x = 2 * np.pi * 100.0
    assert complex(table.complex_modulus(x)) == pytest.approx(complex(made.modulus(x)), rel=0.03)  # 1 % noise
    for make in (
        lambda: TabulatedModulus([1.0], [1.0], [1.0], 2e9, 1e3),
        lambda: TabulatedModulus([2.0, 1.0], [1.0, 1.0], [1.0, 1.0], 2e9, 1e3),
        lambda: TabulatedModulus([1.0, 2.0], [1.0, -1.0], [1.0, 1.0], 2e9, 1e3),
        lambda: PowerLaw(1e6, 1.0, 1.0, 2e9, 1e3),
        lambda: PowerLaw.of_loss_factor(1e6, 0.0, 1.0, **SOLID),
        lambda: FractionalZener(2e6, 1e6, 1.0, 0.5, 2e9, 1e3),
        lambda: FractionalZener(0.0, 1e6, 1.0, 0.0, 2e9, 1e3),
        lambda: PowerLaw(1e6, 0.2, 1.0, 2e9, 1e3).at(30.0),
        lambda: PowerLaw(1e6, 0.2, 1.0, 2e9, 1e3).maxwell(3, band=(1.0, 0.5)),
    ):
        with pytest.raises(ValueError, match=r"must|only by a shift law"):
            make()


# ---------------------------------------------------------------- exports


def numbers(line):
    """Numbers of a line of text."""
    return [float(v) for v in re.findall(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", line)]


def after(text, key):
    """The line below the one that begins so."""
    lines = text.splitlines()
    return lines[next(i for i, line in enumerate(lines) if line.startswith(key)) + 1]


@pytest.fixture
def solid():
    """A rubber with a WLF law, without a dashpot."""
    return Maxwell(1e6, [3e6, 5e5], [1e-3, 0.1], law=WLF(8.0, 120.0, 20.0), temperature=40.0, **SOLID)


def test_abaqus_prony_gives_the_same_modulus_back(solid):
    """Rebuilt from the text by the manual's formulas: G_inst (1 − Σg + Σ g iωτ/(1 + iωτ)); the shift too."""
    text = to_abaqus_prony(solid)
    E, nu = numbers(after(text, "*ELASTIC"))
    total = E / (2 * (1 + nu))
    assert E / (3 * (1 - 2 * nu)) == pytest.approx(2e9, rel=1e-6)  # twelve digits of ν, and 1 − 2ν is small
    at = text.splitlines().index("*VISCOELASTIC, TIME=PRONY")
    terms = [numbers(line) for line in text.splitlines()[at + 1 : at + 3]]
    w = 50.0
    modulus = total * (
        1 - sum(g for g, _, _ in terms) + sum(g * 1j * w * t / (1 + 1j * w * t) for g, _, t in terms)
    )
    assert modulus == pytest.approx(complex(solid.complex_modulus(w)), rel=1e-9)
    T0, C1, C2 = numbers(after(text, "*TRS"))
    assert T0 == 40.0
    shift = solid.law.log_shift(70.0) - solid.law.log_shift(40.0)
    assert -C1 * (70 - T0) / (C2 + 70 - T0) == pytest.approx(float(shift), rel=1e-8)


def test_abaqus_frequency_table_gives_the_same_modulus_back():
    """G″ = G∞ ωRe(g*), G′ = G∞ (1 − ωIm(g*)); the dashpot contained."""
    rubber = Maxwell(1e6, [3e6], [1e-3], 20.0, **SOLID)
    text = to_abaqus_frequency(rubber, [10.0, 1000.0])
    E, nu = numbers(after(text, "*ELASTIC"))
    G = E / (2 * (1 + nu))
    for line, f in zip(text.splitlines()[-2:], (10.0, 1000.0), strict=True):
        loss, storage, _, _, hertz = numbers(line)
        assert hertz == f
        assert G * (1 - storage + 1j * loss) == pytest.approx(
            complex(rubber.complex_modulus(2 * np.pi * f)), rel=1e-8
        )
    with pytest.raises(ValueError, match="G0 is 0"):
        to_abaqus_frequency(Maxwell(0.0, [1e6], [1.0], **SOLID), [1.0])
    with pytest.raises(ValueError, match="frequency"):
        to_abaqus_frequency(rubber, [0.0])


def test_ansys_gives_the_same_modulus_back(solid):
    """PRONY pairs from TBDATA; WLF in kelvin; Arrhenius as TN with Ea/R."""
    text = to_ansys(solid)
    data = [numbers(line.split(",", 2)[2]) for line in text.splitlines() if line.startswith("TBDATA")]
    E = numbers(next(v for v in text.splitlines() if v.startswith("MP,EX")).split(",", 3)[3])[0]
    nu = numbers(next(v for v in text.splitlines() if v.startswith("MP,NUXY")).split(",", 3)[3])[0]
    w = 50.0
    share = 1 - sum(a for a, _ in data[:2]) + sum(a * 1j * w * t / (1 + 1j * w * t) for a, t in data[:2])
    assert E / (2 * (1 + nu)) * share == pytest.approx(complex(solid.complex_modulus(w)), rel=1e-9)
    assert data[2][0] == pytest.approx(313.15)
    text = to_ansys(Maxwell(1e6, [1e6], [1.0], law=Arrhenius(1e5, 20.0), **SOLID))
    Tr, slope = numbers(text.splitlines()[-1].split(",", 2)[2])
    assert (Tr, slope) == pytest.approx((293.15, 1e5 / 8.31446261815324))
    for wrong, message in (
        (Maxwell(1e6, [1e6], [1.0], 5.0, **SOLID), "no dashpot"),
        (Maxwell(1e6, [], [], **SOLID), "needs a branch"),
        (
            Maxwell(1e6, [1e6], [1.0], law=ShiftTable((0.0, 40.0), (1.0, -1.0), 20.0), **SOLID),
            "has WLF and Arrhenius",
        ),
    ):
        for write in (to_ansys, to_abaqus_prony):
            with pytest.raises(ValueError, match=message):
                write(wrong)


def test_calculix_holds_one_frequency():
    """E, ν of the storage modulus and K, and the loss factor as structural damping."""
    rubber = Maxwell(1e6, [3e6], [1e-3], 20.0, **SOLID)
    text = to_calculix(rubber, 100.0)
    E, nu = numbers(after(text, "*ELASTIC"))
    modulus = complex(rubber.complex_modulus(200 * np.pi))
    assert E / (2 * (1 + nu)) == pytest.approx(modulus.real, rel=1e-9)
    assert float(text.strip().rpartition("=")[2]) == pytest.approx(modulus.imag / modulus.real, rel=1e-9)
    with pytest.raises(ValueError, match=r"frequency is -1.0; .*, Hz"):
        to_calculix(rubber, -1.0)
