"""The generalised Maxwell model: modulus, relaxation, stress history, shift, loss at equal stiffness."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import quad

from bearingdyn.material import WLF, Arrhenius, Maxwell, RhoT, ShiftTable
from twins import maxwell_twin

G0, G, TAU, ETA0 = 1.2e6, [3e6, 1.5e6, 0.7e6], [2e-5, 1e-3, 4e-2], 35.0
OMEGA = np.logspace(-1, 7, 17)


def rubber(**change):
    """A rubber with three branches and a dashpot."""
    values = {"G0": G0, "G": G, "tau": TAU, "eta0": ETA0, "K": 2e9, "density": 1200.0} | change
    return Maxwell(**values)


def test_modulus_equals_series_spring_and_dashpot_in_high_precision():
    """Each branch as spring and dashpot in series, 1/(1/G + 1/(iωη)), summed with 40 digits."""
    with mp.workdps(40):
        exact = [
            mpf(G0)
            + 1j * mpf(w) * mpf(ETA0)
            + mp.fsum(
                1 / (1 / mpf(g) + 1 / (1j * mpf(w) * mpf(g) * mpf(t))) for g, t in zip(G, TAU, strict=True)
            )
            for w in OMEGA.tolist()
        ]
        expected = np.array([complex(value) for value in exact])
    # a dozen rounded operations
    np.testing.assert_allclose(rubber().complex_modulus(OMEGA).real, expected.real, rtol=3e-15)
    np.testing.assert_allclose(rubber().complex_modulus(OMEGA).imag, expected.imag, rtol=3e-15)


def test_modulus_is_fourier_transform_of_relaxation():
    """G* = G0 + iωη0 + iω ∫ (G_rel − G0) e^{−iωt} dt, by QUADPACK's Fourier integrals."""
    material = rubber(tau=[0.02, 0.3, 1.0])

    def decay(t):
        return float(material.relaxation(t)) - G0

    for omega in (0.3, 5.0, 40.0):
        cosine = quad(decay, 0, np.inf, weight="cos", wvar=omega, epsabs=1e-3)[0]
        sine = quad(decay, 0, np.inf, weight="sin", wvar=omega, epsabs=1e-3)[0]
        expected = G0 + 1j * omega * ETA0 + 1j * omega * (cosine - 1j * sine)
        # epsabs·ω over |G*| > 1e6 Pa
        assert complex(material.complex_modulus(omega)) == pytest.approx(expected, rel=1e-7)


def test_modulus_satisfies_kramers_kronig():
    """G′(ω) − G0 = (2ω²/π) P∫ G″(u)/u /(ω² − u²) du; the principal value of ∫ du/(ω² − u²) itself is zero."""
    material = rubber()

    def over_u(u):
        return float(material.complex_modulus(u).imag) / u

    for omega in (30.0, 1e3, 2e4):
        at = over_u(omega)

        def integrand(x, omega=omega, at=at):
            u = omega * math.exp(x)
            return (over_u(u) - at) / (omega**2 - u**2) * u if x else 0.0

        total = sum(quad(integrand, a, b, limit=400, epsrel=1e-10)[0] for a, b in ((-30, -1e-6), (1e-6, 30)))
        # the gap of 2e-6 in ln u and the tails beyond e^±30 are below 1e-5 of the integral
        assert float(material.complex_modulus(omega).real) - G0 == pytest.approx(
            2 * omega**2 / np.pi * total, rel=1e-5
        )


def test_modulus_limits_and_symmetry():
    """Relaxed modulus at rest, instantaneous far above 1/τ, conjugate at −ω; shapes kept."""
    material = rubber(eta0=0.0)
    assert complex(material.complex_modulus(0.0)) == G0
    assert complex(material.complex_modulus(1e12)).real == pytest.approx(
        G0 + sum(G), rel=1e-12
    )  # 1/(ωτ)² = 2e-15
    assert material.G_instantaneous == pytest.approx(G0 + sum(G), rel=1e-15)
    assert float(material.relaxation(0.0)) == pytest.approx(material.G_instantaneous, rel=1e-15)
    np.testing.assert_array_equal(material.complex_modulus(-OMEGA), material.complex_modulus(OMEGA).conj())
    assert material.complex_modulus(OMEGA.reshape(1, 17)).shape == (1, 17)
    assert rubber(G0=0.0).complex_modulus([0.0])[0] == 0
    assert np.isinf(rubber(G0=0.0).loss_factor([0.0])[0])
    assert rubber(G=[], tau=[]).complex_modulus(2.0) == G0 + 2j * ETA0


