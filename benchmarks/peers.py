"""One rotor on two bearings of eight Hertzian balls, marched by bearingdyn and two other programs in one run.

python benchmarks/peers.py [--json]     (pip install ross-rotordynamics "plotly<6" exudyn; absent: skipped)

All march the same ten Timoshenko elements (66 coordinates), disc, balls, load, time step and output from
rest at zero, by Newmark's average acceleration:

bearingdyn  the part Shaft with all of its modes, unreduced; and, as it would be used, with modes to 5 kHz
ROSS        its ShaftElement and DiskElement, run_time_response(method="newmark"), the only Newmark it has;
            the balls through add_to_RHS, called once a step with the state before: their force lags a step
EXUDYN      ObjectGenericODE2 with the element matrices (it has no linear rotor element), TrapezoidalIndex2
            with modified Newton; the balls as a user function of that object, with its Jacobian. EXUDYN's
            own ball-bearing machine (CreateBallBearing) cannot express the case: its balls have mass, six
            coordinates and two contacts each and carry their cage along; here they have no mass, and the
            cage turns as prescribed.

The peers' balls are the few lines of NumPy below, written from the law and not taken from this package.
Static deflections: each program's own solver; ROSS, which has none for contacts, lends its stiffness matrix.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import json
import math
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

import bearingdyn as bd
from bearingdyn import core
from bearingdyn.fem import assemble_beam

DT, STEPS, REPEATS = 2.5e-6, 2000, 5
SPEED = 5000 * math.pi / 30
LENGTH, DIAMETER, ELEMENTS = 0.5, 0.03, 10
SEATS, MIDDLE = (1, 9), 5  # nodes of the bearings and of the disc
SEATED = 2e-5  # m, axial, where a static search begins: the balls bear there
DISC = (4.0, 0.008, 0.014)  # mass, kg; diametral and polar moment of inertia, kg m²
LOAD = np.array([0.0, -1000.0, 600.0])  # N on the disc: radial and axial
KAPPA, DAMPING = 8e9, 300.0  # N/m^1.5 and N s/m of each ball; the lag of ROSS needs that much damping

# The same elements and balls, written independently: what may differ is where the static iterations stop.
# EXUDYN's stops at 1e-7 of the first residual, as round-off allows it.
STATIC_TOLERANCE = 1e-6
# EXUDYN iterates the same scheme to 1e-9. A force that lags a step, as in ROSS, is wrong by omega dt of
# itself: 1.6 % at 1 kHz, where the contacts' motion ends.
MOTION_TOLERANCE = {"exudyn": 1e-6, "ross": 0.02}


def bearing() -> bd.BallBearing:
    """Angular-contact bearing, its balls just touching at rest."""
    return bd.BallBearing(
        Z=8,
        Dw=9e-3,
        Dpw=40e-3,
        fi=0.52,
        fo=0.53,
        contact_angle=math.radians(15.0),
        kappa=KAPPA,
        damping=DAMPING,
    )


@dataclass(frozen=True)
class Balls:
    """Force of the balls on the six coordinates of each seat, and its derivatives: paper eqs (1)-(4)."""

    A: float
    X: float  # axial and radial distance of the groove centres, m
    Y: float
    arm: float
    cage_ratio: float
    azimuth: np.ndarray

    @classmethod
    def of(cls, brg: bd.BallBearing) -> Balls:
        """The numbers of a bearing."""
        A = (brg.fi + brg.fo - 1.0) * brg.Dw
        assert brg.contact_angle is not None
        X, Y = A * math.sin(brg.contact_angle), A * math.cos(brg.contact_angle)
        return cls(A, X, Y, brg.arm, brg.cage_ratio, 2.0 * math.pi * np.arange(brg.Z) / brg.Z)

    def contacts(self, q: np.ndarray, t: float, speed: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Normals (seats, balls, 6), indentations and what the races' running past adds to their rates."""
        psi = self.azimuth + self.cage_ratio * speed * t
        c, s = np.cos(psi), np.sin(psi)
        radial, axial, radial_slope, axial_slope = np.zeros((4, psi.size, 6))
        radial[:, 0], radial[:, 1] = c, s
        radial_slope[:, 0], radial_slope[:, 1] = -s, c
        axial[:, 2], axial[:, 3], axial[:, 4] = 1.0, self.arm * s, -self.arm * c
        axial_slope[:, 3], axial_slope[:, 4] = self.arm * c, self.arm * s
        X, Y = self.X + q @ axial.T, self.Y + q @ radial.T
        length = np.sqrt(X * X + Y * Y)
        sine, cosine = X / length, Y / length
        rate = self.cage_ratio * speed * (sine * (q @ axial_slope.T) + cosine * (q @ radial_slope.T))
        return sine[..., None] * axial + cosine[..., None] * radial, length - self.A, rate

    def force(self, q: np.ndarray, v: np.ndarray, t: float, speed: float) -> np.ndarray:
        """Force (seats, 6) on the inner rings at displacement and velocity (seats, 6)."""
        normal, delta, rate = self.contacts(q, t, speed)
        rate += (normal @ v[..., None])[..., 0]
        pressed = np.maximum(delta, 0.0)
        load = np.maximum(KAPPA * pressed * np.sqrt(pressed) + DAMPING * rate * (delta > 0.0), 0.0)
        return -(load[:, None, :] @ normal)[:, 0]

    def tangent(self, q: np.ndarray, t: float, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Stiffness and damping (seats, 6, 6), without the small terms of normals that turn."""
        normal, delta, _ = self.contacts(q, t, speed)
        k = 1.5 * KAPPA * np.sqrt(np.maximum(delta, 0.0))
        turned = normal.swapaxes(1, 2)
        return (turned * k[:, None]) @ normal, DAMPING * (turned * (delta > 0.0)[:, None]) @ normal


@dataclass(frozen=True)
class Outcome:
    """What a program gave: motion of the disc (STEPS,) and its static deflection, m; seconds a step."""

    version: str
    motion: np.ndarray
    static: float
    seconds: float


def best(run: Callable[[], np.ndarray], repeats: int) -> tuple[np.ndarray, float]:
    """Result and least time a step of some runs."""
    least = math.inf
    for _ in range(repeats):
        began = time.perf_counter()
        motion = run()
        least = min(least, time.perf_counter() - began)
    return motion, least / STEPS


def seat_coordinates() -> np.ndarray:
    """Indices (seats, 6) of the seats' coordinates."""
    return 6 * np.array(SEATS)[:, None] + np.arange(6)


def loads() -> np.ndarray:
    """The load on all 66 coordinates."""
    p = np.zeros(6 * (ELEMENTS + 1))
    p[6 * MIDDLE : 6 * MIDDLE + 3] = LOAD
    return p


def spin_spring(K: np.ndarray) -> np.ndarray:
    """Diagonal that holds the free spin in a static solve; nothing loads it."""
    held = np.zeros(len(K))
    held[5::6] = 1e-9 * np.abs(K).max()
    return held


def static_deflection(K: np.ndarray, balls: Balls) -> float:
    """Static deflection of the disc, m, by Newton with a program's stiffness matrix and the balls."""
    seats, rest = seat_coordinates(), np.zeros((2, 6))
    held = spin_spring(K)
    x = np.zeros(len(K))
    x[2::6] = SEATED
    for _ in range(200):
        residual = K @ x + held * x - loads()
        residual[seats] -= balls.force(x[seats], rest, 0.0, 0.0)
        J = K + np.diag(held)
        for at, stiffness in zip(seats, balls.tangent(x[seats], 0.0, 0.0)[0], strict=True):
            J[np.ix_(at, at)] += stiffness
        step = np.linalg.solve(J, residual)
        x -= step
        if np.abs(step).max() < 1e-14:
            return float(x[6 * MIDDLE + 1])
    raise RuntimeError("the static deflection of a peer did not converge")


def by_bearingdyn(f_max: float) -> Outcome:
    """This package: the shaft as a part, two bearings to ground."""
    sections = [bd.Section(LENGTH, DIAMETER)]
    z = np.linspace(0.0, LENGTH, ELEMENTS + 1)
    shaft = bd.Shaft(
        sections,
        seats={"left": z[SEATS[0]], "right": z[SEATS[1]]},
        points={"disc": z[MIDDLE]},
        discs=[bd.Disc(z[MIDDLE], *DISC)],
        f_max=f_max,
        element_length=LENGTH / ELEMENTS * (1 + 1e-9),
    )
    app = bd.Application()
    app.add("shaft", shaft)
    for side in ("left", "right"):
        app.bearing(side, bearing(), inner=f"shaft.{side}", outer="ground")
    app.load("shaft.disc", (*LOAD, 0.0, 0.0, 0.0))
    eq = bd.equilibrium(app)
    modal, _ = eq.system.modal()
    row = modal.row("shaft.disc.y")
    model = modal.model([(core.CHANNEL_KINDS["displacement"], row, 0, 0)])
    scheme = core.Stepping(DT, speed=SPEED)

    def run() -> np.ndarray:
        state = model.state(0.0, np.zeros(modal.n), np.zeros(modal.n))
        return core.march(model, state, scheme, STEPS, start=True)[0][:, 0]

    motion, seconds = best(run, 20 * REPEATS)
    return Outcome(f"{modal.n} coordinates", motion, float(eq.displacement("shaft.disc")[1]), seconds)


def by_ross() -> Outcome:
    """ROSS: its own elements; the balls through add_to_RHS."""
    import ross

    # ROSS 2.3 has (1 + nu) where Hutchinson's coefficient has its square; its other choice, Cowper's, is
    # k G = 3 E / (7 + 6 nu), and this nu gives it the k G of the other two programs
    kG = bd.Section(LENGTH, DIAMETER).shear_coefficient(bd.STEEL.nu) * bd.STEEL.G
    nu = (3.0 * bd.STEEL.E / kG - 7.0) / 6.0
    steel = ross.Material(name="steel", rho=bd.STEEL.density, E=bd.STEEL.E, Poisson=nu)
    shaft = [
        ross.ShaftElement(
            L=LENGTH / ELEMENTS, idl=0.0, odl=DIAMETER, material=steel, shear_method_calc="cowper"
        )
        for _ in range(ELEMENTS)
    ]
    disc = ross.DiskElement(n=MIDDLE, m=DISC[0], Id=DISC[1], Ip=DISC[2])
    nothing = [ross.BearingElement(n=n, kxx=0.0, cxx=0.0) for n in SEATS]
    rotor = ross.Rotor(shaft, [disc], nothing)
    balls, seats = Balls.of(bearing()), seat_coordinates()
    t = DT * np.arange(STEPS + 1)
    F = np.tile(loads(), (len(t), 1))

    def contacts(step: int, **state: Any) -> np.ndarray:
        f = np.zeros(rotor.ndof)
        f[seats] = balls.force(state["disp_resp"][seats], state["velc_resp"][seats], t[step], SPEED)
        return f

    def run() -> np.ndarray:
        response = rotor.run_time_response(SPEED, F, t, method="newmark", add_to_RHS=contacts)
        return np.asarray(response.yout)[1:, 6 * MIDDLE + 1]

    run()  # compiles
    motion, seconds = best(run, REPEATS)
    return Outcome(ross.__version__, motion, static_deflection(np.asarray(rotor.K(0.0)), balls), seconds)


def by_exudyn() -> Outcome:
    """EXUDYN: the element matrices as one object, the balls as its user function."""
    import exudyn as exu
    import exudyn.itemInterface as eii

    z = np.linspace(0.0, LENGTH, ELEMENTS + 1)
    M, G, K = (A.toarray() for A in assemble_beam(z, [bd.Section(LENGTH, DIAMETER)] * ELEMENTS, bd.STEEL))
    at = 6 * MIDDLE + np.arange(6)
    mass, Id, Ip = DISC
    M[at, at] += [mass, mass, mass, Id, Id, Ip]
    G[at[3], at[4]] += Ip
    G[at[4], at[3]] -= Ip
    balls, seats, damping = Balls.of(bearing()), seat_coordinates(), SPEED * G
    n = len(M)

    def build(turning: float) -> tuple[Any, Any, Any]:
        stiffness = K + (np.diag(spin_spring(K)) if turning == 0.0 else 0.0)

        def force(_mbs: Any, t: float, _item: int, q: Any, v: Any) -> np.ndarray:
            f = np.zeros(n)
            f[seats] = balls.force(np.array(q)[seats], np.array(v)[seats], t, turning)
            return f

        def jacobian(_mbs: Any, t: float, _item: int, q: Any, v: Any, in_x: float, in_v: float) -> np.ndarray:
            J = in_x * stiffness + in_v * damping
            elastic, viscous = balls.tangent(np.array(q)[seats], t, turning)
            for b, place in enumerate(seats):
                J[np.ix_(place, place)] += in_x * elastic[b] + in_v * viscous[b]
            return J

        mbs = exu.SystemContainer().AddSystem()
        start = [0.0, 0.0, SEATED if turning == 0.0 else 0.0, 0.0, 0.0, 0.0]
        nodes = [
            mbs.AddNode(
                eii.NodeGenericODE2(
                    referenceCoordinates=[0.0] * 6,
                    initialCoordinates=start,
                    initialCoordinates_t=[0.0] * 6,
                    numberOfODE2Coordinates=6,
                )
            )
            for _ in range(ELEMENTS + 1)
        ]
        mbs.AddObject(
            eii.ObjectGenericODE2(
                nodeNumbers=nodes,
                massMatrix=M,
                stiffnessMatrix=stiffness,
                dampingMatrix=damping,
                forceVector=loads(),
                forceUserFunction=force,
                jacobianUserFunction=jacobian,
            )
        )
        coordinates = exu.OutputVariableType.Coordinates
        sensor = mbs.AddSensor(
            eii.SensorNode(nodeNumber=nodes[MIDDLE], storeInternal=True, outputVariableType=coordinates)
        )
        mbs.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = STEPS
        settings.timeIntegration.endTime = DT * STEPS
        settings.timeIntegration.newton.useModifiedNewton = True
        newton = settings.timeIntegration.newton
        newton.relativeTolerance, newton.absoluteTolerance = 1e-9, 1e-12
        settings.staticSolver.newton.relativeTolerance = 1e-7  # round-off stops it at 4e-8
        settings.solutionSettings.writeSolutionToFile = False
        settings.solutionSettings.sensorsWritePeriod = DT
        settings.linearSolverType = exu.LinearSolverType.EigenDense
        return mbs, settings, sensor

    seconds = math.inf
    for _ in range(REPEATS):
        mbs, settings, sensor = build(SPEED)
        began = time.perf_counter()
        mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
        seconds = min(seconds, time.perf_counter() - began)
    motion = np.asarray(mbs.GetSensorStoredData(sensor))[-STEPS:, 2]

    mbs, settings, sensor = build(0.0)
    mbs.SolveStatic(settings)
    static = float(np.asarray(mbs.GetSensorStoredData(sensor))[-1, 2])
    return Outcome(exu.__version__, motion, static, seconds / STEPS)


PEERS: dict[str, Callable[[], Outcome]] = {"ross": by_ross, "exudyn": by_exudyn}


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Nothing reaches stdout or stderr, from Python or below it."""
    kept = [os.dup(fd) for fd in (1, 2)]
    with open(os.devnull, "w") as nowhere:
        try:
            sys.stdout.flush()
            for fd in (1, 2):
                os.dup2(nowhere.fileno(), fd)
            yield
        finally:
            sys.stdout.flush()
            for fd, before in zip((1, 2), kept, strict=True):
                os.dup2(before, fd)
                os.close(before)


def attempt(program: Callable[[], Outcome]) -> Outcome | str:
    """A peer's outcome, or why there is none."""
    try:
        with silence(), contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return program()
    except (ImportError, ValueError) as error:  # a ValueError comes from ROSS beside too new a plotly
        return f"skipped: {str(error).strip().splitlines()[0]}"


def compare() -> dict[str, Any]:
    """Every program in one run; times in µs a step, the others' over this package's."""
    ours, reduced = by_bearingdyn(1e9), by_bearingdyn(5e3)
    result: dict[str, Any] = {
        "bearingdyn": {"coordinates": ours.version, "us_per_step": round(1e6 * ours.seconds, 3)},
        "bearingdyn_reduced": {
            "coordinates": reduced.version,
            "us_per_step": round(1e6 * reduced.seconds, 3),
            "static_difference": abs(reduced.static / ours.static - 1.0),
        },
        "static_deflection": ours.static,
        "static_tolerance": STATIC_TOLERANCE,
        "agree": True,
    }
    for name, program in PEERS.items():
        there = attempt(program)
        if isinstance(there, str):
            result[name] = there
            continue
        static = abs(there.static / ours.static - 1.0)
        motion = float(np.abs(there.motion - ours.motion).max() / np.ptp(ours.motion))
        result[name] = {
            "version": there.version,
            "us_per_step": round(1e6 * there.seconds, 2),
            "ratio": round(there.seconds / ours.seconds, 1),
            "ratio_to_reduced": round(there.seconds / reduced.seconds, 1),
            "static_difference": static,
            "motion_difference": motion,
            "motion_tolerance": MOTION_TOLERANCE[name],
        }
        if not (static <= STATIC_TOLERANCE and motion <= MOTION_TOLERANCE[name]):
            result["agree"] = False
    return result


def main() -> int:
    """Compare and print; 1 where the programs disagree."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    result = compare()
    print(json.dumps(result) if options.json else "\n".join(f"{k:>20}: {v}" for k, v in result.items()))
    return 0 if result["agree"] else 1


if __name__ == "__main__":
    sys.exit(main())
