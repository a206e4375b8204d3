"""What the rest of the package knows of a part: reduced matrices, named interfaces, output rows."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing.raceway_series import RacewaySeries
from bearingdyn.types import Array, Complex, Index

SYMMETRY = 1e-9  # largest accepted |A - Aᵀ| over the largest |A|: congruence stays far below it


class ComplexModulus(Protocol):
    """A material whose shear modulus depends on the frequency."""

    def complex_modulus(self, omega: Any) -> Any:
        """G*(ω) in Pa for ω in rad/s."""


def frozen(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Array:
    """A read-only copy. Raises ValueError, by the name, for another shape or an entry that is not finite."""
    array = np.array(value, dtype=np.float64)
    if array.shape != shape:
        raise ValueError(f"{name} has shape {array.shape}; it must be {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} has an entry that is not finite: {array[~np.isfinite(array)][0]}")
    array.setflags(write=False)
    return array


def frozen_sparse(name: str, value: Any, n: int, columns: int | None = None) -> scipy.sparse.csr_matrix:
    """A matrix (n, columns or n) as csr. Raises ValueError for another shape or an entry not finite."""
    matrix = scipy.sparse.csr_matrix(value, dtype=np.float64)
    shape = (n, n if columns is None else columns)
    if matrix.shape != shape:
        raise ValueError(f"{name} has shape {matrix.shape}; it must be {shape}")
    if not np.isfinite(matrix.data).all():
        bad = matrix.data[~np.isfinite(matrix.data)][0]
        raise ValueError(f"{name} has an entry that is not finite: {bad}")
    return matrix


def check_symmetry(name: str, A: Any, sign: float) -> None:
    """Raises ValueError unless A = sign Aᵀ to round-off, for a dense or sparse A."""
    scale, error = (float(abs(a).max()) if 0 not in a.shape else 0.0 for a in (A, A - sign * A.T))
    if error > SYMMETRY * scale:
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(f"{name} must be {kind}; it is off by {error:.3g} where entries reach {scale:.3g}")


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """One viscoelastic material inside a superelement, or inside a full model.

    material: anything with ``complex_modulus(omega)``; the time domain needs a Maxwell model.
    H: (n, n) ∫BᵀT2B dV, m, dense if reduced and sparse (csr) if not; the deviatoric stiffness is 2·G*(ω)·H
        (paper (16), (23)).
    """

    material: ComplexModulus
    H: Any

    def __post_init__(self) -> None:
        if not callable(getattr(self.material, "complex_modulus", None)):
            raise ValueError(
                f"material is {self.material!r}; a viscoelastic material must have complex_modulus(omega)"
            )
        sparse = scipy.sparse.issparse(self.H)
        n = self.H.shape[0] if sparse else np.shape(self.H)[0] if np.ndim(self.H) else 0
        H = frozen_sparse("H", self.H, n) if sparse else frozen("H", self.H, (n, n))
        check_symmetry("H", H, 1.0)
        object.__setattr__(self, "H", H)


@dataclass(frozen=True, eq=False)
class Raceway:
    """A race of a flexible ring: its groove-centre displacement as Fourier coefficients in the azimuth.

    series: which coefficients; arm: radius, m, at which tilts become axial motion.
    rows: (len(series), n), the coefficients by the superelement's coordinates; a load of balls g acts as
        rowsᵀ g.
    """

    series: RacewaySeries
    arm: float
    rows: Array

    def __post_init__(self) -> None:
        n = np.shape(self.rows)[-1] if np.ndim(self.rows) else 0
        object.__setattr__(self, "rows", frozen("rows", self.rows, (len(self.series), n)))
        if not 0 < self.arm < math.inf:
            raise ValueError(f"arm is {self.arm}; it must be a positive radius in m")


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a part: ∫ v_n² dA = q̇ᵀ W q̇ of the normal velocity. area: m²; W: (n, n) symmetric, m²."""

    area: float
    W: Array

    def __post_init__(self) -> None:
        if not 0 < self.area < math.inf:
            raise ValueError(f"area is {self.area}; a surface has a positive area in m²")
        n = np.shape(self.W)[0] if np.ndim(self.W) else 0
        W = frozen("W", self.W, (n, n))
        check_symmetry("W", W, 1.0)
        object.__setattr__(self, "W", W)


