"""A model read from its file: includes, parameters, materials, parts, bearings, joints, loads, analyses."""

from __future__ import annotations

import inspect
import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from bearingdyn.analysis import equilibrium
from bearingdyn.application import Application, Plan
from bearingdyn.bearing import BallBearing, catalogue
from bearingdyn.checks import existing, meant, named, number, require
from bearingdyn.material import Maxwell, fit_maxwell, master_curve, read_dma, sample_dma_path
from bearingdyn.model.asked_channels import CHANNELS, check_argument, check_channels
from bearingdyn.model.key_lines import Key, check_chains, key_lines
from bearingdyn.model.model import Analysis, Model, analyses
from bearingdyn.model.notation import grid
from bearingdyn.model.toml_tables import MATERIALS, Shelf, kinds
from bearingdyn.model.trouble import Located, Origin, at

FORMAT = 1
TABLES = ("parameters", "materials", "parts", "bearings", "fits", "temperatures")
LISTS = ("joints", "loads", "analyses")
WORDS = ("format", "title", "include", "equilibrium")
# of a bearing in its place, and of the bearing itself
HUNG = ("inner", "outer", "offset", "place", "fits", "mirrored")
BEARING = (
    "designation",
    "balls",
    "like",
    "type",
    *(k for k in inspect.signature(BallBearing).parameters if k != "overrides"),
)
SAMPLE = "sample"  # instead of a path: the DMA table that the package ships


def read_model(path: str | os.PathLike[str], **parameters: float | str) -> Model:
    """Read a model from a TOML file.

    Parameters
    ----------
    path
        The file. Paths within it, of includes and data, are from its folder.
    **parameters
        Values instead of those that the file's [parameters] have.

    Returns
    -------
    Model

    Raises
    ------
    ValueError
        With file, line and key of what is wrong, and what would be right.
    FileNotFoundError
        Where the file is not there.
    """
    file = existing(path, "model file")
    origin = Origin(str(file))
    held = _load(file, origin, (), [])
    last = max((line for where, line in origin.known.values() if where == str(file)), default=1)
    origin.known.setdefault(("parts",), (str(file), last))  # where they must be added
    for key in held:
        if key not in (*TABLES, *LISTS, *WORDS):
            with at(origin, (key,)):
                raise ValueError(f"{key} is unknown; {meant(key, [*TABLES, *LISTS, *WORDS])}")
    with at(origin, ("parameters",)):
        own = named("parameters", held.get("parameters", {}), "it must be a table, name = value")
        for name in parameters:
            if name not in own:
                raise ValueError(f"{name} is no parameter of this model; {meant(name, own)}")
    shelf = Shelf(origin, {}, {})
    values: dict[str, Any] = {}
    for name, value in {**own, **parameters}.items():
        with at(origin, ("parameters", name)):
            shelf.parameters = values
            plain = isinstance(value, int | float | str) and not isinstance(value, bool)
            require(plain, name, value, "it must be a number or a text")
            values[name] = shelf.plain(value)
    shelf.parameters = values
    for name, table in _table(origin, held, "materials").items():
        shelf.materials[name] = _material(shelf, table, ("materials", name), file.parent)
    app = Application()
    _parts(shelf, app, held)
    _bearings(shelf, app, held)
    _joints(shelf, app, held)
    _loads(shelf, app, held)
    state = _state(shelf, held)
    asked = _analyses(shelf, held, app.plan)
    with at(origin, ("parts",), app.plan.parts):
        app.plan.check_joints()
    title = held.get("title", "")
    with at(origin, ("title",)):
        require(isinstance(title, str), "title", title, "it must be a text")
    places = {"equilibrium": origin.told(("equilibrium",))}
    places |= {one.name: origin.told(("analyses", k)) for k, one in enumerate(asked)}
    for k, table in enumerate(_list(origin, held, "loads")):
        if "unbalance" in table:  # what turns with it is known with the equilibrium
            places[f"unbalance at {table['at']} "] = origin.told(("loads", k, "unbalance"))
        elif isinstance(table.get("force"), list) and table["force"][-1:] != [0.0]:
            places.setdefault("a constant load turns ", origin.told(("loads", k, "force")))
    return Model(app, asked, state, title, values, shelf.materials, places)


