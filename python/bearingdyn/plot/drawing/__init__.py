"""The drawing of a machine before anything is solved: section, bearings, supports, loads, names, parts."""

from bearingdyn.plot.drawing.machine_drawing import draw
from bearingdyn.plot.drawing.scene import scene

__all__ = ["draw", "scene"]
