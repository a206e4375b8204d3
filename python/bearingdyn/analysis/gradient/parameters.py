"""Parameters of a machine by name, and what each of them changes in the system's arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bearingdyn.application import GROUND, Channel, Place
from bearingdyn.bearing import BallBearing
from bearingdyn.checks import meant, name_list, named, number, require
from bearingdyn.material import Maxwell
from bearingdyn.parts import DIMENSIONS, Layer, LayerSlopes, RigidBody, layer_slopes
from bearingdyn.system import System
from bearingdyn.types import Array

_OFFERED = (
    "of a layer's part: r_inner, r_outer, width, K, density, G0, G1 …, tau1 …, eta0; of a bearing: "
    "clearance; "
    "of a rigid body: mass, inertia.x …; of a support: place.stiffness.y, place.damping.y; and load.place.y"
)


@dataclass(eq=False)
class Change:
    """Derivative of a system's arrays with respect to one of the parameters; what is missing is constant.

    Attributes
    ----------
    M, C, K
        (n, n).
    H
        (n, n) of L Lᵀ, by layer.
    shear
        Weight of each Maxwell parameter, by layer and name.
    clearance
        Weight of each bearing's clearance, by its place among the system's.
    load
        (n,) of the constant loads.
    inertia
        (n, 3) of `System.inertia`.
    dimensions
        Weights of a layer's dimensions, by part and name.
    """

    M: Array | None = None
    C: Array | None = None
    K: Array | None = None
    H: dict[int, Array] = field(default_factory=dict)
    shear: dict[tuple[int, str], float] = field(default_factory=dict)
    clearance: dict[int, float] = field(default_factory=dict)
    load: Array | None = None
    inertia: Array | None = None
    dimensions: dict[tuple[str, str], float] = field(default_factory=dict)

    def add(self, other: Change, weight: float) -> None:
        """Add another change, weighed."""
        for name in ("M", "C", "K", "load", "inertia"):
            theirs = getattr(other, name)
            if theirs is not None:
                own = getattr(self, name)
                setattr(self, name, weight * theirs if own is None else own + weight * theirs)
        for layer, H in other.H.items():
            self.H[layer] = self.H.get(layer, 0.0) + weight * H
        for word in ("shear", "clearance", "dimensions"):
            mine = getattr(self, word)
            for key, value in getattr(other, word).items():
                mine[key] = mine.get(key, 0.0) + weight * value


def changes_of(system: System, parameters: object) -> dict[str, Change]:
    """What each parameter changes, by its name.

    Parameters
    ----------
    system
        The machine's.
    parameters
        Names; or a mapping, name -> one of those names, several that change together, or a mapping of them to
        the weights with which they do.

    Raises
    ------
    ValueError
        For a parameter that the system has not; says what there is.
    """
    given: Mapping[str, Any]
    if isinstance(parameters, Mapping):
        given = named("parameters", parameters, "it must be a mapping, name -> parameter")
    else:
        given = {name: name for name in name_list("parameters", parameters, "parameters")}
    require(bool(given), "parameters", parameters, "give one at least")
    asked: dict[str, dict[str, float]] = {}
    for name, what in given.items():
        words = f"parameters[{name!r}]"
        if isinstance(what, Mapping):
            weights = named(words, what, "it must be a mapping, parameter -> weight")
        else:
            several = [what] if isinstance(what, str) else name_list(words, what, "parameters")
            weights = dict.fromkeys(several, 1.0)
        asked[name] = {path: number(f"{words}[{path!r}]", weight) for path, weight in weights.items()}

    paths = list(dict.fromkeys(path for weights in asked.values() for path in weights))
    layers = _Layers(system, paths)
    known = {path: _change(system, path, layers) for path in paths}
    found = {}
    for name, weights in asked.items():
        found[name] = total = Change()
        for path, weight in weights.items():
            total.add(known[path], weight)
    return found


class _Layers:
    """Derivatives of layers, all of one layer at once; a layer may stand on many sides of a machine."""

    def __init__(self, system: System, paths: Sequence[str]) -> None:
        sources = {t.name: t.source for t in system.parts if isinstance(t.source, Layer)}
        self.asked: dict[int, list[str]] = {}
        for path in paths:
            named = _named(path)
            if named.part in sources and named.name in (*DIMENSIONS, "K", "density"):
                names = self.asked.setdefault(id(sources[named.part]), [])
                names += [named.name] if named.name not in names else []
        self.found: dict[int, dict[str, LayerSlopes]] = {}

    def __call__(self, layer: Layer, name: str) -> LayerSlopes:
        if id(layer) not in self.found:
            self.found[id(layer)] = layer_slopes(layer, self.asked[id(layer)])
        return self.found[id(layer)][name]


def _named(path: str) -> Place:
    """What a parameter belongs to, and its name there."""
    return Place.parse(path) if "." in path else Place(path, "")


def _change(system: System, path: str, layers: _Layers) -> Change:
    """The change by one named parameter."""
    named = _named(path)
    head, tail = named.part, named.name
    if head == "load" and tail:
        return Change(load=np.array(system.row(tail)))
    for i, hung in enumerate(system.bearings):
        if path == f"{hung.name}.clearance":
            require(
                isinstance(hung.bearing, BallBearing) and hung.bearing.clearance is not None,
                "parameter",
                path,
                "the bearing was given by a contact angle, or is none; give it a clearance",
            )
            return Change(clearance={i: 1.0})
    for word in ("stiffness", "damping"):
        place, found, component = path.rpartition(f".{word}.")
        if found:
            return _spring(system, path, place, word, component)
    for term in system.parts:
        if term.name != head:
            continue
        own = [k for k, layer in enumerate(system.layers) if layer.part == head]
        if isinstance(term.source, Layer):
            material = system.layers[own[0]].material if own else None
            if tail in (*DIMENSIONS, "K", "density"):
                require(isinstance(material, Maxwell), "parameter", path, "it needs a layer of bd.Maxwell")
                S, slopes = term.place, layers(term.source, tail)
                inertia = S.T @ (slopes.M @ term.rigid[:, :3])
                weights = {(head, tail): 1.0} if tail in DIMENSIONS else {}
                return Change(
                    M=S.T @ slopes.M @ S,
                    K=S.T @ slopes.K @ S,
                    H={own[0]: S.T @ slopes.H @ S},
                    inertia=inertia,
                    dimensions=weights,
                )
        if isinstance(term.source, RigidBody):
            diagonal = np.zeros(6)
            if tail == "mass":
                diagonal[:3] = 1.0
            elif tail in ("inertia.x", "inertia.y", "inertia.z") and not term.source.rotating:
                diagonal[3 + "xyz".index(tail[-1])] = 1.0
            if diagonal.any():
                S, D = term.place, np.diag(diagonal)
                return Change(M=S.T @ D @ S, inertia=S.T @ (D @ term.rigid[:, :3]))
        for k in own:
            material = system.layers[k].material
            if isinstance(material, Maxwell) and tail in shear_names(material):
                return Change(shear={(k, tail): 1.0})
    parts = [t.name for t in system.parts] + [t.name for t in system.bearings]
    hint = "" if head in parts else f"; {meant(head, parts)}"
    raise ValueError(f"parameter is {path!r}; it must be one of those with a derivative, {_OFFERED}{hint}")


def _spring(system: System, path: str, place: str, word: str, component: str) -> Change:
    wanted = (place, f"{place}–{GROUND}")
    springs = [s for s in system.springs if s.name in wanted]
    remedy = f"it must be a spring of the machine; there are {[s.name for s in system.springs]}"
    require(len(springs) == 1, "parameter", path, remedy)
    index = Channel.parse(f"{place}.{component}").index if place in system.outputs else None
    if index is None:
        letters = {"x": 0, "y": 1, "z": 2, "θx": 3, "θy": 4, "θz": 5, "rx": 3, "ry": 4, "rz": 5}
        require(component in letters, "parameter", path, f"its component must be one of {sorted(letters)}")
        index = letters[component]
    row = springs[0].across[index]
    A = np.outer(row, row)
    return Change(K=A) if word == "stiffness" else Change(C=A)


def shear_names(material: Maxwell) -> list[str]:
    """Parameters of a gradient that are a Maxwell model's: their names."""
    n = material.G.size
    return ["G0", *(f"G{k + 1}" for k in range(n)), *(f"tau{k + 1}" for k in range(n)), "eta0"]


