"""Measured and made materials: shifts, master curves, Maxwell fits (measurements lie beside the project)."""

from __future__ import annotations

import warnings

import numpy as np

import make_sample_dma as made
from bearingdyn.material import MasterCurve, Maxwell, fit_maxwell, master_curve, read_dma, sample_dma_path
from measured import DATA
from verified.row import Row


def measured() -> list[Row]:
    """The made material found again; misfits of the measured ones; shifts as published."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of laws through a transition, and bands
        return _made() + (_rubber() + _polymers() if DATA.exists() else [])


def _made() -> list[Row]:
    master = master_curve(read_dma(sample_dma_path()))
    model = fit_maxwell(master, 5, K=2e9, density=1200.0)
    rows = [
        Row(
            f"made material, a_T at {T:.0f} °C",
            "stated WLF law of the made data",
            float(10 ** made.log_shift(T)),
            float(10**shift),
            0.047,
            "0.02 decade, asked for with 1 % noise",
        )
        for T, shift in master.shifts.items()
        if abs(T - 20) > 5
    ]
    for f in (0.1, 10.0, 1e3, 1e5):
        exact, found = made.modulus(2 * np.pi * f), complex(model.complex_modulus(2 * np.pi * f))
        for name, want, got in (
            ("G′", exact.real, found.real),
            ("tan δ", exact.imag / exact.real, found.imag / found.real),
        ):
            source, reason = "stated model of the made data", "twice the 1.5 % rms asked for"
            rows.append(Row(f"made material, {name} at {f:g} Hz", source, want, got, 0.03, reason))
    return rows


def _limit(case: str, limit: float, found: float) -> Row:
    """A row held from above: a misfit beyond the limit does not hold, one below it does."""
    reason = "an upper limit: what lies below it holds, what lies above does not"
    return Row(case, "limit asked for", limit, found, 1.0 if found <= limit else 0.0, reason)


def _rubber() -> list[Row]:
    master = master_curve(read_dma(DATA / "epdm70" / "dma.csv").select(f_max=20.0), clean=False)
    model = fit_maxwell(master, 5, (10.0, 1e5), K=2e9, density=1200.0)
    return [*_misfits("epdm70 up to 20 Hz", master, 0.012, 0.032), *_errors(model)]


def _errors(model: Maxwell) -> list[Row]:
    assert model.fit is not None  # fit_maxwell leaves one
    name = "epdm70, five branches, 10 Hz to 100 kHz, tan δ"
    return [
        _limit(f"{name} rms", 0.04, model.fit.tan_delta_rms),
        _limit(f"{name} largest", 0.12, model.fit.tan_delta_max),
    ]


def _misfits(name: str, master: MasterCurve, storage: float, loss: float) -> list[Row]:
    found = master.kk_residual
    return [
        _limit(f"{name}, misfit of the storage modulus", storage, found[0]),
        _limit(f"{name}, misfit of the loss modulus", loss, found[1]),
    ]


def _polymers() -> list[Row]:
    dma = read_dma(DATA / "adhesive" / "dma.csv").select(f_max=30.0)
    adhesive = master_curve(dma, 80.0, "free", clean=False)
    dma = read_dma(DATA / "glassy_polymer" / "dma.csv")
    glassy = master_curve(dma, 90.0, "free", clean=False)
    path = DATA / "glassy_polymer" / "published_shifts.csv"
    nominal, published = np.genfromtxt(path, delimiter=",", skip_header=1).T
    shifts = np.array(list(glassy.shifts.values()))
    smooth = (nominal <= 40) | (nominal >= 65)
    difference = shifts - published
    shifts = shifts - (difference[smooth].max() + difference[smooth].min()) / 2
    rows = _misfits("adhesive up to 30 Hz", adhesive, 0.030, 0.035)
    rows += _misfits("glassy polymer", glassy, 0.045, 0.077)
    for T, want, got in zip(nominal[smooth], published[smooth], shifts[smooth], strict=True):
        reason = "0.3 decade; one offset for all, since they share no reference"
        rows.append(
            Row(
                f"glassy polymer, log a_T at {T:.0f} °C",
                "DMA-analysis-suite, commit 9efa7069",
                want,
                got,
                0.3 / abs(want),
                reason,
            )
        )
    return rows
