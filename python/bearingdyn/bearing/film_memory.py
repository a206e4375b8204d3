"""The memory of a ball's films in time: what the oil carries through both contacts, as decays.

Over frequency both contacts of a ball in series answer with K̂ = K0 (1 + iωb Σ ρ/(iω + d)), `ehl.FilmDecays`;
in time that is

    dq/dt = −d q + b dδ/dt,    η = Σ Re(ρ q),    F = κ(δ + h0 + η)^{3/2},

which a march steps exactly for a rate of approach linear in its step (csrc/echoes.c).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy

from bearingdyn.bearing import ehl
from bearingdyn.bearing.contact_damping import FILM_NODES, FilmDamping
from bearingdyn.bearing.kernel import BearingKernel
from bearingdyn.checks import require
from bearingdyn.short_repr import short
from bearingdyn.types import Array, Complex

_LAST, _SAMPLES = (
    4.0,
    60,
)  # ωa/um of the slower contact to which both together are fitted: where the table ends
_SLOW = 0.01  # rad/s, where c(ω) is c
_FIRM = 0.9  # least K0 over dry stiffness: below, the film follows the load more than a straight line does


@dataclass(frozen=True, eq=False)
class FilmMemory:
    """Memory of both films of a ball: its answer over frequency as decays.

    Parameters
    ----------
    load
        Of the ball, N.
    decays
        In series with the ring's give, over the dry contacts' stiffness; rad/s.
    error
        Largest departure from what the table answers up to 4 um/a of the slower contact, over the same.
    """

    load: float
    decays: ehl.FilmDecays
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
            Compliance of the ring at a ball of its own, m/N, in series; stiffnesses are then less what it
            takes of K0.

        Raises
        ------
        ValueError
            For a law without answer or load, and where the film is so thick under the load that its
            stiffness is below nine tenths of the dry contacts'.
        """
        if law.answer is None or law.load is None:
            raise ValueError(
                f"damping is {law!r}; only one that bearing.lubricate makes knows how its films answer"
            )
        answer, passages = law.answer.under(np.array([law.load])), law.answer.passages(law.load)
        s = (law.load / kappa) ** (2 / 3)
        dry, c = 1.5 * law.load / s, float(law.at(s))
        low = complex(answer.stiffness(np.array([_SLOW]))[0, 0])
        softness = low.real
        require(
            softness >= _FIRM,
            "contacts",
            "film",
            f"under {law.load:.4g} N the films leave {softness:.2g} of the dry contacts' stiffness; in time "
            f"it must be {_FIRM} or more: take more load or a thinner oil, or contacts='viscous'",
        )
        omega = np.linspace(0, _LAST, _SAMPLES + 1)[1:] / max(passages)
        found = answer.stiffness(omega)[:, 0]
        # in proportion, so that it is c at low frequency
        found = found.real + 1j * found.imag * (c * _SLOW / (dry * low.imag))
        K0 = softness * dry
        found *= (1 + give * K0) / (1 + give * dry * found)
        ends = np.outer(ehl.DECAYS, 1 / np.array(passages)).ravel()
        decays = ehl.FilmDecays.fitted(omega, found, softness, c / K0 / (1 + give * K0), ends)
        return cls(law.load, decays, float(np.abs(decays.stiffness(omega) - found).max()))

    def stiffness(self, omega: Array) -> Complex:
        """Dynamic stiffness K(ω) + iωc(ω) at omega, rad/s, over that of the dry contacts."""
        return self.decays.stiffness(omega)

    def echoes(self) -> Array:
        """Rows (n, 4) of decay and strength, real and imaginary parts, as the core takes them."""
        d, s = self.decays.decays, self.decays.strengths
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
    soft = memory.decays.softness
    s = (memory.load / kernel.kappa) ** (2 / 3)
    kappa, scale = kernel.kappa * soft**1.5, law.scale / soft
    w = np.arange(1, FILM_NODES - 1) / (FILM_NODES - 1)
    root = _root(scale * (w / (1 - w)) ** 2, kernel.give * kappa)
    k = 1.5 * kappa * root
    # a wall may stiffen without bound at loads that no ball bears: held where it doubles k, as in `behind`
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
