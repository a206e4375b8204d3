"""The nonlinear transient at speed: Maxwell history, Newmark, Newton on the balls (paper section 4.2)."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.running import digest, run
from bearingdyn.application import Application
from bearingdyn.bearing import ConstantDamping
from bearingdyn.bearing.raceway_series import NET
from bearingdyn.results import march_dataset
from bearingdyn.system import QUANTITIES, RATES, System, is_rotation
from bearingdyn.types import Array

if TYPE_CHECKING:
    import xarray

Channel = tuple[int, Array | None, int, int]


def transient(
    source: Equilibrium | Application | System,
    *,
    speed: float | tuple[ArrayLike, ArrayLike],
    dt: float,
    steps: int,
    record: Sequence[str],
    decimate: int = 1,
    settle: int = 0,
    initial: Mapping[str, ArrayLike] | None = None,
    resume: xarray.Dataset | None = None,
    stream: str | os.PathLike[str] | None = None,
    audit: bool = False,
    scheme: core.Scheme | None = None,
    progress: core.Progress | None = None,
) -> xarray.Dataset:
    """March an application from its equilibrium, at constant speed or through a run-up.

    Parameters
    ----------
    source
        Equilibrium: the march starts there, at rest, layers relaxed. Of an Application the equilibrium is
        found first. A System starts from zero.
    speed
        Speed of the shaft, rad/s: one number, or (times in s, speeds), linear between and held outside. Cage,
        unbalance and gyroscopic forces follow it; rotating loads also push along with its rate.
    dt, steps
        Step in s and number of steps recorded from.
    record
        Channels: "shaft.left.y" (displacement), "shaft.left.y.velocity", "….acceleration"; of a bearing:
        "left.loaded" (number of loaded balls), "left.ball3" (its load, balls from 1), "left.force.x"
        (force of the inner ring on the balls, x, y or z), "left.loss" (power its contacts turn into heat).
        Motions are relative to the ground where `Application.base_motion` moves it.
    decimate
        Every how many steps a sample is kept; plain sampling, no filter.
    settle
        Steps marched before and thrown away, so that the ring-down of the start has passed.
    initial
        Displacement (6,) or (3,) of interfaces or points at the start, instead of the equilibrium's.
    resume
        Result of an earlier call on the same application: goes on where it ended, bit for bit.
    stream
        File on which channels and states are put while the march runs, every chunk checked and on the disk
        before the next. Killed at any moment, it holds every finished chunk; `bearingdyn.open_result` opens
        it, and the same call goes on from there, bit for bit.
    audit
        Integrate energies and works; they come as attributes "energy_…", J.
    scheme
        β, γ, tolerance, iterations and instruction set; its dt, speed and audit are replaced.

    Returns a Dataset with record (time, channel), and state, from which `resume` goes on. Attribute
    complete is 0 where the march did not reach its end.

    Raises
    ------
    ValueError
        For dt ≤ 0, negative steps, an unknown channel, a damped part that would turn, before any work.
    SolverError
        When Newton's iteration diverges; its `partial` is the Dataset up to there.
    Interrupted
        On Ctrl-C; its `partial` likewise.
    OSError
        Where `stream` cannot be written; what was on the disk stays.

    Examples
    --------
    >>> import numpy as np
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> run = bd.transient(bd.equilibrium(app), speed=0.0, dt=1e-5, steps=1000, record=["mass.centre.y"],
    ...                    initial={"mass.centre": [0, 1e-6, 0, 0, 0, 0]})
    >>> y = run["record"].sel(channel="mass.centre.y")
    >>> bool(np.allclose(y, 1e-6 * np.cos(1000 * y["time"]), atol=1e-9))  # m; √(k/m) is 1000 rad/s
    True

    Reference: paper section 4.2.
    """
    if not (dt > 0 and math.isfinite(dt)):
        raise ValueError(f"dt is {dt}; the time step must be positive, in s")
    for name, value, least in (("steps", steps, 0), ("settle", settle, 0), ("decimate", decimate, 1)):
        if not value >= least or value % 1 != 0:
            raise ValueError(f"{name} is {value}; it must be a whole number of at least {least}")
    if isinstance(record, str):
        raise ValueError(f"record is {record!r}; give a list of channels, [{record!r}]")
    if resume is not None and stream is not None:
        raise ValueError("a stream goes on by itself; give resume or stream, not both")
    if resume is not None and initial:
        raise ValueError("resume goes on from its own state and initial sets another; give one of the two")
    if isinstance(source, Application):
        source = equilibrium(source)
    if isinstance(source, Equilibrium) and source.modulus != "relaxed":
        raise ValueError(
            f"the equilibrium has its layers at their {source.modulus} modulus; a march starts with relaxed "
            f'ones: take equilibrium(app, modulus="relaxed")'
        )
    system = source.system if isinstance(source, Equilibrium) else source
    fastest = checked_speed(speed)
    system.check_speed(fastest)
    modal, T = system.modal()
    channels, units = zip(*(_channel(modal, name) for name in record), strict=True) if record else ((), ())
    model = modal.model(list(channels))
    base = scheme or core.Scheme(dt)
    scheme = core.Scheme(
        dt, base.beta, base.gamma, speed, base.tolerance, base.max_iterations, audit, base.isa
    )

    if resume is not None:
        state, start = np.asarray(resume["state"].values, dtype=np.float64), False
    else:
        x = source.x.copy() if isinstance(source, Equilibrium) else np.zeros(system.n)
        if initial:
            x = _moved(system, x, initial)
        state, start = model.state(0.0, T.T @ system.M @ x, np.zeros(system.n)), True

    facts = {
        "channels": list(record),
        "units": list(units),
        "dt": dt,
        "speed": [part.tolist() for part in scheme.profile],
        "decimate": int(decimate),
        "settle": int(settle),
        "steps": int(steps),
        "inputs": system.inputs,
    }
    header = facts if stream is None else {**facts, "digest": digest(modal, scheme, state)}
    rows, state, report = run(
        model,
        state,
        scheme,
        int(settle),
        int(steps),
        int(decimate),
        start=start,
        progress=progress,
        stream=stream,
        header=header,
    )
    energies = core.energies(model, state) if audit else {}
    result = march_dataset(facts, rows, state, report, {f"energy_{k}": v for k, v in energies.items()})
    if report.status == core.INTERRUPTED:
        raise core.Interrupted(
            f"interrupted at t = {report.t:.6g} s; what was marched is in `partial`", result
        )
    if report.status != 0:
        place = f", worst in bearing {system.bearings[report.bearing].name!r}" if report.bearing >= 0 else ""
        raise core.SolverError(
            f"{report.text} in step {report.steps + 1} at t = {report.t:.6g} s (residual "
            f"{report.residual:.3g} of the largest bearing force{place}); {_remedy(system)}",
            report,
            result,
        )
    return result


def checked_speed(speed: float | tuple[ArrayLike, ArrayLike]) -> float:
    """The largest |speed|; ValueError where the profile is no profile."""
    if not isinstance(speed, tuple):
        return float(speed)
    if len(speed) != 2:
        raise ValueError(f"speed has {len(speed)} parts; give one number, or (times, speeds)")
    times, speeds = (np.atleast_1d(np.asarray(part, dtype=np.float64)) for part in speed)
    if times.shape != speeds.shape or times.ndim != 1 or times.size < 2:
        raise ValueError(
            f"speed has {times.size} times and {speeds.size} speeds; give two or more of each, or one number"
        )
    if not (np.isfinite(times).all() and np.isfinite(speeds).all() and (np.diff(times) > 0).all()):
        raise ValueError("speed: times must increase and all numbers be finite, in s and rad/s")
    return float(np.abs(speeds).max())


def _remedy(system: System) -> str:
    """What helps where Newton's iteration diverges."""
    dampings = [getattr(term.bearing, "damping", None) for term in system.bearings]
    if any(isinstance(d, ConstantDamping) and d.c > 0 for d in dampings):
        return (
            "a constant contact damping makes the force jump where a ball loses contact: give "
            "damping=bd.LoadDamping(...) or bd.TabulatedDamping(...), or try a smaller dt"
        )
    return "try a smaller dt"


