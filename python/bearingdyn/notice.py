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


class UnusualMagnitude(Notice):
    """An input is larger or smaller than machines have it; it was probably given in another unit.

    When: a number lies outside the usual range of its row in `bearingdyn.magnitude.MAGNITUDES`, where it is
    given or where what it is compared with becomes known.

    Remedy: give it in SI units; the text names the unit that was probably meant and the number in SI. A
    machine that is rightly so unusual needs nothing: the number is used as it is.
    """


class BearingWarning(Notice):
    """A bearing is asked for more than its parts bear, or than its model covers.

    When: a contact pressure exceeds 4.2 GPa (ISO 76), the static rating, in any analysis; or a shoulder cuts
    a contact ellipse.

    Remedy: check the load's unit; a larger bearing, less load, or a higher shoulder.
    """


class UnloadedBearing(Notice):
    """A linear analysis stands on a bearing that carries nothing, and so has no stiffness.

    When: modes, a response or a Campbell diagram start from an equilibrium in which no ball of a bearing is
    pressed.

    Remedy: load the bearing (weight by `app.gravity`, a belt, an axial preload by `offset`), or give it no
    clearance.
    """


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
