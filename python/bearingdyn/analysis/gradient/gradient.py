"""Derivatives of what a machine does with respect to what it is made of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.analysis.frequency_response import frequencies
from bearingdyn.analysis.gradient.contact_tangent import STEP, grazing, tangent
from bearingdyn.analysis.gradient.parameters import (
    Change,
    arm_slope,
    changes_of,
    kernel_slope,
    modulus_slope,
    relaxation_slope,
)
from bearingdyn.analysis.inputs_outputs import Input, Output, recovered
from bearingdyn.analysis.linearised import Linear, linear
from bearingdyn.analysis.modes import modes
from bearingdyn.analysis.static_balance import HOLD, diagonal_blocks
from bearingdyn.application import QUANTITIES, Application
from bearingdyn.bearing import BallBearing
from bearingdyn.checks import meant, name_list, one_of, require, truth, whole
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer
from bearingdyn.system import System, natural
from bearingdyn.types import Array, Complex, Index
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
        felt = self._felt(rows)
        every = np.eye(system.n)[felt]
        if speed == 0.0:
            both = self.state.solve(omega, np.vstack([force, rows]), every, 0.0)
            x, y = both[:, :, : len(force)], both[:, :, len(force) :]
        else:
            # gyroscopic and circulatory forces are skew: the adjoint turns the other way
            x = self.state.solve(omega, force, every, speed)
            y = self.state.solve(omega, rows, every, -speed)
        plain = np.asarray(rows[:, felt] @ x)
        response = recovered(
            wanted, given, plain, omega, speed, power, np.zeros((f.size, 0, 0), dtype=np.complex128)
        )
        rate = 1j * omega
        scale = np.stack([rate ** (power + (2 - power if i.axis is not None else 0)) for i in given], axis=1)[
            :, None, :
        ]
        shears: dict[int, Complex] = {}
        for layer in {k for c in self.changes.values() for k, _ in c.shear}:
            L = system.layers[layer].L[felt]
            own = np.flatnonzero(np.abs(L).sum(axis=1))
            shears[layer] = (y[:, own].transpose(0, 2, 1) @ L[own]) @ (L[own].T @ x[:, own])
        slopes = np.array(
            [self._slope(c, p, felt, x, y, omega, given, shears) for p, c in enumerate(self.changes.values())]
        )
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

    def _felt(self, rows: Array) -> Index:
        """Coordinates that the outputs' rows (k, n) and the changes of the system touch."""
        touched = np.abs(rows).sum(axis=0)
        for change in self.changes.values():
            for A in (change.M, change.C, change.K, *change.H.values()):
                if A is not None:
                    touched += np.abs(A).sum(axis=0)
            for layer, _ in change.shear:
                touched += np.abs(self.state.system.layers[layer].L).sum(axis=1)
            if change.inertia is not None:
                touched += np.abs(change.inertia).sum(axis=1)
        for A in self.B.values():
            touched += np.abs(A).sum(axis=0)
        if self.K.any() or self.C.any() or self.B:
            touched += np.abs(self.state.system.B).sum(axis=0)
        return np.asarray(np.flatnonzero(touched > 0), dtype=np.intp)

    def _slope(
        self,
        change: Change,
        p: int,
        felt: Index,
        x: Complex,
        y: Complex,
        omega: Array,
        given: Sequence[Input],
        shears: Mapping[int, Complex],
    ) -> Complex:
        """−yᵀ Z' x + yᵀ f' (f, k, i) of one parameter, from x and y at the coordinates `felt`.

        shears: yᵀ L Lᵀ x of every layer whose modulus changes.
        """
        system, turned = self.state.system, y.transpose(0, 2, 1)

        def between(A: Array) -> Complex:
            A = A[np.ix_(felt, felt)]
            own = np.flatnonzero(np.abs(A).sum(axis=0))
            return np.asarray(turned[:, :, own] @ (A[np.ix_(own, own)] @ x[:, own]))

        w = omega[:, None, None]
        total = np.zeros((omega.size, y.shape[2], x.shape[2]), dtype=np.complex128)
        if change.K is not None:
            total += between(change.K)
        if change.C is not None:
            total += 1j * w * between(change.C)
        if change.M is not None:
            total -= w**2 * between(change.M)
        if self.K[p].any() or self.C[p].any():
            B = system.B[:, felt]
            Bx, By = B @ x, turned @ B.T
            for A, factor in ((self.K[p], np.ones_like(w)), (self.C[p], 1j * w)):
                if A.any():
                    total += factor * (By @ (A @ Bx))
        if p in self.B:
            # (B'ᵀ A B + Bᵀ A B'), A = K + iωC
            for A, factor in ((self.state.K, np.ones_like(w)), (self.state.C, 1j * w)):
                half = self.B[p].T @ A @ system.B
                total += factor * between(half + half.T)
        for layer, H in change.H.items():
            G = np.asarray(system.layers[layer].material.complex_modulus(omega))
            total += 2.0 * G[:, None, None] * between(H)
        sheared: dict[int, Complex] = {}
        for (layer, name), weight in change.shear.items():
            dG = modulus_slope(system.layers[layer].material, name, 1j * omega)
            sheared[layer] = sheared.get(layer, 0.0) + weight * dG
        for layer, dG in sheared.items():
            total += 2.0 * dG[:, None, None] * shears[layer]
        if change.inertia is not None:
            for i, one in enumerate(given):
                if one.axis is not None:
                    total[:, :, i] += turned @ change.inertia[felt, one.axis]
        return -total

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
        at = 0
        while at < values.size:
            end = at + 1
            while end < values.size and abs(values[end] - values[at]) <= COINCIDE * abs(values[at]):
                end += 1
            slopes[:, at:end] = self._of_multiple(values[at:end].mean(), shapes[:, at:end], at, speed, damped)
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

    def _of_multiple(self, value: complex, V: Complex, first: int, speed: float, damped: bool) -> Complex:
        """λ' (parameters, m) of an m-fold eigenvalue with shapes V (n, m)."""
        s, B = self.state.system, self.state.system.B
        K = (s.K + B.T @ self.state.K @ B).astype(np.complex128)
        C = (s.C + B.T @ self.state.C @ B) if damped else np.zeros_like(s.C)
        turning = speed * s.G if damped else np.zeros_like(s.G)
        dZ = C + turning + 2 * value * s.M
        Z = K + value * (C + turning) + value**2 * s.M + (speed * s.N if damped else 0.0)
        for layer in s.layers:
            m, L = layer.material, layer.L
            shear = complex(m.G0)
            if damped:
                shear += value * m.eta0 + complex(np.sum(m.G * value * m.tau / (1 + value * m.tau)))
                rising = m.eta0 + complex(np.sum(m.G * m.tau / (1 + value * m.tau) ** 2))
                dZ = dZ + 2 * rising * (L @ L.T)
            Z += 2 * shear * (L @ L.T)
        if damped and speed != 0.0:
            # left vectors, by the smallest singular values of Z scaled by the masses
            scale = 1.0 / np.sqrt(np.abs(np.diag(s.M)))
            u = np.linalg.svd(scale[:, None] * Z * scale)[0][:, -V.shape[1] :]
            W = scale[:, None] * np.conj(u)
        else:
            W = V
        norm = W.T @ dZ @ V
        found = np.zeros((len(self.changes), V.shape[1]), dtype=np.complex128)
        for p, (name, change) in enumerate(self.changes.items()):
            A = np.linalg.solve(norm, -W.T @ self._matrix_slope(change, p, value, damped) @ V)
            if V.shape[1] == 1:
                found[p] = A[0, 0]
                continue
            each = np.linalg.eigvals(A)
            spread, scale_of = np.ptp(each.real) + np.ptp(each.imag), np.abs(each).max()
            if spread > 1e-5 * scale_of and self.side not in ("up", "down"):
                numbers = ", ".join(str(first + k + 1) for k in range(V.shape[1]))
                raise ValueError(
                    f"modes {numbers} coincide at {abs(value) / (2 * math.pi):.6g} Hz, and {name!r} parts "
                    f"them: their derivatives are one-sided; ask for side='up', of a parameter that "
                    f"grows, or 'down'"
                )
            order = np.argsort(each.imag, kind="stable")
            found[p] = each[order if self.side != "down" else order[::-1]]
        return found

    def _matrix_slope(self, change: Change, p: int, value: complex, damped: bool) -> Complex:
        """∂Z/∂(parameter) (n, n) at a rate λ."""
        s, B = self.state.system, self.state.system.B
        total = np.zeros((s.n, s.n), dtype=np.complex128)
        if change.K is not None:
            total += change.K
        if change.M is not None:
            total += value**2 * change.M
        total += B.T @ self.K[p] @ B
        if p in self.B:
            half = self.B[p].T @ (self.state.K + (value if damped else 0.0) * self.state.C) @ B
            total += half + half.T
        if damped:
            total += value * (B.T @ self.C[p] @ B)
            if change.C is not None:
                total += value * change.C
        for k, layer in enumerate(s.layers):
            m, shear = layer.material, 0.0 + 0.0j
            if k in change.H:
                G = complex(m.G0)
                if damped:
                    G += value * m.eta0 + complex(np.sum(m.G * value * m.tau / (1 + value * m.tau)))
                total += 2 * G * change.H[k]
            for (own, name), weight in change.shear.items():
                if own == k:
                    rate = value if damped else 0.0
                    shear += weight * complex(modulus_slope(m, name, rate))
            if shear:
                total += 2 * shear * (layer.L @ layer.L.T)
        return total

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
        _check(source)
        for p, change in enumerate(changes.values()):
            if change.clearance:
                B[p] = _coefficient_slope(system, change)
        x, K, C = _implicit(source, changes, B, side)
    kept = source if isinstance(source, Equilibrium) else system
    return Gradient(kept, state, changes, x, K, C, B, side)


