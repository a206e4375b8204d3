# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # What does one hear of a layer when the motor runs up?
#
# A sensor says by how many dB a housing moves less. An ear hears pressure, weighs it over frequency, and
# judges a run-up by its tones. Here the paper's motor (`bd.examples.paper_motor`), its bearings as wavy as
# good ones are, runs up from 500 to 6000 rpm; what its left and right pedestals radiate to a microphone a
# metre away becomes a file to listen to, without a layer and with one.

# %%
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import bearingdyn as bd
from bearingdyn import sound
from bearingdyn.bearing import WavinessSpectrum

rubber = bd.examples.rubber().with_relaxation(0.30, 2e3 * np.pi)  # tan δ 0.3 at 1 kHz
layers = {"no layer": None, "layer": bd.Layer(0.031, 0.039, 0.0255, rubber)}
waves = WavinessSpectrum(60e-9, exponent=1.5, order=2, scatter="rayleigh")
pair = [
    bd.catalogue.bearing(
        "6305",
        balls=7,
        clearance=10e-6,
        damping=30.0,
        waviness=(*waves.draw("inner", range(2, 31), seed), *waves.draw("outer", range(2, 31), seed + 1)),
    )
    for seed in (0, 10)
]
motors = {k: bd.examples.paper_motor(layer, 1000.0, bearings=pair) for k, layer in layers.items()}

# %% [markdown]
# ## The run-up
#
# Five motions of each outer ring are recorded, at 48 000 samples a second.

# %%
RATE, RUN = 48_000, 3.0  # samples a second; s of the run-up
MOTIONS = ("x", "y", "z", "θx", "θy")
SIDES = ("left", "right")
rings = [f"{side}_ring.centre.{k}" for side in SIDES for k in MOTIONS]
moved = {}
for label, motor in motors.items():
    run = bd.transient(
        bd.equilibrium(motor),
        rpm=([0.0, RUN], [500.0, 6000.0]),
        dt=1 / RATE / 4,
        steps=round(RUN * RATE) * 4,
        decimate=4,
        record=rings,
    )
    moved[label] = run["record"].values - run["record"].values.mean(axis=0)

# %% [markdown]
# ## From a ring to the ear
#
# Outside of the outer ring everything is linear: layer, pedestal and air. So the pressure at the microphone
# follows from the motion of the ring alone: pressure per force at the ring, over motion per force. Each
# pedestal is solved by itself; that one stands in the other's echo is left out.

# %%
frequency = np.arange(100.0, 3000.0, 1.0)
ear = np.array([1.0, 0.5, 0.24])  # m, from the left ring; the right one stands .487 m along the shaft
places = [ear, ear - [0.0, 0.0, 0.487]]
PANELS = 0.019  # m, a sixth of the shortest wave; the program's own 12.5 mm take ten times as long, for .1 dB
CACHE = Path("../out/radiation")  # what was solved once is read from there
heard = {}
for label, motor in motors.items():
    # the left pedestal, its ring and layer; the right one is like it
    half = bd.Application()
    half.add("ring", motor.plan.sources["left_ring"])
    half.add("housing", motor.plan.sources["left_housing"])
    half.ground("housing.feet")
    if layers[label] is None:
        half.connect("ring.centre", "housing.bore")
    else:
        half.add("layer", layers[label])
        half.connect("ring.centre", "layer.inner", fits=False)
        half.connect("layer.outer", "housing.bore")
    forces = [f"ring.centre.{k}" for k in MOTIONS]
    far = bd.sound_power(
        half, frequency, forces, ["housing.outside"], microphones=places, element_size=PANELS, cache=CACHE
    )
    near = bd.frequency_response(half, frequency, forces, forces)["response"].values
    # pressure (frequency, microphone, motion): P = G Y
    G = np.linalg.solve(near.transpose(0, 2, 1), far["pressure"].values.transpose(0, 2, 1)).transpose(0, 2, 1)
    heard[label] = {
        side: sound.pressure_signal(moved[label][:, 5 * k : 5 * k + 5], RATE, frequency, G[:, k])
        for k, side in enumerate(SIDES)
    }
