"""Bad input to bearingdyn.core: only exceptions come out, and they name what is wrong."""

from __future__ import annotations

import dataclasses
import re
from typing import Any

import numpy as np
import pytest

from bearingdyn import _core, core
from core_models import KERNEL, SCHEME, N, arguments, at_rest, harmonic, model, replaced, stepping

# ---------------------------------------------------------------- bad input


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


def without(fields: dict[str, Any], name: str) -> dict[str, Any]:
    return {key: value for key, value in fields.items() if key != name}


BAD_BEARINGS = [
    ("n_balls", 0),  # balls
    ("n_balls", -3),
    ("n_balls", 2**31 - 1),
    ("n_balls", 2**40),
    ("order", np.array([1, 1, 0, 1, -1], np.intc)),
    ("order", np.array([1, 1, 0, 1, 2**31 - 1], np.intc)),
    ("order", np.zeros(0, np.intc)),
    ("order", np.array([1.0, 1, 0, 1, 1])),
    ("sine", np.array([0, 1, 0], np.intc)),
    ("n_radial", 6),
    ("n_radial", -1),
    ("x0", np.nan),
    ("y0", np.inf),
    ("A", 0.0),
    ("A", np.inf),
    ("e0", np.nan),
    ("kappa", -1.0),
    ("kappa", np.inf),
    ("h0", -1e-9),
    ("h0", np.inf),
    ("law", 3),
    ("law", -1),
    ("c", -1.0),
    ("c", np.inf),
    ("table", np.zeros((0, 2))),  # an empty table
    ("table", np.array([[0.0, 1.0], [0.0, 2.0]])),  # unsorted
    ("table", np.array([[np.nan, 1.0]])),
    ("table", np.array([[0.0, np.nan]])),
    ("table", np.array([[0.0, -1.0]])),
    ("table", np.zeros((3, 3))),
    ("cage_ratio", np.nan),
    ("angle0", np.inf),
    ("angle0", "0"),
    ("imperfections", None),
]


@pytest.mark.parametrize(("field", "value"), BAD_BEARINGS)
def test_a_bad_bearing_is_refused(field: str, value: Any) -> None:
    bad = KERNEL | {field: value}
    B = arguments()["bearings"][0][1]
    with pytest.raises((ValueError, TypeError, OverflowError)):
        model(bearings=[(bad, B)])
    with pytest.raises((ValueError, TypeError, OverflowError)):
        _core.bearing_force(bad, np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "bad",
    [
        (without(KERNEL, "imperfections"), None),
        (list(KERNEL.items()), None),
        (None, None),
        (KERNEL, np.zeros((4, N))),
    ],
)
def test_a_bearing_of_another_form_is_refused(bad: Any) -> None:
    kernel, B = bad
    with pytest.raises((ValueError, TypeError)):
        model(bearings=[(kernel, arguments()["bearings"][0][1] if B is None else B)])
    with pytest.raises((ValueError, TypeError)):
        model(bearings=[[KERNEL, arguments()["bearings"][0][1]]])


