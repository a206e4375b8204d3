"""The shear modulus of a layer at rest."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

from bearingdyn.material import Maxwell, warn_beyond
from bearingdyn.system.terms import LayerTerm

# of layers at rest: "relaxed", "instantaneous", a time after loading, s, or a modulus for each, Pa
Modulus: TypeAlias = str | float | Sequence[float]


def static_modulus(layer: LayerTerm, modulus: Modulus) -> float:
    """Static shear modulus of a layer, "relaxed", "instantaneous" or G(t), Pa; ValueError otherwise."""
    if not isinstance(layer.material, Maxwell):
        raise ValueError(
            f"layer {layer.part!r} has the material {type(layer.material).__name__}; statics and the time "
            f"domain need a Maxwell model: fit one with fit_maxwell"
        )
    if isinstance(modulus, float):
        return float(layer.material.relaxation(modulus, doubt=False))
    if modulus == "relaxed":
        return float(layer.material.G0)
    if modulus == "instantaneous":
        return float(layer.material.G_instantaneous)
    raise ValueError(f'modulus is {modulus!r}; it must be "relaxed" or "instantaneous"')


def warn_at_rest(layers: Iterable[LayerTerm], time: float) -> None:
    """Warn that static moduli of layers are beyond what their data cover.

    Parameters
    ----------
    layers
        Of a system.
    time
        After loading, s; inf: relaxed.

    Warns
    -----
    BeyondData
        Once for all layers.
    """
    warn_beyond(
        [(layer.part, layer.material) for layer in layers],
        time,
        "the static state",
        "take equilibrium(app, after=...) at a time that the data reach, ",
    )
