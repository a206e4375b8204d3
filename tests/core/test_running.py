"""A march of bearingdyn.core as it runs: progress, Ctrl-C, threads, and how it ends when it cannot go on."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bearingdyn import core
from core_models import SCHEME, N, arguments, at_rest, harmonic, model, stepping

# ---------------------------------------------------------------- threads


def test_threads_that_share_a_model_give_the_same_bits() -> None:
    m = model()
    x = 1e-6 * np.arange(N)
    expected, end, _ = core.march(m, m.state(0.0, x, x), SCHEME, 4000, 10, start=True)
    results: list[Any] = [None] * 8

    def run(i: int) -> None:
        results[i] = core.march(m, m.state(0.0, x, x), SCHEME, 4000, 10, start=True)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for record, state, _ in results:
        np.testing.assert_array_equal(record, expected)
        np.testing.assert_array_equal(state, end)


def test_twice_the_steps_is_two_marches_bit_for_bit() -> None:
    m = model()
    state = m.state(0.01, 1e-6 * np.arange(N), np.zeros(N))
    whole, end, _ = core.march(m, state, SCHEME, 600, 7, start=True)
    first, middle, _ = core.march(m, state, SCHEME, 300, 7, start=True)
    second, also_end, _ = core.march(m, middle, SCHEME, 300, 7)
    np.testing.assert_array_equal(np.vstack([first, second]), whole)
    np.testing.assert_array_equal(also_end, end)
    # a state survives a file
    np.testing.assert_array_equal(core.march(m, np.array(middle.tolist()), SCHEME, 300, 7)[1], end)


def test_reports_of_two_marches_add_up_to_that_of_one() -> None:
    m = model()
    state = m.state(0.01, 1e-6 * np.arange(N), np.zeros(N))
    whole = core.march(m, state, SCHEME, 600, 7, start=True)[2]
    _, middle, first = core.march(m, state, SCHEME, 200, 7, start=True)
    second = core.march(m, middle, SCHEME, 400, 7)[2]
    assert first + second == whole
    assert whole.counts == {n: first.counts[n] + second.counts[n] for n in whole.counts}
    assert whole.counts["iterations"] > whole.steps == 600  # Newton's iteration takes more than one to a step
    assert (second + first).t == first.t


def test_other_threads_run_during_a_march() -> None:
    """The interpreter is free while the core works: a march of one call without chunks to speak of."""
    m = model()
    ticks: list[float] = []
    stop = threading.Event()

    def tick() -> None:
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-3)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.perf_counter()
    chunks: list[float] = []
    core.march(
        m,
        at_rest(m),
        SCHEME,
        300_000,
        1000,
        start=True,
        progress=lambda done, total: chunks.append(time.perf_counter()),
    )
    ended = time.perf_counter()
    stop.set()
    thread.join()
    # the longest chunk takes tens of ms; if the lock were held in it, no tick would fall inside
    edges = [began, *chunks, ended]
    longest = max(range(len(edges) - 1), key=lambda i: edges[i + 1] - edges[i])
    inside = [t for t in ticks if edges[longest] < t < edges[longest + 1]]
    assert len(inside) >= 3


# ---------------------------------------------------------------- progress, interrupts, failure


def test_progress_is_called_to_the_end() -> None:
    m = model()
    seen: list[tuple[int, int]] = []
    core.march(
        m, at_rest(m), SCHEME, 5000, start=True, progress=lambda done, total: seen.append((done, total))
    )
    assert seen[-1] == (5000, 5000)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})
    heard: list[tuple[int, int]] = []
    harmonic(m, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (3, 3)


@pytest.mark.parametrize("call", ["march", "harmonic"])
def test_an_exception_in_progress_comes_through(call: str) -> None:
    class Enough(Exception):
        pass

    def progress(done: int, total: int) -> None:
        raise Enough(done)

    m = model()

    def long_call() -> None:
        if call == "march":
            core.march(m, at_rest(m), SCHEME, 100_000, start=True, progress=progress)
        else:
            harmonic(m, progress=progress)

    with pytest.raises(Enough):
        long_call()
    with pytest.raises(TypeError):
        core.march(m, at_rest(m), SCHEME, 10, progress=3)  # type: ignore[arg-type]


def test_a_keyboard_interrupt_in_progress_ends_a_march_with_what_there_is() -> None:
    def progress(done: int, total: int) -> None:
        raise KeyboardInterrupt

    def at_the_end(done: int, total: int) -> None:
        if done == total:
            raise KeyboardInterrupt

    m = model()
    for steps, listener in ((1_000_000, progress), (20, at_the_end)):
        record, _, report = core.march(m, at_rest(m), SCHEME, steps, start=True, progress=listener)
        assert report.status == core.INTERRUPTED
        assert 0 < report.steps <= steps
        assert len(record) == report.steps
    assert report.steps == 20  # an interrupt after the last step is not lost either
    with pytest.raises(KeyboardInterrupt):
        harmonic(m, progress=progress)


LONG_MARCH = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background inherits it ignored
sys.path.insert(0, {tests!r})
import numpy as np
from core_models import SCHEME, core, model, at_rest
m = model()
print("ready", flush=True)
record, state, report = core.march(m, at_rest(m), SCHEME, 10**9, 100_000, start=True)
print("done", report.status, report.steps, len(record), time.time(), flush=True)
"""

