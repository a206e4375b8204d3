"""Colours of temperatures, and the bar that explains them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bearingdyn.types import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap, Normalize


TEMPERATURES = "viridis"
BRIGHTEST = 0.9  # of its range: the end would not show on white


def temperature_scale(temperature: Array) -> Normalize:
    """Scale of the temperature colours over these temperatures, °C."""
    from matplotlib.colors import Normalize

    return Normalize(float(temperature.min()), float(temperature.max()))


def temperature_colour(scale: Normalize, temperature: float) -> tuple[float, ...]:
    """Colour of a temperature, °C."""
    return tuple(temperature_colours()(float(scale(temperature))))


def temperature_colours() -> Colormap:
    """Colours of temperatures, the coldest first."""
    import matplotlib
    from matplotlib.colors import ListedColormap

    return ListedColormap(matplotlib.colormaps[TEMPERATURES](np.linspace(0.0, BRIGHTEST, 256)))


def temperature_bar(panels: list[Axes], scale: Normalize) -> None:
    """The colours of the temperatures, beside the panels."""
    from matplotlib.cm import ScalarMappable

    bar = panels[0].figure.colorbar(
        ScalarMappable(scale, temperature_colours()), ax=panels, aspect=35, pad=0.02
    )
    bar.set_label("temperature, °C")
    outline: Any = bar.outline
    outline.set_visible(False)
    bar.ax.tick_params(labelsize=8.5, width=0.7)
