"""Where a running application turns energy into heat."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.march import March
from bearingdyn.analysis.march_pieces import ended, pieces
from bearingdyn.analysis.recordable_channels import CoreChannel
from bearingdyn.application import Application
from bearingdyn.checks import one_speed
from bearingdyn.material import is_volume
from bearingdyn.progress import Progress, told
from bearingdyn.system import System, factor
from bearingdyn.types import Array
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


# steps whose powers are held at once
PIECE = 2000


@dataclass(frozen=True, eq=False)
class Sink:
    """One place of dissipation: its power is Σ (rows v)², or the core's own channel of it."""

    name: str
    rows: Array
    channel: tuple[int, int, int] | None = None

    def channels(self) -> list[CoreChannel]:
        """What the core must record for it."""
        if self.channel is None:
            return [(core.CHANNEL_KINDS["velocity"], row, 0, 0) for row in self.rows]
        kind, bearing, index = self.channel
        return [(kind, None, bearing, index)]


@takes(speed=("s", "rad/s"), dt="s", memory="s")
def dissipation(
    source: Equilibrium | Application,
    *,
    speed: float | tuple[ArrayLike, ArrayLike] | None = None,
    dt: float,
    steps: int,
    settle: int = 0,
    scheme: core.Scheme | None = None,
    memory: float | None = None,
    progress: Progress | bool | None = None,
    rpm: float | tuple[ArrayLike, ArrayLike] | None = None,
) -> xarray.Dataset:
    """Find what an application dissipates: march as `transient`, and sum what becomes heat, and where.

    Viscous damping loses ẋᵀCẋ. The shear of a viscoelastic part, "layer (shear)", loses what the dashpots of
    its branches and its η0 lose; a bearing what its contacts lose. Powers are summed by the trapezoidal rule
    over the last `steps` steps (without `settle` all but the first), as in the audit of `transient`: the
    entries are the parts of its linear, branch and contact losses, and of that of the branch by which a layer
    softens (not of what breaks in it while the amplitude grows). The loss of a part whose damping turns
    with the shaft is that of its motion in the fixed frame.

    Parameters
    ----------
    source
        Equilibrium, or an application, whose equilibrium is found first.
    speed, dt, steps, settle, scheme, memory, progress, rpm
        As in `transient`; at least one step.

    Returns
    -------
    xarray.Dataset
        Over "part": energy, J, and power, its mean, W. Attribute `complete` is 0 where the march did not
        reach its end.

    Raises
    ------
    ValueError
        As `transient`; also for a system, which no longer says what its bearings lose once linearised.
    SolverError, Interrupted
        As `transient`; `partial` is the Dataset up to there.
    """
    given: object = source
    if isinstance(given, System):
        raise ValueError(
            f"source is {given!r}; pass the application or bd.equilibrium(app): a linearised system no "
            f"longer says what its bearings lose"
        )
    march = March.of(
        source,
        speed=one_speed(speed, rpm),
        dt=dt,
        steps=steps,
        settle=settle,
        scheme=scheme,
        memory=memory,
        least_steps=1,
    )
    march.warn_if_still()
    losing = sinks(march.modal)
    channels = [sink.channels() for sink in losing]
    model = march.model([channel for own in channels for channel in own])
    dt, sizes = march.stepping.dt, [len(own) for own in channels]

    state = march.start(model)
    energy, last, done = np.zeros(len(losing)), np.zeros((0, len(losing))), 0
    # the power of the last state before the record is the first that counts
    with told(progress, "step") as tell:
        for rows, _, report in pieces(
            march, model, state, start=True, size=PIECE, keep_settled=True, progress=tell
        ):
            power = np.vstack([last, _powers(losing, sizes, rows)])
            if len(power):
                energy += dt * (power.sum(axis=0) - 0.5 * (power[0] + power[-1]))
            last, done = power[-1:], done + report.steps

    from bearingdyn.results import dataset, inputs_of

    counted = max(done - march.settle, 0)
    duration = dt * max(counted if march.settle else counted - 1, 1)
    result = dataset(
        {
            "energy": ("part", energy, "J", "energy turned into heat"),
            "power": ("part", energy / duration, "W", "its mean power"),
        },
        {
            "analysis": "dissipation",
            "dt": dt,
            "settle": march.settle,
            "steps": counted,
            "complete": int(report.status == 0),
            "status": report.text,
            **inputs_of(march.system.inputs),
        },
        {"part": ([s.name for s in losing], "")},
    )
    return ended(march, result, replace(report, steps=done))


def sinks(system: System) -> list[Sink]:
    """All places of dissipation in a system, in its own coordinates."""
    none = np.zeros((0, system.n))
    found = []
    layer = 0
    for part in system.parts:
        found.append(Sink(part.name, factor(np.asarray(part.element.C)).T @ part.place))
        for _ in part.element.viscoelastic:
            term = system.layers[layer]
            eta0 = float(getattr(term.material, "eta0", 0.0))
            name = f"{part.name} ({'volume' if is_volume(term.material) else 'shear'})"
            found.append(Sink(name, none, (core.CHANNEL_KINDS["branch_loss"], 0, layer)))
            if eta0 > 0.0:
                found.append(Sink(f"{part.name} (shear, η0)", math.sqrt(2.0 * eta0) * term.L.T))
            layer += 1
    for spring in system.springs:
        found.append(Sink(spring.name, np.sqrt(spring.damping)[:, None] * spring.across))
    for k, hung in enumerate(system.bearings):
        found.append(Sink(hung.name, none, (core.CHANNEL_KINDS["contact_loss"], k, 0)))
    return [s for s in found if s.channel is not None or s.rows.any()]


def _powers(sinks: list[Sink], sizes: list[int], rows: Array) -> Array:
    """Power (samples, sinks) from the recorded channels."""
    power = np.zeros((len(rows), len(sinks)))
    at = 0
    for k, (sink, size) in enumerate(zip(sinks, sizes, strict=True)):
        own = rows[:, at : at + size]
        power[:, k] = own[:, 0] if sink.channel is not None else (own**2).sum(axis=1)
        at += size
    return power
