"""Numbers in matrix files: as Fortran writes them, cut, with commas, of six digits."""

from __future__ import annotations

import io
import math
import time
import tracemalloc
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse

import bearingdyn as bd
from bearingdyn.fem import check_matrices, read_matrices
from bearingdyn.fem.matrix_files import matrix_market as matrix_market_file
from bearingdyn.fem.matrix_files import text_tables
from bearingdyn.fem.matrix_files.text_tables import Form, triples
from bearingdyn.notice import UnfinishedLine

Write = Callable[[Path, Any, Callable[[float], str]], None]


@pytest.fixture(scope="module")
def block() -> tuple[Any, Any, Any]:
    """Positions, K and M of a steel block 100 × 20 × 30 mm."""
    mesh = bd.box_mesh(np.linspace(0, 0.1, 3), [0, 0.02], [0, 0.03])
    full = bd.Solid(mesh, bd.STEEL, {"a": "x-"}, f_max=0).full_model()
    return mesh.points, full.K.tocsr(), full.M.tocsr()


def lower(A: Any) -> Any:
    return scipy.sparse.tril(A).tocoo()


def matrix_market(path: Path, A: Any, form: Callable[[float], str]) -> None:
    A = lower(A)
    text = "".join(f"{i + 1} {j + 1} {form(v)}\n" for i, j, v in zip(A.row, A.col, A.data, strict=True))
    head = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n"
    path.write_text(f"{head}{A.shape[0]} {A.shape[0]} {A.nnz}\n{text}")


def array(path: Path, A: Any, form: Callable[[float], str]) -> None:
    n, full = A.shape[0], A.toarray()
    text = "".join(f"{form(v)}\n" for j in range(n) for v in full[j:, j])
    path.write_text(f"%%MatrixMarket matrix array real symmetric\n{n} {n}\n{text}")


def abaqus(path: Path, A: Any, form: Callable[[float], str]) -> None:
    A = lower(A)
    path.write_text("*MATRIX INPUT\n" + "".join(
        f"{i // 3 + 1},{i % 3 + 1}, {j // 3 + 1},{j % 3 + 1}, {form(v)}\n"
        for i, j, v in zip(A.row, A.col, A.data, strict=True)
    ))  # fmt: skip


def plain(path: Path, A: Any, form: Callable[[float], str]) -> None:
    A = lower(A)
    path.write_text(
        "".join(f"{i + 1} {j + 1} {form(v)}\n" for i, j, v in zip(A.row, A.col, A.data, strict=True))
    )
    labels = "".join(f"{i // 3 + 1}.{i % 3 + 1}\n" for i in range(A.shape[0]))
    path.with_suffix(".dof").write_text(labels)


FORMATS = {
    "MatrixMarket": (matrix_market, "k.mtx", "m.mtx"),
    "array": (array, "k.mtx", "m.mtx"),
    "Abaqus": (abaqus, "k.mtx", "m.mtx"),
    "COORDINATE": (plain, "k.mtx", "m.mtx"),
    "CalculiX": (plain, "k.sti", "k.mas"),
}


def full(value: float) -> str:
    """All digits."""
    return repr(float(value))


def fortran(value: float) -> str:
    """1.5D+08, and without the letter where the exponent has three digits."""
    text = f"{value:.15E}"
    return text.replace("E", "D")


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize("form", [fortran, lambda v: f"{v:.15e}", lambda v: f"  {v:+.16E} \r", full])
def test_numbers_are_what_was_written(tmp_path, block, name, form) -> None:
    points, K, M = block
    write, k, m = FORMATS[name]
    write(tmp_path / k, K, lambda v: form(float(v)))
    write(tmp_path / m, M, lambda v: form(float(v)))
    found = read_matrices(tmp_path / k, tmp_path / m, points)
    # sixteen digits
    assert abs(found.K - K).max() <= 1e-15 * abs(K).max()
    assert abs(found.M - M).max() <= 1e-15 * abs(M).max()


