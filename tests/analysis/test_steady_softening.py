"""Steady motions of layers that soften with their amplitude: against response, march and formula."""

import numpy as np
import pytest
from tests.analysis.test_softening import LAW, RUBBER, At, mass_on_layer
from tests.analysis.test_softening_march import PLACE, driven
from tests.analysis.test_steady_state import SPEED, fitted, preloaded

import bearingdyn as bd
import rotors
from bearingdyn.analysis.steady.factored import jacobian
from bearingdyn.analysis.steady.layer_lines import SoftLayers
from bearingdyn.analysis.steady.problem import Problem
from bearingdyn.analysis.steady.torus import Lines
from bearingdyn.material import held_at
from bearingdyn.notice import BeyondSweep
from bearingdyn.system import LayerTerm

RECORD = ["shaft.end.y", "block.centre.y"]


def pulled(tones, material=RUBBER):
    """A mass on a layer under forces (N at Hz) along z; no bearing."""
    app = mass_on_layer(material)
    for size, hz in tones:
        app.load("mass.centre", (0, 0, size, 0, 0, 0), frequency=hz)
    return app


def line(found, hertz):
    """Complex amplitude of the first channel at a frequency."""
    k = int(np.abs(found["frequency"].values - hertz).argmin())
    return complex(found["amplitude"].values[k, 0])


def ringed(law, material=RUBBER):
    """The motor of the tests with a law in its layer that feels the small strains of a ball's passage."""
    app = rotors.motor(material.with_payne(law))
    app.load("shaft.end", (0, -600.0, 0, 0, 0, 0))
    return app


# the strain of the motor's layer is 4e-5
SMALL = bd.Payne(D=2.0344e6, gamma_c=2e-5, m=0.4817, Lm=0.1663e6, gamma_l=2e-5, gamma_r=8e-6)


@pytest.mark.parametrize("hz", [150.0, 260.0, 275.0])
@pytest.mark.parametrize("size", [0.5, 5.0, 20.0])
def test_one_tone_is_the_frequency_response_at_that_amplitude(size, hz):
    """Another iteration, over ln γ, finds the same; both balance to 1e-10."""
    found = bd.steady_state(pulled([(size, hz)]), speed=100.0, record=[PLACE, "layer.strain"])
    wanted = bd.frequency_response(mass_on_layer(), [hz], [PLACE], [PLACE], amplitude=size)
    assert line(found, hz) == pytest.approx(size * complex(wanted.response.values[0, 0, 0]), rel=1e-9)
    assert float(found.strain[0]) == pytest.approx(float(wanted.strain[0, 0, 0]), rel=1e-9)
    assert found.record.sel(channel="layer.strain").values == pytest.approx(float(found.strain[0]))
    # what softening turns into heat is in the balance of energy
    assert found.attrs["energy_balance"] < 1e-10


def test_a_small_motion_is_that_of_the_unbroken_rubber():
    found = bd.steady_state(pulled([(1e-7, 240.0)]), speed=100.0, record=[PLACE])
    linear = bd.steady_state(pulled([(1e-7, 240.0)], At(0.0)), speed=100.0, record=[PLACE])
    assert line(found, 240.0) == pytest.approx(line(linear, 240.0), rel=1e-9)


def test_two_tones_share_one_strain_and_its_mean_frequency():
    """Against the formula for several, E + 2 L iω/(iω + Ω), at the strain that both tones make."""
    tones = [(6.0, 230.0), (6.0, 260.0)]
    found = bd.steady_state(pulled(tones), speed=100.0, record=[PLACE])
    z = np.array([line(found, hz) for _, hz in tones])
    omega = 2 * np.pi * np.array([hz for _, hz in tones])
    mean = float(np.sqrt(np.sum(np.abs(z * omega) ** 2) / np.sum(np.abs(z) ** 2)))
    gamma = float(found.strain[0])

    class Met:
        K, density = 2e9, 1150.0

        def complex_modulus(self, w):
            return RUBBER.modulus_at(w, gamma, mean)

    for (size, hz), own in zip(tones, z, strict=True):
        linear = bd.frequency_response(mass_on_layer(Met()), [hz], [PLACE], [PLACE])
        # not all of the motion goes along z in step: the strain's own mean frequency differs by 1e-6
        assert own == pytest.approx(size * complex(linear.response.values[0, 0, 0]), rel=1e-5)
    each = [bd.frequency_response(mass_on_layer(), [hz], [PLACE], [PLACE], amplitude=s) for s, hz in tones]
    alone = np.sqrt(sum(float(one.strain[0, 0, 0]) ** 2 for one in each))
    assert abs(gamma / alone - 1) > 0.01  # not each tone's own


