"""The harmonic response about an equilibrium (paper section 4.1, eq (20))."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bearingdyn import core
from bearingdyn.analysis.equilibrium import HOLD, Equilibrium
from bearingdyn.application import Application
from bearingdyn.material import Maxwell
from bearingdyn.system import System, assemble, is_rotation

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]


def frequency_response(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    inputs: Sequence[str],
    outputs: Sequence[str],
    *,
    speed: float = 0.0,
    quantity: str = "displacement",
    progress: core.Progress | None = None,
) -> xarray.Dataset:
    """Complex response at `outputs` to unit harmonic forces at `inputs`, zero-to-peak per N (or N m).

    Parameters
    ----------
    source
        Equilibrium, whose bearings are linearised; or an application or system without bearings.
    frequency
        (f,) Hz, ≥ 0, finite.
    inputs, outputs
        Channels, "shaft.left.y".
    speed
        rad/s of the shaft, for gyroscopic forces; it is not the excitation frequency.
    quantity
        "displacement", "velocity" or "acceleration".

    Returns a Dataset with response (frequency, output, input), complex.

    At 0 Hz the response is the static one; the free spin of a shaft, which no such force drives, is left out.

    Raises ValueError for an unknown channel or quantity, a negative frequency, bearings without equilibrium,
    a damped part that would turn;
    ArithmeticError where the dynamic stiffness is singular.
    """
    f = np.atleast_1d(np.asarray(frequency, dtype=np.float64))
    if f.ndim != 1 or f.size == 0 or not (np.isfinite(f).all() and (f >= 0).all()):
        raise ValueError("frequency must be a list of finite values of zero or more, in Hz")
    powers = {"displacement": 0, "velocity": 1, "acceleration": 2}
    if quantity not in powers:
        raise ValueError(f"quantity is {quantity!r}; it must be one of {sorted(powers)}")
    if isinstance(source, Equilibrium):
        system, K, C = source.system, source.bearing_K, source.bearing_C
    else:
        system = source if isinstance(source, System) else assemble(source)
        if system.bearings:
            raise ValueError(
                "bearings have no stiffness of their own; pass bd.equilibrium(app), which linearises them"
            )
        K = C = np.zeros((0, 0))
    system.check_speed(speed)
    force = np.array([system.row(name) for name in inputs]).reshape(-1, system.n)
    row = np.array([system.row(name) for name in outputs]).reshape(-1, system.n)

    omega = 2 * np.pi * f
    modulus = np.ones((f.size, len(system.layers)), dtype=np.complex128)
    for k, layer in enumerate(system.layers):
        modulus[:, k] = layer.material.complex_modulus(omega)
    # η0 sits in G*(ω) here, so C is the structure's own
    response = np.zeros((f.size, len(row), len(force)), dtype=np.complex128)
    for part in (omega > 0, omega == 0):
        if part.any():
            model = (system if omega[part][0] > 0 else _at_rest(system, force)).model([], relaxed=False)
            response[part] = core.harmonic(
                model, omega[part], modulus[part], K, C, force, row, speed, progress
            )
    response *= ((1j * omega) ** powers[quantity])[:, None, None]

    from bearingdyn.results import dataset, inputs_of

    return dataset(
        {
            "response": (
                ("frequency", "output", "input"),
                response,
                _unit(quantity, [*outputs], [*inputs]),
                f"complex {quantity}, zero-to-peak, per unit force",
            ),
        },
        {"analysis": "frequency response", "speed": speed, "quantity": quantity, **inputs_of(system.inputs)},
        {"frequency": (f, "Hz"), "output": (list(outputs), ""), "input": (list(inputs), "")},
    )


def _unit(quantity: str, outputs: Sequence[str], inputs: Sequence[str]) -> str:
    """Unit of the response; of its entries together where rotations or moments stand among them."""
    turning = [any(is_rotation(name) for name in names) for names in (outputs, inputs)]
    time = {"displacement": "", "velocity": " s", "acceleration": " s²"}[quantity]
    motion, force = ("m, rad" if turning[0] else "m"), ("N, N m" if turning[1] else "N")
    if any(turning):
        return f"({motion})/({force}){' per' + time if time else ''}"
    return f"m/({force}{time})" if time else f"m/{force}"


def _at_rest(system: System, force: Array) -> System:
    """The system with its free motions held, unless a force drives one."""
    if not all(isinstance(layer.material, Maxwell) for layer in system.layers):
        return system
    free = system.free_motions()
    driven = np.abs(force @ free).max(initial=0.0)
    if driven > 1e-9 * np.abs(free).max(initial=0.0):
        return system
    held = system.M @ free
    return replace(system, K=system.K + HOLD * (held @ held.T))
