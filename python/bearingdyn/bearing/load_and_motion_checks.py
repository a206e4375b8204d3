"""Loads on a bearing and motions of its rings, checked against what machines have."""

from __future__ import annotations

from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array


def check_load(field: str, load: Array) -> None:
    """Check each entry of a load (6,) on a bearing, N and N m, against what machines have."""
    for k, x in enumerate(load.tolist()):
        kind = "force" if k < 3 else "moment"
        plausible(kind, f"{field}[{k}], the {kind} along {'xyz'[k % 3]},", x)


def check_motion(field: str, q: Array) -> None:
    """Check each entry of a motion (3,) or (6,) of a ring, m and rad."""
    for k, x in enumerate(q.tolist()):
        plausible("displacement" if k < 3 else "tilt", f"{field}[{k}]", x)
