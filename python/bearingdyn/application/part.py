"""What an application takes as a part."""

from __future__ import annotations

from typing import Protocol

from bearingdyn.cms import Superelement


class Part(Protocol):
    """What an application takes as a part: anything that becomes a superelement."""

    def superelement(self) -> Superelement:
        """The part's reduced matrices."""
