"""One file for each result, or for several by name: netCDF-4, and run files as far as they go."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn import run_file
from bearingdyn.checks import existing, instance, meant
from bearingdyn.results.file_seal import check_seal, seal
from bearingdyn.results.global_heaps import check_global_heaps
from bearingdyn.results.march_record import march_dataset
from bearingdyn.results.provenance import stamp
from bearingdyn.writing import check_target, write_whole

if TYPE_CHECKING:
    import xarray


# netCDF has no complex type: a trailing axis of two of this name holds real and imaginary part
PARTS = "part"
# its name where results have parts of a machine
PARTS_BESIDE = "real_imaginary"
_REMEDY = "give a file that bd.save or the stream of a march wrote, or compute it again"


def save(results: xarray.Dataset | Mapping[str, xarray.Dataset], path: str | os.PathLike[str]) -> None:
    """Save a Dataset, or several by name (as groups), to one result file (netCDF-4).

    The file is made in memory, written under another name beside its place, and moved there when it is on the
    disk: whatever fails, the file that was there before is intact. This takes as much memory again as the
    results do.

    Behind the content stands its SHA-256, which `open_result` compares: a file damaged since is refused, not
    read. Other programs can open the file: a complex number is stored along a last axis of two, real and
    imaginary.

    Parameters
    ----------
    results
        One Dataset, or several by name.
    path
        File to write; one that is there is replaced.

    Raises
    ------
    ValueError
        If there is nothing to save, or something other than a Dataset.
    OSError
        Where the place cannot be written: its folder is missing, the disk is full, or it is not a file but a
        folder, a device or a pipe. It names the file.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> found = bd.modes(app)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     bd.save(found, Path(folder) / "modes.nc")
    ...     again = bd.open_result(Path(folder) / "modes.nc")
    >>> again.equals(found)
    True
    """
    groups = dict(results) if isinstance(results, Mapping) and not hasattr(results, "dims") else {"": results}
    if not groups:
        raise ValueError(f"{path}: nothing to save; give at least one result")
    for name, data in groups.items():
        what = f"results[{name!r}]" if name else "results"
        if not hasattr(data, "to_netcdf") or not hasattr(data, "data_vars"):
            raise ValueError(f"{what} is {data!r}; it must be a Dataset, as every analysis returns it")
        if name and not all(name.split("/")):
            raise ValueError(
                f"results has the name {name!r}; each part of a name must be a text, as in 'response/mass'"
            )
        _check_attributes(what, data)
    check_target(path)
    # in memory: HDF5 itself does not survive a disk that fills up under it
    made = io.BytesIO()
    for i, (name, data) in enumerate(groups.items()):
        _plain(data).to_netcdf(made, mode="w" if i == 0 else "a", group=name or None, engine="h5netcdf")
    made.seek(0, io.SEEK_END)
    made.write(seal(made.getvalue()))
    write_whole(path, made.getbuffer())


def open_result(path: str | os.PathLike[str], group: str = "") -> xarray.Dataset:
    """Open a result file written by `save`, or what a run file holds so far, wholly into memory.

    Parameters
    ----------
    path
        File by `save`, or by the `stream` of a march.
    group
        Name of the result in a file of several.

    Returns
    -------
    xarray.Dataset
        Its variables carry units; complex numbers are complex again.

    Raises
    ------
    ValueError
        If the file is no netCDF-4 file, lacks the group, or is not as it was saved.
    FileNotFoundError
        If there is no such file.
    """
    import h5netcdf  # noqa: F401  # so that its absence is not taken for a damaged file
    import xarray

    existing(path, "result")
    instance("group", group, str, "it must be the name of a result in the file")
    if run_file.is_run(path):
        return _run_dataset(path)
    _check_content(path)
    try:
        with xarray.open_dataset(path, group=group or None, engine="h5netcdf", phony_dims="access") as data:
            found = _complex(data.load())
    except Exception as error:  # the layers under it raise whatever the damage of a file leads to
        known = groups(path) if group else []
        if group and group not in known:
            hint = meant(group, known) if known else "it is one result: leave group out"
            raise ValueError(f"{os.fspath(path)} has no result {group!r}; {hint}") from None
        place = f"group {group!r} of " if group else ""
        raise ValueError(f"{place}{os.fspath(path)} cannot be read as a result: {error}; {_REMEDY}") from None
    if not group and not found.variables and groups(path):
        raise ValueError(f"{os.fspath(path)} holds several results; name one of them: {groups(path)}")
    return found


def groups(path: str | os.PathLike[str]) -> list[str]:
    """Names of the groups in a result file.

    Parameters
    ----------
    path
        File by `save`.

    Returns
    -------
    list[str]
        Sorted, those within others as "outer/inner"; empty for a file of one result, and for a run file.

    Raises
    ------
    ValueError
        If it cannot be read.
    """
    import h5netcdf

    existing(path, "result")
    if run_file.is_run(path):
        return []
    _check_content(path)
    try:
        with h5netcdf.File(path, "r") as file:
            return sorted(_holding(file, ""))
    except Exception as error:  # as in open_result
        raise ValueError(f"{os.fspath(path)} cannot be read as a result: {error}; {_REMEDY}") from None


def _check_content(path: str | os.PathLike[str]) -> None:
    """Check what the layers above HDF5 would read: the file is as saved, opens, and its texts fit into it."""
    import h5py

    check_seal(path)
    check_global_heaps(path)
    size = os.stat(path).st_size
    try:
        # h5netcdf prints a traceback when it forgets a file that it could not open
        with h5py.File(path, "r") as file:
            file.visititems(lambda name, item: _check_texts(name, item, size))
    except Exception as error:  # as in open_result
        raise ValueError(f"{os.fspath(path)} cannot be read as a result: {error}; {_REMEDY}") from None


def _check_texts(name: str, item: Any, size: int) -> None:
    """Check that texts, each a length and a place in the file, are no longer than the file.

    HDF5 takes and fills the memory before it looks: one wrong byte costs gigabytes and ten seconds.
    """
    import h5py

    place = item.id.get_offset() if isinstance(item, h5py.Dataset) and item.dtype.kind == "O" else None
    if place is None:
        return
    with open(item.file.filename, "rb") as file:
        file.seek(place)
        told = np.frombuffer(file.read(16 * item.size), np.uint8)
    lengths = told[: told.size // 16 * 16].reshape(-1, 16)[:, :4].copy().view("<u4")
    if lengths.sum(dtype=np.uint64) > size:
        raise ValueError(f"{name} holds texts longer than the file; it is damaged")


def _holding(group: Any, above: str) -> Iterator[str]:
    """Names of the groups below one that hold a result, those within others by "outer/inner"."""
    for name, inner in group.groups.items():
        if inner.variables or not inner.groups:
            yield above + name
        yield from _holding(inner, f"{above}{name}/")


def _run_dataset(path: str | os.PathLike[str]) -> xarray.Dataset:
    """What a run file holds so far."""
    facts, chunks, _ = run_file.read(path)
    if not chunks:
        raise ValueError(f"{os.fspath(path)} holds no finished chunk yet")
    state = chunks[-1].state
    rows = np.concatenate([c.rows for c in chunks])
    written = datetime.fromtimestamp(Path(path).stat().st_mtime, UTC)
    return march_dataset(facts, rows, state, run_file.report_of(chunks), {"made_at": stamp(written)})


def _check_attributes(what: str, data: Any) -> None:
    """Check that a file can keep every attribute of a result, and of its variables."""
    for place, held in (("", data), *((f"[{str(v)!r}]", data[v]) for v in data.variables)):
        for key, value in held.attrs.items():
            if not isinstance(value, str | bytes | Real | np.ndarray | np.generic | list | tuple):
                raise ValueError(
                    f"{what}{place}.attrs[{key!r}] is {value!r}; a file keeps texts, numbers and arrays of "
                    f"them: drop it, or write it as a text"
                )


def _plain(data: Any) -> Any:
    """Complex variables as a trailing axis of two."""
    import xarray

    plain = data.copy()
    for name, variable in data.data_vars.items():
        if np.iscomplexobj(variable.values):
            values = np.stack([variable.values.real, variable.values.imag], axis=-1)
            dims = (*variable.dims, PARTS_BESIDE if PARTS in data.dims else PARTS)
            plain[name] = xarray.Variable(dims, values, {**variable.attrs, "complex": 1})
    return plain


def _complex(data: xarray.Dataset) -> xarray.Dataset:
    import xarray

    for name, variable in data.data_vars.items():
        if variable.attrs.get("complex") == 1 and variable.dims[-1] in (PARTS, PARTS_BESIDE):
            attrs = {k: v for k, v in variable.attrs.items() if k != "complex"}
            # by parts: re + 1j·im makes NaN of an infinite part
            values = np.empty(variable.shape[:-1], dtype=np.complex128)
            values.real, values.imag = variable.values[..., 0], variable.values[..., 1]
            data = data.assign({str(name): xarray.Variable(variable.dims[:-1], values, attrs)})
    return data
