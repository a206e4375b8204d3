"""Superelements kept in a folder: equal to the bit, found by their content, whole or not at all."""

from __future__ import annotations

import dataclasses
import multiprocessing
import os
import signal
import time
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bearingdyn.application import Application
from bearingdyn.bearing.catalogue import bearing
from bearingdyn.cms import Superelement, kept_superelement
from bearingdyn.fem import Section
from bearingdyn.material import BulkRelaxation, Maxwell
from bearingdyn.notice import VolumeCounts
from bearingdyn.parts import FlexibleRing, Housing, Layer, Shaft
from bearingdyn.system import assemble

RUBBER = Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-2, 1e-4], K=2e9, density=1150.0)
BRICK = Housing(0.08, 0.08, 0.02, 0.052, bore_height=0.04, damping=0.01, f_max=3e3, element_size=0.02)


def same(a: Any, b: Any, where: str = "") -> None:
    """Two values equal to the bit, dataclasses field by field."""
    assert type(a) is type(b), where
    if dataclasses.is_dataclass(a) and not isinstance(a, Maxwell):
        for field in dataclasses.fields(a):
            same(getattr(a, field.name), getattr(b, field.name), f"{where}.{field.name}")
    elif isinstance(a, dict):
        assert list(a) == list(b), where
        for name in a:
            same(a[name], b[name], f"{where}[{name!r}]")
    elif isinstance(a, tuple):
        assert len(a) == len(b), where
        for k, (one, other) in enumerate(zip(a, b, strict=True)):
            same(one, other, f"{where}[{k}]")
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype, where
        np.testing.assert_array_equal(a, b, where)
    else:
        assert a == b, where


PARTS = {
    "shaft": Shaft([Section(0.1, 0.02)], {"left": 0.02}, {"end": 0.1}, damping=0.01, f_max=5e3),
    "layer": Layer(0.026, 0.030, 0.015, RUBBER),
    "relaxing volume": Layer(0.026, 0.030, 0.015, replace(RUBBER, bulk=BulkRelaxation([0.2], [1e-3]))),
    "housing": BRICK,
    "ring": FlexibleRing.of(bearing("6205"), f_max=0.0),
}


@pytest.mark.parametrize("name", PARTS)
def test_a_kept_part_is_the_reduced_one_to_the_bit(name: str, tmp_path: Path) -> None:
    part = PARTS[name]
    first = kept_superelement(part, tmp_path)
    before = {p: p.stat().st_mtime_ns for p in tmp_path.iterdir()}
    again = kept_superelement(part, tmp_path)
    assert len(before) == 1
    assert {p: p.stat().st_mtime_ns for p in tmp_path.iterdir()} == before
    same(first, again)
    for ours, theirs in zip(first.viscoelastic, again.viscoelastic, strict=True):
        assert ours.material == theirs.material


def test_what_differs_in_anything_is_reduced_by_itself(tmp_path: Path) -> None:
    layer = PARTS["layer"]
    assert isinstance(layer, Layer)
    found = [
        kept_superelement(one, tmp_path).stiffness(10.0)
        for one in (layer, replace(layer, width=0.016), replace(layer, material=replace(RUBBER, G0=2e6)))
    ]
    assert len(list(tmp_path.iterdir())) == 3
    assert not np.allclose(found[0], found[1])
    assert not np.allclose(found[0], found[2])


def test_a_machine_of_kept_parts_is_the_machine(tmp_path: Path) -> None:
    made = []
    for cache in (None, tmp_path, tmp_path):
        app = Application()
        app.add("layer", PARTS["layer"], cache=cache)
        app.add("housing", replace(BRICK, bore_diameter=0.060), cache=cache)
        app.connect("layer.outer", "housing.bore")
        app.ground("housing.feet")
        app.free("layer.inner")
        assert app.plan.sources["layer"] is PARTS["layer"]
        made.append(assemble(app))
    for other in made[1:]:
        np.testing.assert_array_equal(made[0].K, other.K)
        np.testing.assert_array_equal(made[0].M, other.M)
        assert made[0].inputs == other.inputs


def test_a_cut_or_damaged_file_is_made_anew(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    first = kept_superelement(PARTS["shaft"], tmp_path)
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()
    for broken in (b"", whole[: len(whole) // 2], whole[:200] + b"x" + whole[201:], b"\0" * len(whole)):
        path.write_bytes(broken)
        same(first, kept_superelement(PARTS["shaft"], tmp_path))
        assert path.read_bytes() == whole
        assert "cannot be read; the part is reduced again" in caplog.text


def test_doubts_of_a_reduction_are_told_when_it_is_read(tmp_path: Path) -> None:
    thin = Layer(0.026, 0.0265, 0.015, RUBBER)
    told = []
    for _ in range(2):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            kept_superelement(thin, tmp_path)
        told.append([(w.category, str(w.message)) for w in caught])
    assert told[0] == told[1]
    assert VolumeCounts in [category for category, _ in told[0]]


class Foreign:
    """A part whose law of rubber is nowhere in its fields."""

    told_as = "a foreign part"

    def superelement(self) -> Superelement:
        return Layer(0.026, 0.030, 0.015, RUBBER).superelement()


def test_a_part_with_a_law_that_is_not_its_own_is_reduced_each_time(tmp_path: Path) -> None:
    assert kept_superelement(Foreign(), tmp_path).n == kept_superelement(Foreign(), tmp_path).n
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_kept_is_refused_by_name(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        kept_superelement(PARTS["shaft"], tmp_path / "file")
    made = PARTS["shaft"].superelement()
    assert kept_superelement(made, tmp_path / "nowhere") is made


def _work(folder: str, number: int) -> None:
    for k in range(50):
        part = Shaft([Section(0.1, 0.02 + 1e-4 * ((number + k) % 25))], {"left": 0.02}, f_max=2e3)
        kept_superelement(part, folder)


def test_workers_that_are_killed_leave_whole_files(tmp_path: Path) -> None:
    context = multiprocessing.get_context("fork" if os.name == "posix" else "spawn")
    rng = np.random.default_rng(3)
    for number in range(12):
        workers = [context.Process(target=_work, args=(str(tmp_path), number + k)) for k in (0, 7)]
        for worker in workers:
            worker.start()
        time.sleep(rng.uniform(0.02, 0.15))
        for worker in workers:
            if worker.pid is not None:
                os.kill(worker.pid, getattr(signal, "SIGKILL", signal.SIGTERM))
            worker.join()
    for k in range(25):
        part = Shaft([Section(0.1, 0.02 + 1e-4 * k)], {"left": 0.02}, f_max=2e3)
        same(part.superelement(), kept_superelement(part, tmp_path))
