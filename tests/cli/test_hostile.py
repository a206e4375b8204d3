"""Hostile arguments and files: one line that names them, code 2, nothing written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import bearingdyn as bd
from bearingdyn.cli import main

SAMPLE = str(bd.sample_dma_path())
DIGITS = "9" * 5000  # Python refuses to read so long an integer

FILES = {
    "empty": b"",
    "zeros": bytes(4000),
    "noise": bytes((37 * k * k + 11 * k) % 256 for k in range(4000)),
    "header": b"T (C),f (Hz),G' (Pa),G'' (Pa)\n",
    "hdf": b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 4,
    "nested": b"a = " + b"[" * 5000 + b"]" * 5000,
    "digits": b"[model]\nx = " + DIGITS.encode() + b"\n",
    "utf16": "a = 1".encode("utf-16"),
}

OPTIONS = [
    (["fit", SAMPLE, "--n", "1e3"], "--n: it is '1e3'; it must be a whole number, or auto"),
    (["fit", SAMPLE, "--n", DIGITS], "it must be a whole number, or auto"),
    (["fit", SAMPLE, "--n", "0"], "n is 0"),
    (["fit", SAMPLE, "--step", DIGITS], "step is"),
    (["fit", SAMPLE, "--step", ""], "--step is ''"),
    (["fit", SAMPLE, "--band", "nan", "nan"], "band is (nan, nan)"),
    (["fit", SAMPLE, "--T-ref", "1e9"], "T_ref is"),
    (["fit", SAMPLE, "--K", "inf"], "K is inf"),
    (["fit", SAMPLE, "--density", "nan"], "density is nan"),
    (["fit", SAMPLE, "--units", "foo=bar"], "unknown quantities ['foo']"),
    (["fit", SAMPLE, "--isotherms", "nan", "nan"], "T = nan to nan"),
    (["fit", SAMPLE, "--f-max", "nan"], "--f-max is nan"),
    (["fit", SAMPLE, "--out", "."], "is a folder"),
    (["fit", SAMPLE, "--out", ""], "--out is ''"),
    (["fit", SAMPLE, "--out", "/dev/full"], "/dev/full: is a device"),
    (["fit", SAMPLE, "--out", "a\0b"], "--out is 'a\\x00b'"),
    (["fit", SAMPLE, "--plot", "figure"], "its ending must be one of .png, .pdf, .svg"),
    (["fit", SAMPLE, "--plot", "/dev/full"], "/dev/full: is a device"),
    (["fit", "x" * 300], "cannot be read (File name too long)"),
    (["fit", "a\0b"], "NUL"),
    (["show", "a\0b"], "NUL"),
    (["show", "s3://bucket/x"], "no such file"),
    (["bearing", "NU205"], "designation is 'NU205'"),
    (["bearing", "6205", "--temperature", "nan"], "temperature is nan"),
    (["bearing", "6205", "--clearance", "0.012"], "it is in micrometres; is it in mm? give 12"),
    (
        ["bearing", "6205", "--radial", "9", "--rpm", "9", "--oil", "VG32", "--temperature", "343"],
        "in kelvin? give",
    ),
    (["bearing", "6205", "--temperature", "1e9"], "temperature is 1"),
    (["bearing", "6205", "--contamination", "mud"], "contamination is 'mud'"),
    (["bearing", "6205", "--reliability", "0.9"], "reliability is 0.9"),
    (["bearing", "6205", "--oil", "VG" + DIGITS], "oil is"),
    (["bearing", "6205", "--html", "."], "is a folder"),
    (["bearing", "7205", "--radial", "500"], "none of its"),
    (["check", "a\0b"], "NUL"),
    (["demo", "--out", ""], "--out is ''"),
    (["demo", "--out", SAMPLE], "it exists and is no folder"),
]


@pytest.mark.parametrize(("arguments", "found"), OPTIONS, ids=range(len(OPTIONS)))
def test_an_option_that_cannot_be_meant_is_one_line(arguments, found, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert found in told.err.splitlines()[-1]
    assert "Traceback" not in told.err
    assert told.out == ""
    assert not os.listdir(tmp_path)


@pytest.mark.parametrize("command", ["fit", "show", "check", "run"])
@pytest.mark.parametrize("kind", [*FILES, "folder", "loop", "device"])
def test_a_file_that_is_none_is_one_line_that_names_it(command, kind, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    name = "/dev/null" if kind == "device" else kind
    if kind == "folder":
        Path(kind).mkdir()
    elif kind == "loop":
        Path(kind).symlink_to(kind)
    elif kind in FILES:
        Path(kind).write_bytes(FILES[kind])
    assert main([command, name]) == 2
    told = capsys.readouterr()
    lines = told.err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("bearingdyn: ")
    assert name in lines[0]
    assert told.out == ""
