"""The command line: exit codes, JSON that parses, one line for an error."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from bearingdyn import check, demo, results
from bearingdyn.cli import main
from bearingdyn.material import Maxwell, sample_dma_path
from bearingdyn.notice import BeyondData

SAMPLE = str(sample_dma_path())


def test_fit_prints_the_model_and_writes_it(tmp_path, capsys):
    out = tmp_path / "maxwell.json"
    assert main(["fit", SAMPLE, "--n", "3", "--band", "10", "5000", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    model = Maxwell.from_json(out.read_text())
    assert model.G.size <= 3
    for name in ("G0", "G1", "tau1", "eta0", "tan delta", "(assumed)", str(out)):
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


def test_fit_takes_units_and_columns_the_header_does_not_name(tmp_path, capsys):
    """The sample in kPa under titles of one's own: the same model, and what to give if it is not given."""
    rows = [line.split(",") for line in Path(SAMPLE).read_text().splitlines() if line[:1].isdigit()]
    own = tmp_path / "own.csv"
    lines = [f"{f},{T},{float(a) / 1e3!r},{float(b) / 1e3!r}" for f, T, a, b in rows]
    own.write_text("\n".join(["frequency,temperature,stiff,lossy", *lines]) + "\n")
    assert main(["fit", str(own), "--n", "2"]) == 2
    err = capsys.readouterr().err
    assert "recognised as storage, loss" in err
    assert "--columns storage=TITLE" in err
    options = ["--columns", "storage=stiff", "loss=lossy", "--mode", "shear", "--json", "--n", "2"]
    assert main(["fit", str(own), *options]) == 2
    err = capsys.readouterr().err
    assert "'stiff': no unit" in err
    assert "'lossy': no unit" in err
    assert "--units storage=MPa" in err
    assert main(["fit", str(own), *options, "--units", "storage=kPa", "loss=kPa"]) == 0
    captured = capsys.readouterr()
    assert "taken as °C" in captured.err
    found = json.loads(captured.out)["maxwell"]
    assert main(["fit", SAMPLE, "--n", "2", "--json"]) == 0
    # numbers divided and multiplied by 1e3: round-off, through the fit's tolerances
    wanted = json.loads(capsys.readouterr().out)["maxwell"]
    np.testing.assert_allclose(found["G"], wanted["G"], rtol=1e-6)


def test_fit_draws_the_master_curve(tmp_path, capsys):
    pytest.importorskip("matplotlib")
    figure = tmp_path / "master.png"
    assert main(["fit", SAMPLE, "--n", "2", "--plot", str(figure)]) == 0
    assert figure.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
    assert f"written to {figure}" in capsys.readouterr().out


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


