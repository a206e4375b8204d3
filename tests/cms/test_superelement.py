"""Component mode synthesis: what a reduction keeps exactly, what it approximates, what it refuses."""

from __future__ import annotations

import copy
import math
import pickle

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from bearingdyn.cms import (
    RigidInterface,
    Superelement,
    Viscoelastic,
    craig_bampton,
    modal_damping,
    reduce_free_body,
)
from bearingdyn.fem import Section, assemble_beam, lowest_modes, rigid_transfer
from bearingdyn.material import STEEL
from bearingdyn.parts import Housing


class Rubber:
    """G* = 1 MPa + i ω 100 Pa s."""

    def complex_modulus(self, omega):
        return 1e6 + 1j * 100.0 * np.asarray(omega)


def chain(n, k=1e6, m=0.1):
    """Free chain of n equal masses and springs, and its exact frequencies √(k/m)/π sin(jπ/2n), Hz."""
    K = k * scipy.sparse.diags(
        [np.r_[1.0, 2.0 * np.ones(n - 2), 1.0], -np.ones(n - 1), -np.ones(n - 1)], [0, 1, -1]
    )
    exact = math.sqrt(k / m) / math.pi * np.sin(np.arange(n) * math.pi / (2 * n))
    return m * scipy.sparse.eye(n), K, exact


def frequencies(K, M):
    return np.sqrt(np.abs(scipy.linalg.eigh(K, M, eigvals_only=True))) / (2.0 * math.pi)


def beam(n=40, L=0.4, d=0.03):
    z = np.linspace(0.0, L, n + 1)
    M, G, K = assemble_beam(z, [Section(L, d)] * n, STEEL)
    faces = {
        name: RigidInterface(6 * i + np.arange(6), np.eye(6), np.array([0.0, 0.0, z[i]]))
        for name, i in (("a", 5), ("b", n - 5))
    }
    return M, K, G, faces


def test_reduced_chain_has_the_frequencies_of_the_full_one():
    n = 60
    M, K, exact = chain(n)
    basis = craig_bampton(M, K, [10, 45], n_modes=20)
    f = frequencies(basis.stiffness(), basis.reduce(M))
    # Ritz: from above; modes below a quarter of the highest kept come out within 1e-3
    low = np.flatnonzero((exact < basis.frequency[-1] / 4) & (exact > 0))
    assert low.size >= 4
    ratio = f[low] / exact[low]
    assert np.all(ratio > 1.0 - 1e-9)
    assert np.all(ratio < 1.0 + 1e-3)


def test_reduction_with_all_modes_is_exact():
    n = 12
    M, K, exact = chain(n)
    basis = craig_bampton(M, K, [0, 7], f_max=1e9)
    # a change of basis: round-off only, in ω² relative to the largest
    np.testing.assert_allclose(frequencies(basis.stiffness(), basis.reduce(M))[1:], exact[1:], rtol=1e-10)


def test_static_stiffness_between_interfaces_is_exact_without_modes():
    # springs in series: k / number of springs; constraint modes solve the statics, so round-off only
    M, K, _ = chain(50, k=2e6)
    basis = craig_bampton(M, K, [3, 43], n_modes=0)
    np.testing.assert_allclose(basis.K, 2e6 / 40 * np.array([[1, -1], [-1, 1]]), rtol=1e-10)


def test_sparse_and_dense_solvers_find_the_same_modes():
    M, K, _ = chain(900)  # above the size at which Lanczos takes over
    grounded = K + scipy.sparse.diags(np.r_[1e6, np.zeros(898), 1e6])
    f, phi = lowest_modes(scipy.sparse.csr_matrix(grounded), scipy.sparse.csr_matrix(M), n_modes=15)
    j = np.arange(1, 16)
    exact = math.sqrt(1e7) / math.pi * np.sin(j * math.pi / (2 * 901))  # a chain of 900 held at both ends
    np.testing.assert_allclose(f, exact, rtol=1e-8)  # shift-invert at the condition number 3e5
    np.testing.assert_allclose(phi.T @ M @ phi, np.eye(15), atol=1e-9)
    up_to, _ = lowest_modes(
        scipy.sparse.csr_matrix(grounded), scipy.sparse.csr_matrix(M), f_max=exact[13] * 1.01
    )
    np.testing.assert_allclose(up_to, exact[:14], rtol=1e-8)
    again, shape = lowest_modes(scipy.sparse.csr_matrix(grounded), scipy.sparse.csr_matrix(M), n_modes=15)
    assert np.array_equal(shape, phi)  # the same model gives the same superelement, bit for bit
    assert np.array_equal(again, f)