def test_an_exponent_without_its_letter_is_one() -> None:
    stream = io.BytesIO(b"1 1 1.5-100\n2 2 -2.5+100\n")
    form = Form(("count", "count", "number"), "", "", "three columns")
    assert triples(Path("x"), stream, form)[2].tolist() == [1.5e-100, -2.5e100]


@pytest.mark.parametrize("name", FORMATS)
@pytest.mark.parametrize(
    "wrong",
    ["2,5", "1.0\0", "1.0.0", "2.0e", "nan", "inf", "--1", "0x1p3", "1;5", "2.0 7", "", "1_0", "2.0F+08"],
)
def test_what_is_no_number_is_refused_with_file_and_line(tmp_path, block, name, wrong) -> None:
    points, K, M = block
    write, k, m = FORMATS[name]
    write(tmp_path / m, M, full)
    count = 0

    def form(value: float) -> str:
        nonlocal count
        count += 1
        return wrong if count == 40 else full(value)

    write(tmp_path / k, K, form)
    if name == "array" and wrong == "":  # an empty line is left out, and the number is missing
        with pytest.raises(ValueError, match=r"k\.mtx has 4655 numbers where 96 rows .* are 4656"):
            read_matrices(tmp_path / k, tmp_path / m, points)
        return
    line = 40 + {"MatrixMarket": 3, "array": 2, "Abaqus": 1}.get(name, 0)
    with pytest.raises(ValueError, match=rf"k\.(mtx|sti), line {line} is "):
        read_matrices(tmp_path / k, tmp_path / m, points)


@pytest.mark.parametrize("name", FORMATS)
def test_a_number_beyond_the_range_is_refused(tmp_path, block, name) -> None:
    points, K, M = block
    write, k, m = FORMATS[name]
    write(tmp_path / m, M, full)
    write(tmp_path / k, K, lambda v: f"{v:.6e}" + "99")
    with pytest.raises(
        ValueError, match=r"k\.(mtx|sti)(, in line \d+ or below| has a number beyond 1.8e308)"
    ):
        read_matrices(tmp_path / k, tmp_path / m, points)


def test_a_cut_file_is_refused_or_warned_of(tmp_path, block) -> None:
    points, K, M = block
    matrix_market(tmp_path / "m.mtx", M, full)
    matrix_market(tmp_path / "k.mtx", K, fortran)
    data = (tmp_path / "k.mtx").read_bytes()
    entries = data.count(b"\n") - 3
    for cut, message in (
        (data.rindex(b"\n", 0, -1) + 1, f"has {entries - 1} entries where its sizes say {entries}"),
        (data.rindex(b"D") + 1, f"line {entries + 3} is"),
        (data.rindex(b" "), f"line {entries + 3} is"),
        (60, "line 2 is|ends before the line of sizes"),
    ):
        (tmp_path / "k.mtx").write_bytes(data[:cut])
        with pytest.raises(ValueError, match=f"k.mtx.*({message})"):
            read_matrices(tmp_path / "k.mtx", tmp_path / "m.mtx", points)
    (tmp_path / "k.mtx").write_bytes(data[:-1])  # whole, and who could tell
    with pytest.warns(UnfinishedLine, match="k.mtx ends within a line"):
        read_matrices(tmp_path / "k.mtx", tmp_path / "m.mtx", points)


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ("%%MatrixMarket matrix coordinate pattern symmetric\n2 2 2\n1 1\n2 2\n", "holds a pattern"),
        ("%%MatrixMarket matrix coordinate complex symmetric\n", "'complex' numbers"),
        ("%%MatrixMarket matrix coordinate real skew-symmetric\n", "is 'skew-symmetric'"),
        ("%%MatrixMarket matrix coordinate real\n", "line 1 is"),
        ("%%MatrixMarket matrix coordinate real general\n2 3 1\n1 1 1.0\n", "it must be square"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 -1\n", "line 2 is '2 2 -1'"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1.0\n", "row or column 3"),
        ("%%MatrixMarket matrix coordinate real general\n2 2 1\n0 1 1.0\n", "line 3 is '0 1 1.0'"),
        ("%%MatrixMarket matrix coordinate real general\n99999999999999 99999999999999 1\n1 1 1.0\n",
         "fewer than"),
        ("%%MatrixMarket matrix array real general\n9999999 9999999\n1.0\n", "1 numbers where"),
        ("%%MatrixMarket matrix coordinate real symmetric\n2 2 4\n1 1 2.0\n2 1 -1.0\n1 2 -1.0\n2 2 2.0\n",
         "says 'symmetric' and holds entries of both triangles"),
    ],
)  # fmt: skip
def test_a_matrix_market_file_that_means_something_else_is_named(tmp_path, head, message) -> None:
    (tmp_path / "k.mtx").write_text(head)
    with pytest.raises(ValueError, match=rf"k\.mtx.*{message}"):
        read_matrices(tmp_path / "k.mtx", tmp_path / "k.mtx")


