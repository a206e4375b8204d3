"""What a machine answers at the values of its sliders: response, peaks, sag."""

from __future__ import annotations

import math
import os
import threading
import time
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.analysis import Equilibrium, equilibrium, frequencies, frequency_response, static_summary
from bearingdyn.application import Application, Channel
from bearingdyn.checks import instance, meant, name_list, number, require
from bearingdyn.explorer.sliders import Slider, place_of_load, sliders_of, turned
from bearingdyn.model import Model, read_model
from bearingdyn.reporting import told
from bearingdyn.types import Array

BAND = (10.0, 5000.0, 400)  # Hz and how many, where nothing else is asked
MACHINE = "it must be a bd.Model, an Application, or the path of a model file (.toml)"


@dataclass(frozen=True)
class View:
    """One view of an exploration: what a machine answers at some values of its sliders.

    Parameters
    ----------
    values
        By slider, in their units.
    frequency
        (f,) Hz.
    levels
        Magnitude of the receptance (f,), m/N or rad/N, by output; empty where there is none.
    facts
        What, and how much, in words: peaks, and the layers' sag and strain.
    trouble
        Why there is no state at these values; "" where there is one.
    doubts
        Warnings that came up.
    seconds
        That it took.
    """

    values: Mapping[str, float]
    frequency: Array
    levels: Mapping[str, Array]
    facts: Sequence[tuple[str, str]]
    trouble: str
    doubts: Sequence[str]
    seconds: float


class Exploration:
    """A machine whose quantities are turned: what `Explorer` says, without page and notebook."""

    def __init__(
        self,
        source: Model | Application | str | os.PathLike[str],
        *,
        input: str | None = None,
        outputs: Sequence[str] | None = None,
        frequency: ArrayLike | None = None,
    ) -> None:
        self._path = Path(source) if isinstance(source, str | os.PathLike) else None
        self._model = _model(source)
        self.title = self._model.title or "A machine on ball bearings"
        asked = _asked(self._model, None if input is None else name_list("input", [input])[0])
        self._input = asked[0]
        self._outputs = asked[1] if outputs is None else name_list("outputs", outputs, least=1)
        self.frequency = asked[2] if frequency is None else frequencies(frequency)
        found = sliders_of(self._model.application)
        if self._path is not None:
            found += [
                _of_parameter(k, v) for k, v in self._model.parameters.items() if not isinstance(v, str)
            ]
        self.sliders = {slider.name: slider for slider in found}
        require(
            bool(self.sliders),
            "source",
            source,
            "it has no layer, no constant load, no clearance and no parameter to turn; give it one",
        )
        # one state at a time, whoever asks: a page and a notebook may do so at once
        self._lock = threading.Lock()
        first = self.at({})
        if first.trouble:
            raise ValueError(f"source has no state to begin with: {first.trouble}")

    def __repr__(self) -> str:
        """One line."""
        return f"<Explorer of {self.title!r}: {', '.join(self.sliders)}>"

    @property
    def application(self) -> Application:
        """The machine as given."""
        return self._model.application

    @property
    def input(self) -> str:
        """Channel of the force."""
        return self._input

    @property
    def outputs(self) -> list[str]:
        """Channels of the response."""
        return list(self._outputs)

    def at(self, values: Mapping[str, float]) -> View:
        """What the machine answers.

        Parameters
        ----------
        values
            By slider, in its unit; those left out stand where the machine has them.

        Returns
        -------
        View
            Where there is no equilibrium, `trouble` says why.

        Raises
        ------
        ValueError
            For a slider that there is not, and a value outside its range.
        """
        given = {}
        for name, value in values.items():
            if name not in self.sliders:
                raise ValueError(f"{name!r} is no slider; {meant(str(name), self.sliders)}")
            slider = self.sliders[name]
            x = number(f"values[{name!r}]", value)
            inside = slider.low * (1.0 - 1e-9) <= x <= slider.high * (1.0 + 1e-9)
            remedy = f"it must lie between {slider.low:.6g} and {slider.high:.6g} {slider.unit}".rstrip()
            require(inside, f"values[{name!r}]", value, remedy)
            given[name] = x
        whole = {name: given.get(name, slider.value) for name, slider in self.sliders.items()}
        with self._lock:
            return self._computed(whole, given)

    def _computed(self, whole: dict[str, float], given: dict[str, float]) -> View:
        began = time.perf_counter()
        levels: dict[str, Array] = {}
        facts: list[tuple[str, str]] = []
        trouble = ""
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            try:
                eq = self._state(given)
                found = frequency_response(eq, self.frequency, [self._input], self._outputs)
                H = np.abs(found["response"].values[:, :, 0])
                levels = {name: H[:, k] for k, name in enumerate(self._outputs)}
                facts = [*self._peaks(levels), *_sags(eq)]
            except (ValueError, ArithmeticError, np.linalg.LinAlgError) as error:
                levels, facts, trouble = {}, [], " ".join(str(error).split())
        own = [w for w in caught if issubclass(w.category, UserWarning)]
        doubts = list(dict.fromkeys(" ".join(str(w.message).split()) for w in own))
        took = time.perf_counter() - began
        return View(whole, self.frequency, levels, facts, trouble, doubts, took)

    def _state(self, given: Mapping[str, float]) -> Equilibrium:
        """The machine turned, and at rest."""
        own = {s.name: s for s in sliders_of(self._model.application)}
        parameters = {k: v for k, v in given.items() if k not in own and v != self.sliders[k].value}
        model = self._model
        if parameters and self._path is not None:
            model = read_model(self._path, **parameters)
        moved = {k: v for k, v in given.items() if k in own and v != own[k].value}
        app = turned(model.application, own, moved)
        return equilibrium(app, **model.state)

    def _peaks(self, levels: Mapping[str, Array]) -> list[tuple[str, str]]:
        """The highest point of each curve."""
        said = []
        for name, level in levels.items():
            k = int(np.argmax(level))
            unit = "rad/N" if Channel.parse(name).is_rotation else "m/N"
            said.append((f"{name}, highest", f"{told(level[k], unit)} at {self.frequency[k]:.0f} Hz"))
        return said


