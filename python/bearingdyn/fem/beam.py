"""Timoshenko beam elements along z for stepped shafts of circular section.

Six coordinates a node, (x, y, z, θx, θy, θz). Bending in both planes with shear and rotatory inertia,
stretch, torsion, and the gyroscopic matrix of a section that spins about z with a prescribed angle.
Reference: Friswell, Penny, Garvey & Lees, Dynamics of Rotating Machines (2010), sections 5.4.4-5.4.5.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from bearingdyn.checks import number, positive
from bearingdyn.material import Elastic
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array
from bearingdyn.units import takes


@takes(length="m", d_outer="m", d_inner="m")
@dataclass(frozen=True)
class Section:
    """Section of a beam: a length of constant circular cross-section.

    Parameters
    ----------
    length
        m.
    d_outer, d_inner
        Outer and bore diameter, m; 0 <= d_inner < d_outer.

    Raises
    ------
    ValueError
        For a length or diameter that is not positive, a bore that leaves no wall, a length above 100 m or a
        diameter above 5 m: it is then in mm.
    """

    length: float
    d_outer: float
    d_inner: float = 0.0

    def __post_init__(self) -> None:
        positive("Section length", self.length, "it must be a positive length in m")
        positive("Section d_outer", self.d_outer, "it must be a positive diameter in m")
        number("Section d_inner", self.d_inner, "it must be a diameter in m, 0 for a full section")
        if not 0 <= self.d_inner < self.d_outer:
            raise ValueError(
                f"Section d_inner is {self.d_inner}; it must lie from 0 to below d_outer = {self.d_outer} m"
            )
        plausible("shaft length", "Section length", self.length)
        plausible("shaft diameter", "Section d_outer", self.d_outer)

    @property
    def area(self) -> float:
        """Area of the section, m²."""
        return math.pi / 4.0 * (self.d_outer**2 - self.d_inner**2)

    @property
    def second_moment(self) -> float:
        """Second moment of area about a diameter, m⁴; the polar one is twice this."""
        return math.pi / 64.0 * (self.d_outer**4 - self.d_inner**4)

    def shear_coefficient(self, nu: float) -> float:
        """Shear coefficient k; 6(1+ν)²/(7+12ν+4ν²) when solid.

        References
        ----------
        Hutchinson, J. Applied Mechanics 68 (2001) 87-92, solid and hollow circular section.
        """
        a2, b2 = self.d_outer**2, self.d_inner**2
        s, p = a2 * a2 + b2 * b2, a2 * b2
        return (
            6.0
            * ((a2 + b2) * (1.0 + nu)) ** 2
            / (7.0 * s + 34.0 * p + nu * (12.0 * s + 48.0 * p) + nu**2 * (4.0 * s + 16.0 * p))
        )


def bending_wavelength(section: Section, material: Elastic, frequency: float) -> float:
    """Beam's free bending wave: its length, estimated.

    The shorter of the Euler-Bernoulli wave and the shear wave, between which the Timoshenko beam passes.

    Parameters
    ----------
    section
        Of the beam.
    material
        Of the beam.
    frequency
        Hz.

    Returns
    -------
    float
        m.
    """
    omega = 2.0 * math.pi * frequency
    EI, rhoA = material.E * section.second_moment, material.density * section.area
    bending = math.sqrt(math.sqrt(EI / rhoA) / omega)
    shear = math.sqrt(section.shear_coefficient(material.nu) * material.G / material.density) / omega
    return 2.0 * math.pi * min(bending, shear)


def element_matrices(section: Section, length: float, material: Elastic) -> tuple[Array, Array, Array]:
    """Mass, gyroscopic and stiffness matrix, each (12, 12), of a beam element between two nodes.

    The gyroscopic force is Ω G ẋ on the left-hand side; for a disc G[θx, θy] = +Ip. The matrices of bending
    are consistent, with the interpolation that solves the static Timoshenko equations. Stretch and torsion
    have the mean of the consistent and the lumped mass, whose frequency error falls with the fourth power of
    the length.

    Parameters
    ----------
    section
        The section's own length does not enter.
    length
        Length of the element, m.
    material
        Elastic material.

    References
    ----------
    Goudreau & Taylor, Comput. Meth. Appl. Mech. Eng. 2 (1973) 69-97.
    """
    E, G, rho, L = material.E, material.G, material.density, length
    A, second = section.area, section.second_moment
    phi = 12.0 * E * second / (section.shear_coefficient(material.nu) * G * A * L**2)

    k_b = (E * second / ((1.0 + phi) * L**3)) * np.array(
        [
            [12.0, 6.0 * L, -12.0, 6.0 * L],
            [6.0 * L, (4.0 + phi) * L**2, -6.0 * L, (2.0 - phi) * L**2],
            [-12.0, -6.0 * L, 12.0, -6.0 * L],
            [6.0 * L, (2.0 - phi) * L**2, -6.0 * L, (4.0 + phi) * L**2],
        ]
    )
    m1, m2 = 312.0 + 588.0 * phi + 280.0 * phi**2, (44.0 + 77.0 * phi + 35.0 * phi**2) * L
    m3, m4 = 108.0 + 252.0 * phi + 140.0 * phi**2, -(26.0 + 63.0 * phi + 35.0 * phi**2) * L
    m5, m6 = (8.0 + 14.0 * phi + 7.0 * phi**2) * L**2, -(6.0 + 14.0 * phi + 7.0 * phi**2) * L**2
    m_b = (rho * A * L / (840.0 * (1.0 + phi) ** 2)) * np.array(
        [[m1, m2, m3, m4], [m2, m5, -m4, m6], [m3, -m4, m1, -m2], [m4, m6, -m2, m5]]
    )
    m7, m8 = 36.0, (3.0 - 15.0 * phi) * L
    m9, m10 = (4.0 + 5.0 * phi + 10.0 * phi**2) * L**2, (-1.0 - 5.0 * phi + 5.0 * phi**2) * L**2
    m_r = (rho * second / (30.0 * (1.0 + phi) ** 2 * L)) * np.array(
        [[m7, m8, -m7, m8], [m8, m9, -m8, m10], [-m7, -m8, m7, -m8], [m8, m10, -m8, m9]]
    )

    M, K, gyro = np.zeros((12, 12)), np.zeros((12, 12)), np.zeros((12, 12))
    xz, yz = np.array([0, 4, 6, 10]), np.array([1, 3, 7, 9])
    sign = np.outer([-1.0, 1.0, -1.0, 1.0], [-1.0, 1.0, -1.0, 1.0])  # du/dz = θy but dv/dz = -θx
    K[np.ix_(xz, xz)], K[np.ix_(yz, yz)] = k_b, sign * k_b
    M[np.ix_(xz, xz)], M[np.ix_(yz, yz)] = m_b + m_r, sign * (m_b + m_r)
    g = 2.0 * np.array([[-1.0], [1.0], [-1.0], [1.0]]) * m_r  # polar inertia is twice the diametral
    gyro[np.ix_(yz, xz)], gyro[np.ix_(xz, yz)] = g, -g.T

    bar = np.array([[1.0, -1.0], [-1.0, 1.0]])
    spread = np.array([[5.0, 1.0], [1.0, 5.0]]) / 12.0
    for at, stiffness, mass in (
        (np.array([2, 8]), E * A / L, rho * A * L),
        (np.array([5, 11]), 2.0 * G * second / L, 2.0 * rho * second * L),
    ):
        K[np.ix_(at, at)], M[np.ix_(at, at)] = stiffness * bar, mass * spread
    return M, gyro, K


def assemble_beam(
    z: Array, sections: Sequence[Section], material: Elastic
) -> tuple[scipy.sparse.csr_matrix, scipy.sparse.csr_matrix, scipy.sparse.csr_matrix]:
    """Mass, gyroscopic and stiffness matrix of a shaft of beam elements.

    Parameters
    ----------
    z
        (n,) rising node positions, m.
    sections
        The n - 1 sections between them, whose own lengths do not enter.
    material
        Of all sections.

    Returns
    -------
    M, G, K : scipy.sparse.csr_matrix
        (6 n, 6 n); the gyroscopic force is Ω G ẋ.

    Raises
    ------
    ValueError
        When z does not rise or the counts do not fit.
    """
    h = np.diff(z)
    if not np.all(h > 0):
        raise ValueError(f"z must rise from node to node; its smallest step is {h.min(initial=np.inf)} m")
    if len(sections) != h.size or h.size == 0:
        raise ValueError(f"sections has {len(sections)} entries; {len(z)} nodes need {max(len(z) - 1, 1)}")
    blocks = [element_matrices(s, float(L), material) for s, L in zip(sections, h, strict=True)]
    index = 6 * np.arange(h.size)[:, None] + np.arange(12)
    rows = np.repeat(index, 12, axis=1).ravel()
    columns = np.tile(index, (1, 12)).ravel()
    n = 6 * len(z)

    def matrix(i: int) -> scipy.sparse.csr_matrix:
        entries = np.concatenate([block[i].ravel() for block in blocks])
        return scipy.sparse.csr_matrix((entries, (rows, columns)), shape=(n, n))

    return matrix(0), matrix(1), matrix(2)
