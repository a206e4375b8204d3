"""The explorer as a web page: sliders in the browser, the machine on this computer."""

from __future__ import annotations

import math
from html import escape
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib.resources import files
from typing import Any
from urllib.parse import parse_qsl, urlsplit

from bearingdyn.checks import whole
from bearingdyn.explorer.exploration import Exploration, View
from bearingdyn.explorer.sliders import Slider
from bearingdyn.reporting import Chart, Curve, drawing_html, json_text, page_files

STEPS = 200  # of a slider


def served(explorer: Exploration, host: str = "127.0.0.1", port: int = 0) -> ThreadingHTTPServer:
    """A server of the explorer, ready to run: its page at /, and its numbers at /at.

    Parameters
    ----------
    explorer
        What is served.
    host, port
        As in `Explorer.serve`.
    """
    port = whole("port", port, 0, 65535)
    first = explorer.at({})
    page = page_html(explorer, first).encode()

    class Handler(BaseHTTPRequestHandler):
        server_version = "bearingdyn"

        def do_GET(self) -> None:
            # a page elsewhere that gives its own name to this address is not answered
            asked = self.headers.get("Host", "").rpartition(":")[0]
            if host == "127.0.0.1" and asked not in ("127.0.0.1", "localhost"):
                self._answer(HTTPStatus.FORBIDDEN, "text/plain", b"this explorer is for its own machine")
                return
            url = urlsplit(self.path)
            if url.path == "/":
                self._answer(HTTPStatus.OK, "text/html", page)
            elif url.path == "/at":
                try:
                    values = {name: float(value) for name, value in parse_qsl(url.query)}
                    view = explorer.at(values)
                except ValueError as error:
                    self._answer(HTTPStatus.BAD_REQUEST, "text/plain", str(error).encode())
                    return
                told = json_text(as_json(explorer, first, view))
                self._answer(HTTPStatus.OK, "application/json", told.encode())
            else:
                self._answer(HTTPStatus.NOT_FOUND, "text/plain", b"there are / and /at")

        def _answer(self, status: HTTPStatus, kind: str, body: bytes) -> None:
            self.send_response(status)
            self.send_header("Content-Type", f"{kind}; charset=utf-8")
            self.send_header("Content-Length", str(len(body)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, format: str, *args: Any) -> None:
            """Nothing is printed."""

    return ThreadingHTTPServer((host, port), Handler)


def address(server: ThreadingHTTPServer) -> str:
    """Address of an explorer's server."""
    host, port = server.server_address[:2]
    return f"http://{host if isinstance(host, str) else host.decode()}:{port}/"


def as_json(explorer: Exploration, first: View, view: View) -> dict[str, Any]:
    """A view as the page of an explorer's server takes it."""
    return {
        "chart": chart(explorer, first, view).held() if view.levels else None,
        "facts": view.facts,
        "trouble": view.trouble,
        "doubts": view.doubts,
        "seconds": view.seconds,
    }


def chart(explorer: Exploration, first: View, view: View) -> Chart:
    """Chart of an explorer's server: the response now and as given."""
    curves = [Curve(name, view.frequency, level) for name, level in view.levels.items()]
    curves += [
        Curve(f"{name}, as given", first.frequency, y, beside=name) for name, y in first.levels.items()
    ]
    return Chart(
        f"Response to a force at {explorer.input}",
        "frequency, Hz",
        "displacement, m/N (turning: rad/N)",
        curves,
        log_x=True,
        log_y=True,
    )


def page_html(explorer: Exploration, first: View) -> str:
    """The page of an explorer's server, whole."""
    style, script = page_files()
    text = files("bearingdyn.explorer").joinpath("page.html").read_text(encoding="utf-8")
    held = {
        "title": escape(explorer.title),
        "style": style,
        "script": script,
        "sliders": "".join(slider_html(s) for s in explorer.sliders.values()),
        "chart": chart(explorer, first, first).html(),
        "drawing": drawing_html(explorer.application),
    }
    for name, content in held.items():
        text = text.replace("{{" + name + "}}", content)
    return text


def slider_html(slider: Slider) -> str:
    """One slider on the page of an explorer's server, with its name, value and note."""
    low, value, high = (math.log10(x) if slider.log else x for x in (slider.low, slider.value, slider.high))
    # so that what the machine has lies on a step
    step = (
        (value - low) / max(1, round(STEPS * (value - low) / (high - low)))
        if value > low
        else (high - low) / STEPS
    )
    note = f"<small>{escape(slider.note)}</small>" if slider.note else ""
    log = " data-log=1" if slider.log else ""
    return (
        f"<label><span class=row><span>{escape(slider.name)}</span><output></output></span>"
        f'<input type=range name="{escape(slider.name, True)}" min={low:.9g} max={high:.9g} step={step:.9g} '
        f'value={value:.9g} data-unit="{escape(slider.unit, True)}" data-given={slider.value!r}{log}>'
        f"{note}</label>"
    )
