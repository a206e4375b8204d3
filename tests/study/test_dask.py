"""Studies on a cluster of dask.distributed: the same call, and a worker killed on the way costs nothing."""

from __future__ import annotations

import concurrent.futures
import os
import signal
import threading
import time

import pytest

from bearingdyn import study

distributed = pytest.importorskip("distributed")


def slow(case):
    """Marks its beginning in a file of its own, then takes a while."""
    with open(f"{case['folder']}/{case['x']:g}.{os.getpid()}.begun", "w") as mark:
        mark.write("x")
    time.sleep(case["seconds"])
    if case["x"] == 7.0:
        raise ValueError("seven is not lucky here")
    return {"y": case["x"] ** 2, "pid": os.getpid()}


@pytest.fixture
def client():
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a process that can be killed")
def test_worker_killed_on_the_way_loses_nothing_and_stores_nothing_twice(client, tmp_path):
    store, marks = tmp_path / "store", tmp_path / "marks"
    marks.mkdir()
    cases = study.grid(x=[float(x) for x in range(24)], seconds=[0.1], folder=[str(marks)])
    pids = set(client.run(os.getpid).values())
    assert len(pids) == 2
    victim, seen = min(pids), []

    def kill_one(done, total):
        seen.append(done)
        if done == 6:
            os.kill(victim, signal.SIGKILL)

    found = study.sweep(slow, cases, client.get_executor(), store=store, progress=kill_one)
    assert seen == list(range(1, 25))  # each case came back once
    assert [c.parameters["x"] for c in found] == [float(x) for x in range(24)]
    assert [c.values.get("y") for c in found] == [None if x == 7 else float(x**2) for x in range(24)]
    assert [c.error for c in found if c.error] == ["ValueError: seven is not lucky here"]
    (told,) = study.status(store)
    assert (told.asked, told.done, told.failed, told.ahead) == (24, 23, 1, 0)
    # both workers had begun cases, and the killed one's are begun anew by the other or its successor
    begun = [path.name.split(".") for path in marks.iterdir()]
    assert {int(pid) for _, pid, _ in begun} >= pids
    assert len(begun) >= 24

    before = len(begun)
    again = study.sweep(slow, cases, client.get_executor(), store=store)
    assert again == found
    assert len(list(marks.iterdir())) == before


def always_dies(case):
    if case["x"] == 1.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return {"y": case["x"]}


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="needs a process that can be killed")
def test_case_that_kills_every_worker_fails_alone(client):
    found = study.sweep(always_dies, study.grid(x=[0.0, 1.0, 2.0]), client.get_executor())
    assert [c.values.get("y") for c in found] == [0.0, None, 2.0]
    assert "KilledWorker" in found[1].error


class Counting:
    """An executor of a cluster of four processors that counts the chunks of several cases on their way."""

    def __init__(self) -> None:
        self._client, self.away, self.most, self.lock = self, 0, 0, threading.Lock()

    def ncores(self):
        return {"one": 2, "other": 2}

    def submit(self, function, *arguments):
        future, counts = concurrent.futures.Future(), len(arguments[1]) > 1
        with self.lock:
            self.away += counts
            self.most = max(self.most, self.away)

        def finish():
            with self.lock:
                self.away -= counts
            future.set_result(function(*arguments))

        threading.Timer(0.02, finish).start()
        return future


def test_a_cluster_is_handed_what_its_processors_need():
    """What more is on its way lies with its workers, and is made anew where one dies."""
    pool = Counting()
    found = study.sweep(square, study.grid(x=[float(x) for x in range(5000)]), pool, progress=False)
    assert [case.values["y"] for case in found] == [float(x) ** 2 for x in range(5000)]
    assert 0 < pool.most <= 12  # three for each of four


def square(case):
    return {"y": case["x"] ** 2}