def test_reduced_beam_matches_the_full_beam_on_springs():
    M, K, G, faces = beam()
    s = reduce_free_body(M, K, faces, G=G, f_max=20e3)
    springs = np.array([1e8, 1e8, 2e7, 1e3, 1e3, 10.0])
    full, reduced = K.toarray(), s.K.copy()
    for name, face in faces.items():
        full[face.dofs, face.dofs] += springs
        reduced[s.interfaces[name], s.interfaces[name]] += springs
    f_full = frequencies(full, M.toarray())
    f = frequencies(reduced, s.M)[: np.count_nonzero(f_full < 5e3)]
    assert f.size >= 8
    np.testing.assert_allclose(f, f_full[: f.size], rtol=2e-3)  # modes to four times the highest compared
    assert np.all(f > f_full[: f.size] * (1 - 1e-7))  # Ritz values lie above


def test_rigid_motion_costs_nothing_and_carries_the_mass():
    M, K, G, faces = beam()
    s = reduce_free_body(M, K, faces, G=G, f_max=5e3, damping=0.01)
    R = np.zeros((s.n, 6))
    R[:12] = rigid_transfer([face.position for face in faces.values()])
    assert np.abs(s.K @ R).max() < 1e-12 * np.abs(s.K).max()
    assert np.abs(s.C @ R).max() < 1e-6 * np.abs(s.C).max()  # ω of round-off size: the root of 1e-12
    m = STEEL.density * math.pi / 4 * 0.03**2 * 0.4
    np.testing.assert_allclose(np.diag(R.T @ s.M @ R)[:3], m, rtol=1e-8)  # static solve round-off
    np.testing.assert_allclose(R.T @ s.M @ R, rigid_full(M), rtol=1e-7, atol=1e-9)


def rigid_full(M):
    R = rigid_transfer(np.stack([np.zeros(41), np.zeros(41), np.linspace(0, 0.4, 41)], axis=1))
    return R.T @ M @ R


@pytest.mark.parametrize("zeta", [0.002, 0.05])
def test_modal_damping_gives_every_mode_its_ratio(zeta):
    M, K, _ = chain(30)
    rng = np.random.default_rng(1)
    scale = np.diag(10.0 ** rng.uniform(-3, 3, 30))  # metres beside radians
    m, k = scale @ M.toarray() @ scale, scale @ K.toarray() @ scale
    C = modal_damping(m, k, zeta)
    # eigenvalues of the damped free system, in one scale: -ζω ± iω√(1-ζ²) with the exact ω of the chain
    unscaled = np.linalg.inv(scale) @ C @ np.linalg.inv(scale)
    A = np.block([[np.zeros((30, 30)), np.eye(30)], [-K.toarray() / 0.1, -unscaled / 0.1]])
    lam = np.linalg.eigvals(A)
    omega = 2 * math.pi * chain(30)[2][1:]
    found = np.sort_complex(lam[lam.imag > 1.0])
    found = found[np.argsort(found.imag)]
    np.testing.assert_allclose(-found.real / np.abs(found), zeta, rtol=1e-8)  # eigensolver round-off
    np.testing.assert_allclose(np.abs(found), omega, rtol=1e-8)
    assert np.abs(unscaled @ np.ones(30)).max() < 1e-6 * np.abs(unscaled).max()  # rigid motion undamped


def test_viscoelastic_stiffness_adds_the_deviatoric_part():
    H = np.diag([2.0, 1, 1, 1, 1, 1])
    s = Superelement(
        M=np.eye(6),
        C=np.zeros((6, 6)),
        G=np.zeros((6, 6)),
        K=3.0 * np.eye(6),
        interfaces={"a": np.arange(6)},
        viscoelastic=(Viscoelastic(Rubber(), H),),
    )
    # paper (20): K + 2 G* H
    assert s.stiffness(50.0)[0, 0] == pytest.approx(3.0 + 2 * (1e6 + 5e3j) * 2.0, rel=1e-15)
    assert s.stiffness()[1, 1] == pytest.approx(3.0 + 2e6, rel=1e-15)


def plain(**change):
    given = {
        "M": np.eye(7),
        "C": np.zeros((7, 7)),
        "K": np.eye(7),
        "G": np.zeros((7, 7)),
        "interfaces": {"a": np.arange(6)},
        "outputs": {"p": np.ones((3, 7))},
    }
    return Superelement(**(given | change))


