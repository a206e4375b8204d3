"""Readers of instruments' exports, frames and arrays; what is assumed is said; broken files say where."""

from __future__ import annotations

import builtins
import contextlib
import math
import warnings
import zipfile

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bearingdyn.material import read_dma
from bearingdyn.material.reading import HeaderError, ReadingError
from bearingdyn.notice import AssumedMeaning, LeftOut, UnlikelyModulus
from measured import DATA, written

FORMATS = DATA / "formats"
ROWS = [(1.0, 20.0, 5e6, 1e6), (10.0, 20.0, 6e6, 1.5e6), (1.0, 40.0, 4e6, 0.7e6), (10.0, 40.0, 4.5e6, 9e5)]
F, T, STORAGE, LOSS = np.array(ROWS).T


def export(name):
    """An instrument's export, or a skip."""
    if not (FORMATS / name).exists():
        pytest.skip(f"{FORMATS / name} is not here")
    return FORMATS / name


def same_points(dma):
    """The four points of ROWS."""
    for values, column in zip((dma.frequency, dma.temperature, dma.storage, dma.loss), (F, T, STORAGE, LOSS)):  # noqa: B905
        np.testing.assert_allclose(values, column, rtol=1e-12)  # a few decimal conversions


def test_eplexor_spreadsheet():
    """First and last row as the sheet shows them; 21 temperatures of 10 frequencies."""
    pytest.importorskip("xlrd")
    dma = read_dma(export("eplexor.xls"))
    assert (dma.mode, dma.frequency.size, len(dma.isotherms)) == ("tension", 210, 21)
    assert dma.storage[0] == pytest.approx(4956.183187381401e6, rel=1e-15)
    assert (dma.frequency[-1], dma.temperature[-1]) == (100.0, 99.939)
    assert dma.loss[-1] == pytest.approx(52.88909105007834e6, rel=1e-15)


def test_spreadsheet_without_its_package_names_the_extra(monkeypatch):
    """xlrd is an extra: without it a ValueError that says what to install."""
    path = export("eplexor.xls")
    original = builtins.__import__

    def missing(name, *rest, **kw):
        if name == "xlrd":
            raise ImportError("no xlrd", name="xlrd")
        return original(name, *rest, **kw)

    monkeypatch.setattr(builtins, "__import__", missing)
    with pytest.raises(ValueError, match=r"eplexor.xls, line 1: .*xlrd is not installed.*bearingdyn\[xls\]"):
        read_dma(path)


def test_text_sweep_in_latin_1_ends_where_its_table_ends():
    """60 rows in N/µm columns; what stands below is counted and shown."""
    with pytest.warns(LeftOut, match=r"line 63: 1 lines after the table left out"):
        dma = read_dma(export("frequency_sweep_T0.txt"))
    assert (dma.mode, dma.frequency.size, len(dma.isotherms)) == ("tension", 60, 1)
    assert (dma.temperature[0], dma.storage[0], dma.loss[0]) == (-0.59132, 2.93911e9, 5.45177e7)


def test_rheocompass():
    """Label in front of the header only; rad/s; the temperature from the lines above."""
    dma = read_dma(export("rheocompass.csv"))
    assert (dma.mode, dma.frequency.size) == ("shear", 10)
    assert dma.frequency[0] == pytest.approx(0.1 / (2 * math.pi), rel=1e-15)
    assert (dma.temperature[0], dma.storage[-1], dma.loss[-1]) == (25.0, 3300.0, 4200.0)
    assert any("rad/s" in note for note in dma.notes)


def test_trios_csv_needs_its_temperature():
    """No temperature anywhere: refused, until it is given; shear is deduced from the plates, and said."""
    path = export("trios.csv")
    with pytest.raises(ValueError, match="line 10: no column recognised as temperature: give temperature"):
        read_dma(path)
    with pytest.warns(AssumedMeaning, match="taken as shear"):
        dma = read_dma(path, temperature=25.0)
    assert dma.frequency[0] == pytest.approx(6.28 / (2 * math.pi), rel=1e-15)
    assert (dma.mode, dma.storage[-1], dma.loss[-1]) == ("shear", 1305.7, 400.8)


