"""The explorer of a machine: sliders in a notebook and on a web page."""

from __future__ import annotations

import webbrowser
from typing import Any

from bearingdyn.checks import truth
from bearingdyn.explorer.exploration import Exploration
from bearingdyn.explorer.server import address, served
from bearingdyn.explorer.widgets import box


class Explorer(Exploration):
    """The explorer of a machine: sliders for layer, rubber, loads and clearance, and what it answers.

    In a notebook an explorer shows itself (package ipywidgets, extra "explore"); `serve` makes a web page of
    it, as `bearingdyn explore motor.toml` does; `at` gives the numbers. Parameters of a model file are
    sliders too; each change of one reads the file anew.

    Parameters
    ----------
    source
        A model, an application, or the path of a model file.
    input
        Channel of the force; None: that of the model's first frequency response, or vertically where the
        first constant load acts.
    outputs
        Channels; None: those of that response, or the input's own.
    frequency
        (f,) Hz; None: 400 of them over the band of that response, or from 10 Hz to 5 kHz.

    Attributes
    ----------
    sliders
        By name.

    Raises
    ------
    ValueError
        For a source that is none of these or has nothing to turn, and channels that do not exist.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> explorer = bd.Explorer(bd.examples.motor(), frequency=[100.0, 1000.0])
    >>> sorted(explorer.sliders)[:3]
    ['axial load', 'clearance', 'layer thickness']
    >>> thin, thick = (explorer.at({"layer thickness": t}) for t in (2.0, 4.0))
    >>> bool(thin.levels["shaft.middle.y"][0] < thick.levels["shaft.middle.y"][0])
    True
    """

    def serve(self, *, host: str = "127.0.0.1", port: int = 0, open_browser: bool = True) -> None:
        """Serve the explorer as a web page until it is interrupted (Ctrl-C).

        Parameters
        ----------
        host
            Whom it listens for; this machine alone by default.
        port
            Of the page; 0: any that is free.
        open_browser
            Whether the page is opened in the browser of this machine.

        Raises
        ------
        OSError
            Where the port is taken.
        """
        open_browser = truth("open_browser", open_browser)
        with served(self, host, port) as server:
            if open_browser:
                webbrowser.open(address(server))
            server.serve_forever()

    def widget(self) -> Any:
        """The explorer as an ipywidgets box: sliders, response and facts.

        Raises
        ------
        ModuleNotFoundError
            Where ipywidgets is not installed: the extra "explore" has it.
        """
        return box(self)

    def _repr_mimebundle_(self, **how: Any) -> Any:
        """In a notebook: the sliders."""
        return self.widget()._repr_mimebundle_(**how)
