"""Rotors on bearings of the catalogue at random, in ordinary ranges: none fails, none warns without cause."""

from __future__ import annotations

import math
import statistics
import time
import warnings

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.notice import BearingWarning, StrainedLayer, VolumeCounts

# all that stand in the catalogue by designation; the pitch decides on shaft and load
DESIGNATIONS = sorted(bd.catalogue.CATALOGUE)


RECORD = ["shaft.middle.y", "left.loaded"]


def application(rng: np.random.Generator) -> tuple[bd.Application, bd.BallBearing]:
    """A shaft with a disc on two equal bearings, held rigidly or by rubber, loaded by C0/50 to C0/4."""
    name = str(rng.choice(DESIGNATIONS))
    entry = bd.catalogue.CATALOGUE[name]
    angular = entry.contact_angle is not None
    given = {} if angular else {"clearance": float(rng.uniform(2e-6, 20e-6))}
    if rng.random() < 0.3:
        given["film"] = float(10 ** rng.uniform(-7.3, -6))
    if rng.random() < 0.3:
        given["waviness"] = [
            bd.Waviness("inner", int(rng.integers(2, 20)), float(10 ** rng.uniform(-8.5, -6.5)), phase=1.0)
        ]
    if rng.random() < 0.3:
        given["defects"] = [bd.Pit("outer", float(rng.uniform(0, 6)), 1e-3, 5e-6)]
    given["damping"] = bd.LoadDamping(1e-5)
    bearing = bd.catalogue.bearing(name, **given)
    d, L = entry.bore, float(rng.uniform(6, 12)) * entry.bore
    app = bd.Application()
    mass = bd.Disc.cylinder(0.5 * L, 3 * d, 0.6 * d, d)
    seats = {"left": 0.15 * L, "right": 0.85 * L}
    app.add(
        "shaft", bd.Shaft([bd.Section(L, d)], seats, {"middle": 0.5 * L}, [mass], damping=0.01, f_max=3e3)
    )
    # rubber of ordinary hardness, 40 to 60 Shore A
    G = float(10 ** rng.uniform(5.7, 6.3))
    rubber = bd.Maxwell(G, [G, 2 * G], [1e-3, 1e-5], K=2e9, density=1150.0)
    r = 0.5 * entry.outside
    soft = rng.random() < 0.3
    for side in seats:
        outer = "ground"
        if soft:
            layer = bd.Layer(r, r + 2e-3, entry.width, rubber, refinement=0.3)
            with warnings.catch_warnings():
                # rightly told where 1 or 3 GPa change it by a tenth; test_named_doubts holds it to that
                warnings.simplefilter("ignore", VolumeCounts)
                app.add(f"layer_{side}", layer)
            app.add(f"ring_{side}", bd.RigidBody.ring(0.85 * r, r, entry.width))
            app.connect(f"ring_{side}.centre", f"layer_{side}.inner")
            app.ground(f"layer_{side}.outer")
            outer = f"ring_{side}.centre"
        app.bearing(side, bearing, inner=f"shaft.{side}", outer=outer)
    C0 = bearing.static_rating
    direction = rng.uniform(0, 2 * math.pi)
    F = C0 * 10 ** rng.uniform(-1.7, -0.6)
    axial = F * rng.uniform(0.1, 0.5)
    app.gravity((0, -9.81, 0))
    radial = (F * math.cos(direction), F * math.sin(direction))
    # an angular bearing carries thrust one way: both look the same way here
    app.load("shaft.middle", (*radial, axial, 0, 0, 0))
    app.unbalance("shaft.middle", 6.3e-3 / 300 * app.mass("shaft"), phase=float(rng.uniform(0, 6)))
    return app, bearing


def strained(app: bd.Application, state: bd.Equilibrium) -> list[float]:
    """Displacement across the axis of each layer's faces at the end where it is larger, of its thickness."""
    found = []
    for name, part in app.plan.sources.items():
        if isinstance(part, bd.Layer):
            x, y, _, a, b, _ = state.displacement(f"{name}.outer") - state.displacement(f"{name}.inner")
            ends = [math.hypot(x + b * z, y - a * z) for z in (-0.5 * part.width, 0.5 * part.width)]
            found.append(max(ends) / (part.r_outer - part.r_inner))
    return found


