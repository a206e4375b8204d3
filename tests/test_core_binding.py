"""The contract of the binding: whatever comes in, only exceptions come out, and inputs are left alone."""

from __future__ import annotations

import contextlib
import gc
import os
import re
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bearingdyn import _core, core
from bearingdyn.bearing import BallBearing, TabulatedDamping

N = 6
Z0 = np.zeros(0)
BEARING = BallBearing(
    Z=7,
    Dw=11.5e-3,
    Dpw=43.5e-3,
    fi=0.52,
    fo=0.53,
    clearance=5e-6,
    damping=TabulatedDamping([0.0, 1e-5], [10.0, 30.0]),
)
KERNEL = core.kernel_tuple(BEARING.kernel())
CASTABLE = (np.float64, np.float32, np.int32, np.int64)


def arguments(seed: int = 1) -> dict[str, Any]:
    """Good arguments of Model: two blocks, a layer, a bearing, every load and channel."""
    rng = np.random.default_rng(seed)
    M, C, G, K, zero = np.eye(N), np.zeros((N, N)), np.zeros((N, N)), np.zeros((N, N)), np.zeros((N, N))
    w = 2 * np.pi * np.geomspace(60.0, 4e3, N)
    K, C = np.diag(w**2), np.diag(0.05 * w)
    G[0, 1], G[1, 0] = 0.1, -0.1
    L = np.zeros((N, 2))
    L[2:5] = rng.standard_normal((3, 2))
    B = 0.5 * rng.standard_normal((5, N))
    p = 100.0 * rng.standard_normal((2, N))
    return {
        "M": M,
        "C": C,
        "G": G,
        "K": K,
        "N": zero,
        "layers": [(L, np.array([1e5, 1e6]), np.array([1e-3, 1e-5]))],
        "bearings": [(KERNEL, B)],
        "loads": [
            (0, 0.0, p[0], p[1], np.zeros(0), np.zeros(0)),
            (1, 5e3, p[0], p[1], np.zeros(0), np.zeros(0)),
            (2, 0.0, 1e-6 * p[0], 1e-6 * p[1], np.zeros(0), np.zeros(0)),
            (3, 0.0, p[0], p[1], np.array([0.0, 1e-3]), np.array([0.0, 1.0])),
        ],
        "channels": [(k, np.eye(N)[k % N], 0, 0) for k in range(6)],
    }


def model(**changes: Any) -> core.Model:
    return core.Model(**(arguments() | changes))


def at_rest(m: core.Model) -> np.ndarray:
    return m.state(0.0, np.zeros(N), np.zeros(N))


SCHEME = core.Scheme(dt=2.5e-6, speed=300.0)

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


# ---------------------------------------------------------------- bad input


def replaced(array: Any, at: Any, value: float) -> np.ndarray:
    array = np.array(array, dtype=float)
    array[at] = value
    return array


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", list("MCGKN"))
def test_a_matrix_that_is_not_finite_is_named(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=rf"\b{name}\b"):
        model(**{name: replaced(arguments()[name], (2, 3), value)})


@pytest.mark.parametrize("name", list("MCGKN"))
@pytest.mark.parametrize("shape", [(), (N,), (N, N + 1), (N + 1, N + 1), (0, 0), (N, N, 1)])
def test_a_matrix_of_another_shape_is_named(name: str, shape: tuple[int, ...]) -> None:
    if name == "M" and shape == (N + 1, N + 1):
        name = "C"  # M sets the size
    with pytest.raises(ValueError, match=rf"\b{name}\b"):
        model(**{name: np.zeros(shape)})


@pytest.mark.parametrize(
    "bad", [None, "M", object(), [[1, "x"]], np.eye(N) * 1j, np.eye(N, dtype=object), {}]
)
def test_what_is_no_matrix_is_refused(bad: object) -> None:
    with pytest.raises((ValueError, TypeError)):
        model(K=bad)


def bad_branches() -> list[Any]:
    L, G, tau = arguments()["layers"][0]
    return [
        (L, -G, tau),
        (L, G, -tau),
        (L, G, 0 * tau),
        (L, G, replaced(tau, 0, np.nan)),
        (L, G, replaced(tau, 0, np.inf)),
        (L, replaced(G, 0, np.inf), tau),
        (L, G, tau[:1]),
        (L[:, :0], G, tau),
        (L[:-1], G, tau),
        (replaced(L, (0, 0), np.nan), G, tau),
        (L, G),
        [L, G, tau],
        (L, G, tau, tau),
        None,
        7,
    ]