def _load(file: Path, origin: Origin, above: tuple[Path, ...], seen: list[Path]) -> dict[str, Any]:
    """The tables of a file and of those that it includes, each key in one of them."""
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise Located(
            f"{file}: byte {error.start + 1} is no UTF-8; a model file must be text in UTF-8"
        ) from None
    try:
        check_chains(text)
    except ValueError as error:
        raise Located(f"{file}: {error}; a model needs no more than ten") from None
    try:
        held = tomllib.loads(text)
    except RecursionError:
        raise Located(f"{file}: its brackets are nested too deep; a model needs no more than ten") from None
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"at line (\d+)", str(error))
        line = int(found[1]) if found else text.count("\n") + 1
        raise Located(f"{file}, line {line}, {_near(text, line)}: {_told(error)}") from None
    except ValueError as error:  # Python refuses to read a number of thousands of digits
        raise Located(f"{file}: a number has too many digits to be read ({error})") from None
    lines: Mapping[Key, int] = key_lines(text)
    own = Origin(str(file), {key: (str(file), line) for key, line in lines.items()})
    own.known.setdefault(("format",), (str(file), 1))  # where it must be added
    with at(own, ("format",)):
        version = held.pop("format", None if not above else FORMAT)
        remedy = (
            f"this is a file of another version; it must be {FORMAT}, that of this package: read it with the "
            f"bearingdyn that wrote it, or write format = {FORMAT} and mend what is then refused"
        )
        if version is None:
            raise ValueError(f"format is missing; the file must begin with a line format = {FORMAT}")
        require(version == FORMAT and not isinstance(version, bool), "format", version, remedy)
    included = held.pop("include", [])
    with at(own, ("include",)):
        included = [included] if isinstance(included, str) else included
        good = isinstance(included, list) and all(isinstance(x, str) for x in included)
        require(good, "include", included, "it must be paths of model files, as texts")
    result: dict[str, Any] = {}
    seen.append(file.resolve())
    for k, name in enumerate(included):
        with at(own, ("include", k) if ("include", k) in lines else ("include",)):
            other = existing(file.parent / name, "model file to include")
            chain = [*above, file.resolve()]
            if other.resolve() in chain:
                told = " includes ".join(p.name for p in (*chain[chain.index(other.resolve()) :], other))
                told += "" if other.name == other.resolve().name else f" (a link to {other.resolve().name})"
                raise ValueError(f"include is circular: {told}; leave one of them out")
            if other.resolve() in seen:
                raise ValueError(f"include names {name!r} twice; once is enough")
            _merge(result, _load(other, origin, tuple(chain), seen), origin, own)
    _merge(result, held, own, own)
    # arrays of tables go on counting where the included ones end
    shift = {key: len(result.get(key, [])) - len(held.get(key, [])) for key in LISTS if key in held}
    for key, place in own.known.items():
        first = key[0]
        if len(key) > 1 and isinstance(first, str) and first in shift and isinstance(key[1], int):
            key = (first, key[1] + shift[first], *key[2:])
        origin.known[key] = place
    return result


def _told(error: tomllib.TOMLDecodeError) -> str:
    """What the parser refuses; of a key or table that is there twice, in the reader's words."""
    text = str(error)
    if text.startswith(("Cannot overwrite a value", "Cannot declare", "Duplicate inline table key")):
        return "this stands in the file already, above; leave one of the two out"
    return text


def _near(text: str, line: int) -> str:
    """The last key or table at a line or above, of a text that cannot be read."""
    for row in reversed(text.splitlines()[:line]):
        found = re.match(r"\s*(?:\[+\s*)?([\w.\-\"']+)", row)
        if found:
            return found[1]
    return "the beginning"


