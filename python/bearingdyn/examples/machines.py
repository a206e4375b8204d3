"""The ready machines: a motor, a fan, a spindle and a pump, with the dimensions that such machines have."""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from pathlib import Path

from bearingdyn.application import Application
from bearingdyn.bearing import catalogue
from bearingdyn.checks import one_of
from bearingdyn.material import Maxwell
from bearingdyn.parts import Disc, Housing, Layer, RigidBody, Section, Shaft
from bearingdyn.units import rpm

NAMES = ("motor", "fan", "spindle", "pump")


@cache
def rubber() -> Maxwell:
    """Rubber of the example machines' layers: a Maxwell model of the shipped DMA table at 20 °C.

    The table was made from a stated model and is no measurement. The fit, kept as a file beside this module,
    is `fit_maxwell(curve, n=5, band=(10.0, 5e3), pin=60.0, K=2e9, density=1150.0)`: pinned to the modulus
    that the curve has after a minute, which is the layers' at rest.
    """
    kept = files("bearingdyn.examples") / "rubber.json"
    return Maxwell.from_json(kept.read_text(encoding="utf-8"))


def motor(layers: bool = True, material: Maxwell | None = None) -> Application:
    """Example machine, an electric motor: a shaft in two 6203 bearings in pedestals, with a layer or none.

    Parameters
    ----------
    layers
        Whether 4 mm of rubber lie around each bearing.
    material
        Of the layers; None: `rubber()`.

    Returns
    -------
    Application
        Loads: 1 kN downwards and 100 N along the axis at mid-shaft, and an unbalance of 2 g mm.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> state = bd.equilibrium(bd.examples.motor(layers=False))
    >>> print(f"{state.displacement('shaft.middle')[1] * 1e6:.0f} µm")
    -30 µm
    """
    app = Application()
    app.add(
        "shaft",
        Shaft(
            [Section(0.02, 0.017), Section(0.16, 0.030), Section(0.02, 0.017)],
            seats={"left": 0.01, "middle": 0.10, "right": 0.19},
            damping=0.005,
            f_max=10e3,
        ),
    )
    app.free("shaft.middle")
    # the outer ring of the 6203 as a plain ring: radii and width, m, 2 mm wider than the bearing; the layer
    # outside of it
    ring, thickness, width = (0.0170, 0.0200, 0.014), 0.004, 0.014
    bore = ring[1] + (thickness if layers else 0.0)
    for side in ("left", "right"):
        name, house = f"{side}_ring", f"{side}_housing"
        app.add(name, RigidBody.ring(*ring))
        app.add(house, Housing(0.09, 0.12, 0.02, 2 * bore, 0.07, damping=0.01, f_max=10e3, element_size=0.02))
        app.ground(f"{house}.feet")
        if layers:
            app.add(f"{side}_layer", Layer(ring[1], bore, width, material or rubber()))
            app.connect(f"{name}.centre", f"{side}_layer.inner")
            app.connect(f"{side}_layer.outer", f"{house}.bore")
        else:
            app.connect(f"{name}.centre", f"{house}.bore")
        ball = catalogue.bearing("6203", clearance=8e-6, damping=30.0)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{name}.centre")
    app.load("shaft.middle", (0.0, -1000.0, 100.0, 0.0, 0.0, 0.0))
    app.unbalance("shaft.middle", 2e-6)
    return app


def fan() -> Application:
    """Example machine, a fan: an overhung wheel on two 6205 bearings, whose pedestals stand on rubber feet.

    Returns
    -------
    Application
        Loads: weight, 60 N of thrust, and the unbalance of balancing grade G 6.3 at 1500 rpm (ISO 21940).
    """
    wheel = Disc.cylinder(0.32, d_outer=0.40, width=0.012, d_inner=0.025)
    app = Application()
    app.add(
        "shaft",
        Shaft(
            [Section(0.03, 0.025), Section(0.20, 0.035), Section(0.11, 0.025)],
            seats={"left": 0.015, "right": 0.2425},
            points={"wheel": 0.32, "middle": 0.13},
            discs=[wheel],
            damping=0.005,
            f_max=5e3,
        ),
    )
    for side in ("left", "right"):
        app.add(f"{side}_block", RigidBody.ring(0.026, 0.045, 0.030))
        app.ground(
            f"{side}_block.centre",
            stiffness=(2.0e6, 3.0e6, 1.5e6, 2.0e3, 2.0e3, 2.0e3),
            damping=(200.0, 300.0, 150.0, 1.0, 1.0, 1.0),
        )
        ball = catalogue.bearing("6205", clearance=10e-6, damping=40.0)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{side}_block.centre", fits=False)
    app.gravity((0.0, -9.81, 0.0))
    app.load("shaft.wheel", (0.0, 0.0, 60.0, 0.0, 0.0, 0.0))
    # G 6.3: eccentricity times speed is 6.3 mm/s
    app.unbalance("shaft.wheel", wheel.mass * 6.3e-3 / (1500.0 * rpm))
    return app


