"""Finished searches of a map, kept in a folder: one file of arrays each, named by what it was made from."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bearingdyn.analysis.steady.balance import Pressed
from bearingdyn.analysis.steady.branches import Branch, Mark
from bearingdyn.analysis.steady.continuation import Point
from bearingdyn.analysis.steady.stability import Stability
from bearingdyn.fingerprint import fingerprint
from bearingdyn.kept_arrays import read_arrays, write_arrays
from bearingdyn.types import Array


@dataclass(frozen=True)
class BranchFiles:
    """Files of the branches of a speed map: a folder of finished searches, and what tells maps apart."""

    folder: Path
    told: str

    @classmethod
    def of(cls, folder: str | os.PathLike[str], about: object) -> BranchFiles:
        """The folder, made if it is not there, for maps of what is told by `about`."""
        path = Path(folder)
        path.mkdir(parents=True, exist_ok=True)
        return cls(path, fingerprint(about))

    def _path(self, search: object) -> Path:
        return self.folder / f"{fingerprint((self.told, search))}.arrays"

    def read(self, search: object) -> list[Branch] | None:
        """The branches of a search, or None where it was not finished, or its file is damaged.

        Raises
        ------
        ValueError
            For a file that is whole, and holds something else.
        """
        path = self._path(search)
        held = read_arrays(path)
        if held is None:
            return None
        try:
            heads = json.loads(str(held["heads"]))
            return [_branch({k: held[f"{i}.{k}"] for k in KEPT}, head) for i, head in enumerate(heads)]
        except (ValueError, LookupError, TypeError) as error:
            raise ValueError(f"{path} is no finished search of a map ({error}); delete it") from error

    def write(self, search: object, branches: list[Branch]) -> None:
        """Keep a finished search."""
        arrays: dict[str, Array] = {}
        heads = []
        for i, branch in enumerate(branches):
            heads.append([branch.passages, branch.origin, [m.event for m in branch.marks]])
            arrays |= {f"{i}.{k}": v for k, v in _arrays(branch).items()}
        write_arrays(self._path(search), {"heads": np.array(json.dumps(heads)), **arrays})


KEPT = ("z", "numbers", "tangent", "moved", "multipliers", "period")


def _arrays(branch: Branch) -> dict[str, Array]:
    points = [m.point for m in branch.marks]
    states = [m.stability for m in branch.marks]
    most = max((len(s.multipliers) for s in states if s is not None), default=0)
    multipliers = np.full((len(states), most), np.nan, dtype=np.complex128)
    for row, state in zip(multipliers, states, strict=True):
        if state is not None:
            row[: len(state.multipliers)] = state.multipliers
    return {
        "z": np.array([p.z for p in points]),
        "numbers": np.array([[p.parameter, p.residual, p.iterations, p.slope] for p in points]),
        "tangent": np.array([p.tangent for p in points]),
        "moved": np.array([m.moved for m in branch.marks]),
        "multipliers": multipliers,
        "period": np.array([np.nan if s is None else s.period for s in states]),
    }


def _branch(arrays: dict[str, Array], head: tuple[int, str, list[str]]) -> Branch:
    passages, origin, events = head
    marks = []
    nothing = Pressed.unknown()
    for i, event in enumerate(events):
        p, residual, iterations, slope = arrays["numbers"][i].tolist()
        z = np.ascontiguousarray(arrays["z"][i])
        point = Point(z, p, nothing, residual, int(iterations), arrays["tangent"][i], slope)
        values = arrays["multipliers"][i]
        values = values[np.isfinite(values)]
        period = float(arrays["period"][i])
        state = Stability(values, period) if np.isfinite(period) else None
        marks.append(Mark(point, state, arrays["moved"][i], event))
    return Branch(passages, tuple(marks), origin)
