"""Export as Universal File Format, dataset 58 (function at nodal degree of freedom), which test systems read.

Reference: "Universal File Datasets", Structural Dynamics Research Laboratory, University of Cincinnati.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bearingdyn.application import QUANTITIES, RATES, Channel
from bearingdyn.results.datasets import check_dataset
from bearingdyn.types import Array
from bearingdyn.writing import write_whole

if TYPE_CHECKING:
    import xarray


# specific data types of records 8 to 10
TIME, FREQUENCY, REACTION, FORCE, GENERAL = 17, 18, 9, 13, 1
MOTION = dict(zip(QUANTITIES, (8, 11, 12), strict=True))
AXES = {8: "response", 9: "force", 11: "response", 12: "response", 13: "force"}
TIME_RESPONSE, FREQUENCY_RESPONSE = 1, 4
REAL, COMPLEX = 4, 6  # double precision
WIDTH = 80
EVEN = 1e-3  # of its increment, by which a point of an evenly spaced abscissa may be off


@dataclass(frozen=True, eq=False)
class _Function:
    """One function: its kind, the channels it is between, and its ordinate (n,), real or complex.

    quantity and unit of the ordinate, and of what it is referred to.
    """

    kind: int
    response: str
    reference: str
    quantity: tuple[int, str]
    per: tuple[int, str]
    values: NDArray[np.generic]


def write_uff(data: xarray.Dataset, path: str | os.PathLike[str]) -> list[str]:
    """Write a Universal File: each function of a frequency response or transient as ASCII dataset 58, in SI.

    Ordinates keep twelve digits. The abscissa keeps six, as the format has it. An evenly spaced one is its
    first value and its increment, so six digits scale it by 5e-6 at most and no two points coincide; the
    increment stands with all its digits in the second text line. Another is written value by value. Places
    are numbered as nodes from 1 in the order they first appear; the names of response and reference stand in
    full in the first text line.

    Parameters
    ----------
    data
        Result of `bd.frequency_response` or `bd.transient`.
    path
        File to write.

    Returns
    -------
    list[str]
        The names of the places, node 1 first.

    Raises
    ------
    ValueError
        For a Dataset that is neither, has fewer than two points, or an abscissa that does not rise or whose
        points six digits do not tell apart.
    OSError
        Where the place cannot be written.
    """
    functions = list(_functions(data))
    dim = "time" if "record" in data else "frequency"
    abscissa = np.asarray(data[dim].values, dtype=np.float64)
    if abscissa.size < 2:
        raise ValueError(f"the result has {abscissa.size} points along {dim}; dataset 58 needs two or more")
    _check_abscissa(dim, abscissa)
    names = [name for f in functions for name in (f.response, f.reference) if name]
    nodes = list(dict.fromkeys(_node(name)[0] for name in names))
    lines = [line for f in functions for line in _dataset_58(f, dim, abscissa, nodes, data.attrs)]
    write_whole(path, ("\n".join(lines) + "\n").encode("ascii"))
    return nodes


def _even(abscissa: Array) -> float:
    """The increment of an evenly spaced abscissa; 0 for another."""
    n = abscissa.size
    step = (abscissa[-1] - abscissa[0]) / (n - 1)
    off = float(np.abs(abscissa - (abscissa[0] + step * np.arange(n))).max())
    return float(step) if off <= EVEN * step + 1e-14 * float(np.abs(abscissa).max()) else 0.0


def _check_abscissa(dim: str, abscissa: Array) -> None:
    if not (np.diff(abscissa) > 0).all():
        raise ValueError(f"{dim} does not rise from point to point; sort the result by it and drop doubles")
    if _even(abscissa):
        return
    kept = np.array([float(f"{value:.5e}") for value in abscissa])
    same = np.flatnonzero(np.diff(kept) <= 0)
    if same.size:
        at = abscissa[same[0]]
        raise ValueError(
            f"{dim} has points at {at!r} and {abscissa[same[0] + 1]!r}, which the six digits of dataset 58 "
            f"do not tell apart, and is not evenly spaced; interpolate the result to even spacing"
        )


def _functions(data: xarray.Dataset) -> Iterator[_Function]:
    check_dataset("data", data, [], "frequency_response or transient")
    if "response" in data and {"frequency", "output", "input"} <= set(data["response"].dims):
        H = data["response"].transpose("frequency", "output", "input")
        quantity = str(data.attrs.get("quantity"))
        for i, output in enumerate(H["output"].values.astype(str)):
            for j, given in enumerate(H["input"].values.astype(str)):
                force = Channel.parse(output).is_force
                of = _quantity(output, REACTION if force else MOTION.get(quantity, GENERAL), quantity)
                moved = Channel.parse(given).of_ground
                per = _quantity(given, MOTION.get(quantity, GENERAL) if moved else FORCE, quantity)
                yield _Function(FREQUENCY_RESPONSE, output, given, of, per, H.values[:, i, j])
    elif "record" in data and {"time", "channel"} <= set(data["record"].dims):
        record = data["record"].transpose("time", "channel")
        units = {"m": 8, "rad": 8, "m/s": 11, "rad/s": 11, "m/s²": 12, "rad/s²": 12, "N": FORCE}
        for i, channel in enumerate(record["channel"].values):
            unit = str(data["unit"].values[i])
            of = units.get(unit, GENERAL), unit
            yield _Function(TIME_RESPONSE, str(channel), "", of, (0, "NONE"), record.values[:, i])
    else:
        raise ValueError(
            f"the result holds {[str(name) for name in data.data_vars]}; dataset 58 takes a frequency "
            f"response (frequency, output, input) or a transient (time, channel); choose channels by lists, "
            f'as in .sel(output=["housing.top.y"])'
        )


def _quantity(channel: str, kind: int, quantity: str) -> tuple[int, str]:
    """Specific data type of a channel in a frequency response, and its unit."""
    named = Channel.parse(channel)
    if kind in (FORCE, REACTION):
        return kind, named.force_unit
    return kind, named.motion_unit(quantity if quantity in RATES else "displacement")


def _node(channel: str) -> tuple[str, int]:
    """Node and direction of a channel: "shaft.end.y.velocity" is 2 at "shaft.end"; 0 where it has none."""
    named = Channel.parse(channel)
    return (channel, 0) if named.index is None else (named.site, named.index + 1)


def _ascii(text: str, width: int) -> str:
    """Text as the format's own letters, θx being rx, in a field."""
    plain = text.replace("θ", "r").replace("²", "2").encode("ascii", "replace").decode()
    return f"{plain:<{width}.{width}}"


