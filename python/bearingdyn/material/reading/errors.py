"""Errors of reading, by class: a caller tells them apart without looking at their text."""

from __future__ import annotations

from collections.abc import Sequence


class ReadingError(ValueError):
    """An error of reading: a table cannot be read as it stands.

    Attributes
    ----------
    arguments
        Arguments of :func:`read_dma` that the message offers as a remedy, such as "units" or "columns".
    """

    def __init__(self, message: str, *arguments: str) -> None:
        super().__init__(message)
        self.arguments = arguments


class HeaderError(ReadingError):
    """An error of reading: no header names the columns needed; another sheet may hold the table."""


class NoStepError(HeaderError):
    """An error of reading: no step of a source is the one that is wanted; another sheet may have it."""


def together(where: str, faults: Sequence[ReadingError]) -> ReadingError:
    """All errors of reading at one place as one error, which says the place once."""
    texts = [str(fault) for fault in faults]
    message = "; ".join([texts[0], *(text.removeprefix(f"{where}, ") for text in texts[1:])])
    kind = HeaderError if any(isinstance(fault, HeaderError) for fault in faults) else ReadingError
    return kind(message, *dict.fromkeys(a for fault in faults for a in fault.arguments))
