"""The units a file is written in."""

from __future__ import annotations

from dataclasses import dataclass

from bearingdyn.checks import positive


@dataclass(frozen=True)
class Units:
    """Coherent units of a file: of length in m, of mass in kg, of time in s; force is mass·length/time².

    Raises
    ------
    ValueError
        For a unit that is not positive and finite.
    """

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def __post_init__(self) -> None:
        for name in ("length", "mass", "time"):
            positive(f"Units {name}", getattr(self, name), "it must be positive: how much SI one unit is")


SI = Units()
MM_TONNE = Units(length=1e-3, mass=1e3)  # mm, t, s: forces in N, stresses in MPa
