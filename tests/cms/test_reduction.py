"""A reduction against the model it comes from: exact where it claims to be, and its error known elsewhere."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from bearingdyn.cms import (
    Dynamics,
    FullModel,
    RigidInterface,
    Viscoelastic,
    basis_of,
    craig_bampton,
    modulus_levels,
    project,
    reduce,
    reduce_free_body,
    reduction_error,
)
from bearingdyn.fem import Section, assemble_beam, rigid_transfer
from bearingdyn.material import STEEL, Elastic, Maxwell, fit_maxwell, master_curve
from bearingdyn.parts import Layer, damping_sample
from measured import measured

# |G*| from 1 MPa at rest to 15.8 MPa at 5 kHz, of 16 MPa in all: the whole range lies in the band
RUBBER = Maxwell(1e6, [2e6, 3e6, 10e6], [1e-2, 1e-3, 1e-4], K=2e9, density=1200.0)
BAND = np.unique(np.r_[np.geomspace(5.0, 5e3, 6), np.linspace(1e3, 5e3, 5)])


def beam(n=24, L=0.3, d=0.02, soft=(10, 14), **change) -> FullModel:
    """A free beam whose middle elements also have a viscoelastic part, with a seat at either end."""
    z = np.linspace(0.0, L, n + 1)
    M, _, K = assemble_beam(z, [Section(L, d)] * n, STEEL)
    H = scipy.sparse.lil_matrix(K.shape)
    at = slice(6 * soft[0], 6 * soft[1] + 6)
    part = assemble_beam(z[soft[0] : soft[1] + 1], [Section(L, d)] * (soft[1] - soft[0]), STEEL)[2]
    H[at, at] = part / (2.0 * STEEL.G)
    given = {
        "M": M,
        "K": K,
        "interfaces": {
            name: RigidInterface(6 * i + np.arange(6), np.eye(6), np.array([0.0, 0.0, z[i]]))
            for name, i in (("a", 2), ("b", n - 2))
        },
        "outputs": {"end": np.eye(6, 6 * n + 6), "middle": np.eye(6, 6 * n + 6, 6 * (n // 2))[:3]},
        "viscoelastic": (Viscoelastic(Maxwell(1e9, [6e10], [2e-4], K=1e11, density=1e3), H.tocsr()),),
    }
    return FullModel(**(given | change))


def chain(n=40, k=1e6, m=0.1):
    K = k * scipy.sparse.diags(
        [np.r_[1.0, 2.0 * np.ones(n - 2), 1.0], -np.ones(n - 1), -np.ones(n - 1)], [0, 1, -1]
    )
    return m * scipy.sparse.eye(n), K


def test_transfer_of_a_full_model_is_that_of_its_dense_matrices():
    """Dynamic stiffness and receptance from one dense solve with the interfaces' coordinates free."""
    model, omega = beam(), 2 * math.pi * 700.0
    rows = scipy.sparse.vstack(list(model.outputs.values()))
    rng = np.random.default_rng(2)
    B, c = rng.standard_normal((model.n, 3)), np.diag([30.0, 10.0, 2.0])
    t = Dynamics(model, rows, (B, c)).solve(omega)[0]
    G = model.viscoelastic[0].material.complex_modulus(omega)
    Z = model.stiffness([complex(G)]).toarray() - omega**2 * model.M.toarray() + 1j * omega * B @ c @ B.T
    b = np.concatenate([f.dofs for f in model.interfaces.values()])
    R = rows.toarray()
    everything = np.linalg.inv(Z)
    D = np.linalg.inv(everything[np.ix_(b, b)])
    # 1e-9: condition 1e6 of a beam's stiffness in metres and radians, a hundred times round-off
    np.testing.assert_allclose(t.D, D, atol=1e-9 * np.abs(D).max())
    free = np.arange(6)  # the second seat held: remove its coordinates
    keep = np.setdiff1d(np.arange(model.n), b[6:])
    inverse = np.linalg.inv(Z[np.ix_(keep, keep)])
    S = np.vstack([np.eye(model.n)[b[:6]], R])[:, keep]
    Y = S @ inverse @ S.T
    np.testing.assert_allclose(t.receptance(free), Y, atol=1e-9 * np.abs(Y).max())


