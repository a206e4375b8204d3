"""Optima within limits against closed forms, their multipliers, and what cannot be optimised."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import study
from bearingdyn.notice import UnprovenOptimum

CUBE = {"x": (0.0, 3.0), "y": (0.0, 3.0)}


def can(d):
    """A can of radius x and height y: its surface, and its volume."""
    r, h = d["r"], d["h"]
    return {
        "surface": (
            2 * math.pi * r * (r + h),
            {"r": 2 * math.pi * (2 * r + h), "h": 2 * math.pi * r},
        ),
        "volume": (math.pi * r**2 * h, {"r": 2 * math.pi * r * h, "h": math.pi * r**2}),
    }


def test_the_can_of_least_surface_is_as_high_as_wide_and_a_litre_more_costs_what_the_closed_form_says():
    V = 2.0
    box, limits = {"r": (0.1, 3.0), "h": (0.1, 5.0)}, {"volume": (V, None)}
    best = study.optimise(can, box, minimise="surface", limits=limits, starts=4, tolerance=1e-10)
    r = (V / (2 * math.pi)) ** (1 / 3)
    assert best.parameters["r"] == pytest.approx(r, rel=1e-4)
    assert best.parameters["h"] == pytest.approx(2 * r, rel=1e-4)
    assert best.objective == ("surface", pytest.approx(6 * math.pi * r**2, rel=1e-7))
    # S = 3 (2π)^(1/3) V^(2/3), dS/dV = 2 S/(3 V)
    assert best.prices["volume"] == pytest.approx(2 * best.objective[1] / (3 * V), rel=1e-4)
    assert best.kkt < 1e-4
    assert not best.at_range
    assert "limit on volume: reached" in best.text
    assert all(end == pytest.approx(best.objective[1], rel=1e-5) for end in best.ends)


def test_a_parameter_at_the_end_of_its_range_has_its_price():
    best = study.optimise(
        can, {"r": (0.1, 0.5), "h": (0.1, 5.0)}, minimise="surface", limits={"volume": (2.0, None)}, starts=3
    )
    # r at .5: h = V/πr², S = 2πr² + 2V/r, dS/dr = 4πr − 2V/r²
    assert best.parameters["r"] == pytest.approx(0.5, abs=1e-9)
    assert best.at_range["r"] == pytest.approx(4 * math.pi * 0.5 - 2 * 2.0 / 0.25, rel=1e-6)
    assert best.kkt < 1e-8


def test_what_should_be_large_is_maximised_and_slopes_may_be_left_out():
    def hill(d):
        return {"gain": 5 - (d["x"] - 1) ** 2 - 2 * (d["y"] - 2) ** 2, "cost": d["x"] + d["y"]}

    best = study.optimise(hill, CUBE, maximise="gain", limits={"cost": 2.0}, starts=3)
    # x − 1 = 2 (y − 2) on x + y = 2: x = 1/3, y = 5/3, λ = 2 (1 − x)
    assert best.parameters == pytest.approx({"x": 1 / 3, "y": 5 / 3}, abs=1e-4)
    assert best.prices["cost"] == pytest.approx(4 / 3, rel=1e-3)


def test_of_several_hills_the_highest_is_found():
    def hills(d):
        x = d["x"]
        return {"f": (math.sin(5 * x) + 0.1 * x, {"x": 5 * math.cos(5 * x) + 0.1})}

    best = study.optimise(hills, {"x": (0.0, 6.0)}, maximise="f", starts=16, tolerance=1e-10)
    grid = np.linspace(0, 6, 100_001)
    assert best.objective[1] == pytest.approx((np.sin(5 * grid) + 0.1 * grid).max(), abs=1e-7)


def test_the_front_of_two_squares_is_the_line_between_them():
    def squares(d):
        x, y = d["x"], d["y"]
        return {
            "a": (x**2 + y**2, {"x": 2 * x, "y": 2 * y}),
            "b": ((x - 1) ** 2 + (y - 1) ** 2, {"x": 2 * (x - 1), "y": 2 * (y - 1)}),
        }

    found = study.front(squares, CUBE, objectives=("a", "b"), points=5)
    assert len(found) == 5
    for one in found:
        # √a + √b = √2 on the line
        assert math.sqrt(one.values["a"]) + math.sqrt(one.values["b"]) == pytest.approx(
            math.sqrt(2), abs=2e-3
        )
    middle = found[2]
    assert middle.prices["b"] == pytest.approx(-math.sqrt(middle.values["a"] / middle.values["b"]), rel=1e-3)


def test_limits_that_exclude_everything_are_named():
    def two(d):
        x, y = d["x"], d["y"]
        return {"f": (x, {"x": 1.0, "y": 0.0}), "g": (x + y, {"x": 1.0, "y": 1.0}), "h": y}

    with pytest.raises(ValueError, match=r"no design .* keeps the limit g ≥ 7; the nearest has g = 6"):
        study.optimise(two, CUBE, minimise="f", limits={"g": (7.0, None), "h": 2.0}, starts=2)
    with pytest.raises(ValueError, match=r"the pair of limits g ≥ 5 and h ≤ 1; the nearest"):
        study.optimise(two, CUBE, minimise="f", limits={"g": (5.0, None), "h": 1.0}, starts=2)


def test_a_design_without_a_number_is_named():
    def broken(d):
        return {"f": d["x"] if d["x"] < 0 else math.nan}

    with pytest.raises(ValueError, match=r"f is nan for the design x = .*, y ="):
        study.optimise(broken, CUBE, minimise="f", starts=2)

    def partly(d):
        f = (d["x"] - 1) ** 2 if d["y"] < 1.5 else math.nan
        return {"f": (f, {"x": 2 * (d["x"] - 1), "y": 0.0})}

    best = study.optimise(partly, CUBE, minimise="f", starts=8)
    assert best.parameters["x"] == pytest.approx(1.0, abs=1e-4)
    assert best.failed
    assert "f is nan" in best.failed[0]
    assert sum(math.isnan(e) for e in best.ends) == len(best.failed)

    def unbuildable(d):
        raise ValueError("width is 0; it must be positive")

    with pytest.raises(ValueError, match=r"the design x = .* cannot be computed: width is 0"):
        study.optimise(unbuildable, CUBE, minimise="f", starts=2)


def test_what_is_no_problem_is_named():
    with pytest.raises(ValueError, match="exactly one"):
        study.optimise(can, CUBE)
    with pytest.raises(ValueError, match="low must be below high"):
        study.optimise(can, {"r": (2.0, 1.0)}, minimise="surface")
    with pytest.raises(ValueError, match=r"limits\['volume'\]"):
        study.optimise(can, CUBE, minimise="surface", limits={"volume": (None, None)})
    box = {"r": (0.1, 1.0), "h": (0.1, 1.0)}
    with pytest.raises(ValueError, match="did you mean 'surface'"):
        study.optimise(can, box, minimise="surfaces")


def mount(d, derivatives=True):
    """A block on a rubber ring: isolation at 400 Hz, dB, sag and strain under a preload."""
    rubber = bd.Maxwell(d["G0"], [1.5e6], [2e-4], K=2e9, density=1150.0)
    app = bd.Application()
    app.add("block", bd.RigidBody(mass=20.0, inertia=(1e-1, 1e-1, 1e-1)))
    shape = {"moduli": (1e6, 3e6), "refinement": 0.5, "meshed_as": (0.02, 0.027, 0.015)}
    app.add("layer", bd.Layer(0.02, 0.02 + d["t"], d["b"], rubber, **shape))
    app.connect("block.centre", "layer.inner")
    app.ground("layer.outer")
    app.load("block.centre", (0, -d["F"], 0, 0, 0, 0))
    eq = bd.equilibrium(app)
    names = {"t": "layer.r_outer", "b": "layer.width", "G0": "layer.G0", "F": {"load.block.centre.y": -1.0}}
    slope = bd.gradient(eq, names if derivatives else ["layer.G0"])
    H = slope.response([400.0], ["ground.y"], ["block.centre.y"])
    size = abs(complex(H["response"].values.item()))
    by = H["magnitude_derivative"].values.ravel() * 20 / math.log(10) / size
    sag, by_sag = slope.displacement("block.centre.y")
    strain, by_strain = slope.strain("layer")

    def told(value, slopes, sign=1.0):
        return sign * value, dict(zip(names, (sign * slopes).tolist(), strict=False))

    return {
        "isolation": told(20 * math.log10(size), by, -1.0),
        "sag": told(sag, by_sag, -1.0),
        "strain": told(strain, by_strain),
    }


RANGES = {"t": (0.003, 0.012), "b": (0.010, 0.020), "G0": (0.4e6, 2e6), "F": (50.0, 300.0)}
LIMITS = {"sag": 8e-5, "strain": 0.012}


def test_the_best_mount_is_the_same_from_every_start():
    """Four parameters, two limits; the price of the sag is the slope between optima at two limits."""
    best = study.optimise(mount, RANGES, maximise="isolation", limits=LIMITS, starts=3)
    # 1e-3 of the objective
    assert max(best.ends) - min(best.ends) < 1e-3 * best.objective[1]
    assert best.kkt < 1e-3
    assert best.prices["sag"] > 0
    wider = study.optimise(mount, RANGES, maximise="isolation", limits=LIMITS | {"sag": 8.2e-5}, starts=1)
    gained = (wider.objective[1] - best.objective[1]) / 0.2e-5
    # the price falls a little on the way: 2 % of the limit
    assert best.prices["sag"] == pytest.approx(gained, rel=0.05)


@pytest.mark.slow
def test_a_search_with_twenty_times_as_many_designs_finds_no_better_mount():
    best = study.optimise(mount, RANGES, maximise="isolation", limits=LIMITS, starts=10)
    assert max(best.ends) - min(best.ends) < 1e-3 * best.objective[1]
    found = -math.inf
    for case in study.sobol(20 * best.evaluations, 1, **RANGES):
        y = {name: value for name, (value, _) in mount(case, derivatives=False).items()}
        if all(y[name] <= most for name, most in LIMITS.items()):
            found = max(found, y["isolation"])
    assert best.objective[1] - found > 1e-3 * best.objective[1]


def test_a_layer_with_the_mesh_of_another_is_as_stiff_as_one_meshed_anew():
    rubber = bd.Maxwell(1e6, [1.5e6], [2e-4], K=2e9, density=1150.0)
    shape = {"moduli": (1e6, 3e6), "material": rubber}
    anew = bd.Layer(0.020, 0.026, 0.014, **shape).stiffness()
    moved = bd.Layer(0.020, 0.026, 0.014, **shape, meshed_as=(0.022, 0.029, 0.017)).stiffness()
    # .02 %: what the mesh is good for
    assert np.diag(moved).real == pytest.approx(np.diag(anew).real, rel=4e-4)
    with pytest.raises(ValueError, match="meshed_as is"):
        bd.Layer(0.020, 0.026, 0.014, **shape, meshed_as=(0.03, 0.02, 0.017))


def test_an_optimum_within_the_ranges_satisfies_its_conditions():
    """No limit and no end of a range holds it: nothing of the slope is left, beside that at the starts."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        best = study.optimise(
            lambda d: {"f": (d["x"] - 2) ** 2 + (d["y"] - 1) ** 2}, CUBE, minimise="f", starts=2
        )
    assert best.parameters["x"] == pytest.approx(2.0, abs=1e-3)
    # slopes of some 3 at the starts; ftol 1e-6 of a square leaves its root
    assert best.kkt < 5e-3


def test_a_noisy_objective_is_told_of():
    with pytest.warns(UnprovenOptimum, match="misses the conditions of an optimum"):
        study.optimise(
            lambda d: {"f": (d["x"] - 0.3) ** 2 + 1e-3 * math.sin(1e6 * d["x"])},
            {"x": (0.0, 1.0)}, minimise="f", starts=2,
        )  # fmt: skip
