"""Numbers in another unit than SI are refused by name, before long work; numbers of large machines pass."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing.catalogue import bearing, estimate
from bearingdyn.bearing.mounting import Mounting, Seat
from bearingdyn.fem import box_mesh
from bearingdyn.material import OutsideBand, PowerLaw, fit_dense
from bearingdyn.notice import AssumedMeaning, ClampedBalls, UnlikelyModulus, UnusualMagnitude, warn
from bearingdyn.parts import Region

SOFT = bd.Maxwell(1e6, [2e6], [1e-3], K=2e9, density=1200.0)
BALLS = {"Z": 9, "Dw": 7.94e-3, "Dpw": 39.04e-3, "fi": 0.52, "fo": 0.53}


@pytest.mark.parametrize(
    ("field", "make"),
    [
        ("Section length is 300 m", lambda: bd.Section(300, 25)),
        ("Section d_outer is 25 m", lambda: bd.Section(30, 25)),
        ("the length of all sections is 120 m", lambda: bd.Shaft([bd.Section(40, 0.2)] * 3, {"a": 1.0})),
        ("Section length is 300 m", lambda: bd.Disc.cylinder(0.1, 120, 300)),
        ("width is 120 m", lambda: bd.Housing(width=120, height=120, length=20, bore_diameter=56)),
        ("length is 20 m", lambda: bd.Housing(width=0.12, height=0.12, length=20, bore_diameter=0.056)),
        ("r_outer is 28 m", lambda: bd.Layer(26, 28, 15, SOFT)),
        ("width is 15 m", lambda: bd.Layer(0.026, 0.028, 15, SOFT)),
        ("r_outer is 60 m", lambda: bd.Ring(50, 60, 20)),
        (r"r\[1\] is 28 m", lambda: Region((26, 28), (0, 5), SOFT)),
        (r"z\[1\] - z\[0\] is 15 m", lambda: Region((0.026, 0.028), (0, 15), SOFT)),
        ("r_outer is 60 m", lambda: bd.RigidBody.ring(50, 60, 20)),
        ("Dw is 7.94 m", lambda: bd.BallBearing(**{**BALLS, "Dw": 7.94, "Dpw": 39.04}, clearance=1e-5)),
        ("Dpw is 39.04 m", lambda: bd.BallBearing(**{**BALLS, "Dpw": 39.04}, clearance=1e-5)),
        ("outside is 52 m", lambda: estimate(25, 52, 15)),
        ("outside is 52 m", lambda: Mounting(25, 52)),
    ],
)
def test_millimetres_are_not_metres(field, make):
    with pytest.raises(ValueError, match=f"{field}; it must be at most .*; is it in mm\\? give "):
        make()


def test_a_solid_of_millimetres_is_refused():
    pytest.importorskip("skfem")
    with pytest.raises(ValueError, match=r"x is 120 m; .*is it in mm"):
        box_mesh([0, 60.0, 120.0], [0, 60.0], [0, 20.0], "hex20")
    mesh = box_mesh([0, 0.06, 0.12], [0, 0.06], [0, 0.02], "hex20")
    mesh = replace(mesh, points=1e3 * mesh.points)
    with pytest.raises(ValueError, match=r"the body's extent is 120 m; .*is it in mm"):
        bd.Solid(mesh, bd.STEEL, {"end": "x-"}, 0.0)


def test_a_large_machine_passes():
    """A ship's line of shafts, the hub of a turbine, a slewing bearing."""
    bd.Shaft([bd.Section(30.0, 1.2)] * 3, {"a": 1.0}, f_max=100.0)
    bd.Section(2.0, 4.5)
    bd.Housing(width=8.0, height=8.0, length=3.0, bore_diameter=4.0)
    bd.RigidBody.ring(2.0, 4.0, 1.0)
    bd.BallBearing(Z=200, Dw=0.08, Dpw=6.0, fi=0.52, fo=0.53, clearance=2e-3)


