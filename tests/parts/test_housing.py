"""A housing keeps every mode below its f_max, however many there are."""

from __future__ import annotations

import math

import numpy as np
import scipy

from bearingdyn.parts import Housing


def sturm_count(A: np.ndarray) -> int:
    """Negative eigenvalues of a symmetric A by Sylvester's law of inertia, from LAPACK's factors L D Lᵀ."""
    _, d, _ = scipy.linalg.ldl(A)
    # D has blocks of one and two
    return int((scipy.linalg.eigvals_banded([np.diag(d), [*np.diag(d, -1), 0.0]], lower=True) < 0).sum())


def test_a_housing_has_as_many_modes_as_sturm_counts():
    """K − ω²M of the housing held at its interfaces has as many negative eigenvalues as modes lie below ω.

    They are more than the twenty with which the search for modes begins.
    """
    f_max = 30e3

    def housing(f: float) -> Housing:
        return Housing(0.16, 0.20, 0.030, 0.078, 0.12, f_max=f, element_size=0.05)

    model = housing(f_max).body.full_model()
    held = np.concatenate([interface.dofs for interface in model.interfaces.values()])
    inner = np.setdiff1d(np.arange(model.M.shape[0]), held)
    count = sturm_count((model.K - (2 * math.pi * f_max) ** 2 * model.M)[inner][:, inner].toarray())
    assert count > 20
    modes = len(housing(f_max).superelement().M) - len(housing(0.0).superelement().M)
    assert modes == count
