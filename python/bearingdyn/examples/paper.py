"""The two machines of the notebooks: the motor of the paper's section 4, and a bench for bearing faults."""

from __future__ import annotations

import functools
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing, Pit, WavinessSpectrum, catalogue
from bearingdyn.checks import instance, items, nonnegative, require
from bearingdyn.cms import Superelement, kept_superelement
from bearingdyn.parts import Disc, Housing, Layer, RigidBody, Section, Shaft

# groove radius taken off, outside radius, width of the outer ring, m; for the 6305 of the inner ring too
OUTER_6305, INNER_6305, OUTER_6205 = (0.0275, 0.031, 0.017), (0.0125, 0.0165, 0.017), (0.0228, 0.026, 0.015)
LEFT_SEAT = 0.0185  # m, of the motor's left bearing from the shaft's end
PRELOAD = 180.0  # N, along the motor's axis
CONTACT_DAMPING = 30.0  # N s/m for each ball, the paper's
NO_LAYER = "it must be a bd.Layer around the outer ring, or None"


def paper_motor(
    layer: Layer | None = None,
    radial: float = 0.0,
    *,
    bearings: Sequence[BallBearing] | None = None,
    sleeve: float = 0.0,
    cache: str | os.PathLike[str] | None = None,
) -> Application:
    """The motor of the paper, section 4: a flexible shaft in two 6305 bearings, each in a flexible pedestal.

    The paper does not publish its geometry. This one bears 5 kN a bearing, and its bending modes without
    layers lie near the paper's 382, 1885, 2027 and 4756 Hz.

    Parameters
    ----------
    layer
        Around each outer ring, of r_inner 31 mm unless on a sleeve; None: the rings sit in the bores.
    radial
        Load at mid-shaft, downwards, N, beside 180 N along the axis.
    bearings
        Left and right, as with waviness; None: the 6305 of ISO/TS 16281, of seven balls, without.
    sleeve
        Outside radius, m, of a steel sleeve between each outer ring and its layer; 0: none.
    cache
        Folder in which the reduced pedestals are kept, as in `Application.add`; None: they are reduced here.

    Returns
    -------
    Application
        Places "shaft.middle", "shaft.end" and, of each side, "left_housing.top"; bearings "left", "right".

    Examples
    --------
    >>> import bearingdyn as bd
    >>> state = bd.equilibrium(bd.examples.paper_motor(radial=10e3))
    >>> print(f"{state.displacement('shaft.middle')[1] * 1e6:.0f} µm")
    -386 µm
    """
    instance("layer", layer, (Layer, type(None)), NO_LAYER)
    nonnegative("sleeve", sleeve, "it must be an outside radius beyond the ring's 0.031 m, or zero")
    plain = plain_6305()
    remedy = "it must be two of bd.BallBearing, left and right, or None"
    pair = items("bearings", (plain, plain) if bearings is None else bearings, remedy)
    good = len(pair) == 2 and all(isinstance(one, BallBearing) for one in pair)
    require(good, "bearings", bearings, remedy)
    app = Application()
    app.add("shaft", paper_shaft())
    app.free("shaft.middle")
    bore = OUTER_6305[1] if layer is None else layer.r_outer
    for side, ball in zip(("left", "right"), pair, strict=True):
        ring, house = f"{side}_ring", f"{side}_housing"
        app.add(f"{side}_inner", RigidBody.ring(*INNER_6305, rotating=True))
        app.add(ring, _outer_ring(sleeve))
        app.add(house, reduced_pedestal(2 * bore, None if cache is None else os.fspath(cache)))
        app.connect(f"shaft.{side}", f"{side}_inner.centre")
        app.ground(f"{house}.feet")
        if layer is None:
            app.connect(f"{ring}.centre", f"{house}.bore")
        else:
            app.add(f"{side}_layer", layer)
            # it may be wider than the bearing: a rigid sleeve carries what the ring leaves over
            app.connect(f"{ring}.centre", f"{side}_layer.inner", fits=False)
            app.connect(f"{side}_layer.outer", f"{house}.bore")
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{ring}.centre")
    app.load("shaft.middle", (0.0, 0.0, PRELOAD, 0.0, 0.0, 0.0))
    if radial:
        app.load("shaft.middle", (0.0, -radial, 0.0, 0.0, 0.0, 0.0))
    return app


def _outer_ring(sleeve: float) -> RigidBody:
    ring = RigidBody.ring(*OUTER_6305)
    if not sleeve:
        return ring
    around = RigidBody.ring(OUTER_6305[1], sleeve, OUTER_6305[2])
    across, _, about = (a + b for a, b in zip(ring.inertia, around.inertia, strict=True))
    return RigidBody(ring.mass + around.mass, (across, across, about), measures=OUTER_6305)


def plain_6305() -> BallBearing:
    """The bearing of the paper's motor: the 6305 of ISO/TS 16281, of 7 balls of 11.5 mm, on smooth races."""
    return catalogue.bearing("6305", balls=7, clearance=10e-6, damping=CONTACT_DAMPING)