def test_trios_lims_reads_every_step():
    """Twenty steps of 17 points in one file; Hz preferred to rad/s; a negative loss is kept, not dropped."""
    with pytest.warns(AssumedMeaning, match="taken as shear"):
        dma = read_dma(export("trios_lims.txt"))
    assert (dma.frequency.size, len(dma.isotherms)) == (340, 20)
    assert dma.frequency[0] == pytest.approx(0.100000001490116, rel=1e-12)
    assert dma.storage[0] == pytest.approx(0.010044287109375e6, rel=1e-12)


def test_frames_mappings_and_arrays_read_alike():
    """A mapping, what quacks like a pandas frame, and an array (n, 4)."""
    names = ("frequency (Hz)", "temperature (K)", "G' (MPa)", 'G" (MPa)')
    columns = dict(zip(names, (F, T + 273.15, STORAGE / 1e6, LOSS / 1e6), strict=True))

    class Frame:
        def __init__(self):
            self.columns = list(columns)

        def __getitem__(self, name):
            return columns[name]

    same_points(read_dma(columns))
    same_points(read_dma(Frame()))
    same_points(read_dma(np.array(ROWS), "shear"))
    with pytest.raises(ValueError, match="data, row 1, column \"G' \\(MPa\\)\": 'x' is not a number"):
        read_dma(columns | {"G' (MPa)": [5.0, "x", 4.0, 4.5]})
    with pytest.raises(ValueError, match="equally long"):
        read_dma({"f_Hz": [1.0], "T_C": [1.0, 2.0]})
    with pytest.raises(ValueError, match="must be a path, a pandas frame"):
        read_dma(42)


def test_pandas_frame():
    """A real one, where pandas is installed."""
    pandas = pytest.importorskip("pandas")
    same_points(read_dma(pandas.DataFrame(ROWS, columns=["f_Hz", "T_C", "G_storage_Pa", "G_loss_Pa"])))


@pytest.mark.parametrize(
    ("pair", "values"),
    [
        ("|G*| (Pa),phase (deg)", (np.hypot(STORAGE, LOSS), np.degrees(np.arctan2(LOSS, STORAGE)))),
        ("G* (Pa),δ [rad]", (np.hypot(STORAGE, LOSS), np.arctan2(LOSS, STORAGE))),
        ("Complex shear modulus (Pa),loss factor", (np.hypot(STORAGE, LOSS), LOSS / STORAGE)),
        ("G' (Pa),tan δ", (STORAGE, LOSS / STORAGE)),
        ("G' (Pa),phase angle (°)", (STORAGE, np.degrees(np.arctan2(LOSS, STORAGE)))),
    ],
)
def test_moduli_by_magnitude_phase_and_loss_factor(tmp_path, pair, values):
    """Every pair a complex modulus can be told by."""
    rows = "".join(
        f"{f!r},{t!r},{a!r},{b!r}\n"
        for f, t, a, b in zip(*map(np.ndarray.tolist, (F, T, *values)), strict=True)
    )
    same_points(read_dma(written(tmp_path, f"f_Hz,T_C,{pair}\n{rows}"), "shear"))


HEAD = "frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa\n"


def test_what_is_assumed_of_the_frequency_is_said(tmp_path):
    """Hz and rad/s cannot be told apart by the numbers: the assumption is a warning and a note."""
    body = "1,20,5e6,1e6\n2,20,5.5e6,1e6\n"
    with pytest.warns(AssumedMeaning, match="no unit for the frequency: taken as Hz"):
        dma = read_dma(written(tmp_path, HEAD.replace("_Hz", "") + body))
    assert dma.frequency[0] == 1.0
    assert any("taken as Hz" in note for note in dma.notes)
    with pytest.warns(AssumedMeaning, match="taken as rad/s"):
        dma = read_dma(written(tmp_path, HEAD.replace("frequency_Hz", "angular frequency") + body))
    assert dma.frequency[0] == pytest.approx(1 / (2 * math.pi))
    with pytest.warns(AssumedMeaning, match="an angular frequency in Hz"):
        read_dma(written(tmp_path, HEAD.replace("frequency_Hz", "angular frequency (Hz)") + body))
    assert any("read in Hz" in note for note in read_dma(written(tmp_path, HEAD + body)).notes)