@pytest.mark.parametrize("name", KERNEL)
def test_a_field_of_a_bearing_is_named_where_it_is_missing_or_of_another_type(name: str) -> None:
    still = (np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(TypeError, match=rf'bearing has no field "{name}"'):
        _core.bearing_force(without(KERNEL, name), *still)
    with pytest.raises((TypeError, ValueError), match=rf"bearing\.{name} (is|must)"):
        _core.bearing_force(KERNEL | {name: object()}, *still)


@pytest.mark.parametrize("name", KERNEL["imperfections"])
def test_a_field_of_the_imperfections_is_named_where_it_is_missing_or_of_another_type(name: str) -> None:
    flaws, still = KERNEL["imperfections"], (np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(TypeError, match=rf'bearing.imperfections has no field "{name}"'):
        _core.bearing_force(KERNEL | {"imperfections": without(flaws, name)}, *still)
    with pytest.raises((TypeError, ValueError), match=rf"bearing\.imperfections\.{name} (is|must)"):
        _core.bearing_force(KERNEL | {"imperfections": flaws | {name: object()}}, *still)


def test_a_field_that_is_unknown_is_named() -> None:
    still = (np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0)
    for bad in (KERNEL | {"kapa": 1.0}, KERNEL | {3: 1.0}):
        with pytest.raises(TypeError, match=r"bearing has a field ('kapa'|3) that is unknown"):
            _core.bearing_force(bad, *still)


P = np.ones(N)


@pytest.mark.parametrize(
    "bad",
    [
        (4, 0.0, P, P, np.zeros(0), np.zeros(0)),
        (-1, 0.0, P, P, np.zeros(0), np.zeros(0)),
        (1, np.nan, P, P, np.zeros(0), np.zeros(0)),
        (0, 0.0, P[:-1], P, np.zeros(0), np.zeros(0)),
        (0, 0.0, replaced(P, 0, np.nan), P, np.zeros(0), np.zeros(0)),
        (1, 0.0, P, replaced(P, 0, np.inf), np.zeros(0), np.zeros(0)),
        (3, 0.0, P, P, np.zeros(0), np.zeros(0)),
        (3, 0.0, P, P, np.array([0.0, 0.0]), np.array([1.0, 2.0])),
        (3, 0.0, P, P, np.array([1.0, 0.0]), np.array([1.0, 2.0])),
        (3, 0.0, P, P, np.array([np.nan]), np.array([1.0])),
        (3, 0.0, P, P, np.array([0.0, 1.0]), np.array([1.0])),
        (3, 0.0, P, P, np.array([0.0, np.inf]), np.array([1.0, 2.0])),
        (0, 0.0, P, P),
        [0, 0.0, P, P, np.zeros(0), np.zeros(0)],
        None,
    ],
)
def test_a_bad_load_is_refused(bad: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        model(loads=[bad])


@pytest.mark.parametrize(
    "bad",
    [
        (9, P, 0, 0),
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
        (6, None, 3, 0),
        (7, None, 0, 99),
        (7, None, 0, -1),
        (8, None, 0, 99),
        (8, None, 0, -1),
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

    items += [(0, 0.0, Shrinking(), np.ones(N), np.zeros(0), np.zeros(0)) for _ in range(3)]
    m = model(loads=items)
    assert core.march(m, at_rest(m), SCHEME, 3, start=True)[2].status == 0


def test_a_list_that_grows_while_it_is_read_does_no_harm() -> None:
    items: list[Any] = []

    class Growing:
        def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
            items.extend((0, 0.0, np.ones(N), np.ones(N), np.zeros(0), np.zeros(0)) for _ in range(1000))
            return np.ones(N)

    items += [(0, 0.0, Growing(), np.ones(N), np.zeros(0), np.zeros(0)) for _ in range(3)]
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
        {"speed": "fast"},
        {"speed": ([0.0, 1.0], [0.0])},
        {"speed": ([0.0, 1.0], [0.0, np.inf])},
        {"speed": ([0.0, np.nan], [0.0, 1.0])},
        {"speed": ([1.0, 0.0], [0.0, 1.0])},
        {"speed": ([1.0, 1.0], [0.0, 1.0])},
        {"speed": ([], [])},
        {"speed": ([[0.0]], [[1.0]])},
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
        core.march(m, at_rest(m), stepping(**({"dt": 1e-6} | change)), 5, start=True)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("dt", 0.0),
        ("dt", "1"),
        ("beta", -0.1),
        ("gamma", np.inf),
        ("tolerance", np.nan),
        ("max_iterations", 0),
        ("max_iterations", 1001),
        ("max_iterations", 2**31 - 1),  # such a step would go on for hours, and nothing could end it
        ("max_iterations", 2**40),
        ("max_iterations", 2.5),
        ("speed", "fast"),
        ("speed", ([0.0],)),
        ("isa", "avx"),
        ("isa", None),
    ],
)
def test_what_is_wrong_in_a_scheme_is_named_when_it_is_made(field: str, value: Any) -> None:
    with pytest.raises((ValueError, TypeError), match=rf"\b{field} is {re.escape(repr(value))}; it must be"):
        stepping(**({"dt": 1e-6} | {field: value}))


def test_an_unknown_instruction_set_is_answered_with_those_there_are() -> None:
    with pytest.raises(ValueError, match=r"isa is 'avx'; .* \"best\", \"base\", \"avx2\", \"avx512\"$"):
        core.Scheme(isa="avx")


def test_a_march_names_what_is_wrong_in_its_scheme() -> None:
    m, scheme = model(), SCHEME.packed()
    good = dict(state=at_rest(m), steps=1, decimate=1, scheme=scheme, start=True, progress=None)
    for bad, name in (
        (without(scheme, "beta"), 'scheme has no field "beta"'),
        (scheme | {"delta": 1.0}, "'delta' that is unknown"),
        (scheme | {"gamma": None}, "scheme.gamma is None"),
        (scheme | {"times": np.array([np.nan])}, "scheme.times"),
        (scheme | {"times": np.zeros(2), "speeds": np.zeros(2)}, "scheme.times"),
        (scheme | {"times": np.array([6e305]), "speeds": np.array([300.0])}, "scheme.times"),
        (scheme | {"speeds": np.zeros(2)}, "scheme.speeds"),
        (scheme | {"max_iterations": 2**31 - 1}, "scheme.max_iterations is 2147483647; it must be 1 to 1000"),
        (scheme | {"isa": 4}, "scheme.isa is 4"),
    ):
        with pytest.raises((ValueError, TypeError), match=name):
            m.march(**(good | {"scheme": bad}))


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


@pytest.mark.parametrize("at", range(6))
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


@pytest.mark.parametrize("value", [1e308, -1.7e308, 1e160])
@pytest.mark.parametrize("audit", [False, True])
def test_no_march_succeeds_in_a_state_that_is_not_finite(value: float, audit: bool) -> None:
    """Each number of a state in turn is nearly too large to be squared, or to be added to."""
    m = model()
    scheme = dataclasses.replace(SCHEME, audit=audit)
    state = core.march(m, at_rest(m), scheme, 5, start=True)[1]
    failed = 0
    for at in range(6, len(state)):
        for steps in (0, 1, 4):
            _, after, report = core.march(m, replaced(state, at, value), scheme, steps)
            assert report.status < 0 or np.isfinite(after).all()
            failed += report.status < 0
    assert failed > 0


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
    assert harmonic(m, omega=np.zeros(0), modulus=np.zeros((0, 1), complex)).shape == (0, 3, 2)
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
    for at in range(6):
        a: list[Any] = [np.zeros(5), np.zeros(5), 0.0, 0.0, 0.0, 0.0]
        a[at] = np.full(5, value) if at < 2 else value
        with pytest.raises(ValueError):
            _core.bearing_force(KERNEL, *a)
