"""The way back: an object asked for its picture reaches the end of the line, by name, when it is asked.

Data moves from the rooms to `plot` and never back; this one door is what a method such as `Application.draw`
needs, and no room imports `plot` for it.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


def picture(kind: str, thing: object, *arguments: Any, **keywords: Any) -> Any:
    """Picture of an object: what the function `kind` of bearingdyn.plot makes of it."""
    return getattr(import_module("bearingdyn.plot"), kind)(thing, *arguments, **keywords)


def page(thing: object) -> str:
    """The `_repr_html_` of objects that notebooks show: their page, HTML without scripts."""
    return str(picture("as_html", thing))