@dataclass(frozen=True, eq=False)
class Superelement:
    """A reduced part: M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 G*(ω) H x = f.

    M, C, K: (n, n) symmetric mass (kg), viscous damping (N s/m) and stiffness (N/m). K holds the elastic
        regions and the volumetric part of viscoelastic ones, not their deviatoric part.
    G: (n, n) skew, kg: the gyroscopic force on the left-hand side is Ω G ẋ, with G[θx, θy] = +Ip and
        G[θy, θx] = -Ip.
    interfaces: name -> (6,) indices of the coordinates x, y, z, θx, θy, θz of a rigid joint.
    outputs: name -> rows (6, n) or (3, n), the motion of a named point (interfaces are outputs too); a load f
        there acts as rowsᵀ f.
    viscoelastic: the materials whose deviatoric stiffness is kept apart.

    N: (n, n) skew, N s/m: the circulatory force Ω N x on the left-hand side, there when the damping C belongs
        to material that turns with the shaft; zero by default.
    raceways: name -> Raceway, where a bearing's balls may run on a flexible ring.
    surfaces: name -> Surface, from which sound is radiated.

    Raises ValueError for a wrong shape, a matrix with non-finite entries or without its symmetry, an index
    out of range or used twice, or a name used twice.
    """

    M: Array
    C: Array
    K: Array
    G: Array
    interfaces: Mapping[str, Index]
    outputs: Mapping[str, Array] = field(default_factory=dict)
    viscoelastic: tuple[Viscoelastic, ...] = ()
    N: Array | None = None
    raceways: Mapping[str, Raceway] = field(default_factory=dict)
    surfaces: Mapping[str, Surface] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = np.shape(self.M)[0] if np.ndim(self.M) else 0
        if n == 0:
            raise ValueError(f"M has shape {np.shape(self.M)}; it must be (n, n) with n of at least 1")
        if self.N is None:
            object.__setattr__(self, "N", np.zeros((n, n)))
        for name, sign in (("M", 1.0), ("C", 1.0), ("K", 1.0), ("G", -1.0), ("N", -1.0)):
            A = frozen(name, getattr(self, name), (n, n))
            check_symmetry(name, A, sign)
            object.__setattr__(self, name, A)

        taken: dict[int, str] = {}
        interfaces: dict[str, Index] = {}
        for name, given in self.interfaces.items():
            index = np.array(given)
            if index.shape != (6,) or not np.issubdtype(index.dtype, np.integer):
                raise ValueError(
                    f"interfaces[{name!r}] is {given!r}; it must be 6 integers (of x, y, z, θx, θy, θz)"
                )
            index = index.astype(np.intp)
            for i in index.tolist():
                if not 0 <= i < n:
                    raise ValueError(f"interfaces[{name!r}] holds index {i}; it must lie in 0...{n - 1}")
                if i in taken:
                    raise ValueError(f"interfaces[{name!r}] and [{taken[i]!r}] share index {i}; use it once")
                taken[i] = name
            index.setflags(write=False)
            interfaces[name] = index
        object.__setattr__(self, "interfaces", interfaces)

        outputs: dict[str, Array] = {}
        for name, rows in self.outputs.items():
            if name in interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface ; choose another")
            count = np.shape(rows)[0] if np.ndim(rows) else 0
            if count not in (3, 6):
                raise ValueError(f"outputs[{name!r}] has shape {np.shape(rows)}; it must be (3 or 6, {n})")
            outputs[name] = frozen(f"outputs[{name!r}]", rows, (count, n))
        object.__setattr__(self, "outputs", outputs)

        object.__setattr__(self, "surfaces", dict(self.surfaces))
        for name, surface in self.surfaces.items():
            if surface.W.shape != (n, n):
                raise ValueError(f"surfaces[{name!r}].W has shape {surface.W.shape}; it must be ({n}, {n})")

        object.__setattr__(self, "viscoelastic", tuple(self.viscoelastic))
        for i, part in enumerate(self.viscoelastic):
            if part.H.shape != (n, n):
                raise ValueError(f"viscoelastic[{i}].H has shape {part.H.shape}; it must be ({n}, {n})")

        for name, raceway in self.raceways.items():
            if name in interfaces or name in outputs:
                raise ValueError(f"raceways has {name!r}, the name of an interface or output; choose another")
            if raceway.rows.shape[1] != n:
                raise ValueError(f"raceways[{name!r}].rows has {raceway.rows.shape[1]} columns, not {n}")

    def __repr__(self) -> str:
        """One line instead of the matrices."""
        return f"<Superelement of {self.n} coordinates, interfaces {list(self.interfaces)}>"

    @property
    def n(self) -> int:
        """Number of coordinates."""
        return int(self.M.shape[0])

    def superelement(self) -> Superelement:
        """Itself: what is reduced already is added to an application as it is."""
        return self

    def rows(self, name: str) -> Array:
        """Rows (6, n) or (3, n) giving the motion of an interface or output point.

        Raises ValueError when the superelement has no such name.
        """
        if name in self.interfaces:
            return np.eye(self.n)[self.interfaces[name]]
        if name in self.outputs:
            return self.outputs[name]
        known = sorted([*self.interfaces, *self.outputs])
        raise ValueError(f"no interface or output {name!r}; there are {known}")

    def stiffness(self, omega: float = 0.0) -> Complex:
        """Complex stiffness K + Σ 2 G*(ω) H, (n, n), N/m (paper (20)); ω in rad/s."""
        K = self.K.astype(np.complex128)
        for part in self.viscoelastic:
            K = K + 2.0 * complex(np.asarray(part.material.complex_modulus(omega)).item()) * part.H
        return K
