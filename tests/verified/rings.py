"""Flexible rings against ring theory and the rigid ring; a distorted mesh against the bonded ring."""

from __future__ import annotations

import math

import numpy as np
import scipy.linalg

from bearingdyn.bearing import BallBearing
from bearingdyn.material import STEEL
from bearingdyn.parts import Cylinder, FlexibleBearing, FlexibleRing, Patch, Revolved, RingBed, quadrilaterals
from verified.ring_theory import annulus_compliance, annulus_on_bed, thick_ring, thin_ring
from verified.row import INDEPENDENT, MM, Row, as_printed, rows, steel, unit_rubber


def pinched_rings() -> list[Row]:
    """Free rings under two opposed radial loads, and order by order."""
    cases = []
    P, R = 100.0, 50 * MM
    for t, width, theory in ((1 * MM, 1 * MM, "thin"), (10 * MM, 3 * MM, "thick")):
        a, b = R - t / 2, R + t / 2
        if theory == "thin":
            wanted = thin_ring(P, STEEL.E, width * t**3 / 12, R)
            source, tolerance = "Timoshenko, Strength of Materials, part 1, art. 80", 1e-2
        else:
            wanted = thick_ring(P, STEEL.E, STEEL.nu, a, b, width)
            source, tolerance = "Roark's Formulas, table 9.2, case 1, thick rings", 1e-2
        got = _pinched(a, b, width, P)
        cases += [
            Row(
                f"{theory} ring R/t = {R / t:g}, two opposed loads, change of the diameter {where} (m)",
                source,
                want,
                found,
                tolerance,
                "asked for to 1 %; orders to 32, curved-beam theory for the thick ring",
            )
            for where, want, found in zip(("along", "across"), wanted, got, strict=True)
        ]
    a, b, width = 40 * MM, 60 * MM, 1 * MM
    element = FlexibleRing(
        a, b, width, arm=R, groove=width, outside="flexible", refinement=2.0
    ).superelement()
    raceway, flexible = element.raceways["raceway"], np.linalg.pinv(element.K, rcond=1e-13)
    for n in (0, 2, 4, 8):
        row = raceway.rows[raceway.series.index(0, n, 0)]
        pressure = 1.0 / (width * a * (math.pi if n else 2 * math.pi))
        cases.append(
            Row(
                f"ring 40/60 mm, radial compliance of order {n} (m/N)",
                "plane elasticity, Michell and Lamé",
                pressure * annulus_compliance(n, STEEL.E, STEEL.nu, a, b),
                float(row @ flexible @ row),
                2e-5,
                "a section 1 mm wide is in plane stress to this",
            )
        )
    element = FlexibleRing(
        a,
        b,
        width,
        arm=R,
        groove=width,
        outside=RingBed(1e13, axial=0.0),
        refinement=2.0,
        race="inner",
    ).superelement()
    raceway = element.raceways["raceway"]
    rest = np.setdiff1d(np.arange(element.n), element.interfaces["inner"])
    flexible = np.linalg.pinv(element.K[np.ix_(rest, rest)], rcond=1e-13)
    for n in (2, 4, 8):
        row = raceway.rows[raceway.series.index(0, n, 0), rest]
        cases.append(
            Row(
                f"inner ring 40/60 mm on a bed of 1e13 N/m³, radial compliance of order {n} (m/N)",
                "plane elasticity, Michell",
                annulus_on_bed(n, STEEL.E, STEEL.nu, a, b, 1e13) / (width * b * math.pi),
                float(row @ flexible @ row),
                1e-4,
                "plane stress, and a bed that holds the mean across the width",
            )
        )
    return cases


def _pinched(a: float, b: float, width: float, P: float) -> tuple[float, float]:
    ring = FlexibleRing(a, b, width, arm=0.5 * (a + b), order=32, groove=width, outside="flexible")
    element = ring.superelement()
    raceway = element.raceways["raceway"]

    def diameter(psi: float) -> np.ndarray:
        # radial motion at ψ and opposite: even orders, twice
        return np.array(
            [
                0.0 if axial or n % 2 else 2.0 * (math.sin(n * psi) if sine else math.cos(n * psi))
                for axial, n, sine in raceway.series.terms
            ]
        )

    u = raceway.rows @ np.linalg.pinv(element.K, rcond=1e-12) @ raceway.rows.T @ (P * diameter(0.0))
    return float(diameter(0.0) @ u), float(diameter(math.pi / 2) @ u)


