"""A part marched in time by itself, unreduced or reduced: the check of a reduction in the time domain."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn import core
from bearingdyn.checks import positive
from bearingdyn.cms.full_model import FullModel
from bearingdyn.cms.superelement import Superelement
from bearingdyn.fem import factorise
from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class March:
    """The march of a part by itself: time (steps + 1,), s, motion, name -> (steps + 1, 6 or 3), m and rad."""

    time: Array
    motion: Mapping[str, Array]

    __repr__ = short


def branch_weights(dt: float, modulus: float, tau: float) -> tuple[float, float, float]:
    """Weights of a branch in a part's march: S ← decay S + old ė + now ė⁺, the rate linear over dt.

    They are the core's own, read off its answers to three rates. dt and tau in s, modulus in Pa.

    References
    ----------
    Paper (9), (10).
    """
    rates = np.array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]])
    stress = core.maxwell_stress(rates, dt, 0.0, 0.0, np.array([modulus]), np.array([tau]))
    old, now = stress[1].tolist()
    return (float(stress[2, 0]) / old if old > 0 else math.exp(-dt / tau)), old, now


def march(
    model: FullModel | Superelement,
    loads: Mapping[str, ArrayLike],
    dt: float,
    *,
    fixed: Sequence[str] = (),
    record: Sequence[str] | None = None,
    beta: float = 0.25,
    gamma: float = 0.5,
) -> March:
    """March a part by itself from rest: Newmark's scheme, the core's history of branches (paper (14), (9)).

    One sparse factorisation in all; each step costs a solve and a product with each matrix. The body is not
    turning: G and N are left out.

    Parameters
    ----------
    model
        The part, unreduced or reduced.
    loads
        Interface or output -> (steps + 1, 6 or 3) forces, N, and moments, N m, at 0, dt, ...
    dt
        Time step, s.
    fixed
        Interfaces held still.
    record
        Interfaces and outputs whose motion is kept; None: all that can move.
    beta, gamma
        Of Newmark's scheme.

    Returns
    -------
    March

    Raises
    ------
    ValueError
        For unknown names, loads of unequal length, a time step that is not positive, and a viscoelastic
        material that is not a Maxwell model.
    """
    if isinstance(model, Superelement):
        model = FullModel.of(model)
    positive("dt", dt, "it must be a positive time step in s")
    for part in model.viscoelastic:
        if not all(hasattr(part.material, name) for name in ("G0", "G", "tau", "eta0")):
            raise ValueError(
                f"material is {part.material!r}; the time domain needs a Maxwell model (fit_maxwell)"
            )
    rows = _moving_rows(model, fixed)
    Tr = rows.pop("")
    for name in [*loads, *(record or ())]:
        if name not in rows:
            raise ValueError(f"no moving interface or output {name!r}; there are {sorted(rows)}")
    force = {name: np.asarray(f, dtype=np.float64) for name, f in loads.items()}
    lengths = {len(f) for f in force.values()}
    if len(lengths) != 1:
        raise ValueError(f"loads have lengths {sorted(lengths)}; give one value for each of the same times")
    for name, f in force.items():
        if f.shape[1:] != (rows[name].shape[0],) or not np.isfinite(f).all():
            raise ValueError(
                f"loads[{name!r}] has shape {f.shape}; it must be (steps + 1, {rows[name].shape[0]}), finite"
            )
    steps = lengths.pop() - 1

    def small(A: Any) -> Any:
        return scipy.sparse.csr_matrix(Tr.T @ A @ Tr)

    M, K = small(model.M), small(model.K)
    C = small(model.C) if model.C is not None else 0.0 * M
    histories = []
    for part in model.viscoelastic:
        m: Any = part.material
        H = small(part.H)
        weights = [branch_weights(dt, G, tau) for G, tau in zip(m.G.tolist(), m.tau.tolist(), strict=True)]
        K = K + 2.0 * m.G0 * H
        C = C + (2.0 * m.eta0 + sum(now for _, _, now in weights)) * H
        histories.append((H, weights, np.zeros((len(weights), Tr.shape[1]))))
    lu = factorise(M + gamma * dt * C + beta * dt**2 * K)

    kept = {name: rows[name] for name in (record if record is not None else rows)}
    motion = {name: np.zeros((steps + 1, R.shape[0])) for name, R in kept.items()}
    x, v = np.zeros(Tr.shape[1]), np.zeros(Tr.shape[1])
    start = np.asarray(sum(rows[name].T @ f[0] for name, f in force.items()))
    a = factorise(M).solve(start) if np.any(start) else np.zeros(Tr.shape[1])
    for step in range(1, steps + 1):
        x = x + dt * v + dt**2 * (0.5 - beta) * a
        v_old, v = v, v + dt * (1.0 - gamma) * a
        f = sum(rows[name].T @ f[step] for name, f in force.items())
        f = f - K @ x - C @ v
        for H, weights, S in histories:
            for i, (decay, old, _) in enumerate(weights):
                S[i] = decay * S[i] + old * v_old
            f = f - H @ S.sum(axis=0)
        a = lu.solve(f)
        x, v = x + beta * dt**2 * a, v + gamma * dt * a
        for _, weights, S in histories:
            S += np.array([now for _, _, now in weights])[:, None] * v
        for name, R in kept.items():
            motion[name][step] = R @ x
    return March(dt * np.arange(steps + 1, dtype=np.float64), motion)


def _moving_rows(model: FullModel, fixed: Sequence[str]) -> dict[str, Any]:
    """Rows of each moving interface and each output in the coordinates that can move; "": the change to them.

    Those are six for each interface that is not fixed, and then the coordinates on no interface.
    """
    for name in fixed:
        if name not in model.interfaces:
            raise ValueError(f"fixed has {name!r}; the interfaces are {sorted(model.interfaces)}")
    faces = {name: face for name, face in model.interfaces.items() if name not in fixed}
    held = np.concatenate([np.zeros(0, dtype=np.intp), *(f.dofs for f in model.interfaces.values())])
    inner = np.setdiff1d(np.arange(model.n), held)
    count = 6 * len(faces)
    Tr = scipy.sparse.lil_matrix((model.n, count + inner.size))
    for i, face in enumerate(faces.values()):
        Tr[face.dofs, 6 * i : 6 * i + 6] = face.T
    Tr[inner, count + np.arange(inner.size)] = 1.0
    Tr = Tr.tocsr()
    one = scipy.sparse.eye(count + inner.size, format="csr")
    rows = {name: one[6 * i : 6 * i + 6] for i, name in enumerate(faces)}
    rows |= {name: scipy.sparse.csr_matrix(R @ Tr) for name, R in model.outputs.items()}
    return rows | {"": Tr}
