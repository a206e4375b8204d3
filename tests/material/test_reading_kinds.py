"""Files as laboratories have them: relaxation, a file per temperature, steps, runs, German, cut ends."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from bearingdyn.material import DMAData, Maxwell, RelaxationData, fit_maxwell, master_curve, read_dma
from bearingdyn.material.reading import ReadingError
from bearingdyn.notice import CutFile, MixedRuns, UnlikelyModulus
from measured import DATA, measured, written

RUBBER = Maxwell(1e6, [5e6, 2e7], [1e-2, 5e-4], K=2e9, density=1100.0)
F = np.geomspace(0.1, 100.0, 13)


def modulus(f):
    """G* of RUBBER at f, Hz."""
    return RUBBER.complex_modulus(2 * np.pi * np.asarray(f))


def sweep(head, temperature=None, f=F):
    """A table of RUBBER's moduli in MPa."""
    T = "" if temperature is None else f"{temperature},"
    return f"{head}\n" + "".join(
        f"{float(a)!r},{T}{g.real / 1e6},{g.imag / 1e6}\n" for a, g in zip(f, modulus(f), strict=True)
    )


# ---------------------------------------------------------------- one sweep, a finished curve


NAMED = "Reduced frequency (Hz),Storage modulus G' [MPa],Loss modulus G'' [MPa]"
TAN = "".join(f"{a};{g.real / 1e6};{g.imag / g.real}\n" for a, g in zip(F, modulus(F), strict=True))


@pytest.mark.parametrize(
    ("text", "mode"),
    [
        (sweep("f [Hz],G' [MPa],G'' [MPa]"), None),
        ("# reference temperature: 20 °C\n" + sweep(NAMED), None),
        ("Frequency (Hz);E' (MPa);tan(δ)\n" + TAN, "shear"),
    ],
    ids=["plain", "finished curve, its temperature above", "modulus and loss factor"],
)
def test_a_supplier_s_curve_is_fitted_as_it_was_read(tmp_path, text, mode):
    """No superposition: 1e-3 is four times what the digits and the optimiser leave; no law, so no other T."""
    path = written(tmp_path, text.replace("E'", "G'") if mode else text)
    given = None if "reference" in text else 20.0
    found = fit_maxwell(read_dma(path, mode, temperature=given), n=2, K=2e9, density=1100.0)
    f = np.geomspace(0.1, 100.0, 30)
    np.testing.assert_allclose(found.complex_modulus(2 * np.pi * f), modulus(f), rtol=1e-3)
    assert (found.temperature, found.law) == (20.0, None)
    with pytest.raises(ValueError, match="only by a shift law"):
        found.at(30.0)


def test_several_isotherms_are_not_taken_for_one(tmp_path):
    """fit_maxwell says what to do with two isotherms, and refuses what is no measurement."""
    path = written(tmp_path, sweep("f_Hz,T_C,G'_MPa,G''_MPa", 20) + sweep("", 30).lstrip())
    with pytest.raises(ValueError, match=r"2 isotherms, 20 to 30 °C; shift them first, master_curve"):
        fit_maxwell(read_dma(path), n=2, K=2e9, density=1100.0)
    with pytest.raises(ValueError, match="master is 5; it must be"):
        fit_maxwell(5, n=2, K=2e9, density=1100.0)


# ---------------------------------------------------------------- relaxation

T_RELAX = np.geomspace(1e-3, 1e3, 40)
SLOW = Maxwell(1e6, [2e6, 3e6], [1e-1, 1e1], K=2e9, density=1100.0)


@pytest.mark.parametrize(
    "head",
    [
        "t,G_relax,T\ns,MPa,°C",
        "Time (s),G(t) [MPa],Temperature [°C]",
        "time_s,shear relaxation modulus (MPa),T_C",
        "Zeit [s],Relaxationsmodul G [MPa],Temperatur [°C]",
    ],
)
def test_relaxation_is_read_and_fitted_in_time(tmp_path, head):
    """The five numbers of the model it was made of, to the optimiser's tolerance, and G(t) among the data."""
    rows = "".join(
        f"{t!r},{g / 1e6!r},20\n"
        for t, g in zip(T_RELAX.tolist(), SLOW.relaxation(T_RELAX).tolist(), strict=True)
    )
    data = read_dma(written(tmp_path, f"{head}\n{rows}"), "shear")
    assert isinstance(data, RelaxationData)
    np.testing.assert_allclose(np.sort(data.time), T_RELAX, rtol=1e-12)
    found = fit_maxwell(data, n=2, K=2e9, density=1100.0)
    numbers = [found.G0, *found.G, *found.tau]
    np.testing.assert_allclose(numbers, [1e6, 2e6, 3e6, 1e-1, 1e1], rtol=1e-6)
    assert found.fit.storage_rms < 1e-6
    assert math.isnan(found.fit.tan_delta_rms)  # no loss was measured
    assert fit_maxwell(data, "auto", K=2e9, density=1100.0).tau.size <= 2


