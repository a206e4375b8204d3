"""Answers from data that are not there: temperatures, laws and shifts that warn; resonances in band."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

import bearingdyn as bd
import make_sample_dma as made
from bearingdyn.material import (
    WLF,
    Arrhenius,
    DMAData,
    FractionalZener,
    Joined,
    PowerLaw,
    TabulatedModulus,
    fit_dense,
    fit_maxwell,
    master_curve,
    read_dma,
    sample_dma_path,
    suspects,
)
from bearingdyn.notice import OddPoints, OutsideIsotherms, PoorLaw, UnevenShifts
from measured import measured


@pytest.fixture(scope="module")
def sample():
    """The shipped, made measurement."""
    return read_dma(sample_dma_path())


@pytest.fixture(scope="module")
def curve(sample):
    """Its master curve, −20 to 60 °C."""
    return master_curve(sample)


def made_dma(seed=0, noise=0.01, change=lambda f, G: G):
    """The made measurement with G* changed at the machine's frequency f."""
    f, T, storage, loss = made.points(seed, noise=noise)
    G = change(f, storage + 1j * loss)
    return DMAData(f, T, G.real, G.imag, "shear")


# ---------------------------------------------------------------- temperatures


def materials(curve):
    """Every modulus law that a master curve or its law can be made into."""
    rubber = fit_maxwell(curve, n=3, K=2e9, density=1150.0)
    known = {"K": 2e9, "density": 1150.0, "law": curve.law, "temperature": 20.0}
    return {
        "fit": rubber,
        "dense": fit_dense(curve, K=2e9, density=1150.0, per_decade=3),
        "tabulated": TabulatedModulus.from_master(curve, K=2e9, density=1150.0),
        "power": PowerLaw(5e6, 0.2, 1e3, **known),
        "zener": FractionalZener(1e6, 1e7, 1e-3, 0.5, **known),
        "read again": bd.Maxwell.from_json(rubber.to_json()),
        "harder": rubber.with_modulus(2e6, 1e3),
        "moved": rubber.at(40.0),
        "maxwell of a power law": PowerLaw(5e6, 0.2, 1e3, **known).maxwell(band=(1.0, 1e3)),
    }


