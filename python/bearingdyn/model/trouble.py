"""What is wrong with a model file, and where: file, line and key."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from bearingdyn.model.key_lines import Key


@dataclass
class Origin:
    """Where trouble in a model is told: file and line of each of its keys."""

    file: str
    known: dict[Key, tuple[str, int]] = field(default_factory=dict)

    def told(self, key: Key) -> str:
        """File, line and key, of the nearest key above that stands in a file."""
        for k in range(len(key), 0, -1):
            if key[:k] in self.known:
                file, line = self.known[key[:k]]
                return f"{file}, line {line}, {dotted(key)}"
        return f"{self.file}{', ' + dotted(key) if key else ''}"


def dotted(key: Key) -> str:
    """A model file's key as trouble names it: parts.layer.r_inner, loads[2].vector."""
    text = ""
    for part in key:
        text += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if text else part
    return text


@contextmanager
def at(origin: Origin, key: Key, fields: Mapping[str, Any] = MappingProxyType({})) -> Iterator[None]:
    """Trouble within is told with the model's file, line and key.

    Parameters
    ----------
    origin
        Where keys stand.
    key
        Of the table that is being read.
    fields
        Its fields and their values: where a message names one, its line is told.
    """
    try:
        yield
    except Located:
        raise
    except (ValueError, TypeError, ArithmeticError, OSError, AttributeError, LookupError) as error:
        text = str(error) or type(error).__name__
        named = [(text.find(repr(v)), k) for k, v in fields.items() if isinstance(v, str) and repr(v) in text]
        named = named or [
            (m.start(), name) for name in fields if (m := re.search(rf"\b{re.escape(name)}\b", text))
        ]
        place = (*key, min(named)[1]) if named else key
        raise Located(f"{origin.told(place)}: {text}") from error


class Located(ValueError):
    """Trouble with a model, told with file, line and key."""
