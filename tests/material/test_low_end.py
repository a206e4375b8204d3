"""What a fit says of long times: reach, plateau, the interval for G0, and the pin."""

from __future__ import annotations

import dataclasses
import math
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.material import WLF, MasterCurve, fit_dense
from bearingdyn.notice import BeyondData, OutsideBand
from measured import measured

GIVEN = {"K": 2e9, "density": 1150.0}
G0, G, TAU = 1.2e6, np.array([15e6, 6e6, 2.5e6, 1.0e6, 0.5e6]), np.array([1e-6, 3e-5, 1e-3, 3e-2, 1.0])


def curve(low: float, high: float = 1e5, seed: int = 1, noise: float = 0.01) -> MasterCurve:
    """Points of a stated Maxwell model with noise, 12 a decade; nothing of them comes from the package."""
    rng = np.random.default_rng(seed)
    f = np.geomspace(low, high, 1 + round(12 * math.log10(high / low)))
    x = 2j * np.pi * f[:, None] * TAU
    modulus = G0 + (x / (1 + x)) @ G
    storage, loss = (
        part * (1 + noise * rng.standard_normal(f.size)) for part in (modulus.real, modulus.imag)
    )
    T = np.full(f.size, 20.0)
    law = WLF(8.0, 120.0, 20.0)
    return MasterCurve(f, storage, loss, T, "shear", 20.0, {}, {}, law, 0.0, (0.0, 0.0))


def epdm70() -> MasterCurve:
    """The measured rubber without the resonance of its fixture, its two runs taken for one as published."""
    return bd.master_curve(measured("epdm70").select(f_max=20.0), T_ref=20.0, levels=None)


@pytest.mark.parametrize("seed", range(5))
def test_data_that_show_a_plateau_enclose_the_relaxed_modulus_tightly(seed: int) -> None:
    # ωτ = 0.006 of the slowest branch at the lowest point: G′ has fallen but for 4e-5
    end = bd.fit_maxwell(curve(1e-3, seed=seed), n=5, **GIVEN).fit.low_end
    assert end is not None
    assert end.plateau
    low, high = end.interval
    assert low < G0 < high
    assert high / low < 1.06  # twelve points in the lowest decade with 1 % noise, and their twofold scatter
    assert end.covers(math.inf)


@pytest.mark.parametrize("low", [0.1, 1.0, 10.0])
@pytest.mark.parametrize("n", [3, 5, "auto"])
def test_data_that_still_fall_show_no_plateau_and_bound_g0_from_above_only(low: float, n: int | str) -> None:
    end = bd.fit_maxwell(curve(low), n=n, **GIVEN).fit.low_end
    assert end is not None
    assert not end.plateau
    assert end.interval[0] == 0.0
    x = 2 * np.pi * low * TAU
    assert end.interval[1] >= G0 + (x**2 / (1 + x**2)) @ G  # G0 ≤ G′(ω) at every ω
    assert not end.covers(math.inf)


def test_noise_is_no_plateau() -> None:
    # 30 % noise hides any slope; what cannot be seen is not shown
    end = bd.fit_maxwell(curve(1.0, noise=0.3, seed=3), n=3, **GIVEN).fit.low_end
    assert end is not None
    assert not end.plateau


def test_the_reach_is_one_over_the_lowest_angular_frequency_and_moves_with_the_temperature() -> None:
    rubber = bd.fit_maxwell(curve(1e-2), n=5, band=(1.0, 1e4), **GIVEN)
    end, cold = rubber.low_end, rubber.at(0.0).low_end
    assert end is not None
    assert cold is not None
    lowest = curve(1e-2).frequency[curve(1e-2).frequency >= 1.0][0]
    assert end.reach == pytest.approx(1 / (2 * np.pi * lowest), rel=1e-12)
    assert end.measured == pytest.approx(1e-2, rel=1e-12)
    # WLF by hand: log a_T = −8 (0 − 20)/(120 − 20) = 1.6
    assert cold.reach / end.reach == pytest.approx(10**1.6, rel=1e-12)


@pytest.mark.parametrize("low", [1e-2, 1.0])
def test_the_interval_after_a_time_encloses_the_true_modulus(low: float) -> None:
    rubber = bd.fit_maxwell(curve(low), n="auto", **GIVEN)
    end = rubber.low_end
    assert end is not None
    for t in np.geomspace(1e-3, 1e3, 25):
        least, most = end.bounds(float(t), float(rubber.relaxation(t)))
        # the stated model; inside the data two standard deviations and what the truncated fit adds, 1 %
        assert 0.99 * least <= G0 + np.exp(-t / TAU) @ G <= 1.01 * most


def test_what_is_known_of_long_times_stays_with_the_material() -> None:
    rubber = bd.fit_maxwell(curve(1.0), n=4, **GIVEN)
    omega = 2 * np.pi * 100.0
    end = rubber.low_end
    assert end is not None
    assert bd.Maxwell.from_json(rubber.to_json()).low_end == end
    harder = rubber.with_modulus(2 * abs(rubber.complex_modulus(omega)), omega)
    assert harder.low_end is not None
    assert harder.low_end.interval[1] == pytest.approx(2 * end.interval[1], rel=1e-12)
    assert harder.low_end.reach == end.reach
    lossy = rubber.with_relaxation(0.6, omega)
    assert lossy.low_end is not None
    assert lossy.low_end.interval[1] / lossy.G0 == pytest.approx(end.interval[1] / rubber.G0, rel=1e-12)


