"""What the rest of the package knows of a part: reduced matrices, named interfaces, output rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
import scipy
from numpy.typing import ArrayLike

from bearingdyn.bearing import RacewaySeries
from bearingdyn.checks import positive
from bearingdyn.short import short
from bearingdyn.types import Array, Complex, Index

# Largest accepted |A_ij ∓ A_ji| over the largest |A|. The round-off of a congruence of 1e5 coordinates is
# some 1e-11 of it, and matrices written with ten digits pass; a wrong sign or entry is not so small.
SYMMETRY = 1e-9


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


def check_symmetry(name: str, A: Any, sign: int) -> None:
    """Check that a dense or sparse A is symmetric (sign 1) or skew-symmetric (sign −1).

    Raises
    ------
    ValueError
        Naming the matrix and the two entries farthest from it.
    """
    if 0 in A.shape:
        return
    off, scale = abs(A - sign * A.T), float(abs(A).max())
    if not float(off.max()) <= SYMMETRY * scale:
        i, j = sorted(int(k) for k in np.unravel_index(off.argmax(), off.shape))
        kind = "symmetric" if sign > 0 else "skew-symmetric"
        raise ValueError(
            f"{name}[{i}, {j}] is {A[i, j]:.6g} and {name}[{j}, {i}] is {A[j, i]:.6g}; {name} must be "
            f"{kind}, to {SYMMETRY:g} of its largest entry, {scale:.6g}"
        )


@dataclass(frozen=True, eq=False)
class Viscoelastic:
    """One viscoelastic material inside a superelement, or inside a full model.

    Parameters
    ----------
    material
        Anything with ``complex_modulus(omega)``; the time domain needs a Maxwell model.
    H
        (n, n) ∫BᵀT2B dV, m, dense if reduced and sparse (csr) if not; the deviatoric stiffness is 2·G*(ω)·H
        (paper (16), (23)).
    volume
        Of the material, m³: its mean square shear strain is 2 xᵀHx/volume. None where it is not known; a law
        of softening needs it.
    concentration
        (n,) strain that counts for a law of softening over the rms one, by coordinate; None: 1.
    """

    material: ComplexModulus
    H: Any
    volume: float | None = None
    concentration: Array | None = None

    __repr__ = short

    def __post_init__(self) -> None:
        if not callable(getattr(self.material, "complex_modulus", None)):
            raise ValueError(
                f"material is {self.material!r}; a viscoelastic material must have complex_modulus(omega)"
            )
        sparse = scipy.sparse.issparse(self.H)
        n = self.H.shape[0] if sparse else np.shape(self.H)[0] if np.ndim(self.H) else 0
        H = frozen_sparse("H", self.H, n) if sparse else frozen("H", self.H, (n, n))
        check_symmetry("H", H, 1)
        object.__setattr__(self, "H", H)
        if self.volume is not None:
            positive("volume", self.volume, "it must be a positive volume in m³")
        if self.concentration is not None:
            object.__setattr__(self, "concentration", frozen("concentration", self.concentration, (n,)))


@dataclass(frozen=True, eq=False)
class Raceway:
    """The raceway of a flexible ring: the motion of its groove centre as Fourier coefficients in azimuth.

    Parameters
    ----------
    series
        The coefficients.
    arm
        Radius, m, at which tilts become axial motion.
    rows
        (len(series), n) coefficients from the superelement's coordinates; a load of balls g acts as rowsᵀ g.
    """

    series: RacewaySeries
    arm: float
    rows: Array

    __repr__ = short

    def __post_init__(self) -> None:
        n = np.shape(self.rows)[-1] if np.ndim(self.rows) else 0
        object.__setattr__(self, "rows", frozen("rows", self.rows, (len(self.series), n)))
        positive("arm", self.arm, "it must be a positive radius in m")


@dataclass(frozen=True, eq=False)
class Surface:
    """A surface of a part that radiates sound: ∫ v_n² dA = q̇ᵀ W q̇ of its normal velocity v_n.

    Parameters
    ----------
    area
        m².
    W
        (n, n) symmetric, m².
    """

    area: float
    W: Array

    __repr__ = short

    def __post_init__(self) -> None:
        positive("area", self.area, "it must be a positive area in m²")
        n = np.shape(self.W)[0] if np.ndim(self.W) else 0
        W = frozen("W", self.W, (n, n))
        check_symmetry("W", W, 1)
        object.__setattr__(self, "W", W)


@dataclass(frozen=True, eq=False, kw_only=True)
class Superelement:
    """A reduced part: M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 G*(ω) H x = f.

    Parameters
    ----------
    M, C
        (n, n) symmetric mass, kg, and viscous damping, N s/m.
    G
        (n, n) skew-symmetric, kg: the gyroscopic force on the left-hand side is Ω G ẋ, with G[θx, θy] = +Ip
        and G[θy, θx] = -Ip.
    K
        (n, n) symmetric stiffness, N/m, of the elastic regions, and the volumetric part of that of the
        viscoelastic ones without the deviatoric part.
    N
        (n, n) skew-symmetric, N s/m: the circulatory force Ω N x on the left-hand side, which the damping C
        of material that turns with the shaft brings with it; None: zero.
    interfaces
        name -> (6,) indices of the coordinates x, y, z, θx, θy, θz of a rigid joint.
    outputs
        name -> rows (6, n) or (3, n), the motion of a named point (interfaces are outputs too); a load f
        there acts as rowsᵀ f.
    viscoelastic
        The materials whose deviatoric stiffness is kept apart.
    raceways
        name -> Raceway, where a bearing's balls may run on a flexible ring.
    surfaces
        name -> Surface, from which sound is radiated.

    Raises
    ------
    ValueError
        For a wrong shape, a matrix that has an entry that is not finite or lacks its symmetry, an index out
        of range or used twice, or a name used twice.
    """

    M: Array
    C: Array
    G: Array
    K: Array
    N: Array | None = None
    interfaces: Mapping[str, Index]
    outputs: Mapping[str, Array] = field(default_factory=dict)
    viscoelastic: tuple[Viscoelastic, ...] = ()
    raceways: Mapping[str, Raceway] = field(default_factory=dict)
    surfaces: Mapping[str, Surface] = field(default_factory=dict)

    def __post_init__(self) -> None:
        n = np.shape(self.M)[0] if np.ndim(self.M) else 0
        if n == 0:
            raise ValueError(f"M has shape {np.shape(self.M)}; it must be (n, n) with n of at least 1")
        if self.N is None:
            object.__setattr__(self, "N", np.zeros((n, n)))
        for name, sign in (("M", 1), ("C", 1), ("G", -1), ("K", 1), ("N", -1)):
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

        Raises
        ------
        ValueError
            When the superelement has no such name.
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