@pytest.mark.parametrize(("clearance", "unit"), [(10, "µm"), (1e-3, "mm"), (0.012, "mm")])
def test_clearance_in_another_unit_is_refused(clearance, unit):
    """12 µm in mm are 0.012, and nobody gives 0.012 µm."""
    with pytest.raises(
        ValueError,
        match=rf"clearance is {clearance}; it must be at most Dw/10, 0.000794 m; is it in {unit}\? give ",
    ):
        bd.BallBearing(**BALLS, clearance=clearance)


def test_balls_that_would_yield_and_clearance_that_is_eaten_are_told():
    with pytest.raises(ValueError, match=r"clearance is -0.001; it must be at least -Dw/50.* in mm"):
        bd.BallBearing(**BALLS, clearance=-1e-3)
    with pytest.warns(UnusualMagnitude, match=r"clearance.*clamped by Dw/200 have 2.4 GPa"):
        bd.BallBearing(**BALLS, clearance=-6e-5)
    tight = Mounting(25e-3, 52e-3, Seat(25e-6))
    with pytest.warns(ClampedBalls, match=r"take 20.1 µm of a clearance of 1 µm: .* GPa\) .*looser fits"):
        left = tight.mounted(bd.BallBearing(**BALLS, clearance=1e-6)).clearance
    assert left == pytest.approx(1e-6 - 25e-6 * 25 / 31.1, rel=1e-3)
    with pytest.raises(ValueError, match=r"clearance is -0.0.*looser fits.*the balls yield"):
        Mounting(25e-3, 52e-3, Seat(400e-6)).mounted(bd.BallBearing(**BALLS, clearance=1e-6))


def test_catalogue_takes_the_designation_as_a_number_too():
    assert bearing(6205, clearance=1e-5) == bearing("6205", clearance=1e-5)
    with pytest.raises(ValueError, match="designation is 6999; the nearest are"):
        bearing(6999, clearance=1e-5)


@pytest.mark.parametrize("density", [7.85, 1.2, 7.85e-9, 7.85e-6, 9.9, 7.85e6])
def test_densities_in_other_units_are_refused(density):
    """g/cm³, t/mm³, kg/mm³, g/m³."""
    for make in (
        lambda: bd.Elastic(210e9, 0.3, density),
        lambda: bd.Maxwell(1e6, [], [], K=2e9, density=density),
        lambda: PowerLaw(1e6, 0.2, 100.0, K=2e9, density=density),
    ):
        with pytest.raises(ValueError, match=r"density is .*is it in g/cm³"):
            make()


@pytest.mark.parametrize("density", [1e-3, 30.0, 1150.0, 22600.0])
def test_densities_of_foam_to_osmium_and_of_a_massless_layer_pass(density):
    # sound at 20 m/s or more: 1e8 Pa and more for osmium
    assert bd.Elastic(1e8, 0.3, density).density == density
    assert bd.Maxwell(1e6, [], [], K=2e9, density=density).density == density


@pytest.mark.parametrize("E", [210.0, 3.0])
def test_youngs_modulus_in_gigapascals_is_refused(E):
    with pytest.raises(ValueError, match=r"Elastic.E is .* is it in GPa"):
        bd.Elastic(E, 0.3, 7850.0)


def test_bulk_modulus_leaves_a_poissons_ratio_above_zero():
    """ν = (3K − 2G)/(6K + 2G) vanishes at K = 2G/3, G = 3 MPa right after a step."""
    bd.Maxwell(1e6, [2e6], [1e-3], K=2.0001e6, density=1200.0)
    with pytest.raises(ValueError, match="Poisson's ratio would be negative; a rubber's bulk modulus"):
        bd.Maxwell(1e6, [2e6], [1e-3], K=1.9999e6, density=1200.0)
    # in a band that ends where the branch is still relaxed, G is G0
    low = bd.Maxwell(1e6, [2e6], [1e-6], K=1.9999e6, density=1200.0, band=(1.0, 10.0))
    assert low.K == 1.9999e6


@pytest.fixture(scope="module")
def curve():
    return bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)