@pytest.mark.parametrize(
    ("tones", "kept"),
    [([(10.0, 250.0)], 46), ([(6.0, 230.0), (6.0, 260.0)], 46), ([(6.0, 200.0), (6.0, 320.0)], 40)],
)
def test_the_march_settles_in_it(tones, kept):
    """The issue's .2 %; of the march's running amplitude, its ripple."""
    found = bd.steady_state(pulled(tones), speed=100.0, record=[PLACE])
    marched, run = driven(tones, periods=240, kept=kept, steps=400, memory=10 / tones[0][1])
    for (_, hz), z in zip(tones, marched, strict=True):
        assert abs(z) == pytest.approx(abs(line(found, hz)), rel=2e-3)
    running = float(run.record.sel(channel="layer.strain").values[-1])
    assert running == pytest.approx(float(found.strain[0]), rel=3e-3)


@pytest.mark.parametrize(("size", "hz"), [(30.0, 150.0), (300.0, 150.0), (100.0, 320.0)])
def test_a_machine_on_balls_settles_in_it(monkeypatch, size, hz):
    """A shaft on preloaded bearings, .15 to 1.8 % of strain: lines, and how far the preload has sunk."""
    monkeypatch.setattr(rotors, "RUBBER", RUBBER)
    app = preloaded()
    app.load("shaft.end", (0, size, 0, 0, 0, 0), frequency=hz)
    eq = bd.equilibrium(app)
    record = ["shaft.end.y", "ring.centre.y", "ring.centre.z"]
    found = bd.steady_state(eq, speed=SPEED, record=record, harmonics=4)
    run = bd.transient(
        eq,
        speed=SPEED,
        dt=1 / hz / 400,
        settle=150 * 400,
        steps=60 * 400,
        record=[*record, "layer.strain"],
        progress=False,
    )
    k = int(np.abs(found["frequency"].values - hz).argmin())
    for channel in record[:2]:
        own = abs(found["amplitude"].sel(channel=channel).values[k])
        # Newmark's (ωΔt)²/12 at 400 steps, and the ripple of the running amplitude
        assert abs(fitted(run, channel, np.array([hz]))[0]) == pytest.approx(own, rel=5e-4)
    means = run.record.values.mean(axis=0)
    assert means[-1] == pytest.approx(float(found.strain[0]), rel=2e-3)
    sunk = found["amplitude"].sel(channel="ring.centre.z").values[0].real
    # a march has a little of the amplitude's overshoot in it, for what broke bears nothing again
    assert means[2] == pytest.approx(sunk, rel=3e-3)
    stands = float(eq.displacement("ring.centre")[2])
    assert size < 100 or abs(sunk / stands - 1) > 0.1


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CutHarmonics")  # of round-off: nothing moves
def test_multipliers_are_those_of_layers_that_keep_their_amplitude(monkeypatch):
    """All balls alike: the growth is that of the modes of a linear layer with that modulus."""
    monkeypatch.setattr(rotors, "RUBBER", RUBBER)
    found = bd.steady_state(preloaded(), speed=SPEED, record=RECORD, harmonics=12)
    assert float(found.strain[0]) < 1e-12
    rate = 2 * np.pi * float(found.base_frequency[0])
    monkeypatch.setattr(rotors, "RUBBER", held_at(RUBBER, 0.0, rate))
    values = bd.modes(bd.equilibrium(preloaded()), speed=SPEED, damped=True)["eigenvalue"].values
    # stability follows fast modes at once, and so has the slowest of them to 1e-4
    growths = np.log(np.abs(found["multipliers"].values)) * float(found.base_frequency[0])
    for growth in growths:
        assert np.abs(values.real / growth - 1).min() < 1e-3
    # as stable as with that linear layer, but for the equilibrium's modulus
    held = bd.steady_state(preloaded(), speed=SPEED, record=RECORD, harmonics=12)
    assert found.attrs["growth"] == pytest.approx(held.attrs["growth"], rel=1e-3)


def test_a_layer_held_at_its_amplitude_has_the_modulus_of_the_law():
    """A Maxwell model for stability, at the mean frequency: within what the rest misses there."""
    for gamma in (1e-4, 2e-3, 1e-2):
        for rate in (300.0, 3000.0):
            material = held_at(RUBBER, gamma, rate)
            assert material.payne is None
            met = RUBBER.modulus_at(rate, gamma, rate)
            own = material.complex_modulus(rate)
            assert abs(own - met) < 3e-3 * abs(met)


