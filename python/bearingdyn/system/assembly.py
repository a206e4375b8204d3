"""An application's parts, joints, bearings and loads as one system."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from bearingdyn.application import GRAVITY, GROUND, Application, Load, LooseJoint, Place, Plan
from bearingdyn.bearing import RIGID
from bearingdyn.system.held import check_held
from bearingdyn.system.origin import noted
from bearingdyn.system.softening_layer import softening_factor
from bearingdyn.system.system import System
from bearingdyn.system.terms import BearingTerm, LayerTerm, LoadTerm, PartTerm, SpringTerm
from bearingdyn.system.unbalance_check import check_unbalance
from bearingdyn.types import Array, Index


def assemble(app: Application) -> System:
    """Assemble the system of an application: its arrays.

    Parameters
    ----------
    app
        The application; its parts are reduced here.

    Returns
    -------
    System

    Raises
    ------
    ValueError
        For an interface left loose, a body that nothing holds (named, with its direction), a constant load
        on a layer without relaxed modulus, or gravity or base motion on a part that holds itself.
    """
    plan = app.plan
    plan.check_joints()
    index, n = _coordinates(plan)
    if n == 0:
        raise ValueError("everything is grounded rigidly; nothing is left to move")

    select = {}  # part coordinates = select @ system coordinates
    for part, place in index.items():
        select[part] = np.zeros((place.size, n))
        moving = np.flatnonzero(place >= 0)
        select[part][moving, place[moving]] = 1.0

    M, C, G, K, N, firm = (np.zeros((n, n)) for _ in range(6))
    inertia = np.zeros((n, 3))
    layers: list[LayerTerm] = []
    terms: list[PartTerm] = []
    outputs: dict[str, Array] = {}
    for part, element in plan.parts.items():
        add, own = _placing(index[part]), (element.M, element.C, element.G, element.K, element.N)
        for total, A in zip((M, C, G, K, N), own, strict=True):
            add(total, np.asarray(A))
        R = plan.rigid_shapes(part)
        rigid = np.full((element.n, 6), np.nan) if R is None else R
        inertia += select[part].T @ (element.M @ rigid[:, :3])
        terms.append(PartTerm(part, element, select[part], rigid, plan.sources[part]))
        for term in element.viscoelastic:
            L, strain = softening_factor(term, part)
            layers.append(LayerTerm(part, term.material, select[part].T @ L, strain))
        relaxed = [getattr(term.material, "G0", 0.0) for term in element.viscoelastic]
        if all(relaxed):
            deviatoric = (2.0 * G0 * t.H for G0, t in zip(relaxed, element.viscoelastic, strict=True))
            add(firm, sum(deviatoric, np.asarray(element.K)))
        for name in (*element.interfaces, *element.outputs):
            outputs[str(Place(part, name))] = element.rows(name) @ select[part]

    check_unbalance(plan)
    loads = [_load(plan, load, outputs, inertia) for load in plan.loads]
    springs: list[SpringTerm] = []
    for spring, offset in _springs(plan, outputs):
        springs.append(spring)
        if offset.any():
            pressed = (spring.stiffness * offset) @ spring.across
            loads.append(LoadTerm("constant", 0.0, pressed, np.zeros(n), np.zeros(0), np.zeros(0)))

    bearings = []
    for hung in plan.bearings.values():
        sides = ((hung.inner, 1.0), (hung.outer, -1.0))
        races = [(place, sign, plan.raceway(place)) for place, sign in sides]
        flexible = [(place, sign, race) for place, sign, race in races if race is not None]
        series = flexible[0][2].series if flexible else RIGID
        ends = {
            str(end): sign * hung.coefficients(series)
            for end, sign, race in races
            if race is None and end != GROUND
        }
        B = _between(ends, outputs) if ends else np.zeros((len(series), n))
        for end, sign, race in flexible:
            B = B + sign * race.rows @ select[end.part]
        speeds = plan.ring_speeds(hung)
        known = hung.bearing.ring_speeds == speeds
        bearing = hung.bearing if known else replace(hung.bearing, turning=speeds)
        give = sum(race.give for _, _, race in flexible)
        bearings.append(BearingTerm(hung.name, bearing, B, series, hung.offset, ends, give))

    for seat in plan.fits.values():
        contacts, hold = _loose(plan, seat, select, outputs)
        bearings.append(contacts)
        springs.append(hold)

    for spring in springs:
        for total in (K, firm):
            total += spring.across.T @ (spring.stiffness[:, None] * spring.across)
        C += spring.across.T @ (spring.damping[:, None] * spring.across)

    turning = {name: plan.parts[name] for name in plan.parts if name in plan.turning_parts()}
    standstill = tuple(
        name for name, e in turning.items() if e.viscoelastic or (np.any(e.C) and not np.any(e.N))
    )
    system = System(
        M=M,
        C=C,
        G=G,
        K=K,
        N=N,
        layers=tuple(layers),
        bearings=tuple(bearings),
        loads=tuple(loads),
        outputs=outputs,
        standstill=standstill,
        inertia=inertia,
        parts=tuple(terms),
        springs=tuple(springs),
        held=tuple(tuple(map(str, joint)) for joint in _held(plan)),
        turning=tuple(turning),
        positions=plan.positions(),
    )
    check_held(system, firm)
    return noted(system, app)


def _placing(place: Index) -> Callable[[Array, Array], None]:
    """What adds a part's matrix to the system's at its coordinates' places; the ground holds those of -1."""
    moving = np.flatnonzero(place >= 0)
    inside, own = np.ix_(place[moving], place[moving]), np.ix_(moving, moving)
    alone = np.unique(place[moving]).size == moving.size

    def add(total: Array, A: Array) -> None:
        if not A.any():
            return
        if alone:
            total[inside] += A[own]
        else:  # two interfaces of a part that are joined to each other share their places
            np.add.at(total, inside, A[own])

    return add


