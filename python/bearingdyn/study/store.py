"""A store of finished cases: one SQLite file in a folder, a row for each by the hash of what it came from.

A row takes 28 µs of computing where a file of its own took 640 µs, and 100 thousand rows 15 MB where as many
files took 400.
"""

from __future__ import annotations

import functools
import hashlib
import json
import logging
import math
import os
import sqlite3
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bearingdyn import fingerprint
from bearingdyn.checks import instance
from bearingdyn.results import versions
from bearingdyn.study.cases import Case, Parameters

FILE = "cases.sqlite"
WAIT = 60.0  # s that another study in the same folder may take to write a row
TABLES = """
CREATE TABLE IF NOT EXISTS studies(
    id TEXT PRIMARY KEY, function TEXT, told TEXT, version TEXT, asked INTEGER, ahead INTEGER, began REAL);
CREATE TABLE IF NOT EXISTS cases(
    id TEXT PRIMARY KEY, study TEXT, parameters TEXT, "values" TEXT, error TEXT, at REAL) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS of_study ON cases(study, at);
"""
log = logging.getLogger(__name__)


def name_of(function: Callable[..., Any]) -> str:
    """Name under which the store keeps a study: module and name of its function, or a script's file."""
    inner = function.func if isinstance(function, functools.partial) else function
    named = inner if hasattr(inner, "__qualname__") else type(inner)
    module = str(getattr(named, "__module__", ""))
    if module in ("__main__", "__mp_main__"):
        module = Path(getattr(sys.modules["__main__"], "__file__", None) or "typed in").stem
    return f"{module}.{named.__qualname__}"


