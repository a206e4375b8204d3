"""What a bearing model can tell of a spall: the rig of Case Western Reserve University, two records.

The rig's drive end 6205 has a spall of 0.007 in on one race. The model is a rotor in that bearing,
thrust by the other one's spring, and a housing of five vertical modes that an accelerometer on top feels.
Thrust, clearance and the weight on the bearing are estimates, from the frequencies of the lines and the
size of the motor; the modes' frequencies, damping and gains, and the noise, are fitted to the record of
the OUTER race's spall (`fit`). The record of the INNER race's spall is then predicted, not fitted: each
line absolutely, and against the ball pass line itself, as its sidebands are told (.11 of it).

Run it as `python examples/cwru.py`; `--data FOLDER` names the folder with outer_007.npz and
inner_007.npz, each with drive_end (g), sampling_Hz and rpm, as made from the Bearing Data Center's
records. Without them the example works on signals that it makes itself, and says so. `--fit` fits anew,
`--records N --store FOLDER` writes N labelled records for training, each with its seed and truth.
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

import bearingdyn as bd
from bearingdyn import study

RATE = 12_000.0  # Hz, of the records
MORE = 20  # steps of the march in one sample: 4.2 µs, 25 in the passage of a ball over 0.18 mm
G = 9.80665
SENSOR = "housing.top.y.acceleration"
BAND = (2000.0, 5500.0)  # Hz, of the envelope: the housing's modes
INCH = 25.4e-3
SPALL = 0.007 * INCH  # m, across; 0.011 in deep, which no ball reaches
DATA = Path(__file__).parents[2] / "shared" / "data" / "cwru"
LEVELS = tuple(range(2400, 4300, 100))  # Hz, edges of the bands whose levels are fitted
# Hz, of the envelopes whose lines are fitted: of all modes, and of each group, where they show its decay
FITTED = (BAND, (2450.0, 3050.0), (3100.0, 3450.0), (3450.0, 3950.0))
PATHS = tuple(range(2000, 5500, 250))  # Hz, edges of bands in which the two records are compared
SIDEBANDS = ("1-2", "1-1", "1+1", "1+2")
HARMONICS = 6  # of the ball pass, that are fitted in each


@dataclass(frozen=True)
class Rig:
    """The numbers of the model; the last four are fitted to the outer race's record."""

    weight: float = 50.0
    """N on the drive end: half of a 2 hp motor's rotor, and some of the coupling."""
    thrust: float = 50.0
    """N, of the fan end's spring washer; with the clearance it makes the angle that the lines show."""
    clearance: float = 10e-6
    """m, diametral: normal, less some interference."""
    mode_mass: float = 600.0
    """kg: seen from the bearing. So heavy that the housing does not give way at its resonances, where 6 kg
    would as much as the contacts: of the modes only what the sensor feels counts."""
    frequency: tuple[float, ...] = (2639.8, 2852.6, 3320.9, 3508.2, 3802.6)
    """Hz, of the housing's modes."""
    damping: tuple[float, ...] = (0.0376, 0.0231, 0.0169, 0.0299, 0.0234)
    gain: tuple[float, ...] = (0.6767, -0.8823, 1.0121, -1.2642, 0.4685)
    """1/kg, acceleration at the sensor for one newton far above the mode."""
    noise: float = 0.064
    """g rms at the sensor, white."""


def ball_bearing(rig: Rig, body: str | None, width: float, angle: float, scatter: float = 0.0, seed: int = 0):
    """The 6205, with a spall on a race (or none), its balls' diameters scattered by so much, m."""
    pits = [bd.Pit(body, angle, width, 0.011 * INCH)] if body else []
    sizes = np.random.default_rng(seed).normal(0.0, scatter, 9) if scatter else ()
    return bd.catalogue.bearing(
        "6205", clearance=rig.clearance, damping=100.0, defects=pits, oversize=tuple(sizes)
    )


