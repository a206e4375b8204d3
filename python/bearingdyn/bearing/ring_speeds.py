"""Which ring of a bearing turns with the shaft: speeds of both rings over that of the shaft."""

from __future__ import annotations

from typing import Literal, TypeAlias

from bearingdyn.checks import vector

Turning: TypeAlias = Literal["inner", "outer", "both"] | tuple[float, float]
_WORDS = {"inner": (1.0, 0.0), "outer": (0.0, 1.0), "both": (1.0, 1.0)}


def ring_speeds(turning: Turning | None) -> tuple[float, float]:
    """Speeds of inner and outer ring over that of the shaft; of None, the inner ring turns.

    Raises
    ------
    ValueError
        For an unknown word, or anything else that is not a pair of finite numbers.
    """
    if turning is None:
        return _WORDS["inner"]
    if isinstance(turning, str):
        if turning not in _WORDS:
            raise ValueError(f"turning is {turning!r}; it must be {_REMEDY}")
        return _WORDS[turning]
    inner, outer = vector("turning", turning, (2,), _REMEDY)
    return float(inner), float(outer)


_REMEDY = (
    '"inner", "outer", "both", or the speeds of inner and outer ring over that of the shaft, as (1.0, -0.5)'
)
