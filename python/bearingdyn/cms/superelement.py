"""What the rest of the package knows of a part: reduced matrices, named interfaces, output rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import NoneType

import numpy as np

from bearingdyn.checks import instance, items, named, reals
from bearingdyn.cms.frozen_matrices import check_symmetry, frozen
from bearingdyn.cms.raceway import Raceway
from bearingdyn.cms.radiating_surface import Skin, Surface
from bearingdyn.cms.round_face import RoundFace
from bearingdyn.cms.viscoelastic import Viscoelastic
from bearingdyn.material import answer_of
from bearingdyn.pictures import page
from bearingdyn.types import Array, Complex, Index


@dataclass(frozen=True, eq=False, kw_only=True)
class Superelement:
    """A superelement, the reduced part: M ẍ + (C + Ω G) ẋ + (K + Ω N) x + Σ 2 G*(ω) H x = f.

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
    faces
        name -> the round faces at an interface or raceway, with which an application compares the
        neighbours; what is left out is taken to fit.
    skin
        The whole boundary, which sound power needs; None: unknown.

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
    faces: Mapping[str, tuple[RoundFace, ...]] = field(default_factory=dict)
    skin: Skin | None = None

    _repr_html_ = page

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
        remedy = "it must be a mapping, name -> 6 integers"
        for name, given in named("interfaces", self.interfaces, remedy).items():
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
        for name, given in named("outputs", self.outputs, "it must be a mapping, name -> rows").items():
            if name in interfaces:
                raise ValueError(f"outputs has {name!r}, the name of an interface; choose another")
            rows = reals(f"outputs[{name!r}]", given, f"it must be real numbers, (3 or 6, {n})")
            count = rows.shape[0] if rows.ndim else 0
            if count not in (3, 6):
                raise ValueError(f"outputs[{name!r}] has shape {rows.shape}; it must be (3 or 6, {n})")
            outputs[name] = frozen(f"outputs[{name!r}]", rows, (count, n))
        object.__setattr__(self, "outputs", outputs)

        object.__setattr__(self, "surfaces", named("surfaces", self.surfaces, "it must map names to Surface"))
        for name, surface in self.surfaces.items():
            instance(f"surfaces[{name!r}]", surface, Surface, "it must be a Surface")
            if surface.W.shape != (n, n):
                raise ValueError(f"surfaces[{name!r}].W has shape {surface.W.shape}; it must be ({n}, {n})")

        instance("skin", self.skin, (Skin, NoneType), "it must be a Skin, or None")
        if self.skin is not None and self.skin.rows.shape[1] != n:
            raise ValueError(f"skin.rows has {self.skin.rows.shape[1]} columns, not {n}")

        listed = items("viscoelastic", self.viscoelastic, "it must be a list of Viscoelastic")
        object.__setattr__(self, "viscoelastic", tuple(listed))
        for i, part in enumerate(self.viscoelastic):
            instance(f"viscoelastic[{i}]", part, Viscoelastic, "it must be a Viscoelastic")
            if part.H.shape != (n, n):
                raise ValueError(f"viscoelastic[{i}].H has shape {part.H.shape}; it must be ({n}, {n})")

        for name, raceway in named("raceways", self.raceways, "it must map names to Raceway").items():
            instance(f"raceways[{name!r}]", raceway, Raceway, "it must be a Raceway")
            if name in interfaces or name in outputs:
                raise ValueError(f"raceways has {name!r}, the name of an interface or output; choose another")
            if raceway.rows.shape[1] != n:
                raise ValueError(f"raceways[{name!r}].rows has {raceway.rows.shape[1]} columns, not {n}")

        remedy = "it must map names to lists of RoundFace"
        given = named("faces", self.faces, remedy)
        faces = {name: tuple(items(f"faces[{name!r}]", found, remedy)) for name, found in given.items()}
        object.__setattr__(self, "faces", faces)
        for name in self.faces:
            if name not in interfaces and name not in self.raceways:
                known = sorted([*interfaces, *self.raceways])
                raise ValueError(f"faces has {name!r}, no interface or raceway; there are {known}")

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

    def round_faces(self) -> Mapping[str, tuple[RoundFace, ...]]:
        """Cylinders at its interfaces, against which an application checks the neighbours."""
        return self.faces

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
            K = K + 2.0 * complex(answer_of(part.material, omega).item()) * part.H
        return K
