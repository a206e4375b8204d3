"""`bearingdyn fit`: a Maxwell model from measured DMA data, as a table or JSON."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

from bearingdyn.cli.outcome import GOOD
from bearingdyn.material import (
    DMAData,
    LowEnd,
    MasterCurve,
    Maxwell,
    ReadingError,
    fit_maxwell,
    master_curve,
    read_dma,
)

# usual for rubber; said in the table where they were not given
BULK_MODULUS = 2e9
DENSITY = 1200.0

# options of this command by the argument of read_dma they stand for
_OPTIONS = {
    "units": "--units storage=MPa loss=MPa temperature=C",
    "columns": "--columns storage=TITLE",
    "mode": "--mode shear",
}


def run_fit(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command that fits a model, written to --out as well."""
    out, figure = _target("--out", arguments.out), _target("--plot", arguments.plot)
    if arguments.f_max is not None and not arguments.f_max > 0:
        raise ValueError(f"--f-max is {arguments.f_max}; it must be a positive frequency, in Hz")
    dma = _read(arguments)
    if arguments.f_max is not None:
        dma = dma.select(f_max=arguments.f_max)
    curve = master_curve(dma, T_ref=arguments.T_ref, law=arguments.law, clean=not arguments.no_clean)
    band = None if arguments.band is None else (arguments.band[0], arguments.band[1])
    model = fit_maxwell(
        curve,
        n=arguments.n,
        band=band,
        K=BULK_MODULUS if arguments.K is None else arguments.K,
        density=DENSITY if arguments.density is None else arguments.density,
    )
    if out is not None:
        out.write_text(model.to_json() + "\n", encoding="utf-8")
    if figure is not None:
        from matplotlib.figure import Figure

        from bearingdyn.plot import master

        drawn = Figure(figsize=(6.2, 5.0), layout="constrained")
        master(curve, model, drawn.add_subplot())
        drawn.savefig(figure)
    if arguments.json:
        return json.dumps({**_fit_record(curve, model), "data": arguments.data}, indent=1), GOOD
    text = _fit_table(
        curve, model, K_given=arguments.K is not None, density_given=arguments.density is not None
    )
    return "\n".join([text, *(f"written to {path}" for path in (out, figure) if path is not None)]), GOOD


def _target(option: str, name: str | None) -> Path | None:
    """A file to write, whose folder is there."""
    path = None if name is None else Path(name)
    if path is not None and not path.resolve().parent.is_dir():
        raise ValueError(f"{option} {path}: there is no folder {path.parent}")
    return path


def _read(arguments: argparse.Namespace) -> DMAData:
    """The measurement; what read_dma asks for by its arguments is asked for by options."""
    columns, units = _pairs("--columns", arguments.columns), _pairs("--units", arguments.units)
    try:
        return read_dma(arguments.data, arguments.mode, columns=columns, units=units)
    except ReadingError as error:
        options = ", ".join(_OPTIONS[name] for name in _OPTIONS if name in error.arguments)
        raise ValueError(f"{error} (options: {options})" if options else str(error)) from error


def _pairs(option: str, given: list[str]) -> dict[str, str]:
    """The texts "quantity=value" as a mapping."""
    pairs = {}
    for text in given:
        name, sign, value = text.partition("=")
        if not (name and sign and value):
            raise ValueError(f"{option} {text!r}: must be quantity=value, such as storage=kPa")
        pairs[name] = value
    return pairs


def _fit_record(curve: MasterCurve, model: Maxwell) -> dict[str, Any]:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one
    return {
        "maxwell": json.loads(model.to_json()),
        "fit": {
            "band": list(report.band),
            "covered": list(report.covered),
            "points": report.points,
            "storage_rms": report.storage_rms,
            "storage_max": report.storage_max,
            "tan_delta_rms": report.tan_delta_rms,
            "tan_delta_max": report.tan_delta_max,
        },
        "master": {
            "T_ref": curve.T_ref,
            "mode": curve.mode,
            "frequency": [float(curve.frequency[0]), float(curve.frequency[-1])],
            "shifts": [{"temperature": T, "log_aT": shift} for T, shift in curve.shifts.items()],
            "law_residual": curve.law_residual,
            "kk_residual": list(curve.kk_residual),
        },
    }


def _fit_table(curve: MasterCurve, model: Maxwell, K_given: bool, density_given: bool) -> str:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one

    storage, loss = curve.kk_residual

    def assumed(given: bool) -> str:
        return "" if given else "  (assumed)"

    lines = [
        f"master curve   {len(curve.shifts)} isotherms in {curve.mode}, {curve.frequency[0]:.3g} to "
        f"{curve.frequency[-1]:.3g} Hz at {curve.T_ref:g} C",
        f"shift law      {type(curve.law).__name__}, rms {curve.law_residual:.3f} decades",
        f"causality      rms {storage:.2%} of the storage, {loss:.2%} of the loss modulus",
        "",
        f"Maxwell model in shear at {curve.T_ref:g} C",
        f"  G0           {model.G0:12.5g} Pa",
        *(
            f"  G{i:<2d}          {G:12.5g} Pa     tau{i:<2d} {tau:12.5g} s"
            for i, (G, tau) in enumerate(zip(model.G, model.tau, strict=True), 1)
        ),
        f"  eta0         {model.eta0:12.5g} Pa s",
        f"  K            {model.K:12.5g} Pa{assumed(K_given)}",
        f"  density      {model.density:12.5g} kg/m3{assumed(density_given)}",
        "",
        f"errors of the {report.points} points from {report.covered[0]:.4g} to {report.covered[1]:.4g} Hz",
        f"  storage modulus  rms {report.storage_rms:.2%}   largest {report.storage_max:.2%}",
        f"  tan delta        rms {report.tan_delta_rms:.2%}   largest {report.tan_delta_max:.2%}",
        *_low_end(report.low_end),
    ]
    return "\n".join(lines)


def _low_end(end: LowEnd | None) -> list[str]:
    """What the points say of the modulus at rest."""
    if end is None:
        return []
    plateau = "a plateau" if end.plateau else f"no plateau, G' falls up to {end.fall:.0%} a decade"
    return [
        f"at rest: the points reach {end.reach:.3g} s and show {plateau}",
        f"  they allow G0 from {end.interval[0]:.4g} to {end.interval[1]:.4g} Pa",
    ]