def housing(rig: Rig) -> bd.Superelement:
    """Vertical modes in parallel: the bore moves by their sum, the sensor by their sum with the gains."""
    omega, m = 2 * math.pi * np.array(rig.frequency), rig.mode_mass
    k, n = m * omega**2, len(omega)
    T = np.zeros((n, 5 + n))  # modal coordinates from (x, y, z, θx, θy, θz of the bore, and modes 2 … n)
    T[0, 1], T[0, 6:] = 1.0, -1.0
    T[1:, 6:] = np.eye(n - 1)
    M, C, K = (T.T @ np.diag(d) @ T for d in (np.full(n, m), 2 * np.array(rig.damping) * m * omega, k))
    for i, (mass, stiff) in enumerate(
        [(2 * m, 2 * k[-1]), (2 * m, 2 * k[-1]), (0.01, 1e6), (0.01, 1e6), (0.01, 1e6)]
    ):
        at = (0, 2, 3, 4, 5)[i]  # what the sensor does not feel
        M[at, at], K[at, at], C[at, at] = mass, stiff, 0.05 * math.sqrt(mass * stiff)
    top = np.zeros((3, 5 + n))
    top[1] = (np.array(rig.gain) * m) @ T
    return bd.Superelement(
        M=M, C=C, G=np.zeros_like(M), K=K, interfaces={"bore": np.arange(6)}, outputs={"top": top}
    )


def application(rig: Rig, ball: bd.BallBearing) -> bd.Application:
    """Rotor, drive end bearing, housing."""
    app = bd.Application()
    app.add("rotor", bd.RigidBody(3.0, (5e-3, 5e-3, 3e-3), rotating=True))
    app.ground("rotor.centre", [0, 0, 0, 2e4, 2e4, 0], [0, 0, 20, 1, 1, 0])
    app.add("housing", housing(rig))
    app.bearing("drive", ball, inner="rotor.centre", outer="housing.bore")
    app.load("rotor.centre", (0, -rig.weight, rig.thrust, 0, 0, 0))
    return app


def march(
    rig: Rig, ball: bd.BallBearing, rpm: float, seconds: float, channels: Sequence[str], more: int = MORE
) -> tuple[np.ndarray, dict[str, float]]:
    """The channels, a column each, in SI units, and the bearing's lines, Hz; `more` steps to a sample."""
    speed = rpm * math.pi / 30
    eq = bd.with_loaded_cages(bd.equilibrium(application(rig, ball)), speed)
    found = bd.transient(
        eq, speed=speed, dt=1 / RATE / more, steps=int(seconds * RATE) * more, settle=1500 * more,
        decimate=more, record=channels,
    )  # fmt: skip
    cage, shaft = eq.system.bearings[0].bearing.cage_ratio, rpm / 60
    lines = {"outer": 9 * cage * shaft, "inner": 9 * (1 - cage) * shaft, "shaft": shaft}
    return found.record.values, lines


def run(
    rig: Rig, ball: bd.BallBearing, rpm: float, seconds: float
) -> tuple[np.ndarray, np.ndarray, dict[str, float]]:
    """Acceleration at the sensor, g, without noise; the bearing's force, N; and its lines, Hz."""
    found, lines = march(rig, ball, rpm, seconds, [SENSOR, "drive.force.y"])
    return found[:, 0] / G, found[:, 1], lines


