"""The nonlinear transient at speed: Maxwell history, Newmark, Newton on the balls (paper section 4.2)."""

from __future__ import annotations

import inspect
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.analysis.abreast import Gathering
from bearingdyn.analysis.equilibrium import Equilibrium, equilibrium
from bearingdyn.analysis.march import March
from bearingdyn.analysis.march_pieces import ended, energies_of, run
from bearingdyn.analysis.overload import warn_of_overload
from bearingdyn.analysis.record_memory import check_room
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.analysis.step_size import step_error_made
from bearingdyn.application import Application
from bearingdyn.checks import (
    instance,
    items,
    meant,
    name_list,
    named,
    number,
    one_speed,
    require,
    truth,
    whole,
)
from bearingdyn.progress import Progress, told
from bearingdyn.results import march_dataset
from bearingdyn.system import Contacts, System
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

    from bearingdyn.analysis.steady import Approaches


@takes(speed=("s", "rad/s"), dt="s", memory="s")
def transient(
    source: Equilibrium | Application | System,
    *,
    speed: float | tuple[ArrayLike, ArrayLike] | None = None,
    dt: float,
    steps: int,
    record: Sequence[str],
    decimate: int = 1,
    filter: bool = True,
    settle: int = 0,
    initial: Mapping[str, ArrayLike] | xarray.Dataset | None = None,
    resume: xarray.Dataset | None = None,
    stream: str | os.PathLike[str] | None = None,
    audit: bool = False,
    check_step: bool = False,
    check_unique: bool = False,
    scheme: core.Scheme | None = None,
    memory: float | None = None,
    method: str = "newmark",
    contacts: Contacts = "viscous",
    progress: Progress | bool | None = None,
    rpm: float | tuple[ArrayLike, ArrayLike] | None = None,
) -> xarray.Dataset:
    """Find a transient: march an application from its equilibrium, at constant speed or through a run-up.

    Parameters
    ----------
    source
        Equilibrium: the march starts there, at rest, with relaxed layers. Application: its equilibrium is
        found first. System: the march starts at zero.
    speed
        Speed of the shaft, rad/s: one number, or (times in s, speeds), linear between and held outside. Cage,
        unbalance and gyroscopic forces follow it; rotating loads also push along with its rate. The shaft's
        angle is ∫Ω dt from t = 0, where it is 0, wherever the times lie. The scheme is of second order in dt
        through knots on and between steps.
    dt, steps
        Time step in s, and how many steps are recorded. What drives the march needs twenty steps a period:
        `CoarseStep` warns of a wave, a passage, a pit or a load that has fewer. What answers counts as well:
        a frequency ω comes out (ωΔt)²/12 short, and 2.5 µs leave 1 % of the velocities to 4.7 kHz and 6 % to
        9.4 kHz in the example motor.
    record
        Channels: "shaft.left.y" (displacement), "shaft.left.y.velocity", "….acceleration"; of a bearing:
        "left.loaded" (number of loaded balls), "left.ball3" (load of one ball, counted from 1),
        "left.force.x" (force of the inner ring on the balls, x, y or z), "left.loss" (power that its
        contacts turn into heat); of a part that softens "layer.strain", its running strain amplitude; of a
        flexible ring "ring.raceway.radial-cos2", a coefficient of its race, or "ring.raceway.axial@-90", the
        race at an azimuth in whole degrees.
        Motions are relative to the ground where `Application.base_motion` moves it.
    decimate
        Every how many steps a sample is kept.
    filter
        Whether channels are low-passed before samples are dropped, so that nothing above the new Nyquist
        frequency 1/(2 decimate dt) is folded into the record: level within 0.1 % to 0.8 of it, 80 dB down
        from it on, no phase. A sample looks 26.5·decimate steps back and as many ahead; the march goes on
        beyond its end for that, and before its start the first step is held. Numbers of loaded balls are
        sampled as they are; the force of a ball that loses contact may ring below zero. False: every
        channel is sampled as it is.
    settle
        Steps marched before the record begins, so that the ring-down of the start has passed.
    initial
        Displacement (6,) or (3,) of interfaces or outputs at the start, instead of the equilibrium's; or a
        result of `steady_state` on the same source and at the same speed: the march begins in that motion,
        and so does what films remember.
    resume
        Result of an earlier call on the same application; the march continues where it ended, bit for bit.
        Speed, dt and record may differ; where dt, decimate or record do, and where the result was opened
        from a run file, a filter begins anew.
    stream
        File to which channels and states are written while the march runs; every chunk is checked and on the
        disk before the next begins. A file whose march was killed at any moment holds every finished chunk:
        `bearingdyn.open_result` opens it, and the same call continues from there, bit for bit.
    audit
        Whether energies and works are integrated; they become attributes "energy_…", J, NaN where a march
        that diverged made them overflow.
    check_step
        Whether 2000 steps beyond the end are marched twice, with dt and with dt/2 (6000 steps in all), to
        estimate what dt leaves: attribute `step_error`, one number per channel, relative to its own rms about
        its mean, and `step_error_made`, which says how. Phases of free swings that part within the stretch
        count; what had built up before it does not.
    check_unique
        Whether, at constant speed, other steady motions are looked for: `stable_motion` (motion, channel)
        then holds the peak to peak of each stable one that a run-up from 0.75 or a coast-down from 1.6 times
        the speed leads to (`speed_map` says more), and attribute `stable_motions` their number. Two or more:
        which of them a march ends on depends on its start. For machines with one base frequency alone:
        perfect bearings without unbalance, or one harmonic load.
    scheme
        β, γ, tolerance, iterations and instruction set.
    memory
        Time, s, over which layers with a law of softening (`Maxwell.payne`) remember the amplitude of their
        strain: one to ten periods of the slowest motion that counts. None: five of the slowest of shaft and
        harmonic loads. One tone then meets the modulus of `frequency_response` at that amplitude, each of
        several a modulus off by 0.1 % or so, beside the error of the step, which `check_step` tells of these
        layers as of others. A lasting load does not count as amplitude; under strong vibration it sags, as
        the spring that bears a part of it breaks.
    method
        "newmark", the paper's, or "exact": at a constant speed structure, gyroscopic forces and layers move
        in modes of their own, without an error of the step; what is left is that the bearing forces are held
        as a cubic through four steps' ends (`Scheme.hold`), contacts that close or open within two steps by
        what the sum over steps should see. Of the same error it takes some ten times fewer steps. A constant,
        harmonic or rotating load is exact, a table is linear from step to step. It does not take a speed that
        varies, nor layers with a law of softening; `scheme`'s β and γ do not count. Unlike Newmark's it is
        stable for small steps alone: what balls alone hold at ω does not grow while ωΔt < 2.3, what they hold
        in part while ωΔt < 1.3, and some 1e-4 a step there and beyond, against its damping; `GrowingStep`
        warns of it.
    contacts
        How lubricated contacts answer (`BallBearing(lubrication=…)`): "viscous", by the damping that holds at
        low frequency, or "film": the oil carries what was pressed at the inlet through the contact, so that
        the answer of `frequency_response` with contacts="film" holds in time, K(ω) and c(ω), at the mean load
        of the loaded balls; under others damping follows the load and the course over frequency stays. Films
        become thinner under load, which makes contacts softer by one part in fifty or so. Of the speed at
        which they were lubricated, in a run-up too. They begin as films of balls that have always turned past
        what stands, at the place where they then rest, some nanometres from the equilibrium.
    progress
        True for a bar, False for none, or a function called with (steps done, steps in all); None for a bar
        where standard error is a terminal.
    rpm
        The speed in revolutions a minute, instead of `speed`: one number, or (times in s, rpm).

    Returns
    -------
    xarray.Dataset
        record (time, channel), and state, from which `resume` continues. Attribute `complete` is 0 where the
        march did not reach its end; `system_hash` tells which system the state belongs to.

    Raises
    ------
    ValueError
        Before any long work: for dt ≤ 0, negative steps, a record that the memory cannot hold, an unknown
        channel, a part that would turn although its damping is known at rest only, the state of another
        application, `check_unique` of a run-up or of several base frequencies, contacts="film" where no
        bearing runs on films or one is so thick that it follows the load.
    SolverError
        When Newton's iteration diverges or the response is no longer finite; its `partial` is the Dataset up
        to there.
    Interrupted
        On Ctrl-C; its `partial` likewise.
    OSError
        Where `stream` cannot be written; what was on the disk stays.

    Warns
    -----
    CoarseStep
        Where something that drives the march, or a swing that `initial` lets go, has fewer than twenty steps
        a period.
    BearingWarning
        Where a contact pressure was above 4.2 GPa (ISO 76) at the end of a step.
    NothingPushes
        Where the march starts at rest, no ball is pressed and no load acts.
    OpenSideWarning
        Where balls of an angular contact bearing were pressed onto its open side, or none onto its shoulder.

    References
    ----------
    Paper section 4.2.

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
    """
    record = name_list("record", record)
    places: Mapping[str, ArrayLike] | None = None
    motion: xarray.Dataset | None = None
    if isinstance(initial, Mapping) and "motion" in initial:
        motion = cast("xarray.Dataset", initial)
    elif initial is not None:
        places = named("initial", initial, "it must be displacements by place, as {'shaft.left': [...]}")
    if stream is not None:
        instance("stream", stream, (str, os.PathLike), "it must be the path of a file")
    if resume is not None and stream is not None:
        raise ValueError(
            "resume and stream are both given; a stream continues by itself, so give one of them"
        )
    if resume is not None and (places or motion is not None):
        raise ValueError("resume and initial both set the state at the start; give one of them")
    filter, audit = truth("filter", filter), truth("audit", audit)
    check_step, check_unique = truth("check_step", check_step), truth("check_unique", check_unique)
    speed = one_speed(speed, rpm)
    if isinstance(source, Application):
        source = equilibrium(source)
    march = March.of(
        source,
        speed=speed,
        dt=dt,
        steps=steps,
        settle=settle,
        decimate=decimate,
        filter=filter,
        audit=audit,
        scheme=scheme,
        memory=memory,
        method=method,
        contacts=contacts,
    )
    if check_unique and contacts == "film":
        raise ValueError(
            "check_unique looks for steady motions on viscous contacts, and contacts is 'film'; leave one out"
        )
    if resume is None and not initial:
        march.warn_if_still()
    approaches = _approaches(source, speed) if check_unique else None
    check_room(march.steps // march.decimate, record)
    found = [channel_of(march.modal, name) for name in record]
    model = march.model([channel for channel, _ in found])
    if resume is not None:
        state = march.resumed(model, resume)
    elif motion is not None:
        from bearingdyn.analysis.steady import beginning

        begun = beginning(source, motion, speed, contacts)
        if contacts == "film" and isinstance(source, Equilibrium):  # about where its films let it rest
            begun = replace(begun, x=begun.x + (march.x - source.x))
        state = march.begun(model, begun)
    else:
        if places:
            march.warn_if_start_is_coarse(source, places, record)
        state = march.start(model, places)
    facts = march.facts(record, [unit for _, unit in found])
    with told(progress, "step") as tell:
        rows, state, report, tail = run(
            march,
            model,
            state,
            start=resume is None,
            progress=tell,
            stream=stream,
            header=facts if stream is None else {**facts, "digest": march.digest(state)},
            plain=np.array([channel[0] == core.CHANNEL_KINDS["loaded"] for channel, _ in found], dtype=bool),
            past=None if resume is None else march.past(resume, record),
        )
    warn_of_overload(march, report)
    energies = energies_of(model, state) if audit else {}
    error: dict[str, Any] = {}
    if check_step and report.status == 0:
        made = step_error_made(method, march.stepping.scheme.hold)
        error = {"step_error": march.step_error(model, state), "step_error_made": made}
    result = march_dataset(
        facts, rows, state, report, {f"energy_{k}": v for k, v in energies.items()} | error
    )
    if tail is not None:
        result["tail"] = (("tap", "channel"), tail, {"long_name": "last steps, from which a filter goes on"})
    if approaches is not None:
        swings = approaches.swings(record)
        meaning = {"units": "", "long_name": "peak to peak of each stable motion; units in `unit`"}
        result["stable_motion"] = (("motion", "channel"), swings, meaning)
        result.attrs["stable_motions"] = len(swings)
    return ended(march, result, report)


def _approaches(source: Equilibrium | Application | System, speed: object) -> Approaches:
    """What looks for steady motions; ValueError for a run-up."""
    from bearingdyn.analysis.steady import Approaches

    constant = number("check_unique with speed", speed, "it must be one finite speed, rad/s: no run-up")
    return Approaches(source, constant)


def transients(
    cases: Sequence[Mapping[str, Any]],
    threads: int | None = None,
    *,
    progress: Progress | bool | None = None,
) -> list[xarray.Dataset]:
    """Many transients at once: over threads, and within each up to eight side by side.

    Cases that share their structure (matrices, layers, step and constant speed, to the bit) and differ in
    clearance, preload, loads, waviness, phase or start are marched side by side, which takes a core some 0.7
    of the time. Every result is that of `transient` to the bit, whichever cases are beside it.

    Parameters
    ----------
    cases
        Of each march the arguments of `transient` by name, `source` too.
    threads
        How many cores march at a time; by default as many as there are. Marches with an audit, exact steps, a
        run-up or layers that soften go one after another on each.
    progress
        True for a bar, False for none, or a function called with (marches done, marches in all); None for a
        bar where standard error is a terminal. The marches themselves show none.

    Returns
    -------
    list of xarray.Dataset
        As `transient` returns them, in the order of the cases.

    Raises
    ------
    Exception
        What the first failing case, in their order, raised; after all have ended.
    ValueError
        Before, for cases that are no mappings.
    """
    from concurrent.futures import ThreadPoolExecutor, as_completed

    if threads is not None:
        threads = whole("threads", threads, 1)
    remedy = "it must be a list of mappings, each the arguments of `transient` by name"
    asked = [named(f"cases[{k}]", case, remedy) for k, case in enumerate(items("cases", cases, remedy))]
    known = inspect.signature(transient).parameters
    for k, case in enumerate(asked):
        for name in case:
            require(
                name in known, f"cases[{k}]", name, f"it is no argument of transient; {meant(name, known)}"
            )
        for name in ("source", "dt", "steps", "record"):
            require(name in case, f"cases[{k}]", sorted(case), f"it lacks {name}")
    gathering = Gathering(len(asked), threads or os.cpu_count() or 1)
    with (
        told(progress, "march") as tell,
        ThreadPoolExecutor(max(gathering.members, 1)) as pool,
    ):
        marches = [
            pool.submit(gathering.member, partial(transient, **{"progress": False, **case})) for case in asked
        ]
        for done, _ in enumerate(as_completed(marches), 1):
            if tell is not None:
                tell(done, len(marches))
    return [march.result() for march in marches]
