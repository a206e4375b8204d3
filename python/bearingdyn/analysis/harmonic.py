"""The harmonic response about an equilibrium (paper section 4.1, eq (20))."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.recovery import Input, Output, recovered, requested
from bearingdyn.analysis.statics import HOLD
from bearingdyn.application import QUANTITIES, RATES, Application
from bearingdyn.checks import name_list, numbers
from bearingdyn.material import Maxwell
from bearingdyn.progress import Progress, told
from bearingdyn.system import System, assemble
from bearingdyn.types import Array, Complex

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, eq=False)
class Linear:
    """A system with its bearings linearised: K, C (coefs, coefs) on their raceway coefficients."""

    system: System
    K: Array
    C: Array

    def solve(
        self,
        omega: Array,
        force: Array,
        rows: Array,
        speed: float,
        progress: core.Progress | None = None,
    ) -> Complex:
        """Motions rows (k, n) under forces (i, n) e^{iωt}, (f, k, i); paper (20)."""
        system = self.system
        modulus = np.ones((omega.size, len(system.layers)), dtype=np.complex128)
        for k, layer in enumerate(system.layers):
            modulus[:, k] = layer.material.complex_modulus(omega)
        # η0 sits in G*(ω) here, so C is the structure's own
        x = np.zeros((omega.size, len(rows), len(force)), dtype=np.complex128)
        for part in (omega > 0, omega == 0):
            if part.any():
                model = (system if omega[part][0] > 0 else _at_rest(system, force)).model([], relaxed=False)
                x[part] = core.harmonic(
                    model, omega[part], modulus[part], self.K, self.C, force, rows, speed, progress
                )
        return x


def linear(source: Equilibrium | Application | System) -> Linear:
    """The linear system that a harmonic analysis starts from.

    Raises
    ------
    ValueError
        For bearings without an equilibrium.
    """
    if isinstance(source, Equilibrium):
        return Linear(source.system, source.bearing_K, source.bearing_C)
    system = source if isinstance(source, System) else assemble(source)
    if system.bearings:
        raise ValueError(
            "bearings have no stiffness of their own; pass bd.equilibrium(app), which linearises them"
        )
    return Linear(system, np.zeros((0, 0)), np.zeros((0, 0)))


def frequencies(frequency: ArrayLike) -> Array:
    """Frequencies (f,), Hz; ValueError for none, and for one that is negative or not finite."""
    return numbers(
        "frequency", frequency, "frequency must be one or more finite values of zero or more, in Hz", 0.0
    )


def frequency_response(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    inputs: Sequence[str],
    outputs: Sequence[str],
    *,
    speed: float = 0.0,
    quantity: str = "displacement",
    progress: Progress | bool | None = None,
) -> xarray.Dataset:
    """Complex response at `outputs` to unit harmonic forces or ground motions at `inputs`, zero-to-peak.

    Parameters
    ----------
    source
        Equilibrium, whose bearings are linearised; or an application or system without bearings.
    frequency
        (f,) Hz, ≥ 0, finite.
    inputs
        Channels: "shaft.left.y" is a force there, N (or N m); "ground.y" is a motion of the ground, all of
        it together, in the quantity of the outputs: the response to it is the transmissibility.
    outputs
        Channels: "shaft.left.y" is the motion there, absolute where the ground moves. Forces are
        "left.force.y", which bearing "left" passes from its inner ring to its outer ring (x, y, z);
        "ground.block.feet.y", which the ground bears where it holds "block.feet" (with moments θx, θy, θz);
        and "layer.inner.force.y", which part "layer" exerts on everything joined to its interface "inner".
    speed
        rad/s of the shaft, for gyroscopic forces; it is not the excitation frequency.
    quantity
        "displacement", "velocity" or "acceleration", of motions.
    progress
        True for a bar, False for none, or a function called with (frequencies done, in all); None for a bar
        where standard error is a terminal.

    Returns
    -------
    xarray.Dataset
        response (frequency, output, input), complex. At 0 Hz it is the static response, without the free spin
        of a shaft unless a force drives it.

    Raises
    ------
    ValueError
        For an unknown channel or quantity, a negative frequency, bearings without an equilibrium, a part that
        would turn although its damping is known at rest only.
    ArithmeticError
        Where the dynamic stiffness is singular.

    References
    ----------
    Paper section 4.1, eq (20).

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    >>> frf = bd.frequency_response(app, [0.0, 50.0], ["mass.centre.y"], ["mass.centre.y"])
    >>> frf["response"].dims, [f"{abs(h):.3e}" for h in frf["response"].values.ravel()]  # m/N
    (('frequency', 'output', 'input'), ['1.000e-06', '1.109e-06'])
    """
    f = frequencies(frequency)
    inputs, outputs = name_list("inputs", inputs), name_list("outputs", outputs)
    if quantity not in QUANTITIES:
        raise ValueError(f"quantity is {quantity!r}; it must be one of {list(QUANTITIES)}")
    state = linear(source)
    state.system.check_speed(speed)
    given = [Input.of(state.system, name) for name in inputs]
    wanted = [Output.of(state.system, name) for name in outputs]
    force = np.array([i.force for i in given]).reshape(-1, state.system.n)

    omega = 2 * np.pi * f
    with told(progress, "frequency") as tell:
        x = state.solve(omega, force, requested(wanted, state.system.n), speed, tell)
    response = recovered(wanted, given, x, omega, speed, QUANTITIES.index(quantity), state.K, state.C)

    from bearingdyn.results import dataset, inputs_of

    return dataset(
        {
            "response": (
                ("frequency", "output", "input"),
                response,
                _unit(quantity, wanted, given),
                f"complex {quantity}, zero-to-peak, per unit force",
            ),
        },
        {
            "analysis": "frequency response",
            "speed": speed,
            "quantity": quantity,
            **inputs_of(state.system.inputs),
        },
        {"frequency": (f, "Hz"), "output": (list(outputs), ""), "input": (list(inputs), "")},
    )


def _unit(quantity: str, outputs: Sequence[Output], inputs: Sequence[Input]) -> str:
    """Unit of the response; of its entries together where different ones stand among them."""
    time = {"displacement": "", "velocity": " s", "acceleration": " s²"}[quantity]
    turning = any(o.turning for o in outputs), any(i.turning for i in inputs)
    if any(o.is_force for o in outputs) or any(i.axis is not None for i in inputs):
        moved = "m" + RATES[quantity]
        above = dict.fromkeys(o.unit(quantity) for o in outputs)
        below = dict.fromkeys(moved if i.axis is not None else "N m" if i.turning else "N" for i in inputs)
        return f"({', '.join(above)})/({', '.join(below)})"
    motion, force = ("m, rad" if turning[0] else "m"), ("N, N m" if turning[1] else "N")
    if any(turning):
        return f"({motion})/({force}){' per' + time if time else ''}"
    return f"m/({force}{time})" if time else f"m/{force}"


def _at_rest(system: System, force: Array) -> System:
    """The system with its free motions held, unless a force drives one of them."""
    if not all(isinstance(layer.material, Maxwell) for layer in system.layers):
        return system
    free = system.free_motions()
    driven = np.abs(force @ free).max(initial=0.0)
    if driven > 1e-9 * np.abs(free).max(initial=0.0):
        return system
    held = system.M @ free
    return replace(system, K=system.K + HOLD * (held @ held.T))