def test_missing_values_are_counted_and_negative_moduli_kept(tmp_path):
    """Nothing is dropped without a warning that says how many and why."""
    text = HEAD + "1,20,5e6,1e6\n2,20,,1e6\n3,20,5e6,nan\n4,20,6e6,-1e5\n"
    with pytest.warns(LeftOut, match="2 of 4 points left out: first .*line 3.*empty for the storage"):
        dma = read_dma(written(tmp_path, text))
    assert dma.loss.tolist() == [1e6, -1e5]


def test_a_unit_that_cannot_be_is_refused(tmp_path):
    """Pa labelled MPa: 5e6 MPa is harder than diamond; MPa labelled Pa is softer than a gel."""
    body = "1,20,5e6,1e6\n2,20,5.5e6,1e6\n"
    with pytest.raises(ValueError, match=r"table.csv, line 2 .*harder than diamond.*is the unit right"):
        read_dma(written(tmp_path, HEAD.replace("Pa", "MPa") + body))
    with pytest.warns(UnlikelyModulus, match="the range of gels.*is the unit right"):
        read_dma(written(tmp_path, HEAD + "1,20,5,1\n2,20,5.5,1\n"))


def test_two_sweeps_at_one_temperature_are_named(tmp_path):
    """Up and down again at 20 °C: refused, with the remedies."""
    text = HEAD + "1,20,5e6,1e6\n2,20,6e6,1e6\n1,20,5e6,1e6\n2,20,6e6,1e6\n"
    with pytest.raises(ValueError, match=r"line 4: .*runs back.*two sweeps at one temperature"):
        read_dma(written(tmp_path, text))


def says_where(path, **options):
    """Read a file; if that ends in an error it is a ValueError with the file's name and a line."""
    message = None
    try:
        read_dma(path, **options)
    except ValueError as error:
        message = str(error)
    assert message is None or (str(path) in message and "line " in message), message


def pieces():
    """Text that resembles a table: headers, units, numbers, and what does not belong."""
    cell = st.sampled_from(
        ["f", "f_Hz", "freq", "ω", "T", "T_C", "Temp (K)", "G'", 'G"', "E_stor_MPa", "|G*|", "tan δ",
         "phase [°]", "Hz", "rad/s", "°C", "MPa", "1", "20", "5e6", "-3", "0", "1,5",
         "nan", "inf", "1e400", "", "x", '"',
         "[", "Step name", "[Step]", "Variables", "Interval data:", "#", "\u2028", "\x0b", "1_0"]
    )  # fmt: skip
    line = st.tuples(st.lists(cell, max_size=6), st.sampled_from([",", ";", "\t", " "])).map(
        lambda p: p[1].join(p[0])
    )
    return st.lists(st.one_of(line, st.text(max_size=20)), max_size=8).map("\n".join)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=pieces(), bytes_=st.binary(max_size=40), encoding=st.sampled_from(["utf-8", "utf-16", "raw"]))
