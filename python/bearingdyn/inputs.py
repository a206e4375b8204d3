"""What something was computed from, as plain data: a text to keep with the result, a hash to know it by.

Dataclasses become their class and fields, arrays their numbers or, where they are large, their digest.
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import inspect
import json
import math
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

# arrays of more numbers than this are told by their digest
WRITTEN_OUT = 64
# HDF5 keeps an attribute of up to 64 kB
LONGEST = 60_000


def describe(value: Any, *, strict: bool = True) -> Any:
    """A value as JSON's own types, the same for equal values in any process.

    Numbers, texts, dataclasses, arrays (sparse ones too), mappings, sequences, sets, functions by their
    names, and objects by their `told_as` where they have it, else by their attributes.

    Parameters
    ----------
    value
        Anything a result may be computed from.
    strict
        Refuse what has no content to tell it by.

    Raises
    ------
    ValueError
        For what has no content to tell it by, such as an open file. If not strict, its class stands for it.
    """

    def told(part: Any) -> Any:
        return describe(part, strict=strict)

    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else {"float": str(value)}
    if isinstance(value, complex):
        return {"complex": [told(value.real), told(value.imag)]}
    if isinstance(value, bytes | bytearray):
        return {"bytes": hashlib.sha256(value).hexdigest()}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return {str(key): told(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [told(item) for item in value]
    if isinstance(value, set | frozenset):
        return sorted((told(item) for item in value), key=lambda item: json.dumps(item, sort_keys=True))
    if isinstance(value, np.ndarray):
        return _array(value, told)
    if hasattr(value, "told_as") and not isinstance(value, type):
        return value.told_as
    return _object(value, told, strict)


def text(value: Any) -> str:
    """One line of JSON that describes a value, not strict; a hash replaces each long entry of a mapping."""
    described = describe(value, strict=False)
    written = json.dumps(described, sort_keys=True)
    if len(written) > LONGEST and isinstance(described, dict):
        share = LONGEST // (2 * len(described))
        for name, entry in described.items():
            if len(json.dumps(entry)) > share:
                described[name] = {"sha256": _digest(entry)}
        written = json.dumps(described, sort_keys=True)
    return written if len(written) <= LONGEST else json.dumps({"sha256": _digest(described)})


def fingerprint(value: Any) -> str:
    """Hash (32 hexadecimal digits) of a value's whole content."""
    return _digest(describe(value))


def _digest(described: Any) -> str:
    return hashlib.sha256(json.dumps(described, sort_keys=True).encode()).hexdigest()[:32]


def _array(value: np.ndarray, told: Callable[[Any], Any]) -> Any:
    if value.dtype.hasobject or value.size <= WRITTEN_OUT:
        return [told(item) for item in value.tolist()] if value.ndim else told(value.item())
    plain = np.ascontiguousarray(value)
    return {
        "shape": list(value.shape),
        "dtype": value.dtype.str,
        "sha256": hashlib.sha256(plain.tobytes()).hexdigest()[:32],
    }


def _object(value: Any, told: Callable[[Any], Any], strict: bool) -> Any:
    kind = type(value)
    name = f"{kind.__module__}.{kind.__qualname__}"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {f.name: told(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"class": name, **fields}
    if isinstance(value, functools.partial):
        return {"function": told(value.func), "given": told([value.args, value.keywords])}
    if inspect.ismethod(value):
        return {"method": value.__qualname__, "of": told(value.__self__)}
    if hasattr(value, "__qualname__"):
        return f"{value.__module__}.{value.__qualname__}"
    if hasattr(value, "tocoo"):
        coo = value.tocoo()
        return {"class": name, "shape": list(coo.shape), "row": told(coo.row), "col": told(coo.col),
                "data": told(coo.data)}  # fmt: skip
    if not getattr(value, "__dict__", None):
        if not strict:
            return {"class": name}
        raise ValueError(
            f"{value!r} cannot be told by its content; use numbers, texts, arrays, dataclasses or objects "
            f"with attributes"
        )
    return {"class": name, **{k: told(v) for k, v in vars(value).items()}}
