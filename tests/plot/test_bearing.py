"""Figures of bearings show the numbers they are given."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from bearingdyn import plot
from bearingdyn.bearing import (
    BallBearing,
    Lubricant,
    Running,
    Walther,
    fault_lines,
    load_distribution,
    lubricate,
    waviness_lines,
)
from bearingdyn.bearing.catalogue import bearing

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
xarray = pytest.importorskip("xarray")

BRG = bearing("6205", clearance=10e-6)
RPM = math.pi / 30


@pytest.fixture(autouse=True)
def _close():
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


def drawn(ax):
    ax.figure.canvas.draw()
    return ax


def test_load_distribution_is_drawn_at_the_balls():
    states = {}
    for label, f in (("radial", (2e3, 0, 0, 0, 0, 0)), ("combined", (2e3, 0, 1e3, 0, 0, 0))):
        states[label] = load_distribution(BRG, BRG.displacement(f))
    ax = drawn(plot.load_distribution(states))
    rings = [line for line in ax.lines if line.get_marker() == "o"]
    for line, d in zip(rings, states.values(), strict=True):
        np.testing.assert_array_equal(line.get_xydata()[:-1], np.column_stack([d.azimuth, d.load_inner]))
    assert [t.get_text() for t in ax.get_legend().get_texts()] == [
        f"{label}: {d.loaded} of 9 loaded" for label, d in states.items()
    ]


def test_stiffness_rises_with_load():
    brg = BallBearing(13, 7.938e-3, 38.5e-3, 0.52, 0.53, contact_angle=0.4)
    loads = np.geomspace(100, 1e4, 5)
    ax = drawn(
        plot.bearing_stiffness(
            {"at rest": brg, "turning": Running(brg, 1500.0)}, (0, 0, 1, 0, 0, 0), loads, "z"
        )
    )
    rest, turning = (line.get_ydata() for line in ax.lines)
    # theory.md §2 at the last load, from the ball loads
    d = load_distribution(brg, brg.displacement((0, 0, 1e4, 0, 0, 0)))
    Q, a = d.load_inner[0], d.angle_inner[0]
    Kn, length = 1.5 * brg.kappa ** (2 / 3) * Q ** (1 / 3), brg.geometry.A + (Q / brg.kappa) ** (2 / 3)
    expected = 13 * (Kn * math.sin(a) ** 2 + Q / length * math.cos(a) ** 2)
    assert rest[-1] == pytest.approx(expected, rel=1e-9)
    assert (np.diff(rest) > 0).all()
    # inner and outer angle drawn apart make a fast bearing softer
    assert (turning < rest).all()


def test_film_and_lambda_over_speed():
    oil, load = Lubricant(Walther.iso_vg(32)), (500.0, 0, 0, 0, 0, 0)
    speeds = np.geomspace(50, 1000, 4)
    ax = drawn(plot.film(BRG, oil, [40, 70], speeds, load, roughness=(30e-9, 20e-9)))
    assert len(ax.lines) == 4
    point = lubricate(BRG, oil, 70, speeds[2], load, law="nijenbanning-venner-moes", roughness=(30e-9, 20e-9))
    assert ax.lines[3].get_xydata()[2] == pytest.approx([speeds[2] / RPM, point.film_outer * 1e6])
    lower = next(other for other in ax.figure.axes if other is not ax)
    assert lower.get_ylabel() == "λ ratio"
    assert lower.lines[3].get_ydata()[2] == pytest.approx(point.lambda_outer)


def test_lines_of_faults_and_waves():
    speed, Z, ratio = 1797 * RPM, 9, 7.94 / 39.04
    shaft, cage, spin = 1797 / 60, 1797 / 120 * (1 - ratio), 39.04 / 2 / 7.94 * 1797 / 60 * (1 - ratio**2)
    faults = fault_lines(BRG, speed, harmonics=2)
    expected = {
        "shaft": shaft, "FTF": cage, "BPFO": Z * cage, "BPFI": Z * (shaft - cage), "2 BSF": 2 * spin,
        "2 BPFO": 2 * Z * cage, "2 BPFI": 2 * Z * (shaft - cage), "4 BSF": 4 * spin,
    }  # fmt: skip
    assert faults == pytest.approx(expected, rel=1e-12)
    # theory.md §2, published
    assert faults["BPFO"] == pytest.approx(107.36, abs=5e-3)
    waves = waviness_lines(BRG, speed)
    assert waves == pytest.approx(
        {
            "inner 9 ax": 9 * (shaft - cage),
            "inner 8 rad": 9 * (shaft - cage) - shaft,
            "inner 10 rad": 9 * (shaft - cage) + shaft,
            "outer 9(±1)": 9 * cage,
            "ball 2 ax": 2 * spin,
            "ball 2 rad −": 2 * spin - cage,
            "ball 2 rad +": 2 * spin + cage,
        },
        rel=1e-12,
    )


def test_spectrum_names_the_lines():
    f = np.linspace(0, 400, 401)
    data = xarray.Dataset(
        {"amplitude": ("frequency", 1e-9 + 1e-6 * np.exp(-((f - 107) ** 2)), {"units": "m"})},
        {"frequency": f},
        {"channel": "shaft.left.y"},
    )
    ax = drawn(plot.bearing_spectrum({"run": data}, BRG, 1797 * RPM, waviness=True))
    names = {t.get_text() for t in ax.texts}
    assert names == {
        *fault_lines(BRG, 1797 * RPM),
        "inner 8 rad",
        "inner 10 rad",
        "ball 2 rad −",
        "ball 2 rad +",
    }


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: plot.load_distribution({}), "nothing to draw"),
        (lambda: plot.bearing_stiffness({"a": BRG}, (1, 0, 0, 0, 0, 0), [1, 2], "u"), "component is 'u'"),
        (lambda: plot.bearing_stiffness({"a": BRG}, (1, 0, 0, 0, 0, 0), [2, 1]), "loads must"),
        (lambda: plot.film(BRG, Lubricant(Walther.iso_vg(32)), 40, [0, 1], np.ones(6)), "speeds must"),
        (lambda: fault_lines(BRG, 1.0, harmonics=0), "harmonics is 0"),
        (lambda: waviness_lines(BRG, 1.0, ball_orders=(3,)), "ball_orders is "),
    ],
)
def test_bad_input_is_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(("f_max", "waviness"), [(200.0, False), (3000.0, False), (600.0, True), (6e4, True)])
def test_each_name_is_led_to_its_own_line_and_no_line_goes_through_a_name(f_max, waviness):
    """6203 at 150 rad/s: BPFO 73, 2 BSF 95 and BPFI 118 Hz, a few pixels apart where f_max is high."""
    f = np.linspace(0, f_max, 400)
    data = xarray.Dataset(
        {"amplitude": ("frequency", 1e-9 + 1e-6 * np.exp(-((f - 107) ** 2)), {"units": "m"})},
        {"frequency": f},
        {"channel": "shaft.left.y"},
    )
    brg = bearing("6203", clearance=10e-6)
    ax = drawn(plot.bearing_spectrum({"run": data}, brg, 150.0, f_max=f_max, waviness=waviness, harmonics=3))
    ax.figure.canvas.draw()
    known = fault_lines(brg, 150.0, harmonics=3)
    if waviness:
        known |= waviness_lines(brg, 150.0, multiples=3)
    leaders = {
        p.get_gid(): (p.coords1.transform(p.xy1), p.coords2.transform(p.xy2))
        for p in ax.findobj(matplotlib.patches.ConnectionPatch)
    }
    boxes = {t.get_text(): t.get_window_extent() for t in ax.texts}
    assert set(boxes) == set(leaders) >= {"BPFO", "BPFI", "2 BSF"} & {n for n in known if known[n] <= f_max}
    scale = ax.get_xaxis_transform()
    for name, (foot, head) in leaders.items():
        # the foot is the upper end of the line of that frequency: to a hundredth of a pixel
        (line,) = [ln for ln in ax.get_lines() if ln.get_gid() == name]
        top = scale.transform((known[name], line.get_ydata()[1]))
        np.testing.assert_allclose(foot, top, atol=0.01)
        # the head is nearest to that name of all, and below it by less than a letter
        away = {n: np.hypot((b.x0 + b.x1) / 2 - head[0], b.y0 - head[1]) for n, b in boxes.items()}
        assert min(away, key=away.get) == name
        assert away[name] < 8.0
        # whatever goes down from there begins below all names
        assert top[1] <= min(b.y0 for b in boxes.values())
    along = [boxes[n].x0 for n in sorted(boxes, key=known.get)]
    assert along == sorted(along), "names in the order of the lines: no leaders cross"
    widths = sorted((b.x0, b.x1) for b in boxes.values())
    assert all(a[1] <= b[0] + 0.4 for a, b in itertools.pairwise(widths))
