"""A backend that does what Jupyter's does: loaded, it switches `interactive` on, and shows what is made then.

It stands for matplotlib_inline.backend_inline, which needs an IPython session; tests/examples runs notebooks.
"""

from __future__ import annotations

from typing import Any

import matplotlib
from matplotlib._pylab_helpers import Gcf
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg

shown: list[Any] = []


def new_figure_manager(number: int, *args: Any, FigureClass: Any, **kwargs: Any) -> FigureManagerBase:
    figure = FigureClass(*args, **kwargs)
    return new_figure_manager_given_figure(number, figure)


def new_figure_manager_given_figure(number: int, figure: Any) -> FigureManagerBase:
    manager = FigureManagerBase(FigureCanvasAgg(figure), number)
    if matplotlib.is_interactive():
        shown.append(figure)
    return manager


def show(*args: Any, **kwargs: Any) -> None:
    Gcf.destroy_all()


FigureCanvas = FigureCanvasAgg
FigureManager = FigureManagerBase
matplotlib.interactive(True)
