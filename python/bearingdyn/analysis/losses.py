"""Where a running application turns energy into heat."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.running import part_of
from bearingdyn.analysis.transient import checked_speed
from bearingdyn.system import System, factor
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray

Channel = tuple[int, Array | None, int, int]

# steps whose powers are held at once
PIECE = 2000


@dataclass(frozen=True, eq=False)
class Sink:
    """Something that loses energy: the power is Σ (rows v)², or the core's own channel of it."""

    name: str
    rows: Array
    channel: tuple[int, int, int] | None = None


def dissipation(
    source: Equilibrium,
    *,
    speed: float | tuple[ArrayLike, ArrayLike],
    dt: float,
    steps: int,
    settle: int = 0,
    scheme: core.Scheme | None = None,
    progress: core.Progress | None = None,
) -> xarray.Dataset:
    """March as `transient` does, and sum up what every part, bearing and spring turns into heat.

    Viscous damping loses ẋᵀCẋ; the shear of a viscoelastic part, "layer (shear)", what the dashpots of its
    branches and its η0 lose; a bearing what its contacts lose. Powers are summed by the trapezoidal rule over
    the last `steps` steps, without `settle` all but the first, as in the audit of `transient`, whose linear,
    branch and contact losses these are parts of. A part whose damping turns with the shaft is reckoned by its
    motion in the fixed frame.

    speed, dt, steps, settle, scheme, progress: as in `transient`.

    Returns a Dataset over "part": energy, J, and power, its mean, W.

    Raises ValueError and SolverError as `transient`.
    """
    if not (dt > 0 and math.isfinite(dt)):
        raise ValueError(f"dt is {dt}; the time step must be positive, in s")
    for name, value, least in (("steps", steps, 1), ("settle", settle, 0)):
        if not value >= least or value % 1 != 0:
            raise ValueError(f"{name} is {value}; it must be a whole number of at least {least}")
    if source.modulus != "relaxed":
        raise ValueError(
            f"the equilibrium has its layers at their {source.modulus} modulus; a march starts with relaxed "
            f'ones: take equilibrium(app, modulus="relaxed")'
        )
    system = source.system
    system.check_speed(checked_speed(speed))
    modal, T = system.modal()
    sinks = _sinks(modal)
    channels: list[Channel] = []
    sizes = []
    for sink in sinks:
        if sink.channel is not None:
            kind, bearing, index = sink.channel
            channels.append((kind, None, bearing, index))
        else:
            channels += [(core.CHANNEL_KINDS["velocity"], row, 0, 0) for row in sink.rows]
        sizes.append(1 if sink.channel is not None else len(sink.rows))
    model = modal.model(channels)
    base = scheme or core.Scheme(dt)
    own = core.Scheme(dt, base.beta, base.gamma, speed, base.tolerance, base.max_iterations, False, base.isa)

    state = model.state(0.0, T.T @ system.M @ source.x, np.zeros(system.n))
    total = int(settle) + int(steps)
    energy, last, done, start = np.zeros(len(sinks)), np.zeros((0, len(sinks))), 0, True
    while done < total:
        settling = done < settle
        count = int(settle) - done if settling else min(PIECE, total - done)
        # the last settled step is the first whose power counts
        rows, state, report = core.march(
            model,
            state,
            own,
            count,
            count if settling else 1,
            start=start,
            progress=part_of(progress, done, total),
        )
        if report.status != 0:
            failed = core.Interrupted if report.status == core.INTERRUPTED else None
            text = f"{report.text} in step {done + report.steps + 1} at t = {report.t:.6g} s"
            raise failed(text) if failed else core.SolverError(f"{text}; try a smaller dt", report)
        power = np.vstack([last, _powers(sinks, sizes, rows)])
        energy += dt * (power.sum(axis=0) - 0.5 * (power[0] + power[-1]))
        last, start, done = power[-1:], False, done + count

    from bearingdyn.results import dataset, inputs_of

    duration = dt * (steps if settle else max(steps - 1, 1))
    return dataset(
        {
            "energy": ("part", energy, "J", "energy turned into heat"),
            "power": ("part", energy / duration, "W", "its mean power"),
        },
        {
            "analysis": "dissipation",
            "dt": dt,
            "settle": int(settle),
            "steps": int(steps),
            **inputs_of(system.inputs),
        },
        {"part": ([s.name for s in sinks], "")},
    )


def _sinks(system: System) -> list[Sink]:
    """What loses energy in a system, in its own coordinates."""
    none = np.zeros((0, system.n))
    sinks = []
    layer = 0
    for part in system.parts:
        sinks.append(Sink(part.name, factor(np.asarray(part.element.C)).T @ part.place))
        for _ in part.element.viscoelastic:
            term = system.layers[layer]
            eta0 = float(getattr(term.material, "eta0", 0.0))
            name = f"{part.name} (shear)"
            sinks.append(Sink(name, none, (core.CHANNEL_KINDS["branch_loss"], 0, layer)))
            if eta0 > 0.0:
                sinks.append(Sink(f"{part.name} (shear, η0)", math.sqrt(2.0 * eta0) * term.L.T))
            layer += 1
    for spring in system.springs:
        sinks.append(Sink(spring.name, np.sqrt(spring.damping)[:, None] * spring.across))
    for k, hung in enumerate(system.bearings):
        sinks.append(Sink(hung.name, none, (core.CHANNEL_KINDS["contact_loss"], k, 0)))
    return [s for s in sinks if s.channel is not None or s.rows.any()]


def _powers(sinks: list[Sink], sizes: list[int], rows: Array) -> Array:
    """Power (samples, sinks) from the recorded channels."""
    power = np.zeros((len(rows), len(sinks)))
    at = 0
    for k, (sink, size) in enumerate(zip(sinks, sizes, strict=True)):
        own = rows[:, at : at + size]
        power[:, k] = own[:, 0] if sink.channel is not None else (own**2).sum(axis=1)
        at += size
    return power
