"""The examples in the docstrings run, and print what stands there."""

from __future__ import annotations

import doctest
import importlib
import pkgutil

import pytest

import bearingdyn

MODULES = sorted(
    m.name for m in pkgutil.walk_packages(bearingdyn.__path__, "bearingdyn.") if "_core" not in m.name
)


@pytest.mark.parametrize("name", MODULES)
def test_the_examples_of_a_module_run(name: str) -> None:
    module = importlib.import_module(name)
    assert doctest.testmod(module).failed == 0


def test_there_are_examples() -> None:
    finder = doctest.DocTestFinder(exclude_empty=True)
    found = [test for name in MODULES for test in finder.find(importlib.import_module(name)) if test.examples]
    assert len(found) >= 18