def _coefficient_slope(system: System, change: Change) -> Array:
    """Derivative of B (coefs, n) with the clearances, by which the arm of the rings' tilts changes."""
    found = np.zeros_like(system.B)
    ends = np.cumsum([0, *(len(t.B) for t in system.bearings)])
    for i, weight in change.clearance.items():
        term = system.bearings[i]
        assert isinstance(term.bearing, BallBearing)
        tilts = np.array([(axial, order) == (1, 1) for axial, order, _ in term.series.terms])
        rate = weight * arm_slope(term.bearing)
        moved = sum((rows @ system.rows(name) for name, rows in term.ends.items()), np.zeros(term.B.shape))
        found[ends[i] : ends[i + 1]] = rate * tilts[:, None] * moved
    return found


def _check(eq: Equilibrium) -> None:
    """Refuse what has no derivative here."""
    require(eq.average == 1, "average", eq.average, "it must be 1 for a derivative: one angle of the cages")
    for term in eq.system.bearings:
        name, b, flaws = f"bearing {term.name!r}", term.bearing, term.kernel().imperfections
        if isinstance(b, BallBearing):
            require(not b.lubrication, name, "lubricated", "give it film= and damping= for a derivative")
        law = term.kernel().damping_law
        known = law in ("constant", "load")
        require(known, f"{name}: damping", law, "give bd.ConstantDamping or bd.LoadDamping for a derivative")
        plain = not len(flaws.waves) and not len(flaws.pits) and not len(flaws.oversize)
        require(plain, name, "uneven", "a derivative is of smooth races and equal balls; leave them out")