def transients(cases: Sequence[Mapping[str, Any]], threads: int | None = None) -> list[xarray.Dataset]:
    """Many marches at once over threads, each case the arguments of `transient` by name (`source` too).

    The marches share nothing and hold no lock; results come in the order of the cases. threads: how many at a
    time, by default as many as there are cores.

    Raises what the first failing case, in their order, raised, after all have ended.

    Returns a list of Datasets as `transient` returns them.
    """
    from concurrent.futures import ThreadPoolExecutor

    if threads is not None and threads < 1:
        raise ValueError(f"threads is {threads}; at least one is needed")
    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        running = [pool.submit(transient, **case) for case in cases]
    return [march.result() for march in running]


def _moved(system: System, x: Array, initial: Mapping[str, ArrayLike]) -> Array:
    """Coordinates nearest to x (n,) that put every place where it is wanted."""
    for name, target in initial.items():
        given = np.asarray(target, dtype=np.float64)
        if given.shape != (len(system.rows(name)),) or not np.isfinite(given).all():
            raise ValueError(
                f"initial[{name!r}] must be {len(system.rows(name))} finite numbers, not {target!r}"
            )
    rows = np.vstack([system.rows(name) for name in initial])
    wanted = np.concatenate([np.asarray(target, dtype=np.float64) for target in initial.values()])
    x = x + np.linalg.pinv(rows) @ (wanted - rows @ x)
    if np.abs(rows @ x - wanted).max() > 1e-9 * np.abs(wanted).max(initial=1e-9):
        raise ValueError(f"initial asks {sorted(initial)} for a motion they cannot make together")
    return x


def _channel(system: System, name: str) -> tuple[Channel, str]:
    """Kind, row, bearing and index of a channel by name, and its unit."""
    bearings = [b.name for b in system.bearings]
    head, _, rest = name.partition(".")
    if head in bearings:
        which = bearings.index(head)
        ball = re.fullmatch(r"ball(\d+)", rest)
        if rest == "loss":
            return (core.CHANNEL_KINDS["contact_loss"], None, which, 0), "W"
        if rest == "loaded":
            return (core.CHANNEL_KINDS["loaded"], None, which, 0), "1"
        if ball and 1 <= int(ball[1]) <= system.bearings[which].bearing.Z:
            return (core.CHANNEL_KINDS["ball"], None, which, int(ball[1]) - 1), "N"
        series = system.bearings[which].series
        term = NET["xyz".index(rest[-1])] if rest in ("force.x", "force.y", "force.z") else None
        if term in series.terms:
            return (core.CHANNEL_KINDS["force"], None, which, series.index(*term)), "N"
        raise ValueError(
            f"channel {name!r}: bearing {head!r} offers loaded, loss, ball1 … "
            f"ball{system.bearings[which].bearing.Z}, force.x, force.y and force.z"
        )
    if rest.startswith(("ball", "force.")) or rest in ("loaded", "loss"):
        raise ValueError(f"channel {name!r}: {head!r} is no bearing; there are {bearings}")
    place, _, quantity = name.rpartition(".")
    if quantity not in QUANTITIES:
        place, quantity = name, "displacement"
    unit = ("rad" if is_rotation(place) else "m") + RATES[quantity]
    return (core.CHANNEL_KINDS[quantity], system.row(place), 0, 0), unit