pressure = {label: sum(paths.values()) for label, paths in heard.items()}

# %% [markdown]
# ## Listen
#
# Both are played at one scale. The file holds pascals: 32 bits, and what its full scale is.

# %%
n = np.arange(pressure["layer"].size)
fade = np.clip(np.minimum(n, n[::-1]) / 2400, 0.0, 1.0)  # 50 ms
loudest = max(np.abs(p * fade).max() for p in pressure.values())
bd.write_wav("../out/run_up.wav", [p * fade for p in pressure.values()], RATE, full_scale=1.25 * loudest)
try:
    from IPython.display import Audio, display
except ImportError:
    print("players need IPython; listen to out/run_up.wav")
else:
    for p in pressure.values():
        display(Audio(p[::2] * fade[::2] / loudest, rate=RATE // 2, normalize=False))

# %% [markdown]
# ## What is in it
#
# Orders rise with the speed, resonances stand still. Where they meet, one hears it.

# %%
figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True, layout="constrained")
for ax, (label, p) in zip(axes, pressure.items(), strict=True):
    power, f, t, image = ax.specgram(
        p / 20e-6, NFFT=4096, Fs=RATE, noverlap=3072, scale="dB", cmap="magma", vmin=-90, vmax=10
    )
    ax.set_ylim(0, 3000)
    ax.set_title(label)
    ax.set_xlabel("time, s (500 to 6000 rpm)")
axes[0].set_ylabel("frequency, Hz")
figure.colorbar(image, ax=axes, label="dB re 20 µPa, per Hz")

# %%
bands = {}
for label, p in pressure.items():
    lines, power = sound.mean_squares(p, RATE)
    inside = (lines > frequency[0]) & (lines < frequency[-1])
    bands[label] = sound.band_levels(lines[inside], power[inside], "pressure")
    print(f"{label:<10} {float(bands[label]['weighted_total']):6.1f} dB(A) over the run-up")
by_side = {
    label: {
        side: sound.level(np.std(sound.weighted_signal(p, RATE)), "pressure") for side, p in paths.items()
    }
    for label, paths in heard.items()
}
for label, sides in by_side.items():
    print(f"{label:<10} " + ", ".join(f"{side} {float(level):.1f} dB(A)" for side, level in sides.items()))

# %%
figure, ax = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
middle = bands["no layer"]["band"].values
shown = (middle > 110.0) & (middle < 2600.0)  # those that lie whole in the band
lowest = min(float(b["weighted_level"].values[shown].min()) for b in bands.values())
for k, (label, levels) in enumerate(bands.items()):
    level = levels["weighted_level"].values[shown]
    ax.bar(np.arange(level.size) + 0.4 * k, level - lowest + 3, 0.4, bottom=lowest - 3, label=label)
ax.set_xticks(np.arange(shown.sum()) + 0.2, [f"{b:g}" for b in middle[shown]], rotation=45)
ax.set_xlabel("third octave, Hz")
ax.set_ylabel("dB(A) re 20 µPa")
ax.legend()

# %% [markdown]
# ## Decision

# %%
fall = float(bands["no layer"]["weighted_total"] - bands["layer"]["weighted_total"])
by_band = (bands["layer"]["weighted_level"] - bands["no layer"]["weighted_level"]).values[shown]
worst = int(np.argmax(by_band))
most = {k: float(middle[shown][np.argmax(b["weighted_level"].values[shown])]) for k, b in bands.items()}
print(
    f"A metre away the run-up is {fall:.0f} dB(A) quieter with the layer.\n"
    f"The loudest third octave is {most['no layer']:g} Hz without and {most['layer']:g} Hz with it;\n"
    f"the layer helps least at {middle[shown][worst]:g} Hz: {by_band[worst]:+.0f} dB.\n"
    + ("Fit it: everybody hears ten dB." if fall > 10 else "Think of a softer one: ten dB are not reached.")
)
