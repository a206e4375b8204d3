"""Superelements kept in a folder by the hash of what they are reduced from, for studies and their workers."""

from __future__ import annotations

import json
import logging
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, fields, is_dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from bearingdyn import notice
from bearingdyn.bearing import RacewaySeries
from bearingdyn.checks import require
from bearingdyn.cms.raceway import Raceway
from bearingdyn.cms.radiating_surface import Skin, Surface
from bearingdyn.cms.round_face import RoundFace
from bearingdyn.cms.superelement import Superelement
from bearingdyn.cms.viscoelastic import Viscoelastic
from bearingdyn.fingerprint import VERSION, fingerprint
from bearingdyn.kept_arrays import read_arrays, write_arrays
from bearingdyn.material import volume_of

log = logging.getLogger(__name__)

MATRICES = ("M", "C", "G", "K", "N")
FORMAT = 1  # of what a file holds


class Reducible(Protocol):
    """What a kept superelement is reduced from: any part."""

    def superelement(self) -> Superelement:
        """The reduced part."""


def kept_superelement(part: Reducible, folder: str | Path) -> Superelement:
    """The superelement of a part, kept in a folder: reduced once, then read, by this and every other process.

    The key is the content of the part and the version of this package. A file that was cut or damaged is made
    anew; one that is being written is not seen. Several workers may reduce the same part at once: each writes
    the same file, whole.

    Parameters
    ----------
    part
        Any part; a Superelement is returned as it is.
    folder
        Made where missing.

    Returns
    -------
    Superelement
        Its matrices to the bit as they were reduced; its materials are the part's own.

    Raises
    ------
    ValueError
        For a part that cannot be told by its content.
    OSError
        Where the folder cannot be written.

    Warns
    -----
    Notice
        What the reduction warned of, also when its result is read.
    """
    if isinstance(part, Superelement):
        return part
    key = {"part": fingerprint(part), "class": type(part).__qualname__, "version": VERSION, "format": FORMAT}
    path = Path(folder) / f"part-{fingerprint(key)}.arrays"
    laws = list(_laws(part))
    held = read_arrays(path)
    if held is None:
        if path.exists():
            log.warning("%s cannot be read; the part is reduced again", path)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            made = part.superelement()
        doubts = [(w.category.__name__, str(w.message)) for w in caught]
        arrays = _packed(made, laws)
        if arrays is None:
            log.info("%s has a material that is not its own; it is reduced each time", type(part).__name__)
        else:
            write_arrays(path, {**arrays, "doubts": np.array(json.dumps(doubts))})
    else:
        try:
            made, doubts = _unpacked(held, laws), _doubts(json.loads(str(held["doubts"])))
        except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, RecursionError) as error:
            raise ValueError(f"{path} holds no part of this kind ({error}); delete it") from error
    for category, text in doubts:  # of the reduction, whether made now or before
        notice.warn(text, getattr(notice, category, notice.Notice))
    return made


def _doubts(told: Any) -> list[tuple[str, str]]:
    """Names of classes of notices, and what each said; ValueError for anything else."""
    doubts = [(str(category), str(text)) for category, text in told]
    for category, _ in doubts:
        known = getattr(notice, category, Warning)  # one of another program's is a Notice here
        is_one = isinstance(known, type) and issubclass(known, Warning)
        require(is_one, "doubts", category, "no warning is called so")
    return doubts


def _laws(value: Any, depth: int = 4) -> Iterator[Any]:
    """Viscoelastic laws in the fields of a part, each with that of its volume, in their order."""
    if callable(getattr(value, "complex_modulus", None)):
        yield value
        if (volume := volume_of(value)) is not None:
            yield volume
    elif depth and is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            yield from _laws(getattr(value, field.name), depth - 1)
    elif depth and isinstance(value, Mapping):
        for item in value.values():
            yield from _laws(item, depth - 1)
    elif depth and isinstance(value, list | tuple):
        for item in value:
            yield from _laws(item, depth - 1)


def _packed(made: Superelement, laws: list[Any]) -> dict[str, Any] | None:
    """All arrays of a superelement by name, its words as JSON; None for a law that the part does not have."""
    known = [fingerprint(law) for law in laws]
    arrays: dict[str, Any] = {name: getattr(made, name) for name in MATRICES}
    words: dict[str, Any] = {
        "interfaces": {name: index.tolist() for name, index in made.interfaces.items()},
        "outputs": list(made.outputs),
        "surfaces": {name: surface.area for name, surface in made.surfaces.items()},
        "faces": {name: [asdict(face) for face in faces] for name, faces in made.faces.items()},
        "viscoelastic": [],
        "raceways": {},
        "skin": None,
    }
    for k, rows in enumerate(made.outputs.values()):
        arrays[f"output{k}"] = rows
    for k, term in enumerate(made.viscoelastic):
        told = fingerprint(term.material)
        if told not in known:
            return None
        words["viscoelastic"].append({"law": known.index(told), "volume": term.volume})
        arrays[f"H{k}"] = term.H
        if term.concentration is not None:
            arrays[f"concentration{k}"] = term.concentration
    for k, (name, race) in enumerate(made.raceways.items()):
        words["raceways"][name] = {
            "terms": race.series.terms, "arm": race.arm, "give": race.give, "Z": race.Z
        }  # fmt: skip
        arrays[f"race{k}"] = race.rows
    for k, surface in enumerate(made.surfaces.values()):
        arrays[f"W{k}"] = surface.W
    if (skin := made.skin) is not None:
        words["skin"] = {"f_max": skin.f_max, "surfaces": list(skin.surfaces)}
        arrays |= {"points": skin.points, "skin_faces": skin.faces, "skin_rows": skin.rows}
        arrays |= {f"skin_surface{k}": at for k, at in enumerate(skin.surfaces.values())}
    return {**arrays, "words": np.array(json.dumps(words))}


def _unpacked(held: Mapping[str, Any], laws: list[Any]) -> Superelement:
    """The superelement that `_packed` took apart, with the laws of its part."""
    words = json.loads(str(held["words"]))
    skin = None
    if (told := words["skin"]) is not None:
        surfaces = {name: held[f"skin_surface{k}"] for k, name in enumerate(told["surfaces"])}
        skin = Skin(held["points"], held["skin_faces"], held["skin_rows"], surfaces, told["f_max"])
    return Superelement(
        **{name: held[name] for name in MATRICES},
        interfaces={name: np.array(index, dtype=np.intp) for name, index in words["interfaces"].items()},
        outputs={name: held[f"output{k}"] for k, name in enumerate(words["outputs"])},
        viscoelastic=tuple(
            Viscoelastic(laws[term["law"]], held[f"H{k}"], term["volume"], held.get(f"concentration{k}"))
            for k, term in enumerate(words["viscoelastic"])
        ),
        raceways={
            name: Raceway(
                RacewaySeries(tuple(map(tuple, race["terms"]))),
                race["arm"], held[f"race{k}"], race["give"], race["Z"],
            )
            for k, (name, race) in enumerate(words["raceways"].items())
        },
        surfaces={
            name: Surface(area, held[f"W{k}"]) for k, (name, area) in enumerate(words["surfaces"].items())
        },
        faces={name: tuple(map(_face, faces)) for name, faces in words["faces"].items()},
        skin=skin,
    )  # fmt: skip


def _face(told: Mapping[str, Any]) -> RoundFace:
    """Pairs are lists in JSON."""
    values: dict[str, Any] = {name: tuple(v) if isinstance(v, list) else v for name, v in told.items()}
    return RoundFace(**values)
