"""Bodies that radiate together: their skins, where they stand, and their panels for a band of frequencies."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import scipy.linalg

from bearingdyn.cms import Skin
from bearingdyn.short_repr import short
from bearingdyn.sound.skin_panels import SkinPanels, panelled
from bearingdyn.sound.triangle_surface import TriangleSurface
from bearingdyn.types import Array, Index

# Sides of the program's panels, and along the longest extent of a body, at least. A sphere's power is within
# .005 dB with fewer; a plate's, whose edges the panels resolve worst, asks for them: .07 dB and less.
PER_WAVELENGTH, PER_BODY = 6.0, 16.0


@dataclass(frozen=True, eq=False)
class RadiatingPanels:
    """Panels of all radiators in one surface.

    Parameters
    ----------
    surface
        The panels, without those on the floor.
    rows
        (m, n): their outward normal velocity from the coordinates of all bodies.
    body
        (m,): which body each belongs to.
    shares
        Of each body, name -> the share of each of its panels that lies on a named surface.
    unnamed
        (m,): the share of each panel that lies on none.
    """

    surface: TriangleSurface
    rows: Array
    body: Index
    shares: Sequence[Mapping[str, Array]]
    unnamed: Array

    __repr__ = short


@dataclass(frozen=True, eq=False)
class Radiators:
    """Radiators: bodies that radiate together.

    Parameters
    ----------
    skins
        Of the bodies.
    places
        (bodies, 3), m: what to add to the points of each skin.
    floor
        Height y of a rigid floor, m; None: free field.
    """

    skins: Sequence[Skin]
    places: Array
    floor: float | None = None
    _made: dict[float, RadiatingPanels] = field(default_factory=dict, init=False, repr=False)

    __repr__ = short

    @property
    def coordinates(self) -> int:
        """Coordinates of all bodies together."""
        return sum(skin.rows.shape[1] for skin in self.skins)

    @property
    def blocks(self) -> list[slice]:
        """Coordinates of each body."""
        ends = np.cumsum([0, *(skin.rows.shape[1] for skin in self.skins)])
        return [slice(int(a), int(b)) for a, b in pairwise(ends)]

    def size(self, wavelength: float) -> float:
        """Wanted side of the panels, m, at a wavelength, m."""
        least = min(float(np.ptp(skin.points, axis=0).max()) for skin in self.skins)
        return min(wavelength / PER_WAVELENGTH, least / PER_BODY)

    def surface(self, size: float) -> tuple[TriangleSurface, Array]:
        """One surface of all bodies, and how their coordinates move its triangles, (m, n); kept."""
        made = self.panels(size)
        return made.surface, made.rows

    def panels(self, size: float) -> RadiatingPanels:
        """The panels of all bodies with sides near `size`, m; kept."""
        if size not in self._made:
            self._made[size] = self._panels(size)
        return self._made[size]

    def _panels(self, size: float) -> RadiatingPanels:
        made: dict[tuple[str, ...], SkinPanels] = {}
        points, faces, rows, body, shares, bare, count = [], [], [], [], [], [], 0
        for k, (skin, place) in enumerate(zip(self.skins, self.places, strict=True)):
            key = (digest(skin.points, skin.faces, skin.rows, *skin.surfaces.values()), *skin.surfaces)
            if key not in made:
                made[key] = panelled(skin, size)
            own = made[key]
            points.append(own.points + place)
            faces.append(own.faces + count)
            rows.append(own.rows)
            body.append(np.full(len(own.faces), k))
            shares.append(own.shares)
            bare.append(own.unnamed)
            count += len(own.points)
        p, f = np.vstack(points), np.vstack(faces)
        B, owner = np.asarray(scipy.linalg.block_diag(*rows)), np.concatenate(body)
        radiate: Array = np.ones(len(f), dtype=bool)
        if self.floor is not None:
            # feet that stand on the floor, to the errors of the fit
            near = np.abs(p[:, 1] - self.floor) < 1e-6 * float(np.ptp(p, axis=0).max())
            p[near, 1] = self.floor
            radiate = np.asarray(~near[f].all(axis=1))
        named = [
            {name: share[radiate[owner == k]] for name, share in own.items()} for k, own in enumerate(shares)
        ]
        unnamed = np.concatenate(bare)[radiate]
        return RadiatingPanels(TriangleSurface(p, f, self.floor), B[radiate], owner[radiate], named, unnamed)

    def fingerprint(self) -> str:
        """Hash of everything that the radiation of these bodies depends on."""
        parts = [a for skin in self.skins for a in (skin.points, skin.faces, skin.rows)]
        floor = np.array([np.nan if self.floor is None else self.floor])
        return digest(*parts, np.asarray(self.places), floor)


def digest(*arrays: Array | Index) -> str:
    """Hash of arrays by which radiators are known, their shapes with them."""
    found = hashlib.sha256()
    for a in arrays:
        found.update(f"{a.dtype.kind}{a.shape}".encode())
        found.update(np.ascontiguousarray(a).tobytes())
    return found.hexdigest()
