"""`bearingdyn fit`: a Maxwell model from measured DMA data, as a table or JSON."""

from __future__ import annotations

import argparse
import io
import json
import math
import re
from pathlib import Path
from typing import Any, Final

from bearingdyn.checks import require
from bearingdyn.cli.outcome import GOOD
from bearingdyn.material import (
    DMAData,
    LowEnd,
    MasterCurve,
    Maxwell,
    ReadingError,
    RelaxationData,
    fit_maxwell,
    master_curve,
    one_curve,
    read_dma,
)
from bearingdyn.writing import check_target, write_whole

# usual for rubber; said in the table where they were not given
BULK_MODULUS = 2e9
DENSITY = 1200.0
FIGURES = (".png", ".pdf", ".svg")
T_REF = 20.0
LAW: Final = "wlf"

# options of this command by the argument of read_dma they stand for
_OPTIONS = {
    "units": "--units storage=MPa loss=MPa temperature=C",
    "columns": "--columns storage=TITLE",
    "mode": "--mode shear",
    "temperature": "--temperature 20",
    "step": "--step NAME",
    "sort": "--sort",
}

# what shifts isotherms, and means nothing for a single one, by its name among the arguments
_SHIFTING = {"T_ref": "--T-ref", "law": "--law", "no_clean": "--no-clean"}


def run_fit(arguments: argparse.Namespace) -> tuple[str, int]:
    """The command `bearingdyn fit`: fits a material model to a measurement, written to --out as well."""
    out, figure = _target("--out", arguments.out), _target("--plot", arguments.plot)
    if figure is not None:
        ending = figure.suffix.lower()
        require(ending in FIGURES, "--plot", str(figure), f"its ending must be one of {', '.join(FIGURES)}")
    if arguments.f_max is not None and not arguments.f_max > 0:
        raise ValueError(f"--f-max is {arguments.f_max}; it must be a positive frequency, in Hz")
    dma = _chosen(_read(arguments), arguments)
    curve = _curve(dma, arguments)
    band = None if arguments.band is None else (arguments.band[0], arguments.band[1])
    model = fit_maxwell(
        dma if isinstance(curve, RelaxationData) else curve,
        n=arguments.n,
        band=band,
        K=BULK_MODULUS if arguments.K is None else arguments.K,
        density=DENSITY if arguments.density is None else arguments.density,
    )
    if out is not None:
        write_whole(out, f"{model.to_json()}\n".encode())
    if figure is not None:
        from matplotlib.figure import Figure

        from bearingdyn.plot import master

        drawn = Figure(figsize=(6.2, 5.0), layout="constrained")
        master(one_curve(curve), model, drawn.add_subplot())
        picture = io.BytesIO()
        drawn.savefig(picture, format=figure.suffix[1:].lower())
        write_whole(figure, picture.getvalue())
    if arguments.json:
        names = arguments.data[0] if len(arguments.data) == 1 else arguments.data
        return json.dumps({**_fit_record(curve, model), "data": names}, indent=1), GOOD
    text = _fit_table(
        curve, model, K_given=arguments.K is not None, density_given=arguments.density is not None
    )
    return "\n".join([text, *(f"written to {path}" for path in (out, figure) if path is not None)]), GOOD


def _target(option: str, name: str | None) -> Path | None:
    """A file to write, whose folder is there."""
    if name is not None:
        require(bool(name) and "\0" not in name, option, name, "it must be the name of a file")
    path = None if name is None else Path(name)
    if path is not None and not path.resolve().parent.is_dir():
        raise ValueError(f"{option} {path}: there is no folder {path.parent}")
    if path is not None:
        check_target(path)
    return path


def _read(arguments: argparse.Namespace) -> DMAData:
    """The measurement; what read_dma asks for by its arguments is asked for by options."""
    columns, units = _pairs("--columns", arguments.columns), _pairs("--units", arguments.units)
    files = arguments.data[0] if len(arguments.data) == 1 else arguments.data
    T = arguments.temperature
    one = T is not None and len(T) == 1 and len(arguments.data) == 1
    step = None if arguments.step is None else [_step(s) for s in arguments.step]
    try:
        return read_dma(
            files,
            arguments.mode,
            columns=columns,
            units=units,
            temperature=T[0] if one else T,
            sort=arguments.sort,
            drop_invalid=arguments.drop_invalid,
            step=step,
        )
    except ReadingError as error:
        options = ", ".join(_OPTIONS[name] for name in _OPTIONS if name in error.arguments)
        raise ValueError(f"{error} (options: {options})" if options else str(error)) from error


def _step(text: str) -> int | str:
    """A step by its number, or by a part of its name."""
    require(bool(text.strip()), "--step", text, "it must be a number from 1, or a part of a step's name")
    return int(text) if re.fullmatch("[0-9]{1,9}", text) else text


def _chosen(dma: DMAData, arguments: argparse.Namespace) -> DMAData:
    """The points asked for, by frequency, temperature and run."""
    wanted: dict[str, Any] = {
        "f_max": arguments.f_max,
        "T": None if arguments.isotherms is None else tuple(arguments.isotherms),
        "run": arguments.run_names,
    }
    given = {name: value for name, value in wanted.items() if value is not None}
    return dma.select(**given) if given else dma


