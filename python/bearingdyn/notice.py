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


class CoarseStep(Notice):
    """The time step does not follow something that drives the march.

    When: a wave of a bearing, the passage of its balls, a pit, an unbalance, a harmonic or a sampled load has
    fewer than twenty steps a period, at the highest speed of the profile.

    Remedy: march with the dt that the warning names, or leave out what is that fast; `check_step=True` says
    how far off the record is.
    """


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
