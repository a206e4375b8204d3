"""The assembled system: what is held, what is free, and what other coordinates leave as it was."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg

from bearingdyn.analysis import equilibrium, frequency_response, modes, transient
from bearingdyn.application import Application
from bearingdyn.bearing import BallBearing
from bearingdyn.fem import Section
from bearingdyn.material import Maxwell
from bearingdyn.parts import Layer, RigidBody, Ring, Shaft
from bearingdyn.system import System, assemble

RUBBER = Maxwell(G0=1e6, G=[2e6, 3e6], tau=[1e-3, 1e-5], eta0=5.0, K=2e9, density=1200.0)
CREEPING = Maxwell(G0=0.0, G=[2e6, 3e6], tau=[1e-3, 1e-5], K=2e9, density=1200.0)
BEARING = BallBearing(8, 12.303e-3, 52e-3, 0.52, 0.53, clearance=10e-6, damping=30.0)
ROTOR = RigidBody(2.0, (0.01, 0.01, 0.005), rotating=True)
BLOCK = RigidBody(10.0, (0.1, 0.12, 0.13))
RING = RigidBody.ring(0.03, 0.036, 0.019)
DIRECTIONS = ("x", "y", "z", "θx", "θy", "θz")


def layer(material: Maxwell = RUBBER) -> Layer:
    # shapes at given moduli: one small mesh for both materials
    return Layer(0.036, 0.039, 0.019, material, moduli=(1e6, 6e6), refinement=0.5)


def layered_rotor(material: Maxwell = RUBBER, springs: float | None = 1e8) -> Application:
    """A rotor in one bearing, its outer ring in a layer, that in a block on springs (or on nothing)."""
    app = Application()
    app.add("rotor", ROTOR)
    app.add("ring", RING)
    app.add("layer", layer(material))
    app.add("block", BLOCK)
    app.connect("ring.centre", "layer.inner")
    app.connect("layer.outer", "block.centre")
    app.bearing("front", BEARING, inner="rotor.centre", outer="ring.centre")
    if springs is not None:
        app.ground("block.centre", stiffness=(springs,) * 3 + (springs * 1e-3,) * 3)
    return app


@pytest.fixture(scope="module")
def system() -> System:
    return assemble(layered_rotor())


class TestFreeMotions:
    def test_a_shaft_on_no_bearing_is_named(self):
        app = layered_rotor()
        app.add("shaft", Shaft([Section(0.2, 0.02)], seats={"seat": 0.1}, f_max=3e3))
        app.free("shaft.seat")
        with pytest.raises(
            ValueError, match=r"'shaft' is free to move in (x|y|z|θx|θy) \(seen at shaft\.seat\)"
        ):
            assemble(app)

    def test_a_housing_on_no_ground_is_named(self):
        app = layered_rotor(springs=None)
        with pytest.raises(ValueError, match=r"'(rotor|ring|layer|block)' is free to move in"):
            assemble(app)

    @pytest.mark.parametrize("missing", range(6))
    def test_five_springs_leave_one_direction(self, missing):
        springs = np.array([1e6, 1e6, 1e6, 1e3, 1e3, 1e3])
        springs[missing] = 0.0
        app = Application()
        app.add("body", BLOCK)
        app.ground("body.centre", stiffness=springs)
        load = np.zeros(6)
        load[missing] = 1.0
        app.load("body.centre", load)
        # about z a body may spin, but a torque may not turn it
        message = (
            f"'body' is free to move in {DIRECTIONS[missing]} " if missing < 5 else "turns a shaft about z"
        )
        with pytest.raises(ValueError, match=message):
            assemble(app)

    def test_free_spin_is_accepted_and_its_torque_refused(self, system):
        free = system.free_motions()
        assert free.shape[1] == 1
        motion = system.rows("rotor.centre") @ free[:, 0]
        # nothing but the rotor turns, and only about z: unit modal mass over its Iz
        np.testing.assert_allclose(np.abs(motion), [0, 0, 0, 0, 0, 1 / math.sqrt(0.005)], atol=1e-9)
        app = layered_rotor()
        app.load("rotor.centre", (0, -10.0, 5.0, 0, 0, 1.0))
        with pytest.raises(ValueError, match="constant load turns a shaft about z"):
            assemble(app)

    def test_a_free_body_without_loads_may_be_analysed(self):
        app = Application()
        app.add("body", BLOCK)
        app.free("body.centre")
        assert assemble(app).free_motions().shape == (6, 6)

    @pytest.mark.parametrize("springs", [1e2, 1e4, 1e10])
    def test_a_soft_suspension_holds_whatever_the_layers_inner_modes(self, springs):
        # the layer's own inner mode lies at 1 MHz, the suspension down to 0.5 Hz: ω² in a ratio of 1e-13
        app = layered_rotor(springs=springs)
        app.load("rotor.centre", (0, -100.0, 0, 0, 0, 0))
        state = equilibrium(app)
        # statics does not care for inertia: F/k; round-off of the layer's 1e8 N/m over 1e2 N/m leaves 1e-9
        np.testing.assert_allclose(state.displacement("block.centre")[1], -100.0 / springs, rtol=1e-8)
        # the free spin stays where it was
        assert abs(state.displacement("rotor.centre")[5]) < 1e-12

    def test_everything_grounded_leaves_nothing(self):
        app = Application()
        app.add("body", BLOCK)
        app.ground("body.centre")
        with pytest.raises(ValueError, match="nothing is left to move"):
            assemble(app)

    def test_a_connection_to_a_grounded_interface_is_grounded(self):
        app = layered_rotor(springs=None)
        app.ground("block.centre")
        assert not assemble(app).rows("layer.outer").any()


class TestCreep:
    """A layer without relaxed modulus cannot carry a constant load."""

    @pytest.mark.parametrize("load", [(0, -100, 0, 0, 0, 0), (0, 0, 50, 0, 0, 0), (100, 0, 0, 0, 0, 0)])
    def test_dead_load_through_a_creeping_layer_is_refused(self, load):
        app = layered_rotor(CREEPING)
        app.load("rotor.centre", load)
        with pytest.raises(ValueError, match=r"layer 'layer' has G0 = 0.*creeps"):
            assemble(app)

    def test_springs_in_one_direction_do_not_carry_another(self):
        # the reduced shapes resist a change of volume, which would feign a radial stiffness
        app = layered_rotor(CREEPING)
        app.ground("ring.centre", stiffness=(0, 0, 1e7, 1e4, 1e4, 1e4))
        app.load("rotor.centre", (0, -100, 0, 0, 0, 0))
        with pytest.raises(ValueError, match="G0 = 0"):
            assemble(app)

    def test_springs_beside_the_layer_carry_the_load(self):
        app = layered_rotor(CREEPING)
        app.ground("ring.centre", stiffness=(1e7, 1e7, 1e7, 1e4, 1e4, 1e4))
        app.load("rotor.centre", (0, 0, 100.0, 0, 0, 0))
        # 100 N on 1e7 N/m; the layer's axial shapes keep 1e-5 of that as a resistance to volume
        assert equilibrium(app).displacement("ring.centre")[2] == pytest.approx(1e-5, rel=1e-4)

    def test_a_shaft_beside_the_layer_carries_the_load(self):
        deflection = []
        for with_layer in (False, True):
            app = Application()
            app.add("shaft", Shaft([Section(0.1, 0.02)], seats={"free": 0.0, "held": 0.1}, f_max=3e3))
            app.ground("shaft.held")
            if with_layer:
                app.add("layer", layer(CREEPING))
                app.connect("shaft.free", "layer.inner", fits=False)  # a hub between them is left out
                app.ground("layer.outer")
            else:
                app.free("shaft.free")
            app.load("shaft.free", (0, 100.0, 0, 0, 0, 0))
            deflection.append(equilibrium(app).displacement("shaft.free")[1])
        bending = 100 * 0.1**3 / (3 * 210e9 * math.pi / 64 * 0.02**4)
        k = 6 * 1.3**2 / (7 + 12 * 0.3 + 4 * 0.3**2)
        shear = 100 * 0.1 / (k * 210e9 / 2.6 * math.pi / 4 * 0.02**2)
        # a Timoshenko cantilever, exact at its nodes; round-off of its short elements
        assert deflection[0] == pytest.approx(bending + shear, rel=1e-6)
        # what the creeping layer's shapes resist to volume
        assert deflection[1] == pytest.approx(deflection[0], rel=1e-3)

    def test_without_dead_load_a_creeping_layer_is_no_obstacle(self):
        app = layered_rotor(CREEPING)
        app.load("rotor.centre", (0, 10.0, 0, 0, 0, 0), frequency=100.0)
        assert not equilibrium(app).x.any()


class TestTurning:
    """Damping of a part that turns with the shaft needs its circulatory forces; only a Shaft has them."""

    @staticmethod
    def rotor_with(part, interface: str) -> Application:
        app = Application()
        app.add("rotor", ROTOR)
        app.add("cap", RigidBody(0.1, (1e-4,) * 3))
        app.add("part", part)
        app.connect("rotor.centre", f"part.{interface}")
        app.free("cap.centre")
        app.free("part.outer")
        return app

    def test_a_layer_on_the_shaft_is_refused_at_speed(self):
        system = assemble(self.rotor_with(layer(), "inner"))
        system.check_speed(0.0)
        for call in (
            lambda: frequency_response(system, [10.0], ["rotor.centre.y"], ["rotor.centre.y"], speed=1.0),
            lambda: modes(system, speed=1.0, damped=True),
            lambda: transient(system, speed=1.0, dt=1e-5, steps=1, record=[]),
        ):
            with pytest.raises(ValueError, match=r"'part' turns with the shaft"):
                call()

    def test_a_damped_ring_on_the_shaft_likewise_but_not_an_undamped_one(self):
        damped = assemble(self.rotor_with(Ring(0.02, 0.03, 0.01, damping=0.01), "inner"))
        with pytest.raises(ValueError, match=r"'part' turns with the shaft"):
            damped.check_speed(100.0)
        assemble(self.rotor_with(Ring(0.02, 0.03, 0.01), "inner")).check_speed(100.0)

    def test_a_layer_outside_the_bearings_and_a_damped_shaft_may_turn(self, system):
        system.check_speed(500.0)
        app = layered_rotor()
        app.add("shaft", Shaft([Section(0.2, 0.02)], seats={"seat": 0.1}, damping=0.01, f_max=3e3))
        app.connect("shaft.seat", "rotor.centre")
        assemble(app).check_speed(500.0)
        assert app.plan.turning_parts() == {"shaft", "rotor"}


class TestModalCoordinates:
    def test_mass_is_identity_and_relaxed_stiffness_diagonal_to_the_last_bit(self, system):
        modal, _ = system.modal()
        assert np.array_equal(modal.M, np.eye(system.n))
        K = modal.stiffness()
        assert np.array_equal(K, np.diag(np.diag(K)))

    def test_modes_diagonalise_the_given_matrices(self, system):
        modal, T = system.modal()
        # round-off of n terms
        np.testing.assert_allclose(T.T @ system.M @ T, np.eye(system.n), atol=1e-11)
        K = T.T @ system.stiffness() @ T
        np.testing.assert_allclose(K, modal.stiffness(), atol=1e-11 * np.abs(K).max())

    def test_modes_stay_in_their_block(self, system):
        blocks = system.blocks()
        assert sorted(np.concatenate(blocks)) == list(range(system.n))
        # the rotor's x, y, z and θz; θx with θy, coupled by its spin; of ring, layer and block x with θy, y
        # with θx, z, θz, as a round layer couples them
        assert len(blocks) == 9
        T = system.modal()[1]
        for block in blocks:
            outside = np.setdiff1d(np.arange(system.n), block)
            assert not T[np.ix_(outside, block)].any()

    def test_congruence_of_every_matrix(self, system):
        T = np.random.default_rng(1).standard_normal((system.n, 4))
        small = system.transformed(T)
        for name in ("M", "C", "K", "G", "N"):
            A = getattr(system, name)
            np.testing.assert_array_equal(getattr(small, name), T.T @ A @ T)
        np.testing.assert_allclose(small.B, system.B @ T, rtol=1e-13)
        for rate in ("stiffness", "viscous"):
            A = getattr(system, rate)()
            np.testing.assert_allclose(
                getattr(small, rate)(), T.T @ A @ T, rtol=1e-9, atol=1e-12 * np.abs(A).max()
            )
        np.testing.assert_allclose(small.row("ring.centre.θx"), system.row("ring.centre.θx") @ T)

    def test_layer_factor_gives_back_the_deviatoric_matrix(self, system):
        element = layer().superelement()
        term = system.layers[0]
        where = np.vstack([system.rows("ring.centre"), system.rows("block.centre")])
        H = where @ term.L @ term.L.T @ where.T
        wanted = element.viscoelastic[0].H[:12, :12]
        # what falls below the rank decision is 1e-11 of the scaled matrix
        np.testing.assert_allclose(H, wanted, atol=1e-10 * np.abs(wanted).max())
        # six rigid motions do not strain it
        assert term.L.shape[1] == element.n - 6

    def test_relaxed_and_instantaneous_modulus(self, system):
        difference = system.stiffness("instantaneous") - system.stiffness("relaxed")
        L = system.layers[0].L
        # G0 + ΣG − G0 = 5 MPa; paper (6) with theory: G0 is the relaxed one
        np.testing.assert_allclose(difference, 2 * 5e6 * L @ L.T, atol=1e-12 * np.abs(difference).max())
        with pytest.raises(ValueError, match="modulus is 'static'"):
            system.stiffness("static")

    def test_dashpot_beside_the_branches_is_viscous(self, system):
        L = system.layers[0].L
        np.testing.assert_allclose(system.viscous() - system.C, 2 * 5.0 * L @ L.T, atol=1e-12)


class TestAssembly:
    def test_mass_of_the_whole(self, system):
        y = np.zeros(system.n)
        for name in ("rotor.centre", "ring.centre", "block.centre"):
            y += system.row(f"{name}.y")
        density = 7850.0 * (0.036**2 - 0.03**2) + 1200.0 * (0.039**2 - 0.036**2)
        # the mesh integrates the mass of a ring exactly
        assert y @ system.M @ y == pytest.approx(12.0 + density * math.pi * 0.019, rel=1e-9)

    def test_connected_interfaces_move_as_one(self, system):
        assert np.array_equal(system.rows("ring.centre"), system.rows("layer.inner"))
        assert np.array_equal(system.rows("block.centre"), system.rows("layer.outer"))

    def test_bearing_sees_inner_minus_outer(self, system):
        q = np.arange(1.0, 7.0)
        x = np.linalg.pinv(system.rows("rotor.centre")) @ q
        np.testing.assert_allclose(system.B @ x, BEARING.relative(q), rtol=1e-12)
        x = np.linalg.pinv(system.rows("ring.centre")) @ q
        np.testing.assert_allclose(system.B @ x, -BEARING.relative(q), rtol=1e-12)

    def test_loads_act_through_their_rows(self):
        app = layered_rotor()
        app.load("rotor.centre", (1, 2, 3, 4, 5, 0))
        app.load("ring.centre", (0, 1, 0, 0, 0, 0), frequency=50.0, phase=0.5)
        app.unbalance("rotor.centre", 2e-4, phase=math.pi / 2)
        constant, harmonic, rotating = assemble(app).loads
        s = assemble(app)
        np.testing.assert_array_equal(s.rows("rotor.centre") @ constant.p_cos, [1, 2, 3, 4, 5, 0])
        # cos(ωt + φ) = cos φ cos ωt − sin φ sin ωt
        assert harmonic.omega == pytest.approx(100 * math.pi, rel=1e-15)
        assert s.row("ring.centre.y") @ harmonic.p_cos == pytest.approx(math.cos(0.5))
        assert s.row("ring.centre.y") @ harmonic.p_sin == pytest.approx(-math.sin(0.5))
        # a quarter turn on from x: u (cos(θ + π/2), sin(θ + π/2)) = u (−sin θ, cos θ)
        xy = [s.row("rotor.centre.x"), s.row("rotor.centre.y")]
        np.testing.assert_allclose([r @ rotating.p_cos for r in xy], [0, 2e-4], atol=1e-19)
        np.testing.assert_allclose([r @ rotating.p_sin for r in xy], [-2e-4, 0], atol=1e-19)

    def test_support_springs_and_dampers_stand_on_the_diagonal(self):
        app = Application()
        app.add("body", BLOCK)
        k, c = np.arange(1.0, 7.0) * 1e5, np.arange(6.0)
        app.ground("body.centre", stiffness=k, damping=c)
        s = assemble(app)
        np.testing.assert_array_equal(s.K, np.diag(k))
        np.testing.assert_array_equal(s.C, np.diag(c))
        np.testing.assert_array_equal(s.M, np.diag([10.0] * 3 + [0.1, 0.12, 0.13]))

    def test_a_mixture_of_parts_is_the_sum_of_their_energies(self, system):
        """Kinetic energy of a random motion, part by part, without the assembler."""
        x = np.random.default_rng(3).standard_normal(system.n)
        total = 0.0
        for name, part in (("rotor.centre", ROTOR), ("ring.centre", RING), ("block.centre", BLOCK)):
            v = system.rows(name) @ x
            total += v @ np.diag([part.mass] * 3 + list(part.inertia)) @ v
        element = layer().superelement()
        inner = np.setdiff1d(np.arange(system.n), np.flatnonzero(np.abs(_rigid_rows(system)).sum(axis=0)))
        u = np.concatenate([system.rows("layer.inner") @ x, system.rows("layer.outer") @ x, x[inner]])
        total += u @ element.M @ u
        assert x @ system.M @ x == pytest.approx(total, rel=1e-12)

    @pytest.mark.parametrize(
        ("channel", "message"),
        [("rotor.centre.w", "not 'w'"), ("rotor.y", "'rotor' is no interface"), ("y", "no interface")],
    )
    def test_channels_are_checked(self, system, channel, message):
        with pytest.raises(ValueError, match=message):
            system.row(channel)

    def test_rotations_have_two_names(self, system):
        assert np.array_equal(system.row("rotor.centre.rx"), system.row("rotor.centre.θx"))

    def test_a_body_without_mass_is_named(self):
        from bearingdyn.cms import Superelement

        class Massless:
            def superelement(self) -> Superelement:
                zero = np.zeros((6, 6))
                return Superelement(
                    M=np.diag([1.0, 1, 1, 0, 1, 1]),
                    C=zero,
                    G=zero,
                    K=zero,
                    interfaces={"hub": np.arange(6)},
                )

        app = Application()
        app.add("thing", Massless())
        app.ground("thing.hub", stiffness=(1e6,) * 6)
        with pytest.raises(ValueError, match=r"no mass.*thing\.hub\.θx"):
            assemble(app)


def _rigid_rows(system: System) -> np.ndarray:
    return np.vstack([system.rows(n) for n in ("rotor.centre", "ring.centre", "block.centre")])


def test_natural_modes_agree_with_lapack_where_lapack_can_tell(system):
    """The second look at the slow modes changes only what the first could not resolve."""
    squares = scipy.linalg.eigh(system.stiffness(), system.M, eigvals_only=True)
    ours = np.sort(np.diag(system.modal()[0].stiffness()))
    # LAPACK's absolute error: round-off of the largest
    np.testing.assert_allclose(ours, squares, rtol=1e-9, atol=1e-13 * squares[-1])


def test_gyroscopic_matrix_keeps_its_sign(system):
    """Mx = It θ̈x + Ip Ω θ̇y (reference page §1): G[θx, θy] = +Ip, whatever the assembler does."""
    rows = system.rows("rotor.centre")
    G = rows @ system.G @ rows.T
    wanted = np.zeros((6, 6))
    wanted[3, 4], wanted[4, 3] = 0.005, -0.005
    np.testing.assert_array_equal(G, wanted)


# ------------------------------------------------------------------- what matrices a system may have


@pytest.mark.parametrize(
    ("name", "i", "j", "change", "message"),
    [
        ("M", 3, 1, 0.01, r"M\[1, 3\] is 0 and M\[3, 1\] is 0\.01; M must be symmetric"),
        ("C", 0, 2, 0.5, r"C\[0, 2\] is .*; C must be symmetric"),
        ("K", 4, 2, 1e3, r"K\[2, 4\] is .*; K must be symmetric"),
        ("G", 3, 4, 0.2, r"G\[3, 4\] is 0\.2 and G\[4, 3\] is 0; G must be skew-symmetric"),
        ("N", 1, 1, 0.2, r"N\[1, 1\] is 0\.2 and N\[1, 1\] is 0\.2; N must be skew-symmetric"),
        ("K", 2, 2, math.nan, r"K\[2, 2\] is nan; every entry must be finite"),
    ],
)
def test_a_matrix_that_breaks_its_symmetry_is_named_with_its_entry(name, i, j, change, message):
    good = {k: np.diag([1.0, 2.0, 3.0, 4.0, 5.0]) * (k in "MCK") for k in "MCGKN"}
    good["G"][0, 1], good["G"][1, 0] = 0.1, -0.1
    System(**good)
    good[name][i, j] += change
    with pytest.raises(ValueError, match=message):
        System(**good)


def test_a_symmetric_gyroscopic_matrix_is_refused(system):
    """It would do work on a whirl: ẋᵀGẋ vanishes for every ẋ only where G is skew."""
    with pytest.raises(ValueError, match="G must be skew-symmetric"):
        replace(system, G=np.abs(system.G))


def test_matrices_of_unequal_size_are_named():
    zero = np.zeros((3, 3))
    with pytest.raises(ValueError, match=r"N has the shape \(2, 2\); it must be \(3, 3\), as M"):
        System(M=np.eye(3), C=zero, G=zero, K=zero, N=np.zeros((2, 2)))


def test_a_system_is_made_by_names():
    zero = np.zeros((3, 3))
    with pytest.raises(TypeError, match="positional"):
        System(np.eye(3), zero, zero, zero, zero)


def test_symmetry_outlasts_every_change_of_coordinates(system):
    """Round-off of TᵀAT is far below what is refused: 1e-9 of the largest entry."""
    rng = np.random.default_rng(5)
    # coordinates in mm beside m, and turned
    T = np.linalg.qr(rng.standard_normal((system.n, system.n)))[0] * np.geomspace(1e-3, 1.0, system.n)
    for changed in (system.transformed(T), system.modal()[0]):
        for name, sign in (("M", 1), ("C", 1), ("G", -1), ("K", 1), ("N", -1)):
            A = getattr(changed, name)
            assert np.abs(A - sign * A.T).max() <= 1e-12 * max(np.abs(A).max(), 1e-300)
