"""Places of parts by name: "shaft.left"."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, order=True)
class Place:
    """A place, "shaft.left": an interface, point, raceway or surface of a part, by name.

    `str` gives back the name that `parse` was given. The ground is one place without a name of its own.

    Parameters
    ----------
    part
        Name of the part, without dots.
    name
        Name of the place within the part.

    Examples
    --------
    >>> from bearingdyn.application import Place
    >>> place = Place.parse("shaft.left")
    >>> place.part, place.name, str(place)
    ('shaft', 'left', 'shaft.left')
    """

    part: str
    name: str

    def __str__(self) -> str:
        """The name as it is written, "part.name"."""
        return f"{self.part}.{self.name}" if self.name else self.part

    @property
    def told_as(self) -> str:
        """What stands for it where results keep what they were made from."""
        return str(self)

    @classmethod
    def parse(cls, text: str | Place) -> Place:
        """The place that a text names: up to its first dot the part, after it the place.

        Raises
        ------
        ValueError
            If the text has no dot, or nothing before or after it, or is not a text.
        """
        if isinstance(text, Place):
            return text
        part, _, name = text.partition(".") if isinstance(text, str) else ("", "", "")
        if not (part and name):
            raise ValueError(
                f'{text!r} names no place; it must be "part.place", the name of a part and of one of its '
                f'interfaces or points, such as "shaft.left"'
            )
        return cls(part, name)


# where the weight of every part acts
GRAVITY = Place("gravity", "")
