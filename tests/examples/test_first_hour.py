"""examples/first_hour.py: short enough for a newcomer, and its peak is that of a rigid rotor on springs."""

from __future__ import annotations

import ast
import re
import runpy
import warnings
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import scipy.optimize

import bearingdyn as bd
from bearingdyn.notice import BeyondData

matplotlib.use("Agg")

SCRIPT = Path(__file__).resolve().parents[2] / "examples" / "first_hour.py"


def test_the_first_hour_takes_under_30_lines_of_python() -> None:
    text = SCRIPT.read_text(encoding="utf-8")
    prose = ast.parse(text).body[0].end_lineno
    assert prose is not None
    lines = [line for line in text.splitlines()[prose:] if line.strip() and not line.strip().startswith("#")]
    assert len(lines) < 30  # the figure


class RigidRotor:
    """A rigid cylinder on two springs, each a bearing and a layer in series, in (y, z, θx).

    No finite elements but those of the layer, which is solved anew at every G*(ω).
    """

    def __init__(self, ball: bd.BallBearing, layer: bd.Layer | None) -> None:
        self.layer = layer
        # a cylinder with a journal at either end, 75 mm from the middle
        body, journal = (7850.0 * np.pi / 4 * d**2 * length for d, length in ((0.066, 0.10), (0.025, 0.05)))
        across = body * (3 * 0.033**2 + 0.10**2) / 12
        across += 2 * journal * ((3 * 0.0125**2 + 0.05**2) / 12 + 0.075**2)
        self.M = np.diag([body + 2 * journal] * 2 + [across])
        tilting = 0.0 if layer is None else layer.stiffness(0.0)[3, 3].real
        scale = np.array([1e-5, 1e-4, 1e-3])

        def motion(u: np.ndarray) -> np.ndarray:
            return np.array([0.0, *(u * scale), 0.0, 0.0])

        def balance(u: np.ndarray) -> list[float]:
            # the shaft stays level under its middle load; the ring tilts on its layer, or not at all
            f = ball.force(motion(u))
            return [f[1] / 250 + 1, f[2] / 100 - 1, f[3] + tilting * u[2] * scale[2] if layer else u[2]]

        found = scipy.optimize.root(balance, [-1.0, 1.0, 0.0])
        assert found.success
        self.K = ball.stiffness(motion(found.x))[1:4, 1:4]

    def receptance(self, frequency: float) -> float:
        omega = 2 * np.pi * frequency
        compliance = np.linalg.inv(self.K).astype(complex)
        if self.layer is not None:
            compliance += np.linalg.inv(self.layer.stiffness(omega)[1:4, 1:4])
        k = np.linalg.inv(compliance)
        D = -(omega**2) * self.M.astype(complex)
        for z in (-0.06, 0.06):  # a point on the axis moves by y − z θx
            T = np.array([[1, 0, -z], [0, 1, 0], [0, 0, 1]])
            D += T.T @ k @ T
        return float(abs(np.linalg.inv(D)[0, 0]))


def test_the_rotor_of_the_first_hour_peaks_where_a_rigid_one_on_springs_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error", BeyondData)
        names = runpy.run_path(str(SCRIPT))
    printed = re.findall(
        r"^(no layer|layer): (\S+) m/N \(zero-to-peak\) at (\d+) Hz$", capsys.readouterr().out, re.M
    )
    found = {label: (float(level), float(f)) for label, level, f in printed}
    assert (tmp_path / "out" / "first_hour.png").stat().st_size > 10_000
    assert (tmp_path / "out" / "my_rubber.csv").is_file()

    f = np.arange(500.0, 650.0, 5.0)
    on_layers = RigidRotor(names["ball"], names["layer"])
    H = [on_layers.receptance(x) for x in f]
    # the bending of the shaft, whose first free mode lies at 6 kHz, is what the estimate leaves out: (0.6/6)²
    assert found["layer"][1] == pytest.approx(f[np.argmax(H)], rel=0.02)
    assert found["layer"][0] == pytest.approx(max(H), rel=0.04)
    # without layers; the height of a peak is left to damping
    f = np.arange(900.0, 1500.0, 1.0)
    plain = RigidRotor(names["ball"], None)
    peaks = f[1:-1][[H[1] > max(H[0], H[2]) for H in triples([plain.receptance(x) for x in f])]]
    assert np.abs(peaks / found["no layer"][1] - 1).min() < 0.04  # (1.2/6)²
    # far below resonance the compliance, to which bending and shear of the shaft between its seats add
    # by Castigliano: ½∫x²/EI dx + ½∫dx/κGA from a seat to the middle, the first 10 mm of it journal
    shaft = 0.0
    for d, start, end in ((0.025, 0.0, 0.01), (0.066, 0.01, 0.06)):
        shaft += (end**3 - start**3) / (6 * 210e9 * np.pi / 64 * d**4)
        shaft += (end - start) / (2 * 0.886 * 80.8e9 * np.pi / 4 * d**2)
    low = abs(names["responses"]["no layer"]["response"]).values[0, 0, 0]
    assert low == pytest.approx(plain.receptance(10.0) + shaft, rel=0.01)


def triples(values: list[float]) -> list[tuple[float, float, float]]:
    return list(zip(values, values[1:], values[2:], strict=False))