def test_relaxation_with_noise_keeps_its_level():
    """1 % of noise on 40 points, five unknowns: G(t) is known to some 0.4 %, worse at the ends."""
    rng = np.random.default_rng(3)
    G = SLOW.relaxation(T_RELAX) * (1 + 0.01 * rng.standard_normal(T_RELAX.size))
    data = RelaxationData.of(T_RELAX, G, 20.0, "shear")
    found = fit_maxwell(data, n=2, K=2e9, density=1100.0)
    np.testing.assert_allclose(found.relaxation(T_RELAX), SLOW.relaxation(T_RELAX), rtol=0.01)
    assert 0.006 < found.fit.storage_rms < 0.013  # the noise itself
    pinned = fit_maxwell(data, n=2, K=2e9, density=1100.0, fixed={"G0": 1e6})
    assert pinned.G0 == 1e6
    for wrong in ({"fixed": {"tau1": 1.0}}, {"bounds": {"G0": (0, 1)}}, {"bootstrap": 5}, {"n": 40}):
        with pytest.raises(ValueError, match=r"fixed|bounds|bootstrap|branches"):
            fit_maxwell(data, **({"n": 2, "K": 2e9, "density": 1100.0} | wrong))


def test_relaxation_in_tension_is_brought_to_shear():
    """E = 9KG/(3K + G), time by time."""
    G = SLOW.relaxation(T_RELAX)
    data = RelaxationData.of(T_RELAX, 9 * 2e9 * G / (3 * 2e9 + G), 20.0, "tension")
    found = fit_maxwell(data, n=2, K=2e9, density=1100.0)
    np.testing.assert_allclose(found.G, [2e6, 3e6], rtol=1e-6)


def test_relaxation_at_temperatures_superposes():
    """Converted to sweeps: shifts of one decade per 10 K found to 0.1, as the ends of each are uncertain."""
    T = np.repeat([10.0, 20.0, 30.0], 40)
    t = np.tile(np.geomspace(1e-2, 1e2, 40), 3)
    broad = Maxwell(1e6, [1e6] * 9, np.geomspace(1e-5, 1e5, 9), K=2e9, density=1100.0)
    G = broad.relaxation(t * 10 ** ((T - 20) / 10))
    data = RelaxationData.of(t, G, T, "shear")
    with pytest.raises(ValueError, match="relaxation at 3 temperatures"):
        fit_maxwell(data, n=2, K=2e9, density=1100.0)
    curve = master_curve(data, law="free")
    np.testing.assert_allclose(list(curve.shifts.values()), [1, 0, -1], atol=0.1)


def test_bad_relaxation_is_refused(tmp_path):
    """The moment of the step is left out; what cannot be is named."""
    good = "t_s,G_relax_Pa,T_C\n0,9e6,20\n1,5e6,20\n2,4e6,20\n4,3e6,20\n"
    with pytest.warns(UserWarning, match=r"1 of 4 points left out: .*the moment of the step itself"):
        assert read_dma(written(tmp_path, good)).time.size == 3
    with pytest.raises(
        ReadingError, match=r"line 4, column 'G_relax_Pa': -4e6 for the relaxation: must be positive"
    ):
        read_dma(
            written(
                tmp_path,
                good.replace("4e6", "-4e6").replace("0,9e6,20\n", "0.5,9e6,20\n").replace("1,5e6", "1,5e6"),
            )
        )
    for change, message in (
        ({"time": [1.0, -2.0]}, "at time -2 s"),
        ({"time": [1e-300, 2.0]}, "no relaxation is measured over more"),
        ({"relaxation": [1e6, 0.0]}, "relaxation modulus is 0 Pa"),
    ):
        values = {"time": [1.0, 2.0], "relaxation": [2e6, 1e6], "temperature": 20.0, "mode": "shear"} | change
        with pytest.raises(ValueError, match=message):
            RelaxationData.of(**values)


# ---------------------------------------------------------------- several files


def files(folder, names, head="f_Hz,G'_MPa,G''_MPa"):
    """A sweep in a file of each name."""
    paths = []
    for name in names:
        paths.append(folder / name)
        paths[-1].write_text(sweep(head), encoding="utf-8")
    return paths


