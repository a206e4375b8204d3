"""Steady temperatures of parts that exchange heat: conductances between nodes, and films to the air."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from bearingdyn.application import Application, Place
from bearingdyn.bearing import BallBearing
from bearingdyn.checks import instance, meant, number, positive, require, whole
from bearingdyn.parts import Layer
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array

AIR = "air"
"""The node whose temperature is given."""


@dataclass(frozen=True)
class _Body:
    """A body with heat of its own: its cells and their shares of the volume."""

    cells: tuple[str, ...]
    shares: tuple[float, ...]


@dataclass(eq=False)
class ThermalNetwork:
    """A thermal network: nodes with a temperature each, joined by conductances, in the steady state.

    Parameters
    ----------
    ambient
        Temperature of the node "air", °C.

    Examples
    --------
    >>> from bearingdyn.analysis import ThermalNetwork
    >>> parts = ThermalNetwork(ambient=20.0)
    >>> parts.link("ring", "housing", 2.0)  # W/K
    >>> parts.link("housing", "air", 0.5)
    >>> {name: round(T, 3) for name, T in parts.temperatures({"ring": 10.0}).items()}
    {'air': 20.0, 'ring': 45.0, 'housing': 40.0}
    """

    ambient: float = 20.0
    _links: list[tuple[str, str, float]] = field(default_factory=list)
    _bodies: dict[str, _Body] = field(default_factory=dict)
    _nodes: dict[str, int] = field(default_factory=dict)

    _repr_html_ = page

    def __post_init__(self) -> None:
        plausible("temperature", "ambient", self.ambient, "it must be one finite number, in °C")
        self._nodes.setdefault(AIR, 0)

    def __repr__(self) -> str:
        """One line: nodes, links, and the air."""
        return (
            f"<ThermalNetwork: {len(self._nodes)} nodes, {len(self._links)} links, air {self.ambient:g} °C>"
        )

    @property
    def nodes(self) -> tuple[str, ...]:
        """Names of nodes and bodies, the air among them."""
        inside = {cell for body in self._bodies.values() for cell in body.cells}
        return (*(n for n in self._nodes if n not in inside), *self._bodies)

    def link(self, a: str, b: str, conductance: float) -> None:
        """Join two nodes, W/K; nodes come into being by being named. Several links of a pair add up.

        Raises
        ------
        ValueError
            For a conductance that is not positive, or a node joined to itself.
        """
        for end, node in (("a", a), ("b", b)):
            require(isinstance(node, str) and bool(node), end, node, "it must be the name of a node")
        G = positive(f"conductance of {a!r} to {b!r}", conductance, "it must be positive and finite, in W/K")
        plausible("conductance", f"conductance of {a!r} to {b!r}", G)
        require(a != b, "b", b, "a node cannot be joined to itself")
        for name in (a, b):
            self._nodes.setdefault(name, len(self._nodes))
        self._links.append((a, b, G))

    def film(self, a: str, area: float, coefficient: float) -> None:
        """Join a node to the air by a film: coefficient W/(m² K) times area, m²."""
        carried = plausible("film coefficient", "coefficient", positive("coefficient", coefficient))
        self.link(a, AIR, plausible("area", "area", positive("area", area)) * carried)

    def slab(
        self,
        name: str,
        a: str,
        b: str,
        *,
        area: float,
        thickness: float,
        conductivity: float,
        cells: int = 24,
    ) -> None:
        """Put a slab with heat of its own between two nodes, its faces.

        Parameters
        ----------
        name
            Under which it takes heat and has a (mean) temperature.
        a, b
            The nodes of its faces.
        area, thickness
            m², m.
        conductivity
            W/(m K); rubber some .2.
        cells
            Through its thickness; the temperature's error is 1/cells².
        """
        n = whole("cells", cells, 2, 1000)
        step = plausible("length", "thickness", positive("thickness", thickness)) / n
        lambda_ = plausible("conductivity", "conductivity", positive("conductivity", conductivity))
        G = lambda_ * plausible("area", "area", positive("area", area)) / step
        self._chain(name, a, b, [2 * G, *([G] * (n - 1)), 2 * G], [1 / n] * n)

    def ring(
        self,
        name: str,
        a: str,
        b: str,
        *,
        r_inner: float,
        r_outer: float,
        width: float,
        conductivity: float,
        cells: int = 24,
    ) -> None:
        """Put a ring with heat of its own between the nodes of its inner and outer face.

        Parameters
        ----------
        name, a, b, conductivity, cells
            As in `slab`.
        r_inner, r_outer, width
            m.
        """
        n = whole("cells", cells, 2, 1000)
        inner, outer, wide = (
            plausible("length", name, positive(name, value))
            for name, value in (("r_inner", r_inner), ("r_outer", r_outer), ("width", width))
        )
        require(outer > inner, "r_outer", r_outer, "it must exceed r_inner")
        edges = np.linspace(inner, r_outer, n + 1)
        middles = (edges[1:] + edges[:-1]) / 2
        radii = np.concatenate([[inner], middles, [r_outer]])
        along = 2 * math.pi * wide
        along *= plausible("conductivity", "conductivity", positive("conductivity", conductivity))
        G = along / np.log(radii[1:] / radii[:-1])
        volume = np.diff(edges**2)
        self._chain(name, a, b, G.tolist(), (volume / volume.sum()).tolist())

    def _chain(self, name: str, a: str, b: str, G: list[float], shares: list[float]) -> None:
        require(name not in self._nodes and name not in self._bodies, "name", name, "it is taken")
        cells = tuple(f"{name}[{k}]" for k in range(len(shares)))
        for left, right, conductance in zip((a, *cells), (*cells, b), G, strict=True):
            self.link(left, right, conductance)
        self._bodies[name] = _Body(cells, tuple(shares))

    def temperatures(self, heat: Mapping[str, float]) -> dict[str, float]:
        """Temperature of every node and body (mean), °C, under heats by name, W.

        Raises
        ------
        ValueError
            For heat of an unknown node, or nodes from which heat finds no way to the air.
        """
        T = self._solved(heat)
        inside = {cell for body in self._bodies.values() for cell in body.cells}
        found = {name: float(T[k]) for name, k in self._nodes.items() if name not in inside}
        for name, body in self._bodies.items():
            found[name] = float(np.dot(body.shares, [T[self._nodes[c]] for c in body.cells]))
        return found

    def peak(self, name: str, heat: Mapping[str, float]) -> float:
        """Highest temperature inside a body, °C, under heats by name, W."""
        require(name in self._bodies, "name", name, meant(name, self._bodies))
        T = self._solved(heat)
        return float(max(T[self._nodes[c]] for c in self._bodies[name].cells))

    def _solved(self, heat: Mapping[str, float]) -> Array:
        n = len(self._nodes)
        K, P = np.zeros((n, n)), np.zeros(n)
        for a, b, G in self._links:
            i, j = self._nodes[a], self._nodes[b]
            K[[i, j], [i, j]] += G
            K[[i, j], [j, i]] -= G
        for name, power in heat.items():
            W = number(f"heat of {name!r}", power, "it must be a finite power in W")
            if name in self._bodies:
                for cell, share in zip(self._bodies[name].cells, self._bodies[name].shares, strict=True):
                    P[self._nodes[cell]] += share * W
            else:
                require(name in self._nodes and name != AIR, "heat", name, meant(name, self.nodes))
                P[self._nodes[name]] += W
        free = np.arange(1, n)
        T = np.full(n, float(self.ambient))
        if free.size:
            lost = self._cut_off()
            require(not lost, "network", sorted(lost), "these nodes have no way to the air: link them")
            T[free] = self.ambient + np.linalg.solve(K[np.ix_(free, free)], P[free])
        return T

    def _cut_off(self) -> set[str]:
        """Nodes from which heat finds no way to the air."""
        reached, ahead = {AIR}, [AIR]
        while ahead:
            here = ahead.pop()
            for a, b, _ in self._links:
                for one, other in ((a, b), (b, a)):
                    if one == here and other not in reached:
                        reached.add(other)
                        ahead.append(other)
        return set(self._nodes) - reached


# ISO 15312: a bearing passes 16 kW/m² of π B (d + D) on to its surroundings at 50 K
EMITTED = 16e3 / 50.0
"""W/(m² K) of a bearing's seats, where nothing better is known (ISO 15312)."""


