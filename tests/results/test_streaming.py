"""Long runs: streamed in checked chunks, killed and gone on from, and never losing what was written."""

from __future__ import annotations

import errno
import json
import os
import resource
import signal
import struct
import subprocess
import sys
import time
import zlib
from pathlib import Path

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import runfile

RECORD = ["rotor.centre.y", "rotor.centre.y.velocity", "ball.loaded"]
ARGUMENTS = {"speed": 300.0, "dt": 5e-6, "settle": 1000, "steps": 9000, "record": RECORD, "decimate": 3}


def rotor() -> bd.Equilibrium:
    """A rotor on a layered bearing whose balls lose contact: nonlinear, with history."""
    rubber = bd.Maxwell(4e6, [1e6, 2e6], [1e-4, 1e-3], K=2e9, density=1150.0)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("layer", bd.Layer(0.026, 0.029, 0.016, rubber))
    ball = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, clearance=1e-5, damping=30.0)
    app.bearing("ball", ball, inner="rotor.centre", outer="layer.inner")
    app.ground("layer.outer")
    app.load("rotor.centre", (0, -400, 100, 0, 0, 0))
    return bd.equilibrium(app)


@pytest.fixture(scope="module")
def start() -> bd.Equilibrium:
    return rotor()


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bearingdyn.analysis.march.CHUNK_STEPS", 700)


def same(a: xarray.Dataset, b: xarray.Dataset) -> bool:
    return all(np.array_equal(a[name].values, b[name].values) for name in ("record", "state", "time"))


def test_a_streamed_run_is_the_same_run(start: bd.Equilibrium, tmp_path: Path) -> None:
    path = tmp_path / "run.bdrun"
    plain = bd.transient(start, **ARGUMENTS)
    streamed = bd.transient(start, stream=path, **ARGUMENTS)
    assert same(plain, streamed)
    assert same(plain, bd.open_result(path))
    assert bd.open_result(path).attrs["complete"] == 1
    # settling in 3, the last of the 80 steps that the filter looks back; 13 of recording (9000/700)
    assert len(runfile.read(path)[1]) == 16


def test_a_file_cut_anywhere_opens_and_goes_on_to_the_same_run(start: bd.Equilibrium, tmp_path: Path) -> None:
    whole = tmp_path / "whole.bdrun"
    plain = bd.transient(start, stream=whole, **ARGUMENTS)
    data = whole.read_bytes()
    rng = np.random.default_rng(7)
    for cut in [*rng.integers(0, len(data), 12), len(data) - 1]:
        path = tmp_path / f"cut{cut}.bdrun"
        path.write_bytes(data[:cut])
        if runfile.is_run(path) and cut > 4000:
            partial = bd.open_result(path)
            n = partial.sizes["time"]
            assert partial.attrs["complete"] == 0
            assert np.array_equal(partial["record"].values, plain["record"].values[:n])
        assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))
        assert path.read_bytes() == data


def test_a_flipped_bit_ends_the_file_before_it(start: bd.Equilibrium, tmp_path: Path) -> None:
    path = tmp_path / "run.bdrun"
    plain = bd.transient(start, stream=path, **ARGUMENTS)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    assert 0 < len(runfile.read(path)[1]) < 16
    assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))


def test_another_run_or_another_file_is_not_overwritten(start: bd.Equilibrium, tmp_path: Path) -> None:
    path = tmp_path / "run.bdrun"
    bd.transient(start, stream=path, **ARGUMENTS)
    before = path.read_bytes()
    with pytest.raises(ValueError, match="another run"):
        bd.transient(start, stream=path, **{**ARGUMENTS, "speed": 301.0})
    assert path.read_bytes() == before
    other = tmp_path / "notes.txt"
    other.write_text("keep me")
    with pytest.raises(ValueError, match="not a run file"):
        bd.transient(start, stream=other, **ARGUMENTS)
    assert other.read_text() == "keep me"


CHILD = """
import sys
sys.path[:0] = [{tests!r}, {here!r}]
import test_streaming as t
import bearingdyn.analysis.march as march
march.CHUNK_STEPS = 700
print("ready", flush=True)
t.bd.transient(t.rotor(), stream={path!r}, **t.ARGUMENTS)
"""


def child(path: Path) -> subprocess.Popen[bytes]:
    code = CHILD.format(tests=str(Path(__file__).parents[1]), here=str(Path(__file__).parent), path=str(path))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    return subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment
    )


