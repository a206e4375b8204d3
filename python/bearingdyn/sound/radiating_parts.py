"""The parts of a machine that radiate: found by their surfaces, checked, and solved octave by octave."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from bearingdyn.analysis import surface_of
from bearingdyn.application import arm
from bearingdyn.checks import name_list, number, positive, require
from bearingdyn.cms import Surface
from bearingdyn.notice import BeyondModes, CoarsePanels, warn
from bearingdyn.progress import Progress
from bearingdyn.short_repr import short
from bearingdyn.sound.radiation import PANELS
from bearingdyn.sound.radiators import Radiators
from bearingdyn.sound.resistance import Octave, octaves, solved_octave
from bearingdyn.system import PartTerm, System
from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class RadiatingParts:
    """Parts that radiate together, and the medium around them.

    Parameters
    ----------
    names
        Of the surfaces that were named.
    surfaces
        Each of them, with the part it belongs to.
    parts
        Those parts.
    radiators
        Their skins where they stand.
    density, sound_speed
        Of the medium, kg/m³ and m/s.
    element_size
        Side of the panels, m; None: by the wavelength.
    cache
        Folder of octaves solved before, or None.
    """

    names: Sequence[str]
    surfaces: Sequence[tuple[PartTerm, Surface]]
    parts: Sequence[PartTerm]
    radiators: Radiators
    density: float
    sound_speed: float
    element_size: float | None = None
    cache: Path | None = None

    __repr__ = short

    @classmethod
    def of(
        cls,
        system: System,
        surfaces: Sequence[str],
        *,
        highest: float,
        floor: float | None,
        density: float,
        sound_speed: float,
        element_size: float | None,
        cache: str | os.PathLike[str] | None = None,
    ) -> RadiatingParts:
        """The parts of a system that own the surfaces named, for frequencies up to `highest`, Hz.

        Raises
        ------
        ValueError
            For an unknown surface, a part whose boundary or place is not known, a floor above a part, and
            values that are not positive.

        Warns
        -----
        CoarsePanels
            For an `element_size` above a sixth of the shortest wavelength.
        BeyondModes
            For a frequency above the f_max of a part that radiates.
        """
        names = name_list("surfaces", surfaces, "surfaces", 1)
        density, sound_speed = positive("density", density), positive("sound_speed", sound_speed)
        if element_size is not None:
            element_size = positive("element_size", element_size, "it must be a positive length in m")
        found = [surface_of(system, name) for name in names]
        parts = list({term.name: term for term, _ in found}.values())
        radiators = _radiators(system, parts, floor)
        _check(radiators, parts, highest, element_size, sound_speed)
        folder = None if cache is None else Path(cache)
        return cls(names, found, parts, radiators, density, sound_speed, element_size, folder)

    def octaves(
        self, f: Array, microphones: Array | None = None, tell: Progress | None = None
    ) -> Iterator[tuple[Index, Octave]]:
        """The radiation resistance in each octave of the frequencies f, Hz, and which of them it holds."""
        if not f.max() > 0.0:
            return
        bands = octaves(float(f[f > 0].min()), float(f.max()))
        for k, (low, high) in enumerate(bands):
            # the lowest octave keeps its lower end, where nothing else begins
            above = f >= low if k == len(bands) - 1 else f > low
            at = np.flatnonzero(above & (f <= high))
            if not at.size:
                continue
            yield (
                at,
                solved_octave(
                    self.radiators, low, high, density=self.density, sound_speed=self.sound_speed,
                    microphones=np.zeros((0, 3)) if microphones is None else microphones,
                    element_size=self.element_size, cache=self.cache,
                ),
            )  # fmt: skip
            if tell is not None:
                tell(k + 1, len(bands))

    def said(self, octave: Octave) -> str:
        """Panels and frequencies of an octave, in words."""
        return (
            f"{octave.low:.5g}-{octave.high:.5g} Hz: {octave.panels} panels of {1e3 * octave.size:.3g} mm "
            f"(wavelength/{self.sound_speed / octave.high / octave.size:.1f}), "
            f"{len(octave.nodes)} frequencies"
        )

    def facts(self) -> dict[str, Any]:
        """Medium, surfaces and floor, as results tell them."""
        floor = self.radiators.floor
        reach = min(skin.f_max for skin in self.radiators.skins)
        return {
            **({"valid_to": reach} if math.isfinite(reach) else {}),
            "density": self.density,
            "sound_speed": self.sound_speed,
            "surfaces": ", ".join(self.names),
            "floor": "free field" if floor is None else f"rigid at y = {floor} m",
        }


def _radiators(system: System, parts: Sequence[PartTerm], floor: float | None) -> Radiators:
    skins, places = [], []
    for term in parts:
        skin = term.element.skin
        if skin is None:
            raise ValueError(
                f"part {term.name!r} has surfaces but no skin; make it a Housing, or a Solid with radiating="
            )
        at = system.positions.get(f"{term.name}.{next(iter(term.element.interfaces), None)}")
        if at is None or np.isnan(term.rigid).any():
            raise ValueError(f"part {term.name!r} has no known place; join it to the first part")
        # the mean of the points, from the first interface and in the part's own frame
        mean = skin.rows.reshape(-1, 3, skin.rows.shape[1]).mean(axis=0)
        skins.append(skin)
        places.append(at + arm(mean, term.rigid) - skin.points.mean(axis=0))
    if floor is not None:
        floor = number("floor", floor, "it must be a height y in m, or None")
        for term, skin, place in zip(parts, skins, places, strict=True):
            low = float((skin.points + place)[:, 1].min())
            extent = float(np.ptp(skin.points, axis=0).max())
            require(
                low >= floor - 1e-6 * extent,
                "floor",
                floor,
                f"part {term.name!r} reaches down to y = {low:.6g} m; put the floor at or below that",
            )
    return Radiators(skins, np.array(places), floor)


def _check(
    radiators: Radiators, parts: Sequence[PartTerm], highest: float, size: float | None, sound_speed: float
) -> None:
    """Words of warning before the work."""
    for term, skin in zip(parts, radiators.skins, strict=True):
        if highest > skin.f_max:
            warn(
                f"sound is asked for up to {highest:.5g} Hz, and part {term.name!r} was reduced up to "
                f"f_max = {skin.f_max:.5g} Hz; give it a higher f_max",
                BeyondModes,
            )
    if size is not None and highest > 0 and not size <= sound_speed / highest / PANELS:
        warn(
            f"element_size is {1e3 * size:.4g} mm, and a sixth of the wavelength at {highest:.5g} Hz is "
            f"{1e3 * sound_speed / highest / PANELS:.4g} mm; make it smaller, or leave it out",
            CoarsePanels,
        )
