"""A part before its reduction: sparse matrices, rigid interfaces, output rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bearingdyn.checks import instance, items, named, truth
from bearingdyn.cms.frozen_matrices import check_symmetry, frozen, frozen_sparse
from bearingdyn.cms.superelement import Superelement
from bearingdyn.cms.viscoelastic import Viscoelastic
from bearingdyn.pictures import page
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Index


@dataclass(frozen=True, eq=False)
class RigidInterface:
    """A rigid interface of a full model: coordinates moved by six of one rigid body, u[dofs] = T q.

    Parameters
    ----------
    dofs
        (m,) indices into the model's coordinates.
    T
        (m, 6) for q = (x, y, z, θx, θy, θz) of the reference point.
    position
        (3,) reference point, m.
    """

    dofs: Index
    T: Array
    position: Array

    __repr__ = short

    def __post_init__(self) -> None:
        dofs = np.array(self.dofs)
        if dofs.ndim != 1 or dofs.size == 0 or not np.issubdtype(dofs.dtype, np.integer):
            raise ValueError(f"dofs has shape {dofs.shape}, type {dofs.dtype}; it must be a list of integers")
        if np.unique(dofs).size != dofs.size:
            raise ValueError("dofs names a coordinate twice; name each once")
        object.__setattr__(self, "dofs", dofs.astype(np.intp))
        object.__setattr__(self, "T", frozen("T", self.T, (dofs.size, 6)))
        object.__setattr__(self, "position", frozen("position", self.position, (3,)))


@dataclass(frozen=True, eq=False, kw_only=True)
class FullModel:
    """A part's full, unreduced equations: M ẍ + (C + Ω G) ẋ + K x + Σ 2 G*(ω) H x = f (paper (14)).

    Parameters
    ----------
    M
        (n, n) symmetric mass, kg, dense or sparse, as all that follow; kept as csr. Rotations mix in rad, N
        m.
    C
        (n, n) symmetric viscous damping, N s/m; None: none.
    G
        (n, n) skew-symmetric, kg, as in Superelement; None: none.
    K
        (n, n) symmetric stiffness, N/m: that of the elastic regions, and the bulk modulus times ∫BᵀmmᵀB dV of
        the viscoelastic ones.
    E
        (n, n) the part of K that belongs to elastic regions; a damping ratio refers to its modes. None: all
        of K.
    interfaces
        name -> RigidInterface; no coordinate in two of them.
    outputs
        name -> rows (6, n) or (3, n), the motion of a named point; a load f there acts as rowsᵀ f.
    viscoelastic
        The materials whose deviatoric stiffness is kept apart, their H sparse (n, n).
    spin
        (n, n) generator J of a turn about z for a body of revolution that turns with the shaft; None: it does
        not turn.
    grounded
        K holds the body in space; otherwise it must leave it free.

    Raises
    ------
    ValueError
        For a wrong shape, a matrix that has an entry that is not finite or lacks its symmetry, interfaces
        that share a coordinate, or a name used twice.
    """

    M: Any
    C: Any = None
    G: Any = None
    K: Any
    E: Any = None
    interfaces: Mapping[str, RigidInterface]
    outputs: Mapping[str, Any] = field(default_factory=dict)
    viscoelastic: tuple[Viscoelastic, ...] = ()
    spin: Any = None
    grounded: bool = False

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        n = np.shape(self.M)[0] if np.ndim(self.M) or hasattr(self.M, "tocsr") else 0
        for name, sign in (("M", 1), ("C", 1), ("G", -1), ("K", 1), ("E", 1), ("spin", -1)):
            if getattr(self, name) is not None:
                A = frozen_sparse(name, getattr(self, name), n)
                check_symmetry(name, A, sign)
                object.__setattr__(self, name, A)
        owner: dict[int, str] = {}
        for name, face in named("interfaces", self.interfaces, "it must map names to RigidInterface").items():
            instance(f"interfaces[{name!r}]", face, RigidInterface, "it must be a RigidInterface")
            for i in face.dofs.tolist():
                if not 0 <= i < n:
                    raise ValueError(f"interfaces[{name!r}] holds index {i}; it must lie in 0...{n - 1}")
                if owner.setdefault(i, name) != name:
                    raise ValueError(f"interfaces {owner[i]!r} and {name!r} share coordinate {i}; move one")
        object.__setattr__(self, "interfaces", dict(self.interfaces))
        outputs: dict[str, Any] = {}
        for name, rows in named("outputs", self.outputs, "it must map names to rows").items():
            if name in self.interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
            count = (*np.shape(rows), 0)[0]
            if count not in (3, 6):
                raise ValueError(f"outputs[{name!r}] has {count} rows; it must have 3 or 6")
            outputs[name] = frozen_sparse(f"outputs[{name!r}]", rows, count, n)
        object.__setattr__(self, "outputs", outputs)
        listed = items("viscoelastic", self.viscoelastic, "it must be a list of Viscoelastic")
        object.__setattr__(self, "viscoelastic", tuple(listed))
        object.__setattr__(self, "grounded", truth("grounded", self.grounded))
        for i, part in enumerate(self.viscoelastic):
            instance(f"viscoelastic[{i}]", part, Viscoelastic, "it must be a Viscoelastic")
            if part.H.shape != (n, n):
                raise ValueError(f"viscoelastic[{i}].H has shape {part.H.shape}; it must be ({n}, {n})")

    @classmethod
    def of(cls, element: Superelement) -> FullModel:
        """A superelement seen as a full model of its own coordinates, at standstill (G and N left out)."""
        faces = {name: RigidInterface(at, np.eye(6), np.zeros(3)) for name, at in element.interfaces.items()}
        return cls(
            M=element.M,
            C=element.C,
            K=element.K,
            interfaces=faces,
            outputs=element.outputs,
            viscoelastic=element.viscoelastic,
            grounded=True,
        )

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.M.shape[0])

    def stiffness(self, moduli: Sequence[complex] = ()) -> Any:
        """K + Σ 2 G H, (n, n) sparse, N/m, at one shear modulus for each viscoelastic material, Pa."""
        K = self.K
        for part, G in zip(self.viscoelastic, moduli, strict=True):
            K = K + 2.0 * G * part.H
        return K
