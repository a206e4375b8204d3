"""The explorer in a notebook, by ipywidgets: sliders, the response beside them, and what is read off it."""

from __future__ import annotations

import io
import math
from html import escape
from typing import Any

from bearingdyn.explorer.exploration import Exploration, View
from bearingdyn.explorer.sliders import Slider

STEPS = 100  # of a slider


def box(explorer: Exploration) -> Any:
    """Widgets of an explorer in a notebook: sliders and picture.

    Parameters
    ----------
    explorer
        What is turned.

    Returns
    -------
    ipywidgets.HBox
        Sliders first, then the picture and the facts.
    """
    import ipywidgets

    first = explorer.at({})
    picture = _Picture(explorer, first)
    image = ipywidgets.Image(value=picture.drawn(first), format="png")
    facts = ipywidgets.HTML(_facts(first))
    sliders = {name: _slider(slider) for name, slider in explorer.sliders.items()}

    def redraw(_: object) -> None:
        moved = {name: s.value for name, s in sliders.items() if s.value != explorer.sliders[name].value}
        view = explorer.at(moved)
        if view.levels:
            image.value = picture.drawn(view)
        facts.value = _facts(view)

    for slider in sliders.values():
        slider.observe(redraw, "value")
    return ipywidgets.HBox([ipywidgets.VBox(list(sliders.values())), ipywidgets.VBox([image, facts])])


def _slider(slider: Slider) -> Any:
    """A slider of ipywidgets."""
    import ipywidgets

    looks = {
        "description": f"{slider.name}, {slider.unit}" if slider.unit else slider.name,
        "style": {"description_width": "10em"},
        "layout": ipywidgets.Layout(width="26em"),
        "readout_format": ".3g",
        "tooltip": slider.note,
    }
    if slider.log:
        low, high = math.log10(slider.low), math.log10(slider.high)
        return ipywidgets.FloatLogSlider(
            value=slider.value, base=10.0, min=low, max=high, step=(high - low) / STEPS, **looks
        )
    step = (slider.high - slider.low) / STEPS
    return ipywidgets.FloatSlider(value=slider.value, min=slider.low, max=slider.high, step=step, **looks)


class _Picture:
    """One figure whose curves are moved: a new one would take three times as long."""

    def __init__(self, explorer: Exploration, first: View) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.figure = Figure(figsize=(6.4, 3.6), layout="constrained", dpi=96)
        self.canvas = FigureCanvasAgg(self.figure)
        self.axes = self.figure.add_subplot()
        self.curves = {}
        for k, (name, level) in enumerate(first.levels.items()):
            self.axes.loglog(
                first.frequency, level, color=f"C{k}", lw=0.8, ls="--", label=f"{name}, as given"
            )
            (self.curves[name],) = self.axes.loglog(first.frequency, level, color=f"C{k}", label=name)
        self.axes.set_xlabel("frequency, Hz")
        self.axes.set_ylabel("displacement, m/N")
        self.axes.set_title(f"Response to a force at {explorer.input}", fontsize=10)
        self.axes.legend(fontsize=8)
        self.axes.grid(alpha=0.3)

    def drawn(self, view: View) -> bytes:
        """The figure with a view's curves, as PNG."""
        for name, level in view.levels.items():
            self.curves[name].set_ydata(level)
        self.axes.relim()
        self.axes.autoscale_view()
        held = io.BytesIO()
        self.figure.savefig(held, format="png")
        return held.getvalue()


def _facts(view: View) -> str:
    """The facts as a table, and what is wrong."""
    rows = "".join(f"<tr><td>{escape(a)}&emsp;</td><td>{escape(b)}</td></tr>" for a, b in view.facts)
    said = "".join(f"<p><b>{escape(line)}</b></p>" for line in (view.trouble, *view.doubts) if line)
    return f"<table>{rows}</table>{said}"
