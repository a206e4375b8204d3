"""`bearingdyn bearing`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from bearingdyn.cli import main

LINE = "6205 --radial 2000 --axial 300 --rpm 3000 --oil VG32 --temperature 70".split()


def test_it_prints_the_sheet(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", *LINE]) == 0
    out = capsys.readouterr().out
    assert "basic dynamic rating C, N                                      14000" in out
    assert "C as NSK prints it (computed" in out
    assert "C0 as NSK prints it (computed" in out
    assert "viscosity, mm²/s                                     11.19" in out


def test_a_heading_without_rows_and_a_name_said_twice_are_not_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert main(["bearing", "6206", "--radial", "1000"]) == 0
    out = capsys.readouterr().out
    assert "Film and friction" not in out  # without an oil
    assert "6206: 6206:" not in out
    # the ratings as printed, and as computed: a report of the same bearing shows them the other way round
    assert "6206: C as NSK prints it (computed 19456 N); C0 as NSK prints it (computed 11256 N)" in out


def test_json_has_si_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", *LINE, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["L10"]["value"] == pytest.approx(343.0)
    assert found["viscosity"] == {"value": pytest.approx(11.186e-6, rel=1e-4), "units": "m²/s"}
    assert found["lambda_inner"]["value"] is None


def test_a_page_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "6205.html"
    assert main(["bearing", *LINE, "--html", str(page)]) == 0
    assert str(page) in capsys.readouterr().out
    assert "<h1>Bearing 6205</h1>" in page.read_text(encoding="utf-8")


def test_clearance_and_what_is_passed_over(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", "SKF 6205-2RS/C3", "--radial", "500", "--json"]) == 0
    out = capsys.readouterr()
    assert json.loads(out.out)["clearance"]["value"] == pytest.approx(20.5e-6)
    assert "passed over: SKF, 2RS" in out.err
    assert main(["bearing", "6205", "--radial", "500", "--clearance", "7", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["clearance"]["value"] == pytest.approx(7e-6)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (["6299"], "designation is '6299'; the nearest are"),
        (["7205", "--axial", "-300"], "open side"),
        ([*LINE[:7], "--oil", "water"], "oil is 'water'; give an ISO viscosity grade"),
        ([*LINE, "--contamination", "1.5"], "contamination is 1.5"),
        ([*LINE, "--reliability", "50"], "reliability is 50"),
        (["6205", "--radial", "-5"], "radial is -5"),
    ],
)
def test_what_cannot_be_used_is_one_line(
    line: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bearing", *line]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("word", ["-5e2", "-500", "-.5E+3", "-5000e-1"])
def test_a_negative_number_is_no_option_however_it_is_written(
    word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bearing", "6205", "--radial", "2000", "--axial", word, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert abs(found["axial_load"]["value"]) == pytest.approx(500.0, rel=1e-6)


@pytest.mark.parametrize("word", ["-inf", "-nan", "-1e400"])
def test_a_number_without_end_is_refused_by_its_name(word: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", "6205", "--radial", "2000", "--axial", word]) == 2
    assert "axial is" in capsys.readouterr().err