def envelope(signal: np.ndarray, band: tuple[float, float] = BAND) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies, Hz, and amplitudes of the spectrum of the envelope in a band, zero-to-peak."""
    sos = scipy.signal.butter(6, band, "bandpass", fs=RATE, output="sos")
    size = np.abs(scipy.signal.hilbert(scipy.signal.sosfiltfilt(sos, signal - signal.mean())))
    n = len(size)
    spectrum = np.abs(np.fft.rfft((size - size.mean()) * np.hanning(n), 8 * n)) * 4 / n
    return np.fft.rfftfreq(8 * n, 1 / RATE), spectrum


def peak(
    spectrum: tuple[np.ndarray, np.ndarray], frequency: float, width: float = 1.5
) -> tuple[float, float]:
    """Frequency, Hz, and amplitude of the largest line within `width` Hz."""
    f, size = spectrum
    near = np.abs(f - frequency) < width
    at = int(size[near].argmax())
    return float(f[near][at]), float(size[near][at])


def lines_of(signal: np.ndarray, body: str, near: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Name -> (frequency, amplitude) of the ball pass, its harmonics, and its sidebands at the shaft."""
    found, spectrum = {}, envelope(signal)
    base = peak(spectrum, near[body], 2.0)[0]
    for k in (1, 2, 3):
        for j in (0, -2, -1, 1, 2) if body == "inner" else (0,):
            found[f"{k}" + (f"{j:+d}" if j else "")] = peak(spectrum, k * base + j * near["shaft"])
    return found


def repeats(
    record: np.ndarray, body: str, near: Mapping[str, float], seconds: float = 1.0
) -> dict[str, tuple[float, float]]:
    """Line -> how far its level scatters from one piece of the record to the next, rms in dB, and how much
    lower it is in the whole record than in the pieces: what slip of the cage would spread."""
    count = int(len(record) / RATE / seconds)
    pieces = [lines_of(piece, body, near) for piece in np.array_split(record, count)]
    whole, found = lines_of(record, body, near), {}
    for name, (_, size) in whole.items():
        level = 20 * np.log10([piece[name][1] for piece in pieces])
        found[name] = float(level.std()), float(level.mean() - 20 * math.log10(size))
    return found


def statistics(signal: np.ndarray) -> tuple[float, float]:
    """Rms and kurtosis."""
    x = signal - signal.mean()
    return float(x.std()), float((x**4).mean() / x.var() ** 2)


def levels(signal: np.ndarray, edges: Sequence[float] = LEVELS) -> np.ndarray:
    """Rms in each of the bands between these frequencies, Hz."""
    f, power = scipy.signal.welch(signal, RATE, nperseg=512)
    return np.sqrt([power[(f >= a) & (f < b)].sum() * f[1] for a, b in itertools.pairwise(edges)])


def with_noise(rig: Rig, signal: np.ndarray, seed: int) -> np.ndarray:
    """The record as a sensor writes it."""
    return signal + np.random.default_rng(seed).normal(0.0, rig.noise, len(signal))


def felt(signal: np.ndarray, ball_pass: float) -> np.ndarray:
    """What is fitted, dB: harmonics of the ball pass in the envelopes of FITTED, and the levels."""
    harmonics = []
    for band in FITTED:
        spectrum = envelope(signal, band)
        base = peak(spectrum, ball_pass, 2.0)[0]
        harmonics += [peak(spectrum, k * base)[1] for k in range(1, HARMONICS + 1)]
    return 20 * np.log10(np.append(harmonics, levels(signal)))


