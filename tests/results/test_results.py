"""Results: what is saved comes back to the bit, with its units; other files are refused."""

from __future__ import annotations

import copy
import json
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
import xarray

from bearingdyn import results
from bearingdyn.analysis import (
    campbell,
    dissipation,
    energy_shares,
    equilibrium,
    frequency_response,
    mode_shapes,
    modes,
    transient,
)
from bearingdyn.application import Application
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, RigidBody


@pytest.fixture
def response():
    """A complex result with a text coordinate, a special value and every kind of attribute in use."""
    values = np.array([[1 + 2j, -0.5j], [complex(1e-300, np.inf), 3e200 + 0j]])
    return results.dataset(
        {
            "response": (("frequency", "output"), values, "m/N", "complex displacement"),
            "energy": ("frequency", np.array([1.0, np.nan]), "J", "energy"),
            "count": ((), np.int64(3), "1", "a number"),
        },
        {"analysis": "test", "speed": 523.6, "steps": 7},
        {"frequency": ([10.0, 20.0], "Hz"), "output": (["shaft.left.θx", "shaft.left.y"], "")},
    )


def same(a: xarray.Dataset, b: xarray.Dataset) -> bool:
    """Equal values, NaN being NaN, with dims, coordinates and attributes (xarray's own comparison)."""
    return a.identical(b)


def test_complex_result_comes_back_to_the_bit(response, tmp_path):
    results.save(response, tmp_path / "r.nc")
    back = results.open_result(tmp_path / "r.nc")
    assert same(back, response)
    assert back["response"].dtype == np.complex128
    assert back["response"].values.tobytes() == response["response"].values.tobytes()
    assert back["response"].attrs["units"] == "m/N"
    assert back["frequency"].attrs["units"] == "Hz"
    assert back["output"].values.tolist() == ["shaft.left.θx", "shaft.left.y"]


def test_saving_leaves_the_result_as_it_was(response, tmp_path):
    before = response.copy(deep=True)
    results.save(response, tmp_path / "r.nc")
    assert same(response, before)


def test_several_results_share_a_file_by_name(response, tmp_path):
    other = response.assign(energy=2 * response["energy"])
    results.save({"no layer": response, "layer": other}, tmp_path / "r.nc")
    assert results.groups(tmp_path / "r.nc") == ["layer", "no layer"]
    assert same(results.open_result(tmp_path / "r.nc", "no layer"), response)
    assert same(results.open_result(tmp_path / "r.nc", "layer"), other)


def test_real_variable_that_ends_in_two_is_not_taken_for_complex(tmp_path):
    data = results.dataset({"pair": (("n", "part"), np.ones((3, 2)), "", "two of each")}, {})
    results.save(data, tmp_path / "r.nc")
    assert same(results.open_result(tmp_path / "r.nc"), data)


def test_failed_save_leaves_the_earlier_file_and_no_other(response, tmp_path):
    results.save(response, tmp_path / "r.nc")
    unwritable = response.assign_attrs(bad=object())
    with pytest.raises((TypeError, ValueError)):
        results.save({"good": response, "bad": unwritable}, tmp_path / "r.nc")
    assert [p.name for p in tmp_path.iterdir()] == ["r.nc"]
    assert same(results.open_result(tmp_path / "r.nc"), response)


