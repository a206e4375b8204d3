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
# # Which Maxwell model does this rubber get?
#
# The laboratory sent frequency sweeps of a rubber at ten temperatures. The layer around a bearing will work
# from 10 Hz to 5 kHz, on a cold day at 20 °C and in a warm machine at 40 °C. Which points can be trusted, how
# many branches does the model need, and what does warmth do to the layer?

# %%
import math
import warnings
from pathlib import Path

import bearingdyn as bd
from bearingdyn import plot

# the measurement where it is kept beside the project, else the table that the package ships, which is made;
# put your own here
measured = Path("../../shared/data/epdm70/dma.csv")
source = measured if measured.exists() else bd.sample_dma_path()
table = bd.read_dma(source)
print("measured:" if measured.exists() else "the shipped sample (made):", source.name)
print(f"{table.frequency.size} points, {table.frequency.min():g} to {table.frequency.max():g} Hz")

# %% [markdown]
# ## Which points can be trusted?
#
# Storage and loss modulus of a causal material are tied: where G″ is much more than (π/2) dG′/d ln ω,
# something else than the rubber was measured, most often the fixture.

# %%
axes = plot.causality(table)

# %%
axes = plot.isotherms(table)

# %% [markdown]
# The ratio should stay near one. In the measured table it climbs steadily from some 20 Hz on, at every
# temperature: a resonance of the fixture, not the rubber. Those points are left out; time and temperature
# trade places, so the cold isotherms supply the high frequencies.

# %%
# the measurement is two runs, 5.6 % apart where they meet: both are wanted, and said to be; what the package
# says of their levels is printed
trusted = table.select(f_max=20.0, run=table.runs or None)
with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    master = bd.master_curve(trusted, T_ref=20.0)
print(*(warning.message for warning in told), sep="\n")
axes = plot.shifts(master)

# %%
warm = 10 ** float(master.law.log_shift(40.0))
print(f"shift law {type(master.law).__name__}: rms {master.law_residual:.2f} decades")
print(f"10 Hz at 40 °C lies at {10 * warm:.2g} Hz of the curve at 20 °C")

# %% [markdown]
# ## How many branches?
#
# The band of the fit must hold both temperatures: from 10 Hz at 40 °C to 5 kHz at 20 °C. More branches than
# the data can tell apart are of no use; the last line is what the best possible spectrum leaves.

# %%
band = (10 * warm, 5e3)
given = {"K": 2e9, "density": 1150.0}  # DMA measures neither
print("branches   G′ rms   tan δ rms")
for n in range(1, 7):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", bd.notice.FewerBranches)  # the table says it
        fitted = bd.fit_maxwell(master, n=n, band=band, **given)
    fit = fitted.fit
    if fitted.G.size < n:
        print(f"{n:5d}   the data hold {fitted.G.size}")
        break
    print(f"{n:5d} {fit.storage_rms:11.1%} {fit.tan_delta_rms:9.1%}")
print(f"  any {fit.floor[0]:11.1%} {fit.floor[1]:9.1%}")

# %%
rubber = bd.fit_maxwell(master, n="auto", tolerance=0.05, band=band, **given)
axes = plot.master(master, rubber)

# %% [markdown]
# ## Decision

# %%
omega = 2 * math.pi * 1e3
cold, hot = (rubber.at(T).complex_modulus(omega) for T in (20.0, 40.0))
softer = 1 - abs(hot) / abs(cold)
print(
    f"Take {rubber.G.size} branches: within {rubber.fit.storage_rms:.1%} of G′ and "
    f"{rubber.fit.tan_delta_rms:.1%} of tan δ (rms), {band[0]:.2g} Hz to {band[1] / 1e3:g} kHz at 20 °C.\n"
    f"At 1 kHz |G*| is {abs(cold) / 1e6:.2f} MPa at 20 °C; at 40 °C the layer is {softer:.0%} softer and\n"
    f"tan δ goes from {cold.imag / cold.real:.3f} to {hot.imag / hot.real:.3f}: design for both."
)
