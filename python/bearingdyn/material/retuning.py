"""Another modulus or loss factor for the same material, causal in every case."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Self

import numpy as np

from bearingdyn.checks import number, positive, require
from bearingdyn.material.amplitude import Payne
from bearingdyn.material.low_end import LowEnd
from bearingdyn.material.spread import Spread
from bearingdyn.types import Array, Complex


class Retunable:
    """What a Maxwell model offers to be retuned: made harder, softer, or more lossy."""

    G0: float
    G: Array
    tau: Array
    eta0: float
    low_end: LowEnd | None
    payne: Payne | None
    spread: Spread | None

    def complex_modulus(self, omega: Any) -> Complex:
        """Complex shear modulus at ω rad/s, Pa; given by the model."""
        raise TypeError("Retunable has no modulus of its own")

    def _with(self, **change: Any) -> Self:
        """With these values; what is known of long times goes along with the spring."""
        if self.low_end is not None and self.G0 > 0:
            change["low_end"] = self.low_end.moved(1.0, change.get("G0", self.G0) / self.G0)
        return replace(self, **change)  # type: ignore[type-var]

    def with_modulus(self, modulus: float, omega: float) -> Self:
        """The same material, harder or softer: all strengths scaled so that |G*(omega)| is `modulus`, Pa.

        The loss factor is unchanged at every frequency; a law of softening is scaled along.
        """
        modulus = positive("modulus", modulus, "it must be positive and finite, Pa")
        omega = number("omega", omega, "it must be one angular frequency, rad/s")
        magnitude = float(np.abs(self.complex_modulus(omega)))
        require(magnitude > 0, "omega", omega, "|G*| is zero at this angular frequency; take one above zero")
        factor = modulus / magnitude
        law = None if self.payne is None else self.payne.scaled(factor)
        return self._with(
            G0=self.G0 * factor, G=self.G * factor, eta0=self.eta0 * factor, fit=None, payne=law
        )

    def with_loss_factor(self, loss_factor: float, omega: float) -> Self:
        """A causal material of the same |G*(omega)| and relaxation times, with this loss factor at omega.

        The branches and the dashpot are scaled against the spring G0, then all of them together until
        |G*(omega)| is what it was. G′ and G″ change together as Kramers and Kronig demand; G″ scaled alone
        would not be causal.

        Parameters
        ----------
        loss_factor
            Wanted tan δ at omega, > 0 and below that of the branches without the spring.
        omega
            Angular frequency, rad/s, > 0.

        Raises
        ------
        ValueError
            If the material has no spring or no branches, or the loss factor is out of reach.
        """
        omega = positive("omega", omega, "it must be positive and finite, rad/s")
        loss_factor = number("loss_factor", loss_factor)
        modulus = complex(self.complex_modulus(omega))
        branches = modulus - self.G0
        if not (self.G0 > 0 and branches.imag > 0):
            raise ValueError(
                "Maxwell: with_loss_factor weighs branches against the spring: both must be there"
            )
        limit = branches.imag / branches.real if branches.real > 0 else math.inf
        remedy = f"it must lie between 0 and {limit:.4g}, that of the branches alone at this frequency"
        require(0 < loss_factor < limit, "loss_factor", loss_factor, remedy)
        factor = loss_factor * self.G0 / (branches.imag - loss_factor * branches.real)
        weighed = self._with(G=self.G * factor, eta0=self.eta0 * factor, fit=None)
        return weighed.with_modulus(abs(modulus), omega)

    def with_relaxation(self, loss_factor: float, omega: float) -> Self:
        """A causal material of the same |G*(omega)| and this loss factor there, by one more relaxation.

        Its time is τ = 1/omega.

        A branch of strength s adds s/2 to G′ and to G″ at its own frequency, so s = 2(tan δ G′ − G″)/(1 −
        tan δ); then all strengths are scaled together until |G*(omega)| is what it was. Against
        `with_loss_factor` it keeps more of the relaxed modulus G0, and so of the static stiffness, for the
        same damping at omega.

        Parameters
        ----------
        loss_factor
            Wanted tan δ at omega, above the present one and below 1.
        omega
            Angular frequency, rad/s, > 0.

        Raises
        ------
        ValueError
            If omega is not positive or the loss factor out of reach.
        """
        positive("omega", omega, "it must be positive and finite, rad/s")
        modulus = complex(self.complex_modulus(omega))
        present = modulus.imag / modulus.real
        remedy = f"it must lie between the present {present:.4g} and 1"
        require(present < loss_factor < 1, "loss_factor", loss_factor, remedy)
        strength = 2 * (loss_factor * modulus.real - modulus.imag) / (1 - loss_factor)
        G, tau = np.append(self.G, strength), np.append(self.tau, 1 / omega)
        order = np.argsort(tau)
        spread = None if self.spread is None else self.spread.renumbered(order)
        more = self._with(G=G[order], tau=tau[order], fit=None, spread=spread)
        return more.with_modulus(abs(modulus), omega)
