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
# # Does a rubber layer make this motor quieter, and what does it cost?
#
# A motor on two 6305 bearings is too loud from 1 to 5 kHz: its housings follow what happens on the shaft. A
# ring of rubber between each outer ring and its housing should keep vibration out. By how much, with which
# rubber, and how far does the shaft give for it? This is the paper's section 4; `examples/motor.py` holds the
# machine.

# %%
import sys

import numpy as np

import bearingdyn as bd
from bearingdyn import plot

sys.path.insert(0, "../examples")
import motor
from layer_study import isolation

rubber, *_ = motor.rubber()
print("measured rubber" if motor.MEASURED.exists() else "measurement absent: the shipped sample (made)")
variants = {design.label: design for design in motor.designs(rubber)}
unloaded = {label: bd.equilibrium(motor.motor(design)) for label, design in variants.items()}
print(unloaded["layer, high loss"].system.n, "coordinates with layers")

# %% [markdown]
# ## In the frequency domain
#
# The bearings are linearised in the state they are in under the axial preload; the layers have the complex
# modulus of each frequency. The two rubbers are equally stiff at 1 kHz, one loses more.

# %%
frequency = np.linspace(10.0, 6000.0, 1500)
responses = {label: motor.response(eq, frequency) for label, eq in unloaded.items()}
axes = plot.frequency_response(responses, "shaft.end.y", motor.INPUT)

# %%
axes = plot.frequency_response(responses, "left_housing.top.y", motor.INPUT)

# %% [markdown]
# The shaft's own resonances fall with the layer, and further with more loss; the housing is quieter over most
# of the band, and between the resonances the more lossy rubber isolates less: loss is stiffness in
# quadrature.

# %%
H = {label: data["response"].values[:, :, 0] for label, data in responses.items()}
quieter = {label: isolation(frequency, h[:, 1:3], H["no layer"][:, 1:3]) for label, h in H.items()}
sag = {label: abs(h[0, 3]) for label, h in H.items()}
print(f"{'':<22}shaft at 10 Hz   housing from 1 to 5 kHz")
for label in H:
    print(f"{label:<22}{sag[label] * 1e9:6.1f} nm/N {quieter[label]:14.1f} dB quieter")

# %% [markdown]
# ## At 5000 rpm under 10 kN
#
# Nothing is linearised here: balls pass, some lose contact, and the layers remember by their Maxwell
# branches.

# %%
runs = {}
for label in ("no layer", "layer, high loss"):
    loaded = bd.equilibrium(motor.motor(variants[label], motor.RADIAL))
    runs[label] = motor.run(loaded, motor.ring_down(loaded))
axes = plot.orbit({label: bd.orbit(run, "shaft.middle.x", "shaft.middle.y") for label, run in runs.items()})

# %%
channel = "left_housing.top.y.velocity"
lines = {f"{k}× ball pass" if k > 1 else "ball pass": k * motor.ball_pass() for k in (1, 2, 3)}
axes = plot.spectrum({label: bd.spectrum(run, channel) for label, run in runs.items()}, lines, f_max=4e3)

# %%
velocity = {label: float(run["record"].sel(channel=channel).std()) for label, run in runs.items()}
balls = {label: int(run["record"].sel(channel="left.loaded").min()) for label, run in runs.items()}
for label in runs:
    print(
        f"{label:<18} housing {velocity[label] * 1e6:.1f} µm/s rms; at least {balls[label]} of 7 balls loaded"
    )

# %% [markdown]
# ## Decision

# %%
chosen = max(quieter, key=quieter.get)
calmer = 20 * np.log10(velocity["layer, high loss"] / velocity["no layer"])
print(
    f"Take the {chosen}: the housing is {quieter[chosen]:.0f} dB quieter from 1 to 5 kHz,\n"
    f"and its velocity at 5000 rpm falls by {-calmer:.0f} dB with the high-loss layer.\n"
    f"The price: at 10 Hz the shaft gives {sag[chosen] / sag['no layer']:.1f} times as much."
)
