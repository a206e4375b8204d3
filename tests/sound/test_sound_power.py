"""Sound power of parts: interpolated over frequency, kept on disk, beside the equivalent radiated power."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.notice import BeyondModes, CoarsePanels, RepairedResistance, UnsureInterpolation
from bearingdyn.sound import radiators, resistance
from bearingdyn.sound.radiation import solve

F = np.linspace(400.0, 1600.0, 40)


@pytest.fixture(scope="module")
def app() -> bd.Application:
    housing = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, damping=0.01, f_max=3000.0)
    app = bd.Application()
    app.add("housing", housing.superelement())
    app.ground("housing.feet")
    app.free("housing.bore")
    return app


def asked(app: bd.Application, **more: object):
    return bd.sound_power(app, F, ["housing.bore.z"], ["housing.outside"], **({"element_size": 0.035} | more))


@pytest.fixture(scope="module")
def found(app: bd.Application):
    return asked(app)


def direct(app: bd.Application, f: float, size: float, floor: float | None = None) -> float:
    """Solved at the frequency itself, W/N²."""
    from bearingdyn.analysis import Input, linear, part_velocities

    state = linear(app)
    term = state.system.parts[0]
    given = [Input.of(state.system, "housing.bore.z")]
    (v,) = part_velocities(state, [term], np.array([f]), given)
    bodies = radiators.Radiators([term.element.skin], np.zeros((1, 3)), floor)
    surface, rows = bodies.surface(size)
    return solve(surface, rows, f, coarse=True).power(v[0, :, 0])


def test_between_the_frequencies_solved_at_the_power_is_that_of_a_direct_solution(app, found) -> None:
    """Within .05 dB at frequencies drawn at random: as much as the estimate may be."""
    for i in np.random.default_rng(5).choice(F.size, 4, replace=False):
        one = direct(app, F[i], 0.035)
        assert 10 * math.log10(found.power.values[i, 0] / one) == pytest.approx(0.0, abs=0.05)
    assert found.interpolation_error.values.max() < 0.05


def test_panels_of_one_size_are_made_once(app, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[float] = []

    def counted(skin: object, size: float):
        made.append(size)
        return panelled(skin, size)

    panelled = radiators.panelled
    monkeypatch.setattr(radiators, "panelled", counted)
    bd.sound_power(app, [100.0, 150.0, 250.0], ["housing.bore.z"], ["housing.outside"], element_size=0.05)
    assert made == [0.05]


def test_a_finer_mesh_tells_the_same(app) -> None:
    """Sides of 20 mm against 15 mm, within .1 dB."""
    for f in (300.0, 1100.0):
        assert 10 * math.log10(direct(app, f, 0.020) / direct(app, f, 0.015)) == pytest.approx(0.0, abs=0.1)


def test_equivalent_radiated_power_stands_beside_it(app, found) -> None:
    erp = bd.radiated_power(app, F, ["housing.bore.z"], ["housing.outside"]).power.values[:, 0]
    assert found.equivalent_radiated_power.values == pytest.approx(erp, rel=1e-12, abs=0.0)
    error = 10 * np.log10(erp / found.power.values)
    assert found.equivalent_error.values == pytest.approx(error)
    # a plate of .2 m is far below a plane at 400 Hz, and near it at 1600
    assert error[0, 0] > 8.0
    assert error[-1, 0] < 6.0


def test_a_result_says_up_to_where_its_parts_are_right(found) -> None:
    """The housing keeps modes to 3 kHz."""
    assert found.attrs["valid_to"] == 3000.0


def test_parts_add_up(found) -> None:
    assert found.part_power.values.sum(axis=1) == pytest.approx(found.power.values, rel=1e-9, abs=0.0)


def test_what_was_solved_is_kept(app, found, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = asked(app, cache=tmp_path)
    assert first.power.values == pytest.approx(found.power.values, rel=1e-12, abs=0.0)
    kept = sorted(tmp_path.iterdir())
    assert len(kept) == 2  # octaves up from 400 to 1600 Hz

    def never(*_: object, **__: object) -> None:
        raise AssertionError("solved again")

    monkeypatch.setattr(resistance, "solve", never)
    assert asked(app, cache=tmp_path).power.values.tolist() == first.power.values.tolist()
    with pytest.raises(AssertionError, match="solved again"):
        asked(app, cache=tmp_path, density=1.1)
    kept[0].write_bytes(b"cut")
    with pytest.raises(AssertionError, match="solved again"):
        asked(app, cache=tmp_path)


def test_pressure_at_microphones_is_that_of_the_power_far_away(app) -> None:
    """|p|²/2ρc over a sphere of 4 m around it."""
    z, w = np.polynomial.legendre.leggauss(8)
    phi = np.arange(16) * np.pi / 8
    r = np.sqrt(1 - z**2)
    u = np.stack([np.outer(r, np.cos(phi)), np.outer(r, np.sin(phi)), np.repeat(z[:, None], 16, 1)], axis=-1)
    heard = bd.sound_power(
        app, [500.0, 700.0, 1000.0], ["housing.bore.z"], ["housing.outside"], element_size=0.035,
        microphones=4.0 * u.reshape(-1, 3),
    )  # fmt: skip
    p = heard.pressure.values[:, :, 0].reshape(3, 8, 16)
    power = 16.0 * np.einsum("z,fza->f", w, np.abs(p) ** 2) * np.pi / 8 / (2 * 1.204 * 343.2)
    assert 10 * np.log10(power / heard.power.values[:, 0]) == pytest.approx(np.zeros(3), abs=0.1)


def test_pressure_at_microphones_has_the_phase_of_a_direct_solution(app) -> None:
    """Between the frequencies solved at, complex, to the .05 dB of the interpolation."""
    from bearingdyn.analysis import Input, linear, part_velocities

    at, f = np.array([[1.0, 0.3, 0.4], [-0.2, -2.0, 5.0]]), 830.0
    heard = bd.sound_power(
        app, [f, 1000.0], ["housing.bore.z"], ["housing.outside"], element_size=0.05, microphones=at
    )
    state = linear(app)
    given = [Input.of(state.system, "housing.bore.z")]
    (v,) = part_velocities(state, state.system.parts, np.array([f]), given)
    bodies = radiators.Radiators([state.system.parts[0].element.skin], np.zeros((1, 3)))
    surface, rows = bodies.surface(0.05)
    p = bd.sound.pressure_at(solve(surface, rows, f, coarse=True), at) @ v[0, :, 0]
    assert heard.pressure.values[0, :, 0] == pytest.approx(p, rel=0.006)


def test_bodies_stand_at_their_places() -> None:
    bodies = facing(0.1)
    surface, _ = bodies.surface(0.05)
    low, high = (surface.points[np.unique(surface.faces[at])][:, 2] for at in sorted(surface.bodies, key=min))
    assert high.mean() - low.mean() == pytest.approx(0.13, abs=1e-3)
    assert high.min() - low.max() == pytest.approx(0.1, abs=2e-3)  # faces fitted to .3 mm


def test_on_a_floor_a_housing_stands_on_its_feet(app) -> None:
    """The base lies on the floor and is left out; interpolated and direct agree."""
    on = bd.sound_power(
        app, [300.0, 350.0, 400.0], ["housing.bore.z"], ["housing.outside"], element_size=0.035, floor=-0.12
    )
    assert 10 * math.log10(on.power.values[1, 0] / direct(app, 350.0, 0.035, -0.12)) == pytest.approx(
        0.0, abs=0.05
    )


def test_warnings_come_before_the_work(app, monkeypatch: pytest.MonkeyPatch) -> None:
    def stop(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    ask = (["housing.bore.z"], ["housing.outside"])
    monkeypatch.setattr("bearingdyn.sound.radiating_parts.solved_octave", stop)
    with pytest.warns(BeyondModes, match="f_max = 3000 Hz"), pytest.raises(KeyboardInterrupt):
        bd.sound_power(app, [4000.0], *ask)
    with pytest.warns(CoarsePanels, match="element_size is 50 mm"), pytest.raises(KeyboardInterrupt):
        bd.sound_power(app, [2000.0], *ask, element_size=0.05)


def test_what_is_repaired_or_unsure_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    nodes = np.linspace(100.0, 200.0, 5)
    R = np.array([np.diag([1.0, -0.1])] * 5)
    octave = resistance.Octave(100.0, 200.0, nodes, R, np.zeros((5, 0, 2), complex), 0.01, 100)
    fixed = resistance._repaired(octave)
    with pytest.warns(RepairedResistance, match=r"negative power, 1\.0e\+00 of the largest"):
        resistance._warn(fixed)
    assert np.linalg.eigvalsh(fixed.resistance[0])[0] >= -1e-15

    class Swinging:
        frequency = 0.0

    def swings(surface: object, rows: object, f: float, **_: object):
        one = Swinging()
        one.resistance = f**2 * np.eye(2) * (2 + math.sin(f))
        one.shapes = np.zeros((4, 2))
        return one

    class Bodies:
        def surface(self, size: float):
            return type("S", (), {"faces": np.zeros((4, 3)), "floor": None, "extent": 1.0})(), None

        def fingerprint(self) -> str:
            return "0"

    monkeypatch.setattr(resistance, "solve", swings)
    with pytest.warns(UnsureInterpolation, match="between 500 and 1000 Hz"):
        resistance.solved_octave(
            Bodies(),
            500.0,
            1000.0,
            density=1.2,
            sound_speed=343.0,
            microphones=np.zeros((0, 3)),
            element_size=1.0,
        )


@pytest.mark.parametrize("level", [None, 3])
def test_the_polynomial_through_the_nodes_is_exact_for_polynomials(level: int | None) -> None:
    """Up to the degree that 5 points carry, and 3 of them; round-off else."""
    nodes = resistance._nodes(500.0, 1000.0, 5)
    octave = resistance.Octave(
        500.0, 1000.0, nodes, np.zeros((5, 1, 1)), np.zeros((5, 0, 1), complex), 0.01, 100
    )
    f = np.array([500.0, 555.0, 777.0, 1000.0])
    for degree in range(5 if level is None else level):
        assert octave.weights(f, level) @ nodes**degree == pytest.approx(f**degree, rel=1e-12)


def facing(gap: float) -> radiators.Radiators:
    """Two housings, one before the other."""
    skin = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, f_max=0.0).superelement().skin
    return radiators.Radiators([skin, skin], np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.03 + gap]]))


def unsure(bodies: radiators.Radiators, cache: Path) -> resistance.Octave:
    """Solved for 2500 ... 5000 Hz with a word of warning, on panels that are coarse but few."""
    with pytest.warns(UnsureInterpolation, match="between 2500 and 5000 Hz the radiation solved at"):
        return resistance.solved_octave(
            bodies, 2500.0, 5000.0, density=1.204, sound_speed=343.2, microphones=np.zeros((0, 3)),
            element_size=0.05, cache=cache,
        )  # fmt: skip


def largest_error(octave: resistance.Octave, bodies: radiators.Radiators) -> float:
    """Of single and mixed motions between the frequencies solved at, against direct solutions, dB."""
    draw = np.random.default_rng(7)
    n = bodies.coordinates
    motions = np.vstack([np.eye(n)[[0, 1, 2, n // 2]], draw.standard_normal((8, n))])
    surface, rows = bodies.surface(0.05)
    worst = 0.0
    for f in draw.uniform(octave.low, octave.high, 6):
        R = solve(surface, rows, f, coarse=True).resistance
        for v in motions:
            power, _ = octave.power(np.array([f]), v[None] + 0j)
            worst = max(worst, abs(10 * math.log10(power[0] / (0.5 * v @ R @ v))))
    return worst


def test_housings_before_one_another_are_unsure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With 17 frequencies of an octave, .43 dB seen and 6.3 dB told; what is read from disk says it again."""
    monkeypatch.setattr(resistance, "LEVELS", (5, 9, 17))
    bodies = facing(0.1)
    octave = unsure(bodies, tmp_path)
    assert 0.05 < largest_error(octave, bodies) < resistance._unsure(octave)
    monkeypatch.setattr(resistance, "solve", None)
    assert unsure(bodies, tmp_path).nodes.tolist() == octave.nodes.tolist()


