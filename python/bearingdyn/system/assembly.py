"""An application's parts, joints, bearings and loads as one system."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from bearingdyn.application import GRAVITY, GROUND, Application, HungFit
from bearingdyn.bearing.raceway_series import RIGID
from bearingdyn.system.arrays import BearingTerm, LayerTerm, LoadTerm, PartTerm, SpringTerm, System, factor
from bearingdyn.system.held import check_held
from bearingdyn.system.origin import noted
from bearingdyn.types import Array, Index


def assemble(app: Application) -> System:
    """An application as arrays.

    Raises ValueError for an interface left loose, a body that nothing holds (named, with its direction), a
    dead load on a layer without relaxed modulus, gravity or base motion on a part that holds itself.
    """
    app.check_joints()
    index, n = _coordinates(app)
    if n == 0:
        raise ValueError("everything is grounded rigidly; nothing is left to move")

    select = {}  # part coordinates = select @ system coordinates
    for part, place in index.items():
        select[part] = np.zeros((place.size, n))
        moving = np.flatnonzero(place >= 0)
        select[part][moving, place[moving]] = 1.0

    M, C, K, G, N, firm = (np.zeros((n, n)) for _ in range(6))
    inertia = np.zeros((n, 3))
    layers: list[LayerTerm] = []
    terms: list[PartTerm] = []
    outputs: dict[str, Array] = {}
    for part, element in app.parts.items():
        own = (element.M, element.C, element.K, element.G, element.N)
        for total, A in zip((M, C, K, G, N), own, strict=True):
            total += select[part].T @ np.asarray(A) @ select[part]
        R = app.rigid_shapes(part)
        rigid = np.full((element.n, 6), np.nan) if R is None else R
        inertia += select[part].T @ (element.M @ rigid[:, :3])
        terms.append(PartTerm(part, element, select[part], rigid, app.sources[part]))
        for term in element.viscoelastic:
            layers.append(LayerTerm(part, term.material, select[part].T @ factor(term.H)))
        relaxed = [getattr(term.material, "G0", 0.0) for term in element.viscoelastic]
        if all(relaxed):
            deviatoric = (2.0 * G0 * t.H for G0, t in zip(relaxed, element.viscoelastic, strict=True))
            firm += select[part].T @ sum(deviatoric, np.asarray(element.K)) @ select[part]
        for name in (*element.interfaces, *element.outputs):
            outputs[f"{part}.{name}"] = element.rows(name) @ select[part]

    loads = _loads(app, outputs, inertia)
    springs: list[SpringTerm] = []
    for spring, offset in _springs(app, outputs):
        springs.append(spring)
        if offset.any():
            pressed = (spring.stiffness * offset) @ spring.across
            loads += (LoadTerm("constant", 0.0, pressed, np.zeros(n), np.zeros(0), np.zeros(0)),)

    bearings = []
    for hung in app.bearings.values():
        raceway = app.raceway(hung.outer)
        series = RIGID if raceway is None else raceway.series
        ends = {hung.inner: hung.bearing.coefficients(series)}
        if raceway is None and hung.outer != GROUND:
            ends[hung.outer] = -hung.bearing.coefficients()
        B = _between(ends, outputs)
        if raceway is not None:
            B = B - raceway.rows @ select[hung.outer.partition(".")[0]]
        bearings.append(BearingTerm(hung.name, hung.bearing, B, series, hung.offset, ends))

    for seat in app.fits.values():
        contacts, hold = _loose(app, seat, select, outputs)
        bearings.append(contacts)
        springs.append(hold)

    for spring in springs:
        for total in (K, firm):
            total += spring.across.T @ (spring.stiffness[:, None] * spring.across)
        C += spring.across.T @ (spring.damping[:, None] * spring.across)

    turning = {name: app.parts[name] for name in app.parts if name in app.turning_parts()}
    standstill = tuple(
        name for name, e in turning.items() if e.viscoelastic or (np.any(e.C) and not np.any(e.N))
    )
    system = System(
        M,
        C,
        K,
        G,
        N,
        tuple(layers),
        tuple(bearings),
        loads,
        outputs,
        standstill,
        inertia,
        tuple(terms),
        tuple(springs),
        _held(app),
        tuple(turning),
        app.positions(),
    )
    check_held(system, firm)
    return noted(system, app)


def _between(ends: Mapping[str, Array], outputs: Mapping[str, Array]) -> Array:
    """Relative motion (k, n) of interfaces, by the rows (k, 6) of each."""
    return np.asarray(sum(rows @ outputs[name] for name, rows in ends.items()))


def _loose(
    app: Application, seat: HungFit, select: Mapping[str, Array], outputs: Mapping[str, Array]
) -> tuple[BearingTerm, SpringTerm]:
    """A loose fit as contacts on the radial coefficients, ring less bore, and the springs of its hold."""
    raceway = app.raceway(seat.ring)
    assert raceway is not None  # the application checked
    relative = raceway.rows @ select[seat.ring.partition(".")[0]]
    bore = {} if seat.bore == GROUND else {seat.bore: -raceway.series.rigid(raceway.arm)}
    relative = relative + _between(bore, outputs)
    radial, series, held = seat.fit.split(raceway.series)
    seat.fit.kernel(series)  # too few stations are refused here
    hold = SpringTerm(
        f"{seat.name} (hold)",
        relative[held],
        np.full(len(held), seat.fit.hold),
        np.zeros(len(held)),
        {name: rows[held] for name, rows in bore.items()},
    )
    ends = {name: rows[radial] for name, rows in bore.items()}
    return BearingTerm(seat.name, seat.fit, relative[radial], series, ends=ends), hold


def _partners(app: Application) -> dict[str, str]:
    """Which interface each connected one moves with."""
    return {c.a: c.b for c in app.connections} | {c.b: c.a for c in app.connections}


def _held(app: Application) -> tuple[tuple[str, ...], ...]:
    """Joints that the ground holds rigidly."""
    partner = _partners(app)
    return tuple(
        (name, partner[name]) if name in partner else (name,)
        for name in (s.interface for s in app.supports.values() if s.rigid)
    )


def _coordinates(app: Application) -> tuple[dict[str, Index], int]:
    """Global index of every part's coordinates (-1: held by the ground), and how many there are."""
    local = {name: np.full(element.n, -2, dtype=np.intp) for name, element in app.parts.items()}

    def places(interface: str) -> tuple[str, Index]:
        part, _, name = interface.partition(".")
        return part, app.parts[part].interfaces[name]

    partner = _partners(app)
    for interface in (name for joint in _held(app) for name in joint):
        part, index = places(interface)
        local[part][index] = -1
    count = 0
    for part, element in app.parts.items():
        for name, index in element.interfaces.items():
            other = partner.get(f"{part}.{name}")
            if local[part][index[0]] == -2 and other is not None:
                other_part, other_index = places(other)
                if local[other_part][other_index[0]] >= 0:
                    local[part][index] = local[other_part][other_index]
        for i in range(element.n):
            if local[part][i] == -2:
                local[part][i] = count
                count += 1
    return local, count


