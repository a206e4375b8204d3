"""Natural modes: undamped, or damped and exact with the layers' branches as states."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.film_modes import film_modes
from bearingdyn.analysis.linearised import linear
from bearingdyn.application import Application
from bearingdyn.checks import number, one_of, one_speed, truth, whole
from bearingdyn.system import Contacts, System
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


# an eigenvalue this close to the real axis, relative to its size, does not oscillate
REAL = 1e-9


@takes(speed="rad/s")
def modes(
    source: Equilibrium | Application | System,
    count: int | None = None,
    *,
    speed: float | None = None,
    damped: bool = False,
    modulus: str = "relaxed",
    contacts: Contacts = "film",
    rpm: float | None = None,
) -> xarray.Dataset:
    """Natural modes about an equilibrium, or of an application without bearings.

    Parameters
    ----------
    source
        Equilibrium, whose bearings act by their tangents; or an application or system without bearings.
    count
        How many modes, the lowest first; None for all.
    speed
        rad/s of the shaft, for gyroscopic forces and, in damped modes, damping that turns; 0 by default.
    damped
        False: only masses, stiffnesses and gyroscopic forces act. True: C, G, K, N and every Maxwell branch
        act, each branch as a state, so that the eigenvalues solve the frequency-dependent problem exactly.
    modulus
        Of the layers in undamped modes, "relaxed" or "instantaneous".
    contacts
        How lubricated bearings act in damped modes: "film", by the stiffness and damping that their films
        have at the frequency of each mode, good to the first order in its damping ratio; "viscous", by those
        of low frequency, as a march does. In undamped modes they have their static stiffness.
    rpm
        The speed in revolutions a minute, instead of `speed`.

    Returns
    -------
    xarray.Dataset
        Over "mode": frequency (Hz), damping_ratio, eigenvalue (rad/s, complex), and shape (mode, coordinate),
        complex, in the coordinates of the system; the motion of a place is rows(place) @ shape.

    Raises
    ------
    ValueError
        For bearings without an equilibrium, and for a part that would turn although its damping is known at
        rest only.
    ArithmeticError
        Where a mode is not found with the films of its own frequency.

    Warns
    -----
    UnloadedBearing
        Where a bearing of the equilibrium carries nothing, and so has no stiffness.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 3 + [1e3] * 3)
    >>> bd.modes(app)["frequency"].values.round(2).tolist()  # √(k/m)/2π, three times each
    [112.54, 112.54, 112.54, 159.15, 159.15, 159.15]
    """
    if count is not None:
        count = whole("count", count, 1)
    damped, speed = truth("damped", damped), number("speed", one_speed(speed, rpm, 0.0))
    one_of("contacts", contacts, ("film", "viscous"))
    system = source.linearised() if isinstance(source, Equilibrium) else linear(source).system
    # linearised bearings are springs, which any speed suits
    (source.system if isinstance(source, Equilibrium) else system).check_speed(speed)
    if damped:
        values, shapes = _damped(system, speed)
        if contacts == "film" and isinstance(source, Equilibrium) and source.filmed:
            values, shapes = _with_films(source, system, speed, values[np.argsort(np.abs(values))][:count])
    elif speed == 0.0:
        squares, real = scipy.linalg.eigh(system.stiffness(modulus), system.M)
        values, shapes = 1j * np.sqrt(np.maximum(squares, 0.0)), real.astype(np.complex128)
    else:
        values, shapes = _gyroscopic(system.stiffness(modulus), system.M, speed * system.G)
    order = np.argsort(np.abs(values), kind="stable")[:count]
    values, shapes = values[order], shapes[:, order]

    from bearingdyn.results import dataset, inputs_of

    size = np.abs(values)
    return dataset(
        {
            "frequency": ("mode", size / (2 * np.pi), "Hz", "undamped natural frequency |λ|/2π"),
            "damping_ratio": (
                "mode",
                np.divide(-values.real, size, out=np.zeros_like(size), where=size > 0),
                "1",
                "−Re λ/|λ|",
            ),
            "eigenvalue": ("mode", values, "rad/s", "λ of exp(λt)"),
            "shape": (("mode", "coordinate"), shapes.T, "m, rad", "mode shape in system coordinates"),
        },
        {
            "analysis": "modes",
            "speed": speed,
            "damped": int(damped),
            "modulus": modulus,
            "contacts": contacts,
            **state_of(source),
            **inputs_of(system.inputs),
        },
    )


def _with_films(
    source: Equilibrium, system: System, speed: float, values: Complex
) -> tuple[Complex, Complex]:
    """The damped modes nearest to the values (m,) with lubricated contacts as they are at each."""
    modal, T = system.modal()
    B = source.system.B @ T

    def balls(omega: Array) -> tuple[Complex, Array] | None:
        found = source.balls(omega)
        return found and (found[0], found[1] @ B)

    values, shapes = film_modes(modal, speed, balls, values, lambda held: _damped_modal(held, speed))
    return values, T @ shapes


def _swinging(values: Complex, shapes: Complex) -> tuple[Complex, Complex]:
    keep = values.imag > REAL * np.abs(values).max(initial=1.0) * 1e-3
    return values[keep], shapes[:, keep]


def _gyroscopic(K: Array, M: Array, G: Array) -> tuple[Complex, Complex]:
    n = len(K)
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ G]])
    values, vectors = scipy.linalg.eig(A)
    return _swinging(values, vectors[:n])


def _damped(system: System, speed: float) -> tuple[Complex, Complex]:
    """States x, v and every branch stress: ṡ = 2 G Lᵀ v − s/τ, force L s (paper (6) differentiated)."""
    modal, T = system.modal()
    values, shapes = _damped_modal(modal, speed)
    return values, T @ shapes


def _damped_modal(modal: System, speed: float) -> tuple[Complex, Complex]:
    n = modal.n
    columns, rates = [np.zeros((n, 0))], [np.zeros(0)]
    strengths = [np.zeros(0)]
    for layer in modal.layers:
        for G, tau in zip(layer.material.G, layer.material.tau, strict=True):
            columns.append(layer.L)
            rates.append(np.full(layer.L.shape[1], 1.0 / tau))
            strengths.append(np.full(layer.L.shape[1], 2.0 * G))
    L, rate, strength = np.hstack(columns), np.concatenate(rates), np.concatenate(strengths)
    m = len(rate)
    # s scaled by √strength, so that the branches' states weigh like velocities
    Ls = L * np.sqrt(strength)
    A = np.block(
        [
            [np.zeros((n, n)), np.eye(n), np.zeros((n, m))],
            [
                -(modal.stiffness() + speed * modal.N),
                -(modal.viscous() + speed * modal.G),
                -Ls,
            ],
            [np.zeros((m, n)), Ls.T, -np.diag(rate)],
        ]
    )
    values, vectors = scipy.linalg.eig(A)
    return _swinging(values, vectors[:n])
