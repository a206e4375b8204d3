"""A part marched unreduced, with the core's history: in itself, and against its reduction in time."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from bearingdyn import Application
from bearingdyn.analysis import equilibrium, transient
from bearingdyn.cms import FullModel, RigidInterface, Superelement, Viscoelastic, march
from bearingdyn.cms.part_march import branch_weights
from bearingdyn.material import Maxwell
from bearingdyn.parts import damping_sample

RUBBER = Maxwell(1e6, [2e6, 3e6, 10e6], [1e-2, 1e-3, 1e-4], K=2e9, density=1200.0)
DT, STEPS = 4e-6, 500  # 2 ms


@dataclass(frozen=True)
class Ready:
    """A part whose superelement is at hand."""

    element: Superelement

    def superelement(self) -> Superelement:
        return self.element


def pulse() -> np.ndarray:
    """Half a millisecond of sin², N: its spectrum falls off beyond 4 kHz."""
    t = DT * np.arange(STEPS + 1)
    return np.where(t < 5e-4, 100.0 * np.sin(math.pi * t / 5e-4) ** 2, 0.0)


def push(direction: int) -> np.ndarray:
    f = np.zeros((STEPS + 1, 6))
    f[:, direction] = pulse()
    return f


@pytest.mark.parametrize("x", [1e-4, 0.1, 1.0, 30.0])
def test_branch_weights_are_the_integrals_of_the_history(x):
    """S = 2G∫e^{−(t−s)/τ} ė ds, ė linear over Δt = xτ: with m = (1 − e⁻ˣ)/x, 2Gτ(m − e⁻ˣ) and 2Gτ(1 − m)."""
    tau, G = 0.3, 5.0
    decay, old, now = branch_weights(x * tau, G, tau)
    m = -math.expm1(-x) / x
    assert decay == pytest.approx(math.exp(-x), rel=1e-12)
    # 1 − m cancels in this formula, x/2 out of 1
    assert old == pytest.approx(2 * G * tau * (m - math.exp(-x)), rel=1e-12 + 1e-15 / x**2)
    assert now == pytest.approx(2 * G * tau * (1 - m), rel=1e-12 + 1e-15 / x**2)


def test_harmonic_load_brings_the_complex_stiffness_and_mass():
    """A mass on a Maxwell spring: after the start has died, F/(2G*H − mω²) to the scheme's (ωΔt)²/12."""
    m, H, f = 0.5, 0.02, 200.0
    w = 2 * math.pi * f
    material = Maxwell(1e6, [3e6], [1e-3], eta0=50.0, K=1e9, density=1e3)
    model = FullModel(
        M=m * np.eye(6),
        K=np.zeros((6, 6)),
        interfaces={"a": RigidInterface(np.arange(6), np.eye(6), np.zeros(3))},
        viscoelastic=(Viscoelastic(material, H * np.eye(6)),),
        grounded=True,
    )
    dt, steps = 1 / f / 200, 200 * 30
    t = dt * np.arange(steps + 1)
    load = np.zeros((steps + 1, 6))
    load[:, 1] = np.cos(w * t)
    found = march(model, {"a": load}, dt)
    last = slice(-200, None)
    amplitude = 2 * np.mean(found.motion["a"][last, 1] * np.exp(-1j * w * t[last]))
    exact = 1 / (2 * complex(material.complex_modulus(w)) * H - m * w**2)
    # (ωΔt)²/12 = 8e-5 on each term, which add to 1.6 of their sum; the start: e^{−ζωt} is below 1e-9
    assert amplitude == pytest.approx(exact, rel=3e-4)
    assert np.abs(found.motion["a"][:, [0, 2, 3, 4, 5]]).max() == 0.0


@pytest.fixture(scope="module")
def sample():
    return replace(
        damping_sample(RUBBER, refinement=0.5), inertia=1, outputs={"rubber": (0.01875, 0.002, 0.3)}
    )


@pytest.mark.parametrize("direction", [1, 2])
def test_reduced_sample_is_within_one_percent_of_full_in_time(sample, direction):
    """A pulse on the outer ring, the inner one held; 1 %: the demanded accuracy, of the largest motion."""
    load = {"outer": push(direction)}
    full = march(sample.full_model(), load, DT, fixed=["inner"])
    error = {}
    for name, part in (
        ("several moduli", sample),
        ("one modulus", replace(sample, moduli=(1e6,), inertia=0)),
    ):
        small = march(part.superelement(), load, DT, fixed=["inner"])
        difference = [small.motion[n] - full.motion[n] for n in ("outer", "rubber")]
        largest = max(np.abs(full.motion[n][:, direction]).max() for n in ("outer", "rubber"))
        error[name] = max(np.abs(d[:, :3]).max() for d in difference) / largest
    print(f"direction {direction}: reduced against full in time: {error}")
    assert error["several moduli"] < 0.01
    if direction == 1:  # the radial shape depends on G/K; the axial one hardly
        assert error["one modulus"] > 0.05


def test_march_is_the_cores_for_a_reduced_part(sample):
    """The same superelement through an application and the C core: one scheme, so round-off of S⁻¹ only."""
    element = sample.superelement()
    own = march(element, {"outer": push(1)}, DT, fixed=["inner"], record=["outer"])
    app = Application()
    app.add("s", Ready(element))
    app.ground("s.inner")
    app.free("s.outer")
    app.load("s.outer", (0, 1, 0, 0, 0, 0), time=DT * np.arange(STEPS + 1), value=pulse())
    run = transient(equilibrium(app), speed=0.0, dt=DT, steps=STEPS, record=["s.outer.y"])
    rows = np.rint(run.time.values / DT).astype(int)
    theirs, ours = run.record.values[:, 0], own.motion["outer"][rows, 1]
    # 1e-8: condition of the modal form, whose largest ω² is 1e13 of the smallest
    np.testing.assert_allclose(theirs, ours, atol=1e-8 * np.abs(ours).max())


class Loss:
    def complex_modulus(self, omega):
        return 1e6 * (1 + 0.1j) * np.ones_like(np.asarray(omega))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"dt": 0.0}, "dt is 0.0"),
        ({"dt": math.nan}, "dt is nan"),
        ({"fixed": ["nose"]}, "fixed has 'nose'"),
        ({"loads": {"nose": push(1)}}, "no moving interface or output 'nose'"),
        ({"loads": {"inner": push(1)}}, "no moving interface or output 'inner'"),
        ({"record": ["nose"]}, "no moving interface or output 'nose'"),
        ({"loads": {"outer": push(1)[:, :3]}}, r"loads\['outer'\] has shape"),
        ({"loads": {"outer": np.full((4, 6), math.nan)}}, r"loads\['outer'\] has shape .* finite"),
        ({"loads": {"outer": push(1), "rubber": np.zeros((3, 3))}}, "loads have lengths"),
    ],
)
def test_march_names_what_is_wrong(sample, change, message):
    given = {"model": sample.superelement(), "loads": {"outer": push(1)}, "dt": DT, "fixed": ["inner"]}
    with pytest.raises(ValueError, match=message):
        march(**(given | change))


def test_material_without_branches_is_refused_in_time(sample):
    element = sample.superelement()
    lossy = replace(element, viscoelastic=(Viscoelastic(Loss(), element.viscoelastic[0].H),))
    with pytest.raises(ValueError, match="needs a Maxwell model"):
        march(lossy, {"outer": push(1)}, DT, fixed=["inner"])