def test_blocks_are_put_together(tmp_path, block, monkeypatch) -> None:
    """Lines across the bounds of blocks, here of a few lines each, and the number of a wrong one."""
    points, K, M = block
    monkeypatch.setattr(text_tables, "BLOCK", 200)
    matrix_market(tmp_path / "k.mtx", K, full)
    matrix_market(tmp_path / "m.mtx", M, full)
    assert (
        abs(read_matrices(tmp_path / "k.mtx", tmp_path / "m.mtx", points).K - K).max() <= 1e-15 * abs(K).max()
    )
    lines = (tmp_path / "k.mtx").read_text().splitlines()
    lines[500] = "7 7 7,0"
    (tmp_path / "k.mtx").write_text("\n".join(lines) + "\n")
    with pytest.raises(ValueError, match="line 501 is '7 7 7,0'"):
        read_matrices(tmp_path / "k.mtx", tmp_path / "m.mtx", points)


# ---------------------------------------------------------------- six digits


def rounded(A: Any, digits: int) -> Any:
    A = A.tocoo()
    values = [float(f"{v:.{digits - 1}e}") for v in A.data]
    return scipy.sparse.csr_matrix((values, (A.row, A.col)), shape=A.shape)


BODIES = [
    ((0.1, 0.02, 0.03), (3, 2, 2)),
    ((0.1, 0.02, 0.03), (11, 3, 4)),
    ((0.3, 0.01, 0.01), (31, 2, 2)),
    ((0.05, 0.05, 0.002), (6, 6, 2)),
]


@pytest.mark.parametrize(("size", "nodes"), BODIES)
def test_six_digits_are_enough(size, nodes) -> None:
    mesh = bd.box_mesh(*(np.linspace(0.0, length, n) for length, n in zip(size, nodes, strict=True)))
    full = bd.Solid(mesh, bd.STEEL, {"a": "x-"}, f_max=0).full_model()
    mass = bd.STEEL.density * math.prod(size)
    found = check_matrices(rounded(full.K, 6), rounded(full.M, 6), mesh.points, expected_mass=mass)
    check_matrices(rounded(full.K, 6), rounded(full.M, 6))  # where nothing says what rigid motion is
    assert abs(found.K - full.K).max() <= 5e-6 * abs(full.K).max()


@pytest.mark.parametrize("digits", [6, 17])
def test_an_unstable_body_is_still_refused(block, digits) -> None:
    """The softest elastic mode made unstable by half its stiffness."""
    points, K, M = block
    lam, phi = scipy.linalg.eigh(K.toarray(), M.toarray(), subset_by_index=[6, 6])
    p = M @ phi[:, 0]
    with pytest.raises(ValueError, match="K is indefinite"):
        check_matrices(rounded(scipy.sparse.csr_matrix(K - 1.5 * lam[0] * np.outer(p, p)), digits), M, points)


# ---------------------------------------------------------------- archives


