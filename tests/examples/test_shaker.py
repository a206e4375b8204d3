"""The shaker example: measured peaks predicted from DMA data alone, and what each cause would change."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shaker

import bearingdyn as bd

RIG = shaker.Rig(0.25, 0.015, 0.02, 0.006, 0.0059, 0.01675)
F = np.linspace(200.0, 800.0, 1201)
needs_data = pytest.mark.skipif(not shaker.DATA.exists(), reason=f"{shaker.DATA} is not here")


@cache
def rubber() -> bd.Maxwell:
    """Some lossy rubber, tan δ near 0.1 in 200–800 Hz."""
    return bd.Maxwell(5e6, [0.6e6, 0.8e6, 1.5e6], [1e-3, 2e-4, 4e-5], K=2e9, density=1000.0)


def modulus() -> shaker.Complex:
    return np.asarray(rubber().complex_modulus(2 * np.pi * F))


def peak_of(rig: shaker.Rig, G: shaker.Complex | None = None) -> shaker.Peak:
    return shaker.peak(F, shaker.transmissibility(rig, F, modulus() if G is None else G))


# ---------------------------------------------------------------- the method, on any rubber


def test_the_peak_of_a_mass_on_a_constant_complex_spring_is_read_exactly() -> None:
    eta, f0 = 0.1, 371.3
    H = (1 + 1j * eta) / (1 + 1j * eta - (F / f0) ** 2)
    found = shaker.peak(F, H)
    # 1/|H|² = ((1 − r²)² + η²)/(1 + η²) is a parabola in r²: to the round-off of its fit
    assert found.frequency == pytest.approx(f0, rel=1e-9)
    assert found.height == pytest.approx(math.sqrt(1 + eta**2) / eta, rel=1e-9)


def test_a_bonded_ring_is_softer_than_pure_shear_and_stiffer_than_a_beam() -> None:
    # Simple shear is an admissible displacement: an upper bound. The stresses of a beam clamped at both ends
    # (E = 3G, Cowper's shear coefficient of a thick tube for ν = ½) balance: a lower one.
    m = (RIG.r_inner / RIG.r_outer) ** 2
    nu = 0.5
    kappa = 6 * (1 + nu) * (1 + m) ** 2 / ((7 + 6 * nu) * (1 + m) ** 2 + (20 + 12 * nu) * m)
    inertia = math.pi / 4 * (RIG.r_outer**4 - RIG.r_inner**4)
    beam = 1 / (1 / kappa + RIG.thickness**2 * RIG.area / (12 * 3 * inertia))
    assert beam < RIG.bending < 1.0
    # a thin ring has no room to bend and little free edge: the lost share falls as t does
    thin = replace(RIG, thickness=RIG.thickness / 8)
    assert 1 - thin.bending == pytest.approx((1 - RIG.bending) / 8, rel=0.1)  # the first order in t/b


def test_the_rig_is_the_application_of_ring_mass_and_base() -> None:
    """The same half rig through an application: a body pushed at the base, both ends kept from tilting."""
    app = bd.Application()
    half = replace(RIG, mass=RIG.mass / 2, discs=RIG.discs / 2)
    body = RIG.ring
    ring = replace(body, regions=(replace(body.regions[0], material=rubber()),))
    app.add("base", bd.RigidBody(1.0, (1.0, 1.0, 1.0)))
    app.add("ring", ring)
    app.add("mass", bd.RigidBody(half.moving, (1.0, 1.0, 1.0)))
    for end, place in (("low", "base"), ("high", "mass")):
        app.connect(f"ring.{end}", f"{place}.centre")
        app.ground(f"{place}.centre", stiffness=(0, 0, 0, 1e12, 1e12, 1e12))
    f = F[::40]
    data = bd.frequency_response(app, f, ["base.centre.x"], ["base.centre.x", "mass.centre.x"])
    x = data["response"].values[:, :, 0]
    H = shaker.transmissibility(RIG, F, modulus())[::40]
    # the springs against tilting are 1e9 times as stiff as the ring
    assert np.abs(x[:, 1] / x[:, 0] - H).max() < 1e-6 * np.abs(H).max()


def test_the_rubber_counts_a_third_of_its_mass() -> None:
    rubber_mass = 2 * RIG.density * RIG.area * RIG.thickness
    light = peak_of(replace(RIG, density=1e-6 * RIG.density))
    lumped = peak_of(replace(RIG, density=1e-6 * RIG.density, discs=RIG.discs + rubber_mass / 3))
    moved = peak_of(RIG)
    # a third is exact for a linear shape; bending changes the effect of 3 % by a fifth of it at most
    assert moved.frequency < light.frequency
    assert moved.frequency == pytest.approx(lumped.frequency, rel=1e-3)


def test_equal_rings_do_not_let_the_mass_rock_and_unequal_ones_do_in_second_order() -> None:
    plain, heavy = (peak_of(replace(RIG, inertia=i)) for i in (1e-5, 13e-5))
    assert heavy.frequency == pytest.approx(plain.frequency, rel=1e-12)  # by symmetry, to round-off
    assert heavy.height == pytest.approx(plain.height, rel=1e-12)
    still = peak_of(RIG).frequency
    shift = [peak_of(replace(RIG, unequal=u)).frequency / still - 1 for u in (0.05, 0.1)]
    # coupling enters squared: four times for twice the difference; higher orders are (0.1)² of it
    assert shift[1] == pytest.approx(4 * shift[0], rel=0.05)
    assert abs(shift[1]) < 0.01


def test_unequal_rings_respond_as_one_body_of_revolution_of_rubber_steel_and_rubber() -> None:
    """The whole rig meshed as one: its levers, its inertia and its steel come from the elements."""
    unequal, G = 0.5, 6e6 * (1 + 0.1j)
    rig = replace(RIG, unequal=unequal, K=2e9)
    radius = math.sqrt(rig.moving / (shaker.STEEL * math.pi * rig.width))
    z = rig.width / 2
    section = (rig.r_inner, rig.r_outer)
    # bulk and shear modulus of the two rings scale together, as `unequal` has it
    soft = [bd.Maxwell(5e6, [], [], K=rig.K * (1 + s * unequal), density=rig.density) for s in (1, -1)]
    body = bd.Revolved(
        (
            bd.Region(section, (-z - rig.thickness, -z), soft[0]),
            bd.Region((0.0, radius), (-z, z), bd.STEEL),
            bd.Region(section, (z, z + rig.thickness), soft[1]),
        ),
        {"left": bd.EndFace(-z - rig.thickness), "right": bd.EndFace(z + rig.thickness)},
        {"centre": (0.0, 0.0, 0.0)},
        moduli=(6e6,),
        f_max=8e3,
    )
    part = body.superelement()
    base = np.zeros(part.n)
    base[[part.interfaces[name][0] for name in ("left", "right")]] = 1.0
    f = np.linspace(50.0, 800.0, 31)
    H = np.zeros(f.size, complex)
    for k, omega in enumerate(2 * np.pi * f):
        D = part.K - omega**2 * part.M + 0j
        for scale, stuff in zip((1 + unequal, 1 - unequal), part.viscoelastic, strict=True):
            D += 2 * scale * G * stuff.H
        x = np.concatenate([base[:12], -np.linalg.solve(D[12:, 12:], D[12:] @ base)])
        H[k] = part.outputs["centre"][0] @ x
    computed = shaker.transmissibility(rig, f, np.full(f.size, G))
    # steel of finite stiffness, and the rings' own modes from 6 kHz on: 0.3 % each of the peak
    assert np.abs(computed - H).max() < 0.006 * np.abs(H).max()


def test_a_common_factor_of_the_stiffness_moves_the_peak_and_leaves_its_height() -> None:
    plain, soft = peak_of(RIG), peak_of(RIG, 0.88 * modulus())
    # G′ rises by 2 % over the move of 6 %, which the root passes on by half
    assert soft.frequency / plain.frequency == pytest.approx(math.sqrt(0.88), rel=0.01)
    assert soft.height == pytest.approx(plain.height, rel=0.02)  # tan δ changes little over so short a way


def test_a_lossless_spring_in_series_lowers_the_frequency_and_raises_the_peak() -> None:
    share = 0.88
    G = modulus()
    series = peak_of(RIG, G / (1 + G / (share / (1 - share) * np.abs(G))))
    plain = peak_of(RIG)
    assert series.frequency < plain.frequency
    # only `share` of the compliance is lossy: the height goes as one over the loss factor, to second order
    assert series.height / plain.height == pytest.approx(1 / share, rel=0.02)


def test_what_the_peaks_ask_for_is_found_where_it_is_known() -> None:
    """Four responses of the model with a known share of stiffness and known weights give both back."""
    if not shaker.DATA.exists():
        pytest.skip(f"{shaker.DATA} is not here")
    ms = []
    for mass in (0.12, 0.25, 0.57, 1.2):
        rig = replace(RIG, mass=mass)
        f = np.linspace(50.0, 900.0, 3401)
        H = shaker.transmissibility(rig, f, 0.9 * shaker.modulus(f))
        ms.append(shaker.Measurement("", f, H, np.ones_like(f), rig, 21.0))
    share, _, more, _ = shaker.inferred(ms)
    rubber_mass = 2 * RIG.density * RIG.area * RIG.thickness
    # the parabola takes G* as constant near a peak: 1 % of the stiffness
    assert share == pytest.approx(0.9, rel=0.01)
    assert more == pytest.approx(RIG.discs + rubber_mass / 3, abs=1e-3)


# ---------------------------------------------------------------- the measurement


@cache
def measured() -> tuple[shaker.Measurement, ...]:
    return tuple(shaker.measurement(grams) for grams in shaker.MASSES)


@cache
def peaks() -> tuple[tuple[shaker.Peak, shaker.Peak], ...]:
    """Measured and predicted."""
    return tuple(
        (shaker.peak(m.frequency, m.response), shaker.peak(m.frequency, shaker.prediction(m)))
        for m in measured()
    )


@cache
def found() -> tuple[float, float, float, float]:
    return shaker.inferred(measured())


@cache
def otherwise(k: int) -> dict[str, tuple[float, float]]:
    """Relative change of frequency and height of the k-th mass for each cause."""
    base = peaks()[k][1]
    return {
        label: (p.frequency / base.frequency - 1, p.height / base.height - 1)
        for label, p in shaker.causes(measured()[k], found()[0]).items()
    }


@needs_data
def test_the_height_of_each_peak_is_predicted_within_10_percent() -> None:
    for said, computed in peaks():
        assert computed.height == pytest.approx(said.height, rel=0.10)  # asked for


@needs_data
def test_the_peak_is_read_where_the_published_maximum_is() -> None:
    published = ((510.7, 9.66), (360.6, 9.97), (239.9, 10.23), (165.8, 10.42))
    for m, (said, _), (frequency, height) in zip(measured(), peaks(), published, strict=True):
        top = int(np.argmax(np.abs(m.response)))
        assert m.frequency[top] == pytest.approx(frequency, abs=0.06)  # the digits given
        assert abs(m.response[top]) == pytest.approx(height, abs=0.006)
        # the maximum rides on the ripple of the measurement, 3 % for 573 g; the parabola goes through it
        assert said.frequency == pytest.approx(frequency, rel=0.005)
        assert said.height == pytest.approx(height, rel=0.02)


@needs_data
def test_the_frequency_is_too_high_alike_for_all_masses() -> None:
    ratio = np.array([computed.frequency / said.frequency for said, computed in peaks()])
    # The finding: the rings are 12 % softer than the DMA has it, 6 % in frequency, and 2 g of the moving mass
    # are unaccounted for, 1 % of the frequency of the lightest. Two DMA runs of the rubber differ by 4.5 %.
    assert np.all((ratio > 1.0) & (ratio < 1.08))
    # A common factor leaves the ratios between masses, where the rise of G′ over 1.6 octaves, the discs and
    # the rubber's inertia must be right: 1 % for the 2 g and the ripple.
    assert np.ptp(ratio) < 0.01
    pure = [otherwise(k)["pure shear spring, plain mass"][0] for k in range(4)]
    assert np.ptp((1 + np.array(pure)) * ratio) > 0.05  # without them they spread


@needs_data
def test_the_resonance_agrees_with_a_power_law_through_one_isotherm() -> None:
    """No superposition, no finite elements: G′ ∝ f^(2δ/π) from the 18.4 °C isotherm at 10 Hz, 2AG′/t."""
    dma = bd.read_dma(shaker.DATA / "dma.csv").select(f_max=20.0)
    near = (np.abs(dma.temperature - 18.4) < 0.5) & (np.abs(dma.frequency - 10) < 0.1)
    storage, loss = float(dma.storage[near].mean()), float(dma.loss[near].mean())
    for m, (_, computed) in zip(measured(), peaks(), strict=True):
        G = storage * (computed.frequency / 10) ** (2 / math.pi * math.atan(loss / storage))
        k = 2 * G * m.rig.area / m.rig.thickness
        rubber_mass = 2 * m.rig.density * m.rig.area * m.rig.thickness
        f = math.sqrt(k / (m.rig.moving + rubber_mass / 3)) / (2 * math.pi)
        # 3.3 % for the softening of the ring, which the spring leaves out; 1 % for 2.6 K; the tolerance is
        # for a constant δ over 1.2 (heavy) to 1.7 (light) decades: tan δ is lower at first, and rises
        assert computed.frequency == pytest.approx(
            f * (1 - 0.033 - 0.01), rel=0.015 * math.log10(computed.frequency / 10)
        )


@needs_data
def test_discs_and_rubber_count_as_their_masses_do() -> None:
    for k, m in enumerate(measured()):
        rig = m.rig
        third = 2 * rig.density * rig.area * rig.thickness / 3
        moving = rig.moving + third
        exponent = 1 / (2 - 2 / math.pi * 0.1)  # k ∝ f^(2δ/π), δ = 0.1: f ∝ m^(−1/(2 − 2δ/π))
        for label, mass in (
            ("without the discs", moving - rig.discs),
            ("discs counted twice", moving + rig.discs),
            ("rings without inertia", moving - third),
        ):
            expected = (moving / mass) ** exponent - 1
            # δ varies by a tenth over the band, a thirtieth of the effect; 0.1 % is the grid
            assert otherwise(k)[label][0] == pytest.approx(expected, rel=0.05, abs=1e-3), label


@needs_data
def test_two_kelvin_change_the_frequency_by_one_percent() -> None:
    # from the isotherms themselves: G′ at 10 Hz falls from 5.72 MPa at 11.1 °C to 4.84 MPa at 32.0 °C
    slope = math.log(4.844 / 5.724) / 20.9 / 2
    for k in range(4):
        # at the higher frequencies the slope is that of colder isotherms, up to a half steeper
        assert otherwise(k)["2 K warmer"][0] == pytest.approx(2 * slope, abs=0.004)
        assert otherwise(k)["2 K colder"][0] == pytest.approx(-2 * slope, abs=0.004)


@needs_data
def test_the_strain_of_the_rings_is_below_that_of_the_dma_and_does_not_explain_it() -> None:
    for k, m in enumerate(measured()):
        said = peaks()[k][0]
        # |H − 1| a/ω² over the thickness, with a = 0.1 g and H nearly imaginary
        strain = 100 * math.hypot(said.height, 1) * 0.981 / (2 * math.pi * said.frequency) ** 2 / 0.006
        assert shaker.strain_at_peak(m) == pytest.approx(strain, rel=0.06)  # a and H vary by 3 % and 2 %
        assert shaker.strain_at_peak(m) < 1.1 * shaker.STRAIN_DMA
    lightest, heaviest = otherwise(0), otherwise(3)
    label = "at its own strain (sweep)"
    # at the strain of the DMA nothing changes; ten times below, rubber is stiffer: away from the measurement
    assert abs(heaviest[label][0]) < 0.005
    assert 0.005 < lightest[label][0] < 0.03
    # and the sweep's loss there would raise the peak by a half, which the measurement does not show
    said, computed = peaks()[0]
    assert computed.height * (1 + lightest[label][1]) > 1.3 * said.height


@needs_data
def test_the_other_causes_are_small_or_go_the_wrong_way() -> None:
    missed: list[float] = []
    for k in range(4):
        change = {label: pair[0] for label, pair in otherwise(k).items()}
        assert -0.005 < change["Poisson's ratio 0.474"] < 0  # less bulk, more bending; the rings shear
        assert abs(change["shifts as found, without a law"]) < 0.01  # 0.04 decade of a slope of 15 % a decade
        # less than the 1/1.1 of stiffness that one of the rings loses, by far: their sum stays
        assert abs(change["rings unequal by ±10 %: rocking"]) < 0.01
        assert -0.02 < change["faces free to tilt (bound)"] < 0
        # k ∝ A/t at equal volume: 1/0.95² in stiffness, and less free edge
        assert 0.05 < change["rings squeezed by 5 %"] < 0.065
        # 0.5 mm off the outer radius takes this share of the section; the loose rim still pulls along
        rig = measured()[k].rig
        lost = 1 - (rig.r_outer - 5e-4) ** 2 / rig.r_outer**2
        assert -lost / 2 < change["outer 0.5 mm not bonded"] < 0
        # a lossless compliance would explain the frequency, and miss the height by 10 % (mean of the masses:
        # accelerometers are good to 5 %)
        series = otherwise(k)["lossless spring in series"][1]
        said, computed = peaks()[k]
        missed.append(computed.height * (1 + series) / said.height)
    assert np.mean(missed) > 1.10


@needs_data
def test_the_four_peaks_by_themselves_find_the_discs_and_one_stiffness() -> None:
    share, share_error, more, more_error = found()
    rig = measured()[0].rig
    expected = rig.discs + 2 * rig.density * rig.area * rig.thickness / 3
    assert more == pytest.approx(expected, abs=3 * more_error)
    assert more_error < 2e-3
    assert 0.8 < share < 0.95
    assert share_error < 0.01


@needs_data
def test_the_figure_shows_four_masses_measured_and_predicted(tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    path = tmp_path / "new" / "shaker.png"
    shaker.figure(measured(), path)
    assert 20e3 < path.stat().st_size < 200e3  # a picture, and small enough for the README


def test_without_the_measurement_the_example_says_so(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(shaker, "DATA", tmp_path / "absent")
    assert shaker.main() == 0
    assert "skipped" in capsys.readouterr().out


# ---------------------------------------------------------------- amplitude


def answer_of(grams: int, level: str, capsys: pytest.CaptureFixture[str]) -> dict[str, dict[str, float]]:
    """What the command line says of a run."""
    folder = shaker.DATA
    run, rig = folder / f"shaker_{level}_{grams}g.csv", folder / f"shaker_{grams}g.json"
    capsys.readouterr()
    assert shaker.main(["--json", "--run", str(run), "--rig", str(rig)]) == 0
    told: dict[str, dict[str, float]] = json.loads(capsys.readouterr().out)
    return told


@needs_data
def test_softening_by_the_strain_sweep_predicts_the_runs_at_1_g(capsys: pytest.CaptureFixture[str]) -> None:
    """573 g: −4.88 % and 8.02 were computed independently; −3.92 % and 8.03 measured."""
    low, high = (answer_of(573, level, capsys) for level in ("0.1g", "1g"))
    drop = {
        side: 100 * (high[side]["frequency"] / low[side]["frequency"] - 1)
        for side in ("measured", "predicted")
    }
    assert drop["predicted"] == pytest.approx(-4.88, abs=0.1)
    assert drop["predicted"] == pytest.approx(drop["measured"], abs=1.0)
    assert high["predicted"]["height"] == pytest.approx(8.02, rel=5e-3)
    assert high["predicted"]["height"] == pytest.approx(high["measured"]["height"], rel=0.05)
    assert high["predicted"]["strain"] == pytest.approx(
        6.4e-3, rel=0.05
    )  # nominal .64 %, a sandwich has less
    light = answer_of(118, "1g", capsys)
    assert light["predicted"]["height"] == pytest.approx(light["measured"]["height"], rel=0.12)


def test_a_run_needs_its_rig(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        shaker.main(["--json", "--run", "none.csv"])
    assert "belong together" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        shaker.main(["--json", "--run", "none.csv", "--rig", "none.json"])
    assert "no such file" in capsys.readouterr().err


RIG_SAID = {
    "mass_kg": 0.25, "mass_disks": 0.0148, "thickness_m": 0.006, "outer_diameter_m": 0.0335,
    "inner_diameter_m": 0.0118, "mass_width": 0.02, "temperature": 21.0,
}  # fmt: skip


def made_run(tmp_path: Path, rows: list[str], **rig: object) -> tuple[Path, Path]:
    run, path = tmp_path / "run.csv", tmp_path / "rig.json"
    run.write_text("\n".join([",".join(shaker.COLUMNS), *rows]), encoding="utf-8")
    path.write_text(json.dumps({k: v for k, v in {**RIG_SAID, **rig}.items() if v is not None}))
    return run, path


def test_a_run_is_read_by_the_names_of_its_columns(tmp_path: Path) -> None:
    """In any order, with others between, falling in frequency, with a byte order mark."""
    run, rig = made_run(tmp_path, [])
    lines = ["mass_phase_rad,note,freq_hz,mass_accel_ms2,base_accel_ms2,base_phase_rad"]
    lines += [f"-0.5,x,{f},{2 * f},{f},0.25" for f in (300, 200, 100)]
    run.write_text("\ufeff" + "\n".join(lines), encoding="utf-8")
    found = shaker.read_run(run, rig)
    assert found.frequency.tolist() == [100.0, 200.0, 300.0]
    assert found.base.tolist() == [100.0, 200.0, 300.0]
    assert found.response == pytest.approx(np.full(3, 2 * np.exp(-0.75j)))
    assert (found.rig.r_outer, found.temperature) == (0.01675, 21.0)


@pytest.mark.parametrize(
    ("rows", "rig", "message"),
    [
        (["100,1,0,1,0"] * 2, {}, "three frequencies above zero"),
        (["100,1,0,1,0", "200,1,0,nan,0", "300,1,0,1,0"], {}, "finite"),
        (["0,1,0,1,0", "200,1,0,1,0", "300,1,0,1,0"], {}, "above zero"),
        (["100,0,0,1,0", "200,1,0,1,0", "300,1,0,1,0"], {}, "accelerations above zero"),
        (["100,1,0,x,0", "200,1,0,1,0", "300,1,0,1,0"], {}, "could not convert string to float: 'x'"),
        (["100,1,0", "200,1,0,1,0", "300,1,0,1,0"], {}, "every row has a number"),
        (["100,1,0,1,0"] * 3, {"mass_kg": None}, "'mass_kg'; a rig has the numbers"),
        (["100,1,0,1,0"] * 3, {"mass_kg": "heavy"}, "could not convert"),
        (["100,1,0,1,0"] * 3, {"inner_diameter_m": 0.04}, "inner below outer"),
        (["100,1,0,1,0"] * 3, {"thickness_m": -0.006}, "must be positive"),
    ],
)
def test_a_run_that_makes_no_sense_is_named(
    tmp_path: Path, rows: list[str], rig: dict[str, object], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        shaker.read_run(*made_run(tmp_path, rows, **rig))
