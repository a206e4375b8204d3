"""The housing of the rig, fitted to ONE record: the inner race's, whose spall pushes from all directions.

The record repeats itself, so that two thirds of its power stand in lines k·BPFI + j·shaft with steady phases.
First these complex lines are fitted: modes' frequencies and damping, the spall's place at the first sample,
and, linearly, the gains. Then the lines of the envelope and the levels, which also hold what wanders.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import scipy
from cwru_rig import BELOW, RATE, SPALL, Rig, ball_bearing, felt_at, run, with_noise
from cwru_signal import BAND, LEVELS, envelope, levels, peak

PASSES = np.arange(13, 35)  # k of the lines that are fitted: 2 to 5.5 kHz
SIDES = np.arange(-2, 3)  # j; a radial force turning with the ring is in ±1, an axial one in 0
COUNTS = np.array([0.5, 1.0, 0.7, 1.0, 0.5])  # of each side
# Hz, of the envelopes whose lines are fitted: of all modes, and of each group, where they show its decay
FITTED = (BAND, (2450.0, 3050.0), (3100.0, 3450.0), (3450.0, 3950.0))


def coherent(signal: np.ndarray, ball_pass: float, shaft: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and complex amplitudes (k, j) of the lines, at rates found near those given."""
    x = (signal - signal.mean()) * np.hanning(len(signal))
    f, size = np.fft.rfftfreq(8 * len(x), 1 / RATE), np.abs(np.fft.rfft(x, 8 * len(x)))

    def missed(rates: np.ndarray) -> float:
        at = np.outer(np.arange(16, 25), [rates[0]]) + rates[1] * np.array([-1, 1])
        return -float((np.interp(at, f, size) ** 2).sum())

    first = np.array([ball_pass, shaft])
    simplex = first + np.array([[0, 0], [0.01, 0], [0, 0.01]])
    rates = scipy.optimize.minimize(
        missed, first, method="Nelder-Mead", options={"initial_simplex": simplex, "xatol": 1e-5}
    ).x
    at = rates[0] * PASSES[:, None] + rates[1] * SIDES
    t = np.arange(len(x)) / RATE
    return at, np.array([[x @ np.exp(-2j * np.pi * q * t) for q in row] for row in at]) * 4 / len(x)


