"""Whether the step of a march follows what drives it, said before it runs; how far off it was, afterwards."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.driving_periods import rhythms
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.held_forces import held_growth
from bearingdyn.material import answer_of
from bearingdyn.notice import CoarseStep, GrowingStep, OutsideBand, untold, warn
from bearingdyn.system import System, natural
from bearingdyn.types import Array

# most of a period that a step may be: the average acceleration's frequencies are short by (ωΔt)²/12, 0.8 % at
# this share, which grows with its square; measured forced amplitudes are 24 % off at 0.17
SHARE = 0.05
NAMED = 12  # lines of a warning; the fastest come first
GROWN = 0.01  # growth of a mode over a march, as ln of its factor, that is no matter
ORDERS = {2: "second", 3: "third", 4: "fourth"}
HALVINGS = 12  # of the interval in which the largest step is that makes nothing grow
CHECKED = 2000  # steps of the stretch that is repeated at half the step


def warn_if_coarse(system: System, speed: float, dt: float) -> None:
    """Warn of a step size that is too coarse: dt is more than SHARE of the period of something."""
    coarse = [r for r in rhythms(system, speed) if not dt <= SHARE * r.period]
    if not coarse:
        return
    enough = rounded_down(SHARE * coarse[0].period)
    lines = [
        f"  {r.what}: period {r.period:.3g} s, {r.period / dt:.3g} steps a period; "
        f"dt={rounded_down(SHARE * r.period):g} would do"
        for r in coarse[:NAMED]
    ]
    if len(coarse) > NAMED:
        lines.append(f"  and {len(coarse) - NAMED} more, slower ones")
    warn(
        f"dt = {dt:g} s is too coarse for what drives this march at {abs(speed):.6g} rad/s:\n"
        + "\n".join(lines)
        + f"\nmarch with dt={enough:g} or less; check_step=True says how far off the record is",
        CoarseStep,
    )


def warn_if_growing(eq: Equilibrium, dt: float, steps: int, hold: int) -> None:
    """Step size too long for the exact method: warn where a mode grows by what its held forces leave.

    Modes are those of the relaxed structure on the balls' tangents; each gains what the step's recurrence
    says of one that balls hold by its share (`held_growth`).
    """
    system = eq.system
    if not system.bearings:
        return
    B = system.B
    squares, shapes = natural(system.stiffness(system.marched_moduli()) + B.T @ eq.bearing_K @ B, system.M)
    moving = squares > 0.0
    omega, shapes = np.sqrt(squares[moving]), shapes[:, moving]
    z = B @ shapes
    share = np.einsum("ij,ij->j", z, eq.bearing_K @ z) / omega**2
    decay = modal_decays(system, eq.bearing_C, omega, shapes)
    share = np.clip(share, 0.0, 1.0)

    def grown(dt: float) -> tuple[Array, Array]:
        """What modes gain, and what is left of it by their damping, 1/s."""
        gain = held_growth(omega * dt, share, hold) / dt
        return gain, gain - decay

    gain, left = grown(dt)
    worst = int(np.argmax(left))
    if not left[worst] * steps * dt > GROWN:
        return
    # to two digits
    within, beyond = 0.0, dt
    for _ in range(HALVINGS):
        middle = 0.5 * (within + beyond)
        within, beyond = (middle, beyond) if (grown(middle)[1] <= 0.0).all() else (within, middle)
    enough = within
    remedy = (
        f"march with dt={rounded_down(enough):g} or less, or with method='newmark'"
        if enough > 0.0
        else "march with method='newmark', or give the contacts the damping that they have"
    )
    warn(
        f"dt = {dt:g} s with method 'exact' makes a mode at {omega[worst] / (2 * np.pi):.5g} Hz grow by "
        f"{left[worst]:.3g} 1/s: balls hold {100 * share[worst]:.0f} % of it, which gains "
        f"{gain[worst]:.3g} 1/s, and its damping takes {decay[worst]:.3g} 1/s; {remedy}",
        GrowingStep,
    )


def modal_decays(system: System, contacts: Array | None, omega: Array, shapes: Array) -> Array:
    """Rate at which each mode's swing decays (modes,), 1/s, by dampers, contacts and layers.

    Parameters
    ----------
    system
        The whole.
    contacts
        Damping of its contacts in the bearings' motions; None: none.
    omega, shapes
        Frequencies (modes,), rad/s, and mass-normalised shapes (n, modes).
    """
    decay = 0.5 * np.einsum("ij,ij->j", shapes, system.viscous() @ shapes)
    if contacts is not None:
        z = system.B @ shapes
        decay += 0.5 * np.einsum("ij,ij->j", z, contacts @ z)
    for layer in system.layers:
        material = layer.material if layer.strain is None else layer.material.rest
        # all modes of the model are looked at, those far above the march's band too
        with untold(OutsideBand):
            loss = np.imag(answer_of(material, omega))
        loss -= omega * getattr(material, "eta0", 0.0)
        decay += loss / omega * ((layer.L.T @ shapes) ** 2).sum(axis=0)
    return np.asarray(decay)


def rounded_down(value: float) -> float:
    """Two digits, never more than the value."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.floor(value / unit * (1 + 1e-12)) * unit:.2g}")


def step_error_made(method: str, hold: int) -> str:
    """How `step_error` was made, in words."""
    order = 2 if method == "newmark" else hold + 1
    share = f"{2**order}/{2**order - 1}"
    return (
        f"{CHECKED} steps beyond the end, at dt and at dt/2 from one state: {share} of the rms difference "
        f"over the rms of the channel about its mean (the scheme is of {ORDERS[order]} order)"
    )


def step_error(
    model: core.Model,
    state: Array,
    stepping: core.Stepping,
    modes: tuple[dict[str, Array], dict[str, Array]] | None = None,
) -> Array:
    """Error of each channel that the step size leaves, (channels,), relative; NaN where one stands still.

    From the state at the end of a march CHECKED steps go on, once with the step and once with half of it. The
    scheme is of second order, so that 4/3 of the difference (rms) is the error of the coarser one
    (Richardson); it is put over the channel's own rms about its mean. With `modes`, of the step and its
    half, steps are exact but for the bearing forces, of the order after the one that these are held by.
    """
    whole, halved = modes or (None, None)
    plain = replace(stepping, audit=False)
    half = replace(plain, dt=plain.dt / 2)
    # both start their own count, so that both begin without an old Newton matrix
    coarse, _, _ = core.march(model, state.copy(), plain, CHECKED, modes=whole)
    fine, _, report = core.march(model, state.copy(), half, 2 * CHECKED, 2, modes=halved)
    if len(coarse) != CHECKED or report.status != 0:
        return np.full(coarse.shape[1], np.nan)
    size = np.std(fine, axis=0)
    halvings = 2 ** (2 if modes is None else stepping.scheme.hold + 1)
    error = halvings / (halvings - 1) * np.sqrt(np.mean((coarse - fine) ** 2, axis=0))
    return np.asarray(np.divide(error, size, out=np.full_like(size, np.nan), where=size > 0))