def test_a_file_per_temperature(tmp_path):
    """By names, by a list of temperatures, by a line above the table: the same three isotherms."""
    paths = files(tmp_path, ["rubber_m10C.csv", "rubber_25C.csv", "T=40.csv"])
    with pytest.warns(UserWarning, match="-10 °C is taken from the file's name"):
        by_name = read_dma(paths)
    by_hand = read_dma([str(p) for p in paths], temperature=[-10.0, 25.0, 40.0])
    for dma in (by_name, by_hand):
        assert dma.isotherm_temperatures.tolist() == [-10.0, 25.0, 40.0]
        assert dma.frequency.size == 3 * F.size
        assert "and 2 more" in dma.source
    for path, T in zip(paths, (-10, 25, 40), strict=True):
        path.write_text(f"Prüftemperatur: {T} °C\n" + path.read_text(encoding="utf-8"), encoding="utf-8")
    assert read_dma(paths).isotherm_temperatures.tolist() == [-10.0, 25.0, 40.0]


def test_files_that_cannot_be_put_together_are_refused(tmp_path):
    """One temperature for three files, too few, a sign that may be a hyphen, shear and tension, one twice."""
    paths = files(tmp_path, ["a-10C.csv", "b-20C.csv"])
    with pytest.raises(ReadingError, match="give a list of 2 of them"):
        read_dma(paths, temperature=20.0)
    with pytest.raises(ValueError, match="as many as files, 2"):
        read_dma(paths, temperature=[20.0])
    with pytest.raises(ReadingError, match=r"a-10C.csv, line 1: no column recognised as temperature"):
        read_dma(paths)
    with pytest.raises(ValueError, match="the file is named twice"):
        read_dma([paths[0], paths[0]])
    other = files(tmp_path, ["c.csv"], "f_Hz,E'_MPa,E''_MPa")
    with pytest.raises(ValueError, match="all files must be of the kind of"):
        read_dma([*paths, *other], temperature=[1.0, 10.0, 20.0])
    with pytest.raises(FileNotFoundError, match=r"none\.csv"):
        read_dma([paths[0], tmp_path / "none.csv"], temperature=[1.0, 2.0])


# ---------------------------------------------------------------- runs


def test_runs_are_labels_that_can_be_selected():
    """The measured rubber is two runs; mixing them unasked warns, choosing or naming both does not."""
    dma = measured("epdm70")
    assert dma.runs == ("tf_015p", "tf_015p_high")
    assert dma.select(run="tf_015p").isotherm_temperatures.max() == pytest.approx(18.4, abs=0.1)
    with pytest.warns(
        MixedRuns, match=r"2 runs in one curve, 'tf_015p' \(-10.02 to 18.42 °C\), 'tf_015p_high'"
    ):
        master_curve(dma)
    with pytest.raises(ValueError, match="run is 'x'; there are"):
        dma.select(run="x")
    with pytest.raises(ValueError, match="no column of the table names runs"):
        DMAData(F, 20 + 0 * F, modulus(F).real, modulus(F).imag, "shear").select(run="x")


@pytest.mark.filterwarnings("error::bearingdyn.notice.MixedRuns")
@pytest.mark.parametrize("run", ["tf_015p", ["tf_015p", "tf_015p_high"]])
def test_chosen_runs_do_not_warn(run):
    """One run, or both by name."""
    master_curve(measured("epdm70").select(run=run, f_max=20.0))


def test_two_runs_at_one_temperature_stay_two_isotherms(tmp_path):
    """Their frequencies do not run back, and each can be fitted alone."""
    one = sweep("specimen,f_Hz,T_C,G'_MPa,G''_MPa", 20)
    head, *rows = one.splitlines()
    text = "\n".join([head, *(f"A,{row}" for row in rows), *(f"B,{row}" for row in rows)])
    dma = read_dma(written(tmp_path, text))
    assert (dma.runs, len(dma.isotherms)) == (("A", "B"), 2)
    found = fit_maxwell(dma.select(run="B"), n=2, K=2e9, density=1100.0)
    np.testing.assert_allclose(found.complex_modulus(2 * np.pi * F), modulus(F), rtol=1e-3)
    with pytest.raises(ValueError, match="one isotherm only, at 20 °C"):  # of both: nothing to shift
        master_curve(dma)


# ---------------------------------------------------------------- steps


def trios(*steps):
    """A text export: name of the step, frequencies, strains."""
    head = "Frequency\tTemperature\tStrain\tStorage modulus\tLoss modulus\nHz\t°C\t%\tMPa\tMPa\n"
    parts = []
    for name, f, strain in steps:
        g = modulus(f)
        rows = (
            f"{a}\t20\t{s}\t{b.real / 1e6}\t{b.imag / 1e6}\n" for a, s, b in zip(f, strain, g, strict=True)
        )
        parts.append(f"[step]\n{name}\n{head}{''.join(rows)}")
    return "".join(parts)


