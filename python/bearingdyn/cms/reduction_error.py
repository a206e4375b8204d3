"""The error of a reduction against the full model, frequency by frequency: estimated, or exact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, name_list, number, numbers, require, truth, whole
from bearingdyn.cms.basis import Basis, orthogonalise
from bearingdyn.cms.dynamic_stiffness import Dynamics, Transfer
from bearingdyn.cms.full_model import FullModel
from bearingdyn.cms.reduction import project
from bearingdyn.cms.superelement import Superelement
from bearingdyn.fem import rigid_transfer
from bearingdyn.material import answer_of
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex, Index

CHANGE = 0.1  # of the estimated error by the last full solve: below it, no further one is made
WANTED = "it must be one or more positive frequencies in Hz"


@dataclass(frozen=True, eq=False)
class ReductionError:
    """Error of a reduced model against the full one.

    Parameters
    ----------
    frequency
        (f,), Hz.
    by_load
        (f, loads) ‖reduced − full‖/‖full‖ of the response to each unit load (or imposed motion).
    exact
        Each value from a full solve; otherwise an estimate.
    solved
        Frequencies, Hz, at which the full model was solved.
    """

    frequency: Array
    by_load: Array
    exact: bool
    solved: Array

    __repr__ = short
    _repr_html_ = page

    @property
    def error(self) -> Array:
        """The worst load's relative error at each frequency, (f,)."""
        return np.asarray(self.by_load.max(axis=1))

    @property
    def worst(self) -> float:
        """The largest error of all."""
        return float(self.by_load.max())


