"""The drawing of a machine before anything is solved: section, bearings, supports, loads, names, parts."""

from bearingdyn.plot.drawing.scene import scene
from bearingdyn.plot.drawing.sheet import draw

__all__ = ["draw", "scene"]
