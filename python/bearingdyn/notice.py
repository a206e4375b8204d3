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


class OutsideBand(Notice):
    """A material model is used at a frequency it was not fitted at.

    When: a Maxwell model that knows its band is asked for its modulus outside it, in a response, in damped
    modes or by `complex_modulus`; or `fit_maxwell` is given a band that reaches beyond the master curve.

    Remedy: fit a band that covers the frequencies asked for, with data that reach there; or take the answer
    as an extrapolation.
    """


class AssumedMeaning(Notice):
    """A file does not say what a number means, and the usual is taken.

    When: `read_dma` finds no unit for a frequency or a temperature, an angular frequency in a unit of
    frequency, or moduli of which only the words around them tell shear from tension.

    Remedy: say it: `units={...}`, `mode=...`; the text names the argument.
    """


class LeftOut(Notice):
    """Something of a measurement is not used.

    When: `read_dma` leaves out rows that are not valid or stand behind the table; `master_curve` leaves out
    points that no passive material could give, such as a resonance of the fixture.

    Remedy: look at the rows or points named; `clean=False` keeps what is positive, `dma.select` leaves out
    more.
    """


class UnlikelyModulus(Notice):
    """A measured modulus is far from what gels, elastomers and polymers have; its unit is likely wrong.

    When: the median of the storage moduli that `read_dma` read lies outside 100 Pa to 20 GPa, or no storage
    modulus is as large as a rubber's.

    Remedy: give the unit of the columns: `units={"storage": "MPa", "loss": "MPa"}`.
    """


class ThinIsotherm(Notice):
    """A shift rests on a single point.

    When: `master_curve` meets an isotherm with one frequency only.

    Remedy: leave that temperature out by `dma.select`, or measure a sweep there.
    """


class CoarseModel(Notice):
    """No number of branches tried renders the measurement within the tolerance.

    When: `fit_maxwell(n="auto")` has tried all it may.

    Remedy: a narrower band, a larger `tolerance`, or better data: a causal spectrum as dense as it may be
    leaves the floor that the text names.
    """


class TensionAsShear(Notice):
    """Moduli measured in tension are turned into shear by the bulk modulus alone.

    When: `fit_maxwell` is given a master curve in tension.

    Remedy: `master.to_shear(K=...)` or `to_shear(nu=...)` beforehand says how it is meant.
    """


class OutsideIsotherms(Notice):
    """A shift law is used at a temperature at which nothing was measured.

    When: a material is moved to (`at`, `Application.temperature`), or a master curve referred to, a
    temperature outside the isotherms its law was found from.

    Remedy: measure there, or take the answer as an extrapolation of the law.
    """


class PoorLaw(Notice):
    """A shift law renders the shifts of the isotherms far worse than they are known.

    When: `master_curve` fits a law that misses the shifts by 0.3 decade rms.

    Remedy: another law ("joined" through a glass transition, "free"), or fewer isotherms.
    """


class BearingWarning(Notice):
    """A bearing is asked for more than its parts bear, or than its model covers.

    When: a contact pressure exceeds 4.2 GPa (ISO 76), the static rating, in `load_distribution`;
    or a shoulder cuts a contact ellipse.

    Remedy: check the load's unit; a larger bearing, less load, or a higher shoulder.
    """


def warn(text: str, category: type[Notice]) -> None:
    """Warn at the nearest caller that is not of this package.

    The caller is known by its module's name, not its file: the `__init__` of a dataclass has no file.
    """
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and str(frame.f_globals.get("__name__", "")).partition(".")[0] == _OWN:
        level, frame = level + 1, frame.f_back
    warnings.warn(text, category, stacklevel=level)