def exact_stress(rate, dt, material):
    """Stress under piecewise-linear rates: every convolution integral in closed form, 50 digits, no
    recursion."""
    with mp.workdps(50):
        steps = [mpf(float(h)) for h in np.broadcast_to(dt, rate.shape[0] - 1)]
        times = [mpf(0)]
        for h in steps:
            times.append(times[-1] + h)
        out = np.empty_like(rate)
        for column in range(rate.shape[1]):
            v = [mpf(float(x)) for x in rate[:, column]]
            strain = mpf(0)
            for n in range(len(v)):
                if n:
                    strain += steps[n - 1] * (v[n] + v[n - 1]) / 2
                total = 2 * mpf(material.G0) * strain + 2 * mpf(material.eta0) * v[n]
                for g, tau in zip(material.G.tolist(), material.tau.tolist(), strict=True):
                    g, tau = mpf(g), mpf(tau)
                    for k in range(n):
                        slope = (v[k + 1] - v[k]) / steps[k]

                        # antiderivative of e^{−(t_n − s)/τ}(v_k + slope (s − t_k))
                        def primitive(s, k=k, n=n, tau=tau, slope=slope, v=v):
                            decay = mp.exp(-(times[n] - s) / tau)
                            return tau * decay * (v[k] + slope * (s - times[k]) - slope * tau)

                        total += 2 * g * (primitive(times[k + 1]) - primitive(times[k]))
                out[n, column] = float(total)
        return out


def histories():
    """Rate histories with ė(0) ≠ 0 and steps that change by orders of magnitude."""
    rng = np.random.default_rng(5)
    for ratio in (1e-8, 1e-6, 2e-5, 1e-3, 0.04, 0.05, 0.06, 0.3, 0.5, 0.51, 1.0, 7.0, 1e3):
        yield f"dt/tau={ratio:g}", rng.standard_normal((9, 2)), ratio * 1e-3, [1e-3]
    yield "changing dt", rng.standard_normal((12, 3)), 10.0 ** rng.uniform(-9, -1, 11), [1e-3]
    yield (
        "changing dt, five branches",
        rng.standard_normal((12, 1)),
        10.0 ** rng.uniform(-7, 0, 11),
        10.0 ** np.arange(-6, -1),
    )


HISTORIES = list(histories())


@pytest.fixture(params=["twin", "core"])
def update(request):
    """The history update, by the NumPy twin and by the C core."""
    if request.param == "twin":
        return maxwell_twin.maxwell_stress
    from bearingdyn import core

    return core.maxwell_stress


