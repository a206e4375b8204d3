"""What something was computed from, as plain data: a text to keep with the result, a hash to know it by.

Dataclasses become their class and fields, arrays their numbers or, where they are large, their digest, and
functions their name, code, and all that code takes from around it.
"""

from __future__ import annotations

import dataclasses
import dis
import functools
import hashlib
import inspect
import json
import logging
import math
import os
import sys
import sysconfig
import types
import weakref
from collections.abc import Callable, Mapping
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np


def _own_version() -> str:
    try:
        return version("bearingdyn")
    except PackageNotFoundError:
        return "not installed"


# found once: it takes milliseconds where many packages are installed
VERSION = _own_version()
# arrays of more numbers than this are told by their digest
WRITTEN_OUT = 64
# digests of large arrays that nobody may write into, by their id: the same parts stand in many applications
_digests: dict[int, tuple[weakref.ref[Any], str]] = {}
# methods that write into a dict, a list or a set
_WRITERS = ("setdefault", "append", "add")
# HDF5 keeps an attribute of up to 64 kB
LONGEST = 60_000


def describe(
    value: Any,
    *,
    strict: bool = True,
    within: tuple[Any, ...] = (),
    forgetful: bool = False,
    known: dict[int, tuple[Any, Any]] | None = None,
) -> Any:
    """A value as JSON's own types, from which its fingerprint is taken: the same for equal values anywhere.

    Numbers, texts, dataclasses, arrays (sparse ones too), mappings, sequences, sets, functions, and objects
    by their `told_as` where they have it, else by their attributes.

    A function is told by its name, its byte code, defaults, enclosed variables, and the global names it uses:
    values by their content, functions and classes of the user's own modules by their code in turn, what is
    installed, and modules, by their names.

    Parameters
    ----------
    value
        Anything a result may be computed from.
    strict
        Refuse a value that has no content to tell it by.
    within
        What the value is a part of: one that holds itself is told by its name there.
    forgetful
        Tell global dicts, lists and sets into which functions write themselves, as a memory of what they have
        computed, as empty: as they stand before the first call.
    known
        Of dataclasses already described, by their id, themselves and what they are: a part that stands in two
        places of a machine is then described once. None: each where it stands.

    Raises
    ------
    ValueError
        For a value that has no content to tell it by, such as an open file. If not strict, its
        class stands for it.
    """

    def told(part: Any) -> Any:
        return describe(part, strict=strict, within=(*within, value), forgetful=forgetful, known=known)

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
    if any(value is whole for whole in within):
        return {"again": getattr(value, "__qualname__", type(value).__qualname__)}
    if isinstance(value, types.FunctionType):
        return _function(value, told, forgetful)
    if isinstance(value, type) and not _installed(value.__module__):
        return _class(value, told)
    if known is None or not dataclasses.is_dataclass(value):
        return _object(value, told, strict)
    if id(value) not in known:
        known[id(value)] = value, _object(value, told, strict)
    return known[id(value)][1]


def text(value: Any) -> str:
    """What a fingerprint is taken from, as one line of JSON, not strict; long entries as their hashes."""
    described = describe(value, strict=False, known={})
    written = json.dumps(described, sort_keys=True)
    if len(written) > LONGEST and isinstance(described, dict):
        share = LONGEST // (2 * len(described))
        for name, entry in described.items():
            if len(json.dumps(entry)) > share:
                described[name] = {"sha256": _digest(entry)}
        written = json.dumps(described, sort_keys=True)
    return written if len(written) <= LONGEST else json.dumps({"sha256": _digest(described)})


def fingerprint(value: Any) -> str:
    """Fingerprint (32 hexadecimal digits) of a value's whole content."""
    return _digest(describe(value))


def loose(value: Any, *, forgetful: bool = False) -> str:
    """Fingerprint that refuses nothing: what cannot be told by its content is told by its class."""
    return _digest(describe(value, strict=False, forgetful=forgetful))


def _digest(described: Any) -> str:
    return hashlib.sha256(json.dumps(described, sort_keys=True).encode()).hexdigest()[:32]


def _array(value: np.ndarray, told: Callable[[Any], Any]) -> Any:
    if value.dtype.hasobject or value.size <= WRITTEN_OUT:
        return [told(item) for item in value.tolist()] if value.ndim else told(value.item())
    frozen = value.base is None and not value.flags.writeable
    known = _digests.get(id(value)) if frozen else None
    if known is None or known[0]() is not value:
        plain = np.ascontiguousarray(value)
        known = weakref.ref(value), hashlib.sha256(plain.tobytes()).hexdigest()[:32]
        if frozen:
            _digests[id(value)] = known
            weakref.finalize(value, _digests.pop, id(value), None).atexit = False
    return {"shape": list(value.shape), "dtype": value.dtype.str, "sha256": known[1]}