def test_a_file_of_version_1_is_read_and_not_gone_on_from(start: bd.Equilibrium, tmp_path: Path) -> None:
    """The same run written by hand as the first format had it: counts without names, in this order."""
    path, old = tmp_path / "run.bdrun", tmp_path / "old.bdrun"
    new = bd.transient(start, stream=path, **ARGUMENTS)
    data = path.read_bytes()
    at = len(runfile.MAGIC)
    length, _ = struct.unpack_from("<QI", data, at)
    text = b"bearingdyn run 1\n" + data[at : at + 12 + length]
    for chunk in runfile.read(path)[1]:
        r = chunk.report
        counts = (r.steps, r.iterations, r.refreshes, r.refactors, r.grazing)
        block = struct.pack("<7Q", len(chunk.rows), chunk.state.size, *counts)
        block += chunk.rows.tobytes() + chunk.state.tobytes()
        text += struct.pack("<QI", len(block), zlib.crc32(block)) + block
    old.write_bytes(text)
    known, changes = bd.load(old), ("made_at",)
    assert same(new, known)
    assert {k: v for k, v in known.attrs.items() if k not in changes} == {
        k: v for k, v in bd.load(path).attrs.items() if k not in changes
    }
    with pytest.raises(ValueError, match="earlier version"):
        bd.transient(start, stream=old, **ARGUMENTS)


def test_counters_of_a_file_go_by_name(start: bd.Equilibrium, tmp_path: Path) -> None:
    """One that the file does not know is 0, whatever the order."""
    path = tmp_path / "run.bdrun"
    bd.transient(start, stream=path, **ARGUMENTS)
    chunk = runfile.read(path)[1][3]
    packed = chunk.packed()
    named = json.dumps(chunk.report.counts).encode()
    other = json.dumps({"grazing": 5, "steps": 700}).encode()
    assert named in packed
    changed = packed.replace(named, other.ljust(len(named)))
    report = runfile.Chunk.unpacked(changed, len(RECORD), version=2).report
    assert (report.steps, report.grazing, report.iterations) == (700, 5, 0)


def killed_and_resumed(
    start: bd.Equilibrium, plain: xarray.Dataset, path: Path, kills: int, seed: int
) -> int:
    """Kill child after child at random moments until the run is whole; returns how many were killed."""
    rng = np.random.default_rng(seed)
    done = 0
    for _ in range(kills):
        process = child(path)
        assert process.stdout is not None
        process.stdout.readline()
        time.sleep(float(rng.uniform(0.0, 0.25)))
        process.send_signal(signal.SIGKILL)
        done += process.wait() == -signal.SIGKILL
        if runfile.is_run(path):
            chunks = runfile.read(path)[1]
            if chunks:
                rows = bd.open_result(path)["record"].values
                assert np.array_equal(rows, plain["record"].values[: len(rows)])
    assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))
    return done


def test_a_killed_run_goes_on_to_the_same_end(start: bd.Equilibrium, tmp_path: Path) -> None:
    plain = bd.transient(start, **ARGUMENTS)
    killed_and_resumed(start, plain, tmp_path / "run.bdrun", kills=4, seed=1)


@pytest.mark.slow
def test_a_hundred_killed_runs_go_on_to_the_same_end(start: bd.Equilibrium, tmp_path: Path) -> None:
    plain = bd.transient(start, **ARGUMENTS)
    done = sum(
        killed_and_resumed(start, plain, tmp_path / f"run{k}.bdrun", kills=10, seed=k) for k in range(10)
    )
    assert done > 10  # most children must have died while at work, or nothing was tested


def test_a_full_disk_is_an_error_and_keeps_what_was_written(start: bd.Equilibrium, tmp_path: Path) -> None:
    path = tmp_path / "run.bdrun"
    plain = bd.transient(start, stream=path, **ARGUMENTS)
    size = path.stat().st_size
    path.unlink()
    handler = signal.signal(
        signal.SIGXFSZ, signal.SIG_IGN
    )  # writing beyond the limit fails instead of killing
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size // 2, hard))
    try:
        with pytest.raises(OSError, match="could not be written on") as caught:
            bd.transient(start, stream=path, **ARGUMENTS)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, handler)
    assert caught.value.errno == errno.EFBIG
    kept = bd.open_result(path)
    n = kept.sizes["time"]
    assert n > 0
    assert np.array_equal(kept["record"].values, plain["record"].values[:n])
    assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))


def test_a_place_that_cannot_be_written_is_named_before_the_march(
    start: bd.Equilibrium, tmp_path: Path
) -> None:
    with pytest.raises(OSError, match="cannot write the run"):
        bd.transient(start, stream=tmp_path / "no such folder" / "run.bdrun", **ARGUMENTS)


def test_many_marches_at_once_are_the_marches_one_by_one(start: bd.Equilibrium) -> None:
    cases = [{**ARGUMENTS, "source": start, "speed": 200.0 + 50.0 * k, "steps": 3000} for k in range(5)]
    together = bd.transients(cases, threads=2)
    for case, result in zip(cases, together, strict=True):
        assert same(result, bd.transient(**case))
    with pytest.raises(ValueError, match="dt"):
        bd.transients([{**cases[0], "dt": -1.0}, cases[1]])
