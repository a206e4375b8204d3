"""What a physical input can be, in SI: one table, and the check of a number against its row.

A number outside the possible is refused; one outside the usual is used, with a warning. Both say why, and
name the unit that was probably meant: mm, µm, MPa, degrees, g mm, kg mm², rpm, kelvin.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from bearingdyn.checks import number
from bearingdyn.notice import UnusualMagnitude, warn
from bearingdyn.types import Array

__all__ = [
    "MAGNITUDES",
    "Magnitude",
    "UnusualMagnitude",
    "check_bulk",
    "check_density",
    "check_reference",
    "plausible",
]


class Slip(NamedTuple):
    """A slip of magnitude: a unit that is often given instead, SI = scale × number + shift."""

    unit: str
    scale: float
    shift: float = 0.0


_TYPED = (
    0.01  # numbers in units below a thousandth are larger: nobody gives a film of 5e-5 µm, but of 5e-5 mm
)


@dataclass(frozen=True)
class Magnitude:
    """What magnitudes one quantity can have.

    Parameters
    ----------
    unit
        SI.
    possible
        (least, most); what is outside is refused.
    usual
        (least, most); what is outside comes with a warning.
    reason
        Where the limits come from.
    slips
        Units often given instead.
    by_size
        Whether the limits are of |x|, zero always being possible; else of x itself.
    """

    unit: str
    possible: tuple[float, float]
    usual: tuple[float, float]
    reason: str
    slips: tuple[Slip, ...] = ()
    by_size: bool = True

    def within(self, x: float, limits: tuple[float, float]) -> bool:
        """Whether x lies in the limits; NaN does not."""
        if self.by_size and x == 0:
            return True
        return limits[0] <= (abs(x) if self.by_size else x) <= limits[1]

    def guess(self, x: float) -> str:
        """The unit in which x would be usual, as a question; empty if there is none."""
        for unit, scale, shift in self.slips:
            meant = scale * x + shift
            typed = abs(x) >= _TYPED or scale >= 1e-3
            if typed and self.within(meant, self.usual):
                return f"; is it in {unit}? give {meant:.4g} {self.unit}".rstrip()
        return ""

    def span(self, limits: tuple[float, float], x: float) -> str:
        """The limit that x does not keep, in words."""
        size = abs(x) if self.by_size else x
        word, limit = ("at least", limits[0]) if size < limits[0] else ("at most", limits[1])
        return f"{word} {limit:g} {self.unit}".rstrip()


_MM, _UM, _NM = Slip("mm", 1e-3), Slip("µm", 1e-6), Slip("nm", 1e-9)
_KN = Slip("kN", 1e3)
_MPA, _GPA, _KPA = Slip("MPa", 1e6), Slip("GPa", 1e9), Slip("kPa", 1e3)
# a factor typed twice, as in 30 * mm * mm
_TWICE = Slip("mm, converted twice", 1e3)
_LENGTHS, _STRESSES = (_MM, _UM), (_MPA, _GPA, _KPA)
_DEGREES = (Slip("degrees", math.pi / 180),)
_CELSIUS = (Slip("kelvin", 1.0, -273.15), Slip("°F", 5 / 9, -160 / 9))
_RPM = Slip("rpm", math.pi / 30)

MAGNITUDES: Mapping[str, Magnitude] = MappingProxyType(
    {
        # ------------------------------------------------------------ materials
        "Young's modulus": Magnitude(
            "Pa",
            (1e4, 1e18),
            (1e5, 1.3e12),
            "a gel has 1e4 Pa, rubber 1e6, steel 2.1e11, diamond 1.2e12",
            (_GPA, _MPA, _KPA),
        ),
        "shear modulus": Magnitude(
            "Pa", (1e2, 1e12), (1e3, 6e11), "a gel has 1e3 Pa, rubber 1e5 to 1e9, diamond 5e11", _STRESSES
        ),
        "branch modulus": Magnitude(
            "Pa", (0.0, 1e12), (0.0, 6e11), "no glass has more, diamond 5e11", (Slip("kPa", 1e-3),)
        ),
        "bulk modulus": Magnitude(
            "Pa",
            (1e4, 1e12),
            (1e5, 5e11),
            "a foam has 1e5 Pa, rubber 2e9, diamond 4.4e11",
            _STRESSES,
        ),
        "bulk branch": Magnitude(
            "",
            (0.0, 100.0),
            (0.0, 3.0),
            "glassy polymers are two to three times as stiff in volume as rubbery ones",
            (Slip("per cent", 0.01),),
        ),
        "spread": Magnitude(
            "",
            (0.0, 2.0),
            (0.0, 0.5),
            "two specimens differ by 0.05, a modulus that is hardly known by 0.3",
            (Slip("per cent", 0.01),),
        ),
        "wave speed": Magnitude(
            "m/s", (20.0, math.inf), (20.0, math.inf), "sound runs at 20 m/s or more in any solid"
        ),
        "relaxation time": Magnitude(
            "s", (1e-30, 1e30), (1e-20, 1e20), "a measured curve spans some twenty decades about 1 s"
        ),
        "dashpot viscosity": Magnitude("Pa s", (0.0, 1e15), (0.0, 1e9), "a rubber's is of G times its time"),
        "temperature": Magnitude(
            "°C", (-273.15, 2000.0), (-150.0, 250.0), "rubber serves from -100 to 250 °C", _CELSIUS, False
        ),
        "activation energy": Magnitude(
            "J/mol",
            (1.0, 1e9),
            (2e3, 3e6),
            "that of flow is 2e4 to 1e6 J/mol",
            (Slip("kJ/mol", 1e3), Slip("kcal/mol", 4184.0)),
        ),
        "oil temperature": Magnitude(
            "°C", (-273.15, 1000.0), (-80.0, 250.0), "oils serve from -60 to 200 °C", _CELSIUS, False
        ),
        "viscosity": Magnitude(
            "Pa s",
            (1e-6, 1e6),
            (1e-4, 100.0),
            "water has 1e-3 Pa s, a bearing's oil 5e-3 to 1",
            (Slip("mPa s", 1e-3),),
        ),
        "kinematic viscosity": Magnitude(
            "m²/s", (1e-8, 1.0), (5e-7, 0.1), "ISO VG 32 has 32e-6 m²/s at 40 °C", (Slip("mm²/s", 1e-6),)
        ),
        "pressure coefficient": Magnitude(
            "1/Pa",
            (1e-10, 1e-6),
            (2e-9, 6e-8),
            "oils have 1e-8 to 3e-8 1/Pa",
            (Slip("1/GPa", 1e-9), Slip("mm²/N", 1e-6)),
        ),
        "oil density": Magnitude(
            "kg/m³", (100.0, 5000.0), (500.0, 3000.0), "oils have 800 to 1000 kg/m³", (Slip("g/cm³", 1e3),)
        ),
        "expansion": Magnitude(
            "1/K", (0.0, 1e-2), (0.0, 3e-4), "steel has 12e-6 1/K, rubber 2e-4", (Slip("1e-6/K", 1e-6),)
        ),
        "warming": Magnitude(
            "K",
            (-2000.0, 2000.0),
            (-200.0, 200.0),
            "it is a difference of temperatures",
            (Slip("kelvin above absolute zero", 1.0, -293.15),),
            False,
        ),
        # ------------------------------------------------------------- geometry
        "length": Magnitude(
            "m",
            (1e-8, 10.0),
            (2e-4, 10.0),
            "a part of a machine; the smallest ball bearing is 1.5 mm across",
            (*_LENGTHS, _TWICE),
        ),
        "shaft length": Magnitude(
            "m", (1e-8, 100.0), (2e-5, 100.0), "a ship's line of shafts", (*_LENGTHS, _TWICE)
        ),
        "shaft diameter": Magnitude(
            "m", (1e-8, 5.0), (1e-4, 5.0), "a watch's pivot to the hub of a turbine", (*_LENGTHS, _TWICE)
        ),
        "solid length": Magnitude(
            "m", (1e-8, 100.0), (1e-6, 100.0), "of a mesh that read_mesh was told is that large", _LENGTHS
        ),
        "place": Magnitude(
            "m",
            (0.0, 100.0),
            (0.0, 10.0),
            "a point of a part, along its axis",
            _LENGTHS,
        ),
        "machine": Magnitude("m", (1e-4, 1e3), (5e-3, 50.0), "machines are 0.01 to 20 m long", _LENGTHS),
        "microphone": Magnitude(
            "m", (1e-4, 1e4), (5e-3, 100.0), "microphones stand 0.01 to 16 m from a machine", _LENGTHS
        ),
        "specimen": Magnitude(
            "m", (1e-6, 1.0), (1e-4, 0.2), "specimens are 1 to 50 mm thick and wide", (_MM,)
        ),
        "ball diameter": Magnitude(
            "m", (1e-6, 0.5), (1e-4, 0.2), "balls of bearings have 0.3 mm to 150 mm", _LENGTHS
        ),
        "pitch diameter": Magnitude(
            "m", (1e-6, 10.0), (1e-4, 10.0), "slewing bearings have metres", _LENGTHS
        ),
        "groove": Magnitude(
            "", (0.5, 1e4), (0.5, 1.0), "a groove's radius is 0.51 to 0.56 Dw, and 100 Dw is flat"
        ),
        "clearance": Magnitude(
            "of Dw",
            (-0.02, 0.1),
            (-0.005, 0.04),
            "radial clearances (ISO 5753) are below Dw/80, and balls clamped by Dw/200 have 2.4 GPa",
            by_size=False,
        ),
        "mount clearance": Magnitude(
            "m", (0.0, 0.1), (0.0, 2e-3), "fits leave some µm to some tenths of a mm", (_UM, _MM)
        ),
        "interference": Magnitude(
            "m", (0.0, 0.01), (0.0, 5e-4), "press fits have some µm to some tenths of a mm", (_UM, _MM)
        ),
        "contact angle": Magnitude(
            "rad", (0.0, math.pi / 2), (0.0, 1.2), "ball bearings have 0 to 60°, 1.05 rad", _DEGREES
        ),
        "angle": Magnitude("rad", (0.0, 1e6), (0.0, 4 * math.pi * (1 + 1e-6)), "a full turn is 2π", _DEGREES),
        "turned angle": Magnitude("rad", (0.0, 1e12), (0.0, 40.0), "a full turn is 2π", _DEGREES),
        "tilt": Magnitude(
            "rad",
            (0.0, 1.0),
            (0.0, 0.1),
            "tilts enter linearly and are milliradians",
            (Slip("degrees", math.pi / 180), Slip("mrad", 1e-3), Slip("µrad", 1e-6)),
        ),
        "film": Magnitude(
            "m", (0.0, 1e-4), (0.0, 1e-5), "both films of a ball are 0.05 to 5 µm thick", (_UM, _NM, _MM)
        ),
        "waviness": Magnitude(
            "m", (0.0, 2e-4), (0.0, 5e-5), "waves of ground races are 1 nm to some µm high", (_UM, _NM, _MM)
        ),
        "bore wave": Magnitude(
            "m", (0.0, 0.01), (0.0, 5e-4), "bores are out of round by 1 to 100 µm", (_UM, _MM)
        ),
        "wave order": Magnitude(
            "waves a turn",
            (0.0, 1e6),
            (0.0, 2e4),
            "shorter waves than a contact, 20 to 2000 a turn, hardly move a ball; roughness has 1e5",
        ),
        "oversize": Magnitude(
            "m", (0.0, 2e-4), (0.0, 5e-5), "balls of one bearing differ by 0.1 to some µm", (_UM, _NM, _MM)
        ),
        "roughness": Magnitude(
            "m", (0.0, 1e-4), (0.0, 1e-5), "races and balls have 5 nm to 0.5 µm", (_UM, _NM, _MM)
        ),
        "pit width": Magnitude("m", (1e-8, 0.1), (1e-7, 0.02), "spalls are 0.1 to some mm wide", (_MM, _UM)),
        "pit depth": Magnitude("m", (1e-9, 0.01), (1e-9, 1e-3), "spalls are 1 to 500 µm deep", (_UM, _MM)),
        "offset": Magnitude(
            "m", (0.0, 1.0), (0.0, 5e-3), "preload by displacement is 1 to some 100 µm", (_UM, _MM)
        ),
        "static displacement": Magnitude(
            "m", (0.0, 1e3), (0.0, 0.05), "the softest mounts sag by 40 mm", _LENGTHS
        ),
        "displacement": Magnitude(
            "m", (0.0, 1.0), (0.0, 0.01), "parts move by µm; the theory is of small motions", (_UM, _MM)
        ),
        # ---------------------------------------------------- bodies and joints
        "mass": Magnitude("kg", (1e-12, 1e8), (1e-9, 1e6), "a ball has grams, a turbine's rotor 1e5 kg"),
        "gyration": Magnitude(
            "m",
            (0.0, 20.0),
            (0.0, 5.0),
            "√(inertia/mass), the radius of gyration, lies within the part",
            (_MM,),
        ),
        "gyration ratio": Magnitude("", (0.0, 300.0), (0.0, 30.0), "wheels and rods reach ten or twenty"),
        "stiffness": Magnitude(
            "N/m", (0.0, 1e18), (0.0, 1e14), "a machine's bed has 1e9 N/m; hold rigidly what is stiffer"
        ),
        "bed stiffness": Magnitude(
            "N/m³",
            (0.0, 1e20),
            (1e6, 1e17),
            "1 mm of rubber has 1e9 to 1e12 N/m³, 10 mm of steel 2e13",
            (Slip("N/mm³", 1e9),),
        ),
        "support damping": Magnitude(
            "s", (0.0, 100.0), (0.0, 0.1), "of a spring with a loss factor of 0.1 at 100 Hz it is 1.6e-4 s"
        ),
        "conductance": Magnitude(
            "W/K", (1e-12, 1e9), (1e-6, 1e5), "a film of still air has 1e-2 W/K, a ring in its bore 1e2"
        ),
        "area": Magnitude(
            "m²",
            (1e-12, 1e4),
            (1e-7, 100.0),
            "a bearing's seat has 1e-3 m², a motor's housing 1",
            (Slip("mm²", 1e-6), Slip("cm²", 1e-4)),
        ),
        "film coefficient": Magnitude(
            "W/(m² K)",
            (0.0, 1e7),
            (0.5, 1e5),
            "still air has 5 to 10, a fan's air 50, a stream of water 5000, a dry seat 300",
        ),
        "conductivity": Magnitude(
            "W/(m K)",
            (1e-4, 5000.0),
            (0.01, 500.0),
            "air has 0.026, rubber 0.2, steel 50, copper 400",
            (Slip("mW/(m K)", 1e-3),),
        ),
        "sample rate": Magnitude(
            "Hz", (1.0, 1e9), (1e3, 1e7), "sound is sampled at 8000 to 192 000 Hz", (Slip("kHz", 1e3),)
        ),
        "damping": Magnitude("N s/m", (0.0, 1e15), (0.0, 1e10), "a machine's dampers have 1 to 1e6 N s/m"),
        "contact damping": Magnitude("N s/m", (0.0, 1e9), (0.0, 1e6), "one ball in oil has 10 to 1e4 N s/m"),
        "contact damping time": Magnitude(
            "s",
            (0.0, 1.0),
            (0.0, 1e-2),
            "a contact's damping over stiffness is 1e-7 to 1e-4 s",
            (Slip("µs", 1e-6), Slip("ms", 1e-3)),
        ),
        "deflection coefficient": Magnitude(
            "N/m^1.5",
            (1e3, 1e16),
            (1e6, 1e14),
            "steel balls have 1e9 to 1e11 N/m^1.5, a ring in its bore 3e13",
            (Slip("N/mm^1.5", 10**4.5), Slip("N/µm^1.5", 1e9)),
        ),
        # ---------------------------------------------------------------- loads
        "force": Magnitude(
            "N", (0.0, 1e12), (0.0, 1e8), "the heaviest bearings carry 1e7 N", (Slip("mN", 1e-3),)
        ),
        "moment": Magnitude(
            "N m", (0.0, 1e12), (0.0, 1e8), "the heaviest shafts pass 1e7 N m", (Slip("N mm", 1e-3),)
        ),
        "seal moment": Magnitude(
            "N m", (0.0, 1e4), (0.0, 10.0), "contact seals have 0.005 to 5 N m", (Slip("N mm", 1e-3),)
        ),
        "gravity": Magnitude(
            "m/s²", (0.0, 1000.0), (0.0, 30.0), "the earth has 9.81 m/s²", (Slip("mm/s²", 1e-3),)
        ),
        "field of gravity": Magnitude(
            "m/s²",
            (0.0, 1000.0),
            (1.2, 30.0),
            "the moon has 1.62 m/s², the earth 9.81",
            (Slip("g", 9.80665), Slip("mm/s²", 1e-3)),
        ),
        "velocity of a housing": Magnitude(
            "m/s",
            (0.0, 1e3),
            (0.0, 0.3),
            "machines are stopped at 0.01 to 0.03 m/s (ISO 20816)",
            (Slip("mm/s", 1e-3), Slip("µm/s", 1e-6)),
        ),
        "acceleration": Magnitude(
            "m/s²", (0.0, 1e7), (0.0, 5000.0), "a hard shock has 500 g, 5000 m/s²", (Slip("mm/s²", 1e-3),)
        ),
        "unbalance": Magnitude(
            "kg m",
            (0.0, 1e4),
            (0.0, 100.0),
            "rotors of 1 kg have 1e-6 to 1e-4 kg m",
            (Slip("g mm", 1e-6), Slip("kg mm", 1e-3)),
        ),
        "eccentricity": Magnitude(
            "m",
            (0.0, 0.5),
            (0.0, 0.01),
            "unbalance over the mass that turns is 0.1 to 100 µm (ISO 21940)",
            (Slip("mm", 1e-3), Slip("µm", 1e-6)),
        ),
        "pressure": Magnitude(
            "Pa",
            (0.0, 2.1e10),
            (0.0, 4.2e9),
            "4.2 GPa is the static rating (ISO 76), five times that is above the hardness of silicon nitride",
        ),
        "oil pressure": Magnitude(
            "Pa",
            (0.0, 2.1e10),
            (1e4, 4.2e9),
            "contacts press their oil with 1e8 to 4e9 Pa",
            (_GPA, _MPA),
        ),
        "pressure by Barus": Magnitude(
            "Pa", (0.0, 3e10), (0.0, 5e8), "Barus' law is some times too high above 1e8 Pa; take Roelands'"
        ),
        "share of the static rating": Magnitude(
            "",
            (0.0, 1e9),
            (5e-4, 1e9),
            "balls of a bearing that bears less than a hundredth slide instead of rolling",
        ),
        "rating": Magnitude(
            "N", (0.0, 1e10), (5.0, 1e8), "the smallest ball bearings have 10 N, the largest 1e7", (_KN,)
        ),
        "rating by size": Magnitude(
            "N/m²",
            (3e4, 3e8),
            (2e5, 3e7),
            "C0 over the square of a diameter is 2e6 to 1e7 N/m² of ball bearings",
            (Slip("kN", 1e3),),
        ),
        # ------------------------------------------------------- time and speed
        "speed": Magnitude(
            "rad/s", (0.0, 1e6), (0.0, 5e4), "5e4 rad/s are 477 000 rpm, a dental drill's", (_RPM,)
        ),
        "angular acceleration": Magnitude(
            "rad/s²", (0.0, 1e12), (0.0, 1e7), "a dental drill takes 0.05 s to 5e4 rad/s, 1e6 rad/s²"
        ),
        "time at rest": Magnitude(
            "s", (1e-30, 1e12), (1e-20, 1e10), "a machine serves for a hundred years, 3e9 s"
        ),
        "speed value n·dm": Magnitude(
            "mm/min",
            (0.0, 2e7),
            (0.0, 1.5e6),
            "speed times pitch diameter; ball bearings reach 0.5e6 in grease, 1e6 in oil, and the fastest "
            "spindles 3e6 mm/min, with ceramic balls",
        ),
        "speed value n·dm of a deep groove bearing": Magnitude(
            "mm/min",
            (0.0, 2e7),
            (0.0, 8e5),
            "speed times pitch diameter; makers limit open bearings with steel balls to 0.5e6 to 0.65e6 in "
            "grease and 0.6e6 to 0.75e6 mm/min in oil",
        ),
        "frequency": Magnitude("Hz", (1e-12, 1e12), (1e-9, 1e9), "machines sound from 1e-3 to 1e5 Hz"),
        "band of a part": Magnitude(
            "Hz",
            (0.0, 1e8),
            (0.0, 1e6),
            "modes above what is heard, 20 kHz, follow statically; a mesh for more grows without end",
        ),
        "time step": Magnitude(
            "s",
            (1e-18, 1e6),
            (1e-12, 1.0),
            "balls passing take steps of 1e-7 to 1e-4 s",
            (Slip("µs", 1e-6), Slip("ms", 1e-3)),
        ),
    }
)
"""What is possible and usual of every physical input."""

# kg/m³; a foam to more than any metal, and what stands for a body without inertia
LIGHTEST, HEAVIEST = 10.0, 30000.0
MASSLESS = (1e-4, 0.1)
SOFTEST = MAGNITUDES["Young's modulus"].possible[0]
LARGEST_BODY = MAGNITUDES["length"].possible[1]


def plausible(kind: str, field: str, value: object, remedy: str = "", hint: str | None = None) -> float:
    """The value as a float of a magnitude that can be meant.

    Parameters
    ----------
    kind
        Row of MAGNITUDES.
    field
        Name of the input, for the message.
    value
        In the row's unit.
    remedy
        What would be right where it is no finite number at all.
    hint
        Instead of the row's own guess of the unit, where the value follows from what was given.

    Warns
    -----
    UnusualMagnitude
        Outside the usual.

    Raises
    ------
    ValueError
        Outside the possible, or no finite number.
    """
    row = MAGNITUDES[kind]
    x = number(field, value, remedy or f"it must be one finite number, in {row.unit}".removesuffix(", in "))
    if row.within(x, row.usual) and row.within(x, row.possible):
        return x
    told = f"{field} is {x:.6g} {row.unit}".rstrip()
    guess = row.guess(x) if hint is None else hint
    if not row.within(x, row.possible):
        raise ValueError(f"{told}; it must be {row.span(row.possible, x)} ({row.reason}){guess}")
    text = f"{told}; usual is {row.span(row.usual, x)} ({row.reason}){guess}"
    warn(text, UnusualMagnitude)
    return x


def check_density(field: str, density: float) -> None:
    """Check the magnitude of a density, kg/m³; 1e-4 to 0.1 mean a body without inertia. Raises ValueError."""
    if not (LIGHTEST <= density <= HEAVIEST or MASSLESS[0] <= density <= MASSLESS[1]):
        raise ValueError(
            f"{field} is {density!r} kg/m³; it must be {LIGHTEST:g} to {HEAVIEST:g} kg/m³, as solids are; is "
            f"it in g/cm³ or t/mm³? Water has 1000 kg/m³ (for a body without inertia give {MASSLESS[0]:g} to "
            f"{MASSLESS[1]:g})"
        )


def check_bulk(field: str, K: float, G: float) -> None:
    """Check the magnitude of a bulk modulus K: with the shear modulus G, both Pa, ν must not be negative."""
    if not K >= 2 / 3 * G:  # ν = (3K − 2G)/(6K + 2G)
        raise ValueError(
            f"{field} is {K:g} Pa, below 2/3 of the shear modulus, {G:.4g} Pa: Poisson's ratio would be "
            "negative; a rubber's bulk modulus is near 2e9 Pa"
        )


def check_waves(field: str, modulus: float, density: float) -> None:
    """Check the magnitude of a modulus, Pa, and a density, kg/m³, by the speed of sound. Raises ValueError.

    The kind of slip: steel of E = 210e3, in MPa, with 7850 kg/m³ has √(E/ρ) = 5.2 m/s.
    """
    modulus, density = float(modulus), float(density)
    speed = math.sqrt(modulus / density)
    floor = MAGNITUDES["wave speed"].possible[0]
    if density >= LIGHTEST and not speed >= floor:
        raise ValueError(
            f"{field} is {modulus:g} Pa; it must be at least {floor**2 * density:.3g} Pa with a density of "
            f"{density:g} kg/m³: waves would run at {speed:.2g} m/s, and run at {floor:g} m/s or more in any "
            f"solid; is it in MPa? give {modulus * 1e6:.4g} Pa"
        )


def check_speed_value(field: str, speed: float, pitch: float, groove: bool = False) -> None:
    """Check the magnitude of a shaft's speed, rad/s, with the pitch diameter, m, of a bearing on it: n·dm.

    groove: whether it is a deep groove bearing with steel balls, which runs less fast than a spindle's.
    """
    speed, pitch = float(speed), float(pitch)
    kind = f"speed value n·dm{' of a deep groove bearing' if groove else ''}"
    turns = speed * 30 / math.pi
    value, row = abs(turns) * pitch * 1e3, MAGNITUDES[kind]
    meant = row.within(value * math.pi / 30, row.usual)
    hint = (
        f"; is the speed in rpm? give {speed * math.pi / 30:.6g} rad/s, or rpm={speed:.6g}" if meant else ""
    )
    plausible(kind, f"{field} is {speed:.6g} rad/s, {turns:.6g} rpm; n·dm", value, hint=hint)


def check_gyration(field: str, inertia: float, mass: float) -> None:
    """Check the magnitude of a moment of inertia, kg m², for a mass, kg: its radius of gyration.

    Beside the row's own limits, √(I/m) is compared with the side of a steel cube of that mass: a shell, a rod
    or a wheel reach some ten sides, an inertia in kg mm² is a thousand times further out.
    """
    radius, side = math.sqrt(inertia / mass), (mass / 7850.0) ** (1 / 3)
    name = f"{field} is {inertia:.6g} kg m² with a mass of {mass:.6g} kg; its radius of gyration"
    known = MAGNITUDES["gyration"]
    slip = f"; is the inertia in kg mm²? give {inertia * 1e-6:.4g} kg m²"
    plausible("gyration", name, radius, hint=slip if known.within(radius * 1e-3, known.usual) else "")
    row = MAGNITUDES["gyration ratio"]
    # a body of less than 0.1 g stands for none, and its moments for nothing
    if mass > 1e-4 and not row.within(radius / side, row.usual):
        text = f"{name} is {radius:.4g} m, {radius / side:.3g} times the side of a steel cube of that mass; "
        meant = f"is the inertia in kg mm²? give {inertia * 1e-6:.4g} kg m²"
        if not row.within(radius / side, row.possible):
            raise ValueError(f"{text}it must be at most {row.possible[1]:g} ({row.reason}); {meant}")
        warn(f"{text}usual is at most {row.usual[1]:g} ({row.reason}); {meant}", UnusualMagnitude)


def check_reference(field: str, reference: Array, points: Array) -> None:
    """Check the magnitude of a reference point (3,), m, by the extent of the body's points (n, 3), m.

    Twenty times the body away, a rigid arm to it is no part of a machine. Raises ValueError.
    """
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    away = float(np.linalg.norm(np.maximum(0.0, np.maximum(low - reference, reference - high))))
    if not away <= 20.0 * size:
        raise ValueError(
            f"{field} is {reference.tolist()}, {away:.4g} m away from a body {size:.4g} m large; it must lie "
            f"within 20 times that; is it in mm? give {(1e-3 * reference).tolist()} m"
        )