def test_what_strain_and_mean_frequency_add_is_the_derivative_of_the_force():
    """Of each of two layers, on coordinates that weigh differently: against differences of the force itself.

    Newton finds the motion with another slope too, only more slowly: the answer does not tell.
    """
    rng = np.random.default_rng(3)
    terms = tuple(
        LayerTerm("layer", RUBBER, rng.normal(size=(3, 2)), strain=rng.uniform(0.5, 2.0, 2)) for _ in range(2)
    )
    layers = SoftLayers(terms)
    omega = 2 * np.pi * np.array([0.0, 130.0, 200.0, 320.0])
    size = (len(omega), 4)
    y, dy = (1e-3 * (rng.normal(size=size) + 1j * rng.normal(size=size)) for _ in range(2))
    y[0], dy[0] = y[0].real, dy[0].real
    standing = 1e-3 * rng.normal(size=4)

    def force(step):
        at = layers.along(y + step * dy, omega, standing)
        return at.change * (y + step * dy) + at.lasting

    here, step = layers.along(y, omega, standing), 1e-5
    given = here.change * dy + here.forced(dy)
    wanted = (force(step) - force(-step)) / (2 * step)
    assert (here.strain > 1e-3).all()
    # differences: step² of the third derivative, and round-off over the step
    assert given == pytest.approx(wanted, abs=1e-8 * np.abs(wanted).max())
    without = np.abs(here.forced(dy)).max(axis=1)
    assert (without > 1e-2 * np.abs(wanted).max(axis=1)).all()


def test_the_derivative_has_the_strain_in_it():
    """As one matrix, as products and by differences of the residual, of one strain for all lines."""
    problem = Problem.of(bd.equilibrium(ringed(SMALL)))
    lines = Lines.harmonics(6)
    balance = problem.balance(lines, SPEED)
    rng = np.random.default_rng(2)
    z = problem.standing(lines)
    z[1:] += 2e-8 * (rng.normal(size=z[1:].shape) + 1j * rng.normal(size=z[1:].shape))
    pressed = balance.press(z)
    J = jacobian(balance, pressed)
    linear = balance.linearised(pressed)
    step = rng.normal(size=(2, *z.shape))
    step[1, 0] = 0.0
    dz = step[0] + 1j * step[1]
    flat = dz.view(np.float64).ravel()
    by_matrix = (J @ flat).view(np.complex128).reshape(z.shape)
    product = linear.product(flat).view(np.complex128).reshape(z.shape)
    by_product = np.linalg.solve(linear.inverse, product[..., None])[..., 0]
    h = 1e-12
    sides = [balance.residual(z + s * h * dz, balance.press(z + s * h * dz)) for s in (1, -1)]
    by_differences = (sides[0] - sides[1]) / (2 * h)
    size = np.abs(by_matrix).max()
    own = balance.receptances.of_layers
    softened = np.abs(pressed.softened.forced(dz[:, own])).max()
    assert softened > 1e-3 * np.abs(pressed.softened.change * dz[:, own]).max()
    assert np.abs(by_matrix - by_product).max() < 1e-11 * size
    # differences: of 1e-12 m in 1e-8 m, 1e-8 relative, and round-off of deflections of 1e-5 m
    assert np.abs(by_matrix - by_differences).max() < 1e-5 * size


def test_a_map_has_the_steady_motions_of_softening_layers():
    app = ringed(SMALL)
    made = bd.speed_map(
        app,
        speeds=(0.97 * SPEED, 1.03 * SPEED),
        record=RECORD,
        harmonics=10,
        points=4,
        several=False,
        progress=False,
    )
    k = int(made.sizes["point"]) // 2
    one = bd.steady_state(app, speed=float(made["speed"][k]), record=RECORD, harmonics=10)
    # a map has fewer samples a harmonic: without the law its lines are as far off, 2e-4
    assert made["strain"].values[k] == pytest.approx(one["strain"].values, rel=5e-4)
    # a map follows what bearings feel, one state also the block's torsion, which decays slowly
    sizes = np.abs(one["multipliers"].values)
    assert np.abs(sizes / made["multiplier"].values[k] - 1).min() < 1e-4
    assert sizes[0] == pytest.approx(one.attrs["multiplier"], rel=1e-12)
    orders = made["amplitude"].values[k, 1:6]
    assert orders == pytest.approx(one["amplitude"].values[1:6], rel=1e-3)


def test_a_strain_beyond_the_sweep_is_said():
    law = bd.Payne(**{**vars(LAW), "strains": (1.5e-3, 1e-2)})
    with pytest.warns(BeyondSweep, match=r"layer 'layer' vibrates with up to .* beyond the 1 %"):
        bd.steady_state(
            pulled([(50.0, 270.0)], RUBBER.with_payne(law)), speed=100.0, record=[PLACE], stability=False
        )


def test_a_march_does_not_begin_in_it():
    app = ringed(SMALL)
    found = bd.steady_state(app, speed=SPEED, record=RECORD, harmonics=10)
    with pytest.raises(ValueError, match=r"layer 'layer' softens.*settle="):
        bd.transient(app, speed=SPEED, dt=1e-5, steps=10, record=RECORD, initial=found, progress=False)
