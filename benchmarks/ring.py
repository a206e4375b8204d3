"""Time of a step with a bearing in a flexible ring in rubber, its coordinates, and what making it took.

The target is at most 150 coordinates at order 10 and 8 µs a step, on one core. The step's CPU time is the
least of several marches, each of some thousand steps; what a march takes besides its steps is taken off by
marching twice as many.
"""

from __future__ import annotations

import argparse
import json
import time

import bearingdyn as bd

TARGET = {"coordinates": 150, "microseconds": 8.0}
MM = 1e-3
RUBBER = bd.Maxwell(G0=2e6, G=[2e6, 3e6], tau=[1e-3, 1e-5], K=2e9, density=1200.0)


def application(order: int) -> bd.Application:
    """A rotor of 2 kg in a 6305 of seven balls, whose outer ring of 3.5 mm lies in 4 mm of rubber."""
    ball = bd.catalogue.bearing("6305", balls=7, clearance=10e-6, damping=30.0)
    layer = bd.Layer(31 * MM, 35 * MM, 17 * MM, RUBBER)
    app = bd.Application()
    app.add("rotor", bd.RigidBody(2.0, (0.01, 0.01, 0.005)))
    app.ground("rotor.centre", (0, 0, 0, 1e4, 1e4, 1.0), (50, 50, 50, 1, 1, 0.1))
    app.add("ring", bd.FlexibleRing(27.5 * MM, 31 * MM, 17 * MM, bearing=ball, layer=layer, order=order))
    app.ground("ring.outer")
    app.bearing("b", ball, inner="rotor.centre", outer="ring.raceway")
    app.load("rotor.centre", (0.0, -2000.0, 200.0, 0.0, 0.0, 0.0))
    return app


def main() -> None:
    """Print what a step takes, as a line or as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true", help="print JSON")
    parser.add_argument("--order", type=int, default=10)
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    begun = time.process_time()
    eq = bd.equilibrium(application(arguments.order))
    made = time.process_time() - begun

    def marched(steps: int) -> float:
        begun = time.process_time()
        bd.transient(eq, speed=300.0, dt=5e-6, steps=steps, record=["rotor.centre.y"], progress=False)
        return time.process_time() - begun

    short, long = (min(marched(n) for _ in range(arguments.repeats)) for n in (10_000, 30_000))
    found = {
        "coordinates": eq.system.n,
        "microseconds": (long - short) / 20_000 * 1e6,
        "seconds_to_make": made,
    }
    if arguments.json:
        print(json.dumps({"target": TARGET, **found}, indent=1))
        return
    print(
        f"{found['coordinates']} coordinates, {found['microseconds']:.2f} µs a step, made in {made:.1f} s CPU"
    )


if __name__ == "__main__":
    main()
