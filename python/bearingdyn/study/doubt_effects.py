"""What each doubt about a rubber does to an answer, one at a time."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.checks import instance, require
from bearingdyn.material import Doubts, Maxwell
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


def doubt_effects(doubts: Doubts, answer: Callable[[Maxwell], Any], unit: str = "1") -> xarray.Dataset:
    """Ask for an answer at both ends of each doubt about a rubber, the rest as it is.

    Parameters
    ----------
    doubts
        As `doubts` names them.
    answer
        Called with a rubber: real numbers, of one shape each time.
    unit
        Of the answer.

    Returns
    -------
    xarray.Dataset
        nominal (…,), the answer of the rubber as it is; value (doubt, end, …), the answers at the low and the
        high end of each doubt; low and high (…,), nominal less, and more, the root of the sum of the squares
        of what the doubts take away, or add: the band if they are independent and the answer is linear in
        them. The doubts are ordered by the largest change they make; setting (doubt, end) is their own value,
        source (doubt,) where it comes from.

    Raises
    ------
    ValueError
        For an answer that is not finite, or of another shape than that of the rubber as it is. What `answer`
        itself raises names the doubt.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[2e6], tau=[1e-4], K=2e9, density=1150.0)
    >>> def radial(material):
    ...     layer = bd.Layer(r_inner=0.020, r_outer=0.021, width=0.017, material=material)
    ...     return layer.stiffness()[0, 0].real
    >>> found = bd.study.doubt_effects(bd.doubts(rubber, K=(1e9, 3e9), specimen=(1.0, 1.034)), radial, "N/m")
    >>> [f"{float(x) / 1e6:.0f}" for x in (found.low, found.nominal, found.high)], found.doubt.values.tolist()
    (['226', '256', '271'], ['K', 'specimen'])
    """
    instance("doubts", doubts, Doubts, "name them by bd.doubts(material, …)")
    nominal = _asked(answer, doubts.material, None, "the rubber as it is")
    value = np.zeros((len(doubts), 2, *nominal.shape))
    for k, d in enumerate(doubts.sources):
        for side, x in enumerate((d.low, d.high)):
            material = doubts.varied(**{d.name: x})
            value[k, side] = _asked(answer, material, nominal.shape, f"{d.name} = {x:g}")
    change = value - nominal
    size = np.abs(change).reshape(len(doubts), -1).max(axis=1)
    order = np.argsort(-size, kind="stable")
    down = np.sqrt(np.sum(np.minimum(change.min(axis=1), 0.0) ** 2, axis=0))
    up = np.sqrt(np.sum(np.maximum(change.max(axis=1), 0.0) ** 2, axis=0))

    from bearingdyn.results import dataset

    sources = [doubts.sources[k] for k in order]
    inner = tuple(f"answer_{i}" for i in range(nominal.ndim))
    return dataset(
        {
            "nominal": (inner, nominal, unit, "answer of the rubber as it is"),
            "value": (("doubt", "end", *inner), value[order], unit, "answer at the ends of each doubt"),
            "low": (inner, nominal - down, unit, "lower end of the band of all doubts"),
            "high": (inner, nominal + up, unit, "upper end of the band of all doubts"),
            "setting": (("doubt", "end"), np.array([(d.low, d.high) for d in sources]), "", "of each doubt"),
            "source": ("doubt", np.array([d.source for d in sources]), "", "where it comes from"),
        },
        {"analysis": "doubt effects"},
        {"doubt": ([d.name for d in sources], ""), "end": (["low", "high"], "")},
    )


def _asked(
    answer: Callable[[Maxwell], Any], material: Maxwell, shape: tuple[int, ...] | None, words: str
) -> Array:
    try:
        found = np.asarray(answer(material), dtype=np.float64)
    except Exception as error:
        error.add_note(f"asked with {words}")
        raise
    require(bool(np.isfinite(found).all()), "answer", found, f"with {words} it must be finite numbers")
    known = shape is None or found.shape == shape
    require(
        known, "answer", found.shape, f"with {words} its shape must be {shape}, as of the rubber as it is"
    )
    return found
