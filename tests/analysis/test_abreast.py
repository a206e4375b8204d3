"""Marches side by side come out as marches one by one, to the bit, whatever they are asked for besides."""

from __future__ import annotations

import warnings
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, cast

import pytest
import xarray

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.analysis import abreast
from bearingdyn.notice import StrainedLayer

COMMON: dict[str, Any] = {
    "speed": 300.0,
    "dt": 5e-6,
    "settle": 200,
    "steps": 900,
    "decimate": 3,
    "record": ["rotor.centre.y", "rotor.centre.y.velocity", "ball.loaded", "ball.ball3", "ball.loss"],
}


def rotor(push: float = 400.0, thickness: float = 3e-3, **change: Any) -> bd.Equilibrium:
    """A rotor on a layered bearing whose balls lose contact."""
    rubber = bd.Maxwell(4e6, [1e6, 2e6], [1e-4, 1e-3], K=2e9, density=1150.0)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(4.0, (0.02, 0.02, 0.004), rotating=True))
    app.add("layer", bd.Layer(0.026, 0.026 + thickness, 0.016, rubber))
    plain: dict[str, Any] = {"clearance": 1e-5, "damping": 30.0}
    ball = bd.BallBearing(9, 7.94e-3, 39.04e-3, 0.52, 0.53, **(plain | change))
    app.bearing("ball", ball, inner="rotor.centre", outer="layer.inner")
    app.ground("layer.outer")
    app.load("rotor.centre", (0, -push, 100, 0, 0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", StrainedLayer)
        return bd.equilibrium(app)


@pytest.fixture(scope="module")
def cases() -> list[dict[str, Any]]:
    """Ten cases of one structure and three that do not go beside them."""
    base = rotor()
    sources = [rotor(clearance=1e-5 + 2e-6 * k) for k in range(4)]
    sources += [rotor(push=200.0), rotor(damping=60.0), rotor(waviness=[bd.Waviness("inner", 9, 1e-6)])]
    together = [{**COMMON, "source": source} for source in [*sources, base]]
    together += [
        {**COMMON, "source": base, "initial": {"rotor.centre": [1e-6, 0, 0, 0, 0, 0]}, "steps": 400},
        {**COMMON, "source": base, "settle": 0, "decimate": 7, "filter": False},
    ]
    apart: list[dict[str, Any]] = [
        {**COMMON, "source": base, "audit": True},
        {**COMMON, "source": base, "method": "exact"},
        {**COMMON, "source": rotor(thickness=2e-3)},
    ]
    return [*together, *apart]


def same(a: xarray.Dataset, b: xarray.Dataset) -> bool:
    names = ("record", "state", "time", *(["tail"] if "tail" in a else []))
    return all(a[name].values.tobytes() == b[name].values.tobytes() for name in names)


@pytest.fixture
def groups(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many calls went to the core at a time."""
    told: list[int] = []
    march = core.march_abreast

    def watched(calls: Any) -> Any:
        told.append(len(calls))
        return march(calls)

    monkeypatch.setattr(abreast.core, "march_abreast", watched)
    return told


@pytest.mark.parametrize("threads", [1, 2])
def test_each_case_is_its_own_march_to_the_bit(
    cases: list[dict[str, Any]], groups: list[int], threads: int
) -> None:
    found = bd.transients(cases, threads=threads)
    for case, result in zip(cases, found, strict=True):
        assert same(result, bd.transient(**case))
    assert max(groups) == min(8, -(-len(cases) // threads))  # they did go side by side


def test_streams_and_what_resumes_them_too(
    cases: list[dict[str, Any]], groups: list[int], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("bearingdyn.analysis.march_pieces.CHUNK_STEPS", 250)
    plain = [bd.transient(**case) for case in cases[:5]]
    paths = [tmp_path / f"{k}.bdrun" for k in range(5)]
    streamed = bd.transients(
        [{**case, "stream": path} for case, path in zip(cases, paths, strict=False)], threads=1
    )
    assert all(map(same, plain, streamed))
    for path in paths:  # as a kill leaves them
        whole = path.read_bytes()
        path.write_bytes(whole[: len(whole) * 2 // 3])
    again = bd.transients(
        [{**case, "stream": path} for case, path in zip(cases, paths, strict=False)], threads=1
    )
    assert all(map(same, plain, again))
    ends = bd.transients(
        [
            {**case, "settle": 0, "resume": run, "initial": None}
            for case, run in zip(cases, plain, strict=False)
        ],
        threads=1,
    )
    for case, run, end in zip(cases, plain, ends, strict=False):
        assert same(end, bd.transient(**{**case, "settle": 0, "resume": run}))
    assert max(groups) == 5


def test_a_case_that_fails_leaves_what_it_had_and_the_others_go_on(cases: list[dict[str, Any]]) -> None:
    # two iterations of Newton do not do where balls hop: that march ends, the rest do not notice
    told: list[str] = []
    lost = {**cases[1], "initial": {"rotor.centre": [0, 1e-4, 0, 0, 0, 0]}}
    scheme = bd.Scheme(max_iterations=3)
    group = [{**case, "scheme": scheme} for case in (cases[0], lost, cases[2])]

    def one(case: dict[str, Any]) -> xarray.Dataset:
        try:
            return bd.transient(**case)
        except core.SolverError as error:
            told.append(str(error))
            return cast("xarray.Dataset", error.partial)

    alone = [one(case) for case in group]
    assert len(told) == 1
    gathering = abreast.Gathering(3, 1)
    with ThreadPoolExecutor(3) as pool:
        runs = list(pool.map(gathering.member, [partial(one, case) for case in group]))
    assert all(map(same, alone, runs))
    assert told[0] == told[1]
    with pytest.raises(core.SolverError, match="did not converge"):
        bd.transients(group, threads=1)


def test_a_progress_that_raises_ends_its_own_march_alone(cases: list[dict[str, Any]]) -> None:
    def stop(done: int, total: int) -> None:
        raise LookupError(f"{done} of {total}")

    group = [cases[0], {**cases[1], "progress": stop}, cases[2]]
    with pytest.raises(LookupError):
        bd.transients(group, threads=1)
    heard: list[tuple[int, int]] = []
    group[1]["progress"] = lambda done, total: heard.append((done, total))
    found = bd.transients(group, threads=1)
    assert heard[-1] == (1100, 1100)
    assert same(found[1], bd.transient(**cases[1]))
