"""A rotor that ROSS saved turns as ROSS says, and what has no counterpart is named."""

from __future__ import annotations

import json
import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg

import bearingdyn as bd

FILE = Path(__file__).parent / "ross_rotor.toml"  # saved by ROSS 2.3.0
# Hz, damped modes by `rotor.run_modal(speed=…, num_modes=20).wn` of ROSS 2.3.0, without the free ones
ROSS = {
    0.0: [17.7119, 23.0600, 23.2933, 85.6087, 87.6029, 175.6052, 226.1154, 239.0077, 289.8859, 309.8858],
    400.0: [17.7119, 22.9775, 23.6339, 86.5446, 89.5115, 175.6052, 218.5215, 257.5171, 314.6586, 337.6617],
}


@pytest.mark.parametrize("speed", [0.0, 400.0])
@pytest.mark.parametrize("form", ["toml", "json"])
def test_the_rotor_has_the_frequencies_that_ross_finds(speed: float, form: str, tmp_path: Path) -> None:
    file = FILE
    if form == "json":
        file = tmp_path / "rotor.json"
        file.write_text(json.dumps(tomllib.loads(FILE.read_text())))
    found = bd.modes(bd.read_ross(file, speed=speed), speed=speed, damped=True)
    f = np.sort(found["frequency"].values)
    f = f[f > 1.0][:10]
    # both are Timoshenko beams; ROSS's 24 elements and its coefficient of shear are worth 3e-4 at 340 Hz
    assert f == pytest.approx(ROSS[speed], rel=4e-4)


def changed(tmp_path: Path, change: Callable[[dict[str, Any]], object]) -> Path:
    held = tomllib.loads(FILE.read_text())
    change(held)
    path = tmp_path / "changed.json"
    path.write_text(json.dumps(held))
    return path


def test_coefficients_stand_on_their_axes_and_between_their_speeds() -> None:
    supports = {str(p): s for p, s in bd.read_ross(FILE, speed=500.0).plan.supports.items()}
    assert supports["shaft.n0"].stiffness == pytest.approx([1e7, 0.8e7, 1e6, 0, 0, 0])
    assert supports["shaft.n0"].damping == pytest.approx([100.0, 120.0, 0, 0, 0, 0])
    # halfway between 0 and 1000 rad/s; ROSS takes cyy from cxx where it is not given
    assert supports["shaft.n24"].stiffness == pytest.approx([1.5e7, 1.2e7, 0, 0, 0, 0])
    assert supports["shaft.n24"].damping == pytest.approx([150.0, 150.0, 0, 0, 0, 0])


FIRST, DISC, LEFT = "ShaftElement_Shaft Element 0", "DiskElement_Disk 0", "BearingElement_Bearing 0"


def test_a_tapered_element_is_as_stiff_as_the_steps_it_stands_for(tmp_path: Path) -> None:
    """Frequencies lie between those of the rotor with the thick and with the thin end throughout."""

    def first(left: float, right: float) -> float:
        def change(held: dict[str, Any]) -> None:
            for k in range(8, 16):
                held[f"ShaftElement_Shaft Element {k}"] |= {"odl": left, "odr": right}

        f = bd.modes(bd.read_ross(changed(tmp_path, change)))["frequency"].values
        return float(f[(f > 20.0)][0])

    assert first(0.05, 0.05) < first(0.05, 0.06) < first(0.06, 0.06)


def torsion(held: dict[str, Any], of: Callable[[float, float], tuple[float, float]]) -> float:
    """Lowest torsional frequency of a saved rotor, Hz; `of`: both J of an element, by its diameters."""
    shaft = [one for name, one in held.items() if name.startswith("ShaftElement")]
    K, M = np.zeros((len(shaft) + 1,) * 2), np.zeros((len(shaft) + 1,) * 2)
    for k, one in enumerate(shaft):
        stiff, heavy = of(one["odl"], one["odr"])
        at, L, metal = np.ix_([k, k + 1], [k, k + 1]), one["L"], one["material"]
        K[at] += metal["G_s"] * stiff / L * np.array([[1, -1], [-1, 1]])
        M[at] += metal["rho"] * heavy * L / 6 * np.array([[2, 1], [1, 2]])
    for name, one in held.items():
        if name.startswith("DiskElement"):
            M[one["n"], one["n"]] += one["Ip"]
    return math.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[1]) / (2 * math.pi)