@pytest.mark.parametrize(("rate", "dt", "tau"), [h[1:] for h in HISTORIES], ids=[h[0] for h in HISTORIES])
@pytest.mark.parametrize(
    ("G0", "eta0"), [(0.0, 0.0), (1e5, 20.0)], ids=["branches alone", "spring and dashpot"]
)
def test_history_exact_for_linear_rate(update, rate, dt, tau, G0, eta0):
    """Exact to 1e-12 of the largest stress, the figure the project asks for, whatever Δt/τ."""
    material = Maxwell(G0, np.linspace(1e6, 2e6, len(tau)), tau, eta0, K=2e9, density=1200.0)
    expected = exact_stress(rate, dt, material)
    steps = dt if np.ndim(dt) == 0 else np.ascontiguousarray(dt)
    got = update(rate, steps, G0, eta0, material.G, material.tau)
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize("ratio", [1e-8, 1e-4, 0.03, 1.0, 30.0, 1e3])
def test_history_of_ramp_and_of_growing_rate(update, ratio):
    """Constant rate r: S = 2Gτr(1−e^{−t/τ}); rate t: 2Gτ(t − τ(1−e^{−t/τ})) (theory, §1); 40 digits."""
    g, tau, n = 1e6, 2e-3, 50
    h = ratio * tau
    t = h * np.arange(n)
    rate = np.column_stack([np.full(n, 3.0), t])
    with mp.workdps(40):
        exact = []
        for k in range(n):
            time, relaxed = k * mpf(h), -mp.expm1(-k * mpf(h) / mpf(tau))
            exact.append(
                [float(6 * g * mpf(tau) * relaxed), float(2 * g * mpf(tau) * (time - mpf(tau) * relaxed))]
            )
    got = update(rate, h, 0.0, 0.0, np.array([g]), np.array([tau]))
    # every rate is positive, nothing cancels: 1e-12 holds sample by sample
    np.testing.assert_allclose(got[1:], np.array(exact)[1:], rtol=1e-12)


def test_history_of_cosine_rate_converges_with_second_order(update):
    """Rate cos ωt: Re 2G(e^{iωt} − e^{−t/τ})/(iω + 1/τ) (theory, §1); a cosine drawn as chords errs as
    Δt²."""
    g, tau, omega = 1e6, 2e-3, 400.0
    errors = []
    for n in (200, 400, 800):
        t = np.linspace(0, 0.05, n + 1)
        exact = (2 * g * (np.exp(1j * omega * t) - np.exp(-t / tau)) / (1j * omega + 1 / tau)).real
        got = update(np.cos(omega * t)[:, None], t[1], 0.0, 0.0, np.array([g]), np.array([tau]))[:, 0]
        errors.append(np.abs(got - exact).max() / np.abs(exact).max())
    order = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(order, 2.0, atol=0.05)  # next term of the error is (ωΔt)²/20 ≤ 5e-4 relative


def test_discrete_branch_modulus_is_fourth_order():
    """With the trapezoidal rule for the strain: 5.7e-7 at Δt/τ = ωΔt = 0.1, 3.7e-4 at 0.5 (theory, §1)."""
    for ratio, expected in ((0.1, 5.7e-7), (0.5, 3.7e-4)):
        E, old, new = (float(w) for w in maxwell_twin.branch_weights(ratio))
        z = np.exp(1j * ratio)
        rate_per_strain = 2 * (z - 1) / (z + 1)  # times 1/Δt; τ/Δt = 1/ratio
        discrete = (old + new * z) / (z - E) * rate_per_strain / ratio
        exact = 1j / (1 + 1j)  # ωτ = 1
        assert abs(discrete / exact - 1) == pytest.approx(expected, rel=0.02)  # two digits are printed


def test_core_equals_twin_in_any_memory_layout():
    """Material.stress against the twin on five branches, with strided input and trailing axes, input
    untouched."""
    material = rubber(G=[1e6] * 5, tau=10.0 ** -np.arange(1, 6))
    rng = np.random.default_rng(3)
    wide = rng.standard_normal((4, 6, 80))
    rate, copy = wide.transpose(2, 1, 0)[:, ::2], wide.copy()
    dt = 10.0 ** rng.uniform(-6, -2, 79)
    twin = maxwell_twin.maxwell_stress(rate.reshape(80, -1), dt, G0, ETA0, material.G, material.tau)
    got = material.stress(rate, dt)
    assert got.shape == rate.shape
    # sums of eight terms may be ordered differently
    np.testing.assert_allclose(got.reshape(80, -1), twin, rtol=0, atol=1e-14 * np.abs(twin).max())
    np.testing.assert_array_equal(wide, copy)


@pytest.mark.parametrize(
    ("rate", "dt", "message"),
    [
        (np.ones(5), 0.0, "dt: every time step must be positive"),
        (np.ones(5), np.nan, "dt: every time step must be positive"),
        (np.ones(5), np.ones(5), r"dt has shape \(5,\); it must be one number, or 4 for 5 samples"),
        (1.0, 0.1, "axis 0 must be time"),
        ([1.0, np.nan], 0.1, "strain_rate: every value must be finite"),
    ],
)
def test_stress_refuses_bad_history(rate, dt, message):
    """Refused before the core is asked."""
    with pytest.raises(ValueError, match=message):
        rubber().stress(rate, dt)