def archive(path: Path, block: tuple[Any, Any, Any], **change: Any) -> None:
    points, K, M = block
    labels = np.array([(i // 3 + 1, i % 3 + 1) for i in range(K.shape[0])], dtype=np.float64)
    np.savez(path, **{"K": K.toarray(), "M": M.toarray(), "points": points, "labels": labels, **change})


def test_labels_that_are_no_whole_numbers_are_named(tmp_path, block) -> None:
    path = tmp_path / "m.npz"
    for wrong in (math.nan, 1.9, math.inf, 1e300):
        labels = np.array([(i // 3 + 1, i % 3 + 1) for i in range(96)], dtype=np.float64)
        labels[5, 0] = wrong
        archive(path, block, labels=labels)
        with pytest.raises(ValueError, match=f"m.npz: labels has {wrong:g}".replace("+", r"\+")):
            read_matrices(path)
    for change, message in (
        ({"internal": 1.9}, "internal is 1.9"),
        ({"internal": math.nan}, "internal is nan"),
        ({"internal": [1, 2]}, "internal of shape"),
        ({"K": block[1].toarray() != 0}, "K holds truth values, a pattern"),
        ({"K": np.array(["a"])}, "not numbers"),
        ({"labels": np.array([["a", "b"]])}, "not numbers"),
        ({"K": np.full((96, 96), 1 + 1j)}, "K is complex"),
    ):
        archive(path, block, **change)
        with pytest.raises(ValueError, match=f"m.npz.*{message}"):
            read_matrices(path)


def test_a_zip_bomb_and_an_encrypted_archive_are_named(tmp_path, block) -> None:
    path = tmp_path / "m.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made, made.open("K.npy", "w") as stream:
        for _ in range(300):
            stream.write(bytes(1 << 20))
    tracemalloc.start()
    with pytest.raises(ValueError, match=r"m.npz.*K unpacks from \d+ to 314572800 bytes"):
        read_matrices(path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 1 << 23  # B: nothing was unpacked
    archive(path, block)
    data = bytearray(path.read_bytes())
    at = data.index(b"PK\x01\x02")
    data[at + 8] |= 1  # flag of encryption, in the directory
    path.write_bytes(data)
    with pytest.raises(ValueError, match=r"m\.npz.*encrypted"):
        read_matrices(path)


def test_an_array_that_says_it_is_larger_than_it_is_takes_no_memory(tmp_path, block) -> None:
    path = tmp_path / "m.npz"
    made = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        made, {"descr": "<f8", "fortran_order": False, "shape": (1_000_000, 1_000_000)}
    )
    with zipfile.ZipFile(path, "w") as packed:
        packed.writestr("K.npy", made.getvalue() + bytes(80))
    with pytest.raises(ValueError, match=r"m.npz.*K has 80 bytes, which are not the shape"):
        read_matrices(path)


@pytest.mark.slow
def test_large_files_are_read_about_as_fast_as_numpy_reads_them(tmp_path) -> None:
    """By np.loadtxt, which reads numbers alone; SciPy's own reader, faster by far, checks nothing."""
    n, rng = 1_000_000, np.random.default_rng(0)
    lines = zip(rng.integers(1, 99999, n), rng.integers(1, 99999, n), rng.standard_normal(n), strict=True)
    text = "".join(f"{i} {j} {v:.15e}\n" for i, j, v in lines)
    path, bare = tmp_path / "a.mtx", tmp_path / "bare.txt"
    path.write_text(f"%%MatrixMarket matrix coordinate real general\n100000 100000 {n}\n{text}")
    bare.write_text(text)
    begun = time.process_time()
    np.loadtxt(bare)
    theirs = time.process_time() - begun
    begun = time.process_time()
    found = matrix_market_file._read(path)
    ours = time.process_time() - begun
    print(f"{len(text) / 1e6 / ours:.1f} MB/s, np.loadtxt {len(text) / 1e6 / theirs:.1f} MB/s")
    assert abs(found - scipy.io.mmread(path)).max() == 0
    assert ours < 3.0 * theirs  # 1.2 was measured; the neighbours on the machine move either


def test_comments_without_end_are_given_up(tmp_path: Path) -> None:
    """Twelve million lines of them took 5.6 s."""
    path = tmp_path / "k.mtx"
    path.write_bytes(b"%%MatrixMarket matrix coordinate real symmetric\n" + b"% x\n" * 300_000)
    with pytest.raises(ValueError, match=r"k\.mtx, line 100001: so many comments"):
        read_matrices(path, path, np.zeros((1, 3)))
