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
# # Which layer, then: soft enough to isolate, stiff enough to carry?
#
# A softer layer isolates better and sags more; a more lossy one calms the resonances. Drawn one by one such
# designs are guesses. Here twelve of them, four thicknesses with three rubbers of equal |G*| at 1 kHz, go
# through the motor; what remains are those that no other one beats in everything. `examples/layer_study.py`
# says what is computed for each: a new layer, the equilibrium, 1000 frequencies. Sag and strain are those
# after the load has rested for five minutes at 20 °C, which the data of the rubber reach.

# %%
import sys

from bearingdyn import plot

sys.path.insert(0, "../examples")
import layer_study
import motor

print("measured rubber" if motor.MEASURED.exists() else "measurement absent: the shipped sample (made)")

# %% [markdown]
# The designs are spread over as many processes as there are cores. With `store=` each finished case is kept
# under the hash of its inputs, and an interrupted study goes on where it stopped.

# %%
found = layer_study.table(
    thickness=[0.004, 0.006, 0.008, 0.011], width=[0.0255], loss_factor=[0.3, 0.45, 0.6]
)
found.drop_vars(["width", "error"]).to_dataframe()

# %% [markdown]
# ## What isolation costs

# %%
axes = plot.trade_off(found, "sag", "isolation", colour="loss_factor")
_ = axes.axvline(0.7e-3, color="0.5", linestyle=":")

# %% [markdown]
# ## Decision
#
# The air gap allows 0.7 mm of sag, and rubber that is to live strains by no more than 5 %. Among the designs
# that keep both, and that no other one beats, the one that isolates best.

# %%
allowed = found.isel(
    case=found["front"].values & (found["sag"].values <= 0.7e-3) & (found["strain"].values <= 0.05)
)
best = allowed.isel(case=int(allowed["isolation"].values.argmax()))
print(
    f"Take {best.thickness * 1e3:.0f} mm of the rubber with a loss factor of {best.loss_factor:.2f}.\n"
    f"The housing is {best.isolation:.1f} dB quieter, the shaft sags by {best.sag * 1e6:.0f} µm,\n"
    f"the layer strains by {best.strain:.1%} in five minutes, and the highest resonance gives "
    f"{best.peak * 1e9:.0f} nm/N.\n"
    f"{allowed.sizes['case']} of {found.sizes['case']} designs keep both limits and are not beaten."
)

# %% [markdown]
# ## Between the designs of a grid
#
# A grid says roughly where to look. From there gradients go: thickness, width, hardness and one more
# relaxation at 1 kHz (a more lossy mixture) move together until isolation cannot be had without more sag or
# strain. The bore of the housing stays as it is, and a steel sleeve on the ring fills what a thinner layer
# leaves. Two starts end at the same design; `layer_study.best` with more of them only confirms it.

# %%
optimum = layer_study.best(starts=2)
print(layer_study.told(optimum))

# %% [markdown]
# A limit that is reached has its price: what the next µm of air gap, or the next per cent of strain, would
# bring. That is what to talk about with those who set the limits.
