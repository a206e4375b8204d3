"""A machine in three dimensions, for pyvista."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from bearingdyn.application import Application
from bearingdyn.parts import Outlined
from bearingdyn.plot.arguments import figure, one
from bearingdyn.plot.drawing.shown_machine import placed
from bearingdyn.types import Array


@figure(app=one(Application, maker="an Application (bd.Application())"))
def scene(app: Application) -> Any:
    """A machine as a scene in 3-D, a pyvista.MultiBlock, a block for each part and each bearing's balls.

    Parameters
    ----------
    app
        The application.

    Returns
    -------
    pyvista.MultiBlock
        Surfaces, m, from the first interface of the first part, y up and z along the shaft.
        `.save("motor.vtm")` writes it for ParaView.

    Raises
    ------
    ImportError
        Without pyvista.
    ValueError
        Where no part has a surface.
    """
    try:
        pyvista = import_module("pyvista")
    except ImportError:
        raise ImportError(
            "app.scene() needs pyvista: pip install bearingdyn[scene]; app.draw() draws without"
        ) from None
    places = app.plan.positions()
    blocks = pyvista.MultiBlock()
    for name, element in app.plan.parts.items():
        source = app.plan.sources[name]
        first = next(iter((*element.interfaces, *element.raceways)), None)
        at = places.get(f"{name}.{first}")
        if at is None or not isinstance(source, Outlined):
            continue
        outline = source.outline()
        cells = np.insert(outline.faces, 0, outline.faces.shape[1], axis=1)
        blocks.append(pyvista.PolyData(placed(app.plan, name, outline) + at, cells.ravel()), name)
    for name, joint in app.plan.bearings.items():
        at = places.get(str(joint.inner))
        if at is None:
            continue
        b, at = joint.bearing, at + (0.0, 0.0, joint.place)
        balls = [
            pyvista.Sphere(
                radius=0.5 * b.Dw, center=at + _around(0.5 * b.Dpw, b.angle0 + 2 * np.pi * k / b.Z)
            )
            for k in range(b.Z)
        ]
        blocks.append(pyvista.merge(balls), name)
    if len(blocks) == 0:
        raise ValueError("app has no part with a surface; app.draw() draws joints and loads without")
    return blocks


def _around(radius: float, azimuth: float) -> Array:
    return radius * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
