"""Reading DMA tables: columns, units, isotherms, and every way a table can be wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest

import make_sample_dma
from bearingdyn.material import DMAData, group_isotherms, read_dma, sample_dma_path
from bearingdyn.notice import LeftOut
from measured import DATA, written

ROWS = [(1.0, 20.0, 5e6, 1e6), (10.0, 20.1, 6e6, 1.5e6), (1.0, 40.0, 4e6, 0.7e6), (10.0, 39.9, 4.5e6, 0.9e6)]


def measured(name):
    """A file of the measured data, or a skip."""
    if not (DATA / name).exists():
        pytest.skip(f"measured data {DATA / name} are not here")
    return DATA / name


def table(header, rows=ROWS, separator=",", form=repr):
    """Text of a table."""
    return header + "\n" + "".join(separator.join(form(v) for v in row) + "\n" for row in rows)


def test_sample_is_what_its_maker_makes():
    """The shipped table, bit for bit, says that it is made, and reads back the numbers it was made of."""
    text = sample_dma_path().read_text(encoding="utf-8")
    assert text == make_sample_dma.table()
    assert text.startswith("# MADE DATA, not measured")
    dma = read_dma(sample_dma_path())
    f, T, storage, loss = make_sample_dma.points(20)
    assert dma.mode == "shear"
    np.testing.assert_allclose(dma.frequency, f, rtol=5e-6)  # written with six digits
    np.testing.assert_allclose(dma.temperature, T, atol=5.1e-4)  # three decimals
    np.testing.assert_allclose(dma.storage, storage, rtol=5e-6)
    np.testing.assert_allclose(dma.loss, loss, rtol=5e-6)
    np.testing.assert_allclose(dma.isotherm_temperatures, make_sample_dma.TEMPERATURES, atol=0.06)  # 4 σ/√15


def test_sample_is_a_damping_rubber():
    """Several MPa and a loss factor of 0.2 to 0.5 at 1 kHz and 20 °C."""
    modulus = make_sample_dma.modulus(2 * np.pi * 1000.0)
    assert 2e6 < modulus.real < 10e6
    assert 0.2 < modulus.imag / modulus.real < 0.5


@pytest.mark.parametrize(
    ("text", "encoding", "mode"),
    [
        (table("frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa"), "utf-8", "shear"),
        ("\ufeff" + table("f,T,E_stor,E_loss\nHz, C, Pa, Pa"), "utf-8", "tension"),
        (
            table(
                "Angular frequency (rad/s);Temperature (K);G' (MPa);G'' (MPa)",
                [(2 * math.pi * f, T + 273.15, s / 1e6, q / 1e6) for f, T, s, q in ROWS],
                ";",
                lambda v: repr(v).replace(".", ","),
            ),
            "latin-1",
            "shear",
        ),
        (table("f [Hz]\tTs [°C]\tE' [Pa]\tE\" [Pa]", separator="\t"), "latin-1", "tension"),
        (
            table(
                "  f    Ts     E'     E\"\n [Hz]  [°C]  [kPa]  [kPa]",
                [(f, T, s / 1e3, q / 1e3) for f, T, s, q in ROWS],
                "   ",
            ),
            "utf-8",
            "tension",
        ),
        (
            table(
                "# a comment\n\nfreq_hz,temp_C,shear storage modulus (GPa),tan_delta",
                [(f, T, s / 1e9, q / s) for f, T, s, q in ROWS],
            ),
            "utf-16",
            "shear",
        ),
    ],
    ids=[
        "plain",
        "unit row, BOM",
        "decimal comma, rad/s, K, MPa",
        "tabs, latin-1",
        "blanks, kPa",
        "tan delta, utf-16",
    ],
)
def test_tables_of_many_hands_read_alike(tmp_path, text, encoding, mode):
    """The same four points, whatever separator, unit, quote or encoding."""
    dma = read_dma(written(tmp_path, text, encoding))
    assert dma.mode == mode
    expected = np.array(ROWS).T
    for values, column in zip((dma.frequency, dma.temperature, dma.storage, dma.loss), expected, strict=True):
        np.testing.assert_allclose(values, column, rtol=1e-13)  # decimal fractions and one factor
    np.testing.assert_allclose(dma.isotherm_temperatures, [20.05, 39.95], rtol=1e-13)


@pytest.mark.parametrize(
    ("name", "mode", "points", "isotherms"),
    [("epdm70", "shear", 210, 10), ("glassy_polymer", "tension", 1320, 22), ("adhesive", "tension", 210, 21)],
)
def test_measured_tables_read_whole(name, mode, points, isotherms):
    """Every point of the three published measurements, in as many isotherms as their README says."""
    dma = read_dma(measured(f"{name}/dma.csv"))
    assert (dma.mode, dma.frequency.size, len(dma.isotherms)) == (mode, points, isotherms)
    assert group_isotherms(dma.temperature).max() + 1 == isotherms  # without the help of a nominal column


def test_moduli_in_megapascal_arrive_in_pascal():
    """E′ of the glassy polymer runs from 23 to 3259 MPa (its README)."""
    dma = read_dma(measured("glassy_polymer/dma.csv"))
    assert dma.storage.min() == pytest.approx(23e6, rel=0.01)
    assert dma.storage.max() == pytest.approx(3259e6, rel=1e-3)


def test_isotherms_survive_jitter_and_drift():
    """Steps of 2 to 20 K, drift of 1 K, jitter of 0.1 K; single points; one temperature."""
    rng = np.random.default_rng(1)
    levels = np.array([-40.0, -38.0, -30.0, -10.0, 0.0])
    T = np.repeat(levels, 20) + np.tile(np.linspace(0, 1, 20), 5) + 0.05 * rng.standard_normal(100)
    order = rng.permutation(100)
    np.testing.assert_array_equal(group_isotherms(T[order]), np.repeat(np.arange(5), 20)[order])
    np.testing.assert_array_equal(group_isotherms([30.0, 10.0, 20.0]), [2, 0, 1])
    np.testing.assert_array_equal(group_isotherms(20 + 0.05 * rng.standard_normal(30)), np.zeros(30))


def test_selection_leaves_out_openly():
    """What is left is within the limits; nothing left is an error that says what there is."""
    dma = DMAData(*np.array(ROWS).T, "shear")
    assert dma.select(f_max=5.0).frequency.tolist() == [1.0, 1.0]
    assert dma.select(T=(30.0, 50.0)).storage.tolist() == [4e6, 4.5e6]
    with pytest.raises(ValueError, match="no point between f_min = 20"):
        dma.select(f_min=20.0)


HEAD = "frequency_Hz,temperature_C,G_storage_Pa,G_loss_Pa\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no table"),
        ("# only a comment\n", "holds no table"),
        (HEAD, "line 1: the table is empty"),
        (HEAD + "1,20,5e6,1e6\n2,20,abc,1e6\n", r"line 3, column 'G_storage_Pa': 'abc' is not a number"),
        (HEAD + "1,20,5e6,-1e6\n", r"line 2, column 'G_loss_Pa': -1e\+06 for the loss: must be positive"),
        (HEAD + "1,20,nan,1e6\n", r"line 2, column 'G_storage_Pa': nan for the storage"),
        (HEAD + "1,20,5e6\n", r"line 2, column 'G_loss_Pa': empty for the loss"),
        (HEAD + "0,20,5e6,1e6\n", r"column 'frequency_Hz': 0 for the frequency: must be positive"),
        (
            HEAD + "1,20,5e6,1e6\n3,20,5e6,1e6\n2,20,5e6,1e6\n",
            r"line 4: frequency 2 Hz runs back .* sort=True",
        ),
        ("frequency_Hz,G_storage_Pa,G_loss_Pa\n1,5e6,1e6\n", "line 1: no column recognised as temperature"),
        ("a,b\n1,2\n", "no column recognised as frequency, temperature, storage, loss"),
        (
            "f_Hz,temperature,G_storage_Pa,G_loss_Pa\n1,293,5e6,1e6\n",
            r"no unit for the temperature: known are c",
        ),
        (
            "frequency_Hz,temperature (F),G_storage_Pa,G_loss_Pa\n1,20,5e6,1e6\n",
            "unit 'F' for the temperature",
        ),
        ("f_Hz,T_C,storage_Pa,loss_Pa\n1,20,5e6,1e6\n", "does not tell G"),
        ("f_Hz,T_C,G_storage_Pa,E_loss_Pa\n1,20,5e6,1e6\n", "must be both in shear"),
        ("f_Hz,freq_Hz,T_C,G_storage_Pa,G_loss_Pa\n1,1,20,5e6,1e6\n", "both look like the frequency"),
    ],
)
def test_bad_table_is_refused_by_name(tmp_path, text, message):
    """A message naming the file, then line, column, value and remedy."""
    path = written(tmp_path, text)
    with pytest.raises(ValueError, match=message) as error:
        read_dma(path)
    assert str(path) in str(error.value)


def test_binary_file_is_refused(tmp_path):
    """An instrument's own format is not a text table; a broken spreadsheet says what to do."""
    path = tmp_path / "table.csv"
    path.write_bytes(b"ab\ncd\0ef")
    with pytest.raises(ValueError, match=r"table.csv, line 2: a binary file"):
        read_dma(path)
    for head in (b"PK\x03\x04 and so on", b"\xd0\xcf\x11\xe0 and so on"):
        path.write_bytes(head)
        with pytest.raises(ValueError, match=r"table.csv, line 1: a spreadsheet.*CSV"):
            read_dma(path)