@pytest.mark.slow
def test_housings_far_before_one_another_are_unsure_with_all_frequencies(tmp_path: Path) -> None:
    """At .3 m, 65 frequencies: .0046 dB seen, .065 dB told."""
    bodies = facing(0.3)
    octave = unsure(bodies, tmp_path)
    assert len(octave.nodes) == 65
    assert largest_error(octave, bodies) < resistance._unsure(octave)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"floor": 0.0}, "part 'housing' reaches down to y = -0.12"),
        ({"floor": math.nan}, "floor is nan"),
        ({"microphones": [1.0, 2.0]}, "microphones is .* places"),
        ({"microphones": [[0.0, 0.1, 0.02]]}, "at least a triangle's length"),
        ({"element_size": math.nan}, "element_size is nan; it must be a positive length"),
        ({"density": 0.0}, "density is 0.0; it must be positive"),
    ],
)
def test_bad_input_is_named(app, change, text) -> None:
    with pytest.raises(ValueError, match=text):
        bd.sound_power(
            app, [100.0], ["housing.bore.z"], ["housing.outside"], **({"element_size": 0.04} | change)
        )


def test_unknown_surfaces_and_parts_without_a_skin_are_named(app) -> None:
    with pytest.raises(ValueError, match="has no surface 'inside'"):
        bd.sound_power(app, [100.0], ["housing.bore.z"], ["housing.inside"])
    with pytest.raises(ValueError, match="it must be a list of surfaces, of at least 1"):
        bd.sound_power(app, [100.0], ["housing.bore.z"], [])
    bare = bd.Housing(0.1, 0.1, 0.03, 0.04, f_max=0.0).superelement()
    other = bd.Application()
    other.add("bare", dataclasses.replace(bare, skin=None))
    other.ground("bare.feet")
    other.free("bare.bore")
    with pytest.raises(ValueError, match="part 'bare' has surfaces but no skin"):
        bd.sound_power(other, [100.0], ["bare.bore.z"], ["bare.outside"])