def test_each_round_of_inertia_shapes_adds_four_orders_of_frequency():
    """Without modes, the dynamic stiffness of a chain is off as ω⁴ without a round and as ω⁸ after one."""
    M, K = chain()
    held = np.array([0, 39])

    def stiffness(omega, Psi=None):
        Z = (K - omega**2 * M).toarray()
        if Psi is not None:
            Z = Psi.T @ Z @ Psi
            i, b = np.arange(2, Psi.shape[1]), np.arange(2)
        else:
            i, b = np.setdiff1d(np.arange(40), held), held
        return Z[np.ix_(b, b)] - Z[np.ix_(b, i)] @ np.linalg.solve(Z[np.ix_(i, i)], Z[np.ix_(i, b)])

    static = craig_bampton(M, K, held, n_modes=0).Psi
    inner = np.setdiff1d(np.arange(40), held)
    K_ii, M_d = K.toarray()[np.ix_(inner, inner)], M.toarray()
    shapes, first = [static], 2 * math.sqrt(1e7) * math.sin(math.pi / 78)  # its first fixed-interface ω
    for rounds in range(2):
        Psi = np.hstack(shapes)
        error = [np.abs(stiffness(x * first) - stiffness(x * first, Psi)).max() for x in (0.1, 0.2)]
        slope = math.log2(error[1] / error[0])
        # the poles of the first mode in the full and the reduced model add 2 log₂(0.99/0.96) = 0.09
        assert slope == pytest.approx(4 * (rounds + 1), abs=0.15)
        u = np.zeros((40, 2))
        u[inner] = np.linalg.solve(K_ii, (M_d @ shapes[-1])[inner])
        shapes.append(u / np.abs(u).max())

    # and `basis_of` spans just these shapes
    model = beam(viscoelastic=())
    dynamics = Dynamics(model, scipy.sparse.csr_matrix((1, model.n)))
    exact = dynamics.solve(2 * math.pi * 150.0)[0].D
    errors = []
    for rounds in (0, 1, 2):
        small = FullModel.of(project(model, basis_of(model, n_modes=0, inertia=rounds)))
        errors.append(np.abs(Dynamics(small, np.zeros((1, small.n))).solve(2 * math.pi * 150.0)[0].D - exact))
    first = (
        math.pi**2 / 0.25**2 * math.sqrt(STEEL.E * 0.02**2 / 16 / STEEL.density)
    )  # of a pinned span, rad/s
    ratio = (2 * math.pi * 150.0 / first) ** 4
    assert errors[1].max() < 2 * ratio * errors[0].max()
    assert errors[2].max() < 2 * ratio * errors[1].max() + 1e-12 * np.abs(exact).max()


def test_reduction_without_inertia_shapes_is_craig_and_bamptons():
    model = beam(viscoelastic=())
    a = reduce(model, f_max=20e3, inertia=0, damping=0.01)
    b = reduce_free_body(model.M, model.K, model.interfaces, model.outputs, f_max=20e3, damping=0.01)
    for name in ("M", "C", "K"):
        assert np.array_equal(getattr(a, name), getattr(b, name))


