"""What the page shows of results: charts and tables by their kind, designs of one kind side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bearingdyn.analysis import spectrum
from bearingdyn.reporting.blocks import paragraph, scaled, table, told
from bearingdyn.reporting.chart import Chart, Curve
from bearingdyn.reporting.shapes import free_motions
from bearingdyn.sound import level
from bearingdyn.types import Array
from bearingdyn.units import rpm

if TYPE_CHECKING:
    import xarray

Results: TypeAlias = "Mapping[str, xarray.Dataset]"
MODES = 40  # listed of a machine that may have hundreds
MOST_CHANNELS = 12  # drawn of each kind of march
FAINT = 1e-5  # of the largest line, below which the high end of a spectrum is not drawn
WIDE = 30.0  # ratio of frequencies from which their axis is logarithmic


def together(results: Results) -> list[tuple[str, Results]]:
    """Results in sections of a report: those under one name before the last "/" stand together."""
    found: dict[tuple[str, str], dict[str, xarray.Dataset]] = {}
    for name, data in results.items():
        above, _, last = name.rpartition("/")
        kind = kind_of(data)
        shared = bool(above) and kind in BESIDE
        found.setdefault((above if shared else name, kind), {})[last if shared else name] = data
    return [(title, members) for (title, _), members in found.items()]


def kind_of(data: xarray.Dataset) -> str:
    """The analysis that a report's result says it is of."""
    return str(data.attrs.get("analysis", ""))


def results_html(members: Results) -> str:
    """Charts and tables of a section of a report's results."""
    kind = kind_of(next(iter(members.values())))
    make = BESIDE.get(kind)
    if make is not None:
        return make(members)
    alone = ALONE.get(kind, everything)
    return "".join(alone(data) for data in members.values())


def _response(members: Results) -> str:
    """A chart for each pair of output and input, magnitude over frequency or speed."""
    first = next(iter(members.values()))
    over = "frequency" if "frequency" in first.coords else "speed"
    pairs: dict[tuple[str, str], list[Curve]] = {}
    for label, data in members.items():
        response = data["response"]
        if response.ndim > 3:  # by amplitude too: the first
            response = response.isel({d: 0 for d in response.dims if d not in (over, "output", "input")})
        x = data[over].values / (rpm if over == "speed" else 1.0)
        for output in map(str, data["output"].values):
            given = [str(i) for i in data["input"].values] if "input" in data.coords else [""]
            for name in given:
                one = response.sel(output=output, input=name) if name else response.sel(output=output)
                pairs.setdefault((output, name), []).append(Curve(label, x, np.abs(one.values)))
    quantity = str(first.attrs.get("quantity", "response"))
    unit = str(first["response"].attrs.get("units", ""))
    charts = []
    for (output, name), curves in pairs.items():
        values, text = scaled(np.concatenate([c.y for c in curves]), unit)
        parts = np.split(values, np.cumsum([c.x.size for c in curves])[:-1])
        x = np.concatenate([c.x for c in curves])
        positive = x[x > 0]
        wide = bool(positive.size == x.size and x.max() > WIDE * x.min())
        charts.append(
            Chart(
                f"{output}, by {name}" if name else f"{output}, by the unbalance",
                "frequency, Hz" if over == "frequency" else "speed, rpm",
                f"{quantity}, zero-to-peak, {text}",
                [Curve(c.name, c.x, y) for c, y in zip(curves, parts, strict=True)],
                log_x=wide,
                log_y=bool((values > 0).any()),
            ).html()
        )
    return "".join(charts) + _stated(first, ("speed", "layers", "contacts"))


