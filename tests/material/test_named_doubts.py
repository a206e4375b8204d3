"""Named doubts about a rubber: where they come from, and what they do to an answer."""

from dataclasses import replace

import numpy as np
import pytest
from tests.measured import measured

import bearingdyn as bd
from bearingdyn.notice import VolumeCounts

PLAIN = bd.Maxwell(1e6, [2e6], [1e-4], K=2e9, density=1150.0)
SAMPLE = bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)
FITTED = bd.fit_maxwell(SAMPLE, n=5, band=(10.0, 5e3), K=2e9, density=1150.0)


def omega(*f):
    return 2 * np.pi * np.array(f)


def test_runs_that_disagree_are_a_level_between_them():
    curve = bd.master_curve(measured("epdm70"), T_ref=20.0)
    rubber = bd.fit_maxwell(curve, n=5, band=(10.0, 4e3), K=2e9, density=1150.0)
    level = bd.doubts(rubber, curve)["level"]
    # theory §4.1: the second run is .94 ± .01 of the first, the curve standing at the first
    assert level.low == 1.0
    assert 1 / level.high == pytest.approx(0.94, abs=0.01)
    w = omega(20.0, 500.0)
    stiff = bd.doubts(rubber, curve).varied(level=level.high)
    np.testing.assert_allclose(stiff.complex_modulus(w), level.high * rubber.complex_modulus(w), rtol=1e-12)


def test_a_fits_doubt_is_the_scatter_of_refits_to_data_made_anew():
    # data of a known law with 1 % of noise, fitted 40 times: what the fits scatter by is what each one says
    w = omega(*np.geomspace(10.0, 5e3, 40))
    G = FITTED.complex_modulus(w)

    def fit(seed):
        noise = np.exp(0.01 * np.random.default_rng(seed).normal(size=(2, 40)))
        data = bd.material.DMAData(
            w / 2 / np.pi, np.full(40, 20.0), G.real * noise[0], G.imag * noise[1], "shear", "made"
        )
        return bd.fit_maxwell(data, n=3, band=(10.0, 5e3), K=2e9, density=1150.0)

    fits = [fit(seed) for seed in range(40)]
    grid = omega(*np.geomspace(10.0, 5e3, 40))
    moduli = np.array([m.complex_modulus(grid) for m in fits])
    seen = np.sqrt(np.mean(np.var(np.log(np.abs(moduli)), axis=0, ddof=1)))
    told = np.array([np.log(bd.doubts(m)["fit"].high) / 2 for m in fits])
    assert told.mean() == pytest.approx(
        seen, rel=0.3
    )  # 40 draws: the scatter itself to 11 %, the model misfits
    seen = np.sqrt(np.mean(np.var(np.log(moduli.imag / moduli.real), axis=0, ddof=1)))
    told = np.array([np.log(bd.doubts(m)["loss"].high) / 2 for m in fits])
    assert told.mean() == pytest.approx(seen, rel=0.3)


def test_loss_and_relaxed_state_move_without_the_rest():
    found = bd.doubts(FITTED)
    middle = omega(np.sqrt(10.0 * 5e3))
    lossy = found.varied(loss=1.1)
    assert abs(lossy.complex_modulus(middle)) == pytest.approx(abs(FITTED.complex_modulus(middle)), rel=1e-9)
    assert lossy.loss_factor(middle) == pytest.approx(1.1 * FITTED.loss_factor(middle), rel=1e-9)
    relaxed = found["relaxed"]
    assert relaxed.low < 1.0 <= relaxed.high
    soft = found.varied(relaxed=relaxed.low)
    assert soft.G0 == pytest.approx(relaxed.low * FITTED.G0)
    # what the data tell stays: the branch added loses a hundredth of itself at their lowest frequency
    w = omega(FITTED.low_end.frequency, 100.0, 5e3)
    lost = FITTED.G0 - soft.G0
    assert np.abs(soft.complex_modulus(w) - FITTED.complex_modulus(w)).max() < 0.011 * lost


