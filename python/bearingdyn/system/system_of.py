"""The system of an application, for analyses that take either of both."""

from __future__ import annotations

from typing import cast

from bearingdyn.application import Application
from bearingdyn.checks import require
from bearingdyn.system.assembly import assemble
from bearingdyn.system.system import System


def system_of(field: str, source: object) -> System:
    """The system of an application, or the system itself.

    Parameters
    ----------
    field
        Name of the argument in messages.
    source
        The application or system.

    Returns
    -------
    System

    Raises
    ------
    ValueError
        For anything else.
    """
    if isinstance(source, System):
        return source
    remedy = "it must be an Application (bd.Application()), or its system"
    require(isinstance(source, Application), field, source, remedy)
    return assemble(cast(Application, source))
