"""Campbell diagram, waterfall and mode shapes show the numbers they are given, in the units they name."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib
import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import plot

matplotlib.use("Agg")

RPM = 30 / np.pi


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    import matplotlib.pyplot as plt

    yield
    plt.close("all")


def whirling() -> xarray.Dataset:
    """A rigid rotor on isotropic springs: ω = ±IpΩ/2It + √((IpΩ/2It)² + ω0²) (theory, §3.10), and one mode
    along the axis, one without oscillation."""
    speed = np.linspace(0.0, 1000.0, 11)
    half = 0.3 * speed
    forward, backward = half + np.hypot(half, 500.0), -half + np.hypot(half, 500.0)
    fixed = np.full_like(speed, 700.0)
    omega = np.stack([forward, backward, fixed, fixed], axis=1)
    eigenvalue = omega * 1j
    eigenvalue[:, 2] = 700.0 * (-0.2 + 1j * np.sqrt(1 - 0.04))
    eigenvalue[:, 3] = -700.0
    one = np.ones_like(speed)
    return xarray.Dataset(
        {
            "frequency": (("speed", "mode"), omega / (2 * np.pi)),
            "damping_ratio": (("speed", "mode"), np.stack([0 * one, 0 * one, 0.2 * one, one], axis=1)),
            "eigenvalue": (("speed", "mode"), eigenvalue),
            "whirl": (("speed", "mode"), np.stack([one, -one, 0 * one, 0 * one], axis=1)),
        },
        coords={"speed": speed},
    )


def test_a_campbell_diagram_parts_forward_from_backward_and_leaves_out_what_does_not_swing() -> None:
    data = whirling()
    ax = plot.campbell(data, (1.0, 2.0))
    dots = {c.get_label(): c for c in ax.collections}
    assert set(dots) == {"forward", "backward", "along a line"}
    offsets = np.asarray(dots["forward"].get_offsets())
    assert offsets[:, 0] == pytest.approx(data["speed"].values * RPM)
    assert offsets[:, 1] == pytest.approx(data["frequency"].values[:, 0])
    # of the two modes along a line only the one that swings, its dots larger for its damping
    assert len(np.asarray(dots["along a line"].get_offsets())) == 11
    assert np.min(dots["along a line"].get_sizes()) > np.max(dots["forward"].get_sizes())
    assert {t.get_text() for t in ax.texts} == {"1×", "2×"}
    # the ray of the first order meets 60 f = rpm
    ray = next(line for line in ax.lines if line.get_linestyle() not in ("-",))
    x, y = (np.asarray(v, dtype=float) for v in ray.get_data())
    assert y[-1] == pytest.approx(x[-1] / 60)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("speed, rpm", "natural frequency, Hz")


@pytest.mark.parametrize("arguments", [{"f_max": 0.0}, {"f_max": float("nan")}, {"orders": [-1.0]}])
def test_a_campbell_diagram_refuses_what_is_no_frequency(arguments: dict[str, object]) -> None:
    with pytest.raises(ValueError, match="must be"):
        plot.campbell(whirling(), **arguments)  # type: ignore[arg-type]


def pieces(speed: np.ndarray) -> xarray.Dataset:
    frequency = np.linspace(0.0, 500.0, 51)
    amplitude = 1e-6 * np.exp(-(((frequency[None, :] - speed[:, None] / (2 * np.pi)) / 15.0) ** 2))
    data = xarray.Dataset(
        {
            "amplitude": (("time", "frequency"), amplitude, {"units": "m"}),
            "speed": ("time", speed, {"units": "rad/s"}),
        },
        coords={"time": np.arange(speed.size) * 0.1, "frequency": frequency},
        attrs={"channel": "shaft.disc.y"},
    )
    return data


def test_a_waterfall_stands_over_speed_in_a_run_up_and_over_time_else() -> None:
    run_up = plot.waterfall(pieces(np.linspace(100.0, 900.0, 9)), f_max=300.0)
    assert run_up.get_ylabel() == "speed, rpm"
    mesh = run_up.collections[0]
    assert mesh.get_array().shape == (9, 31)  # type: ignore[union-attr]
    # the largest line of each piece lies at the speed
    at = np.linspace(0.0, 300.0, 31)[np.asarray(mesh.get_array()).argmax(axis=1)]  # type: ignore[union-attr]
    assert at == pytest.approx(np.linspace(100.0, 900.0, 9) / (2 * np.pi), abs=5.0)  # lines are 10 Hz apart
    assert plot.waterfall(pieces(np.full(9, 300.0))).get_ylabel() == "time, s"
    with pytest.raises(ValueError, match="f_max"):
        plot.waterfall(pieces(np.full(9, 300.0)), f_max=-1.0)


def test_a_mode_shape_between_its_stations_is_that_of_a_shaft_with_more_of_them() -> None:
    """Half a sine of a shaft on stiff supports, known at three places, against the sine itself."""
    E, rho, d, L = 210e9, 7850.0, 0.02, 0.8
    app = bd.Application()
    app.add("shaft", bd.Shaft([bd.Section(L, d)], seats={"left": 0.0, "right": L}, points={"middle": L / 2}))
    for side in ("left", "right"):
        app.ground(f"shaft.{side}", stiffness=[1e10, 1e10, 1e10, 0, 0, 1e6])
    system = bd.system.assemble(app)
    modes = bd.modes(system)
    # √(EI/ρA)(π/L)²/2π, thin beam; shear and rotatory inertia take 0.2 % at this slenderness
    expected = np.sqrt(E * d**2 / (16 * rho)) * (np.pi / L) ** 2 / (2 * np.pi)
    bending = int(np.argmin(np.abs(modes["frequency"].values - expected)))
    assert float(modes["frequency"][bending]) == pytest.approx(expected, rel=5e-3)
    ax = plot.mode_shape(app, system, modes, bending)
    lines = [line for line in ax.lines if str(line.get_label()).startswith(("x,", "y,"))]
    z, u = max(
        (tuple(np.asarray(v, dtype=float) for v in line.get_data()) for line in lines),
        key=lambda pair: np.ptp(pair[1]),
    )
    assert (z[0], z[-1]) == (0.0, L)
    # the cubic through three points and slopes of a sine misses it by (π/2)⁴/384 of its height
    assert u / u[np.abs(u).argmax()] == pytest.approx(np.sin(np.pi * z / L), abs=0.02)
    assert f"{expected:.3g}"[:3] in ax.get_title(loc="left")


def test_a_mode_shape_needs_a_shaft_and_a_mode_that_is_there() -> None:
    app = bd.Application()
    app.add("mass", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.ground("mass.centre", stiffness=[1e6] * 6)
    system = bd.system.assemble(app)
    modes = bd.modes(system)
    with pytest.raises(ValueError, match="no Shaft"):
        plot.mode_shape(app, system, modes)
    app.add("shaft", bd.Shaft([bd.Section(0.3, 0.02)], seats={"end": 0.0}))
    app.ground("shaft.end")
    system = bd.system.assemble(app)
    with pytest.raises(ValueError, match="counted from 0"):
        plot.mode_shape(app, system, bd.modes(system), 10_000)
