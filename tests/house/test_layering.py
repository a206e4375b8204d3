"""The shape of the package: which room may import which, and what the C core may touch."""

from __future__ import annotations

import ast
import dataclasses
import importlib
import importlib.util
import re
import shutil
import struct
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import get_args

import pytest

import bearingdyn
from bearingdyn import _core, core
from bearingdyn.bearing import contact_damping, imperfections

ROOT = Path(__file__).resolve().parents[2]
CSRC = ROOT / "csrc"
PACKAGE = ROOT / "python" / "bearingdyn"

# ---------------------------------------------------------------- Python: imports run along the picture

# A room may import the rooms of earlier rows, and nothing beside or after it. "" is bearingdyn/__init__.py.
ORDER: tuple[tuple[str, ...], ...] = (
    ("kept_by_object", "pictures", "progress", "short_repr", "types"),
    ("checks", "core", "fingerprint", "notice"),
    ("plausible_ranges", "units", "writing"),
    ("kept_arrays",),
    ("material",),
    ("bearing", "fem"),
    ("cms",),
    ("parts",),
    ("application",),
    ("system",),
    ("run_file",),
    ("results",),
    ("analysis",),
    ("sound",),
    ("model", "plot", "study"),
    ("reporting",),
    ("explorer",),
    ("examples",),
    ("",),
    ("check", "demo"),
    ("cli",),
)
ROW = {room: row for row, rooms in enumerate(ORDER) for room in rooms}

# Drawing is the end of the line: only these may reach it, and only inside a function.
MAY_DRAW = {"", "cli", "demo", "reporting", "study"}

# Objects that show themselves go by one door, which names the room as a text when it is asked.
BY_NAME = {"pictures"}

# Third-party packages a module may load when it is imported; the rest is imported inside functions.
LOADED_AT_IMPORT = {"numpy", "scipy"}


def module_name(path: Path) -> str:
    parts = path.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_name(path): path for path in sorted(PACKAGE.rglob("*.py"))}


def room(module: str) -> str:
    return module.partition(".")[2].partition(".")[0]


@dataclass(frozen=True)
class Import:
    target: str  # full dotted name of the module
    door: str  # what stands behind `from` or `import`
    line: int
    late: bool  # inside a function, or for the type checker alone


def imports(module: str) -> Iterator[Import]:
    """Every import statement of a module, relative ones resolved."""
    path = MODULES[module]
    package = module if path.name == "__init__.py" else module.rpartition(".")[0]

    def visit(node: ast.AST, late: bool) -> Iterator[Import]:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(alias.name, alias.name, node.lineno, late)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*above, base] if base else above)
            for alias in node.names:
                full = f"{base}.{alias.name}"
                known = full in MODULES or full == "bearingdyn._core"
                yield Import(full if known else base, base, node.lineno, late)
        late |= isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            late = True
        for child in ast.iter_child_nodes(node):
            yield from visit(child, late)

    yield from visit(ast.parse(path.read_text(encoding="utf-8")), late=False)


def own_imports(module: str) -> list[Import]:
    return [i for i in imports(module) if i.target.partition(".")[0] == "bearingdyn"]


@pytest.mark.parametrize("module", MODULES)
def test_every_module_has_a_place_in_the_picture(module: str) -> None:
    assert room(module) in ROW, f"{module}: give the room {room(module)!r} a row in ORDER"