def fit(rig: Rig, measured: np.ndarray, rpm: float) -> Rig:
    """Modes and noise that give levels and envelope lines of one record; the force stays as it is."""
    quiet = scipy.signal.welch(measured, RATE, nperseg=256)
    floor = float(np.median(quiet[1][(quiet[0] > 1500) & (quiet[0] < 2300)]))
    rig = replace(rig, noise=math.sqrt(floor * RATE / 2))
    _, force, lines = run(rig, ball_bearing(rig, "outer", SPALL, -math.pi / 2), rpm, 2.0)
    f = np.fft.rfftfreq(len(force), 1 / RATE)
    spectrum, n = np.fft.rfft(force - force.mean()), len(rig.frequency)
    aim = felt(measured[: len(force)], lines["outer"])
    # a line of all modes counts for two of a group; the first harmonics most
    weight = np.outer([2.0] + [1.0] * (len(FITTED) - 1), [1.0, 0.8, 0.6, 0.4, 0.4, 0.4]).ravel()
    weight = np.append(weight, np.full(len(LEVELS) - 1, 0.7))

    def answer(p: np.ndarray) -> np.ndarray:
        modes = sum(g * -(f**2) / (f0**2 - f**2 + 2j * z * f0 * f) for f0, z, g in p.reshape(n, 3))
        signal = np.fft.irfft(spectrum * modes, len(force)) / G
        return np.asarray(weight * (felt(with_noise(rig, signal, 7), lines["outer"]) - aim))

    start = np.column_stack([rig.frequency, rig.damping, rig.gain])
    # the modes that the spectrum shows, not any that would do
    least, most = start - [100, 0, 5], start + [100, 0, 5]
    least[:, 1], most[:, 1] = 0.005, 0.06
    found = scipy.optimize.least_squares(
        answer, start.ravel(), bounds=(least.ravel(), most.ravel()), x_scale=[50, 0.01, 0.3] * n,
        diff_step=1e-3, max_nfev=25,
    )  # fmt: skip
    f0, z, g = found.x.reshape(n, 3).T
    return replace(rig, frequency=tuple(f0.tolist()), damping=tuple(z.tolist()), gain=tuple(g.tolist()))


def load_records(folder: Path) -> dict[str, tuple[np.ndarray, float]] | None:
    """Body -> (record, g, and rpm); None where there are no data."""
    paths = {body: folder / f"{body}_007.npz" for body in ("outer", "inner")}
    if not all(path.exists() for path in paths.values()):
        return None
    found = {}
    for body, path in paths.items():
        with np.load(path) as data:
            found[body] = data["drive_end"].astype(float), float(data["rpm"])
    return found


def made_records(rig: Rig, seconds: float = 2.0) -> dict[str, tuple[np.ndarray, float]]:
    """The same from the model itself, with other modes and noise: where it must agree, and does."""
    other = replace(
        rig, frequency=tuple(1.004 * f for f in rig.frequency), gain=tuple(1.1 * g for g in rig.gain)
    )
    found = {}
    for seed, (body, rpm) in enumerate((("outer", 1750.0), ("inner", 1748.0))):
        signal, _, _ = run(other, ball_bearing(other, body, SPALL, -math.pi / 2), rpm, seconds)
        found[body] = with_noise(other, signal, seed), rpm
    return found


def compare(
    rig: Rig, records: Mapping[str, tuple[np.ndarray, float]], seconds: float = 4.0
) -> dict[str, dict[str, tuple[float, float, float]]]:
    """Print and return, by body and line: error of the frequency, of the amplitude, dB, and of the amplitude
    against that of line "1", dB. Key "force": the same of the inner race, of the bearing's force itself.
    """
    found: dict[str, dict[str, tuple[float, float, float]]] = {}
    path = {}
    for body, how in (("outer", "fitted"), ("inner", "predicted")):
        record, rpm = records[body]
        signal, force, near = run(rig, ball_bearing(rig, body, SPALL, -math.pi / 2), rpm, seconds)
        path[body] = levels(record, PATHS) / levels(force, PATHS)
        signal = with_noise(rig, signal, 7)
        theirs = lines_of(record, body, near)
        rms, kurtosis = zip(statistics(record), statistics(signal), strict=True)
        print(f"{body} race, {how}: rms {rms[0]:.3f} g, model {rms[1]:.3f}; ", end="")
        print(f"kurtosis {kurtosis[0]:.2f}, model {kurtosis[1]:.2f}")
        own = repeats(record, body, near)
        for key, what in ((body, signal), ("force", force)) if body == "inner" else ((body, signal),):
            mine = lines_of(what, body, near)
            level = 20 * math.log10(mine["1"][1] / theirs["1"][1])
            found[key] = {}
            for name in mine:
                (f, a), (f_mine, a_mine) = theirs[name], mine[name]
                off = 20 * math.log10(a_mine / a)
                found[key][name] = f_mine / f - 1, off, off - level
                if key == body:
                    print(
                        f"  line {name:>4} {f:8.2f} Hz {a:7.4f} g; model {f_mine:8.2f} Hz {a_mine:7.4f} g,",
                        end="",
                    )
                    print(f" {off:+5.1f} dB, against line 1 {off - level:+5.1f}", end="")
                    print("; the record by the second ±{:.1f}, spread {:+.1f}".format(*own[name]))
    told = ", ".join(f"{found['force'][name][2]:+.1f}" for name in SIDEBANDS)
    print(f"the force itself, no housing: sidebands {', '.join(SIDEBANDS)} against line 1 {told} dB")
    ratio = 20 * np.log10(path["inner"] / path["outer"])
    print("from the force to the sensor, record of the inner race over that of the outer one, dB:")
    print("  " + ", ".join(f"{f:.0f} Hz {x:+.1f}" for f, x in zip(PATHS, ratio, strict=False)))
    return found


