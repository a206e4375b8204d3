"""Saving: whole or not at all, whatever the disk does, and never over what is no file."""

from __future__ import annotations

import errno
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn.results import groups, write_uff
from bearingdyn.writing import write_whole

SAVES = """
import resource, sys
import numpy as np, xarray
import bearingdyn as bd
path, limit = sys.argv[1], int(sys.argv[2])
data = xarray.Dataset({"x": ("t", np.random.default_rng(0).standard_normal(500_000))})  # 4 MB
if limit:
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
try:
    bd.save({"a": data, "b": data}, path)
except OSError as error:
    print("refused", error.errno, error)
bd.save(data.isel(t=slice(10)), path + ".small")  # the interpreter lives, and can still save
print("alive")
"""


def saves(path: Path, limit: int = 0) -> str:
    run = subprocess.run(
        [sys.executable, "-c", SAVES, str(path), str(limit)], capture_output=True, text=True, timeout=120
    )
    assert run.returncode == 0, run.stderr  # −11 was SIGSEGV
    return run.stdout


def small(value: float = 1.0) -> xarray.Dataset:
    return xarray.Dataset({"x": ("t", np.full(3, value))})


@pytest.mark.parametrize("limit", [100_000, 1_000_000, 4_100_000])
def test_a_file_that_may_grow_no_further_is_an_error_and_the_old_one_stays(
    tmp_path: Path, limit: int
) -> None:
    pytest.importorskip("resource")
    path = tmp_path / "result.nc"
    bd.save(small(), path)
    before = path.read_bytes()
    said = saves(path, limit)
    assert f"refused {errno.EFBIG}" in said
    assert str(path) in said
    assert "what was there before is unchanged" in said
    assert "alive" in said
    assert path.read_bytes() == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["result.nc", "result.nc.small"]


def test_a_full_disk_is_an_error_and_the_old_file_stays(tmp_path: Path) -> None:
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(disk)], capture_output=True, check=False
    )
    if mounted.returncode:
        pytest.skip("no right to mount a small disk")
    try:
        path = disk / "result.nc"
        bd.save(small(), path)
        before = path.read_bytes()
        said = saves(path)
        assert f"refused {errno.ENOSPC}" in said
        assert "alive" in said
        assert path.read_bytes() == before
        assert len(list(disk.iterdir())) == 2
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_what_is_no_file_is_not_written_over(tmp_path: Path) -> None:
    pipe, folder = tmp_path / "pipe.nc", tmp_path / "folder.nc"
    os.mkfifo(pipe)
    folder.mkdir()
    run = xarray.Dataset(
        {"record": (("time", "channel"), np.zeros((4, 1)))},
        coords={"time": 0.1 * np.arange(4), "channel": ["s.e.y"], "unit": ("channel", ["m"])},
    )
    for place, what in ((pipe, "pipe"), (folder, "folder"), (Path("/dev/full"), "device")):
        for write in (lambda p: bd.save(small(), p), lambda p: write_uff(run, p)):
            with pytest.raises(OSError, match=f"is a {what}, not a file.*{place.name}"):
                write(place)
        with pytest.raises(OSError, match=f"cannot write the run: is a {what}"):
            bd.transient(free(), speed=0.0, dt=1e-5, steps=3, record=["m.centre.y"], stream=place)
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert not list(folder.iterdir())


def free() -> bd.Application:
    app = bd.Application()
    app.add("m", bd.RigidBody(1.0, (1e-3, 1e-3, 1e-3)))
    app.ground("m.centre", stiffness=[1e6] * 6)
    return app


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=f"no folder {tmp_path / 'none'}; make it first"):
        bd.save(small(), tmp_path / "none" / "result.nc")


def test_a_link_stays_a_link_and_permissions_stay(tmp_path: Path) -> None:
    real, link = tmp_path / "real.nc", tmp_path / "link.nc"
    bd.save(small(), real)
    real.chmod(0o640)
    link.symlink_to(real)
    bd.save(small(2.0), link)
    assert link.is_symlink()
    assert stat.S_IMODE(real.stat().st_mode) == 0o640
    assert float(bd.open_result(real)["x"][0]) == 2.0
    long = tmp_path / ("n" * 250 + ".nc")  # a name of 253 bytes; 255 are allowed
    bd.save(small(), long)
    assert bd.open_result(long).equals(small())


def test_a_new_file_has_the_permissions_of_any_new_file(tmp_path: Path) -> None:
    bd.save(small(), tmp_path / "a.nc")
    (tmp_path / "plain").touch()
    assert (tmp_path / "a.nc").stat().st_mode == (tmp_path / "plain").stat().st_mode


def test_what_is_no_result_is_refused_before_anything_is_written(tmp_path: Path) -> None:
    path = tmp_path / "r.nc"
    for wrong in (5, None, {"a": 5}, {"a//b": small()}, {}):
        with pytest.raises(ValueError, match=r"it must be a Dataset|must be a text|nothing to save"):
            bd.save(wrong, path)  # type: ignore[arg-type]
    assert not list(tmp_path.iterdir())


def test_several_results_in_one_file_are_what_they_were(tmp_path: Path) -> None:
    bd.save({"a": small(1.0), "b": small(2.0)}, tmp_path / "r.nc")
    assert groups(tmp_path / "r.nc") == ["a", "b"]
    assert bd.open_result(tmp_path / "r.nc", "b").equals(small(2.0))


def test_an_interrupted_write_leaves_nothing_beside_the_old_file(tmp_path: Path, monkeypatch) -> None:
    path = tmp_path / "x"
    path.write_bytes(b"old")

    def stopped(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", stopped)
    with pytest.raises(KeyboardInterrupt):
        write_whole(path, b"new")
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_results_within_results_are_named_by_both(tmp_path: Path) -> None:
    bd.save({"response/soft": small(1.0), "response/hard": small(2.0), "a": small()}, tmp_path / "r.nc")
    assert groups(tmp_path / "r.nc") == ["a", "response/hard", "response/soft"]
    for name in groups(tmp_path / "r.nc"):
        assert bd.open_result(tmp_path / "r.nc", name).sizes == small().sizes


@pytest.mark.parametrize("value", [None, object(), {"a": 1}, 1 + 2j])
def test_an_attribute_that_no_file_keeps_is_named(value, tmp_path):
    data = xarray.Dataset({"x": ("t", [1.0], {"odd": value})}, attrs={"fine": "a", "n": 3})
    with pytest.raises(ValueError, match=r"results\['x'\]\.attrs\['odd'\] is "):
        bd.save(data, tmp_path / "r.nc")
    with pytest.raises(ValueError, match=r"results\['a'\]\.attrs\['odd'\] is "):
        bd.save({"a": xarray.Dataset(attrs={"odd": value})}, tmp_path / "r.nc")
    assert not list(tmp_path.iterdir())