@pytest.mark.parametrize("i", range(15))
def test_a_bad_layer_is_refused(i: int) -> None:
    with pytest.raises((ValueError, TypeError)):
        model(layers=[bad_branches()[i]])


BAD_BEARINGS = [
    (0, 0),  # balls
    (0, -3),
    (0, 2**31 - 1),
    (0, 2**40),
    (1, np.array([1, 1, 0, 1, -1], np.intc)),
    (1, np.array([1, 1, 0, 1, 2**31 - 1], np.intc)),
    (1, np.zeros(0, np.intc)),
    (1, np.array([1.0, 1, 0, 1, 1])),
    (2, np.array([0, 1, 0], np.intc)),
    (3, 6),
    (3, -1),
    (4, np.nan),
    (5, np.inf),
    (6, 0.0),
    (6, np.inf),
    (7, np.nan),
    (8, -1.0),
    (8, np.inf),
    (9, -1e-9),
    (9, np.inf),
    (10, 3),
    (10, -1),
    (11, -1.0),
    (11, np.inf),
    (12, np.zeros((0, 2))),  # an empty table
    (12, np.array([[0.0, 1.0], [0.0, 2.0]])),  # unsorted
    (12, np.array([[np.nan, 1.0]])),
    (12, np.array([[0.0, np.nan]])),
    (12, np.array([[0.0, -1.0]])),
    (12, np.zeros((3, 3))),
    (13, np.nan),
    (14, np.inf),
    (14, "0"),
]


@pytest.mark.parametrize(("field", "value"), BAD_BEARINGS)
def test_a_bad_bearing_is_refused(field: int, value: Any) -> None:
    bad = (*KERNEL[:field], value, *KERNEL[field + 1 :])
    B = arguments()["bearings"][0][1]
    with pytest.raises((ValueError, TypeError, OverflowError)):
        model(bearings=[(bad, B)])
    with pytest.raises((ValueError, TypeError, OverflowError)):
        _core.bearing_force(bad, np.zeros(5), np.zeros(5), 0.0, 0.0)


@pytest.mark.parametrize(
    "bad", [(KERNEL[:-1], None), (list(KERNEL), None), (None, None), (KERNEL, np.zeros((4, N)))]
)
def test_a_bearing_of_another_form_is_refused(bad: Any) -> None:
    kernel, B = bad
    with pytest.raises((ValueError, TypeError)):
        model(bearings=[(kernel, arguments()["bearings"][0][1] if B is None else B)])
    with pytest.raises((ValueError, TypeError)):
        model(bearings=[[KERNEL, arguments()["bearings"][0][1]]])


P = np.ones(N)


