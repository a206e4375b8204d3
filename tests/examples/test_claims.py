"""The paper's claims about its motor (sections 4.1 and 4.2), each an assertion on examples/motor.py.

The geometry is our own, for the paper gives none; what must hold are its statements. Those about the
damping-layer sample stand in test_damping_layer_sample.py.
"""

from __future__ import annotations

from functools import cache

import motor
import numpy as np
import pytest
import scipy.linalg
import xarray
from numpy.typing import NDArray

import bearingdyn as bd
from rotors import motor_rubber

BARE, LOW, HIGH = 0, 1, 2  # of motor.designs: no layer; layers of equal |G*| at 1 kHz, low and high loss
END_Y, HOUSING_Y, HOUSING_Z, MIDDLE_Y = range(4)  # of motor.OUTPUTS
BAND = np.linspace(1000.0, 5000.0, 4001)  # Hz, of the claims about the housing
FINE = np.geomspace(200.0, 7000.0, 8000)  # a step of 0.044 %; the sharpest peak is 2ζ = 0.36 % wide


@cache
def equilibrium(design: int, radial: float = 0.0) -> bd.Equilibrium:
    return bd.equilibrium(motor.motor(motor.designs(motor_rubber())[design], radial))


@cache
def level(design: int, fine: bool = False) -> NDArray[np.float64]:
    """|receptance| (frequency, output) to a vertical force at mid-shaft, m/N, over FINE or BAND."""
    response = motor.response(equilibrium(design), FINE if fine else BAND)["response"]
    return np.abs(response.values[:, :, 0])


@cache
def run(design: int) -> xarray.Dataset:
    eq = equilibrium(design, motor.RADIAL)
    return motor.run(eq, motor.ring_down(eq))


def peaks(frequency: NDArray[np.float64], h: NDArray[np.float64]) -> NDArray[np.intp]:
    """Where a curve has its resonances: higher than the lower of the minima beside it by 3 dB."""
    top = np.flatnonzero((h[1:-1] > h[:-2]) & (h[1:-1] > h[2:])) + 1
    low = np.flatnonzero((h[1:-1] < h[:-2]) & (h[1:-1] < h[2:])) + 1
    beside = [np.concatenate([low[low < i][-1:], low[low > i][:1]]) for i in top]
    kept = [i for i, m in zip(top, beside, strict=True) if m.size and h[i] > 2**0.5 * h[m].min()]
    return np.array(kept, dtype=np.intp)


def shaft_resonances(design: int) -> NDArray[np.float64]:
    """Frequencies, Hz, of the peaks of the shaft's end that are the shaft's own, not the pedestals'."""
    h = level(design, True)
    tops = peaks(FINE, h[:, END_Y])
    # at 703 Hz the layer-free pedestals rock and carry the shaft along, 6 nm/N beside their own 4
    return FINE[tops[h[tops, END_Y] > 5 * h[tops, HOUSING_Z]]]


def lowest(K: NDArray[np.float64], M: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """Undamped frequencies, Hz."""
    squares = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=(0, count - 1))
    return np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi)


