"""Whatever hypothesis throws at bearingdyn.core: numbers come out, or exceptions."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from bearingdyn import _core, core
from core_models import CASTABLE, KERNEL, SCHEME, N, arguments, at_rest, harmonic, model, stepping


@settings(max_examples=200, deadline=None)
@given(
    z=st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=5, max_size=5),
    rate=st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=5, max_size=5),
    angle=st.floats(-1e9, 1e9),
)
def test_a_bearing_answers_in_numbers(z: list[float], rate: list[float], angle: float) -> None:
    with contextlib.suppress(ArithmeticError):
        for answer in _core.bearing_force(
            KERNEL, np.array(z), np.array(rate), angle, 100.0, 2.5 * angle, 250.0
        ):
            assert np.isfinite(answer).all()


def test_harmonic_answers_in_numbers() -> None:
    for omega in (1e-300, 1e100, 1e200, -1e200, 1e308):
        with contextlib.suppress(ArithmeticError):
            assert np.isfinite(harmonic(model(), omega=np.full(3, omega))).all()


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
    good: dict[str, Any] = dict(state=at_rest(m), steps=5, decimate=1, start=True, progress=None)
    scheme = stepping(1e-6, speed=300.0, max_iterations=20).packed()
    small = st.one_of(st.none(), st.integers(-3, 40), st.floats(), st.just(at_rest(m)), anything)
    names = st.sampled_from([*good, *scheme])
    for name in data.draw(st.lists(names, min_size=1, max_size=3, unique=True)):
        value = data.draw(small)
        if isinstance(value, int) and name == "steps" and abs(value) > 100:
            value %= 100  # a march of 2**60 steps is not wrong, only long
        (scheme if name in scheme else good)[name] = value
    try:
        record, state, _ = m.march(**good, scheme=scheme)
    except (ValueError, TypeError, OverflowError, MemoryError):
        return
    assert np.isfinite(record).all()
    assert np.isfinite(state).all()
