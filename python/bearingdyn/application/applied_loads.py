"""What acts on an application: forces at its places, unbalance, weight, and a ground that moves."""

from __future__ import annotations

from numpy.typing import ArrayLike

from bearingdyn.application.channel import GROUND
from bearingdyn.application.loads import Unbalance, in_time
from bearingdyn.application.place import GRAVITY
from bearingdyn.application.plan import Plan
from bearingdyn.units import takes

LOAD = ("N",) * 3 + ("N m",) * 3  # units of forces along the axes and moments about them


class AppliedLoads:
    """What acts on an application; every call is checked and written into the plan."""

    plan: Plan

    @takes(vector=LOAD, frequency="Hz", phase="rad", time="s")
    def load(
        self,
        where: str,
        vector: ArrayLike,
        *,
        frequency: float | None = None,
        phase: float = 0.0,
        time: ArrayLike | None = None,
        value: ArrayLike | None = None,
    ) -> None:
        """Apply a force and moment at an interface or point.

        Without the arguments after `vector` the load is constant. With `frequency` it is
        vector·cos(2π f t + phase), zero-to-peak. With `time` and `value` it is vector × value(time), linear
        between the samples; before and after, the end values hold.

        Parameters
        ----------
        where
            The place, "part.place".
        vector
            (6,) Fx, Fy, Fz, Mx, My, Mz in N and N m; at a point without rotation the moments must be zero.
        frequency
            f, Hz.
        phase
            rad.
        time, value
            (k,) s, increasing, and factors of the vector.

        Raises
        ------
        ValueError
            For an unknown place, a wrong shape, or an unsorted table.
        """
        place = self.plan.place(where)
        rows = self.plan.rows(place)
        load = in_time(place, vector, frequency, phase, time, value)
        if rows.shape[0] == 3 and load.vector[3:].any():
            raise ValueError(f"load at {where}: the point has no rotation, so its moment must be zero")
        self.plan.loads.append(load)

    @takes(moment="kg m", phase="rad")
    def unbalance(self, where: str, moment: float, phase: float = 0.0) -> None:
        """Apply an unbalance, which turns with the shaft.

        Parameters
        ----------
        where
            The place, "part.place".
        moment
            Mass × eccentricity, kg m.
        phase
            Angle from x at which it stands when the shaft stands at zero, rad.

        Raises
        ------
        ValueError
            For an unknown place or a negative moment.
        """
        place = self.plan.place(where)
        self.plan.rows(place)
        self.plan.loads.append(Unbalance(place, moment, phase))

    @takes(acceleration="m/s²")
    def gravity(self, acceleration: ArrayLike) -> None:
        """Give every part its weight.

        Parameters
        ----------
        acceleration
            (3,) of a falling body, m/s², such as (0, -9.81, 0).

        Raises
        ------
        ValueError
            For a wrong shape, or if there is gravity already.
        """
        if any(load.where == GRAVITY for load in self.plan.loads):
            raise ValueError("gravity is given already; one acceleration holds for all parts")
        self.plan.loads.append(in_time(GRAVITY, acceleration))

    @takes(acceleration="m/s²", frequency="Hz", phase="rad", time="s")
    def base_motion(
        self,
        acceleration: ArrayLike,
        *,
        frequency: float | None = None,
        phase: float = 0.0,
        time: ArrayLike | None = None,
        value: ArrayLike | None = None,
    ) -> None:
        """Move the ground, all of it together without turning.

        Everything is then reckoned relative to the moving ground, where each part feels −M R ü, R its rigid
        translation. This is exact, for the supports see the relative motion alone. Recorded motions are
        relative too.

        Parameters
        ----------
        acceleration
            (3,) m/s².
        frequency, phase, time, value
            Its course in time, as in `load`.

        Raises
        ------
        ValueError
            For a wrong shape or an unsorted table.
        """
        self.plan.loads.append(in_time(GROUND, acceleration, frequency, phase, time, value))