def test_broken_files_only_raise_value_errors_that_say_where(tmp_path, text, bytes_, encoding):
    """Whatever stands in a file: data, or a ValueError with its name and a line."""
    path = tmp_path / "broken.csv"
    path.write_bytes(bytes_ if encoding == "raw" else text.encode(encoding, "surrogatepass"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        says_where(path, mode="shear", temperature=20.0)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_damaged_exports_only_raise_value_errors_that_say_where(tmp_path, data):
    """A good table with a line lost, a cell changed, or its end cut off."""
    lines = (HEAD + "".join(f"{f},{t},{s},{q}\n" for f, t, s, q in ROWS)).splitlines()
    for _ in range(data.draw(st.integers(1, 3))):
        i = data.draw(st.integers(0, len(lines) - 1))
        cells = lines[i].split(",")
        k = data.draw(st.integers(0, len(cells) - 1))
        cells[k] = data.draw(st.sampled_from(["", "x", "-1", "0", "inf", "1e999", "5 e6", '"', "NaN", "1;2"]))
        lines[i] = ",".join(cells)[: data.draw(st.integers(0, 60))]
    path = tmp_path / "damaged.csv"
    path.write_text("\n".join(lines), encoding="utf-8")
    with warnings.catch_warnings(), contextlib.suppress(UnicodeEncodeError):
        warnings.simplefilter("ignore")
        says_where(path)


# ---------------------------------------------------------------- errors by class


def book(path, *sheets):
    """A spreadsheet with these tables."""
    openpyxl = pytest.importorskip("openpyxl")
    found = openpyxl.Workbook()
    found.remove(found.active)
    for rows in sheets:
        sheet = found.create_sheet()
        for row in rows:
            sheet.append(row)
    found.save(path)
    return path


@pytest.mark.parametrize("member", ["xl/worksheets/sheet1.xml", "xl/styles.xml", "xl/drawing.bin"])
def test_a_spreadsheet_that_unpacks_without_end_is_refused_before_it_is(tmp_path, member):
    """A kilobyte for a megabyte, in whatever member: 17 MB is four seconds of reading."""
    path = book(tmp_path / "bomb.xlsx", [["f_Hz", "T_C", "G'_Pa", 'G"_Pa'], *map(list, ROWS)])
    with zipfile.ZipFile(path) as packed:
        held = {name: packed.read(name) for name in packed.namelist()}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, content in {member: b"", **held}.items():
            packed.writestr(name, content + b" " * (17 << 20) if name == member else content)
    with pytest.raises(ValueError, match=r"bomb.xlsx, line 1: .* unpacks to \d+ MB, more than 16 MB"):
        read_dma(path)


def test_a_sheet_without_a_header_is_passed_over_and_a_broken_table_is_not(tmp_path):
    """The first sheet with a header counts; what is wrong below that header is said, not passed over."""
    names = ["f_Hz", "T_C", "G'_Pa", 'G"_Pa']
    good, notes = [names, *map(list, ROWS)], [["made by hand"], ["on a Monday", 5]]
    same_points(read_dma(book(tmp_path / "book.xlsx", notes, good)))
    without_temperature = [[f, s, q] for f, _, s, q in good]
    same_points(read_dma(book(tmp_path / "book.xlsx", without_temperature, good)))
    broken = [names, ["x", 20.0, 5e6, 1e6]]
    with pytest.raises(ReadingError, match="'x' is not a number"):
        read_dma(book(tmp_path / "book.xlsx", broken, good))
    with pytest.raises(HeaderError, match="no column recognised as frequency"):
        read_dma(book(tmp_path / "book.xlsx", notes))


def test_the_text_of_a_file_does_not_decide_what_an_error_is(tmp_path):
    """A title that repeats the message of another error is only a title: its sheet is not passed over."""
    title = "no column recognised as"
    odd = [["f_Hz", "T_C", f"{title} [psi]", 'G"_Pa'], *map(list, ROWS)]
    good = [["f_Hz", "T_C", title, 'G"_Pa'], *map(list, ROWS)]
    with pytest.raises(ReadingError, match="unit 'psi' for the storage") as error:
        read_dma(book(tmp_path / "book.xlsx", odd, good), columns={"storage": title})
    assert not isinstance(error.value, HeaderError)


@pytest.mark.parametrize(
    ("text", "kind", "arguments"),
    [
        ("a,b\n1,2\n", HeaderError, {"columns"}),
        ("f_Hz,G'_Pa,G\"_Pa\n1,5e6,1e6\n", HeaderError, {"columns", "temperature"}),
        ("f_Hz,T_C,G' [X],G\"_Pa\n1,20,5e6,1e6\n", ReadingError, {"units"}),
        ("f_Hz,T_C,storage_Pa,loss_Pa\n1,20,5e6,1e6\n", ReadingError, {"mode"}),
        ("f_Hz,T_C,storage modulus,loss_Pa\n1,20,5e6,1e6\n", ReadingError, {"units", "mode"}),
        (HEAD.replace("Pa", "GPa") + "1,20,5e6,1e6\n", ReadingError, {"units"}),
        (HEAD + "0,20,5e6,1e6\n", ReadingError, {"drop_invalid"}),
        (HEAD + "1,20,5e6,1e6\n2,20,5e6,1e6\n1,20,5e6,1e6\n", ReadingError, {"sort"}),
    ],
)
def test_errors_name_the_arguments_that_help(tmp_path, text, kind, arguments):
    """For a program around the reader, as the command line is one."""
    with pytest.raises(kind) as error:
        read_dma(written(tmp_path, text))
    assert type(error.value) is kind
    assert set(error.value.arguments) == arguments
    assert all(f"{name}=" in str(error.value) for name in arguments)