def test_a_spring_gains_what_the_slowest_branches_lose():
    rubber = bd.Maxwell(1e6, [5e5, 2e6], [10.0, 1e-4], K=2e9, density=1150.0, band=(1.0, 1e4))
    found = bd.doubts(rubber)
    # 10 s lies beyond the 0.16 s that 1 Hz reaches: that branch may be spring
    assert found["relaxed"].high == pytest.approx(1.5, rel=1e-3)  # G′ at 1 Hz, by which it is bounded
    stiff = found.varied(relaxed=1.5)
    assert (stiff.G0, stiff.G[0], stiff.G[1]) == pytest.approx((1.5e6, 0.0, 2e6))
    assert stiff.G_instantaneous == pytest.approx(rubber.G_instantaneous)


def test_temperature_is_a_shift_of_the_same_material_in_its_measured_band():
    found = bd.doubts(FITTED, temperature=(-3.0, 2.0))
    w = omega(100.0)
    np.testing.assert_allclose(
        found.varied(temperature=2.0).complex_modulus(w), FITTED.at(22.0).complex_modulus(w), rtol=1e-12
    )
    assert found.varied(temperature=2.0).band == FITTED.band
    with pytest.raises(ValueError, match="no shift law"):
        bd.doubts(PLAIN, temperature=(-1.0, 1.0))


def test_draws_have_the_distributions_of_their_sources():
    found = bd.doubts(PLAIN, K=(1e9, 3e9), level=(0.9, 1.1))
    drawn = found.draws(256, seed=3)
    K = np.array([m.K for m in drawn])
    assert (K.min() > 1e9) & (K.max() < 3e9)
    # of a uniform distribution, by a Sobol sequence of 256: means and quartiles to a percent
    np.testing.assert_allclose(np.quantile(K, [0.25, 0.5, 0.75]), [1.5e9, 2e9, 2.5e9], rtol=0.01)
    level = np.array([m.G0 / PLAIN.G0 for m in drawn])
    assert abs(np.corrcoef(K, level)[0, 1]) < 0.05
    fit = bd.doubts(FITTED)["fit"]
    u = np.array([0.0227501, 0.5, 0.9772499])  # two standard deviations of a normal distribution
    np.testing.assert_allclose(fit.quantile(u), [fit.low, 1.0, fit.high], rtol=1e-6)
    assert [m.K for m in found.draws(4, seed=3)] == K[:4].tolist()
    assert found.ranges()["K"] == (1e9, 3e9)


def radial(thickness):
    def stiffness(material):
        layer = bd.Layer(r_inner=0.020, r_outer=0.020 + thickness, width=0.017, material=material)
        return layer.stiffness()[0, 0].real

    return stiffness


def test_what_a_doubt_does_is_told_by_size_and_added_up_by_squares():
    found = bd.study.doubt_effects(
        bd.doubts(PLAIN, K=(1e9, 3e9), specimen=(1.0, 1.034)), radial(0.001), "N/m"
    )
    assert found["doubt"].values.tolist() == ["K", "specimen"]
    assert float(found["nominal"]) == radial(0.001)(PLAIN)
    # a layer of real K asked by itself
    own = [radial(0.001)(replace(PLAIN, K=K)) for K in (1e9, 3e9)]
    assert found["value"].sel(doubt="K").values.tolist() == own
    up = np.hypot(
        own[1] - float(found["nominal"]),
        float(found["value"].sel(doubt="specimen", end="high") - found["nominal"]),
    )
    assert float(found["high"] - found["nominal"]) == pytest.approx(up)
    # thick rubber hardly feels K: the order turns round
    thick = bd.study.doubt_effects(
        bd.doubts(PLAIN, K=(1e9, 3e9), specimen=(1.0, 1.034)), radial(0.008), "N/m"
    )
    assert thick["doubt"].values.tolist() == ["specimen", "K"]


