"""Long runs: streamed in checked chunks, killed and gone on from, and never losing what was written."""

from __future__ import annotations

import errno
import json
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import time
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray

import bearingdyn as bd
from bearingdyn import run_file
from bearingdyn.cli import main

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
    monkeypatch.setattr("bearingdyn.analysis.march_pieces.CHUNK_STEPS", 700)


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
    assert len(run_file.read(path)[1]) == 16


def test_a_file_cut_anywhere_opens_and_goes_on_to_the_same_run(start: bd.Equilibrium, tmp_path: Path) -> None:
    whole = tmp_path / "whole.bdrun"
    plain = bd.transient(start, stream=whole, **ARGUMENTS)
    data = whole.read_bytes()
    rng = np.random.default_rng(7)
    for cut in [*rng.integers(0, len(data), 12), len(data) - 1]:
        path = tmp_path / f"cut{cut}.bdrun"
        path.write_bytes(data[:cut])
        if run_file.is_run(path) and cut > 4000:
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
    assert 0 < len(run_file.read(path)[1]) < 16
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
import bearingdyn.analysis.march_pieces as march
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
    at = len(run_file.MAGIC)
    length, _ = struct.unpack_from("<QI", data, at)
    header = data[at + 12 : at + 12 + length]
    text = b"bearingdyn run 1\n" + struct.pack("<QI", length, zlib.crc32(header)) + header
    for chunk in run_file.read(path)[1]:
        r = chunk.report
        counts = (r.steps, r.iterations, r.refreshes, r.refactors, r.grazing)
        block = struct.pack("<7Q", len(chunk.rows), chunk.state.size, *counts)
        block += chunk.rows.tobytes() + chunk.state.tobytes()
        text += struct.pack("<QI", len(block), zlib.crc32(block)) + block
    old.write_bytes(text)
    known, changes = bd.open_result(old), ("made_at",)
    assert same(new, known)
    assert {k: v for k, v in known.attrs.items() if k not in changes} == {
        k: v for k, v in bd.open_result(path).attrs.items() if k not in changes
    }
    with pytest.raises(ValueError, match="earlier version"):
        bd.transient(start, stream=old, **ARGUMENTS)


def test_counters_of_a_file_go_by_name(start: bd.Equilibrium, tmp_path: Path) -> None:
    """One that the file does not know is 0, whatever the order."""
    path = tmp_path / "run.bdrun"
    bd.transient(start, stream=path, **ARGUMENTS)
    chunk = run_file.read(path)[1][3]
    packed = chunk.packed()
    named = json.dumps({**chunk.report.counts, "peaks": chunk.report.peaks}).encode()
    other = json.dumps({"grazing": 5, "steps": 700}).encode()
    assert named in packed
    changed = packed.replace(named, other.ljust(len(named)))
    report = run_file.Chunk.unpacked(changed, len(RECORD), version=2).report
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
        if run_file.is_run(path):
            chunks = run_file.read(path)[1]
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


def whole_run(start: bd.Equilibrium, folder: Path) -> tuple[bytes, xarray.Dataset]:
    path = folder / "whole.bdrun"
    plain = bd.transient(start, stream=path, **ARGUMENTS)
    return path.read_bytes(), plain


def finished(path: Path, plain: xarray.Dataset) -> int:
    """Rows a damaged file still holds, each as it was; 0 where the file says clearly why it holds none."""
    try:
        found = bd.open_result(path)
    except ValueError as error:
        said = str(error)
    else:
        said = ""
    if said:
        assert re.search("no finished chunk|header of the run is damaged|cannot be read", said)
        return 0
    rows = found["record"].values
    assert found.attrs["complete"] == int(len(rows) == len(plain["record"]))
    assert np.array_equal(rows, plain["record"].values[: len(rows)])
    return len(rows)


def ends(path: Path) -> list[int]:
    """Where each finished chunk of a sound file ends, the header first."""
    data, at, found = path.read_bytes(), len(run_file.MAGIC), []
    while at < len(data):
        at += 12 + struct.unpack_from("<QI", data, at)[0]
        found.append(at)
    return found


