"""The application as its user builds it: every call is checked and written into the plan."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import ArrayLike

from bearingdyn.application.applied_loads import AppliedLoads
from bearingdyn.application.fit_of_neighbours import RINGS, check_bearing, check_beside, check_connection
from bearingdyn.application.joints import BearingJoint, Bush, Connection, LooseJoint, Support
from bearingdyn.application.part import Part
from bearingdyn.application.place import Place
from bearingdyn.application.plan import Plan
from bearingdyn.application.summary import summary
from bearingdyn.bearing import BallBearing, LooseFit, RowSet
from bearingdyn.checks import instance, named, require, truth
from bearingdyn.cms import kept_superelement
from bearingdyn.parts import FlexibleRing
from bearingdyn.pictures import picture
from bearingdyn.plausible_ranges import plausible
from bearingdyn.types import Array
from bearingdyn.units import takes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# units of six numbers, along the axes and about them
STIFFNESS = ("N/m",) * 3 + ("N m/rad",) * 3
DAMPING = ("N s/m",) * 3 + ("N m s/rad",) * 3
OFFSET = ("m",) * 3 + ("rad",) * 3


class Application(AppliedLoads):
    """The application: a machine of parts, joints, bearings and loads, by name.

    An interface is named "part.interface", as "shaft.left"; a point that a part offers for output and loads
    is named in the same manner. Every interface must be joined, grounded, given a bearing, or declared free.

    Names are checked at once, joints when the system is assembled. Either way a ValueError names the part and
    interface. Lengths, forces and masses are in SI; vectors have the order (x, y, z, θx, θy, θz).

    Attributes
    ----------
    plan
        All that was added, for those who read it.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> app = bd.Application()
    >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
    >>> app.ground("mass.centre", stiffness=[1e6] * 6)
    >>> app.load("mass.centre", (0, -20.0, 0, 0, 0, 0))
    >>> print(f"{bd.equilibrium(app).displacement('mass.centre')[1] * 1e6:.1f} µm")
    -20.0 µm
    """

    def __init__(self) -> None:
        self.plan = Plan()

    def __repr__(self) -> str:
        """The summary, or that there is nothing yet."""
        return self.summary() if self.plan.parts else "<Application without parts>"

    def _repr_html_(self) -> str:
        return str(picture("as_html", self))

    def summary(self) -> str:
        """What is connected to what, masses, loads, and which motions nothing holds: read it first."""
        return summary(self.plan)

    def draw(self, ax: Axes | None = None, *, table: bool = True) -> Axes:
        """Draw the machine before anything is solved: its section, to scale; see `bd.plot.draw`.

        Parameters
        ----------
        ax
            Axes to draw into, without a parts list; None: those of a new sheet.
        table
            Whether a new sheet has the parts list.

        Returns
        -------
        Axes
            The axes of the section.

        Raises
        ------
        ValueError
            For an application without parts.
        """
        axes: Axes = picture("draw", self, ax, table=table)
        return axes

    def scene(self) -> Any:
        """The machine in three dimensions, a pyvista.MultiBlock; see `bd.plot.scene`.

        Raises
        ------
        ImportError
            Without pyvista.
        ValueError
            Where no part has a surface.
        """
        return picture("scene", self)

    def names(self) -> list[str]:
        """All interfaces and points, "part.name"."""
        return self.plan.names()

    def mass(self, part: str) -> float | None:
        """Mass of a part, kg; None where it has no rigid motion of its own.

        Raises
        ------
        ValueError
            If there is no such part.
        """
        self.plan.check_part(part)
        return self.plan.mass(part)

    def add(self, name: str, part: Part, *, cache: str | os.PathLike[str] | None = None) -> None:
        """Add a part under a name. One object may be added under several names; it is reduced once.

        Parameters
        ----------
        name
            A word without dots, neither "ground" nor "gravity".
        part
            Anything with a method `superelement()`, such as a Shaft, a Layer or a Superelement.
        cache
            Folder in which the reduced part is kept by its content, for the next machine, process or day;
            made where missing. None: it is reduced here.

        Raises
        ------
        ValueError
            If the name is taken, reserved or has a dot, the part cannot become a superelement, or, with a
            cache, cannot be told by its content.
        OSError
            Where the cache cannot be written.
        """
        plan = self.plan
        plan.check_new("part", name)
        if isinstance(part, BallBearing | RowSet):
            raise ValueError(
                f"part {name!r} is a {type(part).__name__}; hang bearings between parts with "
                f"app.bearing({name!r}, …, inner=…, outer=…)"
            )
        remedy = "it must be a part, such as bd.Shaft(…), bd.RigidBody(…) or bd.Layer(…)"
        if not isinstance(part, type) and callable(getattr(part, "assembled", None)):
            remedy = "as it lies it holds nothing: give what it is squeezed to, part.assembled(…)"
        ready = not isinstance(part, type) and callable(getattr(part, "superelement", None))
        require(ready, f"part {name!r}", part, remedy)
        if cache is not None:
            instance("cache", cache, (str, os.PathLike), "give the path of a folder, or None")
        twin = next((known for known, source in plan.sources.items() if source is part), None)
        # the twin's own, before a temperature was put on it
        if twin is not None:
            made = plan.reduced[twin]
        else:
            made = part.superelement() if cache is None else kept_superelement(part, Path(cache))
        plan.put(name, part, made)

    def with_parts(self, parts: Mapping[str, Part]) -> Application:
        """A copy of the machine in which these parts stand instead of those of the same name.

        Joints, bearings and loads stay as they are; whether the new part's diameters fit its neighbours is
        not asked again.

        Parameters
        ----------
        parts
            New parts by the names of old ones. None: the copy alone.

        Returns
        -------
        Application
            The other machine; this one stays as it is.

        Raises
        ------
        ValueError
            For a name that is no part's, and a part that lacks an interface or point of the old one.

        Examples
        --------
        >>> import bearingdyn as bd
        >>> app = bd.Application()
        >>> app.add("mass", bd.RigidBody(mass=2.0, inertia=(1e-3, 1e-3, 1e-3)))
        >>> app.ground("mass.centre", stiffness=[1e6] * 6)
        >>> light = app.with_parts({"mass": bd.RigidBody(mass=1.0, inertia=(1e-3, 1e-3, 1e-3))})
        >>> app.mass("mass"), light.mass("mass")
        (2.0, 1.0)
        """
        remedy = "it must be parts by the names of those whose place they take"
        other = Application()
        other.plan = self.plan.copy()
        fresh = Application()
        for name, part in named("parts", parts, remedy).items():
            self.plan.check_part(name)
            fresh.add(name, part)
            old, new = self.plan.parts[name], fresh.plan.parts[name]
            for kind in ("interfaces", "outputs", "raceways"):
                lost = [one for one in getattr(old, kind) if one not in getattr(new, kind)]
                if lost:
                    raise ValueError(
                        f"parts[{name!r}] lacks {lost[0]!r}; it must have the places of the part that it "
                        f"replaces: {', '.join(getattr(old, kind))}"
                    )
            other.plan.put(name, fresh.plan.sources[name], new)
            if name in self.plan.temperatures:
                other.temperature(name, self.plan.temperatures[name])
        return other

    def connect(self, a: str, b: str, *, fits: bool = True) -> None:
        """Join two interfaces rigidly: they move as one.

        Parameters
        ----------
        a, b
            The interfaces, "part.interface".
        fits
            Whether what is known of both is compared: one must sit in the other. Radii more than 5 % apart
            are refused, and warned of above 1 %; so are parts that run into a shoulder. False: they are meant
            to differ.

        Raises
        ------
        ValueError
            If either is unknown or connected already, both are of one part, or they do not fit.

        Warns
        -----
        FitWarning
            Where they hardly fit.
        """
        first, second = self.plan.interface(a), self.plan.interface(b)
        for place in (first, second):
            partner = self.plan.partners().get(place)
            if partner is not None:
                raise ValueError(
                    f"{place} is connected already, to {partner}; connect the third part to another "
                    f"interface of either"
                )
        joint = Connection(first, second)
        if truth("fits", fits):
            check_connection((first, second), (self.plan.faces(first), self.plan.faces(second)))
        else:
            self.plan.unjudged.add(joint)
        self.plan.connections.append(joint)

    @takes(stiffness=STIFFNESS, damping=DAMPING, offset=OFFSET)
    def ground(
        self,
        interface: str,
        stiffness: ArrayLike | None = None,
        damping: ArrayLike | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """Hold an interface: rigidly, or by springs and dampers.

        Parameters
        ----------
        interface
            What is held. Without stiffness and damping it is held rigidly.
        stiffness, damping
            (6,) N/m, N m/rad and N s/m, N m s/rad.
        offset
            (6,) m and rad, where the springs carry no force: they pull the interface there (preload by
            displacement). Choose the stiffness of what presses.

        Raises
        ------
        ValueError
            If the interface is unknown or grounded already, a number is negative, or an offset has no spring
            to act through.
        """
        place = self.plan.interface(interface)
        if place in self.plan.supports:
            raise ValueError(f"{place} is grounded already; give stiffness and damping in one call")
        self.plan.supports[place] = Support(place, *(cast(Array, v) for v in (stiffness, damping, offset)))

    @takes(stiffness=STIFFNESS, damping=DAMPING, offset=OFFSET)
    def spring(
        self,
        a: str,
        b: str,
        stiffness: ArrayLike,
        damping: ArrayLike | None = None,
        offset: ArrayLike | None = None,
    ) -> None:
        """Put six springs and dampers between two interfaces.

        Both references are taken to lie at one place, as in a bush: the springs act on x_a − x_b − offset.

        Parameters
        ----------
        a, b
            The interfaces; b may be "ground".
        stiffness, damping
            (6,) N/m, N m/rad and N s/m, N m s/rad.
        offset
            (6,) m and rad, preload by displacement.

        Raises
        ------
        ValueError
            If an interface is unknown, both are one, a number is negative, or an offset has no spring to act
            through.
        """
        first, second = self.plan.interface(a), self.plan.interface_or_ground(b)
        given = (stiffness, *(np.zeros(6) if v is None else v for v in (damping, offset)))
        self.plan.springs.append(Bush(first, second, *(cast(Array, v) for v in given)))

    def free(self, interface: str) -> None:
        """Declare that an interface is left unjoined on purpose, or a raceway without balls.

        Raises
        ------
        ValueError
            If there is no such interface or raceway.
        """
        place = self.plan.place(interface)
        if self.plan.raceway(place) is None:
            self.plan.interface(place)
        self.plan.free_interfaces.add(place)

    @takes(offset="m")
    def bearing(
        self,
        name: str,
        bearing: BallBearing | RowSet,
        *,
        inner: str,
        outer: str,
        offset: float = 0.0,
        mirrored: bool = False,
        fits: bool = True,
    ) -> None:
        """Hang a bearing between the interfaces of its two rings.

        Parameters
        ----------
        name
            A word without dots. The rows of a set become the bearings "name-1", "name-2" and so on.
        bearing
            What is hung: one bearing, or a `Pair` or `Triplet`, whose middle stands at the interfaces and
            whose preload comes with it.
        inner, outer
            Interfaces of the rings. outer may be "ground", and each the raceway of a flexible ring,
            "ring.raceway", made for this bearing's arm. A ring turns with the shaft where its part does: one
            with gyroscopic forces, as a Shaft or a rotating RigidBody, or connected to such a part. Where
            neither is known to turn, the inner ring does. The bearing's `turning` says otherwise.
        offset
            How far along z the inner ring sits beyond where it is drawn, m: a spacer or nut that preloads
            two bearings against each other by displacement.
        mirrored
            Whether it is hung the other way round, its open side turned: `BallBearing.mirrored`; of a set,
            its rows in the other order too.
        fits
            Whether bore, outside and width are compared with the seats, as by `connect`; of a bearing without
            `boundary`, whether the seats leave room for its rings. Two on one shaft must not overlap.

        Raises
        ------
        ValueError
            If it is not a bearing, a name is unknown or taken, the raceway has another arm or is to carry
            more than one row, the offset is not finite, or a ring does not fit.

        Warns
        -----
        FitWarning
            Where a ring hardly fits.
        """
        self.plan.check_new("bearing", name)
        joints: list[BearingJoint] = []
        # the ground carries no inner ring: `place` does not know it
        ends = self.plan.raceway_or_interface(self.plan.place(inner)), self.plan.raceway_or_interface(outer)
        truth("mirrored", mirrored)
        truth("fits", fits)
        races = [place for place in ends if self.plan.raceway(place) is not None]
        if isinstance(bearing, RowSet) and races:
            raise ValueError(
                f"bearing {name!r}: {races[0]} carries one row of balls, and a {type(bearing).__name__} has "
                f"{len(bearing.rows)}; hang it in a rigid interface, or each row in a ring of its own"
            )
        for joint in _hung(name, bearing, ends, offset, mirrored):
            self.plan.check_new("bearing", joint.name)
            self.plan.check_raceway(joint)
            if fits:
                for ring, place in zip(RINGS, (joint.inner, joint.outer), strict=True):
                    check_bearing(joint, ring, place, self.plan.faces(place))
                    source = self.plan.sources.get(place.part)
                    if isinstance(source, FlexibleRing) and self.plan.raceway(place) is not None:
                        source.check_bearing(name, joint.bearing)
                # the rows of one set must not overlap either
                others = [*self.plan.bearings.values(), *joints]
                check_beside(joint, [b for b in others if b.inner.part == ends[0].part], self.plan.faces)
            joints.append(joint)
        self.plan.bearings |= {joint.name: joint for joint in joints}
        if not fits:
            self.plan.unjudged |= {joint.name for joint in joints}

    def fit(self, name: str, fit: LooseFit, *, ring: str, bore: str) -> None:
        """Set a flexible ring loosely in a bore, or on a shaft.

        Parameters
        ----------
        name
            A word without dots.
        fit
            Clearance and contact.
        ring
            Outside of the ring, "ring.outside", or of one around a shaft its bore, "ring.inside".
        bore
            What it sits in or on: an interface or "ground", which stay round, or a raceway of another body,
            such as a `Groove` that is the bore of a `Revolved` housing, which bends with it order by order.

        Raises
        ------
        ValueError
            If this is no loose fit, a name is unknown or taken, the ring's outside is no raceway, or the bore
            moves by other orders or lies at another radius.
        """
        self.plan.check_new("fit", name)
        joint = LooseJoint(name, fit, self.plan.place(ring), self.plan.raceway_or_interface(bore))
        if self.plan.raceway(joint.ring) is None:
            raise ValueError(
                f'fit {name!r}: {ring!r} is no flexible face; make the ring with outside="flexible" and '
                f'name its "outside"'
            )
        check_connection((joint.ring, joint.bore), (self.plan.faces(joint.ring), self.plan.faces(joint.bore)))
        self.plan.check_fit(joint)
        self.plan.fits[name] = joint

    @takes(T="°C")
    def temperature(self, part: str, T: float) -> None:
        """Put a part's viscoelastic materials at a temperature, by the shift law of each.

        Parameters
        ----------
        part
            Name of the part.
        T
            °C; a second call replaces the first. Outside the isotherms a material's law was found from, a
            warning (OutsideIsotherms) says so.

        Raises
        ------
        ValueError
            For an unknown part, one without viscoelastic material, or a material without law.
        """
        self.plan.check_part(part)
        element = self.plan.parts[part]
        if not element.viscoelastic:
            raise ValueError(f"part {part!r} has no viscoelastic material; a temperature changes nothing")
        T = plausible(
            "temperature", f"temperature of part {part!r}", T, "it must be one finite number, in °C"
        )
        moved = []
        for term in element.viscoelastic:
            at = getattr(term.material, "at", None)
            if at is None:
                raise ValueError(
                    f"part {part!r}: {type(term.material).__name__} has no shift law; use a Maxwell model "
                    f"with one"
                )
            try:
                moved.append(replace(term, material=at(T)))
            except ValueError as error:
                raise ValueError(f"part {part!r} at {T} °C: {error}") from None
        self.plan.parts[part] = replace(element, viscoelastic=tuple(moved))
        self.plan.temperatures[part] = T


def _hung(
    name: str,
    bearing: BallBearing | RowSet,
    ends: tuple[Place, Place],
    offset: float,
    mirrored: bool,
) -> list[BearingJoint]:
    """The joints of one bearing, or one for each row of a set."""
    if not isinstance(bearing, RowSet):
        joint = BearingJoint(name, bearing, *ends, offset)
        return [replace(joint, bearing=bearing.mirrored())] if mirrored else [joint]
    rows = [row.reversed() for row in reversed(bearing.rows)] if mirrored else bearing.rows
    joints = []
    for k, row in enumerate(rows, 1):
        own, lift = row.hung(bearing.row)
        whole = BearingJoint(f"{name}-{k}", own, *ends, offset)  # checks the offset
        joints.append(replace(whole, offset=whole.offset + lift, place=row.place))
    return joints
