"""A full model projected on the shapes of a reduction: a superelement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from bearingdyn.cms.basis import Basis, basis_of
from bearingdyn.cms.full_model import FullModel, RigidInterface
from bearingdyn.cms.modal_damping import modal_damping
from bearingdyn.cms.reduction_options import check_held
from bearingdyn.cms.superelement import Superelement
from bearingdyn.cms.viscoelastic import Viscoelastic
from bearingdyn.fem import rigid_body_residual, rigid_transfer


def reduce(
    model: FullModel,
    *,
    f_max: float | None = None,
    n_modes: int | None = None,
    moduli: Sequence[float] | None = None,
    inertia: int = 1,
    attach: Iterable[str] = (),
    damping: float = 0.0,
    held: str | None = None,
) -> Superelement:
    """Reduction of a full model to a superelement: constraint modes, shapes that vanish on the interfaces.

    Parameters
    ----------
    model
        The part's unreduced equations.
    f_max
        Keep the fixed-interface modes up to this frequency, Hz.
    n_modes
        Instead of f_max: keep so many. Give one of the two.
    moduli
        Shear moduli, Pa, at which the constraint modes of a viscoelastic part are taken (modulus_levels). The
        first serves as reference: constraint modes, fixed-interface modes, diagonal stiffness. Each further
        one adds the differences of its constraint modes, up to 6 (i - 1) shapes for i interfaces.
    inertia
        Rounds of inertia_shapes of the constraint modes at each modulus, 6 i shapes each. One is worth far
        more than the same number of further modes; 0 is the basis of Craig and Bampton and of the paper.
    attach
        Outputs where loads may act: their static shapes at each modulus join the basis, so that the motion a
        load there causes is statically exact, which truncated modes leave to chance.
    damping
        Ratio ζ of every elastic mode (modal_damping) of the body with only its elastic stiffness. It is added
        to the model's own C.
    held
        Interface at which the damped body is held; None: it is free. Dampers then act on the motion relative
        to that interface, never on rigid motion.

    Returns
    -------
    Superelement

    Raises
    ------
    ValueError
        For a stiffness that resists rigid motion (unless model.grounded), interfaces that leave the body free
        to move, an unknown output, and values outside their range.

    References
    ----------
    Paper (21)-(25); Craig & Bampton (1968); attachment, Craig & Chang, AIAA Paper 77-405 (1977).
    """
    check_held(held, model.interfaces)
    basis = basis_of(model, f_max=f_max, n_modes=n_modes, moduli=moduli, inertia=inertia, attach=attach)
    return project(model, basis, damping=damping, held=held)


def project(model: FullModel, basis: Basis, *, damping: float = 0.0, held: str | None = None) -> Superelement:
    """Reduction of a full model to a superelement in a given basis, Psiᵀ A Psi for each of its matrices.

    Parameters
    ----------
    model
        The part's unreduced equations.
    basis
        The shapes, such as those of `basis_of`.
    damping, held
        As in `reduce`.

    Returns
    -------
    Superelement

    Raises
    ------
    ValueError
        For a stiffness that resists rigid motion (unless model.grounded), and values outside their range.
    """
    faces = list(model.interfaces.values())
    r = 6 * len(faces)
    R = rigid_transfer([f.position for f in faces], np.mean([f.position for f in faces], axis=0))
    M = basis.reduce(model.M)
    P = np.eye(len(M))
    if not model.grounded:
        rigid = basis.Psi[:, :r] @ R
        for name, A in [
            ("K", model.K),
            *((f"viscoelastic[{i}].H", p.H) for i, p in enumerate(model.viscoelastic)),
        ]:
            residual = rigid_body_residual(A, rigid)
            if not residual < 1e-6:
                raise ValueError(
                    f"{name} resists rigid motion (relative force {residual:.2g}); the body must be free"
                )
        P[:r, :r] -= R @ np.linalg.solve(R.T @ R, R.T)  # rigid motion costs nothing: remove round-off
    if model.viscoelastic:
        K = P.T @ basis.reduce(model.K) @ P
    else:
        K = basis.stiffness()
        k = P[:r, :r].T @ basis.K @ P[:r, :r]
        K[:r, :r] = 0.5 * (k + k.T)
    E = K if model.E is None else P.T @ basis.reduce(model.E) @ P
    if held is None:
        C = modal_damping(M, E, damping)
    else:
        own = np.arange(6) + 6 * list(model.interfaces).index(held)
        others = np.setdiff1d(np.arange(len(M)), own)
        inside = np.ix_(others, others)
        relative = np.eye(len(M))[others]
        carried = rigid_transfer([f.position for f in faces], model.interfaces[held].position)
        relative[:, own] -= np.vstack([carried, np.zeros((len(M) - r, 6))])[others]
        C = relative.T @ modal_damping(M[inside], E[inside], damping) @ relative
    N = np.zeros_like(M)
    if model.spin is not None and damping > 0.0:
        CJ = C @ np.linalg.solve(M, basis.Psi.T @ (model.M @ (model.spin @ basis.Psi)))
        N = -0.5 * (CJ - CJ.T)
    if model.C is not None:
        C = C + basis.reduce(model.C)
    return Superelement(
        M=M,
        C=C,
        G=np.zeros_like(M) if model.G is None else basis.reduce(model.G, skew=True),
        K=K,
        N=N,
        interfaces={name: np.arange(6 * i, 6 * i + 6) for i, name in enumerate(model.interfaces)},
        outputs={name: np.asarray(row @ basis.Psi) for name, row in model.outputs.items()},
        viscoelastic=tuple(
            Viscoelastic(part.material, P.T @ basis.reduce(part.H) @ P, part.volume)
            for part in model.viscoelastic
        ),
    )


def reduce_free_body(
    M: Any,
    K: Any,
    interfaces: Mapping[str, RigidInterface],
    outputs: Mapping[str, Any] | None = None,
    *,
    G: Any = None,
    spin: Any = None,
    damping: float = 0.0,
    held: str | None = None,
    f_max: float | None = None,
    n_modes: int | None = None,
) -> Superelement:
    """Reduction of an elastic body free in space to a superelement, by Craig-Bampton.

    Parameters
    ----------
    M, K
        Mass, kg, and stiffness, N/m, (n, n), dense or sparse.
    interfaces
        name -> rigid interface, no coordinate in two of them.
    outputs
        name -> rows (6, n) or (3, n).
    G
        Gyroscopic matrix (n, n), skew, its force being Ω G ẋ; None: none.
    spin
        (n, n) generator J of a turn about z for a body of revolution that turns with the shaft: its damping
        then acts on ẋ - Ω J x, and the superelement has the circulatory matrix N = -C J.
    damping
        Ratio ζ of every elastic mode (modal_damping).
    held
        Interface at which the damped body is held; None: it is free. Dampers then act on the motion relative
        to that interface, never on rigid motion.
    f_max, n_modes
        As in craig_bampton.

    Returns
    -------
    Superelement

    Raises
    ------
    ValueError
        For interfaces that overlap, or a stiffness that resists rigid motion.
    """
    model = FullModel(M=M, G=G, K=K, interfaces=interfaces, outputs=outputs or {}, spin=spin)
    return reduce(model, f_max=f_max, n_modes=n_modes, inertia=0, damping=damping, held=held)
