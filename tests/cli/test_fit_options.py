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