@pytest.mark.parametrize(
    "bad",
    [
        (4, 0.0, P, P, Z0, Z0),
        (-1, 0.0, P, P, Z0, Z0),
        (1, np.nan, P, P, Z0, Z0),
        (0, 0.0, P[:-1], P, Z0, Z0),
        (0, 0.0, replaced(P, 0, np.nan), P, Z0, Z0),
        (1, 0.0, P, replaced(P, 0, np.inf), Z0, Z0),
        (3, 0.0, P, P, Z0, Z0),
        (3, 0.0, P, P, np.array([0.0, 0.0]), np.array([1.0, 2.0])),
        (3, 0.0, P, P, np.array([1.0, 0.0]), np.array([1.0, 2.0])),
        (3, 0.0, P, P, np.array([np.nan]), np.array([1.0])),
        (3, 0.0, P, P, np.array([0.0, 1.0]), np.array([1.0])),
        (3, 0.0, P, P, np.array([0.0, np.inf]), np.array([1.0, 2.0])),
        (0, 0.0, P, P),
        [0, 0.0, P, P, Z0, Z0],
        None,
    ],
)
def test_a_bad_load_is_refused(bad: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        model(loads=[bad])


@pytest.mark.parametrize(
    "bad",
    [
        (6, P, 0, 0),
        (-1, P, 0, 0),
        (0, P[:-1], 0, 0),
        (0, None, 0, 0),
        (0, replaced(P, 0, np.nan), 0, 0),
        (3, None, 1, 0),
        (3, None, -1, 0),
        (3, None, 0, 5),
        (4, None, 0, 7),
        (4, None, 0, -1),
        (4, None, 0, 2**31),
        (5, None, 3, 0),
        [0, P, 0, 0],
        "0Pxx",
    ],
)
def test_a_bad_channel_is_refused(bad: Any) -> None:
    with pytest.raises((ValueError, TypeError, OverflowError)):
        model(channels=[bad])


@pytest.mark.parametrize("name", ["layers", "bearings", "loads", "channels"])
@pytest.mark.parametrize("bad", [None, 3, np.float64(1.0)])
def test_what_is_no_sequence_is_named(name: str, bad: object) -> None:
    with pytest.raises((ValueError, TypeError), match=name):
        model(**{name: bad})


def test_a_list_that_shrinks_while_it_is_read_does_no_harm() -> None:
    """Conversion of an item may run any code, even such as changes the list it stands in."""
    items: list[Any] = []

    class Shrinking:
        def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
            items.clear()
            return np.ones(N)

    items += [(0, 0.0, Shrinking(), np.ones(N), Z0, Z0) for _ in range(3)]
    m = model(loads=items)
    assert core.march(m, at_rest(m), SCHEME, 3, start=True)[2].status == 0


def test_a_list_that_grows_while_it_is_read_does_no_harm() -> None:
    items: list[Any] = []

    class Growing:
        def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
            items.extend((0, 0.0, np.ones(N), np.ones(N), Z0, Z0) for _ in range(1000))
            return np.ones(N)

    items += [(0, 0.0, Growing(), np.ones(N), Z0, Z0) for _ in range(3)]
    model(loads=items)


@pytest.mark.parametrize(
    "change",
    [
        {"dt": 0.0},
        {"dt": -1e-6},
        {"dt": np.nan},
        {"dt": np.inf},
        {"beta": -0.1},
        {"beta": np.nan},
        {"gamma": np.inf},
        {"speed": np.nan},
        {"tolerance": 0.0},
        {"tolerance": np.nan},
        {"max_iterations": 0},
        {"max_iterations": 2**40},
        {"dt": "1"},
    ],
)
def test_a_bad_scheme_is_refused(change: dict[str, Any]) -> None:
    m = model()
    with pytest.raises((ValueError, TypeError, OverflowError)):
        core.march(m, at_rest(m), core.Scheme(**({"dt": 1e-6} | change)), 5, start=True)


@pytest.mark.parametrize(
    ("steps", "decimate"),
    [(-1, 1), (5, 0), (5, -3), (2**63 - 1, 1), (2**62, 1), (2**64, 1), (1.5, 1), (None, 1)],
)
def test_a_bad_number_of_steps_is_refused(steps: Any, decimate: Any) -> None:
    m = model()
    with pytest.raises((ValueError, TypeError, OverflowError, MemoryError)):
        core.march(m, at_rest(m), SCHEME, steps, decimate)


def test_a_state_is_checked() -> None:
    m = model()
    state = at_rest(m)
    for bad in (state[:-1], np.append(state, 0.0), state.reshape(1, -1), None, replaced(state, 9, np.nan)):
        with pytest.raises(ValueError, match="state"):
            core.march(m, bad, SCHEME, 5)
        with pytest.raises(ValueError, match="state"):
            m.unpack(bad)
    for x in (np.zeros(N + 1), np.full(N, np.nan), "x"):
        with pytest.raises(ValueError, match=r"^x (must|has)"):
            m.state(0.0, x, np.zeros(N))
        with pytest.raises(ValueError, match=r"^v (must|has)"):
            m.state(0.0, np.zeros(N), x)
    for t in (np.nan, np.inf):
        with pytest.raises(ValueError, match="t must"):
            m.state(t, np.zeros(N), np.zeros(N))


@pytest.mark.parametrize("at", range(4))
@pytest.mark.parametrize("value", [1e300, -1e300, -1.0, 2.0**63])
def test_a_state_with_an_absurd_clock_does_no_harm(at: int, value: float) -> None:
    m = model()
    state = core.march(m, at_rest(m), SCHEME, 5, start=True)[1]
    try:
        record, _, report = core.march(m, replaced(state, at, value), SCHEME, 5)
    except ValueError:
        return
    assert len(record) <= 6
    assert report.status <= 0


def harmonic(m: core.Model, **changes: Any) -> np.ndarray:
    a = {
        "omega": np.array([0.0, 10.0, 2e3]),
        "modulus": np.full((3, 1), 1e6 + 1e5j),
        "bearing_K": 1e7 * np.eye(5),
        "bearing_C": 30.0 * np.eye(5),
        "force": np.eye(N)[:2],
        "row": np.eye(N)[:3],
    }
    return core.harmonic(m, **(a | changes))


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("omega", np.array([0.0, np.nan, 1.0])),
        ("omega", np.zeros((3, 1))),
        ("modulus", np.full((3, 1), np.nan + 0j)),
        ("modulus", np.full((3, 1), 1 + 1j * np.inf)),
        ("modulus", np.ones((2, 1), complex)),
        ("modulus", np.ones((3, 2), complex)),
        ("modulus", "x"),
        ("bearing_K", np.eye(4)),
        ("bearing_K", replaced(np.eye(5), (0, 0), np.nan)),
        ("bearing_C", np.eye(5)[0]),
        ("bearing_C", replaced(np.eye(5), (0, 0), np.inf)),
        ("force", np.eye(N - 1)),
        ("force", np.full((1, N), np.nan)),
        ("row", np.full((1, N), np.nan)),
        ("row", np.zeros(N)),
        ("speed", np.nan),
    ],
)
def test_bad_harmonic_input_is_named(name: str, bad: Any) -> None:
    assert np.isfinite(harmonic(model())).all()
    with pytest.raises(ValueError, match=name):
        harmonic(model(), **{name: bad})


