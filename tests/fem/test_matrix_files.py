"""Matrices of other programs: every format gives the same model, what is wrong is named, and it is a part."""

from __future__ import annotations

import itertools
import math
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

from bearingdyn.fem import (
    MM_TONNE,
    FEMatrices,
    Section,
    Units,
    assemble_beam,
    assemble_solid,
    block_with_bore,
    check_matrices,
    factors,
    read_matrices,
    read_nodes,
    read_npz,
    write_npz,
)
from bearingdyn.material import STEEL
from bearingdyn.parts import Housing, Imported, NodeSet, Shaft, at_radius

pytest.importorskip("skfem")

DRAWING = {"width": 0.12, "height": 0.2, "length": 0.02, "bore_diameter": 0.062, "bore_height": 0.13}
SIZE = 0.03


BAR = 1e-5  # m², section


@pytest.fixture(scope="module")
def block() -> FEMatrices:
    """Twelve points of a block 60 × 40 × 20 mm, a steel bar between any two."""
    points = np.array([(x, y, z) for x in (0.0, 0.03, 0.06) for y in (0.0, 0.04) for z in (0.0, 0.02)])
    K, M = np.zeros((36, 36)), np.zeros((36, 36))
    for i, j in itertools.combinations(range(12), 2):
        at = [*range(3 * i, 3 * i + 3), *range(3 * j, 3 * j + 3)]
        length = np.linalg.norm(points[j] - points[i])
        along = (points[j] - points[i]) / length
        pull = np.concatenate([-along, along])
        K[np.ix_(at, at)] += STEEL.E * BAR / length * np.outer(pull, pull)
        M[np.ix_(at, at)] += STEEL.density * BAR * length / 6 * np.kron([[2, 1], [1, 2]], np.eye(3))
    return FEMatrices(M=scipy.sparse.csr_matrix(M), K=scipy.sparse.csr_matrix(K), points=points)


@pytest.fixture(scope="module")
def mass(block: FEMatrices) -> float:
    """Of its bars, kg."""
    assert block.points is not None
    pairs = itertools.combinations(block.points, 2)
    return STEEL.density * BAR * sum(float(np.linalg.norm(q - p)) for p, q in pairs)