@pytest.mark.parametrize("body", [Layer(0.026, 0.028, 0.016, RUBBER, refinement=0.5).body])
def test_body_of_revolution_is_its_full_model_projected(body):
    """The families' matrices side by side, projected, against the reduction family by family."""
    body = replace(body, f_max=12e3, inertia=1, outputs={"p": (0.027, 0.002, 0.7)})
    s, p = body.superelement(), project(body.full_model(), body.basis())
    order = np.arange(s.n)
    for a, b in ((s.M, p.M), (s.K, p.K), (s.viscoelastic[0].H, p.viscoelastic[0].H)):
        # sums in another order; K holds K_vol, a thousand times what it leaves of shapes that keep volume
        np.testing.assert_allclose(a, b[np.ix_(order, order)], atol=1e-11 * np.abs(a).max())
    np.testing.assert_allclose(s.rows("p"), p.rows("p"), atol=1e-9 * np.abs(s.rows("p")).max())
    full = body.full_model()
    R = np.vstack([f.T for f in full.interfaces.values()])
    assert full.n > 1000
    assert np.linalg.matrix_rank(R) == 6
    for i, face in enumerate(full.interfaces.values()):  # the shapes move the faces as the model says
        np.testing.assert_allclose(body.basis().Psi[face.dofs, 6 * i : 6 * i + 6], face.T, atol=1e-15)
    rigid = body.basis().Psi[:, :12] @ rigid_transfer([f.position for f in full.interfaces.values()])
    inertia = rigid.T @ (full.M @ rigid)
    np.testing.assert_allclose(np.diag(inertia)[:3], body.mass, rtol=1e-9)
    # a full turn of the wall: m (a² + b²)/2 about the axis
    assert inertia[5, 5] == pytest.approx(body.mass * (0.026**2 + 0.028**2) / 2, rel=1e-9)


def test_point_under_load_is_statically_exact_once_attached():
    model = beam()
    low = 2 * math.pi * 0.01
    rows = scipy.sparse.vstack(list(model.outputs.values()))
    exact = Dynamics(model, rows).solve(low)[0].Y
    # G* differs from G0 by iωτ of sixty times it, 1e-3; the shape by no more, and its error counts squared
    for attach, tolerance in (((), None), (("end", "middle"), 1e-6)):
        s = reduce(model, n_modes=2, inertia=0, moduli=(1e9,), attach=attach)
        small = FullModel.of(s)
        Y = Dynamics(small, scipy.sparse.vstack(list(small.outputs.values()))).solve(low)[0].Y
        error = np.abs(Y - exact).max() / np.abs(exact).max()
        assert error > 0.01 if tolerance is None else error < tolerance


def sample(material, **change):
    """The paper's sample with a point on its outer ring, on a mesh of half the usual density."""
    points = {"rim": (0.023, 0.0055, 1.0), "rubber": (0.01875, 0.002, 0.3)}
    return replace(damping_sample(material, refinement=0.5), outputs=points, **change)


def epdm() -> Maxwell:
    """The measured rubber as the motor's example fits it."""
    master = master_curve(measured("epdm70").select(f_max=20.0), T_ref=20.0)
    return fit_maxwell(master, n=5, band=(10.0, 10e3), K=2e9, density=1150.0)


@pytest.mark.filterwarnings("ignore::bearingdyn.material.OutsideBand")
@pytest.mark.parametrize("rubber", ["whole range", "epdm70"])
def test_layered_sample_reduced_is_within_one_percent_of_full_up_to_5_khz(rubber):
    material = RUBBER if rubber == "whole range" else epdm()
    low, high = (abs(complex(material.complex_modulus(2 * math.pi * f))) for f in (5.0, 5e3))
    full = sample(material).full_model()
    basis = sample(material, inertia=1).basis()
    paper = sample(material, moduli=(modulus_levels([material])[0][0],)).basis()
    for case in ({"loads": ["outer"], "fixed": ["inner"]}, {}):
        error = reduction_error(full, basis, BAND, exact=True, **case)
        one = reduction_error(full, paper, BAND, exact=True, **case)
        estimate = reduction_error(full, paper, BAND, **case)
        print(
            f"{rubber}: |G*| {low / 1e6:.1f} to {high / 1e6:.1f} MPa, {case or 'stiffness'}: "
            f"{basis.Psi.shape[1]} coordinates {error.worst:.1e}, one modulus {one.worst:.2f}, "
            f"estimated {estimate.worst:.2f}"
        )
        assert error.worst < 0.01  # the demanded accuracy
        assert one.worst > 100 * error.worst
        # what one modulus cannot do: over the whole range, and over the 4.9 to 8 MPa measured. The band
        # begins below the fit's, where the modulus is least known: .049 and .060 were seen on two machines
        if case:
            assert one.worst > (0.3 if rubber == "whole range" else 0.04)
        # the demanded factor, for each load and frequency
        seen = one.by_load > 1e-6
        ratio = estimate.by_load[seen] / one.by_load[seen]
        assert np.all((ratio > 1 / 3) & (ratio < 3))
        assert estimate.solved.size < 0.6 * BAND.size


