"""Levels of DMA runs: one factor for each specimen, found with the shifts."""

from dataclasses import replace

import numpy as np
import pytest
from tests.measured import measured

import bearingdyn as bd
from bearingdyn.notice import UnequalRuns

MODEL = bd.Maxwell(
    1e6,
    np.array([3.0, 2.5, 2.0, 1.6, 1.3, 1.0, 0.8, 0.6]) * 1e6,
    np.geomspace(1e-7, 1.0, 8),
    K=2e9,
    density=1100.0,
)
FREQUENCY = np.geomspace(0.1, 50.0, 15)


def made(runs, scatter=0.005, seed=0):
    """Isotherms by a WLF law: {run: (temperatures, level)}, each modulus with a scatter."""
    rng = np.random.default_rng(seed)
    columns = {name: [] for name in ("frequency", "temperature", "storage", "loss", "run")}
    for run, (temperatures, level) in runs.items():
        for T in temperatures:
            shift = -8.0 * (T - 20.0) / (120.0 + T - 20.0)
            G = level * MODEL.complex_modulus(2 * np.pi * FREQUENCY * 10**shift)
            noise = np.exp(scatter * rng.normal(size=(2, FREQUENCY.size)))
            columns["frequency"] += FREQUENCY.tolist()
            columns["temperature"] += [T] * FREQUENCY.size
            columns["storage"] += (G.real * noise[0]).tolist()
            columns["loss"] += (G.imag * noise[1]).tolist()
            columns["run"] += [run] * FREQUENCY.size
    return bd.material.DMAData(
        *(np.array(columns[name]) for name in ("frequency", "temperature", "storage", "loss")),
        "shear",
        "made",
        run=np.array(columns["run"]),
        runs_chosen=True,
    )


@pytest.mark.parametrize("level", [0.9, 1.06])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_levels_of_made_runs_are_found_within_twice_their_error(level, seed):
    dma = made({"a": (np.arange(-20.0, 15.0, 5.0), 1.0), "b": (np.arange(15.0, 50.0, 5.0), level)}, seed=seed)
    with pytest.warns(UnequalRuns, match=r"'b' .*levels=None"):
        curve = bd.master_curve(dma, T_ref=20.0)
    assert curve.levels["a"] == 1.0
    assert curve.levels["b"] * level == pytest.approx(1.0, abs=2 * level * curve.level_errors["b"])
    assert curve.level_errors["b"] < 0.02
    alone = bd.master_curve(dma, T_ref=20.0, levels=None)
    assert alone.levels == {}
    assert curve.law_residual < 0.5 * alone.law_residual


def test_three_runs_have_a_factor_each():
    dma = made(
        {
            "a": (np.arange(-20.0, 5.0, 5.0), 1.0),
            "b": (np.arange(5.0, 30.0, 5.0), 0.93),
            "c": (np.arange(30.0, 55.0, 5.0), 1.05),
        }
    )
    with pytest.warns(UnequalRuns):
        curve = bd.master_curve(dma, T_ref=20.0)
    for run, level in (("b", 0.93), ("c", 1.05)):
        assert curve.levels[run] * level == pytest.approx(1.0, abs=2 * curve.level_errors[run] * level)


@pytest.mark.filterwarnings("error::bearingdyn.notice.UnequalRuns")
def test_runs_of_one_level_are_left_in_peace():
    dma = made({"a": (np.arange(-20.0, 15.0, 5.0), 1.0), "b": (np.arange(15.0, 50.0, 5.0), 1.0)})
    curve = bd.master_curve(dma, T_ref=20.0)
    assert curve.levels["b"] == pytest.approx(1.0, abs=max(0.02, 3 * curve.level_errors["b"]))


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
def test_runs_that_share_temperatures_tell_their_levels_there(seed):
    """Three runs, each with a temperature of the one before; their scatter over √n is the error."""
    dma = made(
        {
            "a": (np.arange(-20.0, 15.0, 10.0), 1.0),
            "b": (np.arange(10.0, 45.0, 10.0), 0.93),
            "c": (np.arange(30.0, 65.0, 10.0), 1.06),
        },
        scatter=0.01,
        seed=seed,
    )
    with pytest.warns(UnequalRuns, match=r"'b' 1\.0\d\d ± 0\.00\d, 'c' 0\.9\d\d ± 0\.00\d"):
        curve = bd.master_curve(dma, T_ref=20.0)
    for run, level in (("b", 0.93), ("c", 1.06)):
        assert curve.levels[run] * level == pytest.approx(1.0, abs=2 * curve.level_errors[run] * level)
        assert curve.level_errors[run] < 0.006
    assert list(curve.shifts) == [-20.0, -10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]
    G = MODEL.complex_modulus(2 * np.pi * curve.frequency)
    assert np.median(np.abs(curve.storage / G.real - 1)) < 0.01


