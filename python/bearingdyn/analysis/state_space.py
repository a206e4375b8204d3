"""A linear model of the whole application in state space, for control design and for other programs.

    ẋ = A x + B u,  y = C x + D u;  x = (q, q̇, s): modal coordinates, their rates, and the stress of every
    Maxwell branch in its layer's coordinates, ṡ = 2 G_i Lᵀq̇ − s/τ_i (paper eqs 8, 9)

Layers are exact: a branch is a state. Bearings are their tangents in the equilibrium.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.inputs_outputs import Input, Output
from bearingdyn.analysis.linearised import linear
from bearingdyn.application import QUANTITIES, Application
from bearingdyn.checks import name_list, one_of, one_speed, require
from bearingdyn.material import Maxwell
from bearingdyn.pictures import page
from bearingdyn.system import System
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes


@dataclass(frozen=True, eq=False)
class StateSpace:
    """A linear model in state space: ẋ = A x + B u, y = C x + D u, in SI units.

    Parameters
    ----------
    A, B, C, D
        (n, n), (n, inputs), (outputs, n), (outputs, inputs).
    inputs, outputs
        Channels.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]

    _repr_html_ = page

    def __repr__(self) -> str:
        """One line: how many states, inputs and outputs."""
        return f"<StateSpace: {len(self.A)} states, {len(self.inputs)} inputs, {len(self.outputs)} outputs>"

    def response(self, frequency: ArrayLike) -> Complex:
        """Transfer function C (iω − A)⁻¹ B + D, (f, outputs, inputs), at frequencies in Hz."""
        found = []
        for omega in 2 * np.pi * frequencies(frequency):
            x = np.linalg.solve(1j * omega * np.eye(len(self.A)) - self.A, self.B.astype(np.complex128))
            found.append(self.C @ x + self.D)
        return np.array(found)

    def scipy(self) -> Any:
        """The same as a scipy.signal.StateSpace."""
        import scipy.signal

        return scipy.signal.StateSpace(self.A, self.B, self.C, self.D)

    def control(self) -> Any:
        """The same as a control.StateSpace of the package python-control, which must be installed.

        Its names allow no dots: "shaft.left.y" is "shaft_left_y" there.
        """
        from importlib import import_module

        control = import_module("control")
        names = {"inputs": self.inputs, "outputs": self.outputs}
        plain = {key: [name.replace(".", "_") for name in channels] for key, channels in names.items()}
        return control.ss(self.A, self.B, self.C, self.D, **plain)


@takes(speed="rad/s")
def state_space(
    source: Equilibrium | Application | System,
    inputs: Sequence[str],
    outputs: Sequence[str],
    *,
    speed: float | None = None,
    quantity: str = "displacement",
    rpm: float | None = None,
) -> StateSpace:
    """Linear model in state space about an equilibrium, whose transfer function is the frequency response.

    Lubricated contacts are the springs and dampers that they are at low frequency, as with
    contacts="viscous" of `frequency_response`: c(ω), which delays, would need states of its own.

    Parameters
    ----------
    source
        Equilibrium, whose bearings are linearised; or an application or system without bearings.
    inputs
        Channels of forces, N (or N m), as in `frequency_response`; "ground.y" is the acceleration of the
        ground, m/s², and motions are then relative to it.
    outputs
        Channels of motions, and forces of bearings, "left.force.y".
    speed
        Of the shaft, rad/s; at rest by default.
    quantity
        "displacement", "velocity" or "acceleration", of motions.
    rpm
        The speed in revolutions a minute, instead of `speed`.

    Returns
    -------
    StateSpace

    Raises
    ------
    ValueError
        For an unknown channel or quantity, a layer whose material is no Maxwell model, and a reaction force.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    >>> model = bd.state_space(app, ["mass.centre.y"], ["mass.centre.y"])
    >>> model, [f"{abs(h):.3e}" for h in model.response([0.0, 50.0]).ravel()]  # m/N
    (<StateSpace: 12 states, 1 inputs, 1 outputs>, ['1.000e-06', '1.109e-06'])
    """
    inputs, outputs = name_list("inputs", inputs, least=1), name_list("outputs", outputs, least=1)
    one_of("quantity", quantity, QUANTITIES)
    state = linear(source)
    system = state.system
    speed = one_speed(speed, rpm, 0.0)
    system.check_speed(speed)
    for layer in system.layers:
        maxwell = isinstance(layer.material, Maxwell)
        remedy = f"the material of part {layer.part!r} has no branches: fit_maxwell makes them"
        require(maxwell, "source", type(layer.material).__name__, remedy)
    given = [Input.of(system, name) for name in inputs]
    wanted = [Output.of(system, name) for name in outputs]
    for output in wanted:
        reaction = output.is_force and bool(output.parts or output.springs)
        require(not reaction, "outputs", output.name, "of forces, those of bearings alone are offered here")

    # modes of the structure at rest, mass-normalised: no matrix is inverted
    T = system.basis("relaxed")[1]
    K = T.T @ (system.stiffness("relaxed") + speed * system.N + system.B.T @ state.K @ system.B) @ T
    C = T.T @ (system.viscous() + speed * system.G + system.B.T @ state.C @ system.B) @ T
    n = T.shape[1]
    branches = [
        (T.T @ layer.L, float(G), float(tau))
        for layer in system.layers
        for G, tau in zip(layer.material.G, layer.material.tau, strict=True)
        if G > 0
    ]
    total = 2 * n + sum(L.shape[1] for L, _, _ in branches)
    A = np.zeros((total, total))
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -K, -C
    at = 2 * n
    for L, G, tau in branches:
        own = slice(at, at + L.shape[1])
        A[n : 2 * n, own] = -L
        A[own, n : 2 * n] = 2 * G * L.T
        A[own, own] = -np.eye(L.shape[1]) / tau
        at += L.shape[1]
    B = np.zeros((total, len(given)))
    B[n : 2 * n] = T.T @ np.array([i.force for i in given]).reshape(len(given), -1).T

    power = QUANTITIES.index(quantity)
    rows, direct = np.zeros((len(wanted), total)), np.zeros((len(wanted), len(given)))
    for k, output in enumerate(wanted):
        if output.row is None:
            for first, on, share in output.bearings:
                own = slice(first, first + len(on))
                rows[k, :n] += share @ state.K[own, own] @ on @ T
                rows[k, n : 2 * n] += share @ state.C[own, own] @ on @ T
            continue
        row = output.row @ T
        if power == 2:
            rows[k], direct[k] = row @ A[n : 2 * n], row @ B[n : 2 * n]
        else:
            rows[k, power * n : (power + 1) * n] = row
    return StateSpace(A, B, rows, direct, tuple(inputs), tuple(outputs))
