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


class OutsideIsotherms(Notice):
    """A shift law is used at a temperature at which nothing was measured.

    When: a material is moved to (`at`, `Application.temperature`), or a master curve referred to, a
    temperature outside the isotherms its law was found from.
    Remedy: measure there, or take the answer as an extrapolation of the law.
    """


class PoorLaw(Notice):
    """A shift law renders the shifts of the isotherms far worse than they are known.

    When: `master_curve` fits a law that misses the shifts by 0.3 decade rms, or by ten times their own
    standard errors, or that doubles the misfit of the moduli.
    Remedy: another law ("joined" through a glass transition, "free"), or fewer isotherms.
    """


class UnevenShifts(Notice):
    """The shifts of neighbouring isotherms zigzag, or rise with temperature, as no polymer's do.

    When: a step of `master_curve`'s shifts, per kelvin, is below half the smaller, or above twice the
    larger, of its neighbours by 0.15 decade or more, or has the other sign.
    Remedy: look at the isotherms named; leave one out, give its shift by hand, or measure again.
    """


class MixedRuns(Notice):
    """One curve is made of several runs (specimens), whose levels may differ by more than the fit's errors.

    When: `master_curve` gets points of several runs, as a column of the table names them, that nobody chose.
    Remedy: `dma.select(run="a")` for one run; `dma.select(run=["a", "b"])` says that they are meant together.
    """


class CutFile(Notice):
    """A file ends inside a character: it was cut off in copying, and its last line is left out.

    When: `read_dma` reads a UTF-16 text of an odd number of bytes.
    Remedy: export or copy the file again.
    """


def warn(text: str, category: type[Warning] = UserWarning) -> None:
    """Warn at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
