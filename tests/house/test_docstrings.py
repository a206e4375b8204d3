"""Docstrings of the public names are in NumPy's style, and name the arguments that there are."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator

import pytest

# Every room with public names
ROOMS = (
    "analysis",
    "application",
    "bearing",
    "bearing.catalogue",
    "cms",
    "core",
    "fem",
    "material",
    "parts",
    "plot",
    "results",
    "study",
    "system",
)
SECTION = re.compile(r"^(\w+)\n(-{3,})\n(.*?)(?=^\w+\n-{3,}\n|\Z)", re.MULTILINE | re.DOTALL)
# NumPy's own order (numpydoc's format, sections)
ORDER = [
    "Parameters",
    "Attributes",
    "Returns",
    "Yields",
    "Raises",
    "Warns",
    "Notes",
    "References",
    "Examples",
]
PROSE = re.compile(r"^(Raises [A-Z]\w*(Error|Warning)|Returns |Source: |References?: )", re.MULTILINE)


def documented() -> Iterator[tuple[str, object]]:
    """Public functions and classes of the rooms, and the public methods of these classes."""
    for room in ROOMS:
        module = importlib.import_module(f"bearingdyn.{room}")
        names = getattr(module, "__all__", None) or [n for n in vars(module) if not n.startswith("_")]
        for name in names:
            value = getattr(module, name)
            if not (inspect.isfunction(value) or inspect.isclass(value)):
                continue
            if not value.__module__.startswith(f"bearingdyn.{room}"):
                continue
            yield f"{room}.{name}", value
            if inspect.isclass(value):
                for method, member in vars(value).items():
                    if not method.startswith("_") and inspect.isfunction(member):
                        yield f"{room}.{name}.{method}", member


ALL = dict(documented())


def sections(value: object) -> dict[str, str]:
    return {m[1]: m[3] for m in SECTION.finditer((inspect.getdoc(value) or "") + "\n")}


def parameters(text: str) -> list[str]:
    heads = [line for line in text.splitlines() if line and not line.startswith(" ")]
    return [name.strip() for head in heads for name in head.split(",")]


@pytest.mark.parametrize("name", ALL)
def test_sections_are_those_of_numpy_in_their_order(name: str) -> None:
    doc = inspect.getdoc(ALL[name])
    assert doc, "a public name needs a docstring"
    found = list(sections(ALL[name]))
    assert set(found) <= set(ORDER)
    assert found == sorted(found, key=ORDER.index)
    # in a section too: a line at its margin would be read as one of its entries
    prose = PROSE.search(doc)
    assert not prose, f"{prose and prose[0]!r} belongs in a section of its own"
    for m in SECTION.finditer(doc + "\n"):
        assert len(m[2]) == len(m[1]), f"the line under {m[1]} is as long as it"


@pytest.mark.parametrize("name", [n for n, v in ALL.items() if inspect.isfunction(v) and n.count(".") == 1])
def test_every_argument_of_a_public_function_is_described(name: str) -> None:
    signature = inspect.signature(ALL[name])  # type: ignore[arg-type]
    kinds = {inspect.Parameter.VAR_POSITIONAL: "*", inspect.Parameter.VAR_KEYWORD: "**"}
    wanted = [kinds.get(p.kind, "") + p.name for p in signature.parameters.values()]
    assert parameters(sections(ALL[name]).get("Parameters", "")) == wanted


@pytest.mark.parametrize("name", [n for n, v in ALL.items() if "Parameters" in sections(v)])
def test_no_argument_is_described_that_is_not_there(name: str) -> None:
    value = ALL[name]
    there = {p.name for p in inspect.signature(value).parameters.values()}  # type: ignore[arg-type]
    described = {p.lstrip("*") for p in parameters(sections(value)["Parameters"])}
    assert described <= there
