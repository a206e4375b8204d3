"""Whether the memory can hold what a march is to record."""

from __future__ import annotations

import os
from collections.abc import Sequence


def check_room(samples: int, record: Sequence[str]) -> None:
    """ValueError if the record of a march takes more than half the memory of the machine, where it is known.

    Twice its size is needed at the end, when its pieces are put together.

    Parameters
    ----------
    samples
        Kept of each channel.
    record
        The channels.
    """
    need, have = 8 * samples * len(record), memory()
    if have is not None and need > have / 2:
        raise ValueError(
            f"the record would take {_written(need)}: {samples:.3g} samples of {len(record)} channels at 8 "
            f"bytes; it must fit into half the {_written(have)} of this machine: decimate keeps every "
            "so-many steps, or march in parts, one with resume= of the other, each with a stream= of its own"
        )


def memory() -> int | None:
    """The memory of the machine, bytes; None where the system does not say."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return None


def _written(size: float) -> str:
    return f"{size / 1e9:.3g} GB"