def test_fit_refuses_a_bulk_modulus_before_it_fits(curve):
    for fit in (bd.fit_maxwell, fit_dense):
        with pytest.raises(ValueError, match=r"K is 2000 Pa.*near 2e9 Pa"):
            fit(curve, K=2000.0, density=1150.0)


def test_reference_temperature_in_kelvin_is_refused():
    dma = bd.read_dma(bd.sample_dma_path())
    with pytest.raises(ValueError, match=r"T_ref is 293 °C, more than 100 K outside.*is it in kelvin"):
        bd.master_curve(dma, T_ref=293.0)


def test_band_beyond_the_master_curve_is_not_claimed(curve):
    """The report names the frequencies the points have; the band ends twice beyond them."""
    top = float(curve.frequency[-1])
    with pytest.warns(OutsideBand, match="goes beyond the master curve") as caught:
        rubber = bd.fit_maxwell(curve, 3, (100.0, 1e4 * top), K=2e9, density=1150.0)
    assert caught[0].filename == __file__
    inside = curve.frequency[curve.frequency >= 100.0]
    assert rubber.fit.covered == pytest.approx((inside[0], top), rel=1e-12)  # ω to f and back: round-off
    assert rubber.fit.band == rubber.band == (100.0, 2 * top)
    with pytest.warns(OutsideBand, match="extrapolates"):
        rubber.complex_modulus(2 * np.pi * 3 * top)


def table(storage):
    f, T = np.tile([1.0, 10.0, 100.0], 2), np.repeat([10.0, 30.0], 3)
    G = storage * np.tile([1.0, 1.5, 2.0], 2)
    return np.column_stack([f, T, G, 0.2 * G])


def test_moduli_in_kilopascals_are_doubted_where_they_are_read():
    with pytest.warns(UnlikelyModulus, match="no storage modulus above 4000 Pa.* in kPa or MPa") as caught:
        bd.read_dma(table(2000.0), mode="shear")
    assert caught[0].filename == __file__  # the user's line, not the package's
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bd.read_dma(table(6000.0), mode="shear")  # above 1e4 Pa at the top


def test_a_warning_points_at_the_line_outside_the_package():
    with pytest.warns(AssumedMeaning, match="here") as caught:
        warn("here", AssumedMeaning)
    assert caught[0].filename == __file__
    # through a dataclass's own __init__, whose code stands in no file
    curve = PowerLaw.of_loss_factor(1e6, 0.3, 100.0, K=2e9, density=1100.0)
    with pytest.warns(OutsideBand) as caught:
        curve.maxwell(3, band=(1.0, 100.0)).loss_factor(2 * math.pi * 1e5)
    assert caught[0].filename == __file__


HEADER = "frequency,temperature,storage,loss\n"


def test_all_faults_of_the_columns_are_in_one_message(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text(HEADER + "1,293,5,1\n")
    with pytest.raises(ValueError, match="no unit for the temperature") as found:
        bd.read_dma({"frequency": [1], "temperature": [293], "storage modulus": [5], "loss modulus": [1]})
    for part in ("for the temperature", "for the storage", "for the loss", "tell G"):
        assert part in str(found.value)
    path.write_text("frequency,temperature,storage modulus,x\n1,20,5,1\n")
    with pytest.raises(ValueError, match=r"recognised as loss.*for the storage"):
        bd.read_dma(path)


def test_temperature_without_unit_is_celsius_and_that_is_said():
    G = {"frequency_Hz": [1, 2], "G' (MPa)": [1, 1.1], 'G" (MPa)': [0.1, 0.1]}
    with pytest.warns(AssumedMeaning, match="no unit for the temperature: taken as °C"):
        dma = bd.read_dma({**G, "temperature": [20, 20]})
    assert dma.temperature.tolist() == [20.0, 20.0]
    assert any("taken as °C" in note for note in dma.notes)
    with pytest.raises(ValueError, match="no unit for the temperature"):
        bd.read_dma({**G, "temperature": [293, 293]})


def test_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"none.csv: no such file; give the path of a table"):
        bd.read_dma(tmp_path / "none.csv")
