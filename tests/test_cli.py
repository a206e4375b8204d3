"""The command line: exit codes, JSON that parses, one line for an error."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from bearingdyn import results
from bearingdyn.cli import main
from bearingdyn.material import Maxwell, sample_dma_path

SAMPLE = str(sample_dma_path())


def test_fit_prints_the_model_and_writes_it(tmp_path, capsys):
    out = tmp_path / "maxwell.json"
    assert main(["fit", SAMPLE, "--n", "3", "--band", "10", "5000", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    model = Maxwell.from_json(out.read_text())
    assert model.G.size <= 3
    for name in ("G0", "G1", "tau1", "eta0", "tan delta", "5000 Hz", "(assumed)", str(out)):
        assert name in printed
    assert f"{model.G0:.5g}" in printed
    assert printed.isascii()  # any terminal can show it


def test_fit_as_json_parses_and_is_the_written_model(tmp_path, capsys):
    out = tmp_path / "maxwell.json"
    options = ["--K", "2.5e9", "--density", "1100", "--T-ref", "10", "--band", "10", "1000", "--n", "2"]
    assert main(["fit", SAMPLE, *options, "--json", "--out", str(out)]) == 0
    record = json.loads(capsys.readouterr().out)
    assert Maxwell.from_json(json.dumps(record["maxwell"])) == Maxwell.from_json(out.read_text())
    assert (record["maxwell"]["K"], record["maxwell"]["density"]) == (2.5e9, 1100.0)
    assert record["fit"]["band"] == [10.0, 1000.0]
    assert record["master"]["T_ref"] == 10.0
    assert 0 < record["fit"]["storage_rms"] <= record["fit"]["storage_max"]


@pytest.fixture
def result(tmp_path):
    data = results.dataset(
        {"response": (("frequency", "output"), np.full((3, 1), 1 + 2j), "m/N", "complex displacement")},
        {"analysis": "frequency response", "speed": 1.5},
        {"frequency": ([1.0, 2.0, 3.0], "Hz"), "output": (["shaft.left.θx"], "")},
    )
    results.save({"layer": data, "no layer": data}, tmp_path / "r.nc")
    results.save(data, tmp_path / "one.nc")
    return tmp_path


def test_show_lists_groups_dims_variables_and_attributes(result, capsys):
    assert main(["show", str(result / "r.nc")]) == 0
    printed = capsys.readouterr().out
    for part in ("group layer", "group no layer", "frequency 3", "complex128", "[m/N]", "speed = 1.5"):
        assert part in printed
    assert "root group" not in printed


def test_show_as_json_parses(result, capsys):
    assert main(["show", str(result / "r.nc"), "--json"]) == 0
    groups = json.loads(capsys.readouterr().out)["groups"]
    assert list(groups) == ["layer", "no layer"]
    assert groups["layer"]["dims"] == {"frequency": 3, "output": 1}
    assert groups["layer"]["variables"]["response"]["units"] == "m/N"
    assert groups["layer"]["attrs"]["speed"] == 1.5
    assert main(["show", str(result / "one.nc"), "--json"]) == 0
    assert list(json.loads(capsys.readouterr().out)["groups"]) == [""]


def test_version_names_the_package(capsys):
    assert main(["version"]) == 0
    assert capsys.readouterr().out.startswith("bearingdyn ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fit", "missing.csv"], "missing.csv"),
        (["fit", __file__], "no column recognised"),
        (["fit", SAMPLE, "--n", "0"], "n = 0"),
        (["fit", SAMPLE, "--K", "nan"], "K = nan"),
        (["fit", SAMPLE, "--band", "100", "10"], "band"),
        (["fit", SAMPLE, "--f-max", "-1"], "--f-max is -1.0"),
        (["fit", SAMPLE, "--out", "nowhere/at/all.json"], "no folder"),
        (["show", "missing.nc"], "missing.nc: no such file"),
        (["show", __file__], "cannot be read as a result"),
        (["show", "."], "is a folder"),
    ],
)
def test_input_that_cannot_be_used_is_one_line_and_code_1(arguments, message, capsys):
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("bearingdyn: ")
    assert captured.err.count("\n") == 1
    assert message in captured.err


@pytest.mark.parametrize("arguments", [[], ["fit"], ["fit", SAMPLE, "--n", "many"], ["dance"], ["show"]])
def test_command_that_is_not_understood_is_code_2(arguments, capsys):
    assert main(arguments) == 2
    assert "usage" in capsys.readouterr().err


def test_help_is_code_0(capsys):
    assert main(["--help"]) == 0
    assert "fit" in capsys.readouterr().out


def test_warning_is_one_line_on_standard_error(capsys):
    """A reference temperature outside the measured ones: the law extrapolates, and says so."""
    assert main(["fit", SAMPLE, "--T-ref", "100", "--n", "2"]) == 0
    err = capsys.readouterr().err
    assert "bearingdyn: warning: " in err
    assert "extrapolates" in err
    assert str(Path(sys.modules["bearingdyn"].__file__).parent) not in err


def test_module_runs_as_a_program_and_survives_a_closed_pipe():
    command = [sys.executable, "-m", "bearingdyn.cli", "version"]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