class TestTheHarmonicResponse:
    """Section 4.1: "these eigenfrequencies will shift to lower values ... also the static stiffness"."""

    @pytest.mark.parametrize("design", [LOW, HIGH])
    def test_a_bending_resonances_fall_and_the_static_compliance_rises(self, design: int) -> None:
        bare, layered = shaft_resonances(BARE), shaft_resonances(design)
        pairs = list(zip(bare, layered, strict=False))
        print([f"{b:.0f} -> {a:.0f} Hz" for b, a in pairs])
        assert len(pairs) >= 7
        assert all(after < before for before, after in pairs)
        # the paper's four are among those of the bare motor
        for f in motor.bending_modes(equilibrium(BARE)):
            assert np.abs(bare / f - 1).min() < 1e-3
        # Rayleigh: rings locked to the bores of the same housings have no mode lower than those on the layers
        system = equilibrium(design).linearised()
        rows = [system.rows(f"{s}_ring.centre") - system.rows(f"{s}_housing.bore") for s in ("left", "right")]
        # N/m, and N m/rad at a radius of 3 cm: a thousand times the steel's own
        lock = sum(r.T @ (1e12 * np.array([1, 1, 1, 1e-3, 1e-3, 1e-3])[:, None] * r) for r in rows)
        free = lowest(system.stiffness(), system.M, 30)
        locked = lowest(system.stiffness() + lock, system.M, 30)
        # the spin of the shaft, at 0, is above it by round-off alone; 1 Hz covers that
        assert (free <= locked + 1.0).all()
        still = [
            abs(motor.response(equilibrium(k), [0.0])["response"].values[0, :, 0]) for k in (BARE, design)
        ]
        assert still[1][MIDDLE_Y] > 1.2 * still[0][MIDDLE_Y]

    def test_b_a_higher_loss_factor_lowers_the_resonance_peaks_further(self) -> None:
        bare, low, high = (level(k, True)[:, END_Y] for k in (BARE, LOW, HIGH))
        rubbers = [motor.designs(motor_rubber())[k].rubber for k in (LOW, HIGH)]
        omega = 2 * np.pi * FINE
        less, more = (np.asarray(m.loss_factor(omega)) for m in rubbers if m is not None)
        # the high loss is a relaxation put at 1 kHz: at 5.5 kHz the two rubbers differ by a fifteenth only
        tops = [i for i in peaks(FINE, low) if more[i] > 1.2 * less[i]]
        assert len(tops) >= 6
        for i in tops:
            near = (FINE > 0.85 * FINE[i]) & (
                FINE < 1.1 * FINE[i]
            )  # where the same peak of the other rubber is
            assert high[near].max() < low[i], f"peak at {FINE[i]:.0f} Hz"
        # against no layer: the highest peak, which is the first bending resonance, by more than ten
        assert low.max() < 0.25 * bare.max()
        assert high[FINE < 600].max() < 0.1 * bare.max()

    @pytest.mark.parametrize("design", [LOW, HIGH])
    @pytest.mark.parametrize("output", [HOUSING_Y, HOUSING_Z])
    def test_c_the_housing_moves_less_over_1_to_5_khz(self, design: int, output: int) -> None:
        bare, layered = level(BARE)[:, output], level(design)[:, output]
        rms = 10 * np.log10((layered**2).mean() / (bare**2).mean())
        mean = 20 * np.log10(layered / bare).mean()
        print(f"{motor.OUTPUTS[output]}: rms {rms:.1f} dB, mean of the curve {mean:.1f} dB")
        # the aim is 10 dB; both ways of averaging give it
        assert rms < -10.0
        assert mean < -10.0

    def test_d_between_resonances_a_high_loss_factor_isolates_worse(self) -> None:
        """Over 1-5 kHz, away from the layered motor's own resonances, for the housing's vertical motion.

        Below 1 kHz it is the other way round, and that is no contradiction: at equal |G*| at 1 kHz the rubber
        of higher loss rises more steeply with frequency, so below 1 kHz it is the softer one.
        """
        modes = bd.modes(equilibrium(LOW), damped=True)
        far = np.ones(BAND.size, dtype=bool)
        for f, zeta in zip(modes["frequency"].values, modes["damping_ratio"].values, strict=True):
            far &= np.abs(BAND - f) > 3 * zeta * f  # three half-widths: the resonance has fallen by 10 dB
        worse = 20 * np.log10(level(HIGH)[:, HOUSING_Y] / level(LOW)[:, HOUSING_Y])
        print(
            f"worse at {100 * (worse[far] > 0).mean():.0f} % of the frequencies between resonances, "
            f"by {np.median(worse[far]):.1f} dB in the median"
        )
        assert far.mean() > 0.3
        # the flanks of neighbouring resonances reach into what is left, hence not all of it
        assert (worse[far] > 0).mean() > 0.85
        assert np.median(worse[far]) > 0.5
        # while the mean square over all of the band, which resonances make, falls
        low, high = ((level(k)[:, HOUSING_Y] ** 2).mean() for k in (LOW, HIGH))
        assert high < low


