"""What the layers do at rest: deflection and strain, at which modulus and time, and how sure that is."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.static_balance import Statics
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray


def static_summary(eq: Equilibrium) -> xarray.Dataset:
    """Static summary of the layers: deflection, strain, modulus, time and temperature in an equilibrium.

    Parameters
    ----------
    eq
        The static state.

    Returns
    -------
    xarray.Dataset
        Over "layer", a part with rubber between two interfaces: `deflection`, m, of one interface against the
        other (without turning), `strain`, the nominal one of a `Layer` (NaN for other parts), and `modulus`,
        Pa; each also as _low and _high, the equilibrium found anew with every layer at the highest and the
        lowest modulus that its data allow. No lower bound of the modulus gives an infinite deflection.
        Further `time`, s, since loading (inf: relaxed, or the time of a fit's pin; 0: instantaneous),
        `reach`, s, of the data (NaN: none stated), and `temperature`, °C (NaN: none stated).

    Raises
    ------
    ValueError
        For a state that is not an equilibrium, or without layers.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> rubber = bd.Maxwell(G0=1e6, G=[1e6], tau=[100.0], K=2e9, density=1150.0)
    >>> app = bd.Application()
    >>> app.add("ring", bd.Layer(r_inner=0.026, r_outer=0.030, width=0.016, material=rubber))
    >>> app.free("ring.inner")
    >>> app.ground("ring.outer")
    >>> app.load("ring.inner", (0.0, -100.0, 0.0, 0.0, 0.0, 0.0))
    >>> found = bd.static_summary(bd.equilibrium(app, after=50.0))
    >>> [f"{float(found[name][0]):.3g}" for name in ("deflection", "strain", "modulus", "time")]
    ['9.05e-06', '0.00226', '1.61e+06', '50']
    """
    if not isinstance(eq, Equilibrium):
        raise ValueError(f"eq is {eq!r}; it must be an equilibrium: bd.equilibrium(app)")
    if not eq.system.layers:
        raise ValueError("eq has no layers; a part with a viscoelastic material is one")
    parts = [
        part for part in eq.system.parts if part.element.viscoelastic and len(part.element.interfaces) == 2
    ]
    time = {"relaxed": math.inf, "instantaneous": 0.0}.get(eq.modulus, eq.after)
    assert time is not None
    G = eq.system.static_moduli(eq.modulus if eq.after is None else eq.after)
    known = [_known(t.material, time, value) for t, value in zip(eq.system.layers, G, strict=True)]
    low, high = ([k[side] for k in known] for side in (0, 1))
    soft, stiff = _motions(eq, low), _motions(eq, high)
    columns: dict[str, list[float]] = {}
    for part in parts:
        index = next(i for i, layer in enumerate(eq.system.layers) if layer.part == part.name)
        material = eq.system.layers[index].material
        inner, outer = (f"{part.name}.{name}" for name in part.element.interfaces)
        rows = eq.system.rows(inner) - eq.system.rows(outer)
        for suffix, x in (("", eq.x), ("_low", stiff), ("_high", soft)):
            motion = np.full(6, math.inf) if x is None else rows @ x
            strain = getattr(part.source, "nominal_strain", lambda _: math.nan)
            columns.setdefault("deflection" + suffix, []).append(float(np.linalg.norm(motion[:3])))
            columns.setdefault("strain" + suffix, []).append(math.inf if x is None else float(strain(motion)))
        for name, value in (
            ("modulus", G[index]),
            ("modulus_low", low[index]),
            ("modulus_high", high[index]),
            ("time", _meant(material, time)),
            ("reach", getattr(getattr(material, "low_end", None), "reach", math.nan)),
            ("temperature", _number(getattr(material, "temperature", None))),
        ):
            columns.setdefault(name, []).append(value)

    from bearingdyn.results import dataset, inputs_of

    units = {"deflection": "m", "strain": "1", "modulus": "Pa", "temperature": "°C"}
    meaning = {
        "deflection": "of one interface against the other",
        "strain": "nominal, largest",
        "modulus": "shear modulus of the layer in this state",
        "time": "since the load came",
        "reach": "longest time the data speak of",
        "temperature": "of the layer",
    }
    return dataset(
        {
            name: (
                "layer",
                np.array(values),
                units.get(name.partition("_")[0], "s"),
                meaning[name.partition("_")[0]],
            )
            for name, values in columns.items()
        },
        {"analysis": "static summary", **state_of(eq), **inputs_of(eq.system.inputs)},
        {"layer": ([part.name for part in parts], "")},
    )


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _known(material: Any, time: float, value: float) -> tuple[float, float]:
    """Lowest and highest modulus, Pa, that the data allow after a time; else the value itself."""
    end = getattr(material, "low_end", None)
    return (value, value) if end is None or time == 0.0 else end.bounds(time, value)


def _meant(material: Any, time: float) -> float:
    """The time, s, that the state stands for: the relaxed one of a pinned fit is that of the pin."""
    end = getattr(material, "low_end", None)
    return time if end is None else float(end.meant(time))


def _motions(eq: Equilibrium, moduli: list[float]) -> Array | None:
    """Displacement (n,) with the layers at these moduli, Pa; None where one is zero and nothing holds."""
    if not min(moduli) > 0:
        return None
    rest = Statics.of(eq.system, moduli)
    start = rest.T.T @ (eq.system.M @ eq.x)
    return np.asarray(rest.T @ rest.balance(eq.system.bearings, start)[0])