def _implicit(
    eq: Equilibrium, changes: Mapping[str, Change], slopes: Mapping[int, Array], side: str | None
) -> tuple[Array, Array, Array]:
    """Derivatives of the state x and of the bearings' tangents K, C, through the equilibrium."""
    system, B = eq.system, eq.system.B
    when: str | float = eq.modulus if eq.after is None else float(eq.after)
    moduli = system.static_moduli(when)
    kernels = [t.kernel() for t in system.bearings]
    ends = np.cumsum([0, *(len(k.order) for k in kernels)])
    z = [eq.bearings[t.name].z for t in system.bearings]
    carrying: list[Any] = []
    for term, kernel, at in zip(system.bearings, kernels, z, strict=True):
        touching = grazing(kernel, at)
        if touching.size and side != "parted":
            raise ValueError(
                f"ball {int(touching[0]) + 1} of bearing {term.name!r} just touches its races: its stiffness "
                f"begins there with an infinite slope, and a derivative has two sides; ask for "
                f"side='parted', which counts it as parted, or move clearance, load or angle a little"
            )
        on = tangent(kernel, at).approach.real > 0
        on[touching] = False
        carrying.append(on)
    stiff = diagonal_blocks(
        [tangent(k, a, None, c).K.real for k, a, c in zip(kernels, z, carrying, strict=True)]
    )
    Kt = system.stiffness(moduli) + B.T @ stiff @ B
    squares, T = natural(Kt, system.M)
    force = np.concatenate([np.zeros(0), *(eq.bearings[t.name].g for t in system.bearings)])
    free = T[:, squares <= 0.0]
    held = system.M @ free
    factors = scipy.linalg.cho_factor(Kt + HOLD * (held @ held.T))
    x = np.zeros((len(changes), system.n))
    K, C = (np.zeros((len(changes), ends[-1], ends[-1])) for _ in range(2))
    for p, change in enumerate(changes.values()):
        push = np.zeros(system.n) if change.load is None else change.load.copy()
        if change.inertia is not None:
            push += _gravity(system, change.inertia)
        if change.K is not None:
            push -= change.K @ eq.x
        for k, H in change.H.items():
            push -= 2.0 * moduli[k] * (H @ eq.x)
        for (k, name), weight in change.shear.items():
            layer = system.layers[k]
            assert isinstance(layer.material, Maxwell)
            dG = weight * relaxation_slope(layer.material, name, when)
            push -= 2.0 * dG * (layer.L @ (layer.L.T @ eq.x))
        fields: list[dict[str, complex]] = [{} for _ in kernels]
        for i, weight in change.clearance.items():
            bearing = system.bearings[i].bearing
            assert isinstance(bearing, BallBearing)
            for name, slope in kernel_slope(bearing).items():
                fields[i][name] = getattr(kernels[i], name) + 1j * STEP * weight * slope
            moved = tangent(kernels[i], z[i].astype(np.complex128), fields[i], carrying[i])
            push -= B[ends[i] : ends[i + 1]].T @ moved.g.imag / STEP
        turned = slopes[p] @ eq.x if p in slopes else np.zeros(ends[-1])
        if p in slopes:
            push -= slopes[p].T @ force + B.T @ (stiff @ turned)
        x[p] = scipy.linalg.cho_solve(factors, push)
        for i, kernel in enumerate(kernels):
            own = slice(ends[i], ends[i + 1])
            moved = tangent(kernel, z[i] + 1j * STEP * (B[own] @ x[p] + turned[own]), fields[i], carrying[i])
            K[p, own, own], C[p, own, own] = moved.K.imag / STEP, moved.C.imag / STEP
    return x, K, C


def _gravity(system: System, inertia: Array) -> Array:
    """What a change of the masses adds to the constant loads that are a field of gravity."""
    total = np.zeros(system.n)
    for load in system.loads:
        if load.kind == "constant" and not load.part and system.inertia is not None:
            field = np.linalg.lstsq(system.inertia, load.p_cos, rcond=None)[0]
            missed = np.abs(system.inertia @ field - load.p_cos).max()
            if missed <= 1e-9 * np.abs(load.p_cos).max():
                total += inertia @ field
    return total