def spindle() -> Application:
    """Example machine, a grinding spindle: two bearings 7206C, back to back and preloaded by a spacer.

    Returns
    -------
    Application
        Loads: a cutting force of 200 N at the nose, and an unbalance of 0.2 g mm. The spacer draws the rear
        bearing 12 µm along the shaft.
    """
    app = Application()
    app.add(
        "shaft",
        Shaft(
            [Section(0.05, 0.030), Section(0.20, 0.040, 0.012), Section(0.05, 0.030), Section(0.06, 0.028)],
            seats={"rear": 0.042, "front": 0.258},
            points={"nose": 0.36},
            damping=0.005,
            f_max=10e3,
        ),
    )
    ball = catalogue.bearing("7206C", damping=60.0)
    # load on the inner ring towards +z is borne by the rear bearing, towards −z by the front one
    app.bearing("rear", ball, inner="shaft.rear", outer="ground", offset=12e-6)
    app.bearing("front", ball.mirrored(), inner="shaft.front", outer="ground")
    app.load("shaft.nose", (0.0, -200.0, 0.0, 0.0, 0.0, 0.0))
    app.unbalance("shaft.nose", 2e-7)
    return app


def pump() -> Application:
    """Example machine, a pump: an impeller beyond two 6306 bearings, the rear bearing in a layer of rubber.

    Returns
    -------
    Application
        Loads: weight, a hydraulic force of 400 N radially and 800 N towards the bearings, an unbalance of
        20 g mm.
    """
    impeller = Disc.cylinder(0.36, d_outer=0.18, width=0.03, d_inner=0.03)
    app = Application()
    app.add(
        "shaft",
        Shaft(
            [Section(0.04, 0.030), Section(0.20, 0.042), Section(0.13, 0.030)],
            seats={"rear": 0.0305, "front": 0.2495},
            points={"impeller": 0.36},
            discs=[impeller],
            damping=0.005,
            f_max=5e3,
        ),
    )
    # the outer ring of the 6306: groove radius, outside radius, width, m
    ring, thickness = (0.0320, 0.0360, 0.019), 0.006
    for side, layered in (("rear", True), ("front", False)):
        name, house = f"{side}_ring", f"{side}_housing"
        bore = ring[1] + (thickness if layered else 0.0)
        app.add(name, RigidBody.ring(*ring))
        app.add(house, Housing(0.16, 0.19, 0.03, 2 * bore, 0.11, damping=0.01, f_max=5e3, element_size=0.03))
        app.ground(f"{house}.feet")
        if layered:
            app.add(f"{side}_layer", Layer(ring[1], bore, ring[2], rubber()))
            app.connect(f"{name}.centre", f"{side}_layer.inner")
            app.connect(f"{side}_layer.outer", f"{house}.bore")
        else:
            app.connect(f"{name}.centre", f"{house}.bore")
        ball = catalogue.bearing("6306", clearance=12e-6, damping=50.0)
        app.bearing(side, ball, inner=f"shaft.{side}", outer=f"{name}.centre")
    app.gravity((0.0, -9.81, 0.0))
    app.load("shaft.impeller", (0.0, 400.0, -800.0, 0.0, 0.0, 0.0))
    app.unbalance("shaft.impeller", 20e-6)
    return app


def model_path(name: str) -> Path:
    """Path of the model file of a ready machine, for `bd.read_model`, or to be copied.

    Parameters
    ----------
    name
        "motor", "fan", "spindle" or "pump".

    Raises
    ------
    ValueError
        For another name.
    """
    one_of("name", name, NAMES)
    return Path(str(files("bearingdyn.examples") / f"{name}.toml"))