def growth(rig: Rig, seconds: float = 1.0) -> dict[str, list[tuple[float, float]]]:
    """Rms, g, and kurtosis of the model as the spall grows: 7, 14, 21 thousandths of an inch."""
    found = {}
    for body in ("outer", "inner"):
        sizes = []
        for width in (0.007, 0.014, 0.021):
            signal, _, _ = run(rig, ball_bearing(rig, body, width * INCH, -math.pi / 2), 1750.0, seconds)
            sizes.append(statistics(with_noise(rig, signal, 7)))
        found[body] = sizes
    return found


# ------------------------------------------------------------------ records for training


def steps_in_a_sample(ball: bd.BallBearing, rpm: float) -> int:
    """Twenty steps while a ball runs over the spall, as `CoarseStep` asks; ten (8.3 µs) for the housing."""
    rolling = (1 - ball.cage_ratio) * rpm * math.pi / 30 * (ball.Dpw - ball.Dw) / 2  # m/s, on either race
    passage = min((pit.width / rolling for pit in ball.defects), default=math.inf)
    return max(10, math.ceil(1.01 * 20 / RATE / passage))


def labelled(case: Mapping[str, object]) -> dict[str, float]:
    """Write one record, and return its truth; called in each process of a study."""
    rng = np.random.default_rng(int(case["seed"]))  # type: ignore[call-overload]
    body = ("sound", "outer", "inner")[rng.integers(3)]
    width, rpm = float(rng.uniform(0.1e-3, 0.5e-3)), float(rng.uniform(1720, 1800))
    rig = Rig(
        weight=float(rng.uniform(30, 150)),
        thrust=float(rng.uniform(40, 120)),
        clearance=float(rng.uniform(6e-6, 14e-6)),
        frequency=tuple(f * float(rng.uniform(0.9, 1.1)) for f in Rig().frequency),
        noise=float(rng.uniform(0.02, 0.15)),
    )
    angle, seconds = float(rng.uniform(-math.pi, math.pi)), float(case["seconds"])  # type: ignore[arg-type]
    ball = ball_bearing(
        rig, None if body == "sound" else body, width, angle, 0.1e-6, int(rng.integers(2**31))
    )
    found, lines = march(rig, ball, rpm, seconds, [SENSOR], steps_in_a_sample(ball, rpm))
    record = with_noise(rig, found[:, 0] / G, int(rng.integers(2**31))).astype(np.float32)
    truth = {
        "class": float(("sound", "outer", "inner").index(body)),
        "width": 0.0 if body == "sound" else width,
        "angle": angle,
        "rpm": rpm,
        "weight": rig.weight,
        "thrust": rig.thrust,
        "clearance": rig.clearance,
        "noise": rig.noise,
        **{f"line {name}": f for name, f in lines.items()},
    }
    path = Path(str(case["folder"])) / f"{int(case['seed']):06d}.npz"  # type: ignore[call-overload]
    np.savez(path, drive_end=record, sampling_Hz=RATE, seed=int(case["seed"]), **truth)  # type: ignore[call-overload, arg-type]
    return truth


