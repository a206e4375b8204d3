"""What a result was made from, by which versions, and when."""

from __future__ import annotations

import hashlib
import platform
from datetime import UTC, datetime

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
    """Attributes that say what a result was computed from, its provenance, and its hash.

    Parameters
    ----------
    text
        Description by `inputs.text`; empty where it is not known: then there are no attributes.
    """
    if not text:
        return {}
    return {"inputs": text, "inputs_hash": hashlib.sha256(text.encode()).hexdigest()[:32]}