@pytest.mark.parametrize(
    "law",
    [
        WLF(8.0, 120.0, 20.0),
        Arrhenius(9e4, 20.0),
        ShiftTable((0.0, 20.0, 40.0, 60.0), (1.4, 0.1, -1.0, -1.8), 20.0),
    ],
)
def test_shift_in_temperature_scales_frequency(law):
    """G*(ω, T) = G*(ω a_T, T_ref) with the dashpot included; two moves equal one, and back is identity."""
    material = rubber(law=law)
    assert material.temperature == 20.0
    aT = float(10 ** law.log_shift(45.0))
    assert aT < 1
    np.testing.assert_allclose(
        material.at(45.0).complex_modulus(OMEGA), material.complex_modulus(OMEGA * aT), rtol=1e-12
    )  # powers of ten
    np.testing.assert_allclose(material.at(5.0).at(45.0).tau, material.at(45.0).tau, rtol=1e-13)
    np.testing.assert_allclose(material.at(5.0).at(20.0).tau, TAU, rtol=1e-13)


def test_vertical_shift_scales_the_whole_modulus():
    """G*(ω, T) = b_T G*(ω a_T, T_ref), branches and dashpot alike."""
    law, vertical = WLF(8.0, 120.0, 20.0), RhoT(20.0, 6e-4)
    material = rubber(law=law, vertical=vertical)
    assert material.eta0 * OMEGA[-1] > 0.5 * material.complex_modulus(OMEGA[-1]).imag  # the dashpot matters
    aT, bT = float(10 ** law.log_shift(60.0)), 333.15 / 293.15 / (1 + 6e-4 * 40)
    np.testing.assert_allclose(
        material.at(60.0).complex_modulus(OMEGA), bT * material.complex_modulus(OMEGA * aT), rtol=1e-12
    )  # powers of ten


def test_laws_have_published_values():
    """Universal WLF (17.44, 51.6 K): a decade of 12 for 100 K above Tg [Ferry]; Arrhenius by its
    definition."""
    assert float(WLF(17.44, 51.6, 0.0).log_shift(100.0)) == pytest.approx(-11.504, abs=5e-4)  # −1744/151.6
    expected = 8e4 / 8.31446261815324 * (1 / 333.15 - 1 / 293.15) / math.log(10)
    assert float(Arrhenius(8e4, 20.0).log_shift(60.0)) == pytest.approx(expected, rel=1e-14)
    with pytest.raises(ValueError, match="holds above"):
        WLF(17.44, 51.6, 0.0).log_shift(-51.6)
    with pytest.raises(ValueError, match="known from 0 to 40"):
        ShiftTable((0.0, 20.0, 40.0), (1.0, 0.0, -1.0), 20.0).log_shift(41.0)


def test_loss_factor_changes_at_equal_stiffness_and_stays_causal():
    """Same |G*| at ω, loss as asked; causal because it is a Maxwell model with non-negative strengths."""
    omega = 2 * np.pi * 1000.0
    material = rubber()
    before = abs(complex(material.complex_modulus(omega)))
    for loss in (0.05, 0.2, 0.35):
        other = material.with_loss_factor(loss, omega)
        modulus = complex(other.complex_modulus(omega))
        assert abs(modulus) == pytest.approx(before, rel=1e-13)  # a few roundings
        assert modulus.imag / modulus.real == pytest.approx(loss, rel=1e-13)
        assert (other.G > 0).all()
        np.testing.assert_array_equal(other.tau, material.tau)
        np.testing.assert_allclose(other.G / other.eta0, material.G / material.eta0, rtol=1e-14)
    hard = material.with_modulus(1e7, omega)
    assert abs(complex(hard.complex_modulus(omega))) == pytest.approx(1e7, rel=1e-14)
    np.testing.assert_allclose(hard.loss_factor(OMEGA), material.loss_factor(OMEGA), rtol=1e-13)
    with pytest.raises(ValueError, match="between 0 and"):
        material.with_loss_factor(50.0, omega)
    with pytest.raises(ValueError, match="branches against the spring"):
        rubber(G0=0.0).with_loss_factor(0.1, omega)


