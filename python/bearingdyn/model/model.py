"""A model: an application with the analyses that are asked of it, as one file holds them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from bearingdyn import analysis
from bearingdyn.analysis import Equilibrium, equilibrium
from bearingdyn.application import Application
from bearingdyn.checks import instance, items, meant, named, require
from bearingdyn.pictures import page
from bearingdyn.short_repr import short

if TYPE_CHECKING:
    import xarray


def analyses() -> dict[str, Callable[..., Any]]:
    """The analyses that a model may ask for, by name: all that start from an equilibrium."""
    found = {}
    for name in analysis.__all__:
        made = getattr(analysis, name)
        if inspect.isfunction(made):
            first = next(iter(inspect.signature(made).parameters), "")
            if first in ("source", "eq") and "found" not in inspect.signature(made).parameters:
                found[name] = made
    return {k: v for k, v in found.items() if not k.startswith(("sheet_", "ball_channels"))}


@dataclass(frozen=True, eq=False)
class Analysis:
    """One analysis that is asked of a model.

    Parameters
    ----------
    name
        Under which its result is kept.
    kind
        The function's name, as "frequency_response".
    arguments
        Its arguments by name, without the equilibrium.

    Raises
    ------
    ValueError
        For a function or an argument that does not exist.
    """

    name: str
    kind: str
    arguments: Mapping[str, Any] = field(default_factory=dict)

    __repr__ = short
    _repr_html_ = page

    def __post_init__(self) -> None:
        known = analyses()
        require(isinstance(self.name, str) and bool(self.name), "name", self.name, "it must be a word")
        named("arguments", self.arguments, "it must be a mapping, argument -> value")
        if not isinstance(self.kind, str) or self.kind not in known:
            raise ValueError(f"type is {self.kind!r}; {meant(str(self.kind), known)}")
        wanted = inspect.signature(known[self.kind]).parameters
        allowed = list(wanted)[1:]
        for argument in self.arguments:
            if argument not in allowed:
                raise ValueError(f"{argument} is no argument of {self.kind}; {meant(argument, allowed)}")
        for argument in allowed:
            if wanted[argument].default is inspect.Parameter.empty and argument not in self.arguments:
                raise ValueError(f"{self.kind} lacks {argument}; it must be given")


@dataclass(frozen=True, eq=False)
class Model:
    """A model: a machine, the state it starts from, and what is asked of it.

    Parameters
    ----------
    application
        The machine.
    analyses
        What is asked, in order.
    state
        Arguments of `bd.equilibrium`, such as {"after": 60.0}.
    title
        One line.
    parameters
        Numbers and texts by name, for a sweep; as they were used.
    materials
        By the name that the file has for them.
    places
        Where "equilibrium", each analysis, and what a message begins with stand in a file, for messages.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> model = bd.Model(app, [bd.Analysis("modes", "modes", {"count": 1})])
    >>> print(f"{model.run()['modes']['frequency'].item():.2f} Hz")
    112.54 Hz
    """

    application: Application
    analyses: Sequence[Analysis] = ()
    state: Mapping[str, Any] = field(default_factory=dict)
    title: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    materials: Mapping[str, Any] = field(default_factory=dict)
    places: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        instance("application", self.application, Application, "it must be an Application (bd.Application())")
        instance("title", self.title, str, "it must be a text")
        for name in ("state", "parameters", "materials", "places"):
            named(name, getattr(self, name), "it must be a mapping with names as keys")
        for k, asked in enumerate(items("analyses", self.analyses, "it must be a list of bd.Analysis")):
            remedy = 'it must be a bd.Analysis(name, kind, arguments), as bd.Analysis("modes", "modes")'
            instance(f"analyses[{k}]", asked, Analysis, remedy)

    def __repr__(self) -> str:
        """One line: parts, bearings, and what is asked."""
        plan = self.application.plan
        asked = ", ".join(a.name for a in self.analyses) or "nothing"
        size = f"{len(plan.parts)} parts, {len(plan.bearings)} bearings"
        return f"<Model {self.title!r}: {size}; asked for {asked}>"

    def _repr_html_(self) -> str:
        return self.application._repr_html_()

    def equilibrium(self) -> Equilibrium:
        """The state from which the analyses start."""
        return equilibrium(self.application, **self.state)

    def run(self, tell: Callable[[str], object] = lambda _: None) -> dict[str, xarray.Dataset]:
        """Find the equilibrium and do every analysis.

        Parameters
        ----------
        tell
            Called with a line before each.

        Returns
        -------
        dict of xarray.Dataset
            By the name of each analysis, ready for `bd.save`.

        Raises
        ------
        ValueError
            As the equilibrium and the analyses do.
        """
        tell("equilibrium")
        with self._at("equilibrium"):
            eq = self.equilibrium()
        known, found = analyses(), {}
        for one in self.analyses:
            tell(one.name)
            with self._at(one.name):
                found[one.name] = known[one.kind](eq, **one.arguments)
        return found

    @contextmanager
    def _at(self, name: str) -> Iterator[None]:
        """What is refused within is told with its place in the file."""
        try:
            yield
        except (ValueError, TypeError) as error:
            told = str(error)
            place = next((self.places[k] for k in self.places if told.startswith(k)), self.places.get(name))
            if place is None:
                raise
            raise ValueError(f"{place}: {told}") from error
