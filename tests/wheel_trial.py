"""What a new user does with the wheel alone, in an empty folder: check, machine, drawing, model file."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path


def main() -> int:
    """Run the trial; nonzero where something is not as it should be."""
    if any(shutil.which(compiler) for compiler in ("cc", "gcc", "clang")):
        print("a compiler is on the path; this trial is of a machine without one", file=sys.stderr)
        return 1
    import matplotlib

    matplotlib.use("Agg")
    import bearingdyn as bd
    from bearingdyn.cli import main as command

    if command(["check"]) != 0:
        return 1
    app = bd.examples.motor()
    app.draw().figure.savefig("motor.png")
    bd.write_model(app, "motor.toml")
    again = bd.equilibrium(bd.read_model("motor.toml").application)
    state = bd.equilibrium(app)
    if not (again.x == state.x).all():
        print("the model file gives another machine", file=sys.stderr)
        return 1
    run = bd.transient(state, rpm=3000, dt=5e-6, steps=1000, record=["shaft.middle.y"])
    bd.save(run, "run.nc")
    if command(["check", str(bd.examples.model_path("fan"))]) != 0:
        return 1
    end = run["record"].values[-1, 0] * 1e6
    print(f"{bd.__version__} in {Path(bd.__file__).parent}: {end:.1f} µm at the end")
    return 0


if __name__ == "__main__":
    sys.exit(main())
