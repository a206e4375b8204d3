"""The report: a machine, its inputs and doubts, and what was computed of it, on one page."""

from __future__ import annotations

import base64
import hashlib
import os
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bearingdyn.analysis import Equilibrium
from bearingdyn.application import Application
from bearingdyn.checks import existing, instance, named, require
from bearingdyn.model import Model, read_model
from bearingdyn.notice import Notice
from bearingdyn.reporting.blocks import paragraph, table
from bearingdyn.reporting.of_machine import drawing_html, inputs_html, speed_of, state_html
from bearingdyn.reporting.of_results import kind_of, results_html, together
from bearingdyn.reporting.shapes import shapes_html
from bearingdyn.results import groups, inputs_of, open_result, stamp, versions
from bearingdyn.writing import check_target, write_whole

if TYPE_CHECKING:
    import xarray

MACHINE = "it must be a bd.Model, an Application, the path of a model file (.toml), or None"
# nothing may be loaded: the page is whole, and a browser holds it to that
POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; "
    "img-src data:; media-src data:"
)


@dataclass
class _Page:
    """Title, sections in order, and what is doubted."""

    title: str = ""
    lines: list[str] = field(default_factory=list)
    sections: list[tuple[str, str]] = field(default_factory=list)
    doubts: dict[str, str] = field(default_factory=dict)

    def add(self, title: str, content: str) -> None:
        if content:
            self.sections.append((title[:1].upper() + title[1:], content))


def report(
    what: Any,
    path: str | os.PathLike[str],
    *,
    model: Model | Application | str | os.PathLike[str] | None = None,
    sounds: Mapping[str, str | os.PathLike[str]] | None = None,
    title: str = "",
    tell: Callable[[str], object] = lambda _: None,
) -> Path:
    """Write a report: one HTML page that needs no other file and no network.

    It shows the drawing, the inputs with their sources and doubts, the state at rest with sag over time and a
    sheet of the bearings, modes in motion, curves to zoom and read off, designs side by side, sounds to
    listen to, every warning with its remedy, and what made it. Results named alike before their last "/", as
    "response/no layer" and "response/layer", are drawn together. A browser prints it to PDF.

    Parameters
    ----------
    what
        A model, an application, or the path of a model file: its analyses are run. Or an equilibrium. Or a
        result, several by name, or the path of a result file.
    path
        The page; one that is there is replaced.
    model
        Of results: the machine they are of, for drawing, inputs and state.
    sounds
        Files by `bd.write_wav`, by label, to be listened to.
    title
        Of the page; "": that of the model, or the name of the file.
    tell
        Called with a line before each longer piece of work.

    Returns
    -------
    pathlib.Path
        The page.

    Raises
    ------
    ValueError
        For something that is none of these, and as `read_model`, `open_result` and the analyses do.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     page = bd.report({"modes": bd.modes(app)}, Path(folder) / "mass.html", model=app)
    ...     text = page.read_text(encoding="utf-8")
    >>> "112.5 Hz" in text
    True
    """
    instance("title", title, str, "give a text")
    check_target(path)
    players = _players(sounds)
    page = _Page(title)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UserWarning)
        machine = None if model is None else _machine("model", model, page)
        results: dict[str, xarray.Dataset] | None = None
        at_rest = what if isinstance(what, Equilibrium) else None
        if at_rest is not None:
            results = {}
        elif machine is not None or not _is_machine(what):
            results = _results(what, page, tell)
        if results is None:
            machine = _machine("what", what, page)
        _fill(page, machine, results, tell, at_rest)
    page.title = page.title or Path(path).stem
    for each in caught:
        if issubclass(each.category, UserWarning):
            page.doubts.setdefault(" ".join(str(each.message).split()), _remedy(each.category))
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)
    page.add("Sounds", players)
    write_whole(path, _whole(page).encode())
    return Path(path)


def _is_machine(what: Any) -> bool:
    if isinstance(what, str | os.PathLike):
        return Path(what).suffix.lower() == ".toml"
    return isinstance(what, Model | Application)


def _machine(name: str, given: Any, page: _Page) -> Model:
    """The machine, and what its file is."""
    if isinstance(given, Model):
        return given
    if isinstance(given, Application):
        return Model(given)
    require(isinstance(given, str | os.PathLike) and _is_machine(given), name, given, MACHINE)
    file = existing(given, "model file")
    found = read_model(file)
    digest = hashlib.sha256(file.read_bytes()).hexdigest()
    page.lines.append(f"Model file {file.name}, SHA-256 {digest[:32]}.")
    return found


def _results(what: Any, page: _Page, tell: Callable[[str], object]) -> dict[str, xarray.Dataset]:
    """Results by name: as given, or out of a file."""
    if isinstance(what, str | os.PathLike):
        file = existing(what, "result")
        tell(f"reading {file.name}")
        page.lines.append(f"Results of {file.name}.")
        return {name or file.stem: open_result(file, name) for name in groups(file) or [""]}
    if hasattr(what, "data_vars"):
        return {kind_of(what) or "result": what}
    remedy = (
        "it must be a model, an application, an equilibrium, a result, results by name, or the path of a "
        ".toml or result file"
    )
    held = named("what", what, remedy)
    require(bool(held), "what", what, "there is nothing to report: give at least one result by its name")
    for name, data in held.items():
        require(
            hasattr(data, "data_vars"),
            f"what[{name!r}]",
            data,
            "it must be a Dataset, as every analysis returns it",
        )
    return held