def test_materials_know_the_isotherms_of_their_law(curve):
    """Within −20 to 60 °C silent; outside, a warning with the value and the range; absurd: refused."""
    assert curve.law.measured == pytest.approx((-20.0, 60.0), abs=0.1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = materials(curve)
    for material in found.values():
        with warnings.catch_warnings():
            warnings.simplefilter("error", OutsideIsotherms)
            for T in (-20.0, 20.0, 60.0):
                material.at(T)
        for T in (61.0, 200.0, -30.0):
            with pytest.warns(
                OutsideIsotherms, match=rf"T is {T:g} °C, outside the isotherms measured, -(20|19)"
            ):
                material.at(T)
        for T, message in (
            (501.0, "is it in K"),
            (-300.0, "(at least|between) -273.15"),
            (np.nan, "finite"),
            (np.inf, "finite"),
        ):
            with pytest.raises(ValueError, match=f"T.*{message}|finite"):
                material.at(T)


def test_kelvin_for_celsius_is_guessed(curve):
    """293 is far above; the warning asks."""
    with pytest.warns(OutsideIsotherms, match="is it in K"):
        fit_maxwell(curve, n=3, K=2e9, density=1150.0).at(293.15)


def test_an_application_passes_the_warning_on(curve):
    """app.temperature(part, 150) names the temperature and the range."""
    rubber = fit_maxwell(curve, n=3, K=2e9, density=1150.0)
    app = bd.Application()
    app.add("layer", bd.Layer(r_inner=0.010, r_outer=0.013, width=0.01, material=rubber))
    with pytest.warns(OutsideIsotherms, match=r"T is 150 °C, outside the isotherms measured") as caught:
        app.temperature("layer", 150)
    assert caught[0].filename == __file__
    with pytest.raises(ValueError, match="part 'layer' at 600"):
        app.temperature("layer", 600)


def test_a_law_without_a_range_does_not_warn_and_has_its_limits():
    """Constants by hand say nothing of isotherms; a shift of 40 decades has no meaning."""
    rubber = bd.Maxwell(1e6, [1e6], [1e-3], K=2e9, density=1e3, law=Arrhenius(3e5, 20.0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rubber.at(150.0)
    with pytest.raises(ValueError, match="which has no meaning"):
        rubber.at(-200.0)
    for law in (WLF, Arrhenius, Joined):
        constants = {WLF: (8.0, 100.0, 20.0), Arrhenius: (1e5, 20.0), Joined: (8.0, 100.0, 0.0, 1e5, 20.0)}[
            law
        ]
        with pytest.raises(ValueError, match=rf"{law.__name__}.measured is \(60.0, -20.0\)"):
            law(*constants, measured=(60.0, -20.0))


def test_a_reference_outside_the_isotherms_is_an_extrapolation(sample):
    """The class is the same."""
    with pytest.warns(OutsideIsotherms, match="T_ref is 90 °C, outside the measured"):
        master_curve(sample, T_ref=90.0)


# ---------------------------------------------------------------- laws and shifts


def test_a_law_far_worse_than_its_shifts_warns_with_both_figures(sample, curve):
    """Arrhenius over a WLF material: 0.23 decade, fifty times the errors of the shifts; WLF is silent."""
    with pytest.warns(PoorLaw, match="deviate from the arrhenius law by") as caught:
        master_curve(sample, law="arrhenius")
    figures = [
        float(v)
        for v in re.findall(
            r"by ([\d.]+) decades rms, their own standard error is ([\d.]+)", str(caught[0].message)
        )[0]
    ]
    assert figures[0] == pytest.approx(0.23, abs=0.02)
    assert figures[0] > 10 * figures[1]
    misses = [float(v) for v in re.findall(r"([\d.]+)%", str(caught[0].message))]
    assert misses[0] > 5 * misses[2]  # by the law 8 % of G′, by the shifts 0.9 %
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for law in ("wlf", "free"):
            master_curve(sample, law=law)


def test_zigzag_shifts_are_named():
    """The adhesive: 2.7, 0.2 and 2.3 decades per 7.5 K from −35 to −12 °C (theory: none of a polymer)."""
    with pytest.warns(
        UnevenShifts, match=r"2\.7\d* from -34\.93 to -27\.41 °C, 0\.2\d* from -27\.41 to -19\.99 °C, 2\.3\d*"
    ):
        master_curve(measured("adhesive").select(f_max=30.0), T_ref=80.0, law="free", clean=False)


@pytest.mark.parametrize("by", [0.6, -0.6])
def test_one_isotherm_shifted_by_hand_is_named(sample, by):
    """0.6 decade up or down at 30 °C, where a step is 0.6."""
    exact = {T: float(made.log_shift(T)) for T in made.TEMPERATURES}
    exact[30.0] += by
    with pytest.warns(UnevenShifts, match=r"to (30|29\.\d+|30\.\d+) °C"):
        master_curve(sample, shifts=exact, refine=False, law="free")


@pytest.mark.filterwarnings("error::bearingdyn.notice.UnevenShifts")
def test_smooth_shifts_do_not_warn(sample):
    """WLF, and through the glass transition of a measured polymer, where the rate has its peak."""
    master_curve(sample)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*deviate from the|.*left out")
        master_curve(measured("glassy_polymer").select(T=(60.0, 110.0)), T_ref=90.0)


# ---------------------------------------------------------------- resonances inside the band


def amplified(resonance, damping):
    """A fixture in series: the modulus times |1/(1 − r² + i d r)|."""
    return lambda f, G: G * np.abs(1 / (1 - (f / resonance) ** 2 + 1j * damping * f / resonance))


def lossy(resonance, size):
    """A bump of the loss alone, a fifth of a decade wide."""
    return lambda f, G: G.real + 1j * G.imag * (1 + size * np.exp(-((np.log10(f / resonance) / 0.1) ** 2)))


@pytest.mark.parametrize("resonance", [5.0, 20.0])
@pytest.mark.parametrize("size", [0.6, 1.5])
def test_a_resonance_inside_the_band_is_left_out(resonance, size):
    """Points near it go, those a factor of three away stay."""
    flagged, found = suspects(made_dma(change=lossy(resonance, size)))
    f = np.array([s.frequency for s in found])
    assert found
    assert {s.reason for s in found} == {"fixture resonance"}
    assert (np.abs(np.log10(f / resonance)) < np.log10(2.0)).all()
    nearest = made.FREQUENCIES[np.argmin(np.abs(np.log(made.FREQUENCIES / resonance)))]
    assert np.isclose(f, nearest, rtol=0.03).sum() == made.TEMPERATURES.size  # at every temperature
    assert flagged.sum() == len(found)


@pytest.mark.parametrize("damping", [0.1, 0.3])
def test_an_amplifying_fixture_is_left_out_and_the_shifts_are_saved(damping):
    """15 Hz, the modulus up to ten times: the shifts come back within 0.1 decade."""
    dma = made_dma(change=amplified(15.0, damping))
    with pytest.warns(UserWarning, match="fixture resonance"):
        cleaned = master_curve(dma, law="free")
    expected = [float(made.log_shift(T)) for T in made.TEMPERATURES]
    np.testing.assert_allclose(list(cleaned.shifts.values()), expected, atol=0.1)


@pytest.mark.parametrize("noise", [0.0, 0.01, 0.03])
@pytest.mark.parametrize("seed", range(4))
def test_clean_data_lose_nothing(seed, noise):
    """Noise of 3 % is not a resonance."""
    assert suspects(made_dma(seed, noise))[1] == ()


def test_measured_data_lose_what_their_readme_names():
    """epdm70 above 20 Hz and the adhesive at 46 and 100 Hz, on every isotherm; below, nothing."""
    for name, low, high in (("epdm70", 20.0, 101.0), ("adhesive", 40.0, 101.0)):
        dma = measured(name)
        f = {round(s.frequency, 3) for s in suspects(dma)[1]}
        assert f
        assert low < min(f)
        assert max(f) < high
        assert suspects(dma.select(f_max=low))[1] == ()


def isotherms_of(shift, frequency) -> DMAData:
    """Isotherms of one stated Maxwell model, shifted by decades at T."""
    T = (0.0, 10.0, 20.0, 30.0, 40.0)
    tau, G = np.geomspace(1e-6, 1e3, 28), np.geomspace(3e6, 3e5, 28)
    f, at = np.tile(frequency, len(T)), np.repeat(T, frequency.size)
    x = 2j * np.pi * (f * 10 ** shift(at))[:, None] * tau
    modulus = 1e6 + (x / (1 + x)) @ G
    return DMAData(f, at, modulus.real, modulus.imag, "shear")


def test_isotherms_that_do_not_meet_are_told_of():
    """Sweeps of one decade, 3 decades apart: over two decades between them nothing was measured."""
    f = np.geomspace(1.0, 10.0, 8)
    with pytest.warns(UnevenShifts, match=r"leave gaps in the master curve, [12][.0-9]* decades about"):
        master_curve(isotherms_of(lambda T: (20 - T) * 0.3, f), law="free")
    with warnings.catch_warnings():
        warnings.simplefilter("error", UnevenShifts)
        master_curve(isotherms_of(lambda T: (20 - T) * 0.06, f), law="free")


@pytest.mark.parametrize(("which", "factor"), [("storage", 1.4), ("loss", 3.0), ("loss", 0.5)])
def test_a_point_that_stands_alone_is_told_of(which, factor):
    dma = isotherms_of(lambda T: (20 - T) * 0.08, np.geomspace(1.0, 100.0, 10))
    moduli = {"storage": dma.storage.copy(), "loss": dma.loss.copy()}
    moduli[which][24] *= factor
    odd = DMAData(dma.frequency, dma.temperature, moduli["storage"], moduli["loss"], "shear")
    name = "G′" if which == "storage" else "G″"
    said = rf"{name} at {dma.frequency[24]:.4g} Hz and 20 °C"
    with pytest.warns(OddPoints, match=said):
        master_curve(odd, law="free")
    with warnings.catch_warnings():
        warnings.simplefilter("error", OddPoints)
        rng = np.random.default_rng(3)
        scatter = 1 + 0.03 * rng.standard_normal((2, dma.storage.size))
        noisy = DMAData(
            dma.frequency, dma.temperature, dma.storage * scatter[0], dma.loss * scatter[1], "shear"
        )
        master_curve(noisy, law="free")
