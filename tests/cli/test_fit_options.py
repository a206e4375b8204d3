"""Every option of `bearingdyn fit` does what the same argument of the library does."""

from __future__ import annotations

import json

import numpy as np
import pytest

from bearingdyn.cli import main
from bearingdyn.material import Maxwell, fit_maxwell, master_curve, read_dma, sample_dma_path

SAMPLE = str(sample_dma_path())


def command(capsys, *options: str) -> dict:
    assert main(["fit", SAMPLE, "--n", "2", "--json", *options]) == 0
    return json.loads(capsys.readouterr().out)


def rows_of_sample() -> list[list[str]]:
    return [line.split(",") for line in sample_dma_path().read_text().splitlines() if line[:1].isdigit()]


def by_isotherm() -> list[list[list[str]]]:
    """Its rows, an isotherm each, coldest first; the temperatures scatter by a tenth of a kelvin."""
    groups: dict[int, list] = {}
    for row in rows_of_sample():
        groups.setdefault(round(float(row[1])), []).append(row)
    return [groups[T] for T in sorted(groups)]


def table(path, rows, head="frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa") -> str:
    path.write_text("\n".join([head, *(",".join(row) for row in rows)]) + "\n")
    return str(path)


def library(select=None, law=None, master=None, **fit) -> Maxwell:
    dma = read_dma(SAMPLE)
    if select:
        dma = dma.select(**select)
    curve = master_curve(dma, **({"law": law} if law else {}), **(master or {}))
    return fit_maxwell(curve, **({"n": 2, "K": 2e9, "density": 1200.0} | fit))


OPTIONS = {
    "f_max": (["--f-max", "20"], {"select": {"f_max": 20.0}}),
    "T_ref": (["--T-ref", "0"], {"master": {"T_ref": 0.0}}),
    "law": (["--law", "arrhenius"], {"law": "arrhenius"}),
    "no_clean": (["--no-clean"], {"master": {"clean": False}}),
    "band": (["--band", "5", "500"], {"band": (5.0, 500.0)}),
    "n": (["--n", "4"], {"n": 4}),
    "K": (["--K", "1e9"], {"K": 1e9}),
    "density": (["--density", "900"], {"density": 900.0}),
}


@pytest.mark.parametrize("option", OPTIONS)
def test_an_option_is_the_argument_of_the_same_name(option, capsys):
    given, arguments = OPTIONS[option]
    wanted = library(**arguments)
    found = Maxwell.from_json(json.dumps(command(capsys, *given)["maxwell"]))
    # the same computation: to the bit
    assert (found.G0, found.K, found.density) == (wanted.G0, wanted.K, wanted.density)
    np.testing.assert_array_equal(found.G, wanted.G)
    np.testing.assert_array_equal(found.tau, wanted.tau)


def test_the_options_are_not_idle_on_the_sample(capsys):
    """Each changes the model, except --no-clean: no point of the sample looks like a resonance."""
    plain = library()
    for option, (_, arguments) in OPTIONS.items():
        changed = library(**arguments)
        same = changed == plain
        assert same == (option == "no_clean"), option


def test_f_max_keeps_a_resonance_out_of_the_fit(tmp_path, capsys):
    """The sample with what a fixture adds above 50 Hz: below --f-max 40 the model is the clean sample's."""
    rows = [line.split(",") for line in sample_dma_path().read_text().splitlines()]
    head = [row for row in rows if not row[0][:1].isdigit()]
    rows = [row for row in rows if row[0][:1].isdigit()]
    spoiled = tmp_path / "spoiled.csv"
    lines = [",".join(row) for row in head]
    for f, T, storage, loss in rows:
        factor = 1.0 if float(f) < 50.0 else 1.5
        lines.append(f"{f},{T},{float(storage) * factor!r},{float(loss) * factor!r}")
    spoiled.write_text("\n".join(lines) + "\n")
    models = []
    for path in (SAMPLE, str(spoiled)):
        assert main(["fit", path, "--n", "2", "--json", "--f-max", "40"]) == 0
        models.append(json.loads(capsys.readouterr().out)["maxwell"])
    # numbers written out and read again
    np.testing.assert_allclose(models[1]["G"], models[0]["G"], rtol=1e-9)