def test_harmonic_shapes() -> None:
    m = model()
    assert harmonic(m).shape == (3, 3, 2)
    assert harmonic(m, omega=Z0, modulus=np.zeros((0, 1), complex)).shape == (0, 3, 2)
    assert harmonic(m, force=np.zeros((0, N))).shape == (3, 3, 0)
    assert harmonic(m, row=np.zeros((0, N))).shape == (3, 0, 2)
    real = harmonic(m, modulus=np.full((3, 1), 1e6))
    np.testing.assert_array_equal(real, harmonic(m, modulus=np.full((3, 1), 1e6 + 0j)))


def test_a_body_that_floats_is_singular_at_rest() -> None:
    one = np.ones((1, 1))
    m = core.Model(one, 0 * one, 0 * one, 0 * one, 0 * one, [], [], [], [])
    with pytest.raises(ArithmeticError, match="singular"):
        core.harmonic(m, np.zeros(1), np.zeros((1, 0), complex), np.zeros((0, 0)), np.zeros((0, 0)), one, one)


@pytest.mark.parametrize(
    "bad",
    [
        dict(rate=np.full((3, 2), np.nan)),
        dict(rate=np.zeros(3)),
        dict(rate=np.zeros((0, 2**31 - 1))),
        dict(dt=np.array([1.0, 0.0])),
        dict(dt=np.array([1.0, np.nan])),
        dict(dt=np.array([1.0])),
        dict(G0=np.nan),
        dict(eta0=np.inf),
        dict(G=np.array([np.inf])),
        dict(G=np.array([-1.0])),
        dict(G=np.array([1.0, 2.0])),
        dict(tau=np.array([0.0])),
        dict(tau=np.array([np.inf])),
    ],
)
def test_bad_input_of_the_branch_stress_is_refused(bad: dict[str, Any]) -> None:
    good: dict[str, Any] = dict(
        rate=np.ones((3, 2)),
        dt=np.array([1.0, 2.0]),
        G0=1.0,
        eta0=1.0,
        G=np.array([1.0]),
        tau=np.array([1.0]),
    )
    a = good | bad
    with pytest.raises((ValueError, MemoryError)):
        _core.maxwell_stress(a["rate"], a["dt"], a["G0"], a["eta0"], a["G"], a["tau"])


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_bearing_is_not_asked_about_no_number(value: float) -> None:
    for at in range(4):
        a: list[Any] = [np.zeros(5), np.zeros(5), 0.0, 0.0]
        a[at] = np.full(5, value) if at < 2 else value
        with pytest.raises(ValueError):
            _core.bearing_force(KERNEL, *a)