def _object(value: Any, told: Callable[[Any], Any], strict: bool) -> Any:
    kind = type(value)
    name = f"{_module(kind)}.{kind.__qualname__}"
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {f.name: told(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"class": name, **fields, **_own_code(kind, told)}
    if isinstance(value, functools.partial):
        return {"function": told(value.func), "given": told([value.args, value.keywords])}
    if inspect.ismethod(value):
        return {"method": told(value.__func__), "of": told(value.__self__)}
    if isinstance(value, functools._lru_cache_wrapper | staticmethod | classmethod):
        return {"wrapper": name, "of": told(value.__wrapped__)}
    if isinstance(value, property):
        return {"property": told([value.fget, value.fset])}
    if isinstance(value, types.ModuleType | logging.Logger):
        return {"class": name, "name": value.__name__ if isinstance(value, types.ModuleType) else value.name}
    if hasattr(value, "__qualname__"):
        return f"{_module(value)}.{value.__qualname__}"
    if hasattr(value, "tocoo"):
        coo = value.tocoo()
        return {"class": name, "shape": list(coo.shape), "row": told(coo.row), "col": told(coo.col),
                "data": told(coo.data)}  # fmt: skip
    held = {**getattr(value, "__dict__", {})}
    for slot in (slot for base in kind.__mro__ for slot in _slots(base)):
        if hasattr(value, slot):
            held[slot] = getattr(value, slot)
    if not held and _installed(kind.__module__):
        if not strict:
            return {"class": name}
        raise ValueError(
            f"{value!r} cannot be told by its content; use numbers, texts, arrays, dataclasses or objects "
            f"with attributes"
        )
    return {"class": name, **{k: told(v) for k, v in held.items()}, **_own_code(kind, told)}


def _own_code(kind: type, told: Callable[[Any], Any]) -> dict[str, Any]:
    return {} if _installed(kind.__module__) else {"code": told(kind)}


def _slots(kind: type) -> tuple[str, ...]:
    slots = vars(kind).get("__slots__", ())
    return (
        (slots,)
        if isinstance(slots, str)
        else tuple(s for s in slots if s not in ("__dict__", "__weakref__"))
    )


@functools.lru_cache(maxsize=1000)
def _installed(module: str) -> bool:
    """Whether a module came with Python or a package, whose version stands for its code."""
    file = getattr(sys.modules.get(module), "__file__", None)
    if module.partition(".")[0] == __name__.partition(".")[0]:
        return True
    if file is None:
        return module not in ("__main__", "__mp_main__")
    places = {os.path.realpath(sysconfig.get_path(key)) for key in ("stdlib", "purelib", "platlib")}
    return any(os.path.realpath(file).startswith(place + os.sep) for place in places)


def _module(value: Any) -> str:
    """Module of a function or class; a script has one name, which a process spawned by it calls otherwise."""
    name = str(value.__module__)
    return "__main__" if name == "__mp_main__" else name


def _function(value: types.FunctionType, told: Callable[[Any], Any], forgetful: bool) -> Any:
    name = f"{_module(value)}.{value.__qualname__}"
    if _installed(value.__module__) and value.__closure__ is None and "<lambda>" not in name:
        return name
    cells = value.__closure__ or ()
    held = {
        used: value.__globals__[used] for used in sorted(_globals_of(value.__code__) & {*value.__globals__})
    }
    if forgetful:
        memories = _memories_of(value.__code__)
        held |= {k: type(v)() for k, v in held.items() if k in memories and type(v) in (dict, list, set)}
    around = {used: _told_of(f"{name} uses the global {used!r}", part, told) for used, part in held.items()}
    enclosed = {
        used: _told_of(f"{name} uses {used!r} from around it", cell.cell_contents, told)
        for used, cell in zip(value.__code__.co_freevars, cells, strict=True)
        if _filled(cell)
    }
    return {
        "function": name,
        "code": _digest(_code(value.__code__, told)),
        "defaults": told([value.__defaults__, value.__kwdefaults__]),
        "enclosed": enclosed,
        "globals": around,
    }


def _told_of(what: str, value: Any, told: Callable[[Any], Any]) -> Any:
    try:
        return told(value)
    except ValueError as error:
        raise ValueError(f"{what}: {error}") from None


def _filled(cell: types.CellType) -> bool:
    try:
        return cell.cell_contents is not cell
    except ValueError:
        return False


def _class(value: type, told: Callable[[Any], Any]) -> Any:
    """Its code: functions and plain attributes of it and of its bases."""
    own = {
        key: told(part)
        for key, part in vars(value).items()
        if isinstance(part, types.FunctionType | staticmethod | classmethod | property | int | float | str)
        and key not in ("__module__", "__doc__", "__qualname__", "__firstlineno__")
    }
    bases = [told(base) for base in value.__bases__ if base is not object]
    return {"class": f"{_module(value)}.{value.__qualname__}", "own": _digest(own), "bases": bases}


def _code(code: types.CodeType, told: Callable[[Any], Any]) -> Any:
    constants = [
        _code(c, told) if isinstance(c, types.CodeType) else repr(c) if c is ... else told(c)
        for c in code.co_consts
    ]
    return [code.co_code.hex(), constants, list(code.co_names), list(code.co_freevars)]


def _globals_of(code: types.CodeType) -> set[str]:
    """Names a function and those within it take from its module."""
    found = {
        str(instruction.argval)
        for instruction in dis.get_instructions(code)
        if instruction.opname in ("LOAD_GLOBAL", "LOAD_NAME")
    }
    return found.union(*(_globals_of(c) for c in code.co_consts if isinstance(c, types.CodeType)))


def _memories_of(code: types.CodeType) -> set[str]:
    """Names of globals that a function, or one within it, writes items into."""
    steps = list(dis.get_instructions(code))
    found = set[str]()
    for i, step in enumerate(steps):
        if step.opname == "LOAD_GLOBAL" and i + 1 < len(steps) and steps[i + 1].argval in _WRITERS:
            found.add(str(step.argval))
        elif step.opname == "STORE_SUBSCR":  # of value, container, key on the stack
            above, k = 1, i
            while above > 0 and k > 0:
                k -= 1
                above -= dis.stack_effect(steps[k].opcode, steps[k].arg, jump=False)
            if k > 0 and steps[k - 1].opname == "LOAD_GLOBAL":
                found.add(str(steps[k - 1].argval))
    return found.union(*(_memories_of(c) for c in code.co_consts if isinstance(c, types.CodeType)))
