"""What a system was assembled from, kept with it so that results can say it."""

from __future__ import annotations

from dataclasses import replace

from bearingdyn import fingerprint
from bearingdyn.application import Application
from bearingdyn.system.system import System


def noted(system: System, app: Application) -> System:
    """Note in a system its origin: the application's parts, joints, bearings and loads as a text."""
    # the reduced parts, and what is kept of them, follow from their sources; from a fit's check nothing does
    held = {
        name: value
        for name, value in vars(app.plan).items()
        if name not in ("parts", "reduced", "unjudged") and name[0] != "_"
    }
    return replace(system, inputs=fingerprint.text(held))