def test_a_tapered_element_twists_as_its_integral_says_and_not_as_ross_has_it(tmp_path: Path) -> None:
    """ROSS takes the mean of the fourth powers of the ends' radii for stiffness and inertia.

    The flexibility is ∫ dz/GJ, and the inertia ∫ ρJ dz. With eight such elements ROSS is some 3 % too high.
    """

    def exact(a: float, b: float) -> tuple[float, float]:
        x = (np.arange(2000) + 0.5) / 2000
        J = math.pi / 32 * (a + (b - a) * x) ** 4
        return float(1 / np.mean(1 / J)), float(J.mean())

    def of_ross(a: float, b: float) -> tuple[float, float]:
        return (math.pi / 32 * (a**4 + b**4) / 2,) * 2

    def change(held: dict[str, Any]) -> None:
        for k in range(8, 16):
            held[f"ShaftElement_Shaft Element {k}"] |= {"odl": 0.05, "odr": 0.06}

    file = changed(tmp_path, change)
    held = json.loads(file.read_text())
    f = bd.modes(bd.read_ross(file))["frequency"].values
    # sixteen steps of mean diameters: (taper/16)² of the stiffness; no other mode is as near
    assert np.abs(f / torsion(held, exact) - 1.0).min() < 3e-4
    assert torsion(held, of_ross) / torsion(held, exact) == pytest.approx(1.03, abs=0.01)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda h: h[LEFT].update(kxy=[5.0]), "Bearing 0: kxy is 5"),
        (lambda h: h[LEFT].update(mxx=[5.0]), "mxx is 5"),
        (lambda h: h[LEFT].update(n_link=3), "n_link is 3"),
        (lambda h: h[LEFT].update(kxx=[float("nan")]), "kxx is .*finite"),
        (lambda h: h[LEFT].update(kxx=[1.0, 2.0]), "kxx is .*1 finite numbers"),
        (lambda h: h[LEFT].update(kxx="stiff"), "kxx is 'stiff'"),
        (lambda h: h[LEFT].update(n=99), "n is 99"),
        (lambda h: h["BearingElement_right"].update(frequency=[5.0, 1.0]), "ascending"),
        (lambda h: h[DISC].update(n=-1), "n is -1"),
        (lambda h: h[DISC].update(m="heavy"), "m is 'heavy'"),
        (lambda h: h[FIRST].update(L=-1.0), "Shaft Element 0: .*length"),
        (lambda h: h[FIRST].update(axial_force=5.0), "axial_force is 5"),
        (lambda h: h[FIRST].update(n=5), "follow each other"),
        (lambda h: h[FIRST].pop("odl"), "odl is None"),
        (lambda h: h[FIRST].update(material=3), "material is 3"),
        (lambda h: h[FIRST]["material"].update(E=1e11), "2 materials"),
        (lambda h: h[FIRST]["material"].update(G_s=0.0), "material"),
        (lambda h: h.update({"PointMass_a": {"n": 3, "m": 2.0}}), "PointMass_a: has no counterpart"),
        (lambda h: [h.pop(n) for n in list(h) if n.startswith("ShaftElement")], "no ShaftElement"),
        (lambda h: [h.pop(n) for n in list(h) if n.startswith("BearingElement")], "no bearing"),
    ],
)
def test_what_has_no_counterpart_is_named(
    change: Callable[[dict[str, Any]], object], said: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=said):
        bd.read_ross(changed(tmp_path, change))


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[[", b"\xff\xfe", b"a = 1", b"[]", b'{"a":' * 100_000, b"a." * 100_000 + b"a = 1"],
)
def test_what_is_no_rotor_is_named(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "no.toml"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"no\.toml"):
        bd.read_ross(path)
    with pytest.raises(FileNotFoundError):
        bd.read_ross(tmp_path / "absent.toml")


def test_ross_itself_agrees_where_it_is_installed(tmp_path: Path) -> None:
    try:
        import ross
    except Exception as error:  # it breaks on versions of plotly that it does not know
        pytest.skip(f"ROSS is not there: {error}")
    rotor = ross.Rotor.load(FILE)
    wanted = np.sort(rotor.run_modal(speed=200.0, num_modes=20).wn) / (2 * np.pi)
    found = np.sort(bd.modes(bd.read_ross(FILE, speed=200.0), speed=200.0, damped=True)["frequency"].values)
    wanted, found = wanted[wanted > 1.0][:8], found[found > 1.0][:8]
    assert found == pytest.approx(wanted, rel=4e-4)
