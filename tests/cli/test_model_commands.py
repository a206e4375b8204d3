"""`bearingdyn run`, `check`, `explore` and `report` of a model file: what they print, and refuse."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import bearingdyn as bd
from bearingdyn.cli import main

FAN = str(bd.examples.model_path("fan"))
LONE = (
    "format = 1\n[parameters]\nweight = 2.0\n[parts.mass]\ntype = 'RigidBody'\nmass = '= weight'\n"
    "inertia = [1e-3, 1e-3, 1e-3]\n[[joints]]\nground = 'mass.centre'\n"
    "stiffness = [1e6, 1e6, 1e6, 1e6, 1e6, 1e6]\n"
)


@pytest.fixture
def lone(tmp_path: Path) -> str:
    path = tmp_path / "lone.toml"
    path.write_text(LONE, encoding="utf-8")
    return str(path)


def test_a_model_that_asks_for_nothing_is_told_how_to_ask(lone: str, capsys: Any) -> None:
    assert main(["run", lone]) == 0
    assert "add [[analyses]] with a type" in capsys.readouterr().out
    assert main(["check", lone]) == 0
    assert capsys.readouterr().out.rstrip().endswith("none")


def test_a_check_as_json_names_parts_bearings_and_analyses(lone: str, capsys: Any) -> None:
    assert main(["check", FAN, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    plan = bd.examples.fan().plan
    assert told["parts"] == list(plan.parts)
    assert told["bearings"] == list(plan.bearings)
    assert told["analyses"]
    assert main(["check", lone, "--json", "--set", "weight=3"]) == 0
    assert json.loads(capsys.readouterr().out)["parameters"] == {"weight": 3.0}
    # what is no number is a text in the model's own notation
    assert main(["check", lone, "--json", "--set", "weight== 3 * 1000 * g"]) == 0
    assert json.loads(capsys.readouterr().out)["parameters"] == {"weight": 3.0}


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["check", FAN, "--set", "thickness"], "--set is 'thickness'; it must be NAME=VALUE"),
        (["check", FAN, "--set", "=3"], "--set is '=3'"),
        (["report", FAN, "--sound", "before"], "--sound is 'before'; it must be LABEL=FILE"),
        (["report", FAN, "--sound", "=x.wav"], "--sound is '=x.wav'"),
    ],
)
def test_what_is_set_amiss_is_named(asked: list[str], said: str, capsys: Any) -> None:
    assert main(asked) == 2
    assert said in capsys.readouterr().err


def test_a_run_as_json_says_where_results_are(lone: str, tmp_path: Path, capsys: Any) -> None:
    with Path(lone).open("a", encoding="utf-8") as file:
        file.write("[[analyses]]\ntype = 'modes'\ncount = 2\n")
    out = tmp_path / "lone.nc"
    assert main(["run", lone, "--out", str(out), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["file"] == str(out)
    assert told["results"]["modes"]["analysis"] == "modes"
    assert bd.open_result(out, "modes")["frequency"].size == 2


def test_explore_serves_the_model_and_opens_a_browser(monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    import webbrowser
    from http.server import HTTPServer

    opened: list[str] = []
    served: list[bool] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(HTTPServer, "serve_forever", lambda self: served.append(True))
    motor = str(bd.examples.model_path("motor"))
    assert main(["explore", motor, "--port", "0"]) == 0
    assert served == [True]
    assert opened[0].startswith("http://127.0.0.1:")
    assert opened[0] in capsys.readouterr().err
    assert main(["explore", motor, "--port", "0", "--no-browser"]) == 0
    assert len(opened) == 1