def test_a_thin_layer_warns_of_its_bulk_modulus_and_says_by_how_much():
    thin = bd.Layer(r_inner=0.020, r_outer=0.021, width=0.017, material=PLAIN)
    with pytest.warns(VolumeCounts, match=r"layer of 1 mm: (\d+)% of its radial") as told:
        thin.superelement()
    share = 0.01 * int(str(told[0].message).split("mm: ")[1].split("%")[0])
    # the share is d ln k/d ln K, here from two layers
    own = [radial(0.001)(replace(PLAIN, K=2e9 * (1 + s))) for s in (-0.01, 0.01)]
    assert share == pytest.approx(np.log(own[1] / own[0]) / np.log(1.01 / 0.99), abs=0.006)


@pytest.mark.filterwarnings("error::bearingdyn.notice.VolumeCounts")
def test_a_thick_layer_does_not():
    bd.Layer(r_inner=0.020, r_outer=0.024, width=0.017, material=PLAIN).superelement()


def test_wrong_intervals_and_answers_are_named():
    with pytest.raises(ValueError, match="nothing is in doubt"):
        bd.doubts(PLAIN)
    with pytest.raises(ValueError, match=r"doubt 'K'.*nominal is 2e"):
        bd.doubts(PLAIN, K=(2.5e9, 3e9))
    with pytest.raises(ValueError, match="there are \\['K'\\]"):
        bd.doubts(PLAIN, K=(1e9, 3e9)).varied(level=1.0)
    with pytest.raises(ValueError, match="K = 1e\\+09 it must be finite"):
        bd.study.doubt_effects(bd.doubts(PLAIN, K=(1e9, 3e9)), lambda m: np.nan if m.K < 2e9 else 1.0)


UNKNOWN = bd.doubts(
    FITTED, K=(1e9, 3e9), specimen=(1.0, 1 / 0.967), temperature=(-2.0, 2.0), level=(0.9, 1.1)
)


def _on_a_rig(material):
    app = bd.Application()
    app.add("layer", bd.Layer(0.020, 0.024, 0.012, material))
    app.ground("layer.outer")
    app.free("layer.inner")
    return app


def test_a_rubber_carries_its_doubts_through_json_and_a_model_file_bit_for_bit(tmp_path):
    kept = UNKNOWN.carried()
    assert kept == FITTED  # nothing that an answer hangs on
    bd.write_model(_on_a_rig(kept), tmp_path / "m.toml")
    read = bd.read_model(tmp_path / "m.toml").materials["rubber"]
    for again in (bd.Maxwell.from_json(kept.to_json()), read):
        assert again.doubts == kept.doubts == UNKNOWN.sources
        assert bd.doubts(again).sources == UNKNOWN.sources  # found again without fit and curve
        for mine, other in zip(UNKNOWN.draws(8), bd.doubts(again).draws(8), strict=True):
            assert mine == other
    # twice written, the same text
    bd.write_model(_on_a_rig(read), tmp_path / "n.toml")
    assert (tmp_path / "n.toml").read_text() == (tmp_path / "m.toml").read_text()


def test_what_is_given_anew_stands_before_what_is_carried():
    kept = bd.doubts(PLAIN, K=(1e9, 3e9), specimen=(1.0, 1.05)).carried()
    assert bd.doubts(kept, K=(1.5e9, 2.5e9)).ranges() == {"K": (1.5e9, 2.5e9), "specimen": (1.0, 1.05)}
    assert bd.doubts(kept).varied(specimen=1.05).doubts == ()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: replace(PLAIN, doubts=("K",)), r"Maxwell\.doubts is 'K'"),
        (lambda: replace(PLAIN, doubts=2 * bd.doubts(PLAIN, K=(1e9, 3e9)).sources), r"each may stand once"),
        (
            lambda: bd.doubts(replace(bd.doubts(PLAIN, K=(1e9, 3e9)).carried(), K=1.8e9)),
            r"nominal K of a doubt is 2000000000\.0; the material that carries it has another K",
        ),
        (
            lambda: bd.Maxwell.from_json(
                bd.doubts(PLAIN, K=(1e9, 3e9)).carried().to_json().replace("1000000000.0", "5e9")
            ),
            r"low ≤ nominal ≤ high",
        ),
    ],
)
def test_doubts_that_do_not_fit_their_rubber_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
