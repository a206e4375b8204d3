"""The demo's layer study ends in an optimum: the same from everywhere, and cheaper than a search."""

from __future__ import annotations

import layer_study
import numpy as np
import pytest

from bearingdyn import study

STARTS = 10


@pytest.fixture(scope="module")
def best() -> study.Optimum:
    return layer_study.best(STARTS)


@pytest.mark.slow
def test_every_start_ends_at_the_optimum(best: study.Optimum) -> None:
    """Four parameters, two limits, ten starts: within 1e-3 of the objective."""
    assert len(layer_study.RANGES) == 4
    assert len(layer_study.LIMITS) == 2
    assert len(best.ends) == STARTS
    assert max(best.ends) - min(best.ends) < 1e-3 * best.objective[1]
    # SLSQP's own tolerance leaves 1e-3 of the steepest slope
    assert best.kkt < 5e-3
    assert f"residual {best.kkt:.1e}" in layer_study.told(best)
    # at the optimum at least one limit or end of a range holds it, at a price
    assert best.prices | best.at_range


@pytest.mark.slow
def test_values_and_slopes_are_those_of_machines_built_anew(best: study.Optimum) -> None:
    """The slope of the isolation along a direction against a central difference of machines built anew."""
    told = layer_study.slopes(best.parameters)
    plain = layer_study.plainly(dict(best.parameters))
    for name, value in plain.items():
        # the strain of the summary and of the slopes is one number of one state
        assert told[name][0] == pytest.approx(value, rel=1e-9)
    step = {name: 1e-4 * (high - low) for name, (low, high) in layer_study.RANGES.items()}
    inside = {
        name: float(np.clip(value, low + 1e-3 * (high - low), high - 1e-3 * (high - low)))
        for (name, value), (low, high) in zip(
            best.parameters.items(), layer_study.RANGES.values(), strict=True
        )
    }
    slopes = layer_study.slopes(inside)
    up, down = (layer_study.plainly({k: v + s * step[k] for k, v in inside.items()}) for s in (1.0, -1.0))
    for name in plain:
        along = sum(slopes[name][1][k] * step[k] for k in inside)
        # second differences, 1e-8 of the curvature, beside the values' own digits
        assert along == pytest.approx(0.5 * (up[name] - down[name]), rel=1e-4)


@pytest.mark.slow
def test_twenty_times_as_many_designs_of_a_sobol_sequence_find_no_layer_as_good(best: study.Optimum) -> None:
    """5 % of the evaluations: those of one start, which each of them ended at the optimum with."""
    one = best.evaluations / STARTS
    found = -np.inf
    for case in study.sobol(round(20 * one), 1, **layer_study.RANGES):
        y = layer_study.plainly(case)
        if all(y[name] <= most for name, most in layer_study.LIMITS.items()):
            found = max(found, y["isolation"])
    assert found < (1 - 1e-3) * best.objective[1]