def fit_lines(rig: Rig, measured: np.ndarray, force: np.ndarray, near: dict[str, float]) -> tuple[Rig, float]:
    """Modes and gains by the complex lines, and the share of their power that is left unexplained."""
    shaft = near["shaft"]
    at, aim = coherent(measured, peak(envelope(measured), near["inner"])[0], shaft)
    pushes = [coherent(force[:, i], near["inner"], shaft)[1] for i in (0, 1)]
    k, j = np.meshgrid(PASSES, SIDES, indexing="ij")
    n, power = len(rig.frequency), float((np.abs(COUNTS * aim) ** 2).sum())

    def gains(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = np.exp(-2j * np.pi * k * p[-2] - 1j * j * p[-1])
        columns = []
        for f0, z in zip(p[:n], p[n : 2 * n], strict=True):
            one = replace(rig, frequency=(f0,), damping=(z,), gain=(1.0,), axial=(1.0,))
            columns += [
                (COUNTS * turn * h * push).ravel() for h, push in zip(felt_at(one, at), pushes, strict=True)
            ]
        A, b = np.array(columns).T, (COUNTS * aim).ravel()
        A, b = np.vstack([A.real, A.imag]), np.concatenate([b.real, b.imag])
        found = np.linalg.lstsq(A, b, rcond=1e-6)[0]
        return found, A @ found - b

    modes = np.concatenate([rig.frequency, rig.damping])
    places = [(t, s) for t in np.linspace(0, 1, 240, False) for s in np.linspace(0, 2 * np.pi, 24, False)]
    places.sort(key=lambda place: float(np.sum(gains(np.append(modes, place))[1] ** 2)))
    found = []
    for place in places[:3]:
        low = np.concatenate([modes[:n] - 100, np.full(n, 0.004), [place[0] - 0.2, place[1] - 2]])
        high = np.concatenate([modes[:n] + 100, np.full(n, 0.1), [place[0] + 0.2, place[1] + 2]])
        found.append(
            scipy.optimize.least_squares(
                lambda p: gains(p)[1], np.append(modes, place), bounds=(low, high), max_nfev=80,
                x_scale=np.concatenate([np.full(n, 30.0), np.full(n, 0.01), [2e-3, 0.2]]),
            )
        )  # fmt: skip
    best = min(found, key=lambda one: one.cost)
    y, z = gains(best.x)[0].reshape(n, 2).T
    fitted = replace(
        rig, frequency=tuple(best.x[:n].tolist()), damping=tuple(best.x[n : 2 * n].tolist()),
        gain=tuple(y.tolist()), axial=tuple(z.tolist()),
    )  # fmt: skip
    return fitted, 2 * best.cost / power


def felt(signal: np.ndarray, ball_pass: float, shaft: float) -> np.ndarray:
    """What is fitted then, dB: lines of the envelopes of FITTED, and the levels."""
    lines = []
    for band in FITTED:
        spectrum = envelope(signal, band)
        base = peak(spectrum, ball_pass, 2.0)[0]
        lines += [peak(spectrum, k * base + j * shaft)[1] for k in (1, 2, 3) for j in (0, -2, -1, 1, 2)]
    return 20 * np.log10(np.append(lines, levels(signal)))


def fit_envelope(rig: Rig, measured: np.ndarray, force: np.ndarray, near: dict[str, float]) -> Rig:
    """Modes and gains by the lines of the envelope and the levels, from those of `rig`."""
    count, n = len(force), len(rig.frequency)
    f, pushes = np.fft.rfftfreq(count, 1 / RATE), np.fft.rfft(force - force.mean(0), axis=0).T
    aim = felt(measured, near["inner"], near["shaft"])
    # a line of all modes counts for four of a group; the ball pass itself most
    line = np.array([2, 1.4, 1.4, 1.4, 1.4, 1.2, 0.8, 0.8, 0.8, 0.8, 0.8, 0.5, 0.5, 0.5, 0.5])
    weight = np.concatenate([line, *[0.25 * line] * (len(FITTED) - 1), np.full(len(LEVELS) - 1, 0.7)])

    def with_modes(p: np.ndarray) -> Rig:
        columns = (tuple(column) for column in p.reshape(n, 4).T.tolist())
        return replace(rig, **dict(zip(("frequency", "damping", "gain", "axial"), columns, strict=True)))

    def answer(p: np.ndarray) -> np.ndarray:
        own = with_modes(p)
        felt_by = sum(h * push for h, push in zip(felt_at(own, f), pushes, strict=True))
        signal = with_noise(own, np.fft.irfft(felt_by, count), 7)
        return np.asarray(weight * (felt(signal, near["inner"], near["shaft"]) - aim))

    start = np.column_stack([rig.frequency, rig.damping, rig.gain, rig.axial])
    least, most = start - [100, 0, 5, 5], start + [100, 0, 5, 5]
    least[:, 1], most[:, 1] = 0.004, 0.1
    found = scipy.optimize.least_squares(
        answer, start.ravel(), bounds=(least.ravel(), most.ravel()), x_scale=[50, 0.01, 0.3, 0.3] * n,
        diff_step=1e-3, max_nfev=25,
    )  # fmt: skip
    return with_modes(found.x)


def fit(rig: Rig, measured: np.ndarray, rpm: float, seconds: float = 3.0) -> Rig:
    """Noise, modes and gains of the inner race's record; the force stays as it is."""
    quiet = scipy.signal.welch(measured, RATE, nperseg=256)
    floor = float(np.median(quiet[1][(quiet[0] > 4800) & (quiet[0] < 5800)]))
    rig = replace(rig, noise=math.sqrt(floor * RATE / 2))
    _, force, near = run(rig, ball_bearing(rig, "inner", SPALL, BELOW), rpm, seconds)
    measured = measured[: len(force)]
    rig, left = fit_lines(rig, measured, force, near)
    print(f"of the power in the lines of the inner race's record, {100 * (1 - left):.0f} % are the model's")
    return fit_envelope(rig, measured, force, near)