def leaning(app: bd.Application, state: bd.Equilibrium) -> int:
    """How many bearings have rings that lean against each other by more than .01 rad."""
    found = 0
    for side in state.bearings:
        tilt = state.displacement(f"shaft.{side}")[3:5]
        if f"ring_{side}" in app.plan.sources:
            tilt = tilt - state.displacement(f"ring_{side}.centre")[3:5]
        found += math.hypot(*tilt) > 0.01
    return found


def overloaded(
    app: bd.Application, state: bd.Equilibrium, bearing: bd.BallBearing, speed: float
) -> tuple[bool, bool]:
    """Whether the unbalance response warns of a ball load, and whether it could exceed 4.2 GPa (ISO 76).

    Could: the heaviest ball at rest, pressed on by all that its rings move, in phase and towards each other.
    """
    rings = [
        *(f"shaft.{side}" for side in state.bearings),
        *(f"{n}.centre" for n in app.plan.sources if n[:4] == "ring"),
    ]
    places = ["shaft.middle.y", *(f"{ring}.{c}" for ring in rings for c in ("x", "y", "z", "θx", "θy"))]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", BearingWarning)
        response = bd.unbalance_response(state, [speed], places)["response"].values
    assert np.isfinite(response).all()
    arms = np.array([1.0, 1.0, 1.0, bearing.Dpw, bearing.Dpw])
    swing = (np.abs(response.ravel()[1:]).reshape(len(rings), 5) * arms).sum()
    rest = max(float(b.loads.max()) for b in state.bearings.values())
    heaviest = bearing.kappa * ((rest / bearing.kappa) ** (2 / 3) + swing) ** 1.5
    return bool(told), bearing.pressure(heaviest) > 4.2e9


@pytest.mark.parametrize("count", [30, pytest.param(350, marks=pytest.mark.slow)])
def test_ordinary_applications_neither_fail_nor_warn_without_cause(count):
    """Causes: a layer displaced by more than 4 % of its thickness, whose stiffness is 1 % off; rings that
    lean by more than .01 rad; a resonance in which balls are pressed harder than their static rating."""
    rng = np.random.default_rng(350)
    seconds, pressures, lowest, far, lean, heavy = [], [], [], 0, 0, 0
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(count):
            app, bearing = application(rng)
            began = time.process_time()
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always", StrainedLayer)
                warnings.simplefilter("always", BearingWarning)
                state = bd.equilibrium(app)
            strains = [w for w in told if w.category is StrainedLayer]
            # 6e² = 1 %: the finite-strain stiffness of a bonded ring
            assert len(strains) == sum(6.0 * e**2 > 0.01 for e in strained(app, state))
            assert len(told) - len(strains) == leaning(app, state)
            far += bool(strains)
            lean += len(told) > len(strains)
            # speed value below 0.5e6 mm/min
            speed = rng.uniform(0.05, 0.5) * 1e6 / (bearing.Dpw * 1e3) * math.pi / 30
            found = bd.modes(state, 8, speed=0.0)["frequency"].values
            told_heavy, can_be = overloaded(app, state, bearing, speed)
            assert can_be or not told_heavy
            heavy += told_heavy
            run = bd.transient(
                state, speed=speed, dt=1e-6, steps=20, record=["shaft.middle.y", "left.loaded"]
            )
            seconds.append(time.process_time() - began)
            assert np.isfinite(found).all()
            assert np.isfinite(run["record"].values).all()
            heaviest = max(float(b.loads.max()) for b in state.bearings.values())
            pressures.append(bearing.pressure(heaviest))
            lowest.append(float(found[found > 1.0].min()))
    print(
        f"{count} applications: pressures {min(pressures) / 1e9:.2f} to {max(pressures) / 1e9:.2f} GPa, "
        f"lowest modes {min(lowest):.0f} to {max(lowest):.0f} Hz, "
        f"{1e3 * statistics.median(seconds):.0f} ms each; {far} with a layer displaced by more than 4 %, "
        f"{lean} with rings that lean, {heavy} with an overload in the unbalance response"
    )
    # resonances are rare
    assert heavy <= 0.02 * count
