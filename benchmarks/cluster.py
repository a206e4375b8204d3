"""Many quick cases on a cluster of dask.distributed while workers are killed and its scheduler is replaced.

python benchmarks/cluster.py [--json] [--cases 100000] [--workers 2] [--kill 5]

A worker is killed every few seconds, and at half of the cases the whole cluster, scheduler and workers, goes
away; another takes its place and the study is run again with the same store. Counted: cases in the store,
cases whose values are wrong or missing, cases begun again although the store held them (must be none), and
begun again because a worker died with them. At last the store is opened and told of, and read whole.
"""

from __future__ import annotations

import argparse
import json
import logging
import os
import signal
import sqlite3
import sys
import tempfile
import threading
import time
from contextlib import closing, suppress
from pathlib import Path
from typing import Any

from bearingdyn import study

LOST = (Exception,)  # what a sweep ends with when its cluster goes depends on what it was waiting for


def quick(case: dict[str, Any]) -> dict[str, float]:
    """A square, and a mark that it was begun, with the time, in a file of this process."""
    with open(f"{case['marks']}/{os.getpid()}", "a") as mark:
        mark.write(f"{case['x']:.0f} {time.time():.6f}\n")
    return {"y": case["x"] ** 2}


class Killer(threading.Thread):
    """Kills a worker that is at work every few seconds, until it is told to stop."""

    def __init__(self, cluster: Any, every: float) -> None:
        super().__init__(daemon=True)
        self.cluster, self.every, self.stop, self.killed = cluster, every, threading.Event(), 0

    def run(self) -> None:
        """Until `stop` is set."""
        while not self.stop.wait(self.every):
            at_work = set(self.cluster.scheduler.workers)  # not those that are still starting
            nannies = list(self.cluster.workers.values())
            alive = [nanny.pid for nanny in nannies if nanny.pid and nanny.worker_address in at_work]
            if alive:
                os.kill(alive[self.killed % len(alive)], signal.SIGKILL)
                self.killed += 1


def one_cluster(cases: list[Any], store: Path, workers: int, every: float, until: int | None) -> Any:
    """A study on a cluster of its own, which goes away at so many cases: what came of it, and the kills."""
    import dask
    import distributed

    # on a busy machine a successor takes longer to start than the 15 s after which it is given up
    dask.config.set({"distributed.deploy.lost-worker-timeout": "600 s"})
    cluster = distributed.LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
    )
    killer, found, gone = Killer(cluster, every), None, threading.Event()
    client = distributed.Client(cluster)

    def leave(done: int, total: int) -> None:
        if until is not None and done >= until and not gone.is_set():
            gone.set()
            with suppress(TimeoutError):
                cluster.close(timeout=30)

    killer.start()
    try:
        found = study.sweep(quick, cases, client.get_executor(), store=store, progress=leave)
    except LOST as error:
        if not gone.is_set():
            raise
        print(f"the first cluster's study ended with {type(error).__name__}", file=sys.stderr)
    finally:
        killer.stop.set()
        # a worker killed while it starts is waited for without end by the cluster that closes
        with suppress(TimeoutError):
            client.close(timeout=30)
        with suppress(TimeoutError):
            cluster.close(timeout=30)
    return found, killer.killed


def measure(count: int, workers: int, every: float) -> dict[str, Any]:
    """The whole story."""
    logging.disable(logging.ERROR)  # of the cluster, about its dead
    with tempfile.TemporaryDirectory() as folder:
        store, marks = Path(folder) / "store", Path(folder) / "marks"
        marks.mkdir()
        cases = study.grid(x=[float(x) for x in range(count)], marks=[str(marks)])
        began = time.perf_counter()
        first, killed = one_cluster(cases, store, workers, every, count // 2)
        (half,) = study.status(store)
        found, more = one_cluster(cases, store, workers, every, None)
        seconds = time.perf_counter() - began

        cpu = time.process_time()
        (told,) = study.status(store)
        opened = time.process_time() - cpu
        cpu = time.process_time()
        again = study.sweep(quick, cases, store=store, progress=False)
        read = time.process_time() - cpu
        with closing(sqlite3.connect(store / "cases.sqlite")) as file:
            rows = file.execute("SELECT parameters, at FROM cases")
            kept = {json.loads(parameters)["x"]: at for parameters, at in rows}
        begun: dict[float, list[float]] = {}
        for line in (line for path in marks.iterdir() for line in path.read_text().splitlines()):
            x, at = line.split()
            begun.setdefault(float(x), []).append(float(at))
        size = sum(path.stat().st_size for path in store.iterdir())
        return {
            "cases": count,
            "workers": workers,
            "killed": killed + more,
            "scheduler_lost": first is None,
            "in_store_when_scheduler_was_lost": half.done,
            "stored": len(kept),
            "told_done": told.done,
            "wrong_or_missing": sum(case.values.get("y") != case.parameters["x"] ** 2 for case in found),
            "begun_again_though_stored": sum(at > kept[x] for x, times in begun.items() for at in times),
            "begun_again_after_a_death": sum(len(times) - 1 for times in begun.values()),
            "the_same_read_again": again == found,
            "seconds": round(seconds, 1),
            "open_and_tell_cpu_s": round(opened, 3),
            "read_all_cpu_s": round(read, 2),
            "files": len(list(store.iterdir())),
            "store_MB": round(size / 1e6, 1),
        }


def main() -> int:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument("--cases", type=int, default=100_000)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kill", type=float, default=5.0, help="s from one kill to the next")
    options = parser.parse_args()
    result = measure(options.cases, options.workers, options.kill)
    print(json.dumps(result) if options.json else "\n".join(f"{k:>34}: {v}" for k, v in result.items()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
