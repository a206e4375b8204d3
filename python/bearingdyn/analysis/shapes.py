"""Mode shapes where they can be seen: on the interfaces and points of the parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bearingdyn.analysis.equilibrium import Equilibrium
from bearingdyn.application import COMPONENTS, Application
from bearingdyn.system import System, assemble

if TYPE_CHECKING:
    import xarray


def mode_shapes(source: Equilibrium | Application | System, found: xarray.Dataset) -> xarray.Dataset:
    """Motion of every interface and point in the modes that `modes` found, and where it stands.

    Returns a Dataset with motion (mode, place, component), complex, m and rad, NaN for rotations of points
    that have none; position (place, axis), m, from the first interface of the first part; and frequency
    (mode). A mode has the size that `modes` gave it. Places that nothing joins to the first part are left
    out.

    Raises ValueError for modes of another system, or a system that does not know its parts.
    """
    if isinstance(source, Application):
        source = assemble(source)
    system = source.system if isinstance(source, Equilibrium) else source
    shape = found["shape"].values
    if shape.shape[1] != system.n:
        raise ValueError(
            f"the modes have {shape.shape[1]} coordinates and the system {system.n}; give modes of this one"
        )
    places = [name for name in system.outputs if name in system.positions]
    if not places:
        raise ValueError("the system does not know where its parts stand; pass an application")
    motion = np.full((len(shape), len(places), 6), np.nan, dtype=np.complex128)
    for k, name in enumerate(places):
        rows = system.rows(name)
        motion[:, k, : len(rows)] = shape @ rows.T

    from bearingdyn.results import dataset, inputs_of

    return dataset(
        {
            "motion": (
                ("mode", "place", "component"),
                motion,
                "m, rad",
                "mode shape at interfaces and points",
            ),
            "position": (
                ("place", "axis"),
                np.array([system.positions[name] for name in places]),
                "m",
                "from the first interface of the first part",
            ),
            "frequency": ("mode", found["frequency"].values, "Hz", "undamped natural frequency |λ|/2π"),
        },
        {"analysis": "mode shapes", **inputs_of(system.inputs)},
        {"place": (places, ""), "component": (list(COMPONENTS), ""), "axis": (["x", "y", "z"], "")},
    )