def test_a_temperature_in_common_needs_no_law():
    """The level of runs without scatter, by one isotherm of both, whatever law the shifts follow."""
    dma = made({"a": ([0.0, 10.0, 20.0], 1.0), "b": ([20.0, 30.0], 0.9)}, scatter=0.0)
    with pytest.warns(UnequalRuns):
        curve = bd.master_curve(dma, T_ref=20.0, law="free")
    assert curve.levels["b"] == pytest.approx(1 / 0.9, rel=1e-9)


def test_curves_that_do_not_meet_tell_no_level():
    """A gap of two decades: a smooth spectrum is a guess across it, and so would be a level."""
    dma = made({"a": ([-20.0, -10.0, 0.0], 1.0), "b": ([80.0, 90.0, 100.0], 0.9)})
    with pytest.warns(UnequalRuns, match="runs without overlap: .* level of 'b'"):
        curve = bd.master_curve(dma, T_ref=20.0)
    assert curve.levels == {"a": 1.0, "b": 1.0}
    assert curve.level_errors["b"] == np.inf


def test_one_run_has_one_isotherm_at_a_temperature():
    dma = made({"a": ([0.0, 10.0], 1.0), "b": ([10.0, 20.0], 1.0)})
    again = replace(dma, run=np.array(["a"] * dma.frequency.size), isotherm=dma.isotherm)
    with pytest.raises(ValueError, match=r"two isotherms at 10 °C"):
        bd.master_curve(again, T_ref=20.0)


def test_the_measured_runs_differ_by_six_percent():
    """f ≤ 10 Hz: .94 ± .01 for the second run, and the law's residual falls from .091 to .033 decade."""
    dma = measured("epdm70").select(f_max=10.0, run=["tf_015p", "tf_015p_high"])
    with pytest.warns(UnequalRuns, match="tf_015p_high"):
        curve = bd.master_curve(dma, T_ref=20.0)
    assert curve.levels["tf_015p_high"] == pytest.approx(0.94, abs=0.01)
    assert curve.level_errors["tf_015p_high"] < 0.01
    assert curve.law_residual <= 0.035
    assert bd.master_curve(dma, T_ref=20.0, levels=None).law_residual == pytest.approx(0.091, abs=0.001)


def test_levels_may_be_given_by_hand():
    dma = made({"a": (np.arange(-20.0, 15.0, 5.0), 1.0), "b": (np.arange(15.0, 50.0, 5.0), 0.9)})
    curve = bd.master_curve(dma, T_ref=20.0, levels={"b": 1 / 0.9})
    assert curve.levels == {"a": 1.0, "b": pytest.approx(1 / 0.9)}
    one = bd.master_curve(dma, T_ref=20.0, levels={"a": 0.9})
    assert one.storage == pytest.approx(0.9 * curve.storage, rel=1e-9)


def test_runs_that_nothing_holds_together_are_named():
    """One isotherm each of the later runs: a level and a shift are the same thing there."""
    dma = made({"a": ([0.0, 10.0], 1.0), "b": ([30.0], 0.8), "c": ([60.0], 0.7)})
    with pytest.warns(UnequalRuns, match=r"do not tell the levels|runs without overlap"):
        curve = bd.master_curve(dma, T_ref=20.0)
    assert curve.levels in ({}, {"a": 1.0, "b": 1.0, "c": 1.0})


@pytest.mark.parametrize(
    ("levels", "message"),
    [
        ({"x": 1.0}, r"there are the runs \['a', 'b'\]"),
        ({"b": 0.0}, r"levels\['b'\] is 0\.0"),
        ("guess", r"it must be 'find'"),
    ],
)
def test_levels_that_cannot_be_are_refused(levels, message):
    dma = made({"a": (np.arange(-20.0, 15.0, 5.0), 1.0), "b": (np.arange(15.0, 50.0, 5.0), 1.0)})
    with pytest.raises(ValueError, match=message):
        bd.master_curve(dma, T_ref=20.0, levels=levels)