def modulus_slope(material: Maxwell, name: str, s: Any) -> Any:
    """A gradient's ∂G*/∂(parameter) at s = iω, rad/s, or any complex rate, of any shape."""
    s = np.asarray(s, dtype=np.complex128)
    if name == "G0":
        return np.ones_like(s)
    if name == "eta0":
        return s
    k = int(name.lstrip("Gtau")) - 1
    tau = float(material.tau[k])
    if name.startswith("tau"):
        return float(material.G[k]) * s / (1 + s * tau) ** 2
    return s * tau / (1 + s * tau)


def relaxation_slope(material: Maxwell, name: str, state: str | float) -> float:
    """∂G/∂(parameter) of the static modulus: "relaxed", "instantaneous", or after a time, s."""
    if name == "G0":
        return 1.0
    if name == "eta0" or state == "relaxed":
        return 0.0
    k = int(name.lstrip("Gtau")) - 1
    if state == "instantaneous":
        return 0.0 if name.startswith("tau") else 1.0
    assert isinstance(state, float)
    late = state / float(material.tau[k])
    fading = float(np.exp(-late))
    if name.startswith("tau"):
        return float(material.G[k]) * late / float(material.tau[k]) * fading
    return fading


def arm_slope(bearing: BallBearing) -> float:
    """The parameter clearance: derivative of ln R_i, 1/m; R_i is the arm of the tilts unless given."""
    geometry = bearing.geometry
    if bearing.overrides.arm is not None:
        return 0.0
    # R_i = Dpw/2 + (fi − ½) Dw cos α0, cos α0 = 1 − P/2A
    return -(bearing.fi - 0.5) * bearing.Dw / (2.0 * geometry.A) / geometry.R_i


def kernel_slope(bearing: BallBearing) -> dict[str, float]:
    """The parameter clearance: derivative of the kernel's fields, 1 and m."""
    P, A = float(bearing.clearance or 0.0), bearing.geometry.A
    # y0 = A − P/2 and e0 = −(P/2)(2A − P/2); an axial offset adds to e0 what does not depend on P
    return {"y0": -0.5, "e0": -A + 0.5 * P}
