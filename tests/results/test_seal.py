"""The seal of a saved result: damage that HDF5 reads as numbers is refused; other programs see none."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn.results import file_seal, groups
from bearingdyn.results.global_heaps import check_global_heaps


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "r.nc"
    names = [f"ball {i}" for i in range(20)]
    data = xarray.Dataset({"x": ("t", np.arange(400.0))}, {"name": ("n", names)})
    bd.save({"a": data}, path)
    return path


def at_row(content: bytes, value: float) -> int:
    """Where a row of x stands in the file."""
    return content.index(np.array([value - 1, value]).tobytes()) + 8


def test_a_flipped_bit_of_a_number_is_no_other_number(saved: Path) -> None:
    content = bytearray(saved.read_bytes())
    content[at_row(content, 300.0) + 6] ^= 1  # 300 would be read as 364
    saved.write_bytes(content)
    for read in (lambda: bd.open_result(saved, "a"), lambda: groups(saved)):
        with pytest.raises(
            ValueError, match=r"r\.nc cannot be read as a result: its content is not what was"
        ):
            read()
    # what the seal keeps out: HDF5 has no word about it
    with xarray.open_dataset(saved, group="a", engine="h5netcdf") as data:
        assert data.x.values[300] != 300.0


@pytest.mark.parametrize("tail", [20, 51, 52, 1500])
def test_a_tail_of_zeros_is_no_number(saved: Path, tail: int) -> None:
    """What a power cut leaves: the length is right, the last blocks are not, the seal may be among them."""
    content = saved.read_bytes()
    saved.write_bytes(content[:-tail] + bytes(tail))
    with pytest.raises(ValueError, match="its content is not what was saved"):
        bd.open_result(saved, "a")


def test_a_file_that_has_grown_is_not_read(saved: Path) -> None:
    """Where a piece stands twice and the seal's mark is damaged too: HDF5 went round in it without end."""
    content = saved.read_bytes()
    saved.write_bytes(content[:9000] + content[8000:9000] + content[9000:-30])
    with pytest.raises(ValueError, match="its content is not what was saved"):
        bd.open_result(saved, "a")


def test_the_seal_is_the_sha256_of_all_before_it(saved: Path) -> None:
    content = saved.read_bytes()
    assert content.endswith(hashlib.sha256(content[: -file_seal.LENGTH]).digest())


def test_a_file_that_another_program_has_written_or_changed_is_read(saved: Path, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(saved, "a") as file:
        file["a/x"][300] = 7.0
    assert bd.open_result(saved, "a").x.values[300] == 7.0
    for version in ("earliest", "latest"):  # superblocks 0 and 3
        with h5py.File(tmp_path / "theirs.nc", "w", libver=version) as file:
            file["y"] = np.arange(3.0)
        assert bd.open_result(tmp_path / "theirs.nc").y.values.tolist() == [0.0, 1.0, 2.0]


def test_a_text_longer_than_the_file_is_named_before_its_memory_is_taken(saved: Path) -> None:
    """One wrong byte in the length of a text: HDF5 took 3.7 GB and 10 s, and then said nothing of it."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(saved) as file:
        at = file["a/name"].id.get_offset()
    content = bytearray(saved.read_bytes()[: -file_seal.LENGTH])
    content[at + 3] = 0xE3
    saved.write_bytes(content)
    with pytest.raises(ValueError, match=r"r\.nc cannot be read as a result: a/name holds texts longer than"):
        bd.open_result(saved, "a")


def test_a_file_that_is_no_hdf5_leaves_no_traceback_behind(
    saved: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import gc
    import sys

    forgotten: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", forgotten.append)
    saved.write_bytes(b"no HDF5 at all" * 100)
    for read in (lambda: bd.open_result(saved, "a"), lambda: groups(saved)):
        with pytest.raises(ValueError, match="cannot be read as a result"):
            read()
    gc.collect()
    assert forgotten == []


@pytest.mark.parametrize("length", [1 << 10, 1 << 12, 1 << 20, 2**64 - 16, 2**64 - 1])
@pytest.mark.parametrize("sealed", [True, False])
def test_a_length_in_a_heap_that_does_not_fit_is_refused_before_hdf5_follows_it(
    saved: Path, length: int, sealed: bool
) -> None:
    """HDF5 2.0 goes round for ever in a heap whose objects do not fill it; no alarm reaches it there."""
    content = bytearray(saved.read_bytes()[: -file_seal.LENGTH])
    # the first object's length; the last heap, which the references of the dimensions are in
    content[(at := content.rindex(b"GCOL") + 24) : at + 8] = length.to_bytes(8, "little")
    saved.write_bytes(content + (file_seal.seal(content) if sealed else b""))
    for read in (lambda: bd.open_result(saved, "a"), lambda: groups(saved)):
        with pytest.raises(ValueError, match=r"r\.nc cannot be read as a result: the lengths in its heap"):
            read()


def test_heaps_of_sound_files_pass(tmp_path: Path) -> None:
    """Texts of all lengths, some lost again, by another program too; a file of more than one part."""
    import h5py

    for version in ("earliest", "latest"):
        with h5py.File(tmp_path / "a.h5", "w", libver=version) as file:
            for k in range(20):
                file[f"s{k}"] = [f"text {i} " * (i % 40) for i in range(500)]
            file["much"] = np.arange(1_200_000.0)
            file.attrs["texts"] = ["x" * 50_000, "", "y"]
            for k in range(0, 20, 3):
                del file[f"s{k}"]
            file["more"] = ["z"] * 5000
        check_global_heaps(tmp_path / "a.h5")