@pytest.mark.parametrize("module", MODULES)
def test_imports_run_along_the_picture(module: str) -> None:
    here = room(module)
    wrong = [
        f"{MODULES[module]}:{i.line}: {module} imports {i.target}"
        for i in own_imports(module)
        if i.target != "bearingdyn._core"
        and room(i.target) not in (here, "plot")
        and ROW.get(room(i.target), len(ORDER)) >= ROW[here]
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("module", MODULES)
def test_nothing_imports_plot(module: str) -> None:
    wrong = [
        f"{MODULES[module]}:{i.line}"
        for i in own_imports(module)
        if room(i.target) == "plot" and room(module) != "plot" and not (i.late and room(module) in MAY_DRAW)
    ]
    assert not wrong, "\n".join(wrong)


def test_only_one_door_reaches_plot_by_name() -> None:
    asks = {
        module.partition(".")[2]
        for module, path in MODULES.items()
        if re.search(r"""import_module\(\s*f?["'][^"']*plot""", path.read_text(encoding="utf-8"))
    }
    assert asks == BY_NAME


# A room is entered by its own name; (module, what it reaches behind a façade): the reason.
PAST_A_FACADE: dict[tuple[str, str], str] = {}


def test_no_import_past_a_facade_but_those_listed_with_a_reason() -> None:
    past = {
        (module, i.door)
        for module in MODULES
        for i in own_imports(module)
        if room(i.target) != room(module)
        and i.door.count(".") > 1
        and i.door.removeprefix("bearingdyn.") not in bearingdyn.SUBPACKAGES.values()
    }
    assert not past ^ PAST_A_FACADE.keys()


def test_one_room_imports_the_extension() -> None:
    importers = {m for m in MODULES if any(i.target == "bearingdyn._core" for i in imports(m))}
    assert importers <= {"bearingdyn.core"}


def circle(graph: Mapping[str, set[str]]) -> list[str]:
    """A circle's nodes in the order they are met, the first once more at the end; [] where there is none."""
    done: set[str] = set()

    def walk(node: str, trail: list[str]) -> list[str]:
        if node in trail:
            return [*trail[trail.index(node) :], node]
        if node not in done:
            for target in sorted(graph.get(node, ())):
                if found := walk(target, [*trail, node]):
                    return found
            done.add(node)
        return []

    return next((found for node in graph if (found := walk(node, []))), [])


def test_no_import_circles() -> None:
    graph = {m: {i.target for i in own_imports(m)} & MODULES.keys() for m in MODULES}
    assert not circle(graph)


def test_a_circle_is_seen() -> None:
    assert circle({"a": {"b", "d"}, "b": {"c"}, "c": {"b"}}) == ["b", "c", "b"]
    assert circle({"a": {"b", "c"}, "b": {"d"}, "c": {"d"}}) == []


@pytest.mark.parametrize("module", MODULES)
def test_heavy_packages_are_imported_late(module: str) -> None:
    at_import = {i.target.partition(".")[0] for i in imports(module) if not i.late}
    extra = at_import - LOADED_AT_IMPORT - {"bearingdyn"} - sys.stdlib_module_names
    assert not extra, f"{module} loads {sorted(extra)} when it is imported"


@pytest.mark.parametrize("wanted", ["import bearingdyn", "from bearingdyn import *"])
def test_importing_the_package_loads_numpy_and_scipy_at_most(wanted: str) -> None:
    """Alone, and with every public name; the time is printed, not judged: the machine may be busy."""
    code = (
        f"import sys, time; before, began = set(sys.modules), time.perf_counter(); {wanted}\n"
        "print(f'{time.perf_counter() - began:.3f} s')\n"
        "new = (sys.modules[name] for name in set(sys.modules) - before)\n"
        "print(*(m.__file__ for m in new if getattr(m, '__file__', None)), sep='\\n')"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    print(f"{wanted}: {run.stdout.splitlines()[0]}")
    # by folder, not by name: Cython modules inside SciPy go by short names
    installed = set(re.findall(r"(?:site|dist)-packages[/\\](\w+)", run.stdout))
    # NumPy's f2py, which SciPy's linalg loads, takes charset_normalizer where it finds it
    assert installed <= {"bearingdyn", "numpy", "scipy", "charset_normalizer"}
    assert ("numpy" in installed) == ("*" in wanted)


# what NumPy and SciPy, or a package they load, take where they find it
OPTIONAL = ("threadpoolctl", "matplotlib", "pandas", "dask", "sklearn")


def test_importing_everything_takes_no_package_that_happens_to_be_installed(tmp_path: Path) -> None:
    """SciPy's MatrixMarket reader, for one, loads threadpoolctl where it finds it."""
    for name in OPTIONAL:
        (tmp_path / f"{name}.py").write_text("class LibController: pass\nregister = lambda _: None\n")
    code = (
        f"import sys; sys.path.insert(0, {str(tmp_path)!r})\nfrom bearingdyn import *\n"
        f"print(sorted(sys.modules.keys() & set({OPTIONAL!r})))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_public_names_live_where_the_stub_says() -> None:
    stub = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    named = {a.name: n.module for n in stub.body if isinstance(n, ast.ImportFrom) for a in n.names}
    rooms = {name for name in named if name in bearingdyn.SUBPACKAGES}
    assert rooms == set(bearingdyn.SUBPACKAGES)
    assert named.keys() - rooms == set(bearingdyn.__all__)
    for name, home in named.items():
        assert home is not None
        assert getattr(bearingdyn, name) is getattr(importlib.import_module(home), name)
        assert name in dir(bearingdyn)
    with pytest.raises(AttributeError, match="nonsense"):
        _ = bearingdyn.nonsense


# ---------------------------------------------------------------- C: what the sources may include

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)', re.MULTILINE)


C_FILES = sorted(CSRC.rglob("*.[ch]"))
BINDING = CSRC / "binding"
OF_PYTHON = re.compile(r"Python\.h$|numpy/")


def c_name(path: Path) -> str:
    return path.relative_to(CSRC).as_posix()


@pytest.mark.parametrize("path", C_FILES, ids=c_name)
def test_only_the_header_of_the_binding_includes_python_and_numpy(path: Path) -> None:
    included = INCLUDE.findall(path.read_text(encoding="utf-8"))
    found = [header for header in included if OF_PYTHON.match(header)]
    assert c_name(path) == "binding/binding.h" or not found
    if path.parent == BINDING:
        # Python.h decides what the C library declares, so that it comes first
        assert path.suffix == ".h" or included[0] == "binding.h"
    else:
        assert not [header for header in included if "binding" in header]


def test_build_names_every_c_file() -> None:
    named = set(re.findall(r"'((?:\w+/)?\w+\.c)'", (CSRC / "meson.build").read_text(encoding="utf-8")))
    assert named == {c_name(path) for path in C_FILES if path.suffix == ".c"}


# ---------------------------------------------------------------- words that C owns

C_WORDS = {
    name: frozenset(value)
    for name, value in vars(_core).items()
    if name.isupper() and isinstance(value, tuple | MappingProxyType)
}

# Tables that name words of C for a meaning that C does not know: (module, list of words): the reason.
MAY_NAME_WORDS = {
    (
        "bearingdyn.application.channel",
        "CHANNEL_KINDS",
    ): "what the place of a structure can be asked for, and its units",
    (
        "bearingdyn.analysis.frequency_response",
        "CHANNEL_KINDS",
    ): "the units of a response",
    (
        "bearingdyn.analysis.steady.motion",
        "CHANNEL_KINDS",
    ): "how often a motion's amplitudes are derived in time",
    (
        "bearingdyn.plot.frequency_response",
        "CHANNEL_KINDS",
    ): "the reference of a level of each quantity, ISO 1683",
    ("bearingdyn.analysis.steady.torus", "PIT_KINDS"): "how the base frequency of each body is called",
    ("bearingdyn.bearing.ball_bearing", "PIT_KINDS"): "how far each body turns as the balls go round",
    ("bearingdyn.run_file", "REPORT_FIELDS"): "what files of version 1 hold, which will not change",
}

# Types that spell words out for the type checker; they must be all words of a list.
WORD_TYPES = {"DAMPING_LAWS": contact_damping.Law, "PIT_KINDS": imperfections.Body}


def word_tables(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and list of each literal of words of C alone: three or more of a list, or two with their codes."""
    types = {
        part
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript) and ast.unparse(node.value) == "Literal"
        for part in ast.walk(node)
    }
    for node in ast.walk(tree):
        if node in types or not isinstance(node, ast.Dict | ast.Tuple | ast.List | ast.Set):
            continue
        items = node.keys if isinstance(node, ast.Dict) else node.elts
        words = [i.value for i in items if isinstance(i, ast.Constant) and isinstance(i.value, str)]
        values = node.values if isinstance(node, ast.Dict) else []
        codes = values and all(isinstance(v, ast.Constant) and isinstance(v.value, int) for v in values)
        for name, known in C_WORDS.items():
            if len(words) == len(items) >= (2 if codes else 3) and known.issuperset(words):
                yield node.lineno, name


def test_a_table_of_words_that_c_owns_is_seen() -> None:
    assert {"DAMPING_LAWS", "REPORT_FIELDS", "ENERGIES", "ISAS"} <= C_WORDS.keys()
    for text, name in (
        ('LAWS = {"constant": 0, "table": 1, "load": 2}', "DAMPING_LAWS"),
        ('a = ["kinetic", "elastic", "stored"]', "ENERGIES"),
        ('f(("iterations", "refreshes", "grazing"))', "REPORT_FIELDS"),
        ('x = {"base": 1, "avx2": 2}', "ISAS"),
    ):
        assert (1, name) in word_tables(ast.parse(text))
    assert not list(
        word_tables(ast.parse('Law = Literal["constant", "table", "load"]; r = ("inner", "outer")'))
    )


def test_no_table_in_python_repeats_words_that_c_owns() -> None:
    found = {
        (module, name): f"{path}:{line}: the words are _core.{name}"
        for module, path in MODULES.items()
        for line, name in word_tables(ast.parse(path.read_text(encoding="utf-8")))
    }
    assert not [text for key, text in found.items() if key not in MAY_NAME_WORDS]
    assert MAY_NAME_WORDS.keys() <= found.keys(), "an exception that is no longer needed"


@pytest.mark.parametrize("name", WORD_TYPES)
def test_types_spell_out_the_words_of_c(name: str) -> None:
    assert get_args(WORD_TYPES[name]) == tuple(getattr(_core, name))


def test_a_report_has_the_fields_that_c_lists() -> None:
    """In their order, and behind them what is not one number."""
    *numbers, peaks = dataclasses.fields(core.Report)
    assert [(f.name, str(f.type)) for f in numbers] == [
        (name, "float" if name in ("open_t", "t", "residual") else "int") for name in core.REPORT_FIELDS
    ]
    assert peaks.name == "peaks"


def test_c_files_include_one_another_without_circles() -> None:
    """A C file and its header count as one: neither may come to include the other by way of a third."""
    graph: dict[str, set[str]] = {}
    for path in sorted(CSRC.rglob("*.[ch]")):
        here = str(path.with_suffix("").relative_to(CSRC))
        found = {(path.parent / n).resolve() for n in INCLUDE.findall(path.read_text(encoding="utf-8"))}
        own = {str(header.with_suffix("").relative_to(CSRC)) for header in found if header.exists()}
        graph.setdefault(here, set()).update(own - {here})
    assert "newton" in graph["newmark"], "includes are no longer seen"
    assert "bearingdyn" in graph["binding/binding"], "includes across folders are no longer seen"
    assert not circle(graph)


# ---------------------------------------------------------------- C: what the compiled core contains

# Files, streams, the process and the environment are none of the core's business.
FORBIDDEN = frozenset(
    "printf vprintf fprintf vfprintf dprintf puts fputs putchar putc fputc fwrite perror write stdout stderr "
    "fopen open read getenv setlocale system signal time clock rand srand "
    "exit _exit _Exit quick_exit abort longjmp raise __assert_fail".split()
)
ALLOCATORS = frozenset("malloc calloc realloc aligned_alloc posix_memalign strdup free".split())

# Memory is taken when something is created or set up, and by one bearing asked by itself; never in a step.
MAY_ALLOCATE = re.compile(
    r"bd_(\w+_(create|free)|prepare|prepare_softened|exact_prepare|start|work_choose|profile_take|bearing_single)$"
)

WRITABLE = re.compile(r"\.(data|bss|tdata|tbss)(?!\.rel\.ro)|COMMON")


@dataclass(frozen=True)
class Symbol:
    name: str
    section: str  # "" where undefined
    is_global: bool
    is_object: bool


PLACE = re.compile(r"\.(text|data\.rel\.ro\.local|data\.rel\.ro)\.")


def plain(name: str) -> str:
    """A function's or a table's name from that of its section."""
    return PLACE.sub("", name, count=1)


class Elf:
    """The symbols and references of a 64-bit little-endian ELF file (System V gABI, chapters 4 and 5)."""

    def __init__(self, path: Path) -> None:
        self.data = path.read_bytes()
        if self.data[:6] != b"\x7fELF\x02\x01":
            pytest.skip(f"{path.name} is no 64-bit little-endian ELF file")
        (start,) = struct.unpack_from("<Q", self.data, 0x28)
        size, count, names = struct.unpack_from("<HHH", self.data, 0x3A)
        # name, type, flags, address, offset, size, link, info, alignment, entry size
        self.headers = [struct.unpack_from("<IIQQQQIIQQ", self.data, start + k * size) for k in range(count)]
        self.sections = [self._text(self.headers[names], h[0]) for h in self.headers]

    def _text(self, table: tuple[int, ...], offset: int) -> str:
        begin = table[4] + offset
        return self.data[begin : self.data.index(b"\0", begin)].decode()

    def symbols(self, table: str = ".symtab") -> list[Symbol]:
        header = self.headers[self.sections.index(table)]
        found = []
        for k in range(header[5] // 24):
            name, info, _, section, _, _ = struct.unpack_from("<IBBHQQ", self.data, header[4] + 24 * k)
            place = {0: "", 0xFFF1: "ABS", 0xFFF2: "COMMON"}.get(section)
            found.append(
                Symbol(
                    name=self._text(self.headers[header[6]], name),
                    section=self.sections[section] if place is None else place,
                    is_global=info >> 4 != 0,
                    is_object=info & 15 in (1, 6),
                )
            )
        return found

    def calls(self) -> Iterator[tuple[str, str]]:
        """(function or constant table, symbol it refers to), for code compiled with a section for each."""
        symbols = self.symbols()
        for section, header in zip(self.sections, self.headers, strict=True):
            if header[1] == 4 and PLACE.match(section.removeprefix(".rela")):  # SHT_RELA
                for k in range(header[5] // 24):
                    _, info = struct.unpack_from("<QQ", self.data, header[4] + 24 * k)
                    to = symbols[info >> 32]
                    # what is static is referred to by its section
                    yield plain(section.removeprefix(".rela")), plain(to.name or to.section)

    def needed(self) -> set[str]:
        """The shared libraries it is linked with."""
        header = self.headers[self.sections.index(".dynamic")]
        entries = [struct.unpack_from("<qQ", self.data, header[4] + 16 * k) for k in range(header[5] // 16)]
        return {self._text(self.headers[header[6]], value) for tag, value in entries if tag == 1}  # DT_NEEDED


@pytest.fixture(scope="module")
def core_objects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Elf]:
    """The core's files without the binding, compiled one by one, a section to each function and constant."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("core")
    objects = {}
    for source in sorted(CSRC.glob("*.c")):
        target = folder / f"{source.stem}.o"
        flags = ["-std=c11", "-fPIC", "-DNDEBUG", "-ffunction-sections", "-fdata-sections"]
        flags += ["-DBD_ISA=base", "-DBD_WIDTH=2"]  # the hot files exist once per instruction set
        subprocess.run([compiler, *flags, "-c", str(source), "-o", str(target)], check=True)
        objects[source.name] = Elf(target)
    return objects


def test_c_globals_begin_with_bd(core_objects: dict[str, Elf]) -> None:
    names = {
        f"{file}: {s.name}"
        for file, elf in core_objects.items()
        for s in elf.symbols()
        if s.is_global and s.section
    }
    assert names, "the core defines nothing"
    assert not [n for n in names if not n.partition(": ")[2].startswith("bd_")]


def test_core_has_no_writable_globals(core_objects: dict[str, Elf]) -> None:
    wrong = [
        f"{file}: {s.name} in {s.section}"
        for file, elf in core_objects.items()
        for s in elf.symbols()
        if s.is_object and WRITABLE.match(s.section)
    ]
    assert not wrong


def test_core_neither_prints_nor_exits(core_objects: dict[str, Elf]) -> None:
    wrong = [
        f"{file}: {s.name}"
        for file, elf in core_objects.items()
        for s in elf.symbols()
        if not s.section and s.name in FORBIDDEN
    ]
    assert not wrong


def test_c_files_call_one_another_without_circles(core_objects: dict[str, Elf]) -> None:
    """By the symbols that each object file leaves to the others, tables of functions included."""
    home = {
        s.name: file for file, elf in core_objects.items() for s in elf.symbols() if s.is_global and s.section
    }
    graph = {
        file: {home[s.name] for s in elf.symbols() if not s.section and s.name in home}
        for file, elf in core_objects.items()
    }
    assert "balls.c" in graph["step.c"], "references are no longer seen"
    assert not circle(graph)


def reached_from(functions: set[str], objects: dict[str, Elf]) -> set[str]:
    """Every function that a call of one of these may lead to, the C library's included."""
    callees: dict[str, set[str]] = {}
    for elf in objects.values():
        for caller, callee in elf.calls():
            callees.setdefault(caller, set()).add(callee)
    reached: set[str] = set()
    ahead = functions
    while ahead:
        reached |= ahead
        ahead = set().union(*(callees.get(f, set()) for f in ahead)) - reached
    return reached


def test_core_allocates_only_where_it_creates_or_sets_up(core_objects: dict[str, Elf]) -> None:
    public = {s.name for elf in core_objects.values() for s in elf.symbols() if s.is_global and s.section}
    takers = {f for f in public if reached_from({f}, core_objects) & ALLOCATORS}
    assert "bd_model_create" in takers, "allocations are no longer seen"
    assert not {f for f in takers if not MAY_ALLOCATE.match(f)}


def test_march_reaches_no_allocator_and_no_lapack(core_objects: dict[str, Elf]) -> None:
    # the march calls the hot loops through a table
    reached = reached_from({"bd_march", "bd_kernels_base"}, core_objects)
    assert "bd_ehl_contacts_base" in reached, "the march no longer begins here: name its new beginning"
    assert not reached & (ALLOCATORS | {"bd_solve_real", "bd_solve_complex"})


@pytest.fixture(scope="module")
def extension() -> Elf:
    spec = importlib.util.find_spec("bearingdyn._core")
    assert spec is not None, "the extension is not built"
    assert spec.origin is not None
    elf = Elf(Path(spec.origin))
    if any("asan" in library for library in elf.needed()):
        pytest.skip("built with the address sanitizer, which exports symbols of its own")
    if any(symbol.name.startswith("__gcov") for symbol in elf.symbols(".dynsym")):
        pytest.skip("built to count lines, which exports symbols of its own")
    return elf


def test_shared_object_exports_only_its_init_function(extension: Elf) -> None:
    exported = {s.name for s in extension.symbols(".dynsym") if s.is_global and s.section}
    assert exported == {"PyInit__core"}


def test_the_binding_keeps_no_writable_global_but_numpys_table(extension: Elf) -> None:
    """CPython writes to definitions of the module and of types, tables of methods, and keywords."""
    if ".symtab" not in extension.sections:
        pytest.skip("the extension is stripped")
    of_python = re.compile(
        r"(module|model)_(definition|methods|getset|slots)$|names(\.\d+)?$|bd_py_model_spec$"
    )
    own = {
        s.name
        for s in extension.symbols()
        if s.is_object and WRITABLE.match(s.section) and not s.name.startswith("_") and s.name
    }
    rest = {name for name in own if not of_python.match(name)} - {"completed.0"}  # the C library's start-up
    assert rest == {"bd_py_numpy", "bd_py_numpyPyArray_RUNTIME_VERSION"}


def test_shared_object_links_only_libc(extension: Elf) -> None:
    families = {re.split(r"[-.]", library)[0] for library in extension.needed()}
    assert families <= {"libc", "libm", "libpthread", "ld"}