@functools.cache
def paper_shaft() -> Shaft:
    """The stepped shaft of the paper's motor: seats "left" and "right", "middle" for the load, a free end."""
    sections = [
        Section(0.027, 0.025),
        Section(0.0274, 0.0437),
        Section(0.286, 0.0508),
        Section(0.1567, 0.0437),
        Section(0.017, 0.025),
        Section(0.064, 0.0122),
    ]
    ends = np.cumsum([s.length for s in sections])
    # where its shape is looked at: the steps, and between them
    seen = np.unique(np.concatenate([[0.0], ends[:5], np.linspace(0.08, 0.48, 9), [0.545]]))
    return Shaft(
        sections,
        seats={"left": LEFT_SEAT, "right": float(ends[4] - 0.0085), "middle": float(ends[1] + 0.143)},
        points={"end": float(ends[5])} | {f"p{k}": float(z) for k, z in enumerate(seen)},
        damping=0.005,
        f_max=15e3,
    )


def paper_pedestal(bore_diameter: float) -> Housing:
    """A pedestal of the paper's motor: a plate of steel on a rigid base, with a bore of this diameter, m."""
    return Housing(
        width=0.16,
        height=0.20,
        length=0.030,
        bore_diameter=bore_diameter,
        bore_height=0.12,
        damping=0.01,
        f_max=10e3,  # within 0.4 % of the unreduced pedestal to 5 kHz, as bd.reduction_error says
    )


@functools.cache
def reduced_pedestal(bore_diameter: float, cache: str | None = None) -> Superelement:
    """Reduced once for each bore: designs of equal thickness share it, and so do both sides."""
    whole = paper_pedestal(bore_diameter)
    return whole.superelement() if cache is None else kept_superelement(whole, Path(cache))


def fault_bench(layer: Layer | None = None, defects: Sequence[Pit] = ()) -> Application:
    """The paper's section 5 as a bench for faults: a shaft in two wavy 6205 bearings, the left one damaged.

    The bearing is the drive end bearing of the public Case Western Reserve University measurements.

    Parameters
    ----------
    layer
        Around each outer ring, of r_inner 26 mm; None: the rings sit in the bores.
    defects
        Of the left bearing, as `bearing.spall` gives them.

    Returns
    -------
    Application
        Loads: 300 N downwards and 100 N along the axis at mid-shaft, and an unbalance of 2 g mm. A sensor
        may stand on "left_housing.top".
    """
    instance("layer", layer, (Layer, type(None)), NO_LAYER)
    pits = items("defects", defects, "it must be a list of bd.Pit, as bearing.spall gives them")
    app = Application()
    app.add("shaft", _bench_shaft())
    outside = OUTER_6205[1] if layer is None else layer.r_outer
    waves = WavinessSpectrum(60e-9, exponent=1.5, order=2, scatter="rayleigh")
    for side, seed in (("left", 0), ("right", 10)):
        app.add(f"{side}_ring", RigidBody.ring(*OUTER_6205))
        app.add(f"{side}_housing", _bench_pedestal(outside))
        app.ground(f"{side}_housing.feet")
        if layer is None:
            app.connect(f"{side}_ring.centre", f"{side}_housing.bore")
        else:
            app.add(f"{side}_layer", layer)
            app.connect(f"{side}_ring.centre", f"{side}_layer.inner")
            app.connect(f"{side}_layer.outer", f"{side}_housing.bore")
        waviness = (
            *waves.draw("inner", range(2, 41), seed),
            *waves.draw("outer", range(2, 41), seed + 1),
            *waves.draw("ball", range(2, 17, 2), seed + 2, Z=9),
        )
        damage = tuple(pits) if side == "left" else ()
        ball = catalogue.bearing("6205", clearance=8e-6, damping=30.0, waviness=waviness, defects=damage)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{side}_ring.centre")
    app.load("shaft.middle", (0, -300.0, 100.0, 0, 0, 0))
    app.unbalance("shaft.middle", 2e-6)
    return app


@functools.cache
def _bench_shaft() -> Superelement:
    rotor = Disc.cylinder(0.15, 0.12, 0.03, d_inner=0.03)
    seats = {"left": 0.02, "right": 0.28}
    # the inner rings, 15 mm wide on Ø25, stand against the shoulders
    sections = [Section(0.0275, 0.025), Section(0.245, 0.03), Section(0.0275, 0.025)]
    whole = Shaft(sections, seats, {"middle": 0.15}, discs=[rotor], damping=0.005, f_max=12e3)
    return whole.superelement()


@functools.cache
def _bench_pedestal(outside: float) -> Superelement:
    block = Housing(0.12, 0.14, 0.025, bore_diameter=2 * outside, bore_height=0.08, damping=0.01, f_max=12e3)
    return block.superelement()