# of the EPDM by its strain sweep: rubber.md's reference fit, F and L in Pa
PAYNE = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
COARSE = np.geomspace(200.0, 7000.0, 4000)  # 0.09 %; with layers the sharpest peak is 1 % wide


@cache
def softened(design: int, force: float, fine: bool) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """|receptance| (frequency, output) where the layers soften under this force, N, and their strains."""
    found = motor.designs(motor_rubber().with_payne(PAYNE))[design]
    frequency = COARSE if fine else BAND[::2]
    response = bd.frequency_response(
        bd.equilibrium(motor.motor(found)), frequency, [motor.INPUT], motor.OUTPUTS, amplitude=force
    )
    return np.abs(response["response"].values[:, :, 0]), response["strain"].values


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.BeyondSweep")  # at 1 kN: asserted below
@pytest.mark.parametrize("force", [1.0, 1000.0])
class TestTheHarmonicResponseWithSofteningLayers:
    """The same claims with the layers' stiffness by their own amplitude, at 1 N and at 1 kN of excitation."""

    def bare(self, fine: bool) -> NDArray[np.float64]:
        frequency = COARSE if fine else BAND[::2]
        return np.abs(motor.response(equilibrium(BARE), frequency)["response"].values[:, :, 0])

    @pytest.mark.parametrize("design", [LOW, HIGH])
    def test_a_bending_resonances_fall(self, force: float, design: int) -> None:
        def own(h: NDArray[np.float64]) -> NDArray[np.float64]:
            tops = peaks(COARSE, h[:, END_Y])
            return COARSE[tops[h[tops, END_Y] > 5 * h[tops, HOUSING_Z]]]

        bare, layered = own(self.bare(True)), own(softened(design, force, True)[0])
        pairs = list(zip(bare, layered, strict=False))
        print([f"{b:.0f} -> {a:.0f} Hz" for b, a in pairs])
        assert len(pairs) >= 7
        assert all(after < before for before, after in pairs)
        # What changes is told: below the isotherms' strain the first resonance hardly moves, at 1 kN it falls
        # on. The strain there, 14 and 8 %, is far beyond what the sweep tells.
        linear = shaft_resonances(design)[0]
        low, high = (-0.002, 0.01) if force == 1.0 else (-0.10, -0.03)
        assert low < layered[0] / linear - 1 < high
        strain = softened(design, force, True)[1].max()
        assert (strain < 3e-4) if force == 1.0 else (0.01 < strain < 0.2)

    def test_b_a_higher_loss_factor_lowers_the_resonance_peaks_further(self, force: float) -> None:
        bare = self.bare(True)[:, END_Y]
        low, high = (softened(k, force, True)[0][:, END_Y] for k in (LOW, HIGH))
        rubbers = [motor.designs(motor_rubber())[k].rubber for k in (LOW, HIGH)]
        omega = 2 * np.pi * COARSE
        less, more = (np.asarray(m.loss_factor(omega)) for m in rubbers if m is not None)
        tops = [i for i in peaks(COARSE, low) if more[i] > 1.2 * less[i]]
        assert len(tops) >= 6
        for i in tops:
            near = (COARSE > 0.85 * COARSE[i]) & (COARSE < 1.1 * COARSE[i])
            assert high[near].max() < low[i], f"peak at {COARSE[i]:.0f} Hz"
        assert low.max() < 0.25 * bare.max()
        assert high[COARSE < 600].max() < 0.1 * bare.max()

    @pytest.mark.parametrize("design", [LOW, HIGH])
    @pytest.mark.parametrize("output", [HOUSING_Y, HOUSING_Z])
    def test_c_the_housing_moves_less_over_1_to_5_khz(self, force: float, design: int, output: int) -> None:
        bare, layered = self.bare(False)[:, output], softened(design, force, False)[0][:, output]
        assert 10 * np.log10((layered**2).mean() / (bare**2).mean()) < -10.0
        assert 20 * np.log10(layered / bare).mean() < -10.0

    def test_d_between_resonances_a_high_loss_factor_isolates_worse(self, force: float) -> None:
        modes = bd.modes(equilibrium(LOW), damped=True)
        band = BAND[::2]
        far = np.ones(band.size, dtype=bool)
        for f, zeta in zip(modes["frequency"].values, modes["damping_ratio"].values, strict=True):
            far &= np.abs(band - f) > 3 * zeta * f
        low, high = (softened(k, force, False)[0][:, HOUSING_Y] for k in (LOW, HIGH))
        worse = 20 * np.log10(high / low)
        assert (worse[far] > 0).mean() > 0.85
        assert np.median(worse[far]) > 0.5
        assert (high**2).mean() < (low**2).mean()