RUBBER_CONDUCTIVITY = 0.25
"""W/(m K), where nothing better is known."""


ACROSS = 0.5
"""W/K between the rings by balls and oil, where nothing better is known: an estimate, unverified."""


class ThermalRunaway(ArithmeticError):
    """A thermal network has no steady temperatures: heat grows faster than it is carried away."""


def estimated_network(app: Application, ambient: float = 20.0) -> ThermalNetwork:
    """Thermal network of an application's bearings and layers, estimated.

    Each bearing has nodes "name.inner" and "name.outer". Its seats pass heat on as ISO 15312's reference
    does, 320 W/(m² K) of their area; a layer of rubber behind the outer ring lies in between, as a ring of
    .25 W/(m K); the rings exchange .5 W/K by balls and oil (an estimate, unverified).

    Parameters
    ----------
    app
        Application.
    ambient
        °C.

    Raises
    ------
    ValueError
        For a bearing whose bore and outside diameter are not known.
    """
    instance("app", app, Application, "it must be an Application (bd.Application())")
    network = ThermalNetwork(ambient)
    for name, joint in app.plan.bearings.items():
        d, D, B = measures(name, joint.bearing)
        inner, outer = f"{name}.inner", f"{name}.outer"
        network.link(inner, outer, ACROSS)
        network.link(inner, AIR, EMITTED * math.pi * d * B)
        layer = _layer_behind(app, joint.outer)
        seat = EMITTED * math.pi * D * B
        if layer is None:
            network.link(outer, AIR, seat)
            continue
        source = app.plan.sources[layer]
        assert isinstance(source, Layer)
        network.ring(
            layer, outer, f"{layer}.housing", r_inner=source.r_inner, r_outer=source.r_outer,
            width=source.width, conductivity=RUBBER_CONDUCTIVITY,
        )  # fmt: skip
        network.link(f"{layer}.housing", AIR, seat)
    return network


def measures(name: str, bearing: BallBearing) -> tuple[float, float, float]:
    """Bore, outside diameter and width, m, by which a thermal network cools a bearing."""
    if bearing.boundary is None:
        raise ValueError(
            f"bearing {name!r} has no boundary; give boundary=(bore, outside, width) in m: it is cooled by it"
        )
    return bearing.boundary


def _layer_behind(app: Application, place: Place) -> str | None:
    """The layer of rubber next to an outer ring, going by rigid joints through one ring at most."""

    def is_layer(part: str) -> bool:
        return isinstance(app.plan.sources.get(part), Layer)

    if is_layer(place.part):
        return place.part
    for joint in app.plan.connections:
        for one, other in ((joint.a, joint.b), (joint.b, joint.a)):
            if one.part == place.part and is_layer(other.part):
                return other.part
    return None
