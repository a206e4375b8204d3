"""What the pages show and a build makes: pictures, tables, and the first hour as it runs."""

from __future__ import annotations

import contextlib
import hashlib
import inspect
import io
import re
import runpy
import shutil
import tempfile
from pathlib import Path

import architecture
import contact_figure
import design_figure
import pictures
import sheet_figure

HERE = Path(__file__).parent
STATIC = HERE / "_static"


def make() -> None:
    """Write _static/architecture.svg, _static/first_hour.png and what the script printed, and the tables."""
    import matplotlib

    matplotlib.use("Agg")
    STATIC.mkdir(exist_ok=True)
    sources = digest()
    kept = STATIC / "sources.txt"
    if kept.exists() and kept.read_text(encoding="utf-8") == sources:
        return
    kept.unlink(missing_ok=True)
    (STATIC / "warnings.txt").write_text(warnings_table(), encoding="utf-8")
    (STATIC / "names.txt").write_text(names(), encoding="utf-8")
    architecture.draw(STATIC / "architecture.svg")
    sheet_figure.draw(STATIC / "sheet.svg")
    drawn = (
        pictures.drawing,
        pictures.squeezed,
        pictures.deformed,
        pictures.stiffness,
        pictures.ring,
        pictures.sound,
        pictures.sound_paths,
        pictures.sound_intensity,
        pictures.steady,
        pictures.report,
    )
    for picture in drawn:
        picture(STATIC / f"{picture.__name__}.png")
    design_figure.design(STATIC / "design.png")
    pictures.gallery(HERE / "gallery.md", STATIC)
    contact_figure.maps(STATIC / "contact_maps.png")
    contact_figure.damping(STATIC / "contact_damping.svg")
    contact_figure.in_time(STATIC / "films_in_time.svg")
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        with contextlib.redirect_stdout(io.StringIO()) as printed:
            runpy.run_path(str(HERE.parent / "examples" / "first_hour.py"))
        shutil.copy(Path("out", "first_hour.png"), STATIC)
    (STATIC / "first_hour.txt").write_text(printed.getvalue(), encoding="utf-8")
    kept.write_text(sources, encoding="utf-8")


def digest() -> str:
    """Of all that the pictures and tables are made from: the package, the scripts here, pages with code."""
    import bearingdyn

    package = Path(bearingdyn.__file__).parent
    pages = (HERE / "gallery.md", HERE / "guide", HERE.parent / "examples" / "first_hour.py")
    files = [
        f
        for f in (package, *sorted(HERE.glob("*.py")), *pages)
        for f in (sorted(f.rglob("*")) if f.is_dir() else [f])
    ]
    found = hashlib.sha256()
    for file in files:
        if file.suffix in (".py", ".so", ".pyd", ".md", ".toml", ".csv", ".json", ".css", ".js"):
            found.update(file.read_bytes())
    return found.hexdigest()


def warnings_table() -> str:
    """Every class of warning, Markdown: what it says, when it is raised, and what helps."""
    from bearingdyn import notice

    found = [c for _, c in inspect.getmembers(notice, inspect.isclass) if issubclass(c, notice.Notice)]
    rows = ["| class | what | when | remedy |", "|---|---|---|---|"]
    for each in found:
        if each is not notice.Notice:
            what, when, remedy = told(each)
            rows.append(f"| `{each.__name__}` | {what} | {when} | {remedy} |")
    return "\n".join(rows) + "\n"


def told(warning: type[Warning]) -> tuple[str, str, str]:
    """What a warning says, when it is raised and what helps; ValueError where its docstring lacks it."""
    text = inspect.getdoc(warning) or ""
    parts = re.split(r"^(When|Remedy): ", text, flags=re.MULTILINE)
    if parts[1::2] != ["When", "Remedy"]:
        raise ValueError(f"{warning.__name__}: its docstring needs a paragraph When: and then one Remedy:")
    what, when, remedy = (" ".join(part.split()).replace("|", "\\|") for part in parts[0::2])
    what = what.removeprefix("One of the notices: ")
    return what[0].upper() + what[1:], when, remedy


def names() -> str:
    """The public names by what they are about, Markdown, each with the first line of its docstring."""
    import bearingdyn

    lines = []
    for group, homes in bearingdyn.PUBLIC.items():
        lines += [f"## {group.capitalize()}", "", "| name | room | what |", "|---|---|---|"]
        for home, public in homes.items():
            for name in public:
                doc = inspect.getdoc(getattr(bearingdyn, name)) or ""
                first = doc.split("\n\n")[0].replace("\n", " ").replace("|", "\\|").replace("*", "\\*")
                lines.append(f"| `{name}` | `{home}` | {first} |")
        lines.append("")
    return "\n".join(lines)
