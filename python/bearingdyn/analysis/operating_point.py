"""The warm running state: heat of bearings and layers, temperatures, and what they change, to a fixed point.

Heat raises the temperatures by a thermal network; they thin the oil, change clearances, and shift the rubber;
that changes the equilibrium, and with it the heat. Where heat grows faster than it is carried away there is
no such point: a runaway, which is named.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.thermal_network import (
    ThermalNetwork,
    ThermalRunaway,
    estimated_network,
    measures,
)
from bearingdyn.application import Application
from bearingdyn.bearing import (
    BallBearing,
    Friction,
    FrictionModel,
    Lubricant,
    Mounting,
    Supply,
    catalogue,
    friction,
    ratings_of,
)
from bearingdyn.checks import instance, meant, named, one_speed, positive, require, vector, whole
from bearingdyn.parts import Layer
from bearingdyn.pictures import page
from bearingdyn.plausible_ranges import plausible
from bearingdyn.system import System, system_of
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

LayerHeat: TypeAlias = float | Callable[[float], float] | tuple[float, ArrayLike]
"""W; W of the temperature in °C; or (frequency Hz, motion (6,) m and rad zero-to-peak across the layer)."""

HOTTEST = 250.0
"""°C, beyond which no oil or rubber serves."""


@dataclass(frozen=True, eq=False)
class OperatingPoint:
    """An operating point: the warm running state of an application.

    Parameters
    ----------
    equilibrium
        Static state with warm clearances and layers, from which any analysis may start.
    temperatures
        °C, by node of the network.
    heat
        W, by bearing and by layer.
    friction
        Of each bearing.
    viscosity
        Kinematic, of the oil in each bearing, m²/s.
    clearance
        Diametral, of each bearing, m.
    iterations
        Until temperatures stood still.
    """

    equilibrium: Equilibrium
    temperatures: Mapping[str, float]
    heat: Mapping[str, float]
    friction: Mapping[str, Friction]
    viscosity: Mapping[str, float]
    clearance: Mapping[str, float]
    iterations: int

    _repr_html_ = page

    def __repr__(self) -> str:
        """One line: heat, the hottest node, and how many rounds it took."""
        hottest = max(self.temperatures, key=self.temperatures.__getitem__)
        return (
            f"<OperatingPoint: {sum(self.heat.values()):.4g} W, hottest {hottest!r} with "
            f"{self.temperatures[hottest]:.1f} °C, {self.iterations} rounds>"
        )

    def dataset(self) -> xarray.Dataset:
        """Temperatures over "node"; heat, moment, viscosity and clearance over "bearing"."""
        from bearingdyn.results import dataset, inputs_of

        bearings, nodes = list(self.friction), list(self.temperatures)
        return dataset(
            {
                "temperature": ("node", [self.temperatures[n] for n in nodes], "°C", "in the warm state"),
                "heat": ("bearing", [self.heat[b] for b in bearings], "W", "turned out by friction"),
                "moment": ("bearing", [self.friction[b].moment for b in bearings], "N m", "frictional"),
                "viscosity": (
                    "bearing", [self.viscosity[b] for b in bearings], "m²/s", "kinematic, of the warm oil",
                ),
                "clearance": ("bearing", [self.clearance[b] for b in bearings], "m", "diametral, warm"),
            },
            {
                "analysis": "operating point",
                "iterations": self.iterations,
                **inputs_of(self.equilibrium.system.inputs),
            },
            {"bearing": (bearings, ""), "node": (nodes, "")},
        )  # fmt: skip


@takes(speed="rad/s", ambient="°C", assembled_at="°C")
def operating_point(
    app: Application,
    *,
    speed: float | None = None,
    oil: Lubricant,
    ambient: float = 20.0,
    network: ThermalNetwork | None = None,
    friction_model: FrictionModel = "palmgren",
    supply: Supply = "oil bath",
    layer_heat: Mapping[str, LayerHeat] | None = None,
    mountings: Mapping[str, Mounting] | None = None,
    assembled_at: float = 20.0,
    tolerance: float = 0.01,
    rounds: int = 200,
    rpm: float | None = None,
) -> OperatingPoint:
    """The operating point: temperatures, viscosities, clearances and layers that agree with their heat.

    Parameters
    ----------
    app
        Application; it is left as it is.
    speed
        Of the shaft, rad/s.
    oil
        Of all bearings.
    ambient
        Of the air, °C, where no network is given.
    network
        With nodes "name.inner" and "name.outer" for every bearing, and the layers' names for those that are
        to warm; None: by `estimated_network`.
    friction_model, supply
        Of `friction`. The heat is made half at each ring.
    layer_heat
        Heat of layers by part: W, a function of the layer's temperature, or (frequency, motion).
    mountings
        Fits by bearing, at the temperature of assembly; None: no interference.
    assembled_at
        °C, at which clearances are those of the application's bearings.
    tolerance
        K, within which temperatures must repeat.
    rounds
        At most.
    rpm
        The speed in revolutions a minute, instead of `speed`.

    Raises
    ------
    ThermalRunaway
        An ArithmeticError: where temperatures pass 250 °C or do not come to rest; names the hottest node.
    ValueError
        Naming what is wrong; also where fits and warmth leave a bearing no clearance.

    Warns
    -----
    UnloadedBearing
        Where a bearing carries nothing when it is warm.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> from bearingdyn.demo import motor
    >>> oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(32))
    >>> warm = bd.operating_point(motor(None), speed=314.0, oil=oil)
    >>> 25 < warm.temperatures["left.inner"] < 35
    True
    """
    instance("app", app, Application, "it must be an Application (bd.Application())")
    instance("oil", oil, Lubricant, "give a bd.bearing.Lubricant")
    omega = plausible("speed", "speed", one_speed(speed, rpm), "it must be a finite speed in rad/s")
    cold = plausible("temperature", "assembled_at", assembled_at, "it must be one finite number, in °C")
    still = positive("tolerance", tolerance, "it must be positive, in K")
    most = whole("rounds", rounds, 1, 100_000)
    parts = estimated_network(app, ambient) if network is None else network
    instance("network", parts, ThermalNetwork, "give a ThermalNetwork")
    system = system_of("app", app)
    hung = {t.name: t.bearing for t in system.bearings if isinstance(t.bearing, BallBearing)}
    require(bool(hung), "app", app, "it has no ball bearing to warm")
    for name in hung:
        for node in (f"{name}.inner", f"{name}.outer"):
            require(node in parts.nodes, "network", node, f"it is not there; there are {sorted(parts.nodes)}")
    warmed = named("layer_heat", layer_heat or {}, "give heats by the names of parts")
    layers = {t.part for t in system.layers}
    for part in warmed:
        require(part in layers, "layer_heat", part, meant(part, layers))
    fits = named("mountings", mountings or {}, "give a Mounting by the name of its bearing")
    for name in fits:
        require(name in hung, "mountings", name, meant(name, hung))

    T = dict.fromkeys(parts.nodes, float(parts.ambient))
    state: Equilibrium | None = None
    change, share, last = math.inf, 1.0, math.inf
    for k in range(1, most + 1):
        try:
            warm = _warmed(system, T, cold, fits)
            state = equilibrium(warm, start=state)
            rubbed = {
                name: _rubbing(state, name, bearing, omega, oil, T, friction_model, supply)
                for name, bearing in hung.items()
            }
        except ValueError as error:
            if max(T.values()) < HOTTEST * 0.6:
                raise
            raise ThermalRunaway(f"{_hottest(T)} after {k} rounds; {error}") from error
        own = {part: _layer_power(app, part, given, T.get(part, cold)) for part, given in warmed.items()}
        heat = {part: W for part, W in own.items() if part in parts.nodes}
        for name, one in rubbed.items():
            for node in (f"{name}.inner", f"{name}.outer"):
                heat[node] = heat.get(node, 0.0) + one.power / 2
        found = parts.temperatures(heat)
        change = max(abs(found[n] - T[n]) for n in found)
        if change <= still:
            state.warn_of_unloaded("no load rubs in it, so that its oil's drag alone warms it")
            return OperatingPoint(
                state, found, {**{n: f.power for n, f in rubbed.items()}, **own}, rubbed,
                {n: oil.kinematic.viscosity(_mean(T, n)) for n in hung},
                {t.name: t.bearing.geometry.Pd for t in state.system.bearings
                 if isinstance(t.bearing, BallBearing)}, k,
            )  # fmt: skip
        # an oscillation is halved, as Aitken would; a growth is let run into the limit
        share = max(share / 2, 1 / 64) if change > 0.9 * last and k > 3 else min(1.0, 1.2 * share)
        last = change
        T = {n: T[n] + share * (found[n] - T[n]) for n in found}
        if not max(T.values()) < HOTTEST:
            raise ThermalRunaway(
                f"{_hottest(T)} after {k} rounds, and rising: heat of {sum(heat.values()):.4g} W grows "
                f"faster than the network carries it away; more film or conduction, less load or speed"
            )
    raise ThermalRunaway(f"{_hottest(T)} still changes by {change:.3g} K after {most} rounds")


def _hottest(T: Mapping[str, float]) -> str:
    name = max(T, key=T.__getitem__)
    return f"node {name!r} has {T[name]:.0f} °C"


def _mean(T: Mapping[str, float], bearing: str) -> float:
    return (T[f"{bearing}.inner"] + T[f"{bearing}.outer"]) / 2


def _warmed(system: System, T: Mapping[str, float], cold: float, fits: Mapping[str, Mounting]) -> System:
    """The system with its bearings' clearances and its layers' materials at these temperatures."""
    bearings = []
    for term in system.bearings:
        if not isinstance(term.bearing, BallBearing):
            bearings.append(term)
            continue
        d, D, _ = measures(term.name, term.bearing)
        inner, outer = T[f"{term.name}.inner"] - cold, T[f"{term.name}.outer"] - cold
        fit = replace(
            fits.get(term.name, Mounting(d, D)), inner=inner, outer=outer, balls=(inner + outer) / 2
        )
        # the seats have the temperature of their rings, so that fits stay
        fit = replace(
            fit,
            shaft=replace(fit.shaft, warming=inner),
            housing=replace(fit.housing, warming=outer),
        )
        left = term.bearing.geometry.Pd + fit.clearance_change(term.bearing)
        require(
            left >= 0, f"clearance of bearing {term.name!r}", left,
            f"fits and warmth ({inner + cold:.0f} °C inside, {outer + cold:.0f} °C outside) have eaten it: a "
            "larger clearance class, or looser fits",
        )  # fmt: skip
        bearings.append(replace(term, bearing=fit.mounted(term.bearing)))
    layers = []
    for layer in system.layers:
        warm = T.get(layer.part)
        layers.append(layer if warm is None else replace(layer, material=_at(layer.material, warm)))
    return replace(system, bearings=tuple(bearings), layers=tuple(layers))


def _rubbing(
    state: Equilibrium,
    name: str,
    bearing: BallBearing,
    omega: float,
    oil: Lubricant,
    T: Mapping[str, float],
    model: FrictionModel,
    supply: Supply,
) -> Friction:
    """Friction of one bearing in a state."""
    d, D, _ = measures(name, bearing)
    force = state.bearings[name].force
    inner, outer = bearing.ring_speeds
    return friction(
        model,
        radial=float(np.hypot(force[0], force[1])),
        axial=abs(float(force[2])),
        speed=omega * (inner - outer),
        viscosity=oil.kinematic.viscosity(_mean(T, name)),
        bore=d,
        outside=D,
        C0=ratings_of(bearing).C0,
        contact_angle=bearing.contact_angle or 0.0,
        series=catalogue.series_of(bearing) or "62",
        supply=supply,
    )


def _layer_power(app: Application, part: str, given: LayerHeat, T: float) -> float:
    """Heat of a layer at a temperature, W."""
    field = f"layer_heat[{part!r}]"
    if isinstance(given, tuple):
        source = app.plan.sources[part]
        require(isinstance(source, Layer), field, given, "a motion needs a Layer; give W, or W of °C")
        assert isinstance(source, Layer)
        omega = 2 * math.pi * positive(f"{field}: frequency", given[0])
        x = np.concatenate([np.zeros(6), vector(f"{field}: motion", given[1], (6,), "m and rad")])
        K = replace(source, material=_at(source.material, T)).stiffness(omega)
        return float(0.5 * omega * (x @ K.imag @ x))
    power = given(T) if callable(given) else given
    remedy = "it must be zero or positive, in W"
    W = float(power)
    require(math.isfinite(W) and W >= 0, field, power, remedy)
    return W


def _at(material: Any, T: float) -> Any:
    """A material at a temperature, °C; one without a shift law stays as it is."""
    return material.at(T) if getattr(material, "law", None) is not None else material