@pytest.mark.parametrize("inertia", [0, 1])
def test_estimate_for_a_layer_bounds_its_error_within_a_factor_of_three(inertia):
    body = replace(Layer(0.026, 0.028, 0.016, RUBBER, refinement=0.5).body, inertia=inertia)
    full, basis = body.full_model(), body.basis()
    f = np.geomspace(10.0, 5e3, 20)
    exact, estimate = (reduction_error(full, basis, f, exact=e) for e in (True, False))
    assert exact.worst < 0.01
    assert estimate.solved.size <= 6  # of 20
    seen = exact.by_load > 1e-7  # less is round-off of the full solve
    assert seen.any()
    ratio = estimate.by_load[seen] / exact.by_load[seen]
    assert np.all((ratio > 1 / 3) & (ratio < 3))
    assert np.array_equal(exact.frequency, f)
    assert exact.error.shape == f.shape


@pytest.mark.parametrize(
    ("size", "frequency"),
    [
        (0.03, [100.0, 740.0, 2300.0, 3500.0, 5000.0]),
        pytest.param(None, np.linspace(250, 5e3, 20), marks=pytest.mark.slow),
    ],
)
def test_demo_housing_is_within_one_percent_of_full_up_to_5_khz(size, frequency):
    """On its feet, loaded in the bore and at its top: outputs bore, top and a point on the side."""
    from bearingdyn.examples.paper import paper_pedestal

    housing = replace(paper_pedestal(0.078), element_size=size, points={"side": (0.08, 0.02, 0.0)})
    body = housing.body
    full = body.full_model()
    how = {"damping": housing.damping, "held": "feet"}
    paper = basis_of(full, f_max=housing.f_max, inertia=0)
    for loads in (["bore"], ["top", "side"]):
        case = {"loads": loads, "fixed": ["feet"], **how}
        exact = reduction_error(full, body.basis(), frequency, exact=True, **case)
        estimate = reduction_error(full, body.basis(), frequency, **case)
        plain = reduction_error(full, paper, frequency, **case)
        print(f"n = {full.n}, load at {loads}: {exact.worst:.1e}, estimated {estimate.worst:.1e}; ", end="")
        print(f"without attachment and inertia shapes {plain.worst:.2f}")
        assert exact.worst < 0.01
        ratio = estimate.by_load / exact.by_load
        assert np.all((ratio > 1 / 3) & (ratio < 3))
        assert plain.worst > 10 * exact.worst


def test_levels_span_each_materials_range():
    other = Maxwell(1e5, [1e5], [1e-2], K=2e9, density=1e3)
    low, high = modulus_levels([RUBBER, other])
    assert low == [1e6, 1e5]
    # |G*| at ω = 1/τ of the fastest branch, by hand
    w = 1e4
    by_hand = 1e6 + sum(G * 1j * w * t / (1 + 1j * w * t) for G, t in zip(RUBBER.G, RUBBER.tau, strict=True))
    assert high[0] == pytest.approx(abs(by_hand), rel=1e-12)
    assert modulus_levels([]) == [[]]
    assert modulus_levels([RUBBER, other], (1e6, 2e6)) == [[1e6, 1e6], [2e6, 2e6]]
    wide = Maxwell(1e4, [1e8], [1e-5], K=2e9, density=1e3)
    assert len(modulus_levels([wide])) == 3


