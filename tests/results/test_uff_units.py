"""Dataset 58 of the Universal File Format: the unit and the direction of every component."""

from __future__ import annotations

import pytest

from bearingdyn import results
from bearingdyn.analysis import equilibrium, frequency_response, transient
from rotors import oscillator

pyuff = pytest.importorskip("pyuff")

AXES = ("x", "y", "z", "θx", "θy", "θz")
RATE = {"displacement": "", "velocity": "/s", "acceleration": "/s²"}


@pytest.mark.parametrize("quantity", RATE)
def test_lengths_and_forces_along_xyz_angles_and_moments_about_them(quantity, tmp_path):
    """Directions 1 to 3 are translations, 4 to 6 rotations (UFF 58, record 6)."""
    names = [f"body.centre.{axis}" for axis in AXES]
    H = frequency_response(oscillator(), [10.0, 20.0], names, names, quantity=quantity)
    results.write_uff(H, tmp_path / "h.uff")
    sets = iter(pyuff.UFF(str(tmp_path / "h.uff")).read_sets())
    for output in range(6):
        for given in range(6):
            found = next(sets)
            assert (found["rsp_dir"], found["ref_dir"]) == (output + 1, given + 1)
            wanted = ("m" if output < 3 else "rad") + RATE[quantity]
            # the file is ASCII: s² is written s^2 or s2
            said = found["ordinate_axis_units_lab"].strip().replace("^2", "²").replace("s2", "s²")
            assert said == wanted
            assert found["orddenom_axis_units_lab"].strip() == ("N" if given < 3 else "N m")


@pytest.mark.parametrize("rate", ["", ".velocity", ".acceleration"])
def test_records_in_time_carry_the_units_of_their_components(rate, tmp_path):
    names = [f"body.centre.{axis}{rate}" for axis in AXES]
    run = transient(equilibrium(oscillator()), speed=0.0, dt=1e-5, steps=4, record=names)
    results.write_uff(run, tmp_path / "t.uff")
    sets = pyuff.UFF(str(tmp_path / "t.uff")).read_sets()
    assert [s["rsp_dir"] for s in sets] == [1, 2, 3, 4, 5, 6]
    per = {"": "", ".velocity": "/s", ".acceleration": "/s²"}[rate]
    said = [s["ordinate_axis_units_lab"].strip().replace("^2", "²").replace("s2", "s²") for s in sets]
    assert said == [unit + per for unit in ("m", "m", "m", "rad", "rad", "rad")]