def _march(members: Results) -> str:
    """Traces and spectra of the channels that all runs have, most of each kind first."""
    first = next(iter(members.values()))
    names = [
        str(c) for c in first["channel"].values if all(c in d["channel"].values for d in members.values())
    ]
    units = dict(zip(map(str, first["channel"].values), map(str, first["unit"].values), strict=True))
    charts = []
    for name in names[:MOST_CHANNELS]:
        traces = {label: d["record"].sel(channel=name).values for label, d in members.items()}
        scale, unit = _common(list(traces.values()), units[name])
        # runs that settled for different times begin together
        times = {k: d["time"].values - d["time"].values[0] for k, d in members.items()}
        pace, clock = _common(list(times.values()), "s")
        curves = [Curve(k, pace * times[k], scale * traces[k]) for k in members]
        charts.append(Chart(name, f"time from the first sample, {clock}", unit or "–", curves).html())
        lines = _spectra(members, name)
        if lines:
            factor, text = _common([c.y for c in lines], units[name])
            shown = [Curve(c.name, c.x, factor * c.y) for c in lines]
            charts.append(
                Chart(f"{name}, spectrum", "frequency, Hz", f"zero-to-peak, {text}", shown, log_y=True).html()
            )
    left = len(names) - MOST_CHANNELS
    more = (
        f"{left} further channels are in the result: {', '.join(names[MOST_CHANNELS:])}" if left > 0 else ""
    )
    return (
        "".join(charts)
        + paragraph(more, "note")
        + _stated(first, ("speed", "dt", "steps", "status", "layers"))
    )


def _spectra(members: Results, name: str) -> list[Curve]:
    """Spectra of a channel, up to where the last line stands out; [] where a run is too short for one."""
    found = []
    for label, data in members.items():
        try:
            lines = spectrum(data, name)
        except ValueError:
            return []
        found.append(Curve(label, lines["frequency"].values[1:], lines["amplitude"].values[1:]))
    highest = 0.0
    for curve in found:
        above = np.flatnonzero(curve.y > FAINT * curve.y.max())
        if above.size:
            highest = max(highest, float(curve.x[above[-1]]))
    return [Curve(c.name, c.x[c.x <= highest], c.y[c.x <= highest]) for c in found] if highest else found


def _common(values: list[Array], unit: str) -> tuple[float, str]:
    """Factor to, and name of, the multiple of a unit that suits all values together."""
    size = max((float(np.nanmax(np.abs(v))) for v in values if v.size), default=0.0)
    one, text = scaled(np.array([size]), unit)
    return (float(one[0]) / size if size > 0 else 1.0), text


def _lines(members: Results) -> str:
    """Spectra: amplitude over frequency or order."""
    first = next(iter(members.values()))
    over = str(first["amplitude"].dims[-1])
    unit = str(first["amplitude"].attrs.get("units", ""))
    factor, text = _common([d["amplitude"].values for d in members.values()], unit)
    curves = [Curve(k, d[over].values, factor * np.abs(d["amplitude"].values)) for k, d in members.items()]
    label = "frequency, Hz" if over == "frequency" else over
    return Chart(
        str(first.attrs.get("channel", "")), label, f"zero-to-peak, {text}", curves, log_y=True
    ).html()


def _power(members: Results) -> str:
    """Sound power, and what a plane would radiate, as levels of a force of 1 N."""
    first = next(iter(members.values()))
    charts = []
    for name in map(str, first["input"].values):
        curves = []
        for label, data in members.items():
            one = data.sel(input=name)
            before = f"{label}: " if len(members) > 1 else ""
            if "equivalent_radiated_power" in one:
                curves.append(Curve(f"{before}sound power", _f(one), _db(one["power"].values)))
                if len(members) == 1:
                    plane = _db(one["equivalent_radiated_power"].values)
                    curves.append(Curve("as a plane (equivalent)", _f(one), plane))
            else:
                total = one["power"].values
                curves.append(Curve(label, _f(one), _db(total.sum(axis=1) if total.ndim > 1 else total)))
        x = curves[0].x
        charts.append(
            Chart(
                f"Power radiated, by {name}", "frequency, Hz", "level, dB re 1 pW, input of 1", curves,
                log_x=bool(x.min() > 0 and x.max() > WIDE * x.min()),
            ).html()
        )  # fmt: skip
    return "".join(charts) + _stated(first, ("floor", "panels", "surfaces"))