def write_records(count: int, folder: Path, seconds: float = 10.0) -> list[study.Case]:
    """So many labelled records on all cores; what is there already is not computed again.

    A record of 10 s is 1.5 to 4 s of one core's time, by the width of its spall.
    """
    folder.mkdir(parents=True, exist_ok=True)
    cases = [{"seed": seed, "seconds": seconds, "folder": str(folder)} for seed in range(count)]
    return study.sweep(labelled, cases, store=folder / "truth")


CAN_AND_CANNOT = """
What the model can tell: where the lines stand (a loaded cage, not the catalogue's ratio); which race it is;
and what the lines' sidebands are of the line. The thrust presses all balls, the weight those below a little
more, and the sensor feels the vertical part of a force that goes around: sidebands at twice the shaft's speed
of a third, at once of a tenth. The envelope of the bearing's force alone has all
four within 3 dB of those measured.
What it cannot: the level of the inner race's lines, 5 dB too high, and harmonics of it beyond the second.
That is not the record's own scatter: second by second the line repeats to 0.2 dB, the sidebands of the first
two harmonics to 1.3, and a line of ten seconds is as high as one of one within 0.4 dB (0.6 in the weakest):
no slip of the cage spreads them. Its harmonics fall twice as fast as the outer race's, 8 and 14 dB to the
second and the third (4 and 8), and the model's force has them 6 and 10 dB higher: its pulses are longer at
the sensor. Whether the path or the spall makes them so, one record from below cannot tell; one with the spall
elsewhere on the outer race would show what the sensor feels of a force from the side.
Both records are of one rig, but of two bearings: from the force to the sensor the inner one's has 9 dB less
at 3 to 3.5 kHz, 1 dB more at 2.5 and 8 dB more at 2 kHz than the outer one's, band by band and whatever the
modes. No one path of a vertical force fits both; harmonics hang on how its modes beat. What a spall's size
does to the level is not known either: the model has a trench across the race, the rig a hole 0.18 mm wide
under contacts 0.6 to 0.9 mm long, which may run beside it. Nor does the level tell 14 thousandths of an inch
from 21: the model has 0.53, 2.7 and 3.1 g at 7, 14 and 21 on the outer race, 0.41, 1.80 and 1.83 g on the
inner one.
"""


def main(arguments: list[str] | None = None) -> int:
    """Fit or take the fitted numbers, predict, and say what holds; returns the exit code."""
    parser = argparse.ArgumentParser(description="CWRU's rig: fitted to one record, predicting the other")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--fit", action="store_true")
    parser.add_argument("--records", type=int, default=0)
    parser.add_argument("--store", type=Path, default=Path("out/cwru_records"))
    given = parser.parse_args(arguments)
    if given.records:
        cases = write_records(given.records, given.store)
        failed = sum(case.error is not None for case in cases)
        print(f"{len(cases) - failed} records in {given.store}, {failed} failed")
        return int(failed > 0)
    rig, records = Rig(), load_records(given.data)
    if records is None:
        print(f"no measured records in {given.data}: the signals are MADE by the model, with other modes")
        records = made_records(rig)
    if given.fit:
        rig = fit(rig, *records["outer"])
        print(rig)
    compare(rig, records)
    for body, sizes in growth(rig).items():
        steps = ", ".join(f"{rms:.3f} g (kurtosis {kurtosis:.1f})" for rms, kurtosis in sizes)
        print(f"{body} race, model, 7, 14, 21 thousandths of an inch: {steps}")
    print(CAN_AND_CANNOT)
    return 0


if __name__ == "__main__":
    sys.exit(main())