AMPLITUDE = ("Amplitude sweep - 1", np.full(5, 10.0), np.geomspace(0.01, 10, 5))
FREQUENCY = ("Frequency sweep - 2", F, np.full(F.size, 0.1))


@pytest.mark.parametrize("sort", [False, True])
def test_an_amplitude_sweep_is_not_merged(tmp_path, sort):
    """Refused with the names of the steps, sorted or not; the step named is read alone."""
    path = written(tmp_path, trios(AMPLITUDE, FREQUENCY))
    with pytest.raises(
        ReadingError, match=r"3 points in a row at 10 Hz.*1 'Amplitude sweep - 1', 2 'Frequency"
    ) as error:
        read_dma(path, "shear", sort=sort)
    assert error.value.arguments == ("step",)
    for step in ("frequency", 2, ["Frequency sweep - 2"]):
        np.testing.assert_allclose(read_dma(path, "shear", sort=sort, step=step).frequency, F, rtol=1e-12)
    with pytest.raises(ReadingError, match="step is 'creep'; there are 1 'Amplitude"):
        read_dma(path, "shear", step="creep")


def test_sorting_merges_neither_steps_nor_amplitudes(tmp_path):
    """Two sweeps at 20 °C in two steps; one table whose strain changes between repeated frequencies."""
    path = written(tmp_path, trios(("Sweep a", F, 0.1 + 0 * F), ("Sweep b", F, 0.1 + 0 * F)))
    with pytest.raises(
        ReadingError, match="in steps 'Sweep a' and 'Sweep b': sort=True does not merge steps"
    ):
        read_dma(path, "shear", sort=True)
    path = written(tmp_path, trios(("both", np.tile(F, 2), np.repeat([0.1, 1.0], F.size))))
    with pytest.raises(ReadingError, match=r"at strains 0.1 and 1: an amplitude sweep"):
        read_dma(path, "shear", sort=True)


def test_an_amplitude_sweep_in_a_plain_table_is_refused(tmp_path):
    """The published strain sweep at 10 Hz, and the same in a table of our own."""
    path = DATA / "epdm70" / "strain_sweep_10hz.csv"
    if path.exists():
        with pytest.raises(ValueError, match="in a row at 10"):
            read_dma(path, "shear", sort=True, temperature=22.0)
    with pytest.raises(
        ReadingError, match=r"line 2 to 4: 3 points in a row at 10 Hz and 20 °C.*leave it out"
    ):
        read_dma(written(tmp_path, sweep("f_Hz,T_C,G'_MPa,G''_MPa", 20, np.full(4, 10.0))))


# ---------------------------------------------------------------- headers


def test_two_columns_of_one_name_are_told_apart_by_number(tmp_path):
    """In a file and in a frame; the message names the numbers."""
    rows = "".join(
        f"{a!r},{g.real / 1e6},{g.real * 2},{g.imag / 1e6}\n"
        for a, g in zip(F.tolist(), modulus(F), strict=True)
    )
    path = written(tmp_path, "f [Hz],G' [MPa],G' [MPa],G'' [MPa]\n" + rows)
    with pytest.raises(ReadingError, match=r"columns=\{'storage': 2 or 3, its number\}"):
        read_dma(path, temperature=20.0)
    dma = read_dma(path, temperature=20.0, columns={"storage": 2})
    np.testing.assert_allclose(dma.storage, modulus(F).real, rtol=1e-9)
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame([[float(v) for v in row.split(",")] for row in rows.split()])
    frame.columns = ["f_Hz", "G'_MPa", "G'_MPa", "G''_MPa"]
    np.testing.assert_allclose(read_dma(frame, temperature=20.0, columns={"storage": 2}).storage, dma.storage)
    with pytest.raises(ValueError, match=r"columns\['storage'\] is 0; it must be a title, or the number"):
        read_dma(path, temperature=20.0, columns={"storage": 0})