def test_material_is_a_value():
    """Equal, hashable, unchangeable, through JSON and pickle to the last bit."""
    material = rubber(law=WLF(8.0, 120.0, 20.0), G=[1 / 3, 2e6, 1e5])
    twin = Maxwell.from_json(material.to_json())
    assert twin == material
    assert hash(twin) == hash(material)
    assert pickle.loads(pickle.dumps(material)) == material
    assert material != rubber()
    with pytest.raises(ValueError, match="read-only"):
        material.tau[0] = 1.0
    with pytest.raises(ValueError, match="read-only"):
        pickle.loads(pickle.dumps(material)).tau[0] = 1.0
    with pytest.raises(ValueError, match="unknown entries"):
        Maxwell.from_json('{"G0": 1, "G": [], "tau": [], "K": 1, "density": 1, "colour": 2}')
    with pytest.raises(ValueError, match="needs a JSON object"):
        Maxwell.from_json("[1, 2]")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"G0": -1.0}, r"Maxwell.G0 is -1.0; .*, Pa"),
        ({"G0": math.nan}, r"Maxwell.G0 is nan; .*, Pa"),
        ({"G": [1e6, -2.0, 1.0]}, r"Maxwell.G\[1\] is -2.0; .*, Pa"),
        ({"tau": [1e-3, 0.0, 1.0]}, r"Maxwell.tau\[1\] is 0.0; .*, s"),
        ({"tau": [1e-3, math.nan, 1.0]}, r"Maxwell.tau\[1\] is nan; .*, s"),
        ({"tau": [1e-3]}, "each strength needs its time"),
        ({"G": 1e6}, "must be one-dimensional"),
        ({"eta0": -1.0}, "Maxwell.eta0"),
        ({"K": 0.0}, "Maxwell.K"),
        ({"density": math.inf}, "Maxwell.density"),
        ({"G0": 0.0, "G": [0.0] * 3, "eta0": 0.0}, "no shear at all"),
    ],
)
def test_bad_material_is_refused(change, message):
    """A message naming field and value."""
    with pytest.raises(ValueError, match=message):
        rubber(**change)


def test_material_without_law_stays_at_its_temperature():
    """No law, no other temperature."""
    with pytest.raises(ValueError, match="only by a shift law"):
        rubber().at(40.0)


@pytest.mark.parametrize("wanted", [0.2, 0.3, 0.6])
def test_a_further_relaxation_raises_the_loss_and_keeps_the_modulus(wanted: float) -> None:
    base = Maxwell(4e6, [1e6, 5e5], [1e-4, 1e-2], eta0=3.0, K=2e9, density=1100.0)
    omega = 2 * np.pi * 1000.0
    damped = base.with_relaxation(wanted, omega)
    # both follow from the definition in closed form: round-off of a few operations
    assert damped.loss_factor(omega) == pytest.approx(wanted, rel=1e-12)
    assert abs(damped.complex_modulus(omega)) == pytest.approx(abs(base.complex_modulus(omega)), rel=1e-12)
    assert len(damped.tau) == len(base.tau) + 1
    # and it keeps more relaxed modulus than scaling the branches does, where that can reach so far
    if wanted == 0.2:
        assert damped.G0 > base.with_loss_factor(wanted, omega).G0


@pytest.mark.parametrize("wanted", [0.01, 1.0, np.nan])
def test_a_loss_out_of_reach_of_a_further_relaxation_is_refused(wanted: float) -> None:
    base = Maxwell(4e6, [1e6], [1e-4], K=2e9, density=1100.0)
    with pytest.raises(ValueError, match="loss_factor"):
        base.with_relaxation(wanted, 6000.0)
