"""NumPy twin of the C history update of Maxwell branches: the specification, slow and plain."""

from __future__ import annotations

import numpy as np


def branch_weights(r):
    """Decay E and weights of a step, r = Δt/τ > 0: S′ = E S + 2Gτ (old ė + new ė′). Returns (E, old, new).

    E = e^{−r}, new = 1 − (1−E)/r, old = (1−E)/r − E (theory, §1: q and (1−E)−q). Both differences cancel for
    small r: there the series new = Σ_{k≥1} (−r)^k·(−1)/(k+1)!, old = Σ_{k≥1} (−1)^{k+1} k r^k/(k+1)!.
    """
    r = np.asarray(r, dtype=float)
    E = np.exp(-r)
    p = -np.expm1(-r) / r
    small = r < 0.5
    x = np.where(small, r, 0.0)
    term = np.ones_like(x)  # (−1)^{k+1} r^k/(k+1)!, built up from k = 0 with the sign of k = 1 positive
    new, old = np.zeros_like(x), np.zeros_like(x)
    for k in range(1, 19):
        term = x / 2 if k == 1 else -term * x / (k + 1)
        new = new + term
        old = old + k * term
    return E, np.where(small, old, p - E), np.where(small, new, 1 - p)


def maxwell_stress(strain_rate, dt, G0, eta0, G, tau):
    """Stress 2·G0·e + 2·η0·ė + Σ S_i, (nt, m), under a rate (nt, m) linear between samples, from e = S_i =
    0."""
    rate = np.asarray(strain_rate, dtype=float)
    nt, m = rate.shape
    G, tau = np.asarray(G, dtype=float), np.asarray(tau, dtype=float)
    steps = np.broadcast_to(np.asarray(dt, dtype=float), (nt - 1,))
    e, S = np.zeros(m), np.zeros((G.size, m))
    stress = np.empty((nt, m))
    stress[0] = 2 * eta0 * rate[0]
    for n, h in enumerate(steps):
        E, old, new = branch_weights(h / tau)
        e = e + h / 2 * (rate[n] + rate[n + 1])
        S = E[:, None] * S + 2 * (G * tau)[:, None] * (old[:, None] * rate[n] + new[:, None] * rate[n + 1])
        stress[n + 1] = 2 * G0 * e + 2 * eta0 * rate[n + 1] + S.sum(axis=0)
    return stress
