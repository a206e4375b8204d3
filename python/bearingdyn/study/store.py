"""A folder of finished cases, one JSON file each, named by the hash of what the case was computed from."""

from __future__ import annotations

import functools
import json
import logging
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bearingdyn import fingerprint
from bearingdyn.results import versions
from bearingdyn.study.cases import Case, Parameters
from bearingdyn.writing import write_whole

log = logging.getLogger(__name__)


def name_of(function: Callable[..., Any]) -> str:
    """Name under which the store keeps a study: module and name of its function, or a script's file."""
    inner = function.func if isinstance(function, functools.partial) else function
    named = inner if hasattr(inner, "__qualname__") else type(inner)
    module = str(getattr(named, "__module__", ""))
    if module in ("__main__", "__mp_main__"):
        module = Path(getattr(sys.modules["__main__"], "__file__", None) or "typed in").stem
    return f"{module}.{named.__qualname__}"


@dataclass(frozen=True)
class Store:
    """The store of finished cases, by hash of what the function is, the version and the parameters.

    Raises
    ------
    ValueError
        For a function that holds or uses what cannot be told by its content.
    """

    folder: Path
    function: Callable[..., Any]

    def __post_init__(self) -> None:
        name = name_of(self.function)
        try:
            self._of_function  # noqa: B018  # now: a callable may change as it is called
        except (ValueError, RecursionError) as error:
            raise ValueError(
                f"function {name} cannot be told by its content, and a store would mix up its results "
                f"({error}); pass what it needs as parameters of the cases, give the object that holds it an "
                f"attribute told_as, a text that says all its results depend on, or leave store out"
            ) from None
        self.folder.mkdir(parents=True, exist_ok=True)

    @functools.cached_property
    def _of_function(self) -> dict[str, Any]:
        return {
            "function": name_of(self.function),
            "told": fingerprint.fingerprint(self.function),
            "version": versions()["bearingdyn"],
        }

    def _key(self, parameters: Parameters) -> dict[str, Any]:
        return {**self._of_function, "parameters": fingerprint.describe(parameters)}

    def _path(self, parameters: Parameters) -> Path:
        return self.folder / f"{fingerprint.fingerprint(self._key(parameters))}.json"

    def read(self, parameters: Parameters) -> Case | None:
        """The finished case of these parameters; None where there is none."""
        path = self._path(parameters)
        try:
            kept = json.loads(path.read_text(encoding="utf-8"))
            key = json.loads(json.dumps(self._key(parameters)))
            if {name: kept.get(name) for name in key} != key:
                log.warning("%s holds another case than its name says; the case is computed again", path)
                return None
            values = {str(k): float(v) for k, v in kept["values"].items()}
            error = kept["error"]
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError):
            log.warning("%s holds no finished case; the case is computed again", path)
            return None
        return Case(parameters, values, error if error is None else str(error))

    def write(self, case: Case) -> None:
        """Keep a case; the file is there whole or not at all."""
        path = self._path(case.parameters)
        kept = {**self._key(case.parameters), "values": dict(case.values), "error": case.error}
        write_whole(path, json.dumps(kept, indent=1).encode())