def _springs(app: Application, outputs: Mapping[str, Array]) -> Iterator[tuple[SpringTerm, Array]]:
    """Springs to the ground and between interfaces, and the offset (6,) where each is free of force."""
    zero, one = np.zeros(6), np.eye(6)
    for s in app.supports.values():
        if not s.rigid:
            k, c, offset = (zero if v is None else v for v in (s.stiffness, s.damping, s.offset))
            name = f"{s.interface}–{GROUND}"
            yield SpringTerm(name, outputs[s.interface], k, c, {s.interface: one}), offset
    for b in app.springs:
        ends = {b.a: one} if b.b == GROUND else {b.a: one, b.b: -one}
        yield SpringTerm(f"{b.a}–{b.b}", _between(ends, outputs), b.stiffness, b.damping, ends), b.offset


def _loads(app: Application, outputs: Mapping[str, Array], inertia: Array) -> tuple[LoadTerm, ...]:
    terms = []
    nothing = np.zeros(0)
    for load in app.loads:
        if load.where in (GROUND, GRAVITY):
            held = [part for part in app.parts if app.rigid_shapes(part) is None]
            if held:
                raise ValueError(
                    f"part {held[0]!r} has no rigid motion of its own (no interface, or a stiffness that "
                    f"holds it); gravity and base motion need parts that are free by themselves"
                )
            # a falling frame: parts in gravity g feel what they feel when the ground moves with −g
            rows, force = inertia.T, inertia @ (load.vector if load.where == GRAVITY else -load.vector)
        else:
            rows = outputs[load.where]
            force = load.vector[: rows.shape[0]] @ rows
        zero = np.zeros_like(force)
        c, s = math.cos(load.phase), math.sin(load.phase)
        if load.kind == "harmonic":
            terms.append(LoadTerm("harmonic", load.omega, c * force, -s * force, nothing, nothing))
        elif load.kind == "rotating":
            # u (cos(θ + φ), sin(θ + φ)) = cos θ · u (c, s) + sin θ · u (−s, c)
            turn = load.unbalance * np.array([[c, s], [-s, c]])
            along, across = turn @ rows[:2]
            part, _, place = load.where.partition(".")
            own = turn @ app.parts[part].rows(place)[:2]
            terms.append(LoadTerm("rotating", 0.0, along, across, nothing, nothing, part, *own))
        elif load.kind == "sampled":
            assert load.time is not None
            assert load.value is not None
            terms.append(LoadTerm("sampled", 0.0, force, zero, load.time, load.value))
        else:
            terms.append(LoadTerm("constant", 0.0, force, zero, nothing, nothing))
    return tuple(terms)
