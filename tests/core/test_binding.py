"""The contract of bearingdyn.core: any layout is good, inputs are left alone, references are kept."""

from __future__ import annotations

import contextlib
import gc
import os
import re
import subprocess
import sys
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from bearingdyn import _core, core
from core_models import CASTABLE, KERNEL, SCHEME, N, arguments, at_rest, harmonic, stepping

# ---------------------------------------------------------------- layouts and types of good input


@pytest.mark.parametrize("kind", CASTABLE)
@pytest.mark.parametrize("layout", ["C", "F", "strided", "negative", "byte-swapped", "list", "overlapping"])
def test_any_layout_gives_the_same_bits(layout: str, kind: type) -> None:
    def laid(array: np.ndarray) -> Any:
        array = np.round(array * 2).astype(kind)
        if layout == "C":
            return np.ascontiguousarray(array)
        if layout == "F":
            return np.asfortranarray(array)
        if layout == "strided":
            big = np.full([3 * s + 1 for s in array.shape], 7, kind)
            view = big[tuple(slice(1, None, 3) for _ in array.shape)]
            view[...] = array
            return view
        if layout == "negative":
            flipped = tuple(slice(None, None, -1) for _ in array.shape)
            return array[flipped].copy()[flipped]
        if layout == "byte-swapped":
            return array.astype(np.dtype(kind).newbyteorder())
        if layout == "overlapping":  # a window on memory that holds the array twice
            return np.lib.stride_tricks.as_strided(np.concatenate([array, array]), array.shape, array.strides)
        return array.tolist()

    def build(convert: Any) -> np.ndarray:
        a = arguments()
        B = a["bearings"][0][1]
        L, modulus, tau = a["layers"][0]
        a |= {name: convert(a[name]) for name in "MCGKN"}
        a["bearings"] = [(KERNEL, convert(B))]
        a["layers"] = [(convert(L), convert(modulus), tau)]
        a["loads"] = [(k, w, convert(p), convert(q), t, v) for k, w, p, q, t, v in a["loads"]]
        m = core.Model(**a)
        state = m.state(0.0, convert(np.arange(N) * 0.0), convert(np.zeros(N)))
        return core.march(m, state, SCHEME, 40, start=True)[0]

    plain = build(lambda array: np.ascontiguousarray(np.round(array * 2).astype(kind).astype(np.float64)))
    np.testing.assert_array_equal(build(laid), plain)


def test_inputs_are_untouched_and_may_be_read_only() -> None:
    a = arguments()
    arrays: list[np.ndarray] = []

    def collect(value: Any) -> None:
        if isinstance(value, np.ndarray):
            value.flags.writeable = False
            arrays.append(value)
        elif isinstance(value, list | tuple):
            for item in value:
                collect(item)

    collect(list(a.values()))
    before = [x.tobytes() for x in arrays]
    m = core.Model(**a)
    x = np.full(N, 1e-6)
    state = m.state(0.0, x, np.zeros(N))
    kept = state.copy()
    state.flags.writeable = False
    _, new, _ = core.march(m, state, SCHEME, 30, start=True)
    core.energies(m, state)
    assert [x.tobytes() for x in arrays] == before
    np.testing.assert_array_equal(state, kept)
    assert not np.shares_memory(new, state)
    assert (x == 1e-6).all()


def test_a_model_keeps_nothing_of_its_inputs() -> None:
    a = arguments()
    m, other = core.Model(**a), core.Model(**a)
    expected = core.march(other, at_rest(other), SCHEME, 50, start=True)[0]
    for name in "MCGKN":
        a[name][...] = np.nan
    a["bearings"][0][1][...] = np.nan
    a["layers"][0][0][...] = np.nan
    for _, _, p, q, t, v in a["loads"]:
        p[...] = q[...] = np.nan
        t[...] = v[...] = np.nan
    np.testing.assert_array_equal(core.march(m, at_rest(m), SCHEME, 50, start=True)[0], expected)


# ---------------------------------------------------------------- references and memory