def _fill(
    page: _Page,
    machine: Model | None,
    results: dict[str, xarray.Dataset] | None,
    tell: Callable[[str], object],
    eq: Equilibrium | None = None,
) -> None:
    if machine is not None:
        page.title = page.title or machine.title
        tell("drawing")
        page.add("The machine", drawing_html(machine.application))
        page.add("Inputs", inputs_html(machine))
        if eq is None:
            tell("equilibrium")
            eq = machine.equilibrium()
        if results is None:
            results = machine.run(tell)
    if eq is not None:
        page.add("At rest", state_html(eq, speed_of(results or {})))
    for name, members in together(results or {}):
        content = results_html(members)
        first = next(iter(members.values()))
        if eq is not None and kind_of(first) == "modes":
            content += shapes_html(eq, first)
        kind = kind_of(first)
        page.add(name if name == kind or not kind else f"{name}: {kind}", content)
    _provenance(page, eq, results or {}, tell)


def _provenance(
    page: _Page,
    eq: Equilibrium | None,
    results: Mapping[str, xarray.Dataset],
    tell: Callable[[str], object],
) -> None:
    """What made the results, and whether it was this machine and this version."""
    own = inputs_of(eq.system.inputs).get("inputs_hash", "") if eq is not None else ""
    now = versions()["bearingdyn"]
    told, makers = [], set[str]()

    def doubt(text: str, remedy: str) -> None:
        page.doubts[text] = remedy
        tell(f"{text} {remedy}")

    for name, data in results.items():
        made, when, inputs = (str(data.attrs.get(k, "")) for k in ("made_by", "made_at", "inputs_hash"))
        makers.add(made)
        told.append((name, kind_of(data), when, inputs))
        if own and inputs and inputs != own:
            doubt(
                f"{name!r} was computed from other inputs than those of the machine shown here.",
                "Report it with the model that it was computed from, or compute it anew.",
            )
        by = made.partition(",")[0].removeprefix("bearingdyn ")
        if by and by != now:
            doubt(
                f"{name!r} was computed by version {by}; this page is made by {now}.",
                "The changelog says what changed; compute it anew where it matters.",
            )
        if not by:
            doubt(
                f"{name!r} does not say what computed it: this package, its version and inputs, or another.",
                "Report a result as an analysis returns it, or as bd.save wrote it.",
            )
    page.add(
        "Where it comes from",
        table(("result", "analysis", "at, UTC", "hash of its inputs"), told)
        + "".join(paragraph(f"Computed by {made}.") for made in sorted(makers) if made),
    )


def _remedy(category: type[Warning]) -> str:
    """What a warning's class says that helps."""
    text = category.__doc__ or ""
    return " ".join(text.partition("Remedy: ")[2].split()) if issubclass(category, Notice) else ""


def _players(sounds: Mapping[str, str | os.PathLike[str]] | None) -> str:
    if sounds is None:
        return ""
    held = named("sounds", sounds, "it must be paths of .wav files by label, or None")
    blocks = []
    for label, path in held.items():
        data = existing(path, ".wav").read_bytes()
        is_wav = data[:4] == b"RIFF" and data[8:12] == b"WAVE"
        require(is_wav, f"sounds[{label!r}]", str(path), "it must be a .wav, as bd.write_wav writes it")
        text = base64.b64encode(data).decode("ascii")
        name = escape(label, True)
        blocks.append(
            f'<h3>{name}</h3><audio controls preload=metadata aria-label="{name}" '
            f'src="data:audio/wav;base64,{text}"></audio>'
        )
    return "".join(blocks)


def page_files() -> tuple[str, str]:
    """Style and script of the report's page."""
    folder = files("bearingdyn.reporting")
    style, script = (folder.joinpath(name).read_text(encoding="utf-8") for name in ("page.css", "page.js"))
    return style, script


def _whole(page: _Page) -> str:
    title = escape(page.title or "Report")
    doubts = "".join(
        f"<li><b>{escape(text)}</b>{paragraph('Remedy: ' + remedy, 'note') if remedy else ''}</li>"
        for text, remedy in page.doubts.items()
    )
    sections = list(page.sections)
    if doubts:
        at = 1 if sections and sections[0][0] == "The machine" else 0
        sections.insert(at, ("What is doubted", f"<ul class=doubts>{doubts}</ul>"))
    links = "".join(f'<li><a href="#s{k}">{escape(name)}</a></li>' for k, (name, _) in enumerate(sections))
    body = "".join(
        f"<section id=s{k} aria-labelledby=h{k}><h2 id=h{k}>{escape(name)}</h2>{content}</section>"
        for k, (name, content) in enumerate(sections)
    )
    made = ", ".join(f"{name} {number}" for name, number in versions().items())
    lines = "".join(paragraph(line, "made") for line in [*page.lines, f"Made by {made}, {stamp()} (UTC)."])
    style, script = page_files()
    return (
        f'<!DOCTYPE html><html lang=en><head><meta charset=utf-8><meta http-equiv="Content-Security-Policy" '
        f'content="{POLICY}"><meta name=viewport content="width=device-width, initial-scale=1">'
        f"<title>{title}</title><style>{style}</style></head><body><header><h1>{title}</h1>{lines}</header>"
        f"<nav aria-label=contents><ul>{links}</ul></nav><main>{body}</main>"
        f"<script>{script}</script></body></html>\n"
    )
