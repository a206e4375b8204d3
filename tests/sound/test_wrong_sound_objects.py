"""Public functions of sound and of model and result files, given what they cannot use, name it."""

from __future__ import annotations

import contextlib
import inspect
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import sound

# Radiation is a result, not an input: whoever fills it by hand is not asked again
FUNCTIONS: dict[str, Callable[..., Any]] = {
    name: getattr(sound, name) for name in sound.__all__ if callable(getattr(sound, name))
}
del FUNCTIONS["Radiation"]
FUNCTIONS |= {
    name: getattr(bd, name)
    for name in (
        "read_model", "write_model", "Model", "save", "open_result", "write_wav", "read_matrices",
        "read_mesh", "read_nodes", "read_dma", "read_strain_sweep", "reduction_error", "export_stiffness",
    )
}  # fmt: skip
WRONG = [
    None, 5, -1.0, float("nan"), "x", b"x", [], {}, object(), True, 1j, [None], np.zeros(3), np.zeros((0, 3)),
    np.array(["a"]), print,
]  # fmt: skip


@pytest.mark.parametrize("name", sorted(FUNCTIONS))
def test_what_cannot_be_used_is_a_value_error(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    call = FUNCTIONS[name]
    needed = [p for p in inspect.signature(call).parameters.values() if p.default is p.empty]
    plain = [p for p in needed if p.kind not in (p.KEYWORD_ONLY, p.VAR_KEYWORD, p.VAR_POSITIONAL)]
    named = [p.name for p in needed if p.kind is p.KEYWORD_ONLY]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for wrong in WRONG:
            # some of these are right for some functions: a number for the count of a hemisphere's places
            with contextlib.suppress(ValueError, OSError):
                call(*[wrong] * len(plain), **dict.fromkeys(named, wrong))