def numbers(model: FEMatrices) -> np.ndarray:
    """Node numbers with gaps, rising in no order."""
    return 7 + 10 * np.random.default_rng(3).permutation(model.n // 3)


def positions(model: FEMatrices, scale: float = 1.0) -> dict[int, np.ndarray]:
    assert model.points is not None
    return dict(zip(numbers(model).tolist(), scale * model.points, strict=True))


def write_abaqus(path: Path, A: scipy.sparse.csr_matrix, node: np.ndarray, *, both: bool = False) -> None:
    """As *MATRIX OUTPUT, FORMAT=MATRIX INPUT writes: a triangle, nodes and directions."""
    entries = (A if both else scipy.sparse.tril(A)).tocoo()
    lines = ["**", "** a comment", "*MATRIX INPUT, NAME=A, TYPE=SYMMETRIC"]
    lines += [
        f"{node[i // 3]},{i % 3 + 1}, {node[j // 3]},{j % 3 + 1},  {v:.16e}"
        for i, j, v in zip(entries.row, entries.col, entries.data, strict=True)
    ]
    path.write_text("\n".join(lines) + "\n")


def write_coordinate(path: Path, A: scipy.sparse.csr_matrix, *, upper: bool, exponent: str = "e") -> None:
    """Row, column, value, counted from one."""
    entries = (scipy.sparse.triu(A) if upper else A).tocoo()
    lines = [
        f"{i + 1} {j + 1}  {v:.16e}" for i, j, v in zip(entries.row, entries.col, entries.data, strict=True)
    ]
    path.write_text(("\n".join(lines) + "\n").replace("e", exponent))


def assert_same(found: FEMatrices, model: FEMatrices, order: np.ndarray | None = None) -> None:
    """Equal to the seventeen digits that the files carry, nodes in the given order."""
    assert model.points is not None
    assert found.points is not None
    nodes = np.arange(model.n // 3) if order is None else order
    at = (3 * nodes[:, None] + np.arange(3)).ravel()
    for A, B in ((found.K, model.K), (found.M, model.M)):
        assert abs(A - B[at][:, at]).max() <= 1e-15 * abs(B).max()
    np.testing.assert_allclose(found.points, model.points[nodes], rtol=1e-15)


@pytest.mark.parametrize("both", [False, True])
def test_abaqus_matrices_in_mm_and_tonnes_become_si_in_the_order_of_the_nodes(block, mass, tmp_path, both):
    node = numbers(block)
    # N/mm and t: both a thousandth of N/m and kg
    write_abaqus(tmp_path / "job_STIF1.mtx", 1e-3 * block.K, node, both=both)
    write_abaqus(tmp_path / "job_MASS1.mtx", 1e-3 * block.M, node, both=both)
    inp = ["*HEADING", "*NODE, NSET=ALL"]
    inp += [f"{i}, {x:.17g}, {y:.17g}, {z:.17g}" for i, (x, y, z) in positions(block, 1e3).items()]
    (tmp_path / "job.inp").write_text("\n".join([*inp, "1, 0., 0., 0.", "** end", "*ELEMENT, TYPE=C3D20"]))
    found = read_matrices(
        tmp_path / "job_STIF1.mtx",
        tmp_path / "job_MASS1.mtx",
        tmp_path / "job.inp",
        units=MM_TONNE,
        expected_mass=mass,
    )
    assert_same(found, block, np.argsort(node))
    assert found.nodes is not None
    assert found.nodes.tolist() == sorted(node.tolist())
    assert found.name(4) == f"node {sorted(node.tolist())[1]}, y"


def test_matrices_by_row_and_column_may_be_a_triangle_or_whole_and_fortran(block, tmp_path):
    write_coordinate(tmp_path / "K.mtx", block.K, upper=True, exponent="D")
    write_coordinate(tmp_path / "M.mtx", block.M, upper=False)
    assert_same(read_matrices(tmp_path / "K.mtx", tmp_path / "M.mtx", block.points), block)


def test_calculix_files_name_their_coordinates(block, mass, tmp_path):
    node = numbers(block)
    write_coordinate(tmp_path / "job.sti", block.K, upper=True)
    write_coordinate(tmp_path / "job.mas", block.M, upper=True)
    lines = [f"{n}.{direction}" for n in node for direction in (1, 2, 3)]
    (tmp_path / "job.dof").write_text("\n".join(lines) + "\n")
    found = read_matrices(tmp_path / "job.sti", points=positions(block), expected_mass=mass)
    assert_same(found, block, np.argsort(node))


@pytest.mark.parametrize("binary", [True, False])
def test_output4_holds_six_coordinates_a_grid_and_solids_use_three(block, mass, tmp_path, binary):
    op4 = pytest.importorskip("pyyeti.nastran.op4", reason="pyyeti is not installed")
    n = block.n // 3
    at = (6 * np.arange(n)[:, None] + np.arange(3)).ravel()
    spread = scipy.sparse.csr_matrix((np.ones(3 * n), (np.arange(3 * n), at)), shape=(3 * n, 6 * n))
    content = {
        "KGG": (spread.T @ block.K @ spread).toarray(),
        "MGG": (spread.T @ block.M @ spread).toarray(),
        "XYZ": block.points,
    }
    op4.write(str(tmp_path / "job.op4"), content, binary=binary)
    found = read_matrices(tmp_path / "job.op4", coordinates="XYZ", expected_mass=mass)
    assert_same(found, block)
    with pytest.raises(ValueError, match=r"no matrix 'KAA'; it has .'KGG', 'MGG', 'XYZ'"):
        read_matrices(tmp_path / "job.op4", names=("KAA", "MAA"))
    (tmp_path / "text.op4").write_text("no matrices here")
    with pytest.raises(ValueError, match=r"text\.op4 cannot be read|has no matrix"):
        read_matrices(tmp_path / "text.op4")


def test_without_pyyeti_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyyeti.nastran", None)
    (tmp_path / "job.op4").write_bytes(b"")
    with pytest.raises(ImportError, match=r"pip install bearingdyn\[op4\]"):
        read_matrices(tmp_path / "job.op4")


def test_a_beam_written_in_mm_keeps_its_rotations(tmp_path):
    # three Timoshenko elements of six coordinates a node; x in mm, θ in rad
    z = np.array([0.0, 0.1, 0.25, 0.4])
    M, _, K = assemble_beam(z, [Section(0.1, 0.03)] * 3, STEEL)
    points = np.stack([0 * z, 0 * z, z], axis=1)
    D = scipy.sparse.diags(np.tile([1.0] * 3 + [1e3] * 3, 4))  # moments in N mm, arms in mm
    np.savez(tmp_path / "beam.npz", K=(1e-3 * D @ K @ D).toarray(), M=(1e-3 * D @ M @ D).toarray())
    mass = STEEL.density * math.pi / 4 * 0.03**2 * 0.4
    found = read_matrices(tmp_path / "beam.npz", points=1e3 * points, units=MM_TONNE, expected_mass=mass)
    # powers of ten are not exact in binary
    assert abs(found.K - K).max() <= 1e-14 * abs(K).max()
    assert abs(found.M - M).max() <= 1e-14 * abs(M).max()


def test_a_numbered_model_survives_an_archive(block, tmp_path):
    labels = np.array([(n, d) for n in numbers(block) for d in (1, 2, 3)])
    model = check_matrices(block.K, block.M, positions(block), labels=labels)
    write_npz(tmp_path / "m.npz", model)
    again = read_npz(tmp_path / "m.npz")
    assert_same(again, block, np.argsort(numbers(block)))
    assert again.nodes is not None
    assert model.nodes is not None
    assert np.array_equal(again.nodes, model.nodes)


def buckled(model: FEMatrices) -> np.ndarray:
    """K with the first elastic mode made unstable: rigid motion stays free, no diagonal entry turns."""
    K, M = model.K.toarray(), model.M.toarray()
    lam, phi = scipy.linalg.eigh(K, M, subset_by_index=[6, 6])
    p = M @ phi[:, 0]
    return np.asarray(K - 1.5 * lam[0] * np.outer(p, p))


def test_an_indefinite_stiffness_is_named_with_its_place(block):
    with pytest.raises(
        ValueError, match=r"K is indefinite: 1 negative pivots, one at node \d+, [xyz]; a stress"
    ):
        check_matrices(buckled(block), block.M, block.points)
    # and where the nodes are not known
    with pytest.raises(ValueError, match="K is indefinite"):
        check_matrices(buckled(block), block.M)


def test_large_models_are_checked_as_small_ones_are(block, monkeypatch):
    """Above some size matrices are eliminated in another order, here already at 36 coordinates."""
    monkeypatch.setattr(factors, "DISSECT", 20)
    assert_same(check_matrices(block.K, block.M, block.points), block)
    with pytest.raises(
        ValueError, match=r"K is indefinite: 1 negative pivots, one at node \d+, [xyz]; a stress"
    ):
        check_matrices(buckled(block), block.M, block.points)
    assert (factors.pivots(block.K + scipy.sparse.eye(block.n)) > 0).all()
    # pivots by the rows of the matrix: each block of a block-diagonal one keeps its own signs
    signs = np.where(np.arange(block.n) % 3 == 0, -1.0, 2.0)
    np.testing.assert_array_equal(factors.pivots(scipy.sparse.diags(signs)), signs)


def test_an_indefinite_mass_is_named(block):
    M = block.M.toarray()
    off = M - np.diag(np.diag(M))
    with pytest.raises(ValueError, match=r"M is indefinite: .* eigenvalue -"):
        check_matrices(block.K, np.diag(np.diag(M)) + 40.0 * off, block.points)


def test_wrong_units_are_named(block, mass):
    K, M, p = block.K, block.M, block.points
    for args, more, message in (
        (
            (1e-3 * K, 1e-3 * M, p),
            {"expected_mass": mass},
            "M totals .* is expected: a thousandth: .*MM_TONNE",
        ),
        ((1e3 * K, 1e3 * M, p), {"expected_mass": mass}, "a thousand times that"),
        ((2 * K, 2 * M, p), {"expected_mass": mass}, "M totals .* other units"),
        # bars swell with √(E/9ρ) = 1724 m/s. Positions in mm with SI matrices; mm and t without saying so;
        # N/mm with kg; and grams
        ((K, M, 1e3 * p), {}, "speed .* of 1.72e.06 m/s"),
        ((1e-3 * K, 1e-3 * M, 1e3 * p), {}, "speed .* m/s, where solids have .*MM_TONNE"),
        ((1e-3 * K, M, p), {}, "speed .* of 54.5 m/s"),
        ((1e3 * K, 1e3 * M, p), {}, "denser than any solid"),
        ((K, M, p), {"expected_mass": -1.0}, "expected_mass is -1.0"),
        ((K, M), {"expected_mass": 1.0}, "cannot be compared without points"),
    ):
        with pytest.raises(ValueError, match=message):
            check_matrices(*args, **more)
    with pytest.raises(ValueError, match="Units mass is 0"):
        Units(mass=0.0)


def test_loose_nodes_and_supports_are_named(block):
    n = block.n
    K = scipy.sparse.block_diag([block.K, scipy.sparse.csr_matrix((3, 3))]).tocsr()
    M0 = scipy.sparse.block_diag([block.M, scipy.sparse.csr_matrix((3, 3))]).tocsr()
    M1 = scipy.sparse.block_diag([block.M, scipy.sparse.eye(3)]).tocsr()
    points = np.vstack([block.points, [[0.0, 0.0, 0.1]]])
    with pytest.raises(ValueError, match=f"at node {n // 3}, x, which has neither stiffness nor mass"):
        check_matrices(K, M0, points)
    with pytest.raises(ValueError, match=f"at node {n // 3}, x, which has mass but no stiffness"):
        check_matrices(K, M1, points)
    held = block.K + scipy.sparse.diags(np.where(np.arange(n) == 5, 1e36, 0.0))
    with pytest.raises(ValueError, match=r"K has 1e.36 at node 1, z: a support is in it"):
        check_matrices(held, block.M, block.points)
    with pytest.raises(ValueError, match="export the model without supports"):
        check_matrices(block.K[3:, 3:], block.M[3:, 3:], block.points[1:])


def test_files_that_do_not_fit_are_named(block, tmp_path):
    node = numbers(block)
    write_abaqus(tmp_path / "a.mtx", block.K, node)
    write_coordinate(tmp_path / "c.mtx", block.M, upper=True)
    write_abaqus(tmp_path / "internal.mtx", block.K, node - 50)
    (tmp_path / "two.mtx").write_text("1 2\n3 4\n")
    (tmp_path / "half.mtx").write_text("1.5,1,1,1,2.0\n")
    (tmp_path / "zero.mtx").write_text("0 1 2.0\n")
    (tmp_path / "word.mtx").write_text("one two three\n")
    (tmp_path / "k.unv").write_text("-1\n")
    (tmp_path / "alone.sti").write_text("1 1 2.0\n")
    for name in ("few.sti", "few.mas", "bad.sti", "bad.mas"):
        write_coordinate(tmp_path / name, block.K, upper=True)
    (tmp_path / "few.dof").write_text("1.1\n1.2\n")
    (tmp_path / "bad.dof").write_text("1.1\n1\n")
    (tmp_path / "x.inp").write_text("*ELEMENT\n1,2\n")
    (tmp_path / "y.inp").write_text("*NODE\n1, a, b\n")
    f = {path.stem: path for path in tmp_path.iterdir() if path.suffix == ".mtx"}
    for call, message in (
        (lambda: read_matrices(f["a"], f["c"]), "different formats"),
        (lambda: read_matrices(f["a"]), "a.mtx holds the stiffness alone"),
        (lambda: read_matrices(f["internal"], f["a"]), "internal variable of Abaqus"),
        (lambda: read_matrices(f["two"], f["a"]), "2 columns of numbers; an Abaqus matrix has 3 or 5"),
        (
            lambda: read_matrices(f["half"], f["a"]),
            r"half.mtx, line 1 is '1.5,1,1,1,2.0'; .* whole numbers",
        ),
        (lambda: read_matrices(f["zero"], f["a"]), r"zero.mtx, line 1 is '0 1 2.0'; .*they count from 1"),
        (
            lambda: read_matrices(f["word"], f["a"]),
            "word.mtx, line 1 is 'one two three'; an Abaqus matrix has",
        ),
        (lambda: read_matrices(f["a"], f["a"], {1: (0, 0, 0)}), "points has no node 7"),
        (lambda: read_matrices(f["a"], f["a"], block.points[:4]), r"points has shape \(4, 3\), .* 12 nodes"),
        (lambda: read_matrices(tmp_path / "k.unv"), "ends in '.unv'; known are"),
        (lambda: read_matrices(tmp_path / "few.sti"), "rows up to 36, while .* names 2"),
        (lambda: read_matrices(tmp_path / "bad.sti"), "not node.direction"),
        (lambda: read_nodes(tmp_path / "x.inp"), r"has no \*NODE block"),
        (lambda: read_nodes(tmp_path / "y.inp"), "y.inp, line 2: .*'1, a, b' is not a node"),
    ):
        with pytest.raises(ValueError, match=message):
            call()
    for lacking, wanted in (("no", "no.sti"), ("alone", "alone.mas")):
        with pytest.raises(FileNotFoundError, match=f"{wanted}: no such file"):
            read_matrices(tmp_path / f"{lacking}.sti")


def test_nodes_are_read_through_includes_and_blanks_are_zero(tmp_path):
    (tmp_path / "nodes.inp").write_text("*NODE, NSET=all\n1, 1.0, 2.0, 3.0\n2, , 5.0\n")
    (tmp_path / "model.inp").write_text("*HEADING\n*INCLUDE, INPUT=nodes.inp\n*NODE\n7, 1., 1., 1.,\n")
    expected = {1: (1.0, 2.0, 3.0), 2: (0.0, 5.0, 0.0), 7: (1.0, 1.0, 1.0)}
    assert read_nodes(tmp_path / "model.inp") == expected


def test_labels_that_are_wrong_are_named(block):
    labels = np.array([(n, d) for n in numbers(block) for d in (1, 2, 3)])
    for change, message in (((0, 1, 7), "direction 7"), ((1, 1, 1), "direction 1 twice")):
        wrong = labels.copy()
        wrong[change[0], change[1]] = change[2]
        with pytest.raises(ValueError, match=message):
            check_matrices(block.K, block.M, labels=wrong)
    with pytest.raises(ValueError, match=r"labels has shape \(6, 2\)"):
        check_matrices(block.K, block.M, labels=labels[:6])
    with pytest.raises(ValueError, match="internal is 36"):
        check_matrices(block.K, block.M, internal=36)


# ---------------------------------------------------------------- the part


@pytest.fixture(scope="module")
def pedestal() -> FEMatrices:
    """The matrices of a Housing, as if they came from elsewhere."""
    d = DRAWING
    solid = assemble_solid(
        block_with_bore(d["width"], d["height"], d["length"], d["bore_diameter"], d["bore_height"], SIZE)
    )
    return check_matrices(solid.stiffness(STEEL), STEEL.density * solid.mass, solid.points)


def part(matrices: FEMatrices, **change) -> Imported:
    bore = NodeSet(at_radius(0.5 * DRAWING["bore_diameter"]), (0.0, 0.0, 0.0))
    assert matrices.points is not None
    on_base = np.flatnonzero(np.abs(matrices.points[:, 1] + 0.13) < 1e-9).tolist()
    given = {
        "interfaces": {"bore": bore, "feet": NodeSet(on_base, (0.0, -0.13, 0.0))},
        "outputs": {"top": (0.0, 0.07, 0.0)},
        "damping": 0.01,
        "held": "feet",
        "f_max": 8e3,
    }
    return Imported(matrices, **(given | change))


def test_imported_matrices_give_the_superelement_of_the_same_body(pedestal):
    found = part(pedestal).superelement()
    drawn = Housing(**DRAWING, damping=0.01, f_max=8e3, element_size=SIZE).superelement()
    # the static shapes are the same whatever modes join them: equal but for a sparse solve's round-off
    np.testing.assert_allclose(found.K[:12, :12], drawn.K[:12, :12], atol=1e-9 * np.abs(drawn.K).max())
    np.testing.assert_allclose(found.M[:12, :12], drawn.M[:12, :12], atol=1e-9)
    np.testing.assert_allclose(found.rows("top")[:, :12], drawn.rows("top")[:, :12], atol=1e-9)
    free = np.setdiff1d(np.arange(found.n), found.interfaces["feet"])
    square, phi = scipy.linalg.eigh(found.K[np.ix_(free, free)], found.M[np.ix_(free, free)])
    twice = np.diag(phi.T @ found.C[np.ix_(free, free)] @ phi) / np.sqrt(square)
    np.testing.assert_allclose(twice, 2 * 0.01, rtol=1e-6)  # ζ of the body held at its feet
    assert part(pedestal).mass == pytest.approx(7850 * (0.12 * 0.2 - math.pi * 0.031**2) * 0.02, rel=1e-4)


def test_a_model_reduced_elsewhere_is_taken_as_it_is():
    shaft = Shaft([Section(0.4, 0.03)], seats={"left": 0.05, "right": 0.35}, f_max=20e3)
    s = shaft.superelement()
    points = [[0.0, 0.0, 0.05], [0.0, 0.0, 0.35]]
    matrices = check_matrices(s.K, s.M, points, internal=s.n - 12)
    again = Imported(matrices, {"left": NodeSet([0]), "right": NodeSet([1])}, f_max=math.inf).superelement()
    assert again.n == s.n
    inner = np.arange(6, s.n)
    square, expected = (
        np.sort(scipy.linalg.eigh(q.K[np.ix_(inner, inner)], q.M[np.ix_(inner, inner)], eigvals_only=True))
        for q in (again, s)
    )
    np.testing.assert_allclose(square, expected, rtol=1e-8)  # round-off of a condition of 1e6


def test_an_output_at_a_node_of_six_coordinates_turns_too():
    z = np.array([0.0, 0.1, 0.2])
    M, _, K = assemble_beam(z, [Section(0.1, 0.03)] * 2, STEEL)
    matrices = check_matrices(K, M, np.stack([0 * z, 0 * z, z], axis=1))
    s = Imported(matrices, {"end": NodeSet([0])}, {"tip": 2}).superelement()
    rigid = np.zeros((s.n, 6))
    rigid[:6] = np.eye(6)
    moved = s.rows("tip") @ rigid
    assert moved.shape == (6, 6)
    assert moved[0, 4] == pytest.approx(0.2, rel=1e-9)  # x = θy z
    assert moved[3, 3] == pytest.approx(1.0, rel=1e-9)


def test_imported_parts_that_do_not_fit_are_refused(pedestal, block):
    nobody = NodeSet(lambda p: p[:, 2] > 1.0)
    line = NodeSet(lambda p: (np.abs(p[:, 1] + 0.13) < 1e-9) & (np.abs(p[:, 2]) < 1e-9))
    for change, message in (
        ({"interfaces": {}, "held": None}, "interfaces is empty"),
        ({"interfaces": {"a": nobody}, "held": None}, r"interfaces\['a'\] has no nodes"),
        ({"interfaces": {"a": line}, "held": None}, "on a point or a line"),
        ({"interfaces": {"a": NodeSet([99999])}, "held": None}, "names node 99999"),
        ({"interfaces": {"a": NodeSet(lambda p: p)}, "held": None}, "must give a truth value"),
        ({"held": "base"}, "held is 'base'; the interfaces are"),
        ({"damping": 1.0}, "damping is 1.0"),
        ({"f_max": math.nan}, "f_max is nan"),
        ({"outputs": {"bore": 1}}, "the name of an interface"),
        ({"outputs": {"p": 99999}}, "names node 99999"),
        ({"outputs": {"p": (0.0, 1.0)}}, "must be a node's number or"),
    ):
        with pytest.raises(ValueError, match=message):
            part(pedestal, **change)
    with pytest.raises(ValueError, match="matrices has no points"):
        Imported(check_matrices(pedestal.K, pedestal.M), {"a": nobody})
    with pytest.raises(ValueError, match=r"reference is \(0\.0, nan, 0\.0\)"):
        NodeSet([0, 1, 2], (0.0, math.nan, 0.0))


def test_a_piece_that_hangs_on_nothing_is_named(block):
    n = block.n // 3
    K, M = (scipy.sparse.block_diag([A, A]).tocsr() for A in (block.K, block.M))
    points = np.vstack([block.points, block.points + [0.0, 0.0, 0.1]])
    two = check_matrices(K, M, points)
    with pytest.raises(ValueError, match=f"a piece of {3 * n} coordinates, node {n}, x among them"):
        Imported(two, {"end": NodeSet(lambda p: np.abs(p[:, 2]) < 1e-9)})
