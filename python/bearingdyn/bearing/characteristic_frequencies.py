"""The characteristic frequencies of a bearing."""

from __future__ import annotations

from typing import NamedTuple


class Frequencies(NamedTuple):
    """Characteristic frequencies of a bearing, Hz (all ≥ 0)."""

    FTF: float
    """Fundamental train frequency: cage |ω_c|/2π."""
    BPFO: float
    """Ball-pass frequency of the outer race."""
    BPFI: float
    """Ball-pass frequency of the inner race."""
    BSF: float
    """Ball spin frequency |ω_b|/2π; a spot on a ball meets a race at twice this."""
