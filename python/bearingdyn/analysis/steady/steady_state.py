"""The steady motion at one speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.recordable_channels import channel_of
from bearingdyn.analysis.softening import layer_names, warn_of_strain
from bearingdyn.analysis.steady.balance import Balance, Found, newton
from bearingdyn.analysis.steady.borne import warn_of_band, warn_of_motions
from bearingdyn.analysis.steady.choosing import balanced
from bearingdyn.analysis.steady.cut_harmonics import CUT, cut_off, share_cut, warn_of_cut
from bearingdyn.analysis.steady.motion import Motion
from bearingdyn.analysis.steady.problem import Problem, motion_of
from bearingdyn.analysis.steady.stability import Stability, stability_of
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.application import Application
from bearingdyn.checks import name_list, number, one_of, one_speed, positive, require, whole
from bearingdyn.notice import CutHarmonics, OutsideBand, untold, warn
from bearingdyn.system import Contacts, System
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

# harmonics where none are asked for: of the ball pass, or of the highest of several bases
HARMONICS, SEVERAL = 40, 20
# what may be asked: the waves of a ball pass are some tens; of one balance in memory
MOST_HARMONICS, MOST_SUBHARMONIC, MOST_BYTES = 2000, 64, 8e9


@takes(speed="rad/s")
def steady_state(
    source: Equilibrium | Application | System,
    *,
    speed: float | None = None,
    record: Sequence[str],
    harmonics: int | None = None,
    subharmonic: int = 1,
    start: xarray.Dataset | None = None,
    stability: bool = True,
    tolerance: float = 1e-11,
    rpm: float | None = None,
    contacts: Contacts = "viscous",
) -> xarray.Dataset:
    """Find the steady motion at one speed, and whether it is stable, without marching to it.

    The motion is a sum of lines, Σ Re z_n e^{iω_n t}, whose amplitudes balance at every line; the structure
    answers with G*(ω) of any law, the balls are pressed in time; films of oil have their damping of low
    low frequency, as in a march, unless `contacts` says otherwise. Layers with a law of softening
    (`Maxwell.payne`) soften with their own motion: the strain of each, of all its lines without the mean, is
    found with them, and a lasting load sinks as in a march. Of two steady motions at one speed it finds
    the one near its start; `speed_map` follows them all.

    Parameters
    ----------
    source
        Equilibrium, whose bearings give the start; an application, whose equilibrium is found first; or a
        system, whose layers may have laws that an application does not take.
    speed
        Of the shaft, rad/s; not zero.
    record
        Channels as in `transient`.
    harmonics
        Of the base frequency, 1 or more; 40 by default. The base is the ball pass, and the cage's turn where
        a standing ring has waves or pits. The motion of a machine with unbalance, waviness, pits,
        unequal balls or harmonic loads has several base frequencies (shaft, cage, ball spin); its lines up to
        this harmonic (20 by default) are chosen by how far they would move the bearings, and refined.
    subharmonic
        p: the motion may repeat after p ball passages only.
    start
        An earlier result on the same application, to begin from.
    stability
        Whether multipliers are computed, of a motion with one base.
    tolerance
        Of the balance, relative to the largest amplitude.
    rpm
        The speed in revolutions a minute, instead of `speed`.
    contacts
        How lubricated contacts answer: "viscous", by the tangents that hold at low frequency, or "film",
        with what their stiffness and damping at each line's frequency have besides, at the loads that the
        balls carry at rest. Stability is always that of viscous contacts.

    Returns
    -------
    xarray.Dataset
        amplitude (line, channel), complex, zero-to-peak, at frequency (line,), Hz, line 0 the mean; index
        (line, base) how often each base frequency stands in it; record (time, channel) over a period, so that
        `contact_statistics`, `orbit` and `spectrum` take the result; cut (channel,) what the harmonics next
        above the last would add; power (part,), W, what each part turns into heat, and supply (source,), W,
        what feeds it; multipliers (multiplier,), complex, of departures about which the layers keep the
        amplitude of the motion; strain (layer,), the shear strain amplitude of each layer that softens;
        motion (line, coefficient), from which `start` goes on. Attributes: stable (1, 0, or −1 where it was
        not computed), multiplier (largest size), growth (1/s), loss ("fold", "flip" or "neimark-sacker": what
        the largest multiplier brings where it leaves the unit circle), residual, energy_balance (what supply
        and power leave, relative), lines_left (the share of the largest line that was left out, of several
        bases and up to twice the harmonics asked).

    Raises
    ------
    ValueError
        Before any work: for a speed of zero or one at which no base frequency is left, for sampled loads, a
        subharmonic of several bases, an unknown channel, a law without a modulus at rest under a dead load.
    SolverError
        Where the balance is not found: names the speed, the line and its residual; `partial` is the nearest
        state that was.

    Warns
    -----
    BearingWarning
        Where the contact pressure of a ball exceeds 4.2 GPa (ISO 76) in the motion.
    OpenSideWarning
        Where balls of an angular contact bearing are pressed where it has no shoulder, or none onto it.
    NothingPushes
        Where no ball is pressed, and no load acts.
    CutHarmonics
        Where the harmonics next above the last would add more than 2 % of a channel's largest line; of
        several bases, where a line that would be 2 % of the bearings' largest was left out.
    BeyondSweep
        Where a layer's strain leaves the sweep its law of softening comes from.
    OutsideBand
        Where a line that counts in a layer's motion lies outside the band of its material.

    References
    ----------
    T. M. Cameron and J. H. Griffin, J. Appl. Mech. 56 (1989) 149.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    >>> app.unbalance("mass.centre", 1e-6)
    >>> ss = bd.steady_state(app, speed=500.0, record=["mass.centre.y"])
    >>> f"{abs(ss['amplitude'].values[1, 0]):.4e}"  # m: Ω² u/|k − Ω² m + iΩc|
    '3.3330e-07'
    """
    record = name_list("record", record, least=1)
    speed = number(
        "speed",
        one_speed(speed, rpm),
        "it must be one finite speed in rad/s; for a run-up march with bd.transient",
    )
    require(
        speed != 0.0,
        "speed",
        speed,
        "at rest nothing passes and the base frequency is zero; give the speed of the shaft in rad/s, or "
        "take bd.equilibrium",
    )
    subharmonic = whole("subharmonic", subharmonic, 1, MOST_SUBHARMONIC)
    positive("tolerance", tolerance)
    remedy = "it is the residual of the balance over the largest force: at most 1e-3"
    require(tolerance <= 1e-3, "tolerance", tolerance, remedy)
    if harmonics is not None:
        harmonics = whole("harmonics", harmonics, 1, MOST_HARMONICS)
    one_of("contacts", contacts, ("film", "viscous"))
    problem = Problem.of(source, subharmonic, contacts)
    problem.system.check_speed(speed)
    channels = [channel_of(problem.system, name) for name in record]
    # of the lines that are tried, few move a layer; those are told of below
    with untold(OutsideBand):
        balance, found, left = _found(problem, speed, harmonics, subharmonic, start, tolerance)
        state = stability_of(problem, balance, found) if stability and found.converged else None
        several = len(problem.bases.bases) > 1
        asked: dict[str, float | str] = {
            "harmonics": harmonics or (SEVERAL if several else HARMONICS),
            "subharmonic": subharmonic,
            "lines_left": left,
            **({} if contacts == "viscous" else {"contacts": contacts}),
        }
        motion = Motion(balance, found)
        result = _dataset(problem, motion, record, channels, state, asked)
    if not found.converged:
        raise _failed(problem, balance, found, result)
    _warn_of_cut(result, f"the steady motion at {speed:g} rad/s", result.attrs["harmonics"])
    warn_of_band(problem.system, balance.omega, motion.x)
    if balance.receptances.soft.layers:
        warn_of_strain(problem.system, found.pressed.softened.strain[:, None])
    warn_of_motions([(balance, found.z, f"in the steady motion at {speed:g} rad/s", found.pressed)])
    return result


def _found(
    problem: Problem,
    speed: float,
    harmonics: int | None,
    subharmonic: int,
    start: xarray.Dataset | None,
    tolerance: float,
) -> tuple[Balance, Found, float]:
    """The balance, its motion, and what share of it the lines left out are."""
    begun = None if start is None else motion_of("start", problem, start)
    if len(problem.bases.bases) > 1:
        return balanced(problem, speed, harmonics or SEVERAL, tolerance, begun)
    count = (harmonics or HARMONICS) * subharmonic
    n, unknowns = problem.system.n, (2 * count + 1) * len(problem.rest)
    needed = max(8.0 * unknowns**2, 16.0 * count * n**2)
    remedy = f"with {unknowns} unknowns the balance would take {1e-9 * needed:.3g} GB; give fewer"
    require(needed <= MOST_BYTES, "harmonics times subharmonic", count, remedy)
    lines = Lines.harmonics(count)
    # what all coordinates answer comes with what the bearings do
    balance = problem.balance(lines, speed, np.eye(problem.system.n))
    if begun is not None:
        own = Lines(begun[0], lines.steps, lines.samples)
        z = own.moved(begun[1], lines, 1)
        return balance, newton(balance, z, tolerance=tolerance), math.nan
    found = newton(balance, problem.standing(lines), tolerance=tolerance)
    if not found.converged:
        from bearingdyn.analysis.steady.reaching import reached

        found = reached(problem, lines, speed, tolerance) or found
    return balance, found, math.nan


def _warn_of_cut(result: xarray.Dataset, what: str, harmonics: int) -> None:
    """Warn (CutHarmonics) of the line, and of the channel, of a steady state that misses most."""
    left = float(result.attrs["lines_left"])
    if left > CUT:
        warn(
            f"{what} wants more than {harmonics} harmonics: a line of {left:.0%} of the largest was left "
            "out; give more harmonics",
            CutHarmonics,
        )
    cut = result["cut"].values
    share = share_cut(result["amplitude"].values, cut)
    c = int(np.argmax(share))
    about = result.isel(channel=c)
    warn_of_cut(what, harmonics, str(about["channel"].values), share[c], cut[c], str(about["unit"].values))


def _failed(problem: Problem, balance: Balance, found: Found, result: xarray.Dataset) -> core.SolverError:
    n = balance.lines.index[found.line]
    names = (
        " ".join(f"{k:+d} × {b.name}" for k, b in zip(n, problem.bases.bases, strict=True) if k) or "the mean"
    )
    rpm = balance.speed * 30 / np.pi
    return core.SolverError(
        f"no steady motion was found at {balance.speed:g} rad/s ({rpm:g} rpm): line {found.line} ({names}, "
        f"{balance.omega[found.line] / (2 * np.pi):.4g} Hz) misses its balance by {found.residual:.2g} of "
        f"the largest amplitude after {found.iterations} iterations; begin from a neighbour with start=, "
        f"or ask for more harmonics",
        core.Report(status=core.NO_CONVERGENCE, iterations=found.iterations, residual=found.residual),
        result,
    )


def _dataset(
    problem: Problem,
    motion: Motion,
    record: Sequence[str],
    channels: Sequence[tuple[tuple[int, object, int, int], str]],
    state: Stability | None,
    attrs: dict[str, float | str],
) -> xarray.Dataset:
    from bearingdyn.results import dataset, inputs_of

    balance, found = motion.balance, motion.found
    asked = [c for c, _ in channels]
    amplitude = motion.amplitudes(asked)  # type: ignore[arg-type]
    times = motion.times()
    rows = motion.signals(asked, amplitude, times)  # type: ignore[arg-type]
    fed, lost = motion.powers()
    through = sum(abs(v) for v in (*fed.values(), *lost.values()))
    missed = sum(fed.values()) - sum(lost.values())
    dt = float(times[1] - times[0]) if len(times) > 1 else 0.0
    multipliers = np.zeros(0, dtype=np.complex128) if state is None else state.multipliers
    strains: dict[str, Any] = {}
    if balance.receptances.soft.layers:
        meaning = "shear strain amplitude of each layer that softens, of all lines"
        strains["strain"] = ("layer", found.pressed.softened.strain, "1", meaning)
    return dataset(
        {
            "amplitude": (
                ("line", "channel"),
                amplitude,
                "",
                "complex amplitudes, zero-to-peak; their units are in `unit`",
            ),
            "frequency": ("line", balance.omega / (2 * np.pi), "Hz", "frequency of each line"),
            "index": (("line", "base"), balance.lines.index, "1", "how often each base stands in it"),
            "base_frequency": (
                "base",
                problem.bases.frequencies(balance.speed) / (2 * np.pi),
                "Hz",
                "base frequencies",
            ),
            "record": (("time", "channel"), rows, "", "channels over time; their units are in `unit`"),
            "cut": (
                "channel",
                cut_off(balance, found.z, asked, found.pressed),  # type: ignore[arg-type]
                "",
                "amplitude of the lines next above the last",
            ),
            "power": ("part", np.array(list(lost.values())), "W", "mean power turned into heat"),
            "supply": ("source", np.array(list(fed.values())), "W", "mean power that feeds the motion"),
            "multipliers": ("multiplier", multipliers, "1", "Floquet multipliers of a period, largest first"),
            "motion": (
                ("line", "coefficient"),
                found.z,
                "m",
                "coefficients of bearings, and of layers that soften",
            ),
            **strains,
        },
        {
            "analysis": "steady state",
            "speed": balance.speed,
            "dt": dt,
            "decimate": 1,
            "stable": -1 if state is None else int(state.stable),
            "multiplier": math.nan if state is None else abs(state.largest),
            "growth": math.nan if state is None else state.growth,
            "loss": "" if state is None else state.loss,
            "residual": found.residual,
            "iterations": found.iterations,
            "converged": int(found.converged),
            "energy_balance": abs(missed) / through if through > 0.0 else 0.0,
            **attrs,
            **state_of(problem.source),
            **inputs_of(problem.system.inputs),
        },
        {
            "channel": (list(record), ""),
            "base": ([b.name for b in problem.bases.bases], ""),
            "time": (times, "s"),
            "part": (list(lost), ""),
            "source": (list(fed), ""),
            "unit": ("channel", [unit for _, unit in channels], "", "unit of each channel"),
            **({"layer": (layer_names(problem.system), "")} if strains else {}),
        },
    )
