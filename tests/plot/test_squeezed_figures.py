"""Figures of squeezed bodies, pages of the rarer rubbers, and springs between parts in a drawing."""

from __future__ import annotations

import matplotlib
import numpy as np
import pytest

import bearingdyn as bd

matplotlib.use("Agg")
RUBBER = bd.Maxwell(G0=1e6, G=[1e6, 2e6], tau=[1e-3, 1e-4], K=2e9, density=1150.0)


def test_a_squeezed_ring_is_drawn_before_and_after_with_its_pressures() -> None:
    layer = bd.Layer(0.020, 0.024, 0.012, RUBBER, recess=1.2e-3)
    fitted = layer.assembled(squeeze=0.05)
    ax = bd.plot.squeezed_section(fitted)
    labels = ax.get_legend_handles_labels()[1]
    assert labels[0] == "before"
    assert labels[1:] == [f"{name}: {p / 1e6:.2f} MPa" for name, p in fitted.pressures.items()]
    assert ax.get_title(loc="left") == f"Squeezed by {fitted.force:.4g} N"
    # the largest radius before is the ring's; behind the squeeze, 5 % of 4 mm less
    lines = {line.get_label(): np.asarray(line.get_ydata(), dtype=float) for line in ax.get_lines()}
    dashed = [line for line in ax.get_lines() if line.get_linestyle() == "--"]
    assert max(float(np.max(line.get_ydata())) for line in dashed) == pytest.approx(24.0)
    outer = next(y for label, y in lines.items() if str(label).startswith("outer"))
    assert outer.max() == pytest.approx(24.0 - 0.05 * 4.0, rel=1e-6)
    # the colour's scale begins at no stretch, and ends at the largest drawn
    stretch = ax.collections[0].get_array()
    assert ax.collections[0].get_clim() == (1.0, pytest.approx(float(np.max(stretch))))


def test_a_pressed_pad_is_drawn_in_space() -> None:
    lines = [np.linspace(0.0, size, n + 1) for size, n in ((0.020, 3), (0.010, 2), (0.020, 3))]
    pad = bd.Solid(bd.box_mesh(*lines, element="hex20"), RUBBER, {"foot": "y-", "plate": "y+"})
    pressed = pad.assembled({"plate": (0.0, -0.0005, 0.0, 0.0, 0.0, 0.0)})
    ax = bd.plot.squeezed_solid(pressed)
    assert f"{pressed.force:.4g} N, {pressed.pressure / 1e6:.2f} MPa" in ax.get_title(loc="left")
    surface, ghost = ax.collections[0], ax.collections[-1]
    assert ghost.get_label() == "before"
    # a face of the boundary is a polygon: 2 (3·2 + 3·3 + 2·3)
    assert len(surface.get_facecolor()) == 42
    assert len({tuple(c) for c in np.round(surface.get_facecolor(), 3)}) > 5  # shaded by stretch and light


@pytest.mark.parametrize(
    ("rubber", "said"),
    [
        (
            bd.material.FractionalZener(G0=1e6, G_inf=1e8, tau=1e-5, alpha=0.5, K=2e9, density=1150.0),
            ("Fractional Zener", "1 MPa", "100 MPa", "0.5"),
        ),
        (
            bd.material.PowerLaw(modulus=3e6, exponent=0.1, frequency=100.0, K=2e9, density=1150.0),
            ("Power law", "|G*| at 100 Hz", "3 MPa", "0.1"),
        ),
        (
            bd.material.TabulatedModulus(
                [10.0, 100.0, 1e3], [1e6, 2e6, 3e6], [1e5, 3e5, 6e5], K=2e9, density=1150.0
            ),
            ("Tabulated", "3, 10 to 1000 Hz", "1150 kg/m³"),
        ),
    ],
    ids=["zener", "power law", "table"],
)
def test_the_rarer_rubbers_show_themselves(rubber: object, said: tuple[str, ...]) -> None:
    page = rubber._repr_html_()  # type: ignore[attr-defined]
    assert "storage and loss modulus over frequency" in page
    for text in said:
        assert text in page, text


def test_springs_between_parts_and_to_the_ground_are_drawn() -> None:
    app = bd.Application()
    app.add("rotor", bd.RigidBody.ring(0.01, 0.02, 0.03))
    app.add("frame", bd.RigidBody.ring(0.05, 0.06, 0.03))
    app.spring("rotor.centre", "frame.centre", [1e6] * 6)
    bare = len(app.draw(table=False).lines)
    app.spring("frame.centre", "ground", [1e6] * 6, damping=[10.0] * 6)
    ax = app.draw(table=False)
    assert len(ax.lines) > bare
    # the spring spans the gap from the rotor's outside at 20 mm to the frame's bore at 50 mm or beyond
    heights = [np.asarray(line.get_ydata(), dtype=float) for line in ax.lines]
    assert any(y.size > 4 and y.min() >= 19.9 and y.max() > 45.0 for y in heights)
