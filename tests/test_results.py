"""Results: what is saved comes back to the bit, with its units; other files are refused."""

from __future__ import annotations

import numpy as np
import pytest
import xarray

from bearingdyn import results


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
    back = results.load(tmp_path / "r.nc")
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
    assert same(results.load(tmp_path / "r.nc", "no layer"), response)
    assert same(results.load(tmp_path / "r.nc", "layer"), other)


def test_real_variable_that_ends_in_two_is_not_taken_for_complex(tmp_path):
    data = results.dataset({"pair": (("n", "part"), np.ones((3, 2)), "", "two of each")}, {})
    results.save(data, tmp_path / "r.nc")
    assert same(results.load(tmp_path / "r.nc"), data)


def test_failed_save_leaves_the_earlier_file_and_no_other(response, tmp_path):
    results.save(response, tmp_path / "r.nc")
    unwritable = response.assign_attrs(bad=object())
    with pytest.raises((TypeError, ValueError)):
        results.save({"good": response, "bad": unwritable}, tmp_path / "r.nc")
    assert [p.name for p in tmp_path.iterdir()] == ["r.nc"]
    assert same(results.load(tmp_path / "r.nc"), response)


def test_save_into_a_missing_folder_is_an_os_error(response, tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        results.save(response, tmp_path / "nowhere" / "r.nc")


def test_nothing_to_save_is_refused(tmp_path):
    with pytest.raises(ValueError, match="nothing to save"):
        results.save({}, tmp_path / "r.nc")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("read", [results.load, results.groups])
def test_file_that_is_not_what_it_claims_is_a_value_error(read, tmp_path):
    path = tmp_path / "r.nc"
    with pytest.raises(ValueError, match=r"r\.nc"):
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
        results.load(path)


def test_missing_group_is_named(response, tmp_path):
    results.save({"layer": response}, tmp_path / "r.nc")
    with pytest.raises(ValueError, match=r"group 'no layer' of .*r\.nc"):
        results.load(tmp_path / "r.nc", "no layer")