def _merge(into: dict[str, Any], more: dict[str, Any], origin: Origin, told: Origin) -> None:
    for key, value in more.items():
        if key in LISTS and isinstance(value, list):
            into.setdefault(key, [])
            into[key] = [*into[key], *value]
        elif key in TABLES and isinstance(value, dict) and isinstance(into.get(key), dict):
            for name, one in value.items():
                if name in into[key] and key != "parameters":
                    with at(told, (key, name)):
                        raise ValueError(f"{name} is in an included file already; give each its own name")
                into[key][name] = one
        else:
            into[key] = dict(value) if isinstance(value, dict) else value


def _table(origin: Origin, held: Mapping[str, Any], key: str) -> dict[str, Any]:
    with at(origin, (key,)):
        return named(key, held.get(key, {}), f"it must be a table: [{key}.name]")


def _list(origin: Origin, held: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    found = held.get(key, [])
    with at(origin, (key,)):
        good = isinstance(found, list) and all(isinstance(x, dict) for x in found)
        require(good, key, found, f"it must be a list of tables: [[{key}]]")
    return list(found)


def _material(shelf: Shelf, table: Any, key: Key, folder: Path) -> Any:
    """By its parameters, from a file of `Maxwell.to_json`, or fitted to a table of measurements."""
    with at(shelf.origin, key):
        require(isinstance(table, dict), str(key[-1]), table, "it must be a table")
        ways = [way for way in ("type", "file", "dma") if way in table]
        remedy = "it must have one of type (parameters), file (of Maxwell.to_json) and dma (measurements)"
        require(len(ways) == 1, str(key[-1]), ways, remedy)
    if "type" in table:
        return shelf.noun(table, key, only=MATERIALS)
    if "file" in table:
        with at(shelf.origin, (*key, "file")):
            _only(table, ("file", "temperature"))
            found = Maxwell.from_json(existing(folder / str(table["file"])).read_text(encoding="utf-8"))
        with at(shelf.origin, (*key, "temperature")):
            return found if "temperature" not in table else found.at(shelf.plain(table["temperature"], "°C"))
    with at(shelf.origin, key, table):
        _only(table, ("dma", "read", "curve", "fit"))
        paths = table["dma"] if isinstance(table["dma"], list) else [table["dma"]]
        data = [sample_dma_path() if p == SAMPLE else existing(folder / str(p), "DMA table") for p in paths]
        given = {
            k: named(k, shelf.plain(table.get(k, {})), "it must be a table") for k in ("read", "curve", "fit")
        }
        dma = read_dma(data if len(data) > 1 else data[0], **given["read"])
        return fit_maxwell(master_curve(dma, **given["curve"]), **given["fit"])


def _only(table: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise ValueError(f"{key} is unknown here; {meant(key, known)}")


def _parts(shelf: Shelf, app: Application, held: Mapping[str, Any]) -> None:
    twins: dict[str, Any] = {}
    tables = _table(shelf.origin, held, "parts")
    with at(shelf.origin, ("parts",)):
        require(bool(tables), "parts", tables, "it must hold at least one part: [parts.name]")
    makers = tuple(n for n, k in kinds().items() if callable(getattr(k, "superelement", None)))
    for name, table in tables.items():
        key = ("parts", name)
        with at(shelf.origin, key):
            require(isinstance(table, dict), name, table, "it must be a table")
            if "like" in table:
                _only(table, ("like",))
                other = table["like"]
                if other not in twins:
                    raise ValueError(
                        f"like is {other!r}; it must name a part above: {meant(str(other), twins)}"
                    )
                twins[name] = twins[other]
        if "like" not in table:
            twins[name] = shelf.noun(table, key, only=makers)
        with at(shelf.origin, key):
            app.add(name, twins[name])
    for name, T in _table(shelf.origin, held, "temperatures").items():
        with at(shelf.origin, ("temperatures", name)):
            app.temperature(name, shelf.plain(T, "°C"))


def _bearings(shelf: Shelf, app: Application, held: Mapping[str, Any]) -> None:
    made: dict[str, Any] = {}
    for name, table in _table(shelf.origin, held, "bearings").items():
        key = ("bearings", name)
        hung = {}
        with at(shelf.origin, key):
            require(isinstance(table, dict), name, table, "it must be a table")
            for field in ("inner", "outer"):
                if field not in table:
                    raise ValueError(f"bearing {name!r} lacks {field}; it must name an interface")
                hung[field] = table[field]
            own = {k: v for k, v in table.items() if k not in HUNG}
            for k in own:
                with at(shelf.origin, (*key, k)):
                    if k not in BEARING or k == "overrides":
                        raise ValueError(f"{k} is no field of a bearing; {meant(k, BEARING)}")
        if "like" in own:
            with at(shelf.origin, (*key, "like")):
                _only(own, ("like",))
                if own["like"] not in made:
                    raise ValueError(f"like is {own['like']!r}; it must name a bearing above: {sorted(made)}")
                ball = made[own["like"]]
        elif "designation" in own:
            units = kinds()["BallBearing"].__units__  # type: ignore[attr-defined]
            given = {}
            for k, v in own.items():
                with at(shelf.origin, (*key, k)):
                    given[k] = shelf.value(v, (*key, k), units.get(k))
            with at(shelf.origin, key, given):
                ball = catalogue.bearing(**given)
        else:
            ball = shelf.noun(own, key, "BallBearing", only=("BallBearing",))
        with at(shelf.origin, key, table):
            mirrored = table.get("mirrored", False)
            require(isinstance(mirrored, bool), "mirrored", mirrored, "it must be true or false")
            made[name] = ball.mirrored() if mirrored else ball
            offset, fits = shelf.plain(table.get("offset", 0.0), "m"), table.get("fits", True)
            require(isinstance(fits, bool), "fits", fits, "it must be true or false")
            app.bearing(name, made[name], **hung, offset=offset, fits=fits)
        if "place" in table:
            with at(shelf.origin, (*key, "place")):
                require(not fits, "fits", fits, "it must be false where place is given")
                place = number("place", shelf.plain(table["place"], "m"), "it must be a finite length in m")
                app.plan.bearings[name] = replace(app.plan.bearings[name], place=place)
    for name, table in _table(shelf.origin, held, "fits").items():
        key = ("fits", name)
        with at(shelf.origin, key):
            require(isinstance(table, dict), name, table, "it must be a table")
            for field in ("ring", "bore"):
                require(field in table, field, None, "it must name the ring's outside, and the bore")
            own = {k: v for k, v in table.items() if k not in ("ring", "bore")}
        loose = shelf.noun(own, key, "LooseFit", only=("LooseFit",))
        with at(shelf.origin, key, table):
            app.fit(name, loose, ring=table["ring"], bore=table["bore"])


_JOINTS = {
    "connect": ("fits",),
    "ground": ("stiffness", "damping", "offset"),
    "spring": ("stiffness", "damping", "offset"),
    "free": (),
}
SIX = {
    "stiffness": ("N/m",) * 3 + ("N m/rad",) * 3,
    "damping": ("N s/m",) * 3 + ("N m s/rad",) * 3,
    "offset": ("m",) * 3 + ("rad",) * 3,
    "force": ("N",) * 3 + ("N m",) * 3,
}


def _joints(shelf: Shelf, app: Application, held: Mapping[str, Any]) -> None:
    for k, table in enumerate(_list(shelf.origin, held, "joints")):
        key: Key = ("joints", k)
        with at(shelf.origin, key):
            ways = [way for way in _JOINTS if way in table]
            require(len(ways) == 1, "joint", table, f"it must have one of {', '.join(_JOINTS)}")
            _only(table, (ways[0], *_JOINTS[ways[0]]))
        way = ways[0]
        given = {}
        for field in _JOINTS[way]:
            if field in table:
                with at(shelf.origin, (*key, field)):
                    given[field] = shelf.plain(table[field], SIX.get(field))
        with at(shelf.origin, key, table):
            ends = table[way]
            if way in ("connect", "spring"):
                remedy = 'it must be two interfaces, such as ["ring.centre", "housing.bore"]'
                require(isinstance(ends, list) and len(ends) == 2, way, ends, remedy)
                getattr(app, way)(*ends, **given)
            else:
                getattr(app, way)(ends, **given)


def _loads(shelf: Shelf, app: Application, held: Mapping[str, Any]) -> None:
    course = {"frequency": "Hz", "phase": "rad", "time": "s", "value": None}
    for k, table in enumerate(_list(shelf.origin, held, "loads")):
        key: Key = ("loads", k)
        with at(shelf.origin, key):
            ways = [way for way in ("force", "unbalance", "gravity", "base_motion") if way in table]
            require(
                len(ways) == 1, "load", table, "it must have one of force, unbalance, gravity, base_motion"
            )
            way = ways[0]
            known = {
                "force": ("force", "at", *course),
                "unbalance": ("unbalance", "at", "phase"),
                "gravity": ("gravity",),
                "base_motion": ("base_motion", *course),
            }[way]
            _only(table, known)
            if "at" in known and "at" not in table:
                raise ValueError('a load lacks at; it must name a place, such as "shaft.middle"')
        unit = {"force": SIX["force"], "unbalance": "kg m"}.get(way, "m/s²")
        size: Any = None
        with at(shelf.origin, (*key, way)):
            size = shelf.plain(table[way], unit)
        given = {}
        for field, own in course.items():
            if field in table:
                with at(shelf.origin, (*key, field)):
                    given[field] = shelf.plain(table[field], own)
        with at(shelf.origin, key, table):
            if way == "force":
                app.load(table["at"], size, **given)
            elif way == "unbalance":
                app.unbalance(table["at"], size, **given)
            elif way == "gravity":
                app.gravity(size)
            else:
                app.base_motion(size, **given)


def _state(shelf: Shelf, held: Mapping[str, Any]) -> dict[str, Any]:
    table = _table(shelf.origin, held, "equilibrium")
    with at(shelf.origin, ("equilibrium",)):
        _only(table, tuple(list(inspect.signature(equilibrium).parameters)[1:]))
    found = {}
    for name, value in table.items():
        with at(shelf.origin, ("equilibrium", name)):
            found[name] = shelf.plain(value, {"after": "s", "angle": "rad"}.get(name))
    return found


_UNITS = {"frequency": "Hz", "speed": "rad/s", "speeds": "rad/s", "dt": "s", "memory": "s"}


def _analyses(shelf: Shelf, held: Mapping[str, Any], plan: Plan) -> list[Analysis]:
    found: list[Analysis] = []
    known = analyses()
    for k, table in enumerate(_list(shelf.origin, held, "analyses")):
        key: Key = ("analyses", k)
        with at(shelf.origin, key):
            if "type" not in table:
                raise ValueError(f"an analysis lacks type; {meant('', analyses())}")
        given = {}
        for field, value in table.items():
            if field in ("type", "name"):
                continue
            with at(shelf.origin, (*key, field)):
                plain = shelf.plain(value, _UNITS.get(field))
                is_grid = isinstance(plain, dict) and "from" in plain
                if field == "speed" and isinstance(plain, list):
                    plain = tuple(plain)  # times and speeds
                check_argument(known.get(str(table["type"])), field, plain, _UNITS.get(field))
                given[field] = grid(plain) if is_grid else plain
                if field in CHANNELS:
                    check_channels(plan, field, plain)
        with at(shelf.origin, key, table):
            name = table.get("name", table["type"])
            require(isinstance(name, str) and bool(name), "name", name, "it must be a text")
            if name in {one.name for one in found}:
                raise ValueError(f"name is {name!r}, that of another analysis; give each its own")
            found.append(Analysis(name, table["type"], given))
    return found