@pytest.mark.parametrize("damage", ["zeros", "cut"])
@pytest.mark.parametrize("times", [6, pytest.param(50, marks=pytest.mark.slow)])
def test_zeros_or_an_end_where_a_power_cut_left_them_lose_nothing_finished(
    start: bd.Equilibrium, tmp_path: Path, damage: str, times: int
) -> None:
    data, plain = whole_run(start, tmp_path)
    bounds = ends(tmp_path / "whole.bdrun")
    rng = np.random.default_rng(3)
    for k in range(times):
        # places anywhere, and each bound of a block, where a tail of zeros looks like a block of length 0
        cut = int(rng.integers(0, len(data))) if k % 2 else bounds[k // 2 % len(bounds)]
        path = tmp_path / f"{damage}{k}.bdrun"
        path.write_bytes(data[:cut] + (bytes(int(rng.integers(1, 50_000))) if damage == "zeros" else b""))
        rows = finished(path, plain)
        chunks = max(sum(bound <= cut for bound in bounds) - 1, 0)
        assert rows >= min(max(chunks - 3, 0) * 700, 9000) // 3  # three chunks of settling have no rows
        if cut > bounds[0]:
            assert len(run_file.read(path)[1]) >= chunks
        assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))
        assert path.read_bytes() == data


def test_a_block_that_was_moved_is_none(start: bd.Equilibrium, tmp_path: Path) -> None:
    """Two chunks of one length change places: each is sound in itself, and none at the other's place."""
    data, _ = whole_run(start, tmp_path)
    bounds = ends(tmp_path / "whole.bdrun")
    a, b, c = bounds[4:7]
    moved = tmp_path / "moved.bdrun"
    moved.write_bytes(data[:a] + data[b:c] + data[a:b] + data[c:])
    assert len(run_file.read(moved)[1]) == 4


def as_version(data: bytes, magic: bytes) -> bytes:
    """The blocks of a file with the CRC of versions 1 and 2, of the bytes alone."""
    at, text = len(run_file.MAGIC), magic
    while at < len(data):
        length, _ = struct.unpack_from("<QI", data, at)
        block = data[at + 12 : at + 12 + length]
        text += struct.pack("<QI", length, zlib.crc32(block)) + block
        at += 12 + length
    return text


