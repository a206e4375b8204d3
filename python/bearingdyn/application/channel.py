"""Channels by name: one component of what is measured at a place, "shaft.left.y.velocity"."""

from __future__ import annotations

from dataclasses import dataclass

from bearingdyn.application.place import Place

COMPONENTS = ("x", "y", "z", "θx", "θy", "θz")
ALIASES = {"rx": "θx", "ry": "θy", "rz": "θz"}
# of a motion; the order is the number of derivatives
QUANTITIES = ("displacement", "velocity", "acceleration")
RATES = dict(zip(QUANTITIES, ("", "/s", "/s²"), strict=True))
GROUND = Place("ground", "")


@dataclass(frozen=True)
class Channel:
    """A channel by name, one component of a motion or force: "shaft.left.y", "left.force.x".

    `str` gives the name back, with θx for rx.

    Parameters
    ----------
    at
        What the channel belongs to: a place ("shaft.left"), a bearing ("left") or "ground".
    component
        "x" … "θz"; another text where the name ends with something else, such as "loaded" of a bearing.
    quantity
        "displacement", "velocity" or "acceleration"; "" where the name leaves it open. "force" is the force
        that a bearing passes, or that a part puts on its interface; "reaction" the force that the ground
        bears.

    Examples
    --------
    >>> from bearingdyn.application import Channel
    >>> Channel.parse("shaft.left.rx.velocity")
    Channel(at='shaft.left', component='θx', quantity='velocity')
    >>> Channel.parse("ground.housing.feet.y").is_force
    True
    """

    at: str
    component: str
    quantity: str = ""

    @classmethod
    def parse(cls, text: str) -> Channel:
        """The channel of a name. Any text can be parsed; whoever asks checks that it exists."""
        at, _, last = text.rpartition(".")
        if last in QUANTITIES:
            at, _, component = at.rpartition(".")
            return cls(at, ALIASES.get(component, component), last)
        component = ALIASES.get(last, last)
        if at.startswith(f"{GROUND}."):
            return cls(at.removeprefix(f"{GROUND}."), component, "reaction")
        if at.endswith(".force"):
            return cls(at.removesuffix(".force"), component, "force")
        return cls(at, component)

    def __str__(self) -> str:
        """The name as it is written."""
        return f"{self.site}.{self.component}" + (f".{self.quantity}" if self.quantity in QUANTITIES else "")

    @property
    def site(self) -> str:
        """The name without component and quantity: what tells places, and the forces there, apart."""
        if self.quantity == "reaction":
            return f"{GROUND}.{self.at}"
        return f"{self.at}.force" if self.quantity == "force" else self.at

    @property
    def index(self) -> int | None:
        """Place of the component in x, y, z, θx, θy, θz, counted from 0; None where it is none of these."""
        return COMPONENTS.index(self.component) if self.component in COMPONENTS else None

    @property
    def is_rotation(self) -> bool:
        """Whether it is a rotation or a moment."""
        return self.component in COMPONENTS[3:]

    @property
    def is_force(self) -> bool:
        """Whether it is a force or a moment that passes somewhere, no motion."""
        return self.quantity in ("force", "reaction")

    @property
    def of_ground(self) -> bool:
        """Whether it is a motion of the ground itself, as "ground.y"."""
        return self.at == str(GROUND)

    @property
    def force_unit(self) -> str:
        """Unit of a force along the component: N, or N m about it."""
        return "N m" if self.is_rotation else "N"

    def motion_unit(self, quantity: str = "") -> str:
        """Unit of the motion along the component in a quantity; "" is the channel's own, or displacement."""
        return ("rad" if self.is_rotation else "m") + RATES[quantity or self.quantity or QUANTITIES[0]]