def _dataset_58(
    f: _Function, dim: str, abscissa: Array, nodes: list[str], attrs: dict[str, object]
) -> Iterator[str]:
    n = abscissa.size
    step = _even(abscissa)
    even = step > 0
    is_complex = np.iscomplexobj(f.values)

    yield f"{-1:6d}"
    yield f"{58:6d}"
    yield _ascii(f"{f.response} / {f.reference}" if f.reference else f.response, WIDTH)
    spacing = f", {dim} from {float(abscissa[0])!r} by {step!r}" if even else ""
    yield _ascii(f"{attrs.get('analysis', 'NONE')}, zero-to-peak, SI units{spacing}", WIDTH)
    yield _ascii(str(attrs.get("made_at", "NONE")), WIDTH)
    yield _ascii(str(attrs.get("made_by", "NONE")), WIDTH)
    yield _ascii(f"inputs {attrs.get('inputs_hash', 'not known')}", WIDTH)

    def end(channel: str) -> str:
        place, direction = _node(channel) if channel else ("NONE", 0)
        node = nodes.index(place) + 1 if channel else 0
        return f"{_ascii(place, 10)}{node:10d}{direction:4d}"

    yield f"{f.kind:5d}{0:10d}{0:5d}{0:10d} {end(f.response)} {end(f.reference)}"
    start = (float(abscissa[0]), step) if even else (0.0, 0.0)
    kind = COMPLEX if is_complex else REAL
    yield f"{kind:10d}{n:10d}{int(even):10d}{start[0]:13.5e}{start[1]:13.5e}{0.0:13.5e}"

    def axis(kind: int, label: str, unit: str) -> str:
        return f"{kind:10d}{0:5d}{0:5d}{0:5d} {_ascii(label, 20)} {_ascii(unit, 20)}"

    yield axis(TIME if dim == "time" else FREQUENCY, dim, "s" if dim == "time" else "Hz")
    for quantity, unit in (f.quantity, f.per):
        yield axis(quantity, AXES.get(quantity, "response" if quantity else "NONE"), unit or "NONE")
    yield axis(0, "NONE", "NONE")

    columns = [np.real(f.values), np.imag(f.values)] if is_complex else [f.values]
    if even:
        flat, form, across = np.stack(columns, axis=1).ravel(), ["{:20.11e}"], 4
    else:
        flat = np.stack([abscissa, *columns], axis=1).ravel()
        form = ["{:13.5e}"] + ["{:20.11e}"] * len(columns)
        across = 3 if is_complex else 4
    written = [form[k % len(form)].format(value) for k, value in enumerate(flat)]
    for k in range(0, len(written), across):
        yield "".join(written[k : k + across])
    yield f"{-1:6d}"