def test_long_attributes_are_cut_in_the_listing_and_whole_in_json(tmp_path, capsys):
    data = results.dataset({"x": ("n", [1.0], "m", "x")}, {"inputs": "q" * 5000})
    results.save(data, tmp_path / "r.nc")
    assert main(["show", str(tmp_path / "r.nc")]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) < 200
    assert main(["show", str(tmp_path / "r.nc"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["groups"][""]["attrs"]["inputs"] == "q" * 5000


def test_version_names_the_package(capsys):
    assert main(["version"]) == 0
    assert capsys.readouterr().out.startswith("bearingdyn ")
    assert main(["version", "--json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == {"bearingdyn", "Python", "NumPy", "SciPy"}


def test_check_holds_and_prints_source_expected_computed_error_and_tolerance(capsys):
    assert main(["check"]) == 0
    captured = capsys.readouterr()
    assert "all hold" in captured.out
    for part in ("Harris", "ISO/TS 16281", "Friswell", "closed form", "expected", "1.4556"):
        assert part in captured.out
    assert "check 7 of 7" in captured.err


def test_check_that_does_not_hold_is_code_1(monkeypatch, capsys):
    """A published value, changed by a hundredth; and a family that raises."""

    def wrong():
        yield check.Check("ball pass", "a book", 1.01 * 107.36, 107.36, 1e-3)

    def broken():
        raise ArithmeticError("no balance")
        yield

    monkeypatch.setattr(check, "FAMILIES", (check.catalogue, wrong, broken))
    assert main(["check"]) == 1
    printed = capsys.readouterr().out
    assert printed.count("DOES NOT HOLD") == 2
    assert "ArithmeticError: no balance" in printed
    assert main(["check", "--json"]) == 1
    record = json.loads(capsys.readouterr().out)
    assert [row["holds"] for row in record["rows"]] == [True, True, False, False]
    assert not record["holds"]
    assert record["rows"][3]["computed"] is None


def test_demo_shows_a_quieter_housing_on_a_softer_support(tmp_path, capsys):
    with warnings.catch_warnings():
        warnings.simplefilter("error", BeyondData)
        assert main(["demo", "--out", str(tmp_path / "d"), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    bare, layered = found["no layer"], found["layer"]
    assert layered["receptance_20_Hz"] > bare["receptance_20_Hz"]
    assert layered["shaft_peak"] < bare["shaft_peak"]
    # 23 dB; a factor of two in either would leave the bracket
    assert 0.05 < layered["housing_rms_1_to_5_kHz"] / bare["housing_rms_1_to_5_kHz"] < 0.1
    assert {path.name for path in (tmp_path / "d").iterdir()} == {"result.nc", "response.png"}
    for label in ("no layer", "layer"):
        printed_is_what_was_saved(found[label], tmp_path / "d" / "result.nc", label)
    assert main(["show", str(tmp_path / "d" / "result.nc")]) == 0
    assert "group transient layer" in capsys.readouterr().out


def printed_is_what_was_saved(printed, path, label):
    """Every number of the demo, from the response and the record in its file by definition."""
    response = results.open_result(path, f"response {label}")["response"]
    shaft, housing = (np.abs(response.sel(output=name).values[:, 0]) for name in (demo.FORCE, demo.HOUSING))
    f = response.frequency.values
    velocity = results.open_result(path, f"transient {label}")["record"].sel(
        channel=f"{demo.HOUSING}.velocity"
    )
    # about its mean: a vibration
    swing = velocity.values - velocity.values.mean()
    high = housing[f >= 1e3]
    assert f[-1] == 5e3
    # sums in another order
    assert printed == pytest.approx(
        {
            "receptance_20_Hz": shaft[0],
            "shaft_peak": shaft.max(),
            "shaft_peak_frequency": f[shaft == shaft.max()][0],
            "housing_rms_1_to_5_kHz": math.sqrt(sum(high**2) / high.size),
            "housing_velocity_rms": math.sqrt(sum(swing**2) / swing.size),
        },
        rel=1e-9,
    )


def test_demo_prints_its_progress_on_standard_error(tmp_path, monkeypatch, capsys):
    numbers = dict.fromkeys(
        ("receptance_20_Hz", "shaft_peak", "housing_rms_1_to_5_kHz", "housing_velocity_rms"), 2.0
    )

    def quick(folder, tell):
        tell("working")
        return {"no layer": numbers, "layer": {k: 1.0 for k in numbers}, "files": ["a.nc"]}

    monkeypatch.setattr(demo, "demo", quick)
    assert main(["demo", "--out", str(tmp_path)]) == 0
    captured = capsys.readouterr()
    assert captured.err == "bearingdyn: working\n"
    assert captured.out.count("-6.0 dB") == 3
    assert "x 0.50" in captured.out


def test_missing_package_is_named(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "h5netcdf", None)
    assert main(["show", __file__]) == 2
    assert "pip install h5netcdf" in capsys.readouterr().err


def test_interrupt_is_code_130(monkeypatch, capsys):
    def interrupted(progress):
        raise KeyboardInterrupt

    monkeypatch.setattr(check, "check", interrupted)
    assert main(["check"]) == 130
    assert capsys.readouterr().err == "bearingdyn: interrupted\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fit", "missing.csv"], "missing.csv: no such file"),
        (["fit", SAMPLE, "--K", "2000"], "a rubber's bulk modulus is near 2e9 Pa"),
        (["fit", SAMPLE, "--T-ref", "293"], "is it in kelvin"),
        (["fit", SAMPLE, "--plot", "nowhere/at/all.png"], "--plot nowhere"),
        (["fit", SAMPLE, "--units", "kPa"], "--units 'kPa': must be quantity=value"),
        (["fit", SAMPLE, "--units", "stiffness=kPa"], "unknown quantities ['stiffness']"),
        (["fit", __file__], "no column recognised"),
        (["fit", SAMPLE, "--n", "0"], "n is 0"),
        (["fit", SAMPLE, "--K", "nan"], "K is nan"),
        (["fit", SAMPLE, "--band", "100", "10"], "band"),
        (["fit", SAMPLE, "--f-max", "-1"], "--f-max is -1.0"),
        (["fit", SAMPLE, "--out", "nowhere/at/all.json"], "no folder"),
        (["show", "missing.nc"], "missing.nc: no such file"),
        (["show", __file__], "cannot be read as a result"),
        (["show", "."], "is a folder"),
        (["demo", "--out", __file__], "exists"),
    ],
)
def test_input_that_cannot_be_used_is_one_line_and_code_2(arguments, message, capsys):
    assert main(arguments) == 2
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
    printed = capsys.readouterr().out
    for command in ("fit", "show", "check", "demo", "version", "Exit codes"):
        assert command in printed
    for command in ("fit", "show", "check", "demo", "version"):
        assert main([command, "--help"]) == 0
        assert "--json" in capsys.readouterr().out


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