def test_a_file_of_version_2_is_read_and_gone_on_from(start: bd.Equilibrium, tmp_path: Path) -> None:
    data, plain = whole_run(start, tmp_path)
    old = as_version(data, b"bearingdyn run 2\n")
    path = tmp_path / "old.bdrun"
    path.write_bytes(old)
    assert same(plain, bd.open_result(path))
    path.write_bytes(old[: len(old) // 2] + bytes(1000))
    assert same(plain, bd.transient(start, stream=path, **ARGUMENTS))
    assert path.read_bytes() == old


def test_a_second_writer_is_refused_and_a_dead_one_does_not_lock(
    start: bd.Equilibrium, tmp_path: Path
) -> None:
    path = tmp_path / "run.bdrun"
    process = child(path)
    try:
        assert process.stdout is not None
        process.stdout.readline()
        while not (path.exists() and path.stat().st_size > 10_000):
            assert process.poll() is None
            time.sleep(0.005)
        process.send_signal(signal.SIGSTOP)  # at work, and not in a hurry
        with pytest.raises(OSError, match=r"another march writes this run now.*run\.bdrun"):
            bd.transient(start, stream=path, **ARGUMENTS)
        assert bd.open_result(path).attrs["complete"] == 0  # reading is free
    finally:
        process.kill()
        process.wait()
    assert same(bd.transient(start, **ARGUMENTS), bd.transient(start, stream=path, **ARGUMENTS))


def test_two_writers_of_one_process_do_not_write_one_file(tmp_path: Path) -> None:
    path, header = tmp_path / "run.bdrun", {
        "channels": [], "units": [], "speed": [[0.0], [1.0]], "dt": 1.0, "decimate": 1, "settle": 0,
        "steps": 1,
    }  # fmt: skip
    first = run_file.Writer(path, header)
    with pytest.raises(OSError, match="another march writes this run now"):
        run_file.Writer(path, header)
    first.close()
    run_file.Writer(path, header).close()


@pytest.mark.parametrize(
    ("harm", "message"),
    [
        (lambda p: p.unlink(), "was removed"),
        (lambda p: os.truncate(p, 5000), "was changed.*now there are 5000"),
        (lambda p: os.truncate(p, 0), "was changed.*now there are 0"),
        (lambda p: p.write_bytes(bytes(p.stat().st_size)), "was changed"),
        (lambda p: p.write_bytes(p.read_bytes() + b"more"), "was changed"),
        (lambda p: (p.rename(p.with_suffix(".away")), p.write_bytes(b"x")), "was replaced"),
    ],
)
def test_a_file_that_is_lost_under_a_march_ends_it_with_an_error(
    start: bd.Equilibrium, tmp_path: Path, harm: Callable[[Path], object], message: str
) -> None:
    path = tmp_path / "run.bdrun"
    done = False

    def progress(fraction: float, *_: object) -> None:
        nonlocal done
        if not done and run_file.is_run(path) and len(run_file.read(path)[1]) > 5:
            done = True
            harm(path)

    with pytest.raises(OSError, match=message):
        bd.transient(start, stream=path, progress=progress, **ARGUMENTS)
    assert done


def test_odd_content_behind_a_valid_checksum_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "run.bdrun"
    facts = {
        "channels": ["a"], "units": ["m"], "speed": [[0.0], [1.0]], "dt": 1e-5, "decimate": 1, "settle": 0,
        "steps": 10,
    }  # fmt: skip
    state = np.array([0.0, 1.0, 1e-5, 0.0])
    counts = json.dumps({"steps": 1}).encode().ljust(16)

    def chunk(front: tuple[int, int, int], *parts: bytes) -> bytes:
        return struct.pack("<3Q", *front) + b"".join(parts)

    row = np.zeros(1).tobytes()
    good = chunk((1, 4, 16), counts, row, state.tobytes())
    for header, blocks, message in (
        ([1], [], "does not have the header of a run: it is"),
        ({**facts, "channels": 5}, [], "channels is 5"),
        ({**facts, "units": []}, [], "1 channels have 0 units"),
        ({**facts, "dt": "1"}, [], "dt is '1'"),
        ({**facts, "decimate": 0}, [good], "decimate is 0"),
        ({**facts, "speed": [[0.0], [1.0, 2.0]]}, [good], "speed is"),
        ({**facts, "steps": 10**40}, [good], "steps is"),
        (facts, [good, b"x"], r"chunk 1 does not belong to a run: it has 1 bytes"),
        (facts, [chunk((2**60, 4, 16), counts, row, state.tobytes())], "do not fill 80 bytes"),
        (facts, [chunk((1, 4, 16), b"[" * 16, row, state.tobytes())], "chunk 0 does not belong to a run"),
        (facts, [chunk((1, 4, 16), b'{"steps":"9"}   ', row, state.tobytes())], "it counts"),
        (facts, [chunk((1, 4, 16), b'{"loops":1}     ', row, state.tobytes())], "it counts"),
        (facts, [chunk((1, 4, 16), counts, row, np.full(4, np.nan).tobytes())], "which cannot be a time"),
        (facts, [chunk((1, 4, 16), counts, row, np.full(4, 1e300).tobytes())], "which cannot be a time"),
    ):
        data = run_file.MAGIC
        for block in (json.dumps(header).encode(), *blocks):
            place = struct.pack("<QQ", len(data), len(block))
            data += struct.pack("<QI", len(block), zlib.crc32(place + block)) + block
        path.write_bytes(data)
        with pytest.raises(ValueError, match=rf"run\.bdrun.*{message}"):
            bd.open_result(path)


def test_show_says_what_a_run_file_holds(start: bd.Equilibrium, tmp_path: Path, capsys) -> None:
    path = tmp_path / "x.run"
    bd.transient(start, stream=path, **ARGUMENTS)
    assert main(["show", str(path)]) == 0
    said = capsys.readouterr().out
    assert "time 3000, channel 3" in said
    assert "complete = 1" in said
    assert main(["show", "--json", str(path)]) == 0
    assert json.loads(capsys.readouterr().out)["groups"][""]["attrs"]["steps"] == 9000
    path.write_bytes(path.read_bytes()[: ends(path)[0]])
    assert main(["show", str(path)]) == 2
    assert "holds no finished chunk yet" in capsys.readouterr().err