def test_references_are_stable() -> None:
    a = arguments()
    x = np.zeros(N)
    m = core.Model(**a)
    state = m.state(0.0, x, x)
    bad = arguments() | {"layers": [(a["layers"][0][0], np.ones(2), np.zeros(2))]}
    watched = [
        *a.values(),
        *bad.values(),
        x,
        state,
        m,
        KERNEL["order"],
        KERNEL["sine"],
        KERNEL["table"],
        SCHEME,
    ]

    def count() -> list[int]:
        return [sys.getrefcount(w) for w in watched]

    def once() -> None:
        model_again = core.Model(**a)
        model_again.state(0.0, x, x)
        m.unpack(state)
        core.march(m, state, SCHEME, 3, start=True, progress=lambda done, total: None)
        harmonic(m)
        _core.bearing_force(KERNEL, np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)
        _core.maxwell_stress(np.ones((3, 2)), np.ones(2), 1.0, 1.0, np.ones(1), np.ones(1))
        for call in (
            lambda: core.Model(**bad),
            lambda: core.march(m, state[:-1], SCHEME, 3),
            lambda: core.march(m, state, stepping(dt=-1.0), 3),
            lambda: core.march(m, state, SCHEME, 3, progress=lambda done, total: 1 / 0),
            lambda: harmonic(m, row=np.zeros((1, N + 1))),
            lambda: harmonic(m, progress=lambda done, total: 1 / 0),
            lambda: _core.bearing_force(
                {**KERNEL, "sine": None}, np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0
            ),
        ):
            with contextlib.suppress(ValueError, TypeError, ZeroDivisionError):
                call()
                raise AssertionError("a bad call went through")

    once()
    before = count()
    for _ in range(20):
        once()
    assert count() == before

    # Python's and NumPy's memory; the core's own slabs are watched by the sanitizers
    tracemalloc.start()
    once()
    gc.collect()
    first = tracemalloc.get_traced_memory()[0]
    for _ in range(50):
        once()
    gc.collect()
    grown = tracemalloc.get_traced_memory()[0] - first
    tracemalloc.stop()
    assert grown < 2000  # one reference leaked in each round would be 50 times 40 bytes or more


def resident_pages() -> int:
    return int(Path("/proc/self/statm").read_text().split()[1])


@pytest.mark.skipif(
    not Path("/proc/self/maps").exists() or "libasan" in Path("/proc/self/maps").read_text(),
    reason="resident memory is read from /proc, and a sanitizer keeps what is freed",
)
def test_models_and_marches_give_their_memory_back() -> None:
    big = 120
    zero = np.zeros((big, big))
    eye = np.eye(big)

    def once() -> None:  # a model of 5 × 115 kB, a work of some 300 kB
        m = core.Model(eye, zero, zero, eye, zero, [], [], [], [])
        core.march(m, m.state(0.0, np.zeros(big), np.zeros(big)), SCHEME, 1, start=True)

    for _ in range(20):
        once()
    before = resident_pages()
    for _ in range(200):
        once()
    # leaked models would be 28 000 pages
    assert resident_pages() - before < 3000


# ---------------------------------------------------------------- LAPACK

FOREIGN_LAPACK = """
import ctypes, importlib.util, sys, types
import scipy.linalg.cython_lapack as real

new = ctypes.pythonapi.PyCapsule_New
new.restype, new.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]
name = ctypes.pythonapi.PyCapsule_GetName
name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
pointer = ctypes.pythonapi.PyCapsule_GetPointer
pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]

kept, table = [], {{}}
for routine in ("dgetrf", "dgetrs", "zgetrf", "zgetrs"):
    capsule = real.__pyx_capi__[routine]
    signature = name(capsule)
    changed = signature.decode().{change}.encode()
    kept.append(changed)
    table[routine] = new(pointer(capsule, signature), changed, None)
fake = types.ModuleType("scipy.linalg.cython_lapack")
fake.__pyx_capi__ = table
sys.modules["scipy.linalg.cython_lapack"] = fake
# the module alone: the package would import those parts of SciPy that look at the signatures themselves
spec = importlib.util.spec_from_file_location("bearingdyn._core", {path!r})
try:
    spec.loader.exec_module(importlib.util.module_from_spec(spec))
except ImportError as error:
    print("refused:", error)
else:
    print("taken")
"""


@pytest.mark.parametrize(
    ("change", "answer"),
    [
        ('replace("int *", "int64_t *")', "refused: .*32-bit"),
        ('replace("int *", "long *")', "refused: .*32-bit"),
        ('replace("int *", "long int *")', "refused: .*32-bit"),
        ('replace("int *", "npy_int64 *")', "refused: .*32-bit"),
        ('replace("int *", "long long *")', "refused: .*32-bit"),
        ('replace("char *", "int *")', "refused: "),
        ('replace("int *, ", "", 1)', "refused: "),
        ('replace("void", "int")', "taken"),
        ('replace("__pyx_t_5scipy_6linalg_13cython_lapack_", "some_other_")', "taken"),
    ],
)
def test_lapack_is_told_by_its_signature(change: str, answer: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", FOREIGN_LAPACK.format(change=change, path=_core.__file__)],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
        check=False,
    )
    assert re.match(answer, done.stdout), done.stdout + done.stderr