def stiff_rings() -> list[Row]:
    """The 6202-like bearing of the reference page in a ring of 10⁶ times the modulus; free ring modes."""
    metal = steel(207e9)
    brg = BallBearing(
        8, 5.953 * MM, 25 * MM, 0.52, 0.53, clearance=10e-6, material=metal, ball_material=metal
    )
    ring = FlexibleRing(14.5 * MM, 17.5 * MM, 11 * MM, bearing=brg, material=steel(207e15))
    flexible = FlexibleBearing(brg, ring)
    q = flexible.displacement((0, 0, 180.0, 0, 0, 0))
    K = flexible.stiffness(q)
    geometry = brg.geometry
    found = (
        ("δz (m)", 23.43301e-6, q[2] - geometry.A * math.sin(geometry.alpha0)),
        ("Q (N)", 87.6163, float(flexible.ball_loads(q).mean())),
        ("kxx (N/m)", 9.533296e7, K[0, 0]),
        ("kzz (N/m)", 1.561296e7, K[2, 2]),
        ("kθθ (N m)", 1242.715, K[3, 3]),
        ("k_xθy (N)", -3.157244e5, K[0, 4]),
    )
    limit = rows(
        "§3.5",
        1e-6,
        "asked for to 1e-6; the digits given are as many",
        INDEPENDENT,
        [(f"6202 in an outer ring of 10⁶ E, {name}", want, got) for name, want, got in found],
    )
    element = FlexibleRing(
        14 * MM, 17.5 * MM, 11 * MM, arm=12 * MM, order=3, outside="flexible", f_max=40e3
    ).superelement()
    frequency = np.sqrt(np.abs(scipy.linalg.eigvalsh(element.K, element.M))) / (2 * math.pi)
    names = ("n = 2, in plane", "n = 2, out of plane", "n = 3, in plane", "n = 3, out of plane")
    modes = [
        (
            f"free ring of raceways and modes, {name} (Hz)",
            f,
            frequency[np.argmin(np.abs(frequency - f))],
        )
        for name, f in zip(names, (8857.0, 14525.0, 24248.0, 37807.0), strict=True)
    ]
    return limit + rows("§3.10", 2e-3, "asked for to 0.2 %", INDEPENDENT, modes)


def distorted_mesh() -> list[Row]:
    """The bonded ring 17.5/20×11 on a mesh of quadrilaterals whose inner corners are moved at random."""
    r = 18.75 + 1.25 * np.sin(0.5 * np.pi * np.linspace(-1, 1, 17))
    z = 5.5 * np.sin(0.5 * np.pi * np.sin(0.5 * np.pi * np.linspace(-1, 1, 49)))
    points = np.stack(np.meshgrid(r, z, indexing="ij"), axis=-1)
    spacing = np.zeros_like(points)
    spacing[1:-1, :, 0] = np.minimum(np.diff(r)[1:], np.diff(r)[:-1])[:, None]
    spacing[:, 1:-1, 1] = np.minimum(np.diff(z)[1:], np.diff(z)[:-1])
    spacing[[0, -1]] = spacing[:, [0, -1]] = 0.0
    points += 0.2 * spacing * np.random.default_rng(1).uniform(-1, 1, points.shape)
    i, j = np.meshgrid(np.arange(r.size - 1), np.arange(z.size - 1), indexing="ij")
    first = (i * z.size + j).ravel()
    cells = np.stack([first, first + z.size, first + z.size + 1, first + 1], axis=-1)
    mesh = quadrilaterals(points.reshape(-1, 2) * MM, cells)
    nu = 0.499
    body = Revolved(
        (Patch(unit_rubber(nu)),),
        {"inner": Cylinder(17.5 * MM), "outer": Cylinder(20.0 * MM)},
        section=mesh,
    )
    K = np.diag(as_printed(body.stiffness()))
    cases = [
        (f"bonded ring 17.5/20×11, ν = 0.499, distorted mesh, {name}", want, K[at])
        for name, want, at in (("axial", 490.43, 2), ("radial", 5708.0, 0), ("tilt", 109280.0, 3))
    ]
    return rows("§3.7", 1e-3, "asked for to 0.1 %", INDEPENDENT, cases)