def _curve(dma: DMAData, arguments: argparse.Namespace) -> MasterCurve | RelaxationData:
    """What is fitted: isotherms shifted to one curve, a single sweep as it is, or a single relaxation.

    Raises
    ------
    ValueError
        For an option that shifts isotherms where there is one only.
    """
    T = dma.isotherm_temperatures
    if T.size > 1:
        return master_curve(
            dma,
            T_ref=T_REF if arguments.T_ref is None else arguments.T_ref,
            law=LAW if arguments.law is None else arguments.law,
            clean=not arguments.no_clean,
        )
    for name, option in _SHIFTING.items():
        value = getattr(arguments, name)
        remedy = f"{dma.source} has a single isotherm, at {T[0]:.4g} °C, that is not shifted; leave it out"
        require(value is None or value is False, option, value, remedy)
    return dma if isinstance(dma, RelaxationData) else one_curve(dma)


def _pairs(option: str, given: list[str]) -> dict[str, str]:
    """The texts "quantity=value" as a mapping."""
    pairs = {}
    for text in given:
        name, sign, value = text.partition("=")
        if not (name and sign and value):
            raise ValueError(f"{option} {text!r}: must be quantity=value, such as storage=kPa")
        pairs[name] = value
    return pairs


def _fit_record(curve: MasterCurve | RelaxationData, model: Maxwell) -> dict[str, Any]:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one
    loss = {name: getattr(report, name) for name in ("tan_delta_rms", "tan_delta_max")}
    record: dict[str, Any] = {
        "maxwell": json.loads(model.to_json()),
        "fit": {
            "band": list(report.band),
            "covered": list(report.covered),
            "points": report.points,
            "storage_rms": report.storage_rms,
            "storage_max": report.storage_max,
            # of a relaxation no loss was measured, and JSON has no NaN
            **{name: None if math.isnan(value) else value for name, value in loss.items()},
        },
    }
    if isinstance(curve, MasterCurve) and curve.law is not None:
        record["master"] = {
            "T_ref": curve.T_ref,
            "mode": curve.mode,
            "frequency": [float(curve.frequency[0]), float(curve.frequency[-1])],
            "shifts": [{"temperature": T, "log_aT": shift} for T, shift in curve.shifts.items()],
            "law_residual": curve.law_residual,
            "kk_residual": list(curve.kk_residual),
        }
    return record


def _fit_table(
    curve: MasterCurve | RelaxationData, model: Maxwell, K_given: bool, density_given: bool
) -> str:
    report = model.fit
    assert report is not None  # fit_maxwell leaves one
    low, high = report.covered
    relaxed = isinstance(curve, RelaxationData)
    if relaxed:
        place = f"from {1 / (2 * math.pi * high):.4g} to {1 / (2 * math.pi * low):.4g} s"
    else:
        place = f"from {low:.4g} to {high:.4g} Hz"
    what = "relaxation modulus" if relaxed else "storage modulus "

    def assumed(given: bool) -> str:
        return "" if given else "  (assumed)"

    lines = [
        *_origin(curve),
        "",
        f"Maxwell model in shear at {model.temperature:g} C",
        f"  G0           {model.G0:12.5g} Pa",
        *(
            f"  G{i:<2d}          {G:12.5g} Pa     tau{i:<2d} {tau:12.5g} s"
            for i, (G, tau) in enumerate(zip(model.G, model.tau, strict=True), 1)
        ),
        f"  eta0         {model.eta0:12.5g} Pa s",
        f"  K            {model.K:12.5g} Pa{assumed(K_given)}",
        f"  density      {model.density:12.5g} kg/m3{assumed(density_given)}",
        "",
        f"errors of the {report.points} points {place}",
        f"  {what} rms {report.storage_rms:.2%}   largest {report.storage_max:.2%}",
    ]
    if not relaxed:
        lines.append(
            f"  tan delta        rms {report.tan_delta_rms:.2%}   largest {report.tan_delta_max:.2%}"
        )
    return "\n".join([*lines, *_low_end(report.low_end)])


def _origin(curve: MasterCurve | RelaxationData) -> list[str]:
    """What was fitted, in a line or three."""
    if isinstance(curve, RelaxationData):
        T = curve.isotherm_temperatures[0]
        return [
            f"relaxation     {curve.time.size} points in {curve.mode} at {T:.4g} C, {curve.time.min():.3g} "
            f"to {curve.time.max():.3g} s"
        ]
    ends = f"{curve.frequency[0]:.3g} to {curve.frequency[-1]:.3g} Hz"
    if curve.law is None:
        return [
            f"single sweep   {curve.frequency.size} points in {curve.mode} at {curve.T_ref:.4g} C, {ends}; "
            "no shift law"
        ]
    storage, loss = curve.kk_residual
    return [
        f"master curve   {len(curve.shifts)} isotherms in {curve.mode}, {ends} at {curve.T_ref:g} C",
        f"shift law      {type(curve.law).__name__}, rms {curve.law_residual:.3f} decades",
        f"causality      rms {storage:.2%} of the storage, {loss:.2%} of the loss modulus",
    ]


def _low_end(end: LowEnd | None) -> list[str]:
    """What the points say of the modulus at rest."""
    if end is None:
        return []
    plateau = "a plateau" if end.plateau else f"no plateau, G' falls up to {end.fall:.0%} a decade"
    return [
        f"at rest: the points reach {end.reach:.3g} s and show {plateau}",
        f"  they allow G0 from {end.interval[0]:.4g} to {end.interval[1]:.4g} Pa",
    ]
