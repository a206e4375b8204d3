"""A Maxwell model written for other programs: Abaqus, ANSYS, CalculiX. All in SI units, Pa, s, kg/m³.

What a program cannot hold is refused or said in a comment, never dropped: no Prony form has a dashpot in
parallel, and no frequency-domain analysis of Abaqus shifts with temperature (write ``material.at(T)``).
References: Abaqus Keywords Guide, *VISCOELASTIC and *TRS; ANSYS Material Reference, viscoelasticity (TB,PRONY
and TB,SHIFT); G. Dhondt, CalculiX CrunchiX User's Manual, *DAMPING.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.checks import instance, positive, reals, require
from bearingdyn.material.maxwell import Maxwell
from bearingdyn.material.shift_laws import GAS_CONSTANT, WLF, ZERO_CELSIUS, Arrhenius


def elastic_constants(G: float, K: float) -> tuple[float, float]:
    """Young's modulus 9KG/(3K + G), Pa, and Poisson's ratio (3K − 2G)/(6K + 2G), as exports write them."""
    return 9 * K * G / (3 * K + G), (3 * K - 2 * G) / (6 * K + 2 * G)


def to_abaqus_frequency(material: Maxwell, frequency: ArrayLike, name: str = "RUBBER") -> str:
    """Export a material to Abaqus for steady-state dynamics: *VISCOELASTIC, FREQUENCY=TABULAR.

    Columns ωRe(g*) = G″/G∞, ωIm(g*) = 1 − G′/G∞, the same of the bulk modulus, f; the dashpot is contained.
    G∞ = G0 and K are the long-term moduli *ELASTIC gives.

    Parameters
    ----------
    material
        The Maxwell model.
    frequency
        (f,), Hz, of the table.
    name
        Of the material in Abaqus.

    Returns
    -------
    str
        Lines of an input file.

    Raises
    ------
    ValueError
        If G0 = 0, which Abaqus cannot normalise by, or a frequency is not positive.
    """
    instance("material", material, Maxwell, "give a Maxwell model")
    f = np.atleast_1d(reals("frequency", frequency, "it must be a list of positive, finite values, Hz"))
    if f.ndim != 1 or f.size == 0 or not (np.all(f > 0) and np.all(np.isfinite(f))):
        raise ValueError(f"frequency is {frequency!r}; it must be a list of positive, finite values, Hz")
    if not material.G0 > 0:
        raise ValueError("Maxwell.G0 is 0; Abaqus refers frequency data to a long-term modulus above zero")
    modulus = material.complex_modulus(2 * np.pi * f) / material.G0
    bulk = material.bulk_modulus(2 * np.pi * f) / material.K
    rows = zip(modulus.imag, 1 - modulus.real, bulk.imag, 1 - bulk.real, f, strict=True)
    lines = _abaqus_head(material, name, material.G0, "LONG TERM")
    lines += ["*VISCOELASTIC, FREQUENCY=TABULAR"]
    lines += [f"{a:.9e}, {b:.9e}, {_or_none(c)}, {_or_none(d)}, {hertz:.9e}" for a, b, c, d, hertz in rows]
    return "\n".join(lines) + "\n"


def _or_none(value: float) -> str:
    return f"{value:.9e}" if value != 0.0 else "0."


def to_abaqus_prony(material: Maxwell, name: str = "RUBBER") -> str:
    """Export a material to Abaqus for the time domain: *VISCOELASTIC, TIME=PRONY.

    A WLF or Arrhenius law becomes *TRS. Temperatures are in °C, and *PHYSICAL CONSTANTS says where absolute
    zero is.

    Parameters
    ----------
    material
        The Maxwell model.
    name
        Of the material in Abaqus.

    Returns
    -------
    str
        Lines of an input file.

    Raises
    ------
    ValueError
        If there is a dashpot, no branch, a bulk modulus that relaxes, or a law that Abaqus does not have.
    """
    _check_prony(material, "Abaqus")
    total = material.G_instantaneous
    lines = _abaqus_head(material, name, total, "INSTANTANEOUS")
    lines += ["*VISCOELASTIC, TIME=PRONY"]
    lines += [f"{g / total:.12e}, 0., {tau:.12e}" for g, tau in zip(material.G, material.tau, strict=True)]
    constants: list[str] = []
    match material.law:
        case None:
            lines += ["** no shift law: isothermal"]
        case WLF() as law:
            law = _at_temperature(law, material)
            lines += ["*TRS, DEFINITION=WLF", f"{law.T_ref:.9g}, {law.C1:.9g}, {law.C2:.9g}"]
        case Arrhenius() as law:
            constants = [
                "** belongs to the model, outside the material:",
                f"*PHYSICAL CONSTANTS, ABSOLUTE ZERO={-ZERO_CELSIUS}, UNIVERSAL GAS CONSTANT={GAS_CONSTANT}",
            ]
            lines += ["*TRS, DEFINITION=ARRHENIUS", f"{_temperature(material):.9g}, {law.Ea:.9g}"]
        case law:
            raise ValueError(_no_such_law(law, "Abaqus"))
    return "\n".join([*constants, *lines]) + "\n"


def to_ansys(material: Maxwell, number: int = 1) -> str:
    """Export a material to ANSYS: MP, TB,PRONY and TB,SHIFT; temperatures in kelvin, so TOFFST,0.

    WLF as TB,SHIFT,,,3,WLF with (Tr, C1, C2); Arrhenius as TN (Tool–Narayanaswamy), (Tr, Ea/R).

    Parameters
    ----------
    material
        The Maxwell model.
    number
        Of the material in ANSYS.

    Returns
    -------
    str
        Commands.

    Raises
    ------
    ValueError
        If there is a dashpot, no branch, a bulk modulus that relaxes, or a law that ANSYS does not have.
    """
    _check_prony(material, "ANSYS")
    if not (isinstance(number, int) and number > 0):
        raise ValueError(f"number is {number!r}; a material number must be a positive integer")
    total = material.G_instantaneous
    E, nu = elastic_constants(total, material.K)
    lines = [
        "! generalised Maxwell model, instantaneous moduli; SI units, temperatures in kelvin",
        "TOFFST,0",
        f"MP,EX,{number},{E:.12e}",
        f"MP,NUXY,{number},{nu:.12f}",
        f"MP,DENS,{number},{material.density:.9g}",
        f"TB,PRONY,{number},1,{material.G.size},SHEAR",
    ]
    place = 1
    for g, tau in zip(material.G, material.tau, strict=True):
        lines.append(f"TBDATA,{place},{g / total:.12e},{tau:.12e}")
        place += 2
    match material.law:
        case None:
            lines.append("! no shift law: isothermal")
        case WLF() as law:
            law = _at_temperature(law, material)
            lines += [
                f"TB,SHIFT,{number},1,3,WLF",
                f"TBDATA,1,{law.T_ref + ZERO_CELSIUS:.9g},{law.C1:.9g},{law.C2:.9g}",
            ]
        case Arrhenius() as law:
            lines += [
                f"TB,SHIFT,{number},1,2,TN",
                f"TBDATA,1,{_temperature(material) + ZERO_CELSIUS:.9g},{law.Ea / GAS_CONSTANT:.9g}",
            ]
        case law:
            raise ValueError(_no_such_law(law, "ANSYS"))
    return "\n".join(lines) + "\n"


def to_calculix(material: Maxwell, frequency: float, name: str = "RUBBER") -> str:
    """Export a material to CalculiX for steady-state dynamics: *ELASTIC and *DAMPING, STRUCTURAL.

    CalculiX has no viscoelastic material. It takes a constant storage modulus and loss factor, and applies
    the loss factor to the volume too, where this model has none.

    Parameters
    ----------
    material
        The Maxwell model.
    frequency
        Hz, near which the constants hold.
    name
        Of the material in CalculiX.

    Returns
    -------
    str
        Lines of an input file.

    Raises
    ------
    ValueError
        If the frequency is not positive.
    """
    frequency = positive("frequency", frequency, "it must be positive and finite, Hz")
    instance("material", material, Maxwell, "give a Maxwell model")
    _check_name(name)
    modulus = complex(material.complex_modulus(2 * math.pi * frequency))
    E, nu = elastic_constants(modulus.real, float(material.bulk_modulus(2 * math.pi * frequency).real))
    return "\n".join(
        [
            f"** holds at {frequency:.6g} Hz only; the loss factor acts on the volume too",
            f"*MATERIAL, NAME={name}",
            "*ELASTIC",
            f"{E:.12e}, {nu:.12f}",
            "*DENSITY",
            f"{material.density:.9g}",
            f"*DAMPING, STRUCTURAL={modulus.imag / modulus.real:.9e}",
            "",
        ]
    )


def _check_name(name: str) -> None:
    good = isinstance(name, str) and name and not set(name) & set(",=*\n\r")
    require(bool(good), "name", name, "it must be the name of a material: a text without , = * and line ends")


def _abaqus_head(material: Maxwell, name: str, G: float, kind: str) -> list[str]:
    E, nu = elastic_constants(G, material.K)
    _check_name(name)
    return [
        f"*MATERIAL, NAME={name}",
        "*DENSITY",
        f"{material.density:.9g}",
        f"*ELASTIC, MODULI={kind}",
        f"{E:.12e}, {nu:.12f}",
    ]


def _check_prony(material: Maxwell, program: str) -> None:
    instance("material", material, Maxwell, "give a Maxwell model")
    if material.eta0 > 0:
        raise ValueError(
            f"Maxwell.eta0 is {material.eta0:g} Pa s; {program}'s Prony series has no dashpot; fit with "
            "dashpot=False"
        )
    require(
        material.bulk is None,
        "Maxwell.bulk",
        material.bulk,
        f"{program}'s Prony series is written with a constant bulk modulus: give the material with bulk=None",
    )
    if material.G.size == 0:
        raise ValueError(f"Maxwell.G is empty; {program}'s Prony series needs a branch")
    if material.vertical is not None:
        raise ValueError(
            f"Maxwell.vertical is set; {program}'s Prony series has no vertical shift; write material.at(T) "
            "with vertical=None"
        )


def _temperature(material: Maxwell) -> float:
    assert material.temperature is not None  # a material with a law has one
    return material.temperature


def _at_temperature(law: WLF, material: Maxwell) -> WLF:
    """The same law referred to the temperature the times hold at: C2′ = C2 + T − T_ref, C1′ = C1 C2/C2′."""
    T = _temperature(material)
    C2 = law.C2 + T - law.T_ref
    return WLF(law.C1 * law.C2 / C2, C2, T)


def _no_such_law(law: object, program: str) -> str:
    return (
        f"law is {type(law).__name__}: {program} has WLF and Arrhenius; write material.at(T) for one "
        "temperature with law=None"
    )