def test_a_model_given_by_hand_is_believed_unless_it_states_its_band() -> None:
    plain = bd.Maxwell(G0=1e6, G=[1e6], tau=[1.0], **GIVEN)
    assert plain.low_end is None
    banded = dataclasses.replace(plain, band=(10.0, 1e3))
    end = banded.low_end
    assert end is not None
    assert end.reach == pytest.approx(1 / (20 * np.pi), rel=1e-12)
    assert not end.covers(math.inf)
    x = 20 * np.pi
    assert end.interval == pytest.approx((0.0, 1e6 + 1e6 * x**2 / (1 + x**2)), rel=1e-12)


@pytest.mark.parametrize("n", [1, 3, "auto"])
@pytest.mark.parametrize("pin", [(100.0, 1.2e6), (0.5, 1.55e6), [1e4, 0.9e6]])
def test_a_pin_is_met(n: int | str, pin: tuple[float, float]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter(
            "ignore"
        )  # one branch does not suffice for the band; the pin holds all the same
        rubber = bd.fit_maxwell(curve(10.0), n=n, band=(10.0, 3e3), tolerance=0.05, pin=pin, **GIVEN)
    # the weight of 1000 against a hundred points, each off by at most a third: 100·0.33/1e6
    assert float(rubber.relaxation(pin[0])) == pytest.approx(pin[1], rel=1e-4)
    assert rubber.low_end is not None
    assert rubber.low_end.pinned == tuple(pin)
    assert rubber.low_end.covers(pin[0])
    assert not rubber.low_end.covers(10 * pin[0])


def test_a_pin_costs_the_band_little() -> None:
    free = bd.fit_maxwell(curve(10.0), n=5, **GIVEN).fit
    held = bd.fit_maxwell(curve(10.0), n=5, pin=(100.0, 1.2e6), **GIVEN).fit
    # the truth has this modulus there: the band can be met with it as well as without, to the noise
    assert held.storage_rms < 1.1 * free.storage_rms
    assert held.tan_delta_rms < 1.1 * free.tan_delta_rms


@pytest.mark.parametrize("t", [0.1, 1.0, 10.0])
def test_a_pin_without_a_modulus_reads_it_from_the_whole_master_curve(t: float) -> None:
    rubber = bd.fit_maxwell(curve(1e-2), n=5, band=(10.0, 3e3), pin=t, **GIVEN)
    # the stated model at that time; noise of 1 %, smoothed over the curve
    assert float(rubber.relaxation(t)) == pytest.approx(G0 + np.exp(-t / TAU) @ G, rel=0.01)


@pytest.mark.parametrize(
    ("pin", "message"),
    [
        (1e3, r"pin is 1000\.0; the master curve reaches 0\.01592 s"),
        (-1.0, "pin is -1.0; it must be a time"),
        ((1.0, math.nan), "pin is nan; it must be a time"),
        ((1.0, 2.0, 3.0), "it must be a time, or a time and a modulus"),
        ("soon", "pin is 'soon'"),
    ],
)
def test_a_pin_that_cannot_be_meant_is_refused(pin: object, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        bd.fit_maxwell(curve(10.0), n=3, pin=pin, **GIVEN)  # type: ignore[arg-type]


def test_a_dense_fit_reports_its_low_end_too() -> None:
    end = fit_dense(curve(1e-3), **GIVEN).low_end
    assert end is not None
    assert end.plateau


@pytest.mark.parametrize(("n", "found"), [(5, 2.36e6), ("auto", 4.73e6)])
def test_the_measured_rubber_gives_two_relaxed_moduli_and_says_that_neither_is_known(
    n: int | str, found: float
) -> None:
    rubber = bd.fit_maxwell(epdm70(), n=n, band=(10.0, 4000.0), **GIVEN)
    assert rubber.fit is not None
    assert rubber.G0 == pytest.approx(found, rel=5e-3)  # theory §4.1, three digits
    assert rubber.fit.storage_rms == pytest.approx(0.0125, abs=0.001)  # 1.2 % each
    end = rubber.fit.low_end
    assert end is not None
    assert not end.plateau
    for other in (2.36e6, 4.73e6):
        assert end.interval[0] <= other <= end.interval[1]
    # the points themselves: 2.34 MPa at 2.8e-4 Hz, which is 570 s
    assert end.measured == pytest.approx(2.8e-4, rel=0.01)


def test_the_measured_rubber_has_no_plateau_where_its_data_end() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        end = bd.fit_maxwell(epdm70(), n=8, **GIVEN).low_end
    assert end is not None
    assert end.modulus == pytest.approx(2.34e6, rel=0.03)  # the lowest point, and the scatter around it
    assert end.reach == pytest.approx(572.0, rel=0.01)
    assert not end.plateau
    assert end.fall == pytest.approx(0.16, abs=0.02)  # 15 % by the loss factor of .105: 1 − 10^(−(2/π)·.105)


@pytest.mark.parametrize(("n", "sag"), [(5, 113e-6), ("auto", 56e-6)])
def test_the_sag_of_113_or_56_um_comes_with_a_warning(n: int | str, sag: float) -> None:
    rubber = bd.fit_maxwell(epdm70(), n=n, band=(10.0, 4000.0), **GIVEN)
    app = bd.Application()
    app.add("ring", bd.Layer(0.020, 0.024, 0.006, rubber))
    app.free("ring.inner")
    app.ground("ring.outer")
    app.load("ring.inner", (0.0, -200.0, 0.0, 0.0, 0.0, 0.0))
    with pytest.warns(
        BeyondData, match=r"relaxed G = .* reach 0\.0136 s.*master curve reaches 572 s"
    ) as caught:
        eq = bd.equilibrium(app)
    assert len(caught) == 1
    assert -eq.displacement("ring.inner")[1] == pytest.approx(sag, rel=0.01)  # theory §4.1
    found = bd.static_summary(eq)
    assert float(found["deflection_low"][0]) < 56e-6
    assert float(found["deflection_high"][0]) == math.inf


def known_to_16_s() -> bd.Maxwell:
    """A fit whose points reach from 1/(2π 0.01 Hz) = 16 s down to 1.6 µs."""
    return bd.fit_maxwell(curve(1e-2), n=5, **GIVEN)


@pytest.mark.parametrize("t", [1e9, [1.0, 1e9], math.inf])
@pytest.mark.parametrize("what", ["relaxation", "creep"])
def test_a_time_beyond_the_data_is_told_of(what: str, t: object) -> None:
    rubber = bd.fit_maxwell(curve(1.0), n=3, **GIVEN)
    with pytest.warns(BeyondData, match=r"data that reach 0\.159 s"):
        getattr(rubber, what)(t)


@pytest.mark.parametrize("what", ["relaxation", "creep"])
def test_a_time_before_the_band_is_told_of(what: str) -> None:
    rubber = known_to_16_s()
    with pytest.warns(OutsideBand, match=r"after 1e-12 s, before 1\.59e-06 s"):
        getattr(rubber, what)([1e-12, 1.0])
    app = bd.Application()
    app.add("layer", bd.Layer(0.02, 0.025, 0.012, rubber))
    app.ground("layer.outer")
    app.free("layer.inner")
    app.load("layer.inner", (0, -10.0, 0, 0, 0, 0))
    with pytest.warns(OutsideBand, match="the static state of layer is asked after 1e-12 s"):
        bd.equilibrium(app, after=1e-12)


@pytest.mark.parametrize("what", ["relaxation", "creep"])
def test_times_that_the_data_reach_pass_and_so_does_the_instant_of_loading(what: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        getattr(known_to_16_s(), what)([0.0, 1e-5, 1e-3, 10.0])
        # a model given by hand without a band is believed
        getattr(bd.Maxwell(G0, G, TAU, **GIVEN), what)([1e-15, 1e15])


@pytest.mark.parametrize("omega", [0, 0.0, [0.0], [0.0, 10.0], np.zeros((2, 2))])
def test_rest_is_doubted_wherever_it_is_asked_for(omega: object) -> None:
    """By itself the material answers G0, which no data have shown; nothing is said within the data."""
    rubber = bd.fit_maxwell(curve(1.0), n=3, **GIVEN)
    for ask in (rubber.complex_modulus, rubber.loss_factor, rubber.tan_delta):
        with pytest.warns(BeyondData, match="the modulus at rest, at 0 Hz, of the material leaves the data"):
            ask(omega)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rubber.complex_modulus(10.0)
        bd.fit_maxwell(curve(1e-3), n=5, **GIVEN).complex_modulus(omega)
        bd.Maxwell(G0, G, TAU, **GIVEN).complex_modulus(omega)


def test_analyses_that_ask_at_rest_tell_of_it_once_in_their_own_words() -> None:
    rubber = bd.fit_maxwell(curve(1.0), n=3, **GIVEN)
    app = bd.Application()
    app.add("mass", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.add("layer", bd.Layer(0.02, 0.024, 0.015, rubber))
    app.connect("layer.inner", "mass.centre")
    app.ground("layer.outer")
    app.load("mass.centre", (0, -5.0, 0, 0, 0, 0))
    with pytest.warns(BeyondData) as told:
        eq = bd.equilibrium(app)
    assert len(told) == 1
    for ask in (
        lambda: bd.frequency_response(eq, [0.0, 10.0], inputs=["mass.centre.y"], outputs=["mass.centre.y"]),
        lambda: bd.Layer(0.02, 0.024, 0.015, rubber).stiffness(),
    ):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ask()
        texts = [str(w.message) for w in caught if w.category is BeyondData]
        assert len(texts) == 1
        assert "the modulus at rest" not in texts[0]
    with warnings.catch_warnings():
        warnings.simplefilter("error", BeyondData)
        bd.modes(eq)
        bd.transient(eq, speed=0.0, dt=1e-5, steps=3, record=["mass.centre.y"])