class Nameless:
    def complex_modulus(self, omega):
        return 1j * np.asarray(omega)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda m: reduce(m, f_max=1e3, attach=("nose",)), "attach has 'nose'; the outputs are"),
        (lambda m: reduce(m, f_max=1e3, held="nose"), "held is 'nose'; the interfaces are"),
        (lambda m: reduce(m, f_max=1e3, inertia=-1), "inertia is -1"),
        (lambda m: reduce(m, f_max=1e3, moduli=(0.0,)), "moduli is .* positive"),
        (lambda m: reduce(m), "exactly one of the two"),
        (lambda m: reduction_error(m, basis_of(m, n_modes=1), [0.0]), "positive frequencies"),
        (lambda m: reduction_error(m, basis_of(m, n_modes=1), [math.nan]), "positive frequencies"),
        (
            lambda m: reduction_error(m, basis_of(m, n_modes=1), [1.0], solves=2),
            "a whole number of 3 or more",
        ),
        (lambda m: reduction_error(m, basis_of(m, n_modes=1), [1.0], loads=["nose"]), "has 'nose'"),
        (lambda m: reduction_error(m, basis_of(m, n_modes=1), [1.0], fixed=["end"]), "has 'end'"),
        (
            lambda m: reduction_error(m, basis_of(m, n_modes=1), [1.0], loads=["a"], fixed=["a"]),
            "both loaded and fixed",
        ),
        (lambda m: beam(M=np.eye(5)), "K has shape"),
        (lambda m: beam(K=scipy.sparse.triu(m.K)), "K must be symmetric"),
        (lambda m: beam(C=np.full((m.n, m.n), np.nan)), "C has an entry that is not finite"),
        (lambda m: beam(outputs={"a": np.eye(3, m.n)}), "'a', the name of an interface"),
        (lambda m: beam(outputs={"p": np.eye(4, m.n)}), "has 4 rows"),
        (
            lambda m: beam(interfaces={"a": m.interfaces["a"], "c": m.interfaces["a"]}),
            "'a' and 'c' share coordinate 12",
        ),
        (lambda m: reduce(beam(interfaces={}), n_modes=1), "interfaces is empty"),
        (
            lambda m: reduce(beam(K=m.K + scipy.sparse.eye(m.n) * 1e3), n_modes=1),
            "K resists rigid motion",
        ),
        (
            lambda m: reduce(beam(viscoelastic=(Viscoelastic(RUBBER, scipy.sparse.eye(m.n)),)), n_modes=1),
            "resists rigid motion",
        ),
        (lambda m: modulus_levels([Nameless()]), "names no relaxation times"),
    ],
)
def test_reduction_names_what_is_wrong(call, message):
    with pytest.raises(ValueError, match=message):
        call(beam())


def test_grounded_model_is_reduced_as_it_stands():
    """A beam on springs: with all modes the reduction is a change of basis."""
    free = beam(viscoelastic=())
    K = free.K + 1e5 * scipy.sparse.eye(free.n)
    s = reduce(beam(K=K, viscoelastic=(), grounded=True), f_max=1e9, inertia=0)
    assert s.n == free.n
    f = [
        scipy.linalg.eigh(A, B, eigvals_only=True)[:8]
        for A, B in ((s.K, s.M), (K.toarray(), free.M.toarray()))
    ]
    np.testing.assert_allclose(f[0], f[1], rtol=1e-6)  # round-off over ω² from 1e6 to 1e13


def test_elastic_body_has_no_levels():
    assert reduce(beam(viscoelastic=()), n_modes=0, inertia=0).n == 12
    assert isinstance(STEEL, Elastic)


def test_the_estimated_error_does_not_depend_on_the_origin() -> None:
    """Rotations are weighed by the radius of gyration about the centre of mass, wherever that lies."""
    model = beam()
    away = {
        name: replace(face, position=face.position + np.array([0.2, -0.4, 1.5]))
        for name, face in model.interfaces.items()
    }
    moved = replace(model, interfaces=away)
    here, there = (
        reduction_error(m, basis_of(m, n_modes=2), [200.0, 900.0, 2500.0], loads=["a", "end"]).by_load
        for m in (model, moved)
    )
    # the centre of mass is the difference of moments a hundred times its own: round-off of static solves
    np.testing.assert_allclose(there, here, rtol=1e-5)
