"""The harmonic response about an equilibrium (paper section 4.1, eq (20))."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium, state_of
from bearingdyn.analysis.inputs_outputs import Input, Output, recovered, requested
from bearingdyn.analysis.linearised import linear
from bearingdyn.analysis.overload import warn_of_swings
from bearingdyn.analysis.response_band import response_band
from bearingdyn.analysis.softening import layer_names, moduli_of, softened, softening_layers, warn_of_strain
from bearingdyn.analysis.softening_zones import Zones
from bearingdyn.application import QUANTITIES, RATES, Application
from bearingdyn.checks import name_list, numbers, one_of, one_speed, positive, require
from bearingdyn.material import warn_beyond
from bearingdyn.plausible_ranges import plausible
from bearingdyn.progress import Progress, told
from bearingdyn.system import Contacts, System
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray


def frequencies(frequency: ArrayLike) -> Array:
    """Frequencies (f,), Hz, of a frequency response; ValueError for none, a negative or a non-finite one.

    Parameters
    ----------
    frequency
        Hz.
    """
    found = numbers(
        "frequency", frequency, "frequency must be one or more finite values of zero or more, in Hz", 0.0
    )
    plausible("frequency", "the highest frequency", float(found.max()))
    return found


@takes(frequency="Hz", speed="rad/s")
def frequency_response(
    source: Equilibrium | Application | System,
    frequency: ArrayLike,
    inputs: Sequence[str],
    outputs: Sequence[str],
    *,
    speed: float | None = None,
    quantity: str = "displacement",
    amplitude: float | Sequence[float] | Mapping[str, float] | None = None,
    zones: int | None = None,
    contacts: Contacts = "film",
    progress: Progress | bool | None = None,
    rpm: float | None = None,
    uncertainty: int | None = None,
    coverage: float = 0.9,
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
        rad/s of the shaft, for gyroscopic forces, at rest by default; it is not the excitation frequency.
    quantity
        "displacement", "velocity" or "acceleration", of motions.
    amplitude
        Zero-to-peak size of each input, N, N m, or of the ground's motion in the quantity of the outputs:
        layers with a law of softening (`Maxwell.payne`) answer to it, each input acting alone. One number for
        all inputs, a number by input, or a list of numbers, the levels. None: layers are linear, as at the
        strain of their isotherms.
    zones
        With an amplitude: how many zones the section of each softening layer is cut into, each in 8 sectors
        around the axis and with a strain of its own; three or four resolve a thin layer that moves radially.
        None: one strain for a layer, the mean that counts for its energy. Of bd.Layer and bd.Revolved.
    contacts
        How lubricated bearings (`BallBearing(lubrication=...)`, or `lubricate`) answer: "film", by the
        stiffness and damping that their films have at each frequency; "viscous", by those of low frequency,
        as a march does.
    progress
        True for a bar, False for none, or a function called with (frequencies done, in all); None for a bar
        where standard error is a terminal.
    rpm
        The speed in revolutions a minute, instead of `speed`.
    uncertainty
        Number of draws of the layers' materials from their spread (`Maxwell.spread`, that of their fit), for
        each of which equilibrium and response are computed anew: the result then has the band that they
        leave. Layers of equal material are drawn together. None: no band.
    coverage
        Share of further draws that the band covers at each frequency.

    Returns
    -------
    xarray.Dataset
        response (frequency, output, input), complex, per unit of the input. At 0 Hz it is the static
        response, without the free spin of a shaft unless a force drives it. With an amplitude also strain
        (frequency, layer, input), the shear strain amplitude of each layer that softens; with several levels
        both have the dimension "amplitude" in front. With zones also zone_strain (frequency, zone, input),
        and strain is then their mean over ln γ, weighed by energy. With `uncertainty` also lower, median and
        upper, real, of the magnitude of the response and of its dimensions.

    Raises
    ------
    ValueError
        For an unknown channel or quantity, a negative frequency, bearings without an equilibrium, a part that
        would turn although its damping is known at rest only; for an uncertainty where no material has any;
        for zones without an amplitude, of a part that knows none, or with forces of layers as outputs.
    ArithmeticError
        Where the dynamic stiffness is singular; at 0 Hz it names the motion that a force drives and nothing
        holds, such as the spin of a shaft.

    Warns
    -----
    UnloadedBearing
        Where a bearing carries nothing, and so has no stiffness.
    BeyondData
        At 0 Hz, where layers have their relaxed modulus, if their data do not speak of it.
    BeyondSweep
        With an amplitude, where a layer's strain leaves the sweep its law of softening comes from.
    BearingWarning
        With an amplitude, where a contact pressure exceeds 4.2 GPa (ISO 76) while the rings move so.

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
    inputs, outputs = name_list("inputs", inputs, least=1), name_list("outputs", outputs, least=1)
    one_of("quantity", quantity, QUANTITIES)
    state = linear(source, contacts)
    speed = one_speed(speed, rpm, 0.0)
    state.system.check_speed(speed)
    given = [Input.of(state.system, name) for name in inputs]
    wanted = [Output.of(state.system, name) for name in outputs]
    force = np.array([i.force for i in given]).reshape(-1, state.system.n)

    omega = 2 * np.pi * f
    if (f == 0).any():
        warn_beyond(
            [(layer.part, layer.material) for layer in state.system.layers],
            math.inf,
            "the response at 0 Hz, which is relaxed,",
            "take the lowest frequency that the data reach instead, or equilibrium(app, after=...) for a "
            "deflection, ",
        )
    B = state.system.B
    rows, power = np.vstack([requested(wanted, state.system.n), B]), QUANTITIES.index(quantity)
    dims: tuple[str, ...] = ("frequency", "output", "input")
    coords: dict[str, tuple[Any, str]] = {
        "frequency": (f, "Hz"),
        "output": (list(outputs), ""),
        "input": (list(inputs), ""),
    }
    levels = None if amplitude is None else _levels(amplitude, inputs, state.system)
    strain, zone_strain = None, None
    resolved = None if zones is None else _zones(zones, state.system, wanted, levels is not None)
    # only what passes forces asks for it
    bearings = state.dynamic(omega if any(o.bearings for o in wanted) else omega[:0])
    with told(progress, "frequency") as tell:
        if levels is None:
            x = state.solve(omega, force, rows[: len(rows) - len(B)], speed, tell)
            response = recovered(wanted, given, x, omega, speed, power, bearings)
        else:
            drives = [_drive(level, given, omega, power) for level in levels]
            found = softened(state, omega, force, rows, speed, drives, tell, resolved)
            responses = []
            for drive, one in zip(drives, found, strict=True):
                size = np.einsum("fii->fi", drive)
                x = one.x / np.where(size == 0, 1.0, size)[:, None, :]
                moduli = moduli_of(state.system, one.modulus)
                responses.append(recovered(wanted, given, x, omega, speed, power, bearings, moduli))
            response, strain = np.stack(responses), np.stack([one.strain for one in found])
            if resolved is not None:
                zone_strain = np.stack([np.asarray(one.zone_strain) for one in found])
                coords["zone"] = (resolved.names, "")
            asked = strain if zone_strain is None or resolved is None else resolved.largest(zone_strain)
            warn_of_strain(state.system, asked)
            if isinstance(source, Equilibrium):
                swings = np.concatenate(
                    [o.x[:, len(rows) - len(B) :].transpose(0, 2, 1).reshape(-1, len(B)) for o in found]
                )
                each = list(product(f, inputs))

                def place(k: int) -> str:
                    hertz, name = each[k % len(each)]
                    return f"in the response to {name} at {hertz:.6g} Hz"

                warn_of_swings(source, swings, place)
            coords["layer"] = (layer_names(state.system), "")
            if np.ndim(amplitude) == 1:  # type: ignore[arg-type]
                dims = ("amplitude", *dims)
                coords["amplitude"] = (levels[:, 0], _amplitude_unit(quantity, given))
            else:
                response, strain = response[0], strain[0]
                zone_strain = None if zone_strain is None else zone_strain[0]

    band = None
    if uncertainty is not None:

        def again(drawn: Equilibrium | System) -> Array:
            found = frequency_response(
                drawn,
                f,
                inputs,
                outputs,
                speed=speed,
                quantity=quantity,
                amplitude=amplitude,
                zones=zones,
                contacts=contacts,
                progress=False,
            )
            return np.asarray(found["response"].values)

        band = response_band(source, again, uncertainty, coverage)

    from bearingdyn.results import dataset, inputs_of

    variables: dict[str, Any] = {
        "response": (
            dims,
            response,
            _unit(quantity, wanted, given),
            f"complex {quantity}, zero-to-peak, per unit force",
        ),
    }
    if strain is not None:
        over = tuple("layer" if d == "output" else d for d in dims)
        variables["strain"] = (over, strain, "1", "shear strain amplitude of each layer that softens")
    if zone_strain is not None:
        over = tuple("zone" if d == "output" else d for d in dims)
        variables["zone_strain"] = (
            over,
            zone_strain,
            "1",
            "shear strain amplitude of each zone of the layers",
        )
    more: dict[str, Any] = {} if zones is None else {"zones": int(zones)}
    if band is not None:
        unit = variables["response"][2]
        more |= {"uncertainty": int(uncertainty or 0), "coverage": float(coverage)}
        for name in ("lower", "median", "upper"):
            words = f"{name} magnitude over the draws of the materials"
            variables[name] = (dims, getattr(band, name), unit, words)
    if levels is not None and np.ndim(amplitude) != 1:  # type: ignore[arg-type]
        more["amplitude"] = levels[0].tolist()
    return dataset(
        variables,
        {
            "analysis": "frequency response",
            "speed": speed,
            "quantity": quantity,
            "contacts": contacts,
            **more,
            **state_of(source),
            **inputs_of(state.system.inputs),
        },
        coords,
    )


def _zones(zones: object, system: System, wanted: Sequence[Output], driven: bool) -> Zones:
    """Zones of the layers that soften; ValueError without an amplitude, and for forces that layers exert."""
    require(driven, "zones", zones, "zones have strains of their own under an amplitude: give amplitude=...")
    soft = softening_layers(system)
    parts = {system.layers[k].part for k in soft}
    for output in wanted:
        require(
            not parts & {term.name for term, _ in output.parts},
            f"zones with the output {output.name!r}",
            zones,
            "the force that a layer in zones exerts is not known; ask the motion of its neighbours",
        )
    return Zones.of(system, soft, layer_names(system), zones)


def _levels(amplitude: Any, inputs: Sequence[str], system: System) -> Array:
    """Size of each input (levels, i); ValueError for sizes that are not valid, and where nothing softens."""
    if not softening_layers(system):
        raise ValueError(
            f"amplitude is {amplitude!r}, and no layer has a law of softening: give its material one, "
            f"material.with_payne(bd.fit_payne(...)), or leave amplitude out"
        )
    remedy = "it must be positive and finite, N, N m or of the ground's motion, zero-to-peak"
    if isinstance(amplitude, Mapping):
        missing = sorted(set(inputs) ^ set(amplitude))
        require(not missing, "amplitude", amplitude, f"give a size for each input and no other: {missing}")
        sizes = [positive(f"amplitude[{name!r}]", amplitude[name], remedy) for name in inputs]
        return np.array([sizes])
    given = numbers("amplitude", amplitude, remedy)
    require(bool((given > 0).all()), "amplitude", amplitude, remedy)
    return np.repeat(given[:, None], len(inputs), axis=1)


def _drive(level: Array, inputs: Sequence[Input], omega: Array, power: int) -> Complex:
    """How each input (f, i, i) acts alone: a force by its size, the ground by its acceleration."""
    drive = np.zeros((omega.size, len(inputs), len(inputs)), dtype=np.complex128)
    for i, given in enumerate(inputs):
        drive[:, i, i] = level[i] * ((1j * omega) ** (2 - power) if given.axis is not None else 1.0)
    return drive


def _amplitude_unit(quantity: str, inputs: Sequence[Input]) -> str:
    """Unit of an excitation level."""
    kinds = ["m" + RATES[quantity] if i.axis is not None else "N m" if i.turning else "N" for i in inputs]
    return ", ".join(dict.fromkeys(kinds))


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
