"""What an object prints of itself in one line: few numbers as they are, many counted."""

from __future__ import annotations

import numpy as np

import bearingdyn as bd
from bearingdyn.material import WLF, FitReport
from bearingdyn.study import Case
from bearingdyn.study.optimum import Optimum


def test_an_optimum_prints_its_answer() -> None:
    """The design, its values and the price of a limit; a limit of mappings was all that stood there."""
    best = Optimum({"a": 0.0125, "b": 2.0}, {"y": 3.25}, ("y", 3.25), {}, {"a": -1.5}, 1e-9, 12, (3.25,))
    told = repr(best)
    for shown in ("parameters={a: 0.0125, b: 2}", "values={y: 3.25}", "prices={}", "at_range={a: -1.5}"):
        assert shown in told, told


def test_a_case_prints_parameters_and_values() -> None:
    """A study's case names what was asked and what came of it."""
    assert repr(Case({"width": 0.012, "rubber": "soft"}, {"L": 61.2345678})) == (
        "Case(parameters={width: 0.012, rubber: 'soft'}, values={L: 61.2346})"
    )


def test_many_entries_are_counted() -> None:
    """A mapping that would fill several lines is told by its names, and those are cut."""
    told = repr(Case({f"parameter_{k}": k / 7 for k in range(40)}, {}))
    assert told.startswith("Case(parameters=<40: parameter_0, parameter_1")
    assert len(told) < 120


def test_a_fit_prints_the_names_of_its_parameters() -> None:
    """Eleven names make one line, so they are written out."""
    names = ("ln G0", *(f"ln G{k}" for k in range(1, 6)), *(f"ln tau{k}" for k in range(1, 6)))
    report = FitReport((1.0, 1e3), (1.0, 1e3), 40, 0.01, 0.02, 0.03, 0.04, names, np.eye(11))
    assert "names=('ln G0', 'ln G1'" in repr(report)
    assert "'ln tau5')" in repr(report)


def test_a_shift_law_prints_six_digits() -> None:
    """Fitted constants have sixteen digits and two that are known."""
    assert repr(WLF(8.123456789012345, 93.98765432101234, 20.0)) == "WLF(C1=8.12346, C2=93.9877, T_ref=20)"


def test_a_plan_names_its_parts_and_bearings() -> None:
    """An application's plan is told by what it holds, not by its address."""
    told = repr(bd.examples.motor().plan)
    assert told.startswith("<Plan: ")
    assert "2 bearings" in told
    assert "shaft" in told
    assert "0x" not in told
