"""A material's bulk modulus as a term of its own in a superelement: a stiffness that relaxes, as in shear."""

from __future__ import annotations

from typing import Any

import numpy as np

from bearingdyn.checks import positive
from bearingdyn.material.bulk_relaxation import BulkRelaxation
from bearingdyn.material.maxwell import Maxwell


class Volume(Maxwell):
    """The volumetric term of a part: K*(ω) in Maxwell's form, G0 is K at rest, branches its relaxation.

    The volumetric stiffness K ∫(div u)² stands as 2·K*·H with H = ½ ∫(div u)², so that every domain treats it
    as it treats shear.
    """

    def _validate(self) -> None:
        positive("Volume.K", self.K)  # its parts were checked where they were given; G0 is no shear modulus


def volume_of(material: Any) -> Volume | None:
    """The volumetric term of a viscoelastic material; None where its bulk modulus is constant.

    Parameters
    ----------
    material
        With K, and perhaps `bulk`, its relaxation.

    Returns
    -------
    Maxwell or None
        K*(ω) as its complex modulus.
    """
    bulk: BulkRelaxation | None = getattr(material, "bulk", None)
    if bulk is None:
        return None
    return Volume(
        material.K,
        material.K * np.array(bulk.share),
        bulk.tau,
        K=material.K,
        density=material.density,
        law=getattr(material, "law", None),
        temperature=getattr(material, "temperature", None),
    )


def constant_bulk(material: Any) -> float:
    """Bulk modulus, Pa, in K of a superelement: 0 where its volume has a term of its own.

    Parameters
    ----------
    material
        With K, and perhaps `bulk`, its relaxation.
    """
    return 0.0 if getattr(material, "bulk", None) is not None else float(material.K)


def is_volume(material: Any) -> bool:
    """Volume change against shear: whether a term is one of it.

    Parameters
    ----------
    material
        That of the term.
    """
    return isinstance(material, Volume)
