"""The strain of a body of rubber in one number, and where it is: what a law of softening is asked at.

γ² = 2 e:e of the deviatoric strain e: in pure shear the shear strain, in tension √3 ε. Softening goes by the
strain at each place; one number for a whole layer has to be the one at which the layer is as stiff. Energy
weighs each place, and moduli bend over ln γ, so that the mean that serves is that of ln γ by energy:

    ln γ_log = ∫ γ² ln γ dV / ∫ γ² dV
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bearingdyn.short_repr import short
from bearingdyn.types import Array


@dataclass(frozen=True, eq=False)
class Strain:
    """Shear strain amplitude of a body of rubber, zero-to-peak, fractions.

    Attributes
    ----------
    rms
        Root mean square over the volume.
    logarithmic
        Mean of the logarithm, weighed by energy: the one strain at which the law of softening is asked.
    largest
        Largest at a point of integration; at a bonded corner it grows with the mesh.
    """

    rms: float
    logarithmic: float
    largest: float

    __repr__ = short

    @property
    def concentration(self) -> float:
        """χ, logarithmic over rms; 1 where the strain is even, NaN without strain."""
        return self.logarithmic / self.rms if self.rms > 0 else float("nan")

    @classmethod
    def of_field(cls, gamma: Array, volume: Array) -> Strain:
        """The means of a strain field (n,) over volumes (n,)."""
        squares = gamma**2
        energy = float(volume @ squares)
        if not energy > 0:
            return cls(0.0, 0.0, 0.0)
        # a place without strain has no energy: its logarithm counts nothing
        logs = np.log(np.where(squares > 0, squares, 1.0))
        log = 0.5 * float(volume @ (squares * logs)) / energy
        return cls(float(np.sqrt(energy / volume.sum())), float(np.exp(log)), float(gamma.max()))