def _model(source: Any) -> Model:
    if isinstance(source, str | os.PathLike):
        return read_model(source)
    instance("source", source, (Model, Application), MACHINE)
    return source if isinstance(source, Model) else Model(source)


def _asked(model: Model, own: str | None) -> tuple[str, list[str], Array]:
    """Input, outputs and frequencies: of an own channel, the model's first response, or its first load."""
    low, high, many = BAND
    for one in model.analyses if own is None else ():
        if one.kind == "frequency_response":
            f = np.asarray(one.arguments["frequency"], dtype=np.float64)
            f = f[f > 0]
            if f.size > 1:
                low, high = float(f.min()), float(f.max())
            outputs = list(one.arguments["outputs"])
            return next(iter(one.arguments["inputs"])), outputs, np.geomspace(low, high, many)
    place = place_of_load(model.application)
    if own is None and place is None:
        names = model.application.names()
        raise ValueError(f"input is None, and nothing is loaded; give a channel, such as '{names[0]}.y'")
    channel = own or f"{place}.y"
    return channel, [channel], np.geomspace(low, high, many)


def _of_parameter(name: str, value: float) -> Slider:
    """A slider of half to twice a parameter of the file."""
    if value == 0.0:
        return Slider(name, "", -1.0, 0.0, 1.0, note="of the file")
    low, high = sorted((0.5 * value, 2.0 * value))
    return Slider(name, "", low, float(value), high, log=False, note="of the file")


def _sags(eq: Equilibrium) -> list[tuple[str, str]]:
    """Deflection and strain of each layer."""
    if not eq.system.layers:
        return []
    still = static_summary(eq)
    said = []
    for name in still["layer"].values:
        one = still.sel(layer=name)
        after = float(one["time"])
        when = f" after {after:.4g} s" if 0.0 < after < math.inf else ""
        strain = float(one["strain"])
        told = f", strain {100 * strain:.1f} %" if math.isfinite(strain) else ""
        said.append((f"{name}, sag{when}", f"{1e6 * float(one['deflection']):.1f} µm{told}"))
    return said
