"""What a result was made from, by which versions, and when."""

from __future__ import annotations

import hashlib
import json
import platform
from datetime import UTC, datetime
from typing import Any

import numpy as np
import scipy

from bearingdyn.fingerprint import VERSION


def versions() -> dict[str, str]:
    """Provenance: versions of the package and of what it computes with; "not installed" for none."""
    return {
        "bearingdyn": VERSION,
        "Python": platform.python_version(),
        "NumPy": np.__version__,
        "SciPy": scipy.__version__,
    }


def stamp(time: datetime | None = None) -> str:
    """Provenance: when a result was made, in UTC as ISO 8601 writes it.

    Parameters
    ----------
    time
        None: now.
    """
    return (time or datetime.now(UTC)).astimezone(UTC).isoformat(timespec="seconds")


def inputs_of(text: str) -> dict[str, str]:
    """Attributes that say what a result was computed from, its provenance: in words, as JSON, and its hash.

    Parameters
    ----------
    text
        Description by `inputs.text`; empty where it is not known: then there are no attributes.
    """
    if not text:
        return {}
    words = in_words(text)
    return {
        **({"made_from": words} if words else {}),
        "inputs": text,
        "inputs_hash": hashlib.sha256(text.encode()).hexdigest()[:32],
    }


def in_words(text: str) -> str:
    """Inputs of a result in words, by its provenance: parts and their kinds, bearings, fits, loads."""
    try:
        held = json.loads(text)
    except ValueError:  # of a file of another hand
        return ""

    def entries(word: str) -> Any:
        # what is too long to be kept is there by its hash
        found: Any = held.get(word) if isinstance(held, dict) else None
        return found if isinstance(found, dict | list) and "sha256" not in found else {}

    told = []
    if sources := entries("sources"):
        kinds = {k: one.get("class", "") for k, one in dict(sources).items() if isinstance(one, dict)}
        told.append("parts " + ", ".join(f"{k} ({kind.rpartition('.')[2]})" for k, kind in kinds.items()))
    told += [f"{word} {', '.join(names)}" for word in ("bearings", "fits") if (names := entries(word))]
    places = [str(one.get("where")) for one in entries("loads") if isinstance(one, dict)]
    if places:
        told.append(f"loads at {', '.join(dict.fromkeys(places))}")
    return "; ".join(told)