def fitted(capsys, *options: str) -> tuple[Maxwell, dict]:
    assert main(["fit", *options, "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    return Maxwell.from_json(json.dumps(record["maxwell"])), record


def same(found: Maxwell, wanted: Maxwell) -> None:
    """The same computation: to the bit."""
    assert (found.G0, found.eta0, found.temperature) == (wanted.G0, wanted.eta0, wanted.temperature)
    np.testing.assert_array_equal(found.G, wanted.G)
    np.testing.assert_array_equal(found.tau, wanted.tau)


DEFAULTS = {"K": 2e9, "density": 1200.0}


def test_a_single_sweep_is_fitted_as_it_is(tmp_path, capsys):
    """As `fit_maxwell(read_dma(file, temperature=20), n)`, without a shift law."""
    rows = [[f, a, b] for f, T, a, b in by_isotherm()[0]]
    path = table(tmp_path / "one.csv", rows, "frequency_Hz,G_storage_Pa,G_loss_Pa")
    found, record = fitted(capsys, path, "--n", "2", "--temperature", "20")
    same(found, fit_maxwell(read_dma(path, temperature=20.0), 2, **DEFAULTS))
    assert found.temperature == 20.0
    assert "master" not in record
    figure = tmp_path / "one.png"
    assert main(["fit", path, "--n", "2", "--temperature", "20", "--plot", str(figure)]) == 0
    printed = capsys.readouterr().out
    assert "single sweep" in printed
    assert "no shift law" in printed
    assert figure.stat().st_size > 0


@pytest.mark.parametrize("options", [("--law", "wlf"), ("--T-ref", "20"), ("--no-clean",)])
def test_what_shifts_isotherms_is_refused_for_a_single_sweep(options, tmp_path, capsys):
    path = table(tmp_path / "one.csv", by_isotherm()[0])
    assert main(["fit", path, *options]) == 2
    err = capsys.readouterr().err
    assert options[0] in err
    assert "single isotherm" in err


def test_one_isotherm_of_many_is_chosen(capsys):
    T = float(by_isotherm()[0][0][1])
    found, _ = fitted(capsys, SAMPLE, "--n", "2", "--isotherms", str(T - 1), str(T + 1))
    same(found, fit_maxwell(read_dma(SAMPLE).select(T=(T - 1, T + 1)), 2, **DEFAULTS))


def test_files_of_one_temperature_each_are_read_together(tmp_path, capsys):
    few = by_isotherm()[1:5]
    temperatures = [f"{float(rows[0][1]):.0f}" for rows in few]
    head = "frequency_Hz,G_storage_Pa,G_loss_Pa"
    paths = [
        table(tmp_path / f"part{k}.csv", [[f, a, b] for f, _, a, b in rows], head)
        for k, rows in enumerate(few)
    ]
    found, record = fitted(capsys, *paths, "--n", "2", "--temperature", *temperatures)
    dma = read_dma(paths, temperature=[float(T) for T in temperatures])
    same(found, fit_maxwell(master_curve(dma), 2, **DEFAULTS))
    assert record["data"] == paths


def test_a_run_is_chosen(tmp_path, capsys):
    rows = rows_of_sample()
    both = [[*row, "a"] for row in rows] + [[r[0], r[1], repr(2 * float(r[2])), r[3], "b"] for r in rows]
    head = "frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa,run"
    path = table(tmp_path / "runs.csv", both, head)
    found, _ = fitted(capsys, path, "--n", "2", "--run", "a")
    same(found, library())
    assert main(["fit", path, "--run", "c"]) == 2
    assert "['a', 'b']" in capsys.readouterr().err


def test_a_step_is_chosen_by_its_name_or_number(tmp_path, capsys):
    """Two sheets of one workbook, the second twice as stiff."""
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for k, name in enumerate(("first", "second")):
        sheet = book.active if k == 0 else book.create_sheet()
        sheet.title = name
        sheet.append(["frequency_Hz", "temperature_C", "G_storage_Pa", "G_loss_Pa"])
        for row in rows_of_sample():
            f, T, a, b = map(float, row)
            sheet.append([f, T, (k + 1) * a, (k + 1) * b])
    path = tmp_path / "two.xlsx"
    book.save(path)
    first, _ = fitted(capsys, str(path), "--n", "2", "--step", "first")
    second, _ = fitted(capsys, str(path), "--n", "2", "--step", "second")
    same(first, library())
    # all moduli doubled: the same relaxation, round-off through the fit's tolerances
    assert second.G0 == pytest.approx(2 * first.G0, rel=1e-6)


def test_unsorted_and_invalid_rows_are_taken_care_of_where_asked(tmp_path, capsys):
    rows = rows_of_sample()
    path = table(tmp_path / "mixed.csv", [*rows[1:], rows[0]])
    assert main(["fit", path, "--n", "2"]) == 2
    assert "--sort" in capsys.readouterr().err
    found, _ = fitted(capsys, path, "--n", "2", "--sort")
    same(found, library())
    bad = table(tmp_path / "bad.csv", [*rows, ["0", rows[-1][1], "1e6", "1e5"]])
    assert main(["fit", bad, "--n", "2"]) == 2
    capsys.readouterr()
    found, _ = fitted(capsys, bad, "--n", "2", "--drop-invalid")
    same(found, library())


def test_a_relaxation_is_fitted_in_time(tmp_path, capsys):
    """G(t) = 1 MPa + 1 MPa e^(-t): found back, and the JSON has no NaN for the loss that was not measured."""
    times = np.geomspace(1e-2, 1e2, 60)
    rows = [[repr(float(t)), repr(float(1e6 + 1e6 * np.exp(-t)))] for t in times]
    path = table(tmp_path / "relaxation.csv", rows, "time_s,relaxation_modulus_G_Pa")
    found, record = fitted(capsys, path, "--n", "1", "--temperature", "23", "--mode", "shear")
    same(found, fit_maxwell(read_dma(path, "shear", temperature=23.0), 1, **DEFAULTS))
    # exact numbers: what the search's tolerance leaves
    np.testing.assert_allclose([found.G0, found.G[0], found.tau[0]], [1e6, 1e6, 1.0], rtol=1e-6)
    assert record["fit"]["tan_delta_rms"] is None
    assert main(["fit", path, "--n", "1", "--temperature", "23", "--mode", "shear"]) == 0
    printed = capsys.readouterr().out
    assert "relaxation modulus" in printed
    assert "from 0.01 to 100 s" in printed
    assert printed.isascii()
