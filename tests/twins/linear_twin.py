"""The linear system written out: dynamic stiffness at a complex λ, and the response of the scheme itself."""

from __future__ import annotations

import numpy as np

from bearingdyn.system import System


def dynamic_stiffness(system: System, value: complex, speed: float) -> list[np.ndarray]:
    """Terms of λ²M + λ(C + ΩG) + K + ΩN + Σ 2 G(λ) H, G(λ) = G0 + η0 λ + Σ Gᵢ λτᵢ/(1 + λτᵢ)."""
    terms = [value**2 * system.M, value * (system.C + speed * system.G), system.K + speed * system.N]
    for term in system.layers:
        m = term.material
        G = (
            m.G0
            + m.eta0 * value
            + sum(g * value * t / (1 + value * t) for g, t in zip(m.G, m.tau, strict=True))
        )
        terms.append(2 * G * term.L @ term.L.T)
    return terms


def discrete_response(system: System, row: np.ndarray, force: np.ndarray, dt: float, n: int) -> complex:
    """X of the scheme itself under Re F e^{iωt}: z = e^{iωΔt} in Newmark's and the branches' recursions.

    (z−1)V = Δt[(1−γ)+γz]A, (z−1)X = Δt V + Δt²[(½−β)+βz]A, (z−E)S = (old + now·z)Ẏ, written here from
    theory; β = ¼, γ = ½.
    """
    z = np.exp(2j * np.pi / n)
    in_v = dt * (0.5 + 0.5 * z) / (z - 1)
    in_x = (dt * in_v + dt**2 * (0.25 + 0.25 * z)) / (z - 1)
    D = system.M + in_v * system.viscous() + in_x * system.stiffness()
    for layer in system.layers:
        for G, tau in zip(layer.material.G, layer.material.tau, strict=True):
            E = np.exp(-dt / tau)
            q = 1 - (1 - E) * tau / dt
            weight = 2 * tau * G * ((1 - E) - q + q * z) / (z - E)
            D = D + in_v * weight * (layer.L @ layer.L.T)
    return complex(in_x * (row @ np.linalg.solve(D, force)))