SHORT_MARCHES = """
import signal, sys, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background inherits it ignored
sys.path.insert(0, {tests!r})
import numpy as np
from core_models import SCHEME, core, model, at_rest
m = model()
state = at_rest(m)
print("ready", flush=True)
try:
    for _ in range(10**6):
        record, state, report = core.march(m, state, SCHEME, 4000, 4000)
        if report.status != 0:
            break
    print("done", report.status, report.steps, len(record), time.time(), flush=True)
except KeyboardInterrupt:  # it came between two marches
    print("done", core.INTERRUPTED, 0, 0, time.time(), flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="SIGINT is sent by POSIX means")
@pytest.mark.parametrize("program", [LONG_MARCH, SHORT_MARCHES], ids=["a long march", "many short marches"])
def test_ctrl_c_ends_a_march_at_once(program: str) -> None:
    # a loaded machine may hold either process up: the bound must hold in one of three attempts
    assert min(seconds_to_stop(program) for _ in range(3)) < 0.2


def seconds_to_stop(program: str) -> float:
    """From the signal to the report, in seconds; the report itself is checked."""
    child = subprocess.Popen(
        [sys.executable, "-c", program.format(tests=str(Path(__file__).parents[1]))],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert child.stdout is not None
    try:
        assert child.stdout.readline() == "ready\n"
        time.sleep(0.3)
        sent = time.time()
        child.send_signal(signal.SIGINT)
        answer, _ = child.communicate(timeout=20)
    finally:
        child.kill()
    found = re.fullmatch(r"done (\d+) (\d+) (\d+) ([\d.]+)\n", answer)
    assert found, answer
    status, steps, rows, at = (float(g) for g in found.groups())
    assert status == core.INTERRUPTED
    if program is LONG_MARCH:
        assert steps > 1000
        assert rows == steps // 100_000
    return at - sent


def test_a_short_call_listens_before_long_steps() -> None:
    """The first chunk is a step: a large system is interruptible from the start."""
    m = model()
    seen: list[int] = []
    core.march(m, at_rest(m), SCHEME, 1000, progress=lambda done, total: seen.append(done))
    assert seen[0] <= 4


def test_an_absurd_load_is_a_status_with_step_time_bearing_and_residual() -> None:
    """The push comes after 20 steps; what was computed up to there is kept."""
    time_table, value = np.array([20.5 * 2.5e-6, 21 * 2.5e-6]), np.array([0.0, 1e300])
    a = arguments()
    push = (3, 0.0, 1e8 * np.ones(N), np.zeros(N), time_table, value)
    m = model(loads=[a["loads"][0], push])
    record, state, report = core.march(m, at_rest(m), SCHEME, 100, start=True)
    calm, expected, _ = core.march(m, at_rest(m), SCHEME, 20, start=True)
    assert report.status < 0
    assert report.steps == len(record) == 20
    assert report.t == pytest.approx(20 * 2.5e-6, rel=1e-12)
    assert report.bearing == 0
    assert not report.residual <= SCHEME.scheme.tolerance
    assert report.text
    np.testing.assert_array_equal(record, calm)
    np.testing.assert_array_equal(state, expected)


def test_too_few_iterations_are_a_status() -> None:
    m = model()
    scheme = stepping(dt=1e-4, speed=300.0, max_iterations=1)
    _, state, report = core.march(m, m.state(0.0, np.full(N, 1e-5), np.ones(N)), scheme, 50, start=True)
    assert report.status == -6
    assert "converge" in report.text
    assert report.bearing == 0
    assert np.isfinite(state).all()


def test_a_singular_mass_is_a_status_and_leaves_the_state() -> None:
    m = model(M=np.diag([1.0, 1, 1, 1, 1, 0]))
    state = m.state(0.25, np.zeros(N), np.zeros(N))
    _, after, report = core.march(m, state, SCHEME, 10, start=True)
    assert report.status == -5
    assert report.t == 0.25
    assert report.steps == 0
    assert np.isfinite(after).all()


def test_no_steps_report_the_time_they_stand_at() -> None:
    m = model()
    state = m.state(0.125, np.zeros(N), np.zeros(N))
    _, state, report = core.march(m, state, SCHEME, 0, start=True)
    assert (report.status, report.steps, report.t) == (0, 0, 0.125)
    _, state, report = core.march(m, state, SCHEME, 4)
    assert core.march(m, state, SCHEME, 0)[2].t == pytest.approx(0.125 + 4 * 2.5e-6, rel=1e-14)


def test_overflow_without_bearings_is_a_status() -> None:
    """Central differences far beyond their limit; nothing is recorded in time to notice."""
    one = np.ones((1, 1))
    m = core.Model(one, 0 * one, 0 * one, 1e6 * one, 0 * one, [], [], [], [(0, np.ones(1), 0, 0)])
    _, state, report = core.march(
        m, m.state(0.0, np.ones(1), np.zeros(1)), stepping(dt=1.0, beta=0.0), 1000, 10**6, start=True
    )
    assert report.status == -7
    assert 10 < report.steps < 1000
    assert np.isfinite(state).all()


def test_every_instruction_set_gives_the_same_bits() -> None:
    m = model()
    base, state, _ = core.march(m, at_rest(m), stepping(dt=2.5e-6, speed=300.0, isa="base"), 500, start=True)
    for name in ("avx2", "avx512", "best"):
        try:
            record, other, _ = core.march(
                m, at_rest(m), stepping(dt=2.5e-6, speed=300.0, isa=name), 500, start=True
            )
        except ValueError:
            continue  # not on this machine
        np.testing.assert_array_equal(record, base)
        np.testing.assert_array_equal(other, state)
