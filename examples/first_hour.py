"""Start here: from a DMA table to the response of a rotor, without and with rubber around its bearings.

Put in your own numbers: table, bearing, layer, shaft. SI units; z lies along the shaft, y is vertical. Run it
as `python examples/first_hour.py`; it writes the table, if there is none yet, and the picture to out/.
"""

from pathlib import Path

import bearingdyn as bd
from bearingdyn import plot

csv = Path("out", "my_rubber.csv")  # columns: frequency_Hz, temperature_C, G_storage_Pa, G_loss_Pa
csv.parent.mkdir(exist_ok=True)
if not csv.exists():
    csv.write_bytes(bd.sample_dma_path().read_bytes())  # made from a stated model, not measured
master = bd.master_curve(bd.read_dma(csv), T_ref=20.0)
# a load rests, and rubber gives more the longer it does: here for 60 s, which the data must reach
rubber = bd.fit_maxwell(master, n=5, band=(10.0, 5e3), pin=60.0, K=2e9, density=1150.0)
layer = bd.Layer(r_inner=0.026, r_outer=0.030, width=0.015, material=rubber)
ball = bd.BallBearing(Z=9, Dw=7.94e-3, Dpw=39.04e-3, fi=0.52, fo=0.53, clearance=10e-6, damping=30.0)
steps = [bd.Section(0.05, 0.025), bd.Section(0.10, 0.066), bd.Section(0.05, 0.025)]  # length, diameter
shaft = bd.Shaft(steps, seats={"left": 0.04, "right": 0.16}, points={"mid": 0.10})
responses = {}
for label, outer in (("no layer", "ground"), ("layer", "{}_layer.inner")):
    app = bd.Application()
    app.add("shaft", shaft)
    for side in ("left", "right"):
        if label == "layer":
            app.add(f"{side}_layer", layer)
            app.ground(f"{side}_layer.outer")
        app.bearing(side, ball, inner=f"shaft.{side}", outer=outer.format(side))
    app.load("shaft.mid", (0, -500, 200, 0, 0, 0))  # N: what hangs on the shaft, and an axial preload
    state = bd.equilibrium(app, after=60.0)
    responses[label] = frf = bd.frequency_response(state, range(10, 3001), ["shaft.mid.y"], ["shaft.mid.y"])
    level = abs(frf["response"]).sel(output="shaft.mid.y", input="shaft.mid.y")
    print(f"{label}: {level.max():.3g} m/N (zero-to-peak) at {level.idxmax():.0f} Hz")
axes = plot.frequency_response(responses, "shaft.mid.y", "shaft.mid.y", phase=True)
axes.figure.savefig("out/first_hour.png", dpi=130, bbox_inches="tight")
