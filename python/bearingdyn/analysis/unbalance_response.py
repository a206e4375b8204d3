"""The response of a rotor to its own unbalance, speed by speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.inputs_outputs import Input, Output, recovered, requested
from bearingdyn.analysis.linearised import linear
from bearingdyn.analysis.overload import warn_of_swings
from bearingdyn.analysis.softening import layer_names, moduli_of, softened, warn_of_strain
from bearingdyn.application import QUANTITIES, Application
from bearingdyn.checks import name_list, numbers, one_of, one_speed
from bearingdyn.material import band_told_once
from bearingdyn.system import System
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


@takes(speeds="rad/s")
def unbalance_response(
    source: Equilibrium | Application | System,
    speeds: ArrayLike | None = None,
    outputs: Sequence[str] = (),
    *,
    quantity: str = "displacement",
    rpm: ArrayLike | None = None,
) -> xarray.Dataset:
    """Synchronous response to all unbalances of an application, with the gyroscopic forces of each speed.

    Parameters
    ----------
    source
        Equilibrium, whose bearings are linearised; or an application or system without bearings. Its
        unbalances are those of `Application.unbalance`, at their phases.
    speeds
        (s,) rad/s of the shaft, ≥ 0; the response has this frequency. None where `rpm` is given.
    outputs
        One or more channels of motions and forces, as in `frequency_response`.
    quantity
        "displacement", "velocity" or "acceleration", of motions.
    rpm
        The speeds in revolutions a minute, instead of `speeds`.

    Returns
    -------
    xarray.Dataset
        response (speed, output), complex, zero-to-peak: the motion is Re(response·e^{iΩt}) while the shaft
        stands at the angle Ωt. Where layers soften (`Maxwell.payne`), they do so with this motion, and strain
        (speed, layer) is the shear strain amplitude of each.

    Raises
    ------
    ValueError
        For negative speeds, an application without unbalance, an unknown channel or quantity, a part that
        would turn although its damping is known at rest only.
    ArithmeticError
        Where the dynamic stiffness is singular, or the strain of a layer is not found.

    Warns
    -----
    BearingWarning
        Where a contact pressure exceeds 4.2 GPa (ISO 76) while the rings move so about their equilibrium.
    BeyondSweep
        Where a layer's strain leaves the sweep its law of softening comes from.
    """
    given = numbers(
        "speeds",
        one_speed(speeds, rpm, what="speeds"),
        "speeds must be one or more finite values of zero or more, in rad/s",
        0.0,
    )
    outputs = name_list("outputs", outputs, least=1)
    one_of("quantity", quantity, QUANTITIES)
    state = linear(source)
    system = state.system
    system.check_speed(float(given.max()))
    loads = [load for load in system.loads if load.kind == "rotating"]
    if not loads:
        raise ValueError("there is no unbalance; add one with app.unbalance(place, moment, phase)")
    wanted = [Output.of(system, name) for name in outputs]
    rows = np.vstack([requested(wanted, system.n), system.B])
    swings = np.zeros((given.size, len(system.B)), dtype=np.complex128)
    forces = any(o.bearings for o in wanted)
    inputs = [
        Input(name, force, part=load.part, load=own)
        for load in loads
        for name, force, own in (("cos", load.p_cos, load.own_cos), ("sin", load.p_sin, load.own_sin))
    ]
    force = np.array([i.force for i in inputs])
    # p_cos cos Ωt + p_sin sin Ωt = Re (p_cos − i p_sin) e^{iΩt}
    phase = np.tile([1.0, -1j], len(loads))
    response = np.zeros((given.size, len(outputs)), dtype=np.complex128)
    soft, power = layer_names(system), QUANTITIES.index(quantity)
    strain = np.zeros((given.size, len(soft), 1))
    with band_told_once([t.material for t in system.layers], given[given > 0.0]):
        for k, speed in enumerate(given):
            if speed > 0.0:
                omega, turning = np.array([speed]), float(speed)
                if soft:
                    drive = speed**2 * phase.reshape(1, -1, 1)  # all together make the strain
                    (found,) = softened(state, omega, force, rows, turning, [drive])
                    strain[k], x = found.strain[0], found.each()
                    moduli = moduli_of(system, found.modulus)
                else:
                    x, moduli = state.solve(omega, force, rows, turning, None), None
                bearings = state.dynamic(omega if forces else omega[:0])
                unit = recovered(wanted, inputs, x, omega, turning, power, bearings, moduli)
                response[k] = speed**2 * (unit[0] @ phase)
                swings[k] = speed**2 * (x[0, len(rows) - len(system.B) :] @ phase)
    if soft:
        warn_of_strain(system, strain)
    if isinstance(source, Equilibrium):
        warn_of_swings(source, swings, lambda k: f"in the response at {given[k]:.6g} rad/s")

    from bearingdyn.results import dataset, inputs_of

    units = [o.unit(quantity) for o in wanted]
    variables: dict[str, Any] = {
        "response": (
            ("speed", "output"),
            response,
            ", ".join(dict.fromkeys(units)),
            f"complex {quantity}, zero-to-peak, at the frequency of the speed",
        )
    }
    coords: dict[str, tuple[Any, str]] = {"speed": (given, "rad/s"), "output": (list(outputs), "")}
    if soft:
        meaning = "shear strain amplitude of each layer that softens"
        variables["strain"] = (("speed", "layer"), strain[:, :, 0], "1", meaning)
        coords["layer"] = (soft, "")
    made = dataset(
        variables,
        {
            "analysis": "unbalance response",
            "quantity": quantity,
            **state_of(source),
            **inputs_of(system.inputs),
        },
        coords,
    )
    return made.assign_coords(unit=("output", units, {"units": "", "long_name": "unit of each output"}))
