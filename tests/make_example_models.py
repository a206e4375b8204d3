"""Writes the model files of the ready machines anew: python tests/make_example_models.py."""

from __future__ import annotations

from pathlib import Path

import bearingdyn as bd
from bearingdyn import Analysis, Model, examples

HERE = Path(__file__).resolve().parents[1] / "python" / "bearingdyn" / "examples"


def models(*names: str) -> dict[str, Model]:
    """The machines with what their files ask of them; all of them, where none is named."""
    asked = {
        "motor": ("A small motor with rubber layers", "shaft.middle.y", "left_housing.top.y"),
        "fan": ("An overhung fan on rubber feet", "shaft.wheel.y", "shaft.middle.y"),
        "spindle": ("A grinding spindle, preloaded", "shaft.nose.y", "shaft.front.y"),
        "pump": ("A pump with one layered bearing", "shaft.impeller.y", "front_housing.top.y"),
    }
    found = {}
    for name, (title, force, seen) in asked.items():
        if names and name not in names:
            continue
        app = getattr(examples, name)()
        frequency = [10.0, 31.0, 100.0, 310.0, 1000.0]
        analyses = [
            Analysis("modes", "modes", {"count": 12, "rpm": 3000}),
            Analysis(
                "response",
                "frequency_response",
                {
                    "frequency": frequency,
                    "inputs": [force],
                    "outputs": [force, seen],
                },
            ),
            Analysis("run", "transient", {"rpm": 3000, "dt": 5e-6, "steps": 400, "record": [force, seen]}),
        ]
        found[name] = Model(app, analyses, {}, title, {}, {"rubber": examples.rubber()})
    return found


if __name__ == "__main__":
    for name, model in models().items():
        bd.write_model(model, HERE / f"{name}.toml")