class Store:
    """The store of finished cases, by hash of what the function is, the version and the parameters.

    A row is there whole or not at all, also where the process is killed.

    Raises
    ------
    ValueError
        For a function that holds or uses what cannot be told by its content.
    """

    def __init__(self, folder: Path, function: Callable[..., Any]) -> None:
        name = name_of(function)
        try:  # now: a callable may change as it is called
            told = fingerprint.fingerprint(function)
        except (ValueError, RecursionError) as error:
            raise ValueError(
                f"function {name} cannot be told by its content, and a store would mix up its results "
                f"({error}); pass what it needs as parameters of the cases, give the object that holds it an "
                f"attribute told_as, a text that says all its results depend on, or leave store out"
            ) from None
        self._study = {"function": name, "told": told, "version": versions()["bearingdyn"]}
        self._id = fingerprint.fingerprint(self._study)
        self._path = folder / FILE
        self._file: sqlite3.Connection | None = None
        self._begun = False
        folder.mkdir(parents=True, exist_ok=True)

    def read(self, cases: Sequence[Parameters]) -> dict[int, Case]:
        """The finished among some cases, by their place."""
        if not self._path.exists():
            return {}
        with _named(self._path):
            rows = self._open().execute(
                'SELECT id, parameters, "values", error FROM cases WHERE study = ?', (self._id,)
            )
            kept = {str(row[0]): row[1:] for row in rows}
        found: dict[int, Case] = {}
        for index, parameters in enumerate(cases) if kept else ():
            key, described = self._key(parameters)
            if key in kept and (case := self._case(parameters, described, kept[key])):
                found[index] = case
        return found

    def write(self, case: Case, *, asked: int = 1, ahead: int = 1) -> None:
        """Keep a case, of so many that were asked for, and of so many that the store did not hold."""
        key, described = self._key(case.parameters)
        now = time.time()
        row = (key, self._id, described, json.dumps(dict(case.values)), case.error, now)
        with _named(self._path):
            file = self._open()
            if not self._begun:
                study = (self._id, *self._study.values(), asked, ahead, now)
                file.execute("INSERT OR REPLACE INTO studies VALUES(?, ?, ?, ?, ?, ?, ?)", study)
                self._begun = True
            file.execute("INSERT OR REPLACE INTO cases VALUES(?, ?, ?, ?, ?, ?)", row)

    def close(self) -> None:
        """Let go of the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _open(self) -> sqlite3.Connection:
        if self._file is None:
            self._file = sqlite3.connect(self._path, timeout=WAIT, isolation_level=None)
            # a log beside the file: a row is safe from the end of this process without a wait for the disk
            self._file.execute("PRAGMA journal_mode = WAL")
            self._file.execute("PRAGMA synchronous = NORMAL")
            self._file.executescript(TABLES)
        return self._file

    def _key(self, parameters: Parameters) -> tuple[str, str]:
        described = json.dumps(fingerprint.describe(parameters), sort_keys=True)
        return hashlib.sha256(f"{self._id}{described}".encode()).hexdigest()[:32], described

    def _case(self, parameters: Parameters, described: str, row: tuple[Any, ...]) -> Case | None:
        try:
            if row[0] != described:
                raise ValueError("another case than its key says")
            values = {str(k): float(v) for k, v in json.loads(row[1]).items()}
        except (ValueError, TypeError, AttributeError, OverflowError, RecursionError) as error:
            log.warning("%s: a row holds no finished case (%s); it is computed again", self._path, error)
            return None
        return Case(parameters, values, None if row[2] is None else str(row[2]))


@dataclass(frozen=True)
class StudyStatus:
    """How far a study is, as its store tells it.

    Parameters
    ----------
    function, version
        Name of its function, and version of this package with which it was begun.
    asked
        Cases of its last `sweep`.
    done, failed
        Rows in the store with values and with errors, of this and earlier sweeps of the same function.
    ahead
        Cases of the last sweep that are not finished.
    began, last
        Times of the first and the last case that the last sweep finished, s since 1970.
    seconds_left
        What is ahead will take, at the mean pace between these; NaN where one case alone is finished.
    """

    function: str
    version: str
    asked: int
    done: int
    failed: int
    ahead: int
    began: float
    last: float
    seconds_left: float

    def __str__(self) -> str:
        words = f"{self.function}: {self.asked - self.ahead} of {self.asked} cases"
        words += f", {self.failed} failed" if self.failed else ""
        if not self.ahead:
            return f"{words}, complete"
        left = self.seconds_left
        return f"{words}, {self.ahead} ahead" + (f", about {left:.0f} s" if left == left else "")


def status(store: str | os.PathLike[str]) -> list[StudyStatus]:
    """How far the studies in a store are, the last begun first; also while one runs, and from elsewhere.

    Parameters
    ----------
    store
        Folder, as given to `sweep`.

    Returns
    -------
    list of StudyStatus
        One for each function and version; ``print(*study.status("store"), sep="\\n")`` shows them.

    Raises
    ------
    ValueError
        Where the folder holds no store.
    """
    instance("store", store, (str, os.PathLike), "it must be the folder that sweep(store=…) got")
    path = Path(store) / FILE
    if not path.exists():
        raise ValueError(f"store {str(store)!r} holds no {FILE}; give the folder that sweep(store=…) got")
    found = []
    with _named(path), closing(sqlite3.connect(path, timeout=WAIT)) as file:
        rows = file.execute("SELECT id, function, version, asked, ahead, began FROM studies").fetchall()
        for study, function, version, asked, ahead, began in sorted(rows, key=lambda row: -row[5]):
            whole, failed, last = file.execute(
                "SELECT count(*), count(error), max(at) FROM cases WHERE study = ?", (study,)
            ).fetchone()
            (since,) = file.execute(
                "SELECT count(*) FROM cases WHERE study = ? AND at >= ?", (study, began)
            ).fetchone()
            left = max(ahead - since, 0)
            pace = (last - began) / (since - 1) if since > 1 else math.nan
            found.append(
                StudyStatus(
                    function, version, asked, whole - failed, failed, left, began,
                    last, left * pace if left else 0.0,
                )
            )  # fmt: skip
    return found


class _named:
    """A context in which the errors of SQLite name the file and what to do."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: Any, error: BaseException | None, trace: Any) -> None:
        if isinstance(error, sqlite3.Error):
            raise ValueError(
                f"store {self.path} cannot be used ({error}); it must be a store of this package on a disk "
                f"of this machine: give another folder, or remove the file to compute all cases again"
            ) from error