def _between(ends: Mapping[str, Array], outputs: Mapping[str, Array]) -> Array:
    """Relative motion (k, n) of interfaces, by the rows (k, 6) of each."""
    return np.asarray(sum(rows @ outputs[name] for name, rows in ends.items()))


def _loose(
    plan: Plan, seat: LooseJoint, select: Mapping[str, Array], outputs: Mapping[str, Array]
) -> tuple[BearingTerm, SpringTerm]:
    """A loose fit as contacts on the radial coefficients, and the springs of its hold.

    Motions are those of what lies within less those of what lies around.
    """
    raceway, around = plan.raceway(seat.ring), plan.raceway(seat.bore)
    assert raceway is not None  # the application checked
    # the ring lies in the bore, or with a bore of its own around a shaft
    sign = -1.0 if any(face.kind == "bore" for face in plan.faces(seat.ring)) else 1.0
    relative = sign * raceway.rows @ select[seat.ring.part]
    ends = {}
    if around is not None:
        relative = relative - sign * around.rows @ select[seat.bore.part]
    elif seat.bore != GROUND:
        ends = {str(seat.bore): -sign * raceway.series.rigid(raceway.arm)}
        relative = relative + _between(ends, outputs)
    radial, series, held = seat.fit.split(raceway.series)
    seat.fit.kernel(series)  # too few stations are refused here
    hold = SpringTerm(
        f"{seat.name} (hold)",
        relative[held],
        np.full(len(held), seat.fit.hold),
        np.zeros(len(held)),
        {name: rows[held] for name, rows in ends.items()},
    )
    ends = {name: rows[radial] for name, rows in ends.items()}
    return BearingTerm(seat.name, seat.fit, relative[radial], series, ends=ends), hold


def _held(plan: Plan) -> list[tuple[Place, ...]]:
    """Joints that the ground holds rigidly."""
    partner = plan.partners()
    return [
        (place, partner[place]) if place in partner else (place,)
        for place in (s.interface for s in plan.supports.values() if s.rigid)
    ]


def _coordinates(plan: Plan) -> tuple[dict[str, Index], int]:
    """Global index of every part's coordinates (-1: held by the ground), and how many there are."""
    local = {name: np.full(element.n, -2, dtype=np.intp) for name, element in plan.parts.items()}

    def own(place: Place) -> Index:
        return plan.parts[place.part].interfaces[place.name]

    partner = plan.partners()
    for place in (place for joint in _held(plan) for place in joint):
        local[place.part][own(place)] = -1
    count = 0
    for part, element in plan.parts.items():
        for name, index in element.interfaces.items():
            other = partner.get(Place(part, name))
            if local[part][index[0]] == -2 and other is not None:
                known = local[other.part][own(other)]
                if known[0] >= 0:
                    local[part][index] = known
        for i in range(element.n):
            if local[part][i] == -2:
                local[part][i] = count
                count += 1
    return local, count


def _springs(plan: Plan, outputs: Mapping[str, Array]) -> Iterator[tuple[SpringTerm, Array]]:
    """Springs to the ground and between interfaces, and the offset (6,) where each is free of force."""
    zero, one = np.zeros(6), np.eye(6)
    for s in plan.supports.values():
        if not s.rigid:
            k, c, offset = (zero if v is None else v for v in (s.stiffness, s.damping, s.offset))
            at = str(s.interface)
            yield SpringTerm(f"{at}–{GROUND}", outputs[at], k, c, {at: one}), offset
    for b in plan.springs:
        ends = {str(b.a): one} if b.b == GROUND else {str(b.a): one, str(b.b): -one}
        yield SpringTerm(f"{b.a}–{b.b}", _between(ends, outputs), b.stiffness, b.damping, ends), b.offset


def _load(plan: Plan, load: Load, outputs: Mapping[str, Array], inertia: Array) -> LoadTerm:
    """One load on the system, and on the part it acts on; inertia (n, 3) as in `System`."""
    if load.where not in (GROUND, GRAVITY):
        # on the part itself, for the forces that it passes on
        own = load.core(plan.rows(load.where))
        term = LoadTerm(**load.core(outputs[str(load.where)]), part=load.where.part)
        return replace(term, own_cos=own["p_cos"], own_sin=own["p_sin"])
    held = [part for part in plan.parts if plan.rigid_shapes(part) is None]
    if held:
        raise ValueError(
            f"part {held[0]!r} has no rigid motion of its own (no interface, or a stiffness that holds it); "
            f"gravity and base motion need parts that are free by themselves"
        )
    # a falling frame: parts in gravity g feel what they feel when the ground moves with −g
    return LoadTerm(**load.core(inertia.T if load.where == GRAVITY else -inertia.T))
