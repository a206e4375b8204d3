"""The explorer's page: in Chromium, and asked by others than its page."""

from __future__ import annotations

import http.client
import json
import threading
from collections.abc import Iterator
from typing import Any

import pytest

import bearingdyn as bd
from bearingdyn.explorer import address, served
from browser import CONTRAST, browser


@pytest.fixture(scope="module")
def place() -> Iterator[str]:
    server = served(bd.Explorer(bd.examples.model_path("motor")))
    runner = threading.Thread(target=server.serve_forever)
    runner.start()
    yield address(server)
    server.shutdown()
    runner.join()
    server.server_close()


@pytest.mark.parametrize(("width", "scheme"), [(1300, "light"), (400, "dark")])
def test_a_slider_moves_and_the_curve_follows(place: str, width: int, scheme: str) -> None:
    with browser() as chromium:
        view = chromium.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
        said: list[str] = []
        asked: list[str] = []
        view.on("console", lambda message: said.append(message.text))
        view.on("pageerror", lambda error: said.append(str(error)))
        view.on("request", lambda request: asked.append(request.url))
        view.goto(place)
        view.wait_for_selector("html[data-shown='1']", state="attached")
        curve = "document.querySelector('figure.chart path.curve').getAttribute('d')"
        before, facts = view.evaluate(curve), view.locator(".facts").inner_text()
        # as a hand does: along the slider, an event for every position
        took = view.evaluate(
            """async () => {
              const input = document.querySelector('input[name="layer thickness"]');
              const curve = () => document.querySelector('figure.chart path.curve').getAttribute('d');
              const old = curve(), began = performance.now();
              input.value = 2; input.dispatchEvent(new Event("input"));
              while (curve() === old && performance.now() - began < 20e3)
                await new Promise(r => setTimeout(r, 5));
              return performance.now() - began;
            }"""
        )
        assert view.evaluate(curve) != before
        assert view.locator(".facts").inner_text() != facts
        assert view.locator("label", has_text="layer thickness").locator("output").inner_text() == "2 mm"
        # how long is measured by benchmarks/explorer.py; here only that it does not hang
        assert took < 20e3
        view.get_by_role("button", name="as given", exact=True).click()
        view.wait_for_selector("html[data-shown='3']", state="attached")
        assert view.evaluate(curve) == before
        assert said == []
        assert all(url.startswith((place, "data:")) for url in asked)
        assert view.evaluate("document.documentElement.scrollWidth") <= width
        worst, text = view.evaluate(f"({CONTRAST})()")
        assert worst >= 4.5, text


def answer(place: str, path: str, **headers: str) -> tuple[int, str]:
    to = place.removeprefix("http://").rstrip("/")
    connection = http.client.HTTPConnection(to, timeout=20)
    connection.request("GET", path, headers=headers)
    found = connection.getresponse()
    return found.status, found.read().decode()


def test_what_is_asked_wrongly_is_answered_with_a_reason(place: str) -> None:
    assert answer(place, "/at?height=3")[0] == 400
    status, text = answer(place, "/at?axial+load=many")
    assert (status, "could not convert" in text) == (400, True)
    assert answer(place, "/etc/passwd")[0] == 404
    # another page's name for this address
    assert answer(place, "/", Host="elsewhere.example:80")[0] == 403


def test_numbers_are_those_of_the_explorer(place: str) -> None:
    status, text = answer(place, "/at?axial+load=150")
    view: dict[str, Any] = json.loads(text)
    assert status == 200
    own = bd.Explorer(bd.examples.model_path("motor")).at({"axial load": 150.0})
    assert [tuple(pair) for pair in view["facts"]] == list(own.facts)