class TestTheTransient:
    """Section 4.2: 5000 rpm, 180 N axial and 10 kN radial load, 100 000 steps."""

    def of(self, design: int, channel: str) -> NDArray[np.float64]:
        return np.asarray(run(design)["record"].sel(channel=channel).values)

    @pytest.mark.parametrize("design", [BARE, HIGH])
    def test_f_the_orbit_repeats_at_the_ball_pass_frequency(self, design: int) -> None:
        period = 1 / motor.ball_pass() / motor.STEP
        count = 90_000
        for channel in ("shaft.middle.x", "shaft.middle.y"):
            s = self.of(design, channel)
            later = np.interp(np.arange(count) + period, np.arange(s.size), s)
            # 3 % of the start's ring-down in the slowest mode is left, and little of it is in this channel
            assert np.abs(later - s[:count]).max() < 0.01 * np.ptp(s)
            # and not half a ball-pass later: it is the lowest frequency of the motion
            half = np.interp(np.arange(count) + period / 2, np.arange(s.size), s)
            assert np.abs(half - s[:count]).max() > 0.05 * np.ptp(s)

    @pytest.mark.parametrize("design", [BARE, HIGH])
    def test_f_the_orbit_is_not_symmetric_about_the_y_axis(self, design: int) -> None:
        """A symmetric orbit, mirrored, is the same curve."""
        period = round(1 / motor.ball_pass() / motor.STEP)
        x, y = (self.of(design, f"shaft.middle.{c}")[:period] for c in "xy")
        orbit = np.column_stack([x - 0.5 * (x.max() + x.min()), y])
        mirrored = orbit * [-1.0, 1.0]
        away = np.sqrt(((orbit[:, None] - mirrored[None, ::4]) ** 2).sum(-1)).min(axis=1).max()
        print(f"farthest from its mirror image: {away / np.ptp(x):.3f} of the orbit's width")
        # sampled every 2.5 µs, the polygon departs from the curve by less than 1e-3 of the width
        assert away > 0.02 * np.ptp(x)

    def test_f_the_layer_makes_the_motion_smoother(self) -> None:
        def above(design: int, channel: str) -> float:
            lines = bd.spectrum(run(design), channel)
            return float((lines["amplitude"].values[lines["frequency"].values > 2000.0] ** 2).sum())

        channels = ("shaft.end.y.velocity", "left_housing.top.y.velocity")
        fall = {c: 10 * np.log10(above(HIGH, c) / above(BARE, c)) for c in channels}
        print({c: f"{d:.1f} dB above 2 kHz" for c, d in fall.items()})
        assert fall["left_housing.top.y.velocity"] < -10.0
        # A finding against the paper: with the 1.8 MPa at rest that the data have, fewer balls carry and the
        # shaft's end is rougher by 4 dB; with the 4.7 MPa of a rubber that does not relax, smoother by 3.
        smoother = fall["shaft.end.y.velocity"] < -1.0
        assert smoother is not motor.MEASURED.exists()

    @pytest.mark.parametrize("design", [BARE, HIGH])
    def test_g_some_balls_lose_contact_under_the_radial_load(self, design: int) -> None:
        for side in ("left", "right"):
            loaded = self.of(design, f"{side}.loaded")
            assert 1 <= loaded.min() <= loaded.max() < 7

    def test_h_100_000_steps_resolve_4_hz(self) -> None:
        assert motor.STEPS == 100_000
        lines = bd.spectrum(run(HIGH), "shaft.middle.y")["frequency"].values
        # a line every 1/(N Δt), to round-off
        assert np.diff(lines) == pytest.approx(4.0, rel=1e-9)
