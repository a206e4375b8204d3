"""One ball between two equal contacts on oil, as a model of the core and as the parts it is made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bearingdyn import core
from bearingdyn.bearing import (
    BearingKernel,
    FilmAnswer,
    FilmDamping,
    Lubricant,
    PointContact,
    Walther,
    carried,
)
from bearingdyn.bearing.contact_damping import FILM_NODES

E, RX = 2.27e11, 10e-3  # E′, Pa, and Rx = Ry, m
OIL, TEMPERATURE = Lubricant(Walther.iso_vg(32), alpha=2.2e-8), 40.0
DISTANCE = 1e-3  # of the groove centres, m; of no effect


@dataclass(frozen=True)
class OneBall:
    """Contacts of M, L and D = 1: load F, N, and the law that the table of `ehl` makes."""

    F: float
    contact: PointContact
    law: FilmDamping
    kappa: float
    h0: float
    passage: float
    """a/um, s."""

    @classmethod
    def of(cls, M: float, L: float) -> OneBall:
        contact = PointContact(Rx=RX, Ry=RX, modulus=E / 2)
        speed = (L / (OIL.alpha * E)) ** 4  # η0 us/(E′Rx)
        us, F = speed * E * RX / OIL.viscosity(TEMPERATURE), M * E * RX**2 * speed**0.75
        answer = FilmAnswer(contact, contact, OIL, TEMPERATURE, us)
        kappa = F / (2 * contact.approach(F)) ** 1.5
        scale = (10 * answer.turning_load() / kappa) ** (2 / 3)
        w = np.linspace(0, 1, FILM_NODES)[1:-1]
        low, high = answer.loads()
        c = []
        for load in kappa * scale**1.5 * (w / (1 - w)) ** 3:
            c.append(answer.damping(min(max(load, low), high)) * min(load / low, 1.0) ** 3)
        law = FilmDamping(scale, [0.0, *c, c[-1]], answer, F)
        one, _ = answer._looked_up(F)
        return cls(F, contact, law, kappa, 2 * one.h0, answer.passages(F)[0])

    @property
    def viscous(self) -> BearingKernel:
        """One axial coefficient, which is the approach δ of the ball."""
        zero = np.zeros(1, np.intc)
        law, c, table = self.law.kernel_fields()
        return BearingKernel(
            Z=1,
            axial=np.ones(1, np.intc),
            order=zero,
            sine=zero,
            x0=DISTANCE,
            y0=0.0,
            A=DISTANCE,
            e0=0.0,
            kappa=self.kappa,
            h0=self.h0,
            damping_law=law,
            damping_c=c,
            damping_table=table,
        )

    @property
    def film(self) -> BearingKernel:
        """The same with films that remember."""
        return carried(self.viscous, self.law)

    @property
    def rest(self) -> float:
        """δ under F, m."""
        return (self.F / self.kappa) ** (2 / 3) - self.h0

    @property
    def stiffness(self) -> float:
        """Of the dry contacts under F, N/m."""
        return 1.5 * self.F / (2 * self.contact.approach(self.F))

    def march(
        self,
        kernel: BearingKernel,
        mass: float,
        load: Callable[[float], float],
        dt: float,
        steps: int,
        velocity: float = 0.0,
        **scheme: object,
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ − rest, m, and force, N, (steps,), of a mass, kg, under a load over time, N.

        From rest, or from a sudden velocity, m/s.
        """
        time = np.arange(8 * steps + 1) * dt / 8
        one, zero = np.ones((1, 1)), np.zeros((1, 1))
        sampled = (core.LOAD_KINDS["sampled"], 0.0, one[0], zero[0], time, np.array([load(t) for t in time]))
        channels = [(0, one[0], 0, 0), (core.CHANNEL_KINDS["ball"], None, 0, 0)]
        model = core.Model(
            mass * one, zero, zero, zero, zero, [], [(kernel.packed(), one)], [sampled], channels
        )
        start = model.state(0.0, np.array([self.rest]), np.array([velocity]))
        stepping = core.Stepping(dt, scheme=core.Scheme(tolerance=1e-13, **scheme))  # type: ignore[arg-type]
        rows, _, report = core.march(model, start, stepping, steps, 1, start=True)
        assert report.status == 0
        return rows[:, 0] - self.rest, rows[:, 1]
