"""Every class of warning, and `warn`, which points at the user's line from however deep inside."""

from __future__ import annotations

import sys
import warnings

_OWN = __name__.partition(".")[0]


class Notice(UserWarning):
    """A number rests on something that the program doubts; the base of all warnings of this package.

    Every class below says in its docstring what it doubts, and in the paragraphs "When:" and "Remedy:" when
    it is raised and what helps. The documentation's table is made from them.
    """


class BeyondData(Notice):
    """A static answer rests on a modulus at longer times than the rubber's data speak of.

    When: `equilibrium`, a response at 0 Hz or a stiffness at rest takes the modulus of a layer relaxed, or
    `after` a time more than twice the longest that its fit reaches, and the data show no plateau there.
    Remedy: ask for the state `after` a time that the data reach; fit from a lower frequency; pin the low end
    (`fit_maxwell(pin=...)`); measure longer, or warmer.
    """


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