def _f(data: xarray.Dataset) -> Array:
    return np.asarray(data["frequency"].values)


def _db(power: Array) -> Array:
    with np.errstate(divide="ignore"):
        found = level(np.maximum(power, 0.0), "power")
    return np.where(np.isfinite(found), found, np.nan)


def _bands(members: Results) -> str:
    """Band levels as a table, designs side by side, and their totals."""
    first = next(iter(members.values()))
    word = str(first.attrs.get("weighting", "A"))
    curves = [
        Curve(f"{k}, {word}-weighted", d["band"].values.astype(float), _finite(d["weighted_level"].values))
        for k, d in members.items()
    ]
    unit = str(first["level"].attrs.get("units", "dB"))
    rows = [(k, f"{float(d['total']):.1f}", f"{float(d['weighted_total']):.1f}") for k, d in members.items()]
    return Chart("Levels in bands", "band, Hz", unit, curves, log_x=True).html() + table(
        ("", f"in all, {unit}", f"{word}-weighted, {unit}"), rows
    )


def _finite(values: Array) -> Array:
    return np.where(np.isfinite(values), values, np.nan)


def _modes(data: xarray.Dataset) -> str:
    """Frequencies and damping, of as many modes as somebody reads."""
    f, zeta, free = data["frequency"].values, data["damping_ratio"].values, free_motions(data)
    damped = bool(data.attrs.get("damped"))
    rows = [
        (
            str(k + 1),
            "free, nothing holds it" if free[k] else told(float(f[k]), "Hz"),
            "" if free[k] else f"{100 * zeta[k]:.3g} %" if damped else "undamped",
        )
        for k in range(min(f.size, MODES))
    ]
    more = (
        f"{f.size - MODES} more, up to {told(float(f[-1]), 'Hz')}, are in the result."
        if f.size > MODES
        else ""
    )
    return (
        table(("mode", "natural frequency", "damping ratio"), rows)
        + paragraph(more)
        + _stated(data, ("speed", "modulus", "contacts"))
    )


def _campbell(data: xarray.Dataset) -> str:
    """Natural frequencies over the speed."""
    x = data["speed"].values / rpm
    curves = [
        Curve(f"mode {k + 1}", x, data["frequency"].values[:, k]) for k in range(data["frequency"].shape[1])
    ]
    return Chart(
        "Campbell diagram", "speed, rpm", "frequency, Hz", [*curves, Curve("1 ×", x, x / 60.0)]
    ).html()


def _steady(data: xarray.Dataset) -> str:
    """One steady motion: a period of its channels, and its lines."""
    charts = []
    pace, clock = _common([data["time"].values], "s")
    for k, name in enumerate(map(str, data["channel"].values)):
        unit = str(data["unit"].values[k])
        record = data["record"].values[:, k]
        factor, text = _common([record], unit)
        charts.append(
            Chart(
                name, f"time, {clock}", text, [Curve(name, pace * data["time"].values, factor * record)]
            ).html()
        )
        size = np.abs(data["amplitude"].values[:, k])
        order = np.argsort(data["frequency"].values)
        f, size = data["frequency"].values[order], size[order]
        keep = (f > 0) & (size > 0)
        factor, text = _common([size[keep]], unit)
        charts.append(
            Chart(
                f"{name}, lines", "frequency, Hz", f"zero-to-peak, {text}",
                [Curve(name, f[keep], factor * size[keep])], log_y=True, dots=True,
            ).html()
        )  # fmt: skip
    facts = ("speed", "stable", "multiplier", "residual", "energy_balance", "converged", "layers")
    return "".join(charts) + _stated(data, facts)


