"""A folder of finished cases, one JSON file each, named by the hash of what the case was computed from."""

from __future__ import annotations

import dataclasses
import functools
import json
import logging
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bearingdyn import inputs
from bearingdyn.results import versions
from bearingdyn.study.cases import Case, Parameters
from bearingdyn.writing import write_whole

log = logging.getLogger(__name__)


def name_of(function: Callable[..., Any]) -> str:
    """Module and name of a function, or of a callable object's class; a script goes by its file."""
    inner = function.func if isinstance(function, functools.partial) else function
    named = inner if hasattr(inner, "__qualname__") else type(inner)
    module = str(getattr(named, "__module__", ""))
    if module in ("__main__", "__mp_main__"):
        module = Path(getattr(sys.modules["__main__"], "__file__", None) or "typed in").stem
    return f"{module}.{named.__qualname__}"


@dataclass(frozen=True)
class Store:
    """The cases of functions, by hash of the function's name and bound values, the version and parameters."""

    folder: Path
    function: Callable[..., Any]

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)

    def _key(self, parameters: Parameters) -> dict[str, Any]:
        f = self.function
        bound: Any = None
        if isinstance(f, functools.partial):
            bound = [f.args, f.keywords]
        elif dataclasses.is_dataclass(f):
            bound = f
        return {
            "function": name_of(f),
            **({} if bound is None else {"bound": inputs.describe(bound)}),
            "version": versions()["bearingdyn"],
            "parameters": inputs.describe(parameters),
        }

    def _path(self, parameters: Parameters) -> Path:
        return self.folder / f"{inputs.fingerprint(self._key(parameters))}.json"

    def read(self, parameters: Parameters) -> Case | None:
        """The finished case of these parameters; None where there is none."""
        path = self._path(parameters)
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
            values = {str(k): float(v) for k, v in kept["values"].items()}
            error = kept["error"]
        except FileNotFoundError:
            return None
        except (ValueError, KeyError, TypeError, AttributeError):
            log.warning("%s holds no finished case; the case is computed again", path)
            return None
        return Case(parameters, values, error if error is None else str(error))

    def write(self, case: Case) -> None:
        """Keep a case; the file is there whole or not at all."""
        path = self._path(case.parameters)
        kept = {**self._key(case.parameters), "values": dict(case.values), "error": case.error}
        write_whole(path, json.dumps(kept, indent=1).encode())
