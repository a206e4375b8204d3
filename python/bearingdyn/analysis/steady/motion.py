"""From the balance to what is asked for: coordinates, channels, signals, powers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from bearingdyn import core
from bearingdyn.analysis.dissipation import sinks
from bearingdyn.analysis.recordable_channels import CoreChannel
from bearingdyn.analysis.softening import softening_layers
from bearingdyn.analysis.steady.balance import Balance, Found, Pressed
from bearingdyn.types import Array, Complex

# times as many samples as the balance had, for powers and loads
FINER = 4
# samples of the signals of a motion with several base frequencies, at most
MOST_SAMPLES = 20_000

MOTIONS = tuple(core.CHANNEL_KINDS[q] for q in ("displacement", "velocity", "acceleration"))


@dataclass(frozen=True, eq=False)
class Motion:
    """A steady motion in all coordinates of its system."""

    balance: Balance
    found: Found

    @cached_property
    def x(self) -> Complex:
        """Amplitudes (L, n) of the coordinates."""
        b = self.balance
        n = b.system.n
        if b.rows is None or len(b.rows) != n:
            b = replace(b, rows=np.eye(n))
        return b.moved(self.found.z, self.found.pressed.g)

    @cached_property
    def films(self) -> Complex:
        """Amplitudes (L, m) of what films by frequency add to the bearings' forces."""
        b = self.balance
        return np.asarray((b.receptances.films(b.omega) @ self.found.z[:, :, None])[:, :, 0])

    @cached_property
    def fine(self) -> Pressed:
        """What the balls do, sampled more finely where one base allows it."""
        b = self.balance
        lines = b.lines.finer(FINER) if b.lines.index.shape[1] == 1 else b.lines
        return b.press(self.found.z, tangents=False, lines=lines)

    def times(self) -> Array:
        """One period, s; of several bases one of the slowest line, as far as samples allow."""
        b = self.balance
        slow, fast = np.abs(b.omega[1:]).min(initial=np.inf), np.abs(b.omega).max()
        if b.lines.index.shape[1] == 1:
            base = float(b.bases.frequencies(b.speed)[0])
            return np.asarray(np.arange(b.lines.samples) * (2 * np.pi / abs(base) / b.lines.samples))
        count = int(min(MOST_SAMPLES, np.ceil(8 * fast / slow)))
        return np.asarray(np.arange(count) * (2 * np.pi / (8 * fast)))

    def at(self, amplitudes: Complex, times: Array) -> Array:
        """Signals (t, k) of amplitudes (L, k)."""
        b = self.balance
        if b.lines.index.shape[1] == 1 and len(times) == b.lines.samples:
            return b.lines.signals(amplitudes)
        return np.asarray((np.exp(1j * times[:, None] * b.omega) @ amplitudes).real)

    def pressed_at(self, times: Array) -> tuple[core.Along, ...]:
        """What every bearing does at times, s."""
        b = self.balance
        z, rate = self.at(self.found.z, times), self.at(b.rates(self.found.z), times)
        out = []
        for term, own, turning in zip(b.system.bearings, b.slots, b.bases.bearings, strict=True):
            speeds = b.speed * np.array(turning.ratio)
            angles = times[:, None] * speeds
            angles[:, 0] += turning.angle0
            out.append(
                core.bearing_along(term.kernel(), z[:, own], rate[:, own], angles, speeds, tangents=False)
            )
        return tuple(out)

    def amplitudes(self, channels: Sequence[CoreChannel]) -> Complex:
        """(L, channels) of what a march would record."""
        b = self.balance
        lines = b.lines.finer(FINER) if b.lines.index.shape[1] == 1 else b.lines
        out = np.zeros((b.lines.count, len(channels)), dtype=np.complex128)
        for c, (kind, row, bearing, index) in enumerate(channels):
            if row is not None and kind in MOTIONS:
                out[:, c] = (1j * b.omega) ** MOTIONS.index(kind) * (self.x @ row)
            elif kind == core.CHANNEL_KINDS["strain"]:
                out[0, c] = self.strain_of(index)
            elif kind == core.CHANNEL_KINDS["force"]:
                at = b.slots[bearing].start + index
                out[:, c] = self.found.pressed.g[:, at] + self.films[:, at]
            else:
                out[:, c] = lines.amplitudes(_of_balls(kind, index, self.fine.bearings[bearing])[:, None])[
                    :, 0
                ]
        return out

    def signals(self, channels: Sequence[CoreChannel], amplitudes: Complex, times: Array) -> Array:
        """(t, channels) of the same."""
        out = self.at(amplitudes, times)
        plain = (*MOTIONS, core.CHANNEL_KINDS["force"], core.CHANNEL_KINDS["strain"])
        if any(kind not in plain for kind, *_ in channels):
            pressed = self.pressed_at(times)
            for c, (kind, _, bearing, index) in enumerate(channels):
                if kind not in plain:
                    out[:, c] = _of_balls(kind, index, pressed[bearing])
        return out

    def powers(self) -> tuple[dict[str, float], dict[str, float]]:
        """Mean powers, W: what feeds energy in, and what turns it into heat, by name.

        What presses the balls is heat in the mean, for what is elastic comes back; and it is known to the
        samples of the balance, while heat by itself leaves the samples' own error.
        """
        b, s, x = self.balance, self.balance.system, self.x
        velocity = 1j * b.omega[:, None] * x
        fed = {"loads": 0.0}
        for line, force in b.loads:
            fed["loads"] += 0.5 * float(np.real(np.vdot(force, velocity[line])))
        for term, own in zip(s.bearings, self.found.pressed.bearings, strict=True):
            fed[f"{term.name} (turning)"] = float(own.turning.mean())
        if s.N.any():
            circulatory = -b.speed * np.real(np.einsum("lj,lj->", (x @ s.N.T).conj(), velocity))
            fed["shaft's own damping (turning)"] = 0.5 * float(circulatory)
        lost = {}
        for sink in sinks(s):
            if sink.channel is None:
                lost[sink.name] = 0.5 * float((np.abs(velocity @ sink.rows.T) ** 2).sum())
            elif sink.channel[0] == core.CHANNEL_KINDS["contact_loss"]:
                at = b.slots[sink.channel[1]]
                moved = b.rates(self.found.z)[:, at]
                by_films = 0.5 * float(np.real(np.vdot(moved, self.films[:, at])))
                pressing = self.found.pressed.bearings[sink.channel[1]].pressing
                lost[sink.name] = float(pressing.mean()) + by_films
            else:
                lost[sink.name] = self._shear(sink.channel[2])
        return fed, lost

    def _shear(self, layer: int) -> float:
        """Mean power that the branches of a layer turn into heat, W: ω Im G*(ω) |Lᵀx|², η0 apart."""
        b = self.balance
        term = b.system.layers[layer]
        omega = np.abs(b.omega[1:])
        modulus = np.asarray(term.material.complex_modulus(omega))
        if term.strain is not None:
            number = softening_layers(b.system).index(layer)
            soft = self.found.pressed.softened
            modulus = modulus + term.material.payne.change(omega, soft.strain[number], soft.mean[number])
        loss = np.imag(modulus)
        loss = loss - omega * float(getattr(term.material, "eta0", 0.0))
        return float((omega * loss * (np.abs(self.x[1:] @ term.L) ** 2).sum(axis=1)).sum())

    def strain_of(self, layer: int) -> float:
        """Strain amplitude of a layer that softens, of the system's layers the one of this number."""
        number = softening_layers(self.balance.system).index(layer)
        return float(self.found.pressed.softened.strain[number])


def _of_balls(kind: int, index: int, along: core.Along) -> Array:
    """Samples of a channel that the balls make."""
    if kind == core.CHANNEL_KINDS["ball"]:
        return np.asarray(along.loads[:, index])
    if kind == core.CHANNEL_KINDS["loaded"]:
        return np.asarray(np.count_nonzero(along.loads > 0.0, axis=1), dtype=np.float64)
    return along.heat
