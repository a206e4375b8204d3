"""The memory of a ball's films in time: what the oil carries through both contacts, as echoes that fade.

A film answers an approach by what the inlet made of it while the oil that is now in the contact passed there
(`ehl.travelling_film`). Over frequency that is K̂(ω) = K0 (1 + iω b N(ω)), N(0) = 1, where b K0 is the damping
at low frequency; in time a sum of modes that decay,

    N(ω) = Σ ρ/(iω + d),    dq/dt = −d q + b dδ/dt,    η = Σ Re(ρ q),    F = κ(δ + h0 + η)^{3/2},

which a march steps exactly for a rate of approach linear in its step (csrc/echoes.c). The times of decay
follow from those in which the oil passes each contact, the strengths ρ by least squares from what the table
of `ehl` answers; K0 and the damping at low frequency are met exactly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy

from bearingdyn.bearing.contact_damping import FILM_NODES, FilmDamping
from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.checks import require
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

# Of one contact in um/a: a decay alone and two pairs, of which the first is given. Least squares of what a
# 6205 answers; the fast decay stands for the 1/√t with which the inlet's share begins.
_DECAYS = (21.0 + 0j, 1.45 - 2.99j, 1.92 - 0.95j)
_LAST, _SAMPLES = 4.0, 120  # ωa/um to which the strengths are fitted: where the table ends
# weight of the strengths themselves in the fit, rising until the films give no energy at any frequency
_RESTRAINTS = (1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
_ALL = np.geomspace(1e-3, 1e4, 400)  # ωa/um at which that is asked
_SLOW = 0.01  # rad/s, where c(ω) is c
_FIRM = 0.9  # least K0 over dry stiffness: below, the film follows the load more than a straight line does


@dataclass(frozen=True, eq=False)
class FilmMemory:
    """Memory of both films of a ball: its answer over frequency as decays and strengths.

    Parameters
    ----------
    load
        Of the ball, N.
    softness
        Stiffness at low frequency over that of the dry contacts.
    slope
        b, damping at low frequency over stiffness, s.
    decays, strengths
        (n,) d and ρ, 1/s, complex; of a pair the first, its strength doubled.
    error
        Largest departure from what the table answers up to 4 um/a of the slower contact, over the dry
        stiffness.
    """

    load: float
    softness: float
    slope: float
    decays: Complex
    strengths: Complex
    error: float

    __repr__ = short

    @classmethod
    def of(cls, law: FilmDamping, kappa: float, give: float = 0.0) -> FilmMemory:
        """The memory behind a law of damping that `lubricate` made.

        Parameters
        ----------
        law
            With an answer and a load.
        kappa
            Of the ball, N/m^1.5.
        give
            Compliance of the ring at a ball of its own, m/N; it lies in series, and stiffnesses are then over
            that of dry contacts and ring.

        Raises
        ------
        ValueError
            For a law without answer or load, and where the film is so thick under the load that its
            stiffness is below nine tenths of the dry contacts'.
        """
        remedy = "only a damping that bearing.lubricate makes knows how its films answer"
        if law.answer is None or law.load is None:
            raise ValueError(f"damping is {law!r}; {remedy}")
        answer = law.answer.under(np.array([law.load]))
        root = (law.load / kappa) ** (1 / 3)
        dry, c = 1.5 * kappa * root, float(law.at(root**2))
        low = complex(answer.stiffness(np.array([_SLOW]))[0, 0])
        softness = low.real
        require(
            softness >= _FIRM,
            "contacts",
            "film",
            f"under {law.load:.4g} N the films leave {softness:.2g} of the dry contacts' stiffness; in time "
            f"it must be {_FIRM} or more: take more load or a thinner oil, or contacts='viscous'",
        )
        K0 = softness * dry
        passage = max(law.answer.passages(law.load))
        omega = np.linspace(0, _LAST, _SAMPLES + 1)[1:] / passage
        found = answer.stiffness(omega)[:, 0]
        # in proportion, so that it is c at low frequency
        found = found.real + 1j * found.imag * (c * _SLOW / (dry * low.imag))
        through = (1 + give * K0) / (1 + give * dry * found)
        slope = c / K0 / (1 + give * K0)
        ends = np.array([d / t for d in _DECAYS for t in law.answer.passages(law.load)])
        strengths = _strengths(found / softness * through - 1, omega, slope, ends, passage)
        memory = cls(law.load, softness, slope, ends, strengths, 0.0)
        error = float(np.abs(memory.stiffness(omega) - found * through).max())
        return replace(memory, error=error)

    def stiffness(self, omega: Array) -> Complex:
        """Dynamic stiffness K(ω) + iωc(ω) at omega (f,), rad/s, over that of the dry contacts."""
        iw = 1j * np.asarray(omega, dtype=float)
        return np.asarray(self.softness * (1 + iw * self.slope * (_modes(iw, self.decays) @ _parts(self))))

    def echoes(self) -> Array:
        """Rows (n, 4) of decay and strength, real and imaginary parts, as the core takes them."""
        d, s = self.decays, self.strengths
        return np.column_stack([d.real, d.imag, s.real, s.imag])


def carried(kernel: BearingKernel, law: FilmDamping) -> BearingKernel:
    """The kernel of a bearing whose films remember, as F = κ(δ + h0 + η)^{3/2}.

    κ and h0 are those of the line that touches the films' own at the load of the law: there the force is the
    same and the stiffness K0, as the film becomes thinner under more load.

    Parameters
    ----------
    kernel
        Of the bearing, with the κ and h0 of its contacts.
    law
        Its damping, from `lubricate`.

    Raises
    ------
    ValueError
        As `FilmMemory.of`.
    """
    memory = FilmMemory.of(law, kernel.kappa, kernel.give)
    soft = memory.softness
    s = (memory.load / kernel.kappa) ** (2 / 3)
    kappa, scale = kernel.kappa * soft**1.5, law.scale / soft
    w = np.arange(1, FILM_NODES - 1) / (FILM_NODES - 1)
    root = _root(scale * (w / (1 - w)) ** 2, kernel.give * kappa)
    k = 1.5 * kappa * root
    b = law.at(soft * root**2) / k / np.maximum(1 + kernel.give * k, 0.5)
    b = np.concatenate([[0.0], b, [0.0]])
    nodes = np.arange(FILM_NODES)
    rises = scipy.interpolate.PchipInterpolator(nodes, b).derivative()(nodes)
    rises[0] = 0.0
    return replace(
        kernel,
        kappa=kappa,
        h0=kernel.h0 + s / soft - s,
        damping_law="carried",
        damping_c=scale,
        damping_table=np.column_stack([b, rises]),
        echoes=memory.echoes(),
    )


def _root(s: Array, cubic: float) -> Array:
    """u of u² + cubic u³ = s, (n,); held where a ring that stiffens has no more of it."""
    u = np.sqrt(s)
    for _ in range(20 if cubic else 0):
        u = np.maximum(u - (u**2 * (1 + cubic * u) - s) / (u * (2 + 3 * cubic * u)), u / 2)
        if cubic < 0:
            u = np.minimum(u, -1 / (3 * cubic))
    return np.asarray(u)


def _modes(iw: Complex, decays: Complex) -> Complex:
    """Columns of N for each mode: of a pair the two of the real and of the imaginary part of its strength."""
    columns = []
    for d in decays:
        first = 1 / (iw + d)
        if d.imag == 0:
            columns.append(first)
            continue
        second = 1 / (iw + d.conjugate())
        columns += [(first + second) / 2, 0.5j * (first - second)]
    return np.array(columns).T


def _parts(memory: FilmMemory) -> Array:
    """The strengths as `_modes` takes them."""
    pairs = zip(memory.decays, memory.strengths, strict=True)
    return np.concatenate([[s.real] if d.imag == 0 else [s.real, s.imag] for d, s in pairs])


def _strengths(P: Complex, omega: Array, slope: float, decays: Complex, passage: float) -> Complex:
    """Strengths by which iω b N is nearest to P with N(0) = 1, no energy coming back at any frequency.

    Parameters
    ----------
    P
        (f,) K̂/K0 − 1 at omega (f,), rad/s.
    slope
        b, s.
    decays
        (n,).
    passage
        Of the slower contact, s: the unit of the strengths.

    Raises
    ------
    ArithmeticError
        Where there are none.
    """
    iw = 1j * omega
    columns = _modes(iw, decays) * iw[:, None]
    fit = np.vstack([columns.real, columns.imag]) * math.sqrt(1 / omega.size)
    goal = np.concatenate([P.real, P.imag]) * math.sqrt(1 / omega.size) / slope
    slow = _modes(np.zeros(1, dtype=np.complex128), decays)[0].real
    first = slow / (slow @ slow)
    free = scipy.linalg.null_space(slow[None])
    everywhere = _modes(1j * _ALL / passage, decays)
    for restraint in _RESTRAINTS:
        held = restraint * free
        rows, right = np.vstack([fit @ free, held]), np.concatenate([goal - fit @ first, -restraint * first])
        x = first + free @ np.linalg.lstsq(rows, right, rcond=None)[0]
        if ((everywhere @ x).real >= 0).all():
            parts = iter(x.tolist())
            return np.array([complex(next(parts), next(parts) if d.imag else 0.0) for d in decays])
    raise ArithmeticError("no memory of these films takes energy at every frequency: contacts='viscous' does")
