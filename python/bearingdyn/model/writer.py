"""A model written to its file, every number to the last bit."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bearingdyn.application import (
    GRAVITY,
    GROUND,
    Application,
    DirectedLoad,
    HarmonicLoad,
    Load,
    SampledLoad,
    Unbalance,
)
from bearingdyn.checks import instance
from bearingdyn.material import STEEL
from bearingdyn.model.model import Analysis, Model
from bearingdyn.model.reader import FORMAT
from bearingdyn.model.toml_tables import table_of, written
from bearingdyn.writing import write_whole

_BARE = re.compile(r"[A-Za-z0-9_-]+")


class _Materials:
    """The materials met on the way, by the names that they get."""

    def __init__(self, given: Mapping[str, Any]) -> None:
        self.found: dict[str, Any] = {}
        self.given = given

    def name(self, material: Any) -> str:
        for name, known in self.found.items():
            if known is material or (type(known) is type(material) and known == material):
                return name
        if material == STEEL:
            return "steel"
        name = next((n for n, known in self.given.items() if known is material), "")
        kind = "rubber" if type(material).__name__ == "Maxwell" else type(material).__name__.lower()
        k = 1
        while not name or name in self.found or name == "steel":
            name = kind if k == 1 else f"{kind}_{k}"
            k += 1
        self.found[name] = material
        return name


def write_model(
    model: Model | Application, path: str | os.PathLike[str], *, analyses: Sequence[Analysis] = ()
) -> None:
    """Write a model to a TOML file, from which `read_model` makes the same, bit for bit.

    Left out is the report of a material's fit, on which no result depends. Expressions and parameters of a
    file that was read are written as their values.

    Parameters
    ----------
    model
        A model, or an application alone.
    path
        The file; one that is there is replaced.
    analyses
        What is asked, of an application alone.

    Raises
    ------
    ValueError
        For a part that no text can hold, such as a superelement or a mesh.
    """
    instance("model", model, (Model, Application), "it must be a bd.Model or a bd.Application")
    if isinstance(model, Application):
        model = Model(model, tuple(analyses))
    write_whole(path, model_text(model).encode())


def model_text(model: Model) -> str:
    """The text that is written to a model's file."""
    plan = model.application.plan
    materials = _Materials(model.materials)
    blocks: list[str] = []
    twins: dict[int, str] = {}
    for name, source in plan.sources.items():
        if id(source) in twins:
            blocks.append(_section(("parts", name), {"like": twins[id(source)]}))
        else:
            blocks.append(_section(("parts", name), table_of(source, materials.name, f"part {name!r}")))
            twins[id(source)] = name
    if plan.temperatures:
        blocks.append(_section(("temperatures",), plan.temperatures))
    balls: dict[int, str] = {}
    for name, joint in plan.bearings.items():
        ends: dict[str, Any] = {"inner": str(joint.inner), "outer": str(joint.outer)}
        ends |= {name: x for name in ("offset", "place") if (x := getattr(joint, name))}
        if id(joint.bearing) in balls:
            own: dict[str, Any] = {"like": balls[id(joint.bearing)]}
        else:
            own = table_of(joint.bearing, materials.name, f"bearing {name!r}", "BallBearing")
            balls[id(joint.bearing)] = name
        # a row of a set has its place, and was judged with its neighbours when the set was hung
        if name in plan.unjudged or joint.place:
            ends["fits"] = False
        blocks.append(_section(("bearings", name), {**own, **ends}))
    for name, fit in plan.fits.items():
        own = table_of(fit.fit, materials.name, f"fit {name!r}", "LooseFit")
        blocks.append(_section(("fits", name), {**own, "ring": str(fit.ring), "bore": str(fit.bore)}))
    blocks += [_section(("joints",), row, listed=True) for row in _joints(model)]
    blocks += [_section(("loads",), _load(load), listed=True) for load in plan.loads]
    if model.state:
        blocks.append(_section(("equilibrium",), written(model.state, materials.name)))
    for one in model.analyses:
        row = {"name": one.name, "type": one.kind, **written(one.arguments, materials.name, one.name)}
        blocks.append(_section(("analyses",), row, listed=True))
    head = [f"format = {FORMAT}"] + ([f"title = {_value(model.title)}"] if model.title else [])
    nouns = [
        _section(("materials", name), table_of(one, materials.name, f"material {name!r}"))
        for name, one in materials.found.items()
    ]
    return "\n".join(head) + "\n\n" + "\n".join([*nouns, *blocks])


def _joints(model: Model) -> list[dict[str, Any]]:
    plan = model.application.plan
    rows: list[dict[str, Any]] = [
        {"connect": [str(c.a), str(c.b)], **({"fits": False} if c in plan.unjudged else {})}
        for c in plan.connections
    ]
    for support in plan.supports.values():
        rows.append({"ground": str(support.interface), **_springs(support)})
    for bush in plan.springs:
        rows.append({"spring": [str(bush.a), str(bush.b)], **_springs(bush)})
    return rows + [{"free": str(place)} for place in sorted(plan.free_interfaces)]


def _springs(joint: Any) -> dict[str, Any]:
    six = {name: getattr(joint, name) for name in ("stiffness", "damping", "offset")}
    return {name: value.tolist() for name, value in six.items() if value is not None}


def _load(load: Load) -> dict[str, Any]:
    if isinstance(load, Unbalance):
        row: dict[str, Any] = {"at": str(load.where), "unbalance": load.moment}
        return row | ({"phase": load.phase} if load.phase else {})
    assert isinstance(load, DirectedLoad)
    way = {GRAVITY: "gravity", GROUND: "base_motion"}.get(load.where, "force")
    row = ({"at": str(load.where)} if way == "force" else {}) | {way: load.vector.tolist()}
    if isinstance(load, HarmonicLoad):
        row |= {"frequency": load.frequency} | ({"phase": load.phase} if load.phase else {})
    if isinstance(load, SampledLoad):
        row |= {"time": load.time.tolist(), "value": load.value.tolist()}
    return row


def _section(path: Sequence[str], table: Mapping[str, Any], *, listed: bool = False) -> str:
    name = ".".join(map(_key, path))
    lines = [f"[[{name}]]" if listed else f"[{name}]"]
    lines += [f"{_key(key)} = {_value(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def _value(value: Any) -> str:
    """A value in TOML; a float to the last bit."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        if not math.isfinite(value):
            return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
        return repr(value)
    if isinstance(value, str):
        # JSON's escapes are TOML's, but for those beyond the basic plane, which stay as they are
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007F")
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(str(k))} = {_value(v)}" for k, v in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    items = [_value(v) for v in value]
    flat = "[" + ", ".join(items) + "]"
    if len(flat) <= 100:
        return flat
    return "[\n" + "".join(f"    {item},\n" for item in items) + "]"