def _map(data: xarray.Dataset) -> str:
    """Branches of steady motions over the speed, stable and unstable, and what is located on them."""
    over = "speed" if "speed" in data else "parameter"
    x = data[over].values / (rpm if over == "speed" else 1.0)
    stable = data["stable"].values.astype(bool)
    branch = data["branch"].values
    charts = []
    for k, name in enumerate(map(str, data["channel"].values)):
        swing, unit = scaled(data["peak_to_peak"].values[:, k], str(data["unit"].values[k]))
        curves = []
        for b in np.unique(branch):
            for good, word in ((True, "stable"), (False, "unstable")):
                on = (branch == b) & (stable == good)
                if on.any():
                    at = np.argsort(x[on], kind="stable")
                    curves.append(Curve(f"branch {b}, {word}", x[on][at], swing[on][at]))
        label = "speed, rpm" if over == "speed" else "parameter"
        charts.append(
            Chart(f"{name}, steady motions", label, f"peak to peak, {unit}", curves, dots=True).html()
        )
    events = [
        (str(e), told(float(v), "rpm" if over == "speed" else ""), str(b))
        for e, v, b in zip(data["event"].values, x, branch, strict=True)
        if str(e)
    ]
    return "".join(charts) + table(("event", "at", "branch"), events)


def _heat(members: Results) -> str:
    """Mean power that each part turns into heat, designs side by side."""
    found = {
        label: dict(zip(map(str, data["part"].values), data["power"].values, strict=True))
        for label, data in members.items()
    }
    parts = list(dict.fromkeys(part for powers in found.values() for part in powers))
    rows = [
        (part, *(told(float(powers[part]), "W") if part in powers else "" for powers in found.values()))
        for part in parts
    ]
    total = ("in all", *(told(float(sum(powers.values())), "W") for powers in found.values()))
    return table(("part", *found), [*rows, total])


def everything(data: xarray.Dataset) -> str:
    """A report's result without a picture of its own: what it holds, and single numbers as they are."""
    rows = []
    for name, one in data.data_vars.items():
        unit = str(one.attrs.get("units", ""))
        over = ", ".join(f"{size} {d}" for d, size in one.sizes.items()) or "one number"
        if one.dtype.kind in "iufc" and one.size:
            size = np.abs(one.values)
            finite = size[np.isfinite(size)]
            ends = dict.fromkeys(f"{x:.4g}" for x in (finite.min(), finite.max())) if finite.size else ["–"]
            what = " to ".join(ends)
            what = told(float(np.real(one.values)), unit) if one.ndim == 0 else f"{what} {unit}".rstrip()
        else:
            what = str(one.values.item()) if one.ndim == 0 else ""
        rows.append((str(name), str(one.attrs.get("long_name", "")), over, what))
    return table(("name", "what", "over", "size"), rows)


def _stated(data: xarray.Dataset, names: tuple[str, ...]) -> str:
    """Attributes that a reader asks for, in one line."""
    said = []
    for name in names:
        value: Any = data.attrs.get(name)
        if value is None or np.ndim(value):
            continue
        if name == "speed":
            said.append(f"speed {float(value) / rpm:.5g} rpm")
        elif name == "layers":
            said.append(f"about the state at rest with its layers {value}")
        else:
            shown = f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)
            said.append(f"{name.replace('_', ' ')} {shown}")
    return paragraph("; ".join(said), "note")


BESIDE: Mapping[str, Callable[[Results], str]] = {
    "frequency response": _response,
    "unbalance response": _response,
    "transient": _march,
    "spectrum": _lines,
    "envelope spectrum": _lines,
    "order spectrum": _lines,
    "sound power": _power,
    "radiated power": _power,
    "band levels": _bands,
    "dissipation": _heat,
}
ALONE: Mapping[str, Callable[[xarray.Dataset], str]] = {
    "modes": _modes,
    "Campbell diagram": _campbell,
    "steady state": _steady,
    "speed map": _map,
    "parameter map": _map,
}
