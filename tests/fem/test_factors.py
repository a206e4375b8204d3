"""Factors of sparse matrices by SuperLU and, where the extra `fast` is installed, by PARDISO."""

from __future__ import annotations

import gc
import os
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

from bearingdyn.fem import assemble_solid, box_mesh, factorise, lowest_modes, pardiso
from bearingdyn.fem import factors as room
from bearingdyn.fem.pardiso import library_path
from bearingdyn.material import STEEL


@pytest.fixture(scope="module")
def solid():
    """A block of bricks, one face held: stiffness and mass of 5100 coordinates."""
    mesh = box_mesh(*[np.linspace(0.0, 0.1, n) for n in (7, 7, 15)], "hex20")
    matrices = assemble_solid(mesh)
    free = np.flatnonzero(np.repeat(mesh.points[:, 2] > 1e-9, 3))
    K, M = matrices.stiffness(STEEL), STEEL.density * matrices.mass
    return tuple(scipy.sparse.csc_matrix(A[free][:, free]) for A in (K, M))


def plain(A, monkeypatch):
    """Factors as without the extra."""
    with monkeypatch.context() as m:
        m.setattr(room, "library_path", lambda: None)
        return factorise(A)


def test_superlu_is_the_default(solid, monkeypatch):
    assert not isinstance(plain(solid[0], monkeypatch), room.Cholesky)


class TestPardiso:
    """The extra gives the numbers of the default."""

    @pytest.fixture(autouse=True)
    def installed(self):
        if library_path() is None:
            pytest.skip("the extra fast is not installed")

    def test_solutions_agree(self, solid, monkeypatch):
        K = solid[0]
        b = np.random.default_rng(1).standard_normal((K.shape[0], 3))
        ours, theirs = factorise(K), plain(K, monkeypatch)
        assert isinstance(ours, room.Cholesky)
        for load in (b, b[:, 0], b[:, :0]):
            x, y = ours.solve(load), theirs.solve(load)
            assert x.shape == load.shape
            # condition of a solid of bricks, some 1e7, times rounding
            assert np.abs(x - y).max(initial=0.0) <= 1e-9 * np.abs(y).max(initial=0.0)

    @pytest.mark.parametrize("threads", [1, 2])
    def test_the_next_of_a_pattern_has_the_numbers_of_the_first(self, solid, threads):
        """Where one thread works its analysis is kept, and what comes of it is the same to the last bit."""
        library = pardiso._library()
        before = library.MKL_Get_Max_Threads()
        library.MKL_Set_Num_Threads(threads)
        try:
            self.one_after_another(solid[0], kept=threads == 1)
        finally:
            library.MKL_Set_Num_Threads(before)

    def one_after_another(self, K, kept):
        b = np.random.default_rng(2).standard_normal((K.shape[0], 2))
        other = K.copy()
        scale = np.linspace(1.0, 1.2, K.shape[0])  # of rows and columns, so that it stays symmetric
        other.data = K.data * scale[K.indices] * np.repeat(scale, np.diff(K.indptr))
        fresh, one = factorise(other), factorise(K)
        wanted, first = fresh.solve(b), one.solve(b)
        del one, fresh
        gc.collect()
        assert not kept or len(pardiso._idle) > 0
        again, beside = factorise(K), factorise(other)  # two at once are two
        assert np.array_equal(again.solve(b), first)
        assert np.array_equal(beside.solve(b), wanted)
        assert np.array_equal(again.solve(b), first)
        del again, beside
        order = np.random.default_rng(5).permutation(K.shape[0])  # as large, and of another pattern
        found = factorise(K[order][:, order])
        assert isinstance(found, room.Cholesky)  # its own, not SuperLU's where the library refuses
        turned = found.solve(b[order])
        del found
        assert np.abs(turned - first[order]).max() <= 1e-9 * np.abs(first).max()  # as above
        for n in (7000, 6900, 6800):  # other patterns push the oldest out
            factorise(K[:n][:, :n])
            gc.collect()
            assert len(pardiso._idle) <= pardiso.KEPT

    def test_factors_do_not_disturb_each_other(self, solid):
        K, M = solid
        b = np.ones(K.shape[0])
        one, other = factorise(K), factorise(K + 1e9 * M)
        x, y = one.solve(b), other.solve(b)
        del other
        gc.collect()
        assert one.solve(b).tobytes() == x.tobytes()
        assert np.abs(x - y).max() > 1e-3 * np.abs(x).max()

    def test_modes_agree(self, solid, monkeypatch):
        K, M = solid
        ours, _ = lowest_modes(K, M, n_modes=8)
        theirs, _ = lowest_modes(K, M, n_modes=8, lu=plain(K, monkeypatch))
        assert ours == pytest.approx(theirs, rel=1e-9)  # Lanczos ends at 1e-14 in 1/ω²

    def test_pivots_are_those_of_the_default(self, solid):
        K, M = solid
        # three modes lie below 4 kHz: as many pivots are negative (Sylvester)
        frequencies, _ = lowest_modes(K, M, n_modes=8)
        omega = 2 * np.pi * (frequencies[2] + frequencies[3]) / 2
        assert (room.pivots(K - omega**2 * M) < 0).sum() == 3

    def test_what_is_not_positive_definite_goes_to_superlu(self, solid):
        K, M = solid
        shifted = K - 1e10 * M
        found = factorise(shifted)
        assert not isinstance(found, room.Cholesky)
        b = np.ones(K.shape[0])
        assert np.abs(shifted @ found.solve(b) - b).max() < 1e-6

    def test_a_gap_in_the_diagonal_is_no_crash(self, solid):
        K = scipy.sparse.lil_matrix(solid[0])
        K[7, :], K[:, 7] = 0.0, 0.0
        K = scipy.sparse.csc_matrix(K)
        K.eliminate_zeros()
        with pytest.raises(np.linalg.LinAlgError, match="diagonal"):
            room.Cholesky(K)

    def test_every_run_factorises_alike(self, solid):
        """What is kept by the hash of a reduced part is found again: threads that race may not matter.

        Ten of thirty runs differed before the library was told to add up in one order.
        """
        b = np.random.default_rng(1).standard_normal((solid[0].shape[0], 1))
        told = set()
        for _ in range(20):
            x = b
            for _ in range(2):
                x = factorise(solid[0]).solve(x)
            told.add(x.tobytes())
        assert len(told) == 1

    def test_the_environment_is_left_as_it_was(self, solid):
        """Where the library is, is found without a word in the environment."""
        before = dict(os.environ)
        factorise(solid[0]).solve(np.ones(solid[0].shape[0]))
        assert dict(os.environ) == before
        assert Path(library_path()).is_file()
