"""How long a change of a slider takes: in the package, and in Chromium from the slider to the curve.

The ready motor, each of its sliders moved to a new place; least of three. Target: 0.3 s in the package, 0.5 s
in the browser, where playwright and Chromium are installed.
"""

from __future__ import annotations

import argparse
import json
import shutil
import threading
import time
import warnings

import bearingdyn as bd
from bearingdyn.explorer import address, served

FOLLOW = """async ([name, share]) => {
  const input = document.querySelector(`input[name="${name}"]`);
  const curve = () => document.querySelector("figure.chart path.curve").getAttribute("d");
  const old = curve(), began = performance.now();
  input.value = Number(input.min) + share * (Number(input.max) - Number(input.min));
  input.dispatchEvent(new Event("input"));
  while (curve() === old && performance.now() - began < 20e3) await new Promise(r => setTimeout(r, 2));
  return (performance.now() - began) / 1e3;
}"""


def in_package(explorer: bd.Explorer) -> dict[str, dict[str, float]]:
    """Wall and CPU seconds of a change of each slider."""
    found = {}
    for name, slider in explorer.sliders.items():
        walls, cpus = [], []
        for share in (0.3, 0.5, 0.7):
            wall, cpu = time.perf_counter(), time.process_time()
            explorer.at({name: slider.low + share * (slider.high - slider.low)})
            walls.append(time.perf_counter() - wall)
            cpus.append(time.process_time() - cpu)
        found[name] = {"wall_s": round(min(walls), 3), "cpu_s": round(min(cpus), 3)}
    return found


def in_browser(explorer: bd.Explorer) -> dict[str, float] | str:
    """Seconds from a slider to its curve."""
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return "playwright is not installed"
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        return "Chromium is not installed"
    server = served(explorer)
    threading.Thread(target=server.serve_forever).start()
    try:
        with sync_playwright() as driver:
            chromium = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
            page = chromium.new_page()
            page.goto(address(server))
            page.wait_for_selector("html[data-shown='1']", state="attached")
            return {
                name: round(min(page.evaluate(FOLLOW, [name, share]) for share in (0.3, 0.5, 0.7)), 3)
                for name in explorer.sliders
            }
    finally:
        server.shutdown()
        server.server_close()


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", action="store_true")
    warnings.simplefilter("ignore")
    machine = bd.Explorer(bd.examples.model_path("motor"))
    made = {"package": in_package(machine), "browser": in_browser(machine)}
    if parser.parse_args().json:
        print(json.dumps(made))
    else:
        for where, rows in made.items():
            print(where)
            for name, figure in rows.items() if isinstance(rows, dict) else [("", rows)]:
                print(f"  {name:20} {figure}")