# what hypothesis throws at every argument
anything = st.one_of(
    st.none(),
    st.integers(-(2**70), 2**70),
    st.floats(),
    st.text(max_size=3),
    st.just(np.zeros((0, 0))),
    st.sampled_from(CASTABLE).flatmap(
        lambda kind: st.tuples(st.integers(0, N + 1), st.integers(0, N + 1)).map(lambda s: np.ones(s, kind))
    ),
    st.lists(st.floats(), max_size=N).map(np.array),
    st.lists(st.tuples(st.integers(-2, 9), st.floats(), st.integers(-2, 9)), max_size=2),
)


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_only_exceptions_come_out_of_a_model(data: st.DataObject) -> None:
    a = arguments()
    for name in data.draw(st.lists(st.sampled_from(list(a)), min_size=1, max_size=3, unique=True)):
        if name in ("layers", "bearings", "loads", "channels") and data.draw(st.booleans()):
            item = list(a[name][0])
            item[data.draw(st.integers(0, len(item) - 1))] = data.draw(anything)
            a[name] = [tuple(item)]
        else:
            a[name] = data.draw(anything)
    try:
        m = core.Model(**a)
    except (ValueError, TypeError, OverflowError, MemoryError):
        return
    n = len(a["M"])
    record, state, _ = core.march(m, m.state(0.0, np.zeros(n), np.zeros(n)), SCHEME, 5, start=True)
    assert np.isfinite(record).all()
    assert np.isfinite(state).all()


@settings(max_examples=300, deadline=None)
@given(data=st.data())
def test_only_exceptions_come_out_of_a_march(data: st.DataObject) -> None:
    m = model()
    good: list[Any] = [at_rest(m), 5, 1, 1e-6, 0.25, 0.5, 300.0, 1e-9, 20, False, 0, True, None]
    small = st.one_of(st.none(), st.integers(-3, 40), st.floats(), st.just(at_rest(m)), anything)
    for at in data.draw(st.lists(st.integers(0, len(good) - 1), min_size=1, max_size=3, unique=True)):
        value = data.draw(small)
        if isinstance(value, int) and at in (1, 8) and abs(value) > 100:
            value %= 100  # a march of 2**60 steps is not wrong, only long
        good[at] = value
    try:
        record, state, _ = m.march(*good)
    except (ValueError, TypeError, OverflowError, MemoryError):
        return
    assert np.isfinite(record).all()
    assert np.isfinite(state).all()


# ---------------------------------------------------------------- references and memory


def test_references_are_stable() -> None:
    a = arguments()
    x = np.zeros(N)
    m = core.Model(**a)
    state = m.state(0.0, x, x)
    bad = arguments() | {"layers": [(a["layers"][0][0], np.ones(2), np.zeros(2))]}
    watched = [*a.values(), *bad.values(), x, state, m, KERNEL[1], KERNEL[2], KERNEL[12], SCHEME]

    def count() -> list[int]:
        return [sys.getrefcount(w) for w in watched]

    def once() -> None:
        model_again = core.Model(**a)
        model_again.state(0.0, x, x)
        m.unpack(state)
        core.march(m, state, SCHEME, 3, start=True, progress=lambda done, total: None)
        harmonic(m)
        _core.bearing_force(KERNEL, np.zeros(5), np.zeros(5), 0.0, 0.0)
        _core.maxwell_stress(np.ones((3, 2)), np.ones(2), 1.0, 1.0, np.ones(1), np.ones(1))
        for call in (
            lambda: core.Model(**bad),
            lambda: core.march(m, state[:-1], SCHEME, 3),
            lambda: core.march(m, state, core.Scheme(dt=-1.0), 3),
            lambda: core.march(m, state, SCHEME, 3, progress=lambda done, total: 1 / 0),
            lambda: harmonic(m, row=np.zeros((1, N + 1))),
            lambda: harmonic(m, progress=lambda done, total: 1 / 0),
            lambda: _core.bearing_force(KERNEL[:-1], np.zeros(5), np.zeros(5), 0.0, 0.0),
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


# ---------------------------------------------------------------- threads


def test_threads_that_share_a_model_give_the_same_bits() -> None:
    m = model()
    x = 1e-6 * np.arange(N)
    expected, end, _ = core.march(m, m.state(0.0, x, x), SCHEME, 4000, 10, start=True)
    results: list[Any] = [None] * 8

    def run(i: int) -> None:
        results[i] = core.march(m, m.state(0.0, x, x), SCHEME, 4000, 10, start=True)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for record, state, _ in results:
        np.testing.assert_array_equal(record, expected)
        np.testing.assert_array_equal(state, end)


def test_twice_the_steps_is_two_marches_bit_for_bit() -> None:
    m = model()
    state = m.state(0.01, 1e-6 * np.arange(N), np.zeros(N))
    whole, end, _ = core.march(m, state, SCHEME, 600, 7, start=True)
    first, middle, _ = core.march(m, state, SCHEME, 300, 7, start=True)
    second, also_end, _ = core.march(m, middle, SCHEME, 300, 7)
    np.testing.assert_array_equal(np.vstack([first, second]), whole)
    np.testing.assert_array_equal(also_end, end)
    # a state survives a file
    np.testing.assert_array_equal(core.march(m, np.array(middle.tolist()), SCHEME, 300, 7)[1], end)


def test_other_threads_run_during_a_march() -> None:
    """The interpreter is free while the core works: a march of one call without chunks to speak of."""
    m = model()
    ticks: list[float] = []
    stop = threading.Event()

    def tick() -> None:
        while not stop.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-3)

    thread = threading.Thread(target=tick)
    thread.start()
    began = time.perf_counter()
    chunks: list[float] = []
    core.march(
        m,
        at_rest(m),
        SCHEME,
        300_000,
        1000,
        start=True,
        progress=lambda done, total: chunks.append(time.perf_counter()),
    )
    ended = time.perf_counter()
    stop.set()
    thread.join()
    # the longest chunk takes tens of ms; if the lock were held in it, no tick would fall inside
    edges = [began, *chunks, ended]
    longest = max(range(len(edges) - 1), key=lambda i: edges[i + 1] - edges[i])
    inside = [t for t in ticks if edges[longest] < t < edges[longest + 1]]
    assert len(inside) >= 3