def test_remedies_work(tmp_path):
    """What the messages offer: drop_invalid with a count, sort, units, columns, mode."""
    path = written(tmp_path, HEAD + "3,20,5e6,1e6\n1,20,4e6,1e6\n2,20,,1e6\n4,20,5e6,0\n2,20,4.5e6,1e6\n")
    with pytest.warns(LeftOut, match="2 of 5 points left out: first .*line 4"):
        dma = read_dma(path, drop_invalid=True, sort=True)
    assert dma.frequency.tolist() == [1.0, 2.0, 3.0]
    assert dma.storage.tolist() == [4e6, 4.5e6, 5e6]
    path = written(tmp_path, "w1,T,storage,loss\n6.283185307179586,20,5,1\n")
    units = {"frequency": "rad/s", "temperature": "C", "storage": "MPa", "loss": "MPa"}
    dma = read_dma(path, mode="tension", columns={"frequency": "w1"}, units=units)
    assert (dma.mode, dma.frequency[0], dma.storage[0]) == ("tension", pytest.approx(1.0, rel=1e-15), 5e6)
    with pytest.raises(ValueError, match="the header says shear, mode is 'tension'"):
        read_dma(written(tmp_path, HEAD + "1,20,5e6,1e6\n"), mode="tension")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency": []}, "the table is empty"),
        ({"loss": [1e6]}, "loss has 1 values, frequency 4"),
        ({"storage": np.ones((2, 2))}, "must be one-dimensional"),
        ({"mode": "bulk"}, "mode is 'bulk'"),
        ({"storage": [1e6, np.nan, 1.0, 1.0]}, r"storage\[1\] is nan Pa"),
        ({"storage": [5e12] * 4}, "harder than diamond"),
        ({"temperature": [0.0, np.inf, 1.0, 1.0]}, "temperature: every value must be finite"),
        (
            {"frequency": [1.0, 3.0, 2.0, 4.0], "temperature": [20.0] * 4},
            r"frequency\[2\] is 2 Hz and runs",
        ),
        ({"temperature": [20.0, 30.0, 40.0, 50.0], "isotherm": [0, 0, 1, 1]}, "at most 6 K wide"),
        ({"isotherm": [0, 0, 1]}, "isotherm has 3 labels"),
    ],
)
def test_bad_arrays_are_refused(change, message):
    """A message naming field and value."""
    f, T, storage, loss = np.array(ROWS).T
    values = {"frequency": f, "temperature": T, "storage": storage, "loss": loss, "mode": "shear"} | change
    with pytest.raises(ValueError, match=message):
        DMAData(**values)