@pytest.mark.parametrize(
    "head",
    [
        "Frequenz;Temperatur;Speichermodul G';Verlustmodul G''\nHz;°C;MPa;MPa",
        "Frequenz [Hz];Probentemperatur [°C];Schubspeichermodul [MPa];Schubverlustmodul [MPa]",
        "Messfrequenz in Hz;Temperatur in °C;G' in MPa;G'' in MPa",
        "Prüffrequenz / Hz;Prüftemperatur / °C;Speicher-Modul (G') / MPa;Verlust-Modul (G'') / MPa",
    ],
)
def test_german_tables(tmp_path, head):
    """Latin-1, CRLF, semicolons, decimal commas: the four columns, in SI."""
    g = modulus(F)
    rows = "".join(
        f"{a!r};{T};{b.real / 1e6};{b.imag / 1e6}\n"
        for T in (20, 30)
        for a, b in zip(F.tolist(), g, strict=True)
    )
    text = f"{head}\n{rows.replace('.', ',')}".replace("\n", "\r\n")
    dma = read_dma(written(tmp_path, text, "latin-1"))
    assert (dma.mode, dma.isotherm_temperatures.tolist()) == ("shear", [20.0, 30.0])
    np.testing.assert_allclose(dma.storage[: F.size], g.real, rtol=1e-12)
    np.testing.assert_allclose(dma.loss[: F.size], g.imag, rtol=1e-12)


def test_german_words_and_thousands(tmp_path):
    """Loss factor, circular frequency and grouped thousands: 1.234,5 is 1234.5, as 1,234.5 is."""
    head = "Kreisfrequenz [rad/s];Temperatur [°C];Speichermodul E' [kPa];Verlustfaktor tan δ"
    text = f"{head}\n6,283185307179586;20;1.234,5;0,25\n"
    dma = read_dma(written(tmp_path, text))
    np.testing.assert_allclose(
        [dma.frequency[0], dma.storage[0], dma.loss[0]], [1.0, 1234.5e3, 0.25 * 1234.5e3]
    )
    text = 'f_Hz,T_C,G\'_kPa,"G"" [kPa]"\n1,20,"1,234.5","2,345.25"\n'
    np.testing.assert_allclose(read_dma(written(tmp_path, text)).loss, [2345.25e3])


# ---------------------------------------------------------------- encodings


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_marks_and_wide_characters(tmp_path, encoding):
    """With and without a mark of the order of bytes."""
    dma = read_dma(written(tmp_path, sweep("f_Hz,T_C,G'_MPa,G''_MPa", 20), encoding))
    np.testing.assert_allclose(dma.storage, modulus(F).real, rtol=1e-9)


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_a_file_cut_inside_a_character_loses_its_last_line(tmp_path, encoding):
    """What is left of the last number is no number: it is left out with a warning that says where."""
    mark = {"utf-16-le": b"\xff\xfe", "utf-16-be": b"\xfe\xff"}[encoding]
    path = tmp_path / "cut.csv"
    path.write_bytes(mark + sweep("f_Hz,T_C,G'_MPa,G''_MPa", 20).encode(encoding)[:-5])
    with pytest.warns(CutFile, match=r"cut.csv, line 14: the file ends inside a character"):
        dma = read_dma(path)
    np.testing.assert_allclose(dma.frequency, F[:-1], rtol=1e-12)


def test_what_is_no_file_or_too_large_is_refused(tmp_path):
    """A folder, and a file larger than any table, before it is read."""
    with pytest.raises(IsADirectoryError, match="is a folder; give the path of a table"):
        read_dma(tmp_path)
    path = tmp_path / "large.csv"
    with path.open("wb") as file:
        file.truncate(40 << 20)
    with pytest.raises(ValueError, match="larger than 32 MB"):
        read_dma(path)


def test_a_relaxation_modulus_that_rises_is_no_relaxation(tmp_path):
    """A creep compliance, or columns mixed: of a passive material G(t) falls."""
    t = np.geomspace(1.0, 100.0, 5)
    with pytest.raises(ValueError, match=r"rises from 2e\+06 Pa at 1 s to 4e\+06 Pa at 100 s; it must fall"):
        RelaxationData.of(t, np.linspace(2e6, 4e6, 5), 20.0, "shear")
    with pytest.warns(UnlikelyModulus, match="rises from 2e.06 Pa"):
        RelaxationData.of(t, [2.1e6, 2e6, 2e6, 2.3e6, 1.9e6], 20.0, "shear")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        RelaxationData.of(t[::-1], np.linspace(2e6, 4e6, 5), 20.0, "shear")
        # each isotherm by itself
        RelaxationData.of(np.r_[t, t], np.r_[[1e6] * 5, [3e6] * 5], [60.0] * 5 + [20.0] * 5, "shear")


def test_a_line_of_a_million_columns_is_no_table(tmp_path: Path) -> None:
    """Its titles were looked through for 13 s."""
    path = tmp_path / "r.csv"
    path.write_text("a," * 1_000_000 + "\n1,2\n")
    with pytest.raises(ValueError, match=r"r\.csv, line 1: 2000000 characters: no table of sweeps has such"):
        read_dma(path)
