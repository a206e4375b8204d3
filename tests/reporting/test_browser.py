"""The report in a browser: whole without a network, readable in light and dark, wide and narrow."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bearingdyn as bd
from browser import CONTRAST, browser


@pytest.fixture(scope="module")
def page_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report of the ready motor: modes, a response, a march, levels, and a sound."""
    folder = tmp_path_factory.mktemp("report")
    model = bd.read_model(bd.examples.model_path("motor"))
    found: dict[str, Any] = model.run()
    f = np.array([100.0, 200.0, 400.0])
    for name, size in (("levels/before", 1e-6), ("levels/after", 1e-8)):
        found[name] = bd.sound.band_levels(f, np.full(3, size))
    time = np.arange(24000) / 48000.0
    bd.write_wav(folder / "tone.wav", 0.02 * np.sin(2 * np.pi * 1000 * time), 48000, bits=16)
    return bd.report(found, folder / "motor.html", model=model, sounds={"a tone": folder / "tone.wav"})


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with browser() as opened:
        yield opened


def visit(chromium: Any, file: Path, width: int, scheme: str) -> tuple[Any, list[str], list[str]]:
    """The page, what the console said, and what was asked of a network."""
    view = chromium.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    said: list[str] = []
    asked: list[str] = []
    view.on("console", lambda message: said.append(message.text))
    view.on("pageerror", lambda error: said.append(str(error)))
    view.on("request", lambda request: asked.append(request.url))
    view.goto(file.as_uri())
    view.wait_for_selector("html[data-drawn=yes]", state="attached")
    return view, said, [url for url in asked if not url.startswith(("file:", "data:"))]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1300, 400])
def test_the_report_is_whole_and_readable(chromium: Any, page_file: Path, width: int, scheme: str) -> None:
    view, said, asked = visit(chromium, page_file, width, scheme)
    assert said == []
    assert asked == []
    # every figure is drawn
    charts = view.locator("figure.chart").count()
    assert charts >= 7
    assert view.locator("figure.chart .plot svg path").count() >= charts
    drawn = view.evaluate(
        "[...document.querySelectorAll('canvas')].map(c => {"
        " const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        " let n = 0; for (let i = 3; i < p.length; i += 4) n += p[i] > 0; return n / (p.length / 4); })"
    )
    assert len(drawn) == 1
    assert drawn[0] > 0.02
    # a level that stands alone is a dot
    assert view.locator("figure.chart", has_text="Levels in bands").locator("path.dots").count() == 2
    # ticks of an axis differ
    named = view.evaluate(
        "[...document.querySelectorAll('figure.chart svg')].map(s => {"
        " const t = [...s.querySelectorAll('text[text-anchor=end]')].map(e => e.textContent);"
        " return new Set(t).size - t.length; })"
    )
    assert set(named) == {0}
    # nothing is wider than the page
    assert view.evaluate("document.documentElement.scrollWidth") <= width
    ratio, text = view.evaluate(CONTRAST)
    assert ratio >= 4.5, text  # WCAG 2.1, level AA
    # every picture is told to those who do not see it
    silent = view.locator(
        "svg[role=img]:not([aria-label]), .plot:not([aria-label]), canvas:not([aria-label])"
    )
    assert silent.count() == 0
    assert view.locator("img:not([alt])").count() == 0
    view.close()


def test_a_curve_is_read_off_and_zoomed(chromium: Any, page_file: Path) -> None:
    view, said, _ = visit(chromium, page_file, 1300, "light")
    figure = view.locator("figure.chart", has_text="shaft.middle.y, by shaft.middle.y").first
    figure.scroll_into_view_if_needed()
    box = figure.locator(".plot").bounding_box()
    y = box["y"] + box["height"] / 2
    view.mouse.move(box["x"] + box["width"] - 9, y)
    # the last of its frequencies is 1 kHz, and the value that of the result
    shown = figure.locator(".readout").inner_text()
    model = bd.read_model(bd.examples.model_path("motor"))
    last = abs(model.run()["response"]["response"].values[-1, 0, 0])
    assert shown.startswith("1000: ")
    assert float(shown.split()[-1]) == pytest.approx(last * 1e9, rel=1e-4)  # nm/N, in five digits
    reset = figure.locator(".reset")
    assert not reset.is_visible()
    view.mouse.move(box["x"] + 0.3 * box["width"], y)
    view.mouse.down()
    view.mouse.move(box["x"] + 0.8 * box["width"], y)
    view.mouse.up()
    assert reset.is_visible()
    reset.click()
    assert not reset.is_visible()
    assert said == []
    view.close()


def test_a_sound_can_be_played(chromium: Any, page_file: Path) -> None:
    view, _, _ = visit(chromium, page_file, 1300, "light")
    lasts = view.evaluate(
        "new Promise(done => { const a = document.querySelector('audio');"
        " if (a.readyState) done(a.duration); else a.onloadedmetadata = () => done(a.duration); })"
    )
    assert lasts == pytest.approx(0.5, abs=1e-3)
    view.close()