# ---------------------------------------------------------------- progress, interrupts, failure


def test_progress_is_called_to_the_end() -> None:
    m = model()
    seen: list[tuple[int, int]] = []
    core.march(
        m, at_rest(m), SCHEME, 5000, start=True, progress=lambda done, total: seen.append((done, total))
    )
    assert seen[-1] == (5000, 5000)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})
    heard: list[tuple[int, int]] = []
    harmonic(m, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (3, 3)


@pytest.mark.parametrize("call", ["march", "harmonic"])
def test_an_exception_in_progress_comes_through(call: str) -> None:
    class Enough(Exception):
        pass

    def progress(done: int, total: int) -> None:
        raise Enough(done)

    m = model()

    def long_call() -> None:
        if call == "march":
            core.march(m, at_rest(m), SCHEME, 100_000, start=True, progress=progress)
        else:
            harmonic(m, progress=progress)

    with pytest.raises(Enough):
        long_call()
    with pytest.raises(TypeError):
        core.march(m, at_rest(m), SCHEME, 10, progress=3)  # type: ignore[arg-type]


def test_a_keyboard_interrupt_in_progress_ends_a_march_with_what_there_is() -> None:
    def progress(done: int, total: int) -> None:
        raise KeyboardInterrupt

    m = model()
    for steps in (1_000_000, 20):  # the second is done before anyone looks
        record, _, report = core.march(m, at_rest(m), SCHEME, steps, start=True, progress=progress)
        assert report.status == core.INTERRUPTED
        assert 0 < report.steps <= steps
        assert len(record) == report.steps
    with pytest.raises(KeyboardInterrupt):
        harmonic(m, progress=progress)


LONG_MARCH = """
import sys, time
sys.path.insert(0, {tests!r})
import numpy as np
from test_core_binding import SCHEME, core, model, at_rest
m = model()
print("ready", flush=True)
record, state, report = core.march(m, at_rest(m), SCHEME, 10**9, 100_000, start=True)
print("done", report.status, report.steps, len(record), time.time(), flush=True)
"""

SHORT_MARCHES = """
import sys, time
sys.path.insert(0, {tests!r})
import numpy as np
from test_core_binding import SCHEME, core, model, at_rest
m = model()
state = at_rest(m)
print("ready", flush=True)
for _ in range(10**6):
    record, state, report = core.march(m, state, SCHEME, 4000, 4000)
    if report.status != 0:
        break
print("done", report.status, report.steps, len(record), time.time(), flush=True)
"""


@pytest.mark.skipif(os.name == "nt", reason="SIGINT is sent by POSIX means")
@pytest.mark.parametrize("program", [LONG_MARCH, SHORT_MARCHES], ids=["a long march", "many short marches"])
def test_ctrl_c_ends_a_march_at_once(program: str) -> None:
    child = subprocess.Popen(
        [sys.executable, "-c", program.format(tests=str(Path(__file__).parent))],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert child.stdout is not None
    try:
        assert child.stdout.readline() == "ready\n"
        time.sleep(0.3)
        sent = time.time()
        child.send_signal(signal.SIGINT)
        answer, _ = child.communicate(timeout=20)
    finally:
        child.kill()
    found = re.fullmatch(r"done (\d+) (\d+) (\d+) ([\d.]+)\n", answer)
    assert found, answer
    status, steps, rows, at = (float(g) for g in found.groups())
    assert status == core.INTERRUPTED
    if program is LONG_MARCH:
        assert steps > 1000
        assert rows == steps // 100_000
    assert at - sent < 0.2


def test_a_short_call_listens_before_long_steps() -> None:
    """The first chunk is a step: a large system is interruptible from the start."""
    m = model()
    seen: list[int] = []
    core.march(m, at_rest(m), SCHEME, 1000, progress=lambda done, total: seen.append(done))
    assert seen[0] <= 4


def test_an_absurd_load_is_a_status_with_step_time_bearing_and_residual() -> None:
    """The push comes after 20 steps; what was computed up to there is kept."""
    time_table, value = np.array([20.5 * 2.5e-6, 21 * 2.5e-6]), np.array([0.0, 1e300])
    a = arguments()
    push = (3, 0.0, 1e8 * np.ones(N), np.zeros(N), time_table, value)
    m = model(loads=[a["loads"][0], push])
    record, state, report = core.march(m, at_rest(m), SCHEME, 100, start=True)
    calm, expected, _ = core.march(m, at_rest(m), SCHEME, 20, start=True)
    assert report.status < 0
    assert report.steps == len(record) == 20
    assert report.t == pytest.approx(20 * 2.5e-6, rel=1e-12)
    assert report.bearing == 0
    assert not report.residual <= SCHEME.tolerance
    assert report.text
    np.testing.assert_array_equal(record, calm)
    np.testing.assert_array_equal(state, expected)


def test_too_few_iterations_are_a_status() -> None:
    m = model()
    scheme = core.Scheme(dt=1e-4, speed=300.0, max_iterations=1)
    _, state, report = core.march(m, m.state(0.0, np.full(N, 1e-5), np.ones(N)), scheme, 50, start=True)
    assert report.status == -6
    assert "converge" in report.text
    assert report.bearing == 0
    assert np.isfinite(state).all()


def test_a_singular_mass_is_a_status_and_leaves_the_state() -> None:
    m = model(M=np.diag([1.0, 1, 1, 1, 1, 0]))
    state = m.state(0.25, np.zeros(N), np.zeros(N))
    _, after, report = core.march(m, state, SCHEME, 10, start=True)
    assert report.status == -5
    assert report.t == 0.25
    assert report.steps == 0
    assert np.isfinite(after).all()


def test_no_steps_report_the_time_they_stand_at() -> None:
    m = model()
    state = m.state(0.125, np.zeros(N), np.zeros(N))
    _, state, report = core.march(m, state, SCHEME, 0, start=True)
    assert (report.status, report.steps, report.t) == (0, 0, 0.125)
    _, state, report = core.march(m, state, SCHEME, 4)
    assert core.march(m, state, SCHEME, 0)[2].t == pytest.approx(0.125 + 4 * 2.5e-6, rel=1e-14)


def test_overflow_without_bearings_is_a_status() -> None:
    """Central differences far beyond their limit; nothing is recorded in time to notice."""
    one = np.ones((1, 1))
    m = core.Model(one, 0 * one, 0 * one, 1e6 * one, 0 * one, [], [], [], [(0, np.ones(1), 0, 0)])
    _, state, report = core.march(
        m, m.state(0.0, np.ones(1), np.zeros(1)), core.Scheme(dt=1.0, beta=0.0), 1000, 10**6, start=True
    )
    assert report.status == -7
    assert 10 < report.steps < 1000
    assert np.isfinite(state).all()


def test_every_instruction_set_gives_the_same_bits() -> None:
    m = model()
    base, state, _ = core.march(
        m, at_rest(m), core.Scheme(dt=2.5e-6, speed=300.0, isa="base"), 500, start=True
    )
    for name in ("avx2", "avx512", "best"):
        try:
            record, other, _ = core.march(
                m, at_rest(m), core.Scheme(dt=2.5e-6, speed=300.0, isa=name), 500, start=True
            )
        except ValueError:
            continue  # not on this machine
        np.testing.assert_array_equal(record, base)
        np.testing.assert_array_equal(other, state)


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
