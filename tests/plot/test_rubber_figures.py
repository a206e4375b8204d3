"""Figures of rubber as it is: its softening over strain, and the strain in a layer's section."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn import plot

LAW = bd.Payne(D=2.0344e6, gamma_c=3.588e-3, m=0.4817, Lm=0.1663e6, gamma_l=3.132e-3)
RUBBER = bd.Maxwell(4e6, [1e6], [1e-3], K=2e9, density=1150.0)


def test_the_law_runs_through_the_points_it_came_from():
    strain = np.geomspace(1.5e-3, 2e-2, 15)
    made = bd.StrainSweep(strain, 3e6 + LAW.storage(strain), 3e5 + LAW.loss(strain), 10.0)
    law = bd.fit_payne(made, strain_of_isotherms=1.5e-3, lowest_trusted=1.5e-3, D=LAW.D)
    upper = plot.strain_softening(law)
    lower = upper.figure.axes[1]
    for panel in (upper, lower):
        lines = {line.get_label(): line.get_data() for line in panel.lines}
        (x, curve), (points_x, points) = lines["law"], lines["sweep"]
        assert points_x == pytest.approx(100 * strain)
        # made by the law: what is left is the fit's own, and a straight line between 200 points
        assert np.interp(points_x, x, curve) == pytest.approx(points, rel=2e-3)
    assert upper.get_title(loc="left") == "Softening at 10 Hz"
    plt.close("all")
    with pytest.raises(ValueError, match="comes from no strain sweep"):
        plot.strain_softening(LAW)


def test_the_strain_of_a_long_thin_layer_in_shear_is_the_motion_over_its_thickness():
    """Turned about its axis a long ring shears by 2θ/(r²(1/ri² − 1/ro²)) at r, evenly along z."""
    ri, ro, turn = 0.020, 0.024, 1e-3
    layer = bd.Layer(ri, ro, 0.04, RUBBER)
    ax = plot.layer_strain(layer, (0, 0, 0, 0, 0, turn))
    (field,) = [c for c in ax.collections if c.get_array() is not None]
    at = np.array([path.vertices[:4].mean(axis=0) for path in field.get_paths()])
    middle = np.abs(at[:, 0]) < 10.0  # mm, away from the free ends
    r = 1e-3 * at[middle, 1]
    exact = 2 * turn / (r**2 * (1 / ri**2 - 1 / ro**2))
    # of elements some 0.3 mm across, whose mean over 1/r² is that of their middle to (h/r)²
    assert np.asarray(field.get_array())[middle] == pytest.approx(100 * exact, rel=2e-3)
    plt.close("all")
    with pytest.raises(ValueError, match="relative"):
        plot.layer_strain(layer, (0, 0, 0, 0, 0, 0))
