"""Pictures of the guide's page on design."""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import bearingdyn as bd


def design(path: Path) -> None:
    """The mount of the page, and the band that its rubber leaves."""
    curve = bd.master_curve(bd.read_dma(bd.sample_dma_path()), T_ref=20.0)
    rubber = bd.fit_maxwell(curve, n=3, band=(1.0, 5e3), K=2e9, density=1150.0).with_spread(level=0.08)
    app = bd.Application()
    app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    app.add("layer", bd.Layer(0.020, 0.024, 0.012, rubber))
    app.connect("mass.centre", "layer.inner")
    app.ground("layer.outer")
    f = np.geomspace(50.0, 2000.0, 200)
    frf = bd.frequency_response(app, f, ["ground.y"], ["mass.centre.y"], uncertainty=200)
    ax = bd.plot.frequency_response(frf, "mass.centre.y", "ground.y")
    ax.figure.savefig(path, dpi=110)
    plt.close(ax.figure)
