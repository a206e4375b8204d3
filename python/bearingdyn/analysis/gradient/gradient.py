"""Derivatives of what a machine does with respect to what it is made of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.gradient.contact_tangent import STEP
from bearingdyn.analysis.gradient.implicit import check_differentiable, coefficient_slope, implicit_slopes
from bearingdyn.analysis.gradient.mode_slopes import ModeSlopes
from bearingdyn.analysis.gradient.parameters import (
    Change,
    changes_of,
)
from bearingdyn.analysis.gradient.power_slopes import equivalent_power
from bearingdyn.analysis.gradient.response_slopes import ResponseSlopes
from bearingdyn.analysis.inputs_outputs import Input, Output, recovered
from bearingdyn.analysis.linearised import Linear, linear
from bearingdyn.analysis.modes import modes
from bearingdyn.application import QUANTITIES, Application
from bearingdyn.checks import meant, name_list, one_of, require, truth, whole
from bearingdyn.parts import Layer
from bearingdyn.system import System
from bearingdyn.types import Array, Complex
from bearingdyn.units import takes

if TYPE_CHECKING:
    import xarray

# of |λ|: modes this close are taken as one multiple mode
COINCIDE = 1e-6
SIDES = (None, "parted", "up", "down")


@dataclass(frozen=True, eq=False)
class Gradient:
    """The gradient of a machine's answers about a state, with respect to named parameters.

    They are exact: bearings and layers are differentiated as they are computed, and a parameter that moves
    the equilibrium moves the tangents of the bearings with it. The shapes by which a layer is reduced are
    those of its `moduli`, which a derivative holds; with `moduli=None` they follow the material, and building
    the machine anew moves them too, by what the reduction leaves (Layer.superelement says how much).

    Parameters
    ----------
    source
        What is differentiated.
    state
        The source linearised.
    changes
        What each parameter changes.
    x
        (parameters, n) derivatives of the equilibrium's coordinates.
    K, C
        (parameters, coefs, coefs) derivatives of the bearings' tangents.
    B
        Derivatives of the bearings' coefficients (coefs, n), by the parameters that have one.
    side
        As in `gradient`.
    """

    source: Equilibrium | System
    state: Linear
    changes: Mapping[str, Change]
    x: Array
    K: Array
    C: Array
    B: Mapping[int, Array]
    side: str | None = None

    def __repr__(self) -> str:
        """One line."""
        return f"<Gradient of {self.state.system.n} coordinates, {len(self.changes)} parameters>"

    @property
    def parameters(self) -> list[str]:
        """Names of the parameters."""
        return list(self.changes)

    @property
    def slopes(self) -> ResponseSlopes:
        """Slopes of responses by their adjoints."""
        return ResponseSlopes(self.state, self.changes, self.K, self.C, self.B)

    @takes(frequency="Hz", speed="rad/s")
    def response(
        self,
        frequency: ArrayLike,
        inputs: Sequence[str],
        outputs: Sequence[str],
        *,
        speed: float = 0.0,
        quantity: str = "displacement",
    ) -> xarray.Dataset:
        """Response as of `frequency_response`, and derivatives: receptance, transmissibility, compliance.

        By adjoints: however many parameters there are, the dynamic stiffness is solved for once with the
        outputs beside the inputs.

        Parameters
        ----------
        frequency, inputs, outputs, speed, quantity
            As for `frequency_response`; outputs are motions. At 0 Hz it is the static compliance.

        Returns
        -------
        xarray.Dataset
            response (frequency, output, input) and derivative (parameter, frequency, output, input), complex;
            magnitude_derivative, real, that of |response|.

        Raises
        ------
        ValueError
            As `frequency_response`, and for an output that is a force.
        """
        f = frequencies(frequency)
        inputs, outputs = name_list("inputs", inputs, least=1), name_list("outputs", outputs, least=1)
        one_of("quantity", quantity, QUANTITIES)
        system = self.state.system
        system.check_speed(speed)
        given = [Input.of(system, name) for name in inputs]
        wanted = [Output.of(system, name) for name in outputs]
        for output in wanted:
            require(not output.is_force, "output", output.name, "it must be a motion for a derivative")
        force = np.array([i.force for i in given])
        rows = np.array([o.rows[0] for o in wanted])
        omega, power = 2 * np.pi * f, QUANTITIES.index(quantity)
        of = self.slopes
        felt = of.felt()
        every = np.vstack([np.eye(system.n)[felt], rows])
        if speed == 0.0:
            both = self.state.solve(omega, np.vstack([force, rows]), every, 0.0)
            x, y = both[:, :, : len(force)], both[:, :, len(force) :]
        else:
            # gyroscopic and circulatory forces are skew: the adjoint turns the other way
            x = self.state.solve(omega, force, every, speed)
            y = self.state.solve(omega, rows, every, -speed)
        x, y, plain = x[:, : felt.size], y[:, : felt.size], x[:, felt.size :]
        response = recovered(
            wanted, given, plain, omega, speed, power, np.zeros((f.size, 0, 0), dtype=np.complex128)
        )
        rate = 1j * omega
        scale = np.stack([rate ** (power + (2 - power if i.axis is not None else 0)) for i in given], axis=1)[
            :, None, :
        ]
        slopes = of.slopes(felt, x, y, omega, given)
        slopes = slopes * scale
        size = np.abs(response)
        turned = (np.conj(response) * slopes).real
        magnitude = np.divide(turned, size, out=np.zeros_like(turned), where=size > 0)

        from bearingdyn.results import dataset

        dims = ("frequency", "output", "input")
        return dataset(
            {
                "response": (dims, response, "", f"complex {quantity}, per unit of the input"),
                "derivative": (("parameter", *dims), slopes, "", "derivative, per unit of the parameter"),
                "magnitude_derivative": (("parameter", *dims), magnitude, "", "that of the magnitude"),
            },
            {"analysis": "gradient of a frequency response", "speed": speed, "quantity": quantity},
            {
                "frequency": (f, "Hz"),
                "output": (list(outputs), ""),
                "input": (list(inputs), ""),
                "parameter": (self.parameters, ""),
            },
        )

    @takes(frequency="Hz", speed="rad/s")
    def radiated_power(
        self,
        frequency: ArrayLike,
        inputs: Sequence[str],
        surfaces: Sequence[str],
        *,
        speed: float = 0.0,
        density: float = 1.204,
        sound_speed: float = 343.2,
    ) -> xarray.Dataset:
        """Equivalent radiated power as of `radiated_power`, of all surfaces together, and its derivatives.

        `bearingdyn.sound.sound_power_gradient` gives those of the sound power itself.

        Parameters
        ----------
        frequency, inputs, surfaces, speed, density, sound_speed
            As for `radiated_power`.

        Returns
        -------
        xarray.Dataset
            power (frequency, input), W per N², and derivative (parameter, frequency, input).

        Raises
        ------
        ValueError
            As `radiated_power`.
        """
        return equivalent_power(self.slopes, frequency, inputs, surfaces, speed, density, sound_speed)

    def modes(self, count: int | None = None, *, speed: float = 0.0, damped: bool = True) -> xarray.Dataset:
        """Frequencies and damping ratios of the modes, and their derivatives.

        Parameters
        ----------
        count
            How many modes, the lowest first; None for all.
        speed
            rad/s, of damped modes.
        damped
            As for `modes`, damped by default; the undamped ones at rest, with layers relaxed.

        Returns
        -------
        xarray.Dataset
            frequency, Hz, damping_ratio and eigenvalue over "mode", and frequency_derivative,
            damping_ratio_derivative and eigenvalue_derivative over (parameter, mode).

        Raises
        ------
        ValueError
            Where modes coincide and a parameter parts them: the derivative is then one-sided; names them.
        """
        damped = truth("damped", damped)
        require(damped or speed == 0.0, "speed", speed, "it must be 0 for undamped modes")
        count = None if count is None else whole("count", count, 1)
        found = modes(self.source, count, speed=speed, damped=damped, contacts="viscous")
        values = np.asarray(found["eigenvalue"].values)
        require(
            bool((np.abs(values) > 0).all()),
            "count",
            count,
            "free motions are among these modes; hold the machine, or look at damped modes",
        )
        shapes = np.asarray(found["shape"].values).T
        slopes = np.zeros((len(self.changes), values.size), dtype=np.complex128)
        family = ModeSlopes(self.state, self.changes, self.K, self.C, self.B, speed, damped, self.side)
        at = 0
        while at < values.size:
            end = at + 1
            while end < values.size and abs(values[end] - values[at]) <= COINCIDE * abs(values[at]):
                end += 1
            slopes[:, at:end] = family.of_multiple(values[at:end].mean(), shapes[:, at:end], at)
            at = end
        size = np.abs(values)
        by_size = (np.conj(values) * slopes).real / size
        damping = -values.real / size
        by_damping = -slopes.real / size - damping * by_size / size

        from bearingdyn.results import dataset

        both = ("parameter", "mode")
        return dataset(
            {
                "frequency": ("mode", size / (2 * np.pi), "Hz", "undamped natural frequency |λ|/2π"),
                "damping_ratio": ("mode", damping, "1", "−Re λ/|λ|"),
                "eigenvalue": ("mode", values, "rad/s", "λ of exp(λt)"),
                "frequency_derivative": (both, by_size / (2 * np.pi), "", "Hz per unit of the parameter"),
                "damping_ratio_derivative": (both, by_damping, "", "per unit of the parameter"),
                "eigenvalue_derivative": (both, slopes, "", "rad/s per unit of the parameter"),
            },
            {"analysis": "gradient of modes", "speed": speed, "damped": int(damped)},
            {"parameter": (self.parameters, "")},
        )

    def displacement(self, channel: str) -> tuple[float, Array]:
        """Static motion of a channel in the equilibrium, such as a sag, and its derivatives.

        Parameters
        ----------
        channel
            As "shaft.middle.y".

        Returns
        -------
        tuple of float and numpy.ndarray
            m or rad, and (parameters,) per unit of each.

        Raises
        ------
        ValueError
            For a machine without equilibrium.
        """
        eq = self._equilibrium()
        row = eq.system.row(channel)
        return float(row @ eq.x), self.x @ row

    def strain(self, part: str) -> tuple[float, Array]:
        """Nominal strain of a layer in the equilibrium (`Layer.nominal_strain`), and its derivatives.

        Parameters
        ----------
        part
            Name of the layer.

        Returns
        -------
        tuple of float and numpy.ndarray
            Fraction, and (parameters,) per unit of each.

        Raises
        ------
        ValueError
            For a machine without equilibrium, and for a part that is no layer.
        """
        eq = self._equilibrium()
        layers = {t.name: t.source for t in eq.system.parts if isinstance(t.source, Layer)}
        require(part in layers, "part", part, f"it must be a layer; {meant(part, layers)}")
        layer = layers[part]
        rows = eq.system.rows(f"{part}.outer") - eq.system.rows(f"{part}.inner")
        q, found = rows @ eq.x, np.zeros(len(self.changes))
        r, half = 0.5 * (layer.r_inner + layer.r_outer), 0.5 * layer.width
        phi, side = self._strained_at(q, r, half)
        dimensions = ("r_inner", "r_outer", "width")
        plain = {name: float(getattr(layer, name)) for name in dimensions}

        def strain(q: Complex, at: Mapping[str, complex]) -> complex:
            mean = 0.5 * (at["r_inner"] + at["r_outer"])
            z = side * 0.5 * at["width"]
            rho = np.array([mean * math.cos(phi), mean * math.sin(phi), z])
            u = q[:3] + np.array(
                [q[4] * rho[2] - q[5] * rho[1], q[5] * rho[0] - q[3] * rho[2], q[3] * rho[1] - q[4] * rho[0]]
            )
            return complex(np.sqrt(u @ u) / (at["r_outer"] - at["r_inner"]))

        for p, change in enumerate(self.changes.values()):
            dims = {k: v + 1j * STEP * change.dimensions.get((part, k), 0.0) for k, v in plain.items()}
            found[p] = strain(q + 1j * STEP * (rows @ self.x[p]), dims).imag / STEP
        return strain(q.astype(np.complex128), plain).real, found

    @staticmethod
    def _strained_at(q: Array, r: float, half: float) -> tuple[float, float]:
        """Azimuth and edge where the layer is strained most; as `Layer.nominal_strain` looks for it."""
        phi = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
        best = (-1.0, 0.0, 1.0)
        for side in (-1.0, 1.0):
            rho = np.stack([r * np.cos(phi), r * np.sin(phi), np.full_like(phi, side * half)], -1)
            size = np.linalg.norm(q[:3] + np.cross(q[3:], rho), axis=1)
            k = int(size.argmax())
            if size[k] > best[0]:
                best = (float(size[k]), float(phi[k]), side)
        return best[1], best[2]

    def _equilibrium(self) -> Equilibrium:
        require(
            isinstance(self.source, Equilibrium),
            "source",
            self.source,
            "take the gradient of bd.equilibrium(app)",
        )
        assert isinstance(self.source, Equilibrium)
        return self.source


def gradient(
    source: Equilibrium | Application | System,
    parameters: Sequence[str] | Mapping[str, Any],
    *,
    side: str | None = None,
) -> Gradient:
    """Gradient of a machine's responses, modes, sag and strain with respect to what it is made of.

    Parameters
    ----------
    source
        Equilibrium, through which clearances, preloads and moduli act on the bearings' tangents too; or an
        application or system without bearings.
    parameters
        Names: "layer.r_inner", "layer.r_outer", "layer.width" of a layer's part, its material's "layer.G0",
        "layer.G1", "layer.tau1", "layer.eta0", "layer.K" and "layer.density"; "left.clearance" of a bearing;
        "load.shaft.middle.z", a constant load's component, such as a preload; "rotor.mass" and
        "rotor.inertia.x" of a rigid body; "rotor.centre.stiffness.y" and "….damping.y" of a support, or of a
        spring by its name. Or a mapping of your own names to one of these, to several that change together,
        or to weights: {"thickness": {"left.r_outer": 1.0, "right.r_outer": 1.0}}.
    side
        None: refuse where a derivative has two sides. "parted": a ball that just touches its races counts as
        parted from them. "up", "down": of modes that coincide and are parted by a parameter, the derivatives
        for growing or falling values of it.

    Returns
    -------
    Gradient

    Raises
    ------
    ValueError
        For an unknown parameter; where a ball just touches, naming it, as the stiffness of a contact begins
        with an infinite slope; for lubricated bearings, waves, pits and averages over angles, which are not
        differentiated.

    References
    ----------
    R. L. Fox and M. P. Kapoor, AIAA J. 6 (1968) 2426 (modes).

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6, damping=[20.0] * 6)
    >>> slope = bd.gradient(app, ["mass.centre.stiffness.y"])
    >>> found = slope.response([0.0], ["mass.centre.y"], ["mass.centre.y"])
    >>> f"{found['derivative'].values.real.item():.3e}"  # of 1/k: −1/k²
    '-1.000e-12'
    """
    one_of("side", side, SIDES)
    state = linear(source, "viscous")
    system = state.system
    changes = changes_of(system, parameters)
    count, coefs = len(changes), len(state.K)
    K, C = np.zeros((count, coefs, coefs)), np.zeros((count, coefs, coefs))
    x = np.zeros((count, system.n))
    B: dict[int, Array] = {}
    if isinstance(source, Equilibrium):
        check_differentiable(source)
        for p, change in enumerate(changes.values()):
            if change.clearance:
                B[p] = coefficient_slope(system, change)
        x, K, C = implicit_slopes(source, changes, B, side)
    kept = source if isinstance(source, Equilibrium) else system
    return Gradient(kept, state, changes, x, K, C, B, side)