def test_superelement_keeps_its_own_copy_and_survives_pickle():
    K = np.eye(7)
    s = plain(K=K)
    K[0, 0] = 5.0
    assert s.K[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        s.K[0, 0] = 2.0
    for t in (pickle.loads(pickle.dumps(s)), copy.deepcopy(s)):
        assert np.array_equal(t.rows("p"), s.rows("p"))
    assert np.array_equal(s.rows("a"), np.eye(7)[:6])
    with pytest.raises(ValueError, match=r"no interface or output 'b'; there are \['a', 'p'\]"):
        s.rows("b")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"K": np.eye(6)}, r"K has shape \(6, 6\); it must be \(7, 7\)"),
        ({"K": np.triu(np.ones((7, 7)))}, "K must be symmetric"),
        ({"G": np.eye(7)}, "G must be skew-symmetric"),
        ({"M": np.full((7, 7), np.nan)}, "M has an entry that is not finite"),
        ({"M": np.zeros((0, 0))}, r"M has shape \(0, 0\)"),
        ({"interfaces": {"a": np.arange(5)}}, r"interfaces\['a'\].*6 integers"),
        ({"interfaces": {"a": np.arange(6.0)}}, r"interfaces\['a'\].*6 integers"),
        ({"interfaces": {"a": np.arange(2, 8)}}, "index 7; it must lie in 0...6"),
        ({"interfaces": {"a": np.arange(6), "b": np.arange(1, 7)}}, "share index 1"),
        ({"interfaces": {"p": np.arange(6)}}, "'p', the name of an interface"),
        ({"outputs": {"p": np.ones((4, 7))}}, r"outputs\['p'\] has shape \(4, 7\)"),
        ({"outputs": {"p": np.ones((3, 6))}}, r"outputs\['p'\] has shape \(3, 6\)"),
        ({"viscoelastic": (Viscoelastic(Rubber(), np.eye(3)),)}, r"viscoelastic\[0\].H has shape \(3, 3\)"),
    ],
)
def test_superelement_refuses(change, message):
    with pytest.raises(ValueError, match=message):
        plain(**change)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda M, K: craig_bampton(M, K, [0]), "exactly one of the two"),
        (lambda M, K: craig_bampton(M, K, [0], f_max=1.0, n_modes=1), "exactly one of the two"),
        (lambda M, K: craig_bampton(M, K, [0], f_max=math.nan), "f_max is nan"),
        (lambda M, K: craig_bampton(M, K, [0], n_modes=-1), "n_modes is -1"),
        (lambda M, K: craig_bampton(M, K, [0, 0], n_modes=1), "distinct indices"),
        (lambda M, K: craig_bampton(M, K, [99], n_modes=1), "distinct indices"),
        (lambda M, K: craig_bampton(M, K, [0], np.ones((2, 1)), n_modes=1), r"T has shape \(2, 1\)"),
        (lambda M, K: craig_bampton(M, np.eye(3), [0], n_modes=1), "square and alike"),
        (lambda M, K: modal_damping(M.toarray(), K.toarray(), 1.5), "zeta is 1.5"),
        (lambda M, K: modal_damping(M.toarray(), K.toarray(), math.nan), "zeta is nan"),
        (lambda M, K: modal_damping(np.zeros((10, 10)), K.toarray(), 0.1), "needs a mass for each"),
        (lambda M, K: Viscoelastic(3.0, np.eye(2)), "material is 3.0"),
        (lambda M, K: Viscoelastic(Rubber(), np.ones((2, 3))), "H has shape"),
    ],
)
def test_reduction_refuses(call, message):
    M, K, _ = chain(10)
    with pytest.raises(ValueError, match=message):
        call(M, K)


def test_part_left_free_by_its_interface_is_refused():
    M, K, _ = chain(10)
    two = scipy.sparse.block_diag([K, K]), scipy.sparse.block_diag([M, M])
    with pytest.raises(ValueError, match="leave the model free to move"):
        craig_bampton(two[1], two[0], [0], n_modes=3)


def test_grounded_or_overlapping_interfaces_are_refused():
    M, K, _, faces = beam()
    with pytest.raises(ValueError, match="resists rigid motion"):
        reduce_free_body(M, K + 1e3 * scipy.sparse.eye(K.shape[0]), faces, n_modes=2)
    with pytest.raises(ValueError, match="'a' and 'b' share coordinate"):
        reduce_free_body(M, K, {"a": faces["a"], "b": faces["a"]}, n_modes=2)
    with pytest.raises(ValueError, match="interfaces is empty"):
        reduce_free_body(M, K, {}, n_modes=2)


def test_modes_of_a_body_held_at_an_interface_have_its_damping_and_rigid_motion_none() -> None:
    zeta = 0.013
    element = Housing(0.12, 0.16, 0.03, 0.05, damping=zeta, f_max=6e3).superelement()
    feet = element.interfaces["feet"]
    kept = np.setdiff1d(np.arange(element.n), feet)
    inside = np.ix_(kept, kept)
    squares, shapes = scipy.linalg.eigh(element.K[inside], element.M[inside])
    damping = shapes.T @ element.C[inside] @ shapes
    # the definition of modal damping, to the round-off of three products
    np.testing.assert_allclose(damping, np.diag(2 * zeta * np.sqrt(squares)), atol=1e-8 * damping.max())
    # a rigid turn of the whole housing about its feet strains nothing: power against that of the bore alone
    turn = np.zeros(element.n)
    turn[feet] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]
    turn[element.interfaces["bore"]] = [0.0, 0.0, 0.08, 1.0, 0.0, 0.0]
    alone = np.where(np.isin(np.arange(element.n), element.interfaces["bore"]), turn, 0.0)
    assert abs(turn @ element.C @ turn) < 1e-9 * (alone @ element.C @ alone)