def test_save_into_a_missing_folder_is_an_os_error(response, tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        results.save(response, tmp_path / "nowhere" / "r.nc")


def test_nothing_to_save_is_refused(tmp_path):
    with pytest.raises(ValueError, match="nothing to save"):
        results.save({}, tmp_path / "r.nc")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("read", [results.open_result, results.groups])
def test_file_that_is_not_what_it_claims_is_a_value_error(read, tmp_path):
    path = tmp_path / "r.nc"
    with pytest.raises(FileNotFoundError, match=r"r\.nc: no such file"):
        read(path)
    for content in (b"", b"frequency,response\n1,2\n", b"\x89HDF\r\n\x1a\n" + bytes(100)):
        path.write_bytes(content)
        with pytest.raises(ValueError, match=r"r\.nc"):
            read(path)


def test_truncated_file_is_a_value_error(response, tmp_path):
    path = tmp_path / "r.nc"
    results.save(response, path)
    path.write_bytes(path.read_bytes()[:-500])
    with pytest.raises(ValueError, match=r"r\.nc"):
        results.open_result(path)


def test_a_file_of_several_results_asks_which(response, tmp_path):
    results.save({"one": response, "two": response}, tmp_path / "both.nc")
    with pytest.raises(ValueError, match=r"several results; name one of them: \['one', 'two'\]"):
        results.open_result(tmp_path / "both.nc")


def test_missing_group_is_named(response, tmp_path):
    results.save({"layer": response}, tmp_path / "r.nc")
    with pytest.raises(ValueError, match="group is 3; it must be the name of a result"):
        results.open_result(tmp_path / "r.nc", 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"r\.nc has no result 'no layer'; did you mean 'layer'"):
        results.open_result(tmp_path / "r.nc", "no layer")


# ---------------------------------------------------------------- what a result was made from, and by


@pytest.fixture(scope="module")
def rotor():
    app = Application()
    app.add("rotor", RigidBody(5.0, (0.02, 0.02, 0.03), rotating=True))
    app.add("layer", Layer(0.026, 0.028, 0.016, Maxwell(1e6, [2e6], [1e-3], K=2e9, density=1200.0)))
    app.connect("rotor.centre", "layer.inner")
    app.ground("layer.outer")
    return app


OUTPUTS = ["rotor.centre.y", "rotor.centre.θx"]


@pytest.fixture(scope="module")
def frf(rotor):
    return frequency_response(rotor, np.linspace(10.0, 500.0, 50), ["rotor.centre.y"], OUTPUTS)


def test_result_says_what_it_was_made_from_by_and_when(rotor, frf, tmp_path):
    results.save(frf, tmp_path / "r.nc")
    back = results.open_result(tmp_path / "r.nc")
    assert back.identical(frf)
    held = json.loads(back.attrs["inputs"])
    assert held["sources"]["layer"]["r_outer"] == 0.028
    assert held["sources"]["layer"]["material"]["tau"] == [1e-3]
    assert held["connections"][0]["b"] == "layer.inner"
    for part in ("bearingdyn ", "Python ", "NumPy ", "SciPy "):
        assert part in back.attrs["made_by"]
    age = datetime.now(UTC) - datetime.fromisoformat(back.attrs["made_at"])
    assert timedelta(0) <= age < timedelta(hours=1)
    for name in ("response", "frequency"):
        assert back[name].attrs["units"]


def test_other_inputs_other_hash(rotor, frf):
    other = copy.deepcopy(rotor)
    other.ground("rotor.centre", stiffness=(1.0, 0, 0, 0, 0, 0))
    changed = frequency_response(other, [10.0], OUTPUTS[:1], OUTPUTS)
    same = frequency_response(copy.deepcopy(rotor), [10.0], OUTPUTS[:1], OUTPUTS)
    assert same.attrs["inputs_hash"] == frf.attrs["inputs_hash"] != changed.attrs["inputs_hash"]


def test_every_analysis_carries_its_inputs(rotor, tmp_path):
    state = equilibrium(rotor)
    run = transient(state, speed=0.0, dt=1e-5, steps=20, record=["rotor.centre.y"], stream=tmp_path / "r.run")
    streamed = results.open_result(tmp_path / "r.run")
    found = modes(state)
    further = (
        campbell(state, [0.0], count=3),
        energy_shares(state, found),
        mode_shapes(state, found),
        dissipation(state, speed=0.0, dt=1e-5, steps=5),
    )
    hashes = {data.attrs["inputs_hash"] for data in (found, run, streamed, *further)}
    assert hashes == {frequency_response(state, [1.0], OUTPUTS, OUTPUTS).attrs["inputs_hash"]}


def test_channels_are_chosen_by_name_and_become_a_table(rotor, frf):
    chosen = frf["response"].sel(output="rotor.centre.y", input="rotor.centre.y")
    assert chosen.shape == (50,)
    np.testing.assert_array_equal(chosen, frf["response"].values[:, 0, 0])
    assert chosen.sel(frequency=100.0).item() == frf["response"].values[9, 0, 0]
    pandas = pytest.importorskip("pandas")
    frame = frf.to_dataframe()
    assert isinstance(frame, pandas.DataFrame)
    assert (
        frame.loc[100.0, "rotor.centre.θx", "rotor.centre.y"]["response"] == frf["response"].values[9, 1, 0]
    )


# ---------------------------------------------------------------- Universal File Format


def read_uff(path):
    pyuff = pytest.importorskip("pyuff")
    return pyuff.UFF(str(path)).read_sets()


@pytest.mark.parametrize("frequency", [np.linspace(10.0, 500.0, 50), np.geomspace(10.0, 500.0, 41)])
def test_pyuff_reads_back_the_frequency_response(rotor, frequency, tmp_path):
    H = frequency_response(rotor, frequency, OUTPUTS[:1], OUTPUTS, quantity="acceleration")
    assert results.write_uff(H, tmp_path / "h.uff") == ["rotor.centre"]
    sets = read_uff(tmp_path / "h.uff")
    assert [s["func_type"] for s in sets] == [4, 4]
    for i, found in enumerate(sets):
        # twelve digits for ordinates, six for the abscissa: half of the last one
        wanted = H["response"].values[:, i, 0]
        np.testing.assert_allclose(found["data"].real, wanted.real, rtol=5e-12, atol=1e-300)
        np.testing.assert_allclose(found["data"].imag, wanted.imag, rtol=5e-12, atol=1e-300)
        np.testing.assert_allclose(found["x"], frequency, rtol=5e-6)
    assert [(s["rsp_node"], s["rsp_dir"], s["ref_node"], s["ref_dir"]) for s in sets] == [
        (1, 2, 1, 2),
        (1, 4, 1, 2),
    ]
    assert sets[1]["id1"].strip() == "rotor.centre.rx / rotor.centre.y"
    assert {s["ordinate_spec_data_type"] for s in sets} == {12}
    assert {s["orddenom_spec_data_type"] for s in sets} == {13}


def test_forces_and_moving_ground_are_named_as_such(rotor, tmp_path):
    inputs, outputs = ["ground.y", "rotor.centre.θx"], ["rotor.centre.y", "ground.layer.outer.y"]
    H = frequency_response(rotor, [10.0, 20.0], inputs, outputs, quantity="velocity")
    results.write_uff(H, tmp_path / "h.uff")
    # specific data types: 9 reaction force, 11 velocity, 13 excitation force
    sets = read_uff(tmp_path / "h.uff")
    kinds = [(s["ordinate_spec_data_type"], s["orddenom_spec_data_type"]) for s in sets]
    assert kinds == [(11, 11), (11, 13), (9, 11), (9, 13)]
    units = [(s["ordinate_axis_units_lab"].strip(), s["orddenom_axis_units_lab"].strip()) for s in sets]
    assert units == [("m/s", "m/s"), ("m/s", "N m"), ("N", "m/s"), ("N", "N m")]


def test_pyuff_reads_back_a_transient(rotor, tmp_path):
    record = ["rotor.centre.y", "rotor.centre.x.velocity"]
    run = transient(
        equilibrium(rotor),
        speed=0.0,
        dt=2.5e-6,
        steps=101,
        record=record,
        initial={"rotor.centre": [1e-6, 2e-6, 0, 0, 0, 0]},
    )
    results.write_uff(run, tmp_path / "t.uff")
    sets = read_uff(tmp_path / "t.uff")
    assert [(s["func_type"], s["rsp_dir"], s["ordinate_spec_data_type"]) for s in sets] == [
        (1, 2, 8),
        (1, 1, 11),
    ]
    for i, found in enumerate(sets):
        np.testing.assert_allclose(found["data"], run["record"].values[:, i], rtol=5e-12, atol=1e-300)
        np.testing.assert_allclose(found["x"], run["time"], rtol=5e-6, atol=1e-18)


def test_what_is_no_function_is_refused(rotor, frf, tmp_path):
    with pytest.raises(ValueError, match="a frequency response"):
        results.write_uff(modes(rotor), tmp_path / "m.uff")
    with pytest.raises(ValueError, match="1 points along frequency"):
        results.write_uff(frf.isel(frequency=[0]), tmp_path / "m.uff")
    with pytest.raises(ValueError, match="by lists"):
        results.write_uff(frf.sel(output="rotor.centre.y"), tmp_path / "m.uff")
    assert not list(tmp_path.iterdir())
