"""Draws the rooms of the package and what passes between them: data move from left to right only."""

from __future__ import annotations

import sys
from pathlib import Path

INK, SOFT, PAPER = "#22313f", "#5d6d7e", "#ffffff"
GIVEN, ROOM, CORE, TOLD = "#f1ede4", "#dceaf4", "#f6dcc8", "#e3efdd"
HEIGHT = 0.78

# name: (x, y, width, colour, second line)
BOXES: dict[str, tuple[float, float, float, str, str]] = {
    "catalogue, oil": (-0.1, 3.0, 1.7, GIVEN, "maker"),
    "DMA table": (-0.1, 1.5, 1.7, GIVEN, "laboratory"),
    "drawing, mesh": (-0.1, 0.0, 1.7, GIVEN, "or FE matrices"),
    "bearing": (2.15, 3.0, 1.3, ROOM, "force of balls"),
    "material": (2.15, 1.5, 1.3, ROOM, "G*(ω), Maxwell"),
    "fem": (2.15, 0.0, 1.3, ROOM, "M, K$_{vol}$, K$_{dev}$"),
    "cms": (4.1, 0.0, 1.3, ROOM, "superelement"),
    "parts": (6.05, 0.0, 1.3, ROOM, "shaft, layer …"),
    "application": (5.95, 1.5, 1.5, ROOM, "joints, loads"),
    "system": (8.0, 1.5, 1.3, ROOM, "plain arrays"),
    "analysis": (9.9, 1.5, 1.4, ROOM, "modes, FRF, runs"),
    "core": (9.9, 3.0, 1.4, CORE, "C: steps, sweeps"),
    "sound": (11.9, 3.0, 1.3, ROOM, "power, levels"),
    "results": (11.9, 1.5, 1.3, ROOM, "named, in SI"),
    "plot": (13.85, 3.0, 1.3, TOLD, "one call each"),
    "study": (13.85, 1.5, 1.3, TOLD, "many designs"),
    "cli": (13.85, 0.0, 1.3, TOLD, "shell"),
}
ARROWS = [
    ("DMA table", "material"), ("catalogue, oil", "bearing"), ("drawing, mesh", "fem"),
    ("material", "bearing"), ("fem", "cms"), ("cms", "parts"), ("parts", "application"),
    ("application", "system"), ("system", "analysis"), ("analysis", "results"),
    ("analysis", "sound"), ("sound", "results"),
    ("results", "plot"), ("results", "study"), ("results", "cli"),
]  # fmt: skip


def draw(path: Path) -> None:
    """Write the picture as SVG or PNG, by the ending of the path."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

    figure = Figure(figsize=(11.2, 3.5), facecolor=PAPER)
    FigureCanvasAgg(figure)
    ax = figure.add_axes((0, 0, 1, 1))
    ax.set_xlim(-0.25, 15.3)
    ax.set_ylim(-0.75, 4.1)
    ax.set_axis_off()
    for name, (x, y, width, colour, second) in BOXES.items():
        style = "round,pad=0,rounding_size=0.12" if colour != GIVEN else "square,pad=0"
        ax.add_patch(FancyBboxPatch((x, y), width, HEIGHT, boxstyle=style, fc=colour, ec=INK, lw=0.9))
        middle = x + width / 2
        ax.text(middle, y + 0.50, name, ha="center", va="center", fontsize=9.5, weight="bold", color=INK)
        ax.text(middle, y + 0.21, second, ha="center", va="center", fontsize=7.2, color=SOFT)

    def arrow(start: tuple[float, float], end: tuple[float, float], both: bool = False) -> None:
        look = "<|-|>" if both else "-|>"
        ax.add_patch(
            FancyArrowPatch(
                start, end, arrowstyle=look, mutation_scale=10, lw=1.0, color=INK, shrinkA=2, shrinkB=2
            )
        )

    for a, b in ARROWS:
        (xa, ya, wa, *_), (xb, yb, wb, *_) = BOXES[a], BOXES[b]
        x = xa + wa / 2
        if abs(x - (xb + wb / 2)) < 0.01:  # one above the other
            up = yb > ya
            arrow((x, ya + (HEIGHT if up else 0)), (x, yb + (0 if up else HEIGHT)))
        else:
            arrow((xa + wa, ya + HEIGHT / 2), (xb, yb + HEIGHT / 2))
    x, y, w, *_ = BOXES["core"]
    arrow((x + w / 2, BOXES["analysis"][1] + HEIGHT), (x + w / 2, y), both=True)
    # round the corner: rubber goes into superelements, bearings into the application
    for source, target in (("material", "cms"), ("bearing", "application")):
        (xs, ys, ws, *_), (xt, yt, wt, *_) = BOXES[source], BOXES[target]
        bend = xt + wt / 2
        ax.plot([xs + ws, bend], [ys + HEIGHT / 2] * 2, color=INK, lw=1.0)
        arrow((bend, ys + HEIGHT / 2 + 0.05), (bend, yt + HEIGHT))
    ax.text(
        -0.1, -0.45, "Data move to the right only. No room imports one beside or after it; "
        "the core knows arrays, balls, branches and time.",
        fontsize=7.6, color=SOFT, va="center",
    )  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110, metadata={"Date": None} if path.suffix == ".svg" else None)


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