def reduction_error(
    model: FullModel,
    basis: Basis,
    frequency: ArrayLike,
    *,
    loads: Sequence[str] | None = None,
    fixed: Sequence[str] = (),
    damping: float = 0.0,
    held: str | None = None,
    exact: bool = False,
    solves: int = 12,
    element: Superelement | None = None,
) -> ReductionError:
    """Relative error of a reduction at given frequencies.

    Rotations are measured by the arc they make at the body's radius of gyration. At a lightly damped
    resonance a shift of its frequency counts as an error; it is one, for the response at that frequency.

    Parameters
    ----------
    model
        The part's unreduced equations.
    basis
        The shapes of the reduction.
    frequency
        (f,), Hz, above zero.
    loads
        None: unit motion is imposed on each interface coordinate in turn and the response is the column of
        the interfaces' dynamic stiffness. Or names of interfaces and outputs: a unit force along each of
        their coordinates, and the response is the motion of all interfaces and outputs.
    fixed
        Interfaces held still under the loads.
    damping, held
        Modal damping as in `reduce`; the full model is given the same dampers.
    exact
        Solve the full model at each frequency. Otherwise it is solved at no more than `solves` of them: the
        solutions enlarge the basis (a hierarchical estimate), and the model in the larger basis, which is
        exact where it was solved, stands for the full one in between. Solves are added where the estimate was
        changed most by the last ones, until it changes by less than a tenth.
    solves
        Most solves of the full model for an estimate.
    element
        The reduced matrices to be judged, in the coordinates of the basis, where they are interpolated ones;
        None: the model's projections.

    Returns
    -------
    ReductionError

    Raises
    ------
    ValueError
        For frequencies that are not positive, and for unknown names.

    References
    ----------
    Hierarchical estimates, Bank & Smith, SIAM J. Numer. Anal. 30 (1993) 921-935; rational interpolation of a
    transfer function, Grimme, thesis, Univ. of Illinois (1997).
    """
    f = numbers("frequency", frequency, WANTED)
    require(bool((f > 0).all()), "frequency", frequency, WANTED)
    whole("solves", solves, 3, remedy="the estimate needs a whole number of 3 or more")
    instance("model", model, FullModel, "it must be the full model of a part, part.full_model()")
    instance("basis", basis, Basis, "it must be a bd.cms.Basis, as craig_bampton makes it")
    damping = number("damping", damping, "it must be a damping ratio, 0 <= damping < 1")
    case = _Case(model, basis, loads, fixed, damping, held)
    exact = truth("exact", exact)
    judged = project(model, basis)
    if element is not None:
        instance("element", element, Superelement, "it must be a bd.Superelement, or None: the model's own")
        require(
            element.K.shape == judged.K.shape,
            "element",
            element,
            f"it must have the {len(judged.K)} coordinates of the basis",
        )
        judged = replace(element, C=judged.C)  # the case adds the dampers
    omega = 2.0 * np.pi * f
    reduced = [case.response(t) for t in case.reduced(basis, judged, omega)]
    if exact:
        full = [case.response(case.dynamics.solve(w)[0]) for w in omega]
        return ReductionError(f, _relative(reduced, full), True, f)

    order = np.argsort(f)
    chosen = sorted({int(order[0]), int(order[-1]), int(order[f.size // 2])})
    shapes, true = [], {}
    for i in chosen:
        transfer, *motion = case.dynamics.solve(omega[i])
        shapes.append(np.hstack(motion))
        true[i] = case.response(transfer)
    estimate: Array | None = None
    while True:
        larger = case.enlarged(basis, shapes, omega[chosen])
        full = [case.response(t) for t in case.reduced(larger, project(model, larger), omega)]
        for i, response in true.items():
            full[i] = response
        last, estimate = estimate, _relative(reduced, full)
        if len(chosen) >= min(solves, f.size):
            break
        if last is not None:
            change = np.abs(estimate - last).max(axis=1) / np.maximum(estimate.max(axis=1), 1e-12)
            change[chosen] = 0.0
            if change.max() < CHANGE:
                break
            new = int(np.argmax(change))
        else:
            new = _widest_gap(f, chosen)
        transfer, *motion = case.dynamics.solve(omega[new])
        shapes.append(np.hstack(motion))
        true[new] = case.response(transfer)
        chosen.append(new)
    return ReductionError(f, estimate, False, np.sort(f[chosen]))


def _widest_gap(f: Array, chosen: Sequence[int]) -> int:
    """The frequency farthest, on a logarithmic scale, from those chosen."""
    distance = np.abs(np.log(f[:, None] / f[list(chosen)])).min(axis=1)
    return int(np.argmax(distance))


def _relative(reduced: Sequence[Complex], full: Sequence[Complex]) -> Array:
    """Column by column ‖reduced − full‖/‖full‖, (frequencies, columns)."""
    return np.array(
        [
            np.linalg.norm(a - b, axis=0) / np.linalg.norm(b, axis=0)
            for a, b in zip(reduced, full, strict=True)
        ]
    )


class _Case:
    """What is loaded, held and observed, and the damping all models share."""

    def __init__(
        self,
        model: FullModel,
        basis: Basis,
        loads: Sequence[str] | None,
        fixed: Sequence[str],
        damping: float,
        held: str | None,
    ) -> None:
        known = [*model.interfaces, *model.outputs]
        fixed = name_list("fixed", fixed, "interfaces")
        loads = None if loads is None else name_list("loads", loads, "interfaces and outputs")
        for name in [*(loads or ()), *fixed]:
            if name not in known or (name in fixed and name not in model.interfaces):
                raise ValueError(f"loads or fixed has {name!r}; interfaces and outputs are {known}")
        self.model, self.r = model, 6 * len(model.interfaces)
        rows = [row.toarray() for row in model.outputs.values()] if loads is not None else []
        self.points = np.vstack([np.zeros((0, model.n)), *rows])
        length = _radius_of_gyration(model, basis)
        six = np.array([1.0] * 3 + [length] * 3)
        faces = list(model.interfaces)
        free = [6 * faces.index(name) + np.arange(6) for name in faces if name not in fixed]
        self.free: Index = np.concatenate([np.zeros(0, dtype=np.intp), *free])
        self.scale = np.concatenate([np.tile(six, len(free)), *(six[: len(row)] for row in rows)])
        self.columns: Index | None = None
        if loads is not None:
            at, start = {}, 0
            for name, size in [
                *((name, 6) for name in faces if name not in fixed),
                *((name, row.shape[0]) for name, row in model.outputs.items()),
            ]:
                at[name] = np.arange(start, start + size)
                start += size
            for name in loads:
                if name not in at:
                    raise ValueError(f"{name!r} is both loaded and fixed; load what can move")
            self.columns = np.concatenate([at[name] for name in loads])
        element = project(model, basis, damping=damping, held=held)
        C = element.C if model.C is None else element.C - basis.reduce(model.C)
        self.damper = None
        if damping > 0.0:
            MPsi = np.asarray(model.M @ basis.Psi)
            inverse = np.linalg.inv(element.M)
            self.damper = (MPsi, inverse @ C @ inverse)
        self.dynamics = Dynamics(model, self.points, self.damper)

    def response(self, t: Transfer) -> Complex:
        """Scaled response, a column for each load."""
        if self.columns is None:
            six = np.tile(self.scale[:6], self.r // 6)
            return np.asarray(t.D / six / six[:, None])
        scaled = t.receptance(self.free) * self.scale[:, None] / self.scale
        return np.asarray(scaled[:, self.columns])

    def reduced(self, basis: Basis, element: Superelement, omega: Array) -> list[Transfer]:
        """Transfers of reduced matrices in the coordinates of a basis; the dampers are the case's own."""
        small = FullModel.of(element)
        damper = None
        if self.damper is not None:
            B, c = self.damper
            damper = (basis.Psi.T @ B, c)
        dynamics = Dynamics(small, self.points @ basis.Psi, damper)
        return [dynamics.solve(w)[0] for w in omega]

    def enlarged(self, basis: Basis, shapes: Sequence[Any], omega: Array) -> Basis:
        """The basis with what full solutions (inner, columns) have besides."""
        inner = self.dynamics.inner
        K = self.model.K
        for part in self.model.viscoelastic:
            G = np.exp(np.mean([np.log(np.abs(complex(answer_of(part.material, w)))) for w in omega]))
            K = K + 2.0 * G * part.H
        K, M = K[inner][:, inner], self.model.M[inner][:, inner]
        own = basis.Psi[inner]
        extra = []
        for u in shapes:
            new = np.hstack([u.real, u.imag]) if np.iscomplexobj(u) else u
            new[:, : self.r] -= own[:, : self.r]
            extra.append(new)
        internal = own[:, self.r :]
        energy = np.sum(internal * (K @ internal), axis=0)
        internal = internal / np.sqrt(energy)
        columns = np.hstack(extra)
        own_energy = internal.T @ (K @ internal)
        for _ in range(2):  # twice, for round-off
            share = np.linalg.lstsq(own_energy, internal.T @ (K @ columns), rcond=None)[0]
            columns = columns - internal @ share
        energy = np.sum(columns * (K @ columns), axis=0)
        columns = columns[:, energy > 0] / np.sqrt(energy[energy > 0])
        frequency, phi = orthogonalise(np.hstack([internal, columns]), K, M)
        Psi = np.zeros((self.model.n, self.r + frequency.size))
        Psi[:, : self.r] = basis.Psi[:, : self.r]
        Psi[inner, self.r :] = phi
        return Basis(Psi, basis.K, frequency)


def _radius_of_gyration(model: FullModel, basis: Basis) -> float:
    """√(trace of the inertia tensor / 2m) about the centre of mass, m, from the constraint modes."""
    faces = list(model.interfaces.values())
    R = rigid_transfer([f.position for f in faces])
    rigid = basis.Psi[:, : len(R)] @ R
    inertia = rigid.T @ (model.M @ rigid)
    m = inertia[0, 0]
    if not m > 0:
        return 1.0
    centre = np.array([inertia[1, 5], inertia[2, 3], inertia[0, 4]]) / m
    about = np.trace(inertia[3:, 3:]) - 2.0 * m * float(centre @ centre)
    return math.sqrt(max(about, 0.0) / (2.0 * m)) or 1.0
