"""What a ring gives beyond Hertz's contact, and receptances up to a frequency, against finite elements."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.bearing import half_space_orders
from bearingdyn.material import STEEL
from bearingdyn.parts import FlexibleBearing, FlexibleRing, RigidBody, Ring, RingBed, RingPoints
from bearingdyn.parts.raceway_shapes import felt, lossy, misfit, own_scale
from bearingdyn.parts.shape_moduli import moduli_at
from flexible_rings import B6305, CUSHIONED, LAYER, RING, SIZE, audited

# The contact ellipse of a ball of the 6305 under 2 kN is 3.07 mm long; the independent models have 3.0 mm.
LOAD = 2000.0
SOFT = bd.Maxwell(1e6, [], [], K=2e6 * 1.49 / (3 * 0.02), density=1200.0)  # ν = 0.49


@cache
def beyond(Z: int, order: int, outside: str) -> float:
    """Compliance of Z equal loads beyond Hertz, µm/kN."""
    ring = FlexibleRing(*SIZE, bearing=replace(B6305, Z=Z), order=order, outside=outside, load=LOAD)
    return ring.compliance.of(0) * 1e9


@pytest.mark.parametrize(("Z", "wanted"), [(3, 31.91), (7, 5.376), (8, 5.125)])
def test_equal_loads_bend_a_free_ring_as_solid_elements_do(Z: int, wanted: float) -> None:
    # CalculiX, 3.0 × 0.4 mm patch, less the half-space; the 2 %: an even patch is not an ellipse
    assert beyond(Z, Z + 1, "flexible") == pytest.approx(wanted, rel=0.02)
    # orders beyond are folded: the 0.5 %, here what interpolation between orders leaves
    assert beyond(Z, 2 * Z, "flexible") == pytest.approx(beyond(Z, Z + 1, "flexible"), rel=5e-4)


@pytest.mark.parametrize("Z", [3, 7, 8])
def test_a_rigid_bore_stiffens(Z: int) -> None:
    # an independent model, 3.0 × 0.4 mm patch, Z = 7; a wall 3.5 mm deep leaves balls far apart alone: any Z
    assert beyond(Z, Z + 1, "rigid") == pytest.approx(-0.527, rel=0.03)


def test_the_orders_of_the_half_space_are_the_half_space() -> None:
    """h_n(a, R) = h(n a/R)/R: of twice the length half as many orders, each twice; Parseval at high ones."""
    R, count = 0.0275, 4000
    one, other = (half_space_orders(count, a, R, STEEL) for a in (1e-3, 2e-3))
    # orders 50 … 99 of the length 2a are the shares of k a from 99/R to 199/R, orders 99.5 … 199.5 of a
    joined = one[100:199].sum() + 0.5 * (one[99] + one[199])
    assert 2 * other[50:100].sum() == pytest.approx(joined, rel=1e-5)  # halves of a bin, to its curvature
    # at high orders only the energy of the profile counts: (1 − ν²)/(πE)·∫q̂²dκ/k, ∫q̂²dκ = 2π·(3/5)/a
    n = 3000
    k = n / R
    energy = 2 * math.pi * 0.6 / 1e-3
    wanted = (1 - STEEL.nu**2) / (math.pi * STEEL.E) * energy / k / (math.pi * R)
    assert one[n] == pytest.approx(wanted, rel=1e-2)


def test_a_6305_in_a_rigid_bore() -> None:
    brg, angle = FlexibleBearing(B6305, RING), -0.5 * math.pi
    q = brg.displacement((0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), angle)
    # an independent model; the 0.3 and 0.2 %
    assert -q[1] == pytest.approx(36.65e-6, rel=3e-3)
    assert brg.ball_loads(q, angle).max() == pytest.approx(1971.5, rel=2e-3)


def varying(ring: FlexibleRing, angles: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
    """Depth of the inner ring, µm, and largest ball load, N, under 3 kN at cage angles from a ball below."""
    brg, load = FlexibleBearing(B6305, ring), (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)
    found = []
    for a in angles:
        q = brg.displacement(load, a - 0.5 * math.pi)
        found.append((-1e6 * q[1], brg.ball_loads(q, a - 0.5 * math.pi).max()))
    depth, peak = np.array(found).T
    return depth, peak


@pytest.mark.parametrize(
    ("stiffness", "depth", "peak", "swing"),
    [(1e9, 1869.34, 1464.6, 2.884), (1e10, 236.35, 1502.0, 1.990), (1e11, 65.290, 1708.0, 1.192)],
)
def test_a_bearing_on_a_bed(stiffness: float, depth: float, peak: float, swing: float) -> None:
    """Raw orders to 10 give the independent figures; what they lack of the race's give is 0.28 µm.

    The figures were made with orders to 10 and Hertz's dent in them, 2.2 % too stiff for equal loads.
    """
    bed, half = RingBed(stiffness), math.pi / 7
    y, Q = varying(replace(RING, outside=bed), (0.0, half))
    raw = FlexibleRing(*SIZE, arm=B6305.arm, order=10, outside=bed)
    brg = FlexibleBearing(B6305, replace(RING, order=10, outside=bed))
    brg.__dict__["_element"] = raw.superelement()
    load = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)
    q = brg.displacement(load, -0.5 * math.pi)
    # the 1e-3, and its digits
    assert -1e6 * q[1] == pytest.approx(depth, rel=1e-4)
    assert brg.ball_loads(q, -0.5 * math.pi).max() == pytest.approx(peak, rel=1e-4)
    other = brg.displacement(load, half - 0.5 * math.pi)
    # between two ball positions, the swing but for where its extremes lie
    assert abs(1e6 * (q[1] - other[1])) == pytest.approx(swing, rel=0.02)
    assert y[0] - depth == pytest.approx(0.28, abs=0.03)
    assert Q[0] == pytest.approx(peak, rel=1e-3)


def test_a_bearing_on_two_points() -> None:
    # a soft bed keeps the ring, on whose x no load acts, from rolling off
    held = (RingPoints((0.5 * math.pi, -0.5 * math.pi), 5e7), RingBed(1e6))
    y, Q = varying(replace(RING, outside=held, order=10), np.linspace(0.0, 2 * math.pi / 7, 13)[:-1])
    # order 42 of an independent model; the 1.5 %
    assert y[0] == pytest.approx(92.53, rel=0.015)
    assert Q[0] == pytest.approx(2412.6, rel=2e-3)
    assert np.ptp(y) == pytest.approx(26.60, rel=0.015)


def test_free_modes_of_rings() -> None:
    plain = Ring(*SIZE)
    for n, wanted in ((2, 2611.8), (3, 7325.8), (4, 13869.0)):
        # own finite elements, Timoshenko's ring and CalculiX; the 0.3 %
        assert plain.modes(n, 1).frequency[0] == pytest.approx(wanted, rel=3e-3)
    section = {"groove": 9.2e-3, "groove_radius": 6.1e-3}
    grooved = FlexibleRing(25.6e-3, 31e-3, 17e-3, bearing=B6305, outside="flexible", **section)
    for n, wanted in ((2, 3849.4), (3, 10685.0)):
        # CalculiX on the same section; the 0.3 %
        assert grooved.body.modes(n, 1).frequency[0] == pytest.approx(wanted, rel=3e-3)


def test_orders_of_the_race_by_itself() -> None:
    ring = FlexibleRing(*SIZE, arm=B6305.arm, outside="flexible")
    for n, wanted in ((0, 0.43628), (2, 68.140), (3, 9.5510), (7, 0.31495), (8, 0.19937)):
        # own finite elements, nm/N, half of the width pressed evenly; a mesh as coarse as this, to 0.2 %
        got = ring.body.groove_compliance(n, "raceway", np.array([1.0, 0.0])) * 1e9
        assert got == pytest.approx(wanted, rel=2e-3)


def test_f_max_means_right_up_to_there() -> None:
    """The stretch mode of order 1 lies above f_max, at 39.6 kHz, and is felt far below."""
    ring = FlexibleRing(*SIZE, arm=0.021978, order=2, outside="flexible", f_max=30e3)
    element = ring.superelement()
    raceway = element.raceways["raceway"]
    row = raceway.rows[raceway.series.index(0, 1, 0)]
    for frequency, wanted in ((5e3, -1.1505e-8), (9.078e3, -3.2735e-9)):
        D = element.K - (2 * math.pi * frequency) ** 2 * element.M
        # the unreduced ring, in the issue to five digits; a net of 0.1 % from another mesh
        assert row @ np.linalg.solve(D, row) == pytest.approx(wanted, rel=2e-3)


def worst(ring: FlexibleRing, frequencies: np.ndarray, most: int = 99) -> dict[int, float]:
    """Largest relative error of what raceway and interface feel, by order, against the whole model."""
    body, found = ring.body, {}
    for (order, _), shapes in zip(body._orders, body._ports, strict=True):
        if not len(order.ports) or order.h.order > most:
            continue
        pairs = []
        for f in frequencies:
            w = 2 * math.pi * f
            G = lossy(moduli_at(body.regions, w))
            D = shapes.Psi.T @ (order.dynamic(G, w) @ shapes.Psi)
            pairs.append((order.motion(G, w)[1], felt(D, order.ports @ shapes.Psi, shapes.faces)))
        usual = np.median([np.abs(np.diag(T)) for T, _ in pairs], axis=0)
        found[order.h.order] = max(misfit(got, T, own_scale(T, usual)) for T, got in pairs)
    return found


def test_a_sharp_resonance_of_rubber_between_the_frequencies_looked_at_is_right() -> None:
    """Order 0 of springy rubber: torsion and breathing at 3620 Hz, 2 % wide, where nothing else is near."""
    ring = replace(CUSHIONED, layer=replace(LAYER, material=SOFT), order=7)
    got = worst(ring, np.array([3520.0, 3600.0, 3620.0, 3650.0]), most=0)[0]
    assert got < 0.01
    # of the larger of the two families of order 0
    assert 0.5 * got < ring.error[0] < 2.0 * got


@pytest.mark.parametrize("stiffness", [1e9, 3e9, 1e11])
def test_receptances_of_a_ring_on_a_bed_are_right_up_to_f_max(stiffness: float) -> None:
    """Against the whole ring, its outside joined to the bed order by order: a spring at two more ports."""
    ring = FlexibleRing(*SIZE, arm=B6305.arm, outside=RingBed(stiffness), order=7)
    element = ring.superelement()
    rest = np.setdiff1d(np.arange(element.n), element.interfaces["outer"])
    raceway, found = element.raceways["raceway"], {}
    for order, _ in ring.body._orders:
        n = order.h.order
        if not len(order.ports):
            continue
        K = (2 if n == 0 else 1) * math.pi * SIZE[1] * SIZE[2] * stiffness * np.diag([0.0, 0.0, 1.0, 1.0])
        rows = raceway.rows[[raceway.series.index(axial, n, 0) for axial in (0, 1)]][:, rest]
        errors = []
        for f in 6e3 * np.array([0.01, 0.21, 0.43, 0.62, 0.81, 1.0]):
            w = 2 * math.pi * f
            T = order.motion(moduli_at(ring.body.regions, w), w)[1]
            whole = np.linalg.solve(np.eye(4) + T @ K, T)[:2, :2]
            D = (element.K - w**2 * element.M)[np.ix_(rest, rest)]
            got = rows @ np.linalg.solve(D, rows.T)
            errors.append(np.linalg.norm(got - whole, 2) / np.linalg.norm(whole, 2))
        found[n] = max(errors)
    assert max(found.values()) < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("rubber", ["springy", "lossy"])
def test_receptances_in_rubber_are_right_up_to_f_max(rubber: str) -> None:
    layer = replace(LAYER, material=SOFT) if rubber == "springy" else LAYER
    ring = replace(CUSHIONED, layer=layer, order=10)
    assert ring.superelement().n <= 150
    # the rubber's own resonances lie from 2.8 kHz on, 2 % wide where it is springy
    got = worst(
        ring, np.array([60.0, 780.0, 1860.0, *np.arange(2800, 4100, 60), 4300, 4700, 5200, 5600, 6e3])
    )
    assert max(got.values()) < 0.01  # what f_max promises
    # what is told is that, within a factor of two, where there is anything to tell
    for n, told in ring.error.items():
        if got[n] > 1e-3:
            assert 0.5 * got[n] < told < 2.0 * got[n]


PITCH = 2 * math.pi / 7
BED = replace(
    RING, outside=RingBed(3e9, damping=3e-5), order=10, outputs={"below": (SIZE[1], 0.0, -math.pi / 2)}
)


def on_bed() -> bd.Application:
    """A rotor of 2 kg under 500 N, its bearing's ring on a bed."""
    app = bd.Application()
    app.add("rotor", RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", stiffness=(0, 0, 1e4, 1e4, 1e4, 1.0), damping=(500, 500, 500, 1, 1, 0.1))
    app.add("ring", BED)
    app.ground("ring.outer")
    app.bearing("b", replace(B6305, angle0=-math.pi / 2), inner="rotor.centre", outer="ring.raceway")
    app.load("rotor.centre", (0.0, -500.0, 0.0, 0.0, 0.0, 0.0))
    return app


@cache
def at_rest(count: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Cage angles (count,) over a passage of the balls, and the balls' loads (count, 7) under 500 N, N."""
    brg = FlexibleBearing(B6305, BED)
    angles = -math.pi / 2 + PITCH * np.arange(count) / count
    load = (0.0, -500.0, 0.0, 0.0, 0.0, 0.0)
    return angles, np.stack([brg.ball_loads(brg.displacement(load, a), a) for a in angles])


def below(angles: np.ndarray, loads: np.ndarray, rate: float) -> np.ndarray:
    """Lines 1–4 of the outside below, µm, as the ring's linear answer to the balls' loads over a passage.

    rate is the angular frequency of the first line; 0: at rest.
    """
    element = BED.superelement()
    rest = np.setdiff1d(np.arange(element.n), element.interfaces["outer"])
    raceway = element.raceways["raceway"]
    psi = angles[:, None] + PITCH * np.arange(7)
    pushed = [
        (loads * (np.sin(n * psi) if sine else np.cos(n * psi))).sum(axis=1) * (not axial)
        for axial, n, sine in raceway.series.terms
    ]
    force = raceway.rows[:, rest].T @ np.fft.fft(pushed)[:, 1:5] * (2e6 / len(angles))
    found = []
    for line, f in enumerate(force.T, start=1):
        w = line * rate
        D = (element.K + 1j * w * element.C - w**2 * element.M)[np.ix_(rest, rest)]
        found.append(abs(element.outputs["below"][1, rest] @ np.linalg.solve(D, f)))
    return np.array(found)


@cache
def marched(speed: float, steps: int, settle: int) -> tuple[np.ndarray, np.ndarray]:
    """Lines 1–4 of the outside below, µm, marched; and the ring's answer to the loads of that march."""
    rate = 7 * B6305.cage_ratio * speed
    run = bd.transient(
        bd.equilibrium(on_bed()),
        speed=speed,
        dt=2 * math.pi / rate / steps,
        steps=steps,
        record=["ring.below.y", *(f"b.ball{k}" for k in range(1, 8))],
        settle=settle * steps,
        filter=False,
    )
    values = run["record"].values[-steps:]
    angles = -math.pi / 2 + PITCH * (settle + np.arange(1, steps + 1) / steps)
    return 2e6 * np.abs(np.fft.rfft(values[:, 0]))[1:5] / steps, below(angles, values[:, 1:], rate)


def test_lines_of_the_outside_on_a_bed_are_those_of_a_beam() -> None:
    """Timoshenko's ring on Winkler's bed, order by order, under the balls' loads."""
    angles, loads = at_rest(16)
    a, height = 0.5 * (SIZE[0] + SIZE[1]), SIZE[1] - SIZE[0]
    area, shear = SIZE[2] * height, 5 / 6 * STEEL.E / (2 * (1 + STEEL.nu))
    psi = angles[:, None] + PITCH * np.arange(7) + math.pi / 2
    w = np.zeros(len(angles))
    for n in range(11):
        # radial and tangential motion and turn of the section: stretch, shear and bend
        stretch, slip, bend = np.array([[1 / a, n / a, 0], [-n / a, -1 / a, 1], [0, 0, n / a]])
        K = a * STEEL.E * (area * np.outer(stretch, stretch) + area * height**2 / 12 * np.outer(bend, bend))
        K += a * shear * area * np.outer(slip, slip)
        K[0, 0] += SIZE[1] * SIZE[2] * 3e9
        give = np.linalg.inv(K)[0, 0] / math.pi if n else 1 / (2 * math.pi * K[0, 0])
        w += give * (loads * np.cos(n * psi)).sum(axis=1)
    line = 2e6 * abs(np.fft.rfft(w)[1]) / len(w)
    # the middle of the width, under the balls, moves 7 % more than the section does
    assert below(angles, loads, 0.0)[0] == pytest.approx(line, rel=0.1)


@pytest.mark.slow
def test_a_slow_march_on_a_bed_is_a_row_of_states_at_rest() -> None:
    lines, _ = marched(20.0, 2000, 1)
    # 1 % of lines 1 and 2; of what follows, the loads of balls that come and go within a 64th of a passage
    np.testing.assert_allclose(lines, below(*at_rest(), 0.0), rtol=0.01, atol=2e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "settle"), [(20.0, 1), (300.0, 8)])
def test_a_march_on_a_bed_answers_its_balls(speed: float, settle: int) -> None:
    lines, answer = marched(speed, 2000, settle)
    # both second order in a 2000th of a passage; 1e-5 µm of what has not rung down
    np.testing.assert_allclose(lines, answer, rtol=1e-3, atol=1e-5)


def test_the_energy_of_a_march_on_a_bed_is_of_second_order() -> None:
    missing = [abs(audited(bd.equilibrium(on_bed()), 2e-6 / k, steps=4000 * k)[0]) for k in (1, 2)]
    # half the step, a quarter of the residual; 4.0 is measured, and 2 or 8 would be another order
    assert missing[0] / missing[1] == pytest.approx(4.0, rel=0.15)
    assert missing[0] < 1e-4 * 2e-5  # of what the supports dissipate meanwhile, 2e-5 J


def test_beds_and_points_hold_a_rigid_bore_by_their_pressure() -> None:
    """On the bore, the ring held: k cos² around the outside, and k r² of tilts along the axis."""
    k, axial, damping, angles = 3e9, 2e9, 3e-5, (0.3, 2.0, 4.5)
    side = math.pi * SIZE[1] * SIZE[2]
    feet = np.array([[math.cos(a), math.sin(a)] for a in angles])
    for support, xy, z in (
        (RingBed(k, axial=axial, damping=damping), k * side * np.eye(2), 2 * axial * side),
        (RingPoints(angles, k, axial=axial, damping=damping), k * feet.T @ feet, 3 * axial),
    ):
        element = replace(RING, outside=support, f_max=0.0).superelement()
        at = element.interfaces["outer"]
        for matrix, share in ((element.K, 1.0), (element.C, damping)):
            own = matrix[np.ix_(at, at)] / share
            # closed forms, round-off of the quadrature
            np.testing.assert_allclose(own[:2, :2], xy, rtol=0, atol=1e-9 * k * side)
            assert own[2, 2] == pytest.approx(z, rel=1e-9)
            # both tilts together: axial·r²
            assert own[3, 3] + own[4, 4] == pytest.approx(z * SIZE[1] ** 2, rel=1e-9)


def test_the_bed_carries_the_load_that_the_race_takes() -> None:
    stiffness, load = 1e10, (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0)
    brg = FlexibleBearing(B6305, replace(RING, outside=RingBed(stiffness), f_max=0.0))
    q = brg.displacement(load, 0.2)
    psi = np.linspace(0.0, 2 * math.pi, 400, endpoint=False)
    outside, race = brg.outside(q, psi, 0.2), brg.race(q, psi, 0.2)
    # pressure by depth, over the ring's outside: the trapezoidal rule is exact for its orders
    area = SIZE[1] * SIZE[2] * 2 * math.pi / psi.size
    pressed = stiffness * area * (outside[:, 0] @ np.stack([np.cos(psi), np.sin(psi)], axis=-1))
    np.testing.assert_allclose(pressed, load[:2], atol=1e-6 * 3000)
    # between them is the dent of 1.5 kN by orders to 8, 2.19 µm of 205
    np.testing.assert_allclose(race[:, 0], outside[:, 0], rtol=0, atol=0.012 * np.abs(race).max())
    with pytest.raises(ValueError, match="outside is 'rigid'"):
        FlexibleBearing(B6305, RING).outside(q, psi)
    with pytest.raises(ValueError, match="azimuth"):
        brg.race(q, [math.nan])


def test_the_shape_of_a_ring_is_drawn() -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    load, below = (0.0, -3000.0, 0.0, 0.0, 0.0, 0.0), -0.5 * math.pi
    brg = FlexibleBearing(B6305, replace(RING, outside=RingBed(1e11), f_max=0.0))
    ax = bd.plot.ring_shape(brg, load, below)
    race = ax.lines[1].get_xydata()
    motion = 1e-3 * np.hypot(*race.T) - SIZE[0]
    q = brg.displacement(load, below)
    wanted = brg.race(q, np.linspace(0, 2 * math.pi, 721), below)[:, 0]
    # drawn in one proportion to what it is
    assert np.ptp(motion / np.abs(motion).max() - wanted / np.abs(wanted).max()) < 1e-9
    assert f"{brg.ball_loads(q, below).max():.0f} N" in ax.lines[2].get_label()
    with pytest.raises(ValueError, match="bearing"):
        bd.plot.ring_shape(B6305, load)
    import matplotlib.pyplot as plt

    plt.close(ax.figure)


def test_waves_that_the_mesh_does_not_hold_are_refused() -> None:
    """In soft rubber a shear wave at 20 kHz is 1.4 mm long; what the message names is taken."""
    ring = replace(CUSHIONED, layer=replace(LAYER, material=SOFT), order=8)
    with pytest.raises(
        ValueError, match=r"f_max is 20000 Hz; shear waves of regions\[1\] are 1\.44 mm"
    ) as told:
        replace(ring, f_max=20e3)
    finer, limit = re.findall(r"refinement=([\d.]+), or an f_max of at most ([\d.]+)", str(told.value))[0]
    side = math.sqrt(1e6 / 1200.0) / (2.0 * float(limit))  # half a wave, as long as the longest element
    z = ring.body.mesh.z[ring.body.mesh.elements[ring.body.mesh.region == 1]]
    assert side == pytest.approx(np.ptp(z, axis=1).max(), rel=1e-2)  # three digits are told, rounded down
    replace(ring, f_max=float(limit))
    replace(ring, f_max=20e3, refinement=float(finer))
    with pytest.raises(ValueError, match=r"wave: give an f_max of at most"):  # no mesh is so fine
        replace(ring, f_max=200e3)
    # without a frequency there is no wave
    replace(ring, f_max=0.0)


def test_bad_input_names_what_would_do() -> None:
    for change, name in (
        ({"order": 6}, "order is 6; the bearing has 7 balls.*give 8"),
        ({"r_outer": 28.0e-3}, "r_outer.*mm thick under a contact .* at least"),
        ({"groove": 2e-3}, "groove is 0.002"),
        ({"load": -1.0}, "load"),
        ({"bearing": "6305"}, "bearing"),
        ({"outside": ()}, "outside"),
    ):
        with pytest.raises(ValueError, match=name):
            replace(RING, **change)
    with pytest.raises(ValueError, match="r_outer is") as told:
        replace(RING, r_outer=28.0e-3)
    replace(RING, r_outer=float(str(told.value).split("at least ")[1].split(" m")[0]))  # what is told does
    with pytest.raises(ValueError, match="bearing is None"):
        _ = FlexibleRing(*SIZE, arm=0.02).compliance
    with pytest.raises(ValueError, match="boundary is None"):
        FlexibleRing.of(replace(B6305, boundary=None))
    app = bd.Application()
    app.add("rotor", RigidBody(1.0, (1e-3,) * 3))
    app.add("ring", RING)
    with pytest.raises(ValueError, match="made for 7"):
        app.bearing("b", replace(B6305, Z=8), inner="rotor.centre", outer="ring.raceway")
    for wrong in (
        {"stiffness": 0.0},
        {"stiffness": 1e9, "arc": (1.0, 1.0)},
        {"stiffness": 1e9, "axial": -1.0},
    ):
        with pytest.raises(ValueError, match=list(wrong)[-1]):
            RingBed(**wrong)
    with pytest.raises(ValueError, match="azimuth"):
        RingPoints((), 1e7)
