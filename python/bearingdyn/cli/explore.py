"""`bearingdyn explore motor.toml`: a page of sliders for a model file, until Ctrl-C."""

from __future__ import annotations

import argparse
import sys
import webbrowser

from bearingdyn.cli.outcome import GOOD
from bearingdyn.cli.run_model import parameters_of


def run_explorer(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn explore`."""
    from bearingdyn.explorer import Explorer, address, served
    from bearingdyn.model import read_model

    given = parameters_of(arguments.set)
    explorer = Explorer(read_model(arguments.model, **given) if given else arguments.model)
    with served(explorer, arguments.host, arguments.port) as server:
        print(f"bearingdyn: open {address(server)} in a browser; Ctrl-C ends it", file=sys.stderr, flush=True)
        if not arguments.no_browser:
            webbrowser.open(address(server))
        server.serve_forever()
    return "", GOOD
