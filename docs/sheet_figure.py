"""Draws how near the catalogue comes to a maker's print, and the life of a bearing over its temperature."""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

INK, BLUE, ORANGE = "#22313f", "#2b6ea6", "#c9692c"


def draw(path: Path) -> None:
    """Write the picture as SVG or PNG, by the ending of the path."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    import bearingdyn as bd
    from bearingdyn.analysis import single_bearing

    figure = Figure(figsize=(9.6, 3.4), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)

    entries = {id(e): e.deviation for e in bd.catalogue.CATALOGUE.values() if e.deviation is not None}
    off = np.array(list(entries.values()))
    bins = np.linspace(-2, 2, 41)
    left.hist(100 * off[:, 0], bins, color=BLUE, alpha=0.8, label="C (ISO 281)")
    left.hist(100 * off[:, 1], bins, color=ORANGE, alpha=0.6, label="C0 = f0 Z Dw² cosα")
    left.set_xlabel("off the maker's print, %")
    left.set_ylabel("bearings")
    left.set_title(f"ratings of {len(off)} bearings of the catalogue", fontsize=10)
    left.legend(frameon=False, fontsize=8)

    oil = bd.bearing.Lubricant(bd.bearing.Walther.iso_vg(46))
    state = single_bearing(bd.catalogue.bearing("6205"), radial=1500.0, axial=300.0)
    T = np.linspace(30, 110, 33)
    speed = 3000 * math.pi / 30
    words = {"high cleanliness": "-", "normal cleanliness": "--", "typical contamination": ":"}
    for contamination, style in words.items():
        given = {"speed": speed, "oil": oil, "contamination": contamination}
        hours = [float(bd.bearing_sheet(state, temperature=t, **given)["L10mh"][0]) for t in T]
        right.semilogy(T, hours, style, color=BLUE, label=contamination)
    basic = float(bd.bearing_sheet(state, speed=speed)["L10rh"][0])
    right.axhline(basic, color=ORANGE, lw=1, label="without regard to the oil")
    right.set_xlabel("temperature of the oil, °C")
    right.set_ylabel("life of 90 %, h")
    right.set_title("6205, 1.5 kN radial, 0.3 kN axial, 3000 rpm, VG 46", fontsize=10)
    right.legend(frameon=False, fontsize=8)
    for ax in (left, right):
        ax.spines[["top", "right"]].set_visible(False)
    figure.savefig(path)


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
