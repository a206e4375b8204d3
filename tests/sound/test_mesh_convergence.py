"""Bodies with edges on the panels that the program chooses, against finer ones and their far field."""

from __future__ import annotations

import math

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.analysis import Input, linear, part_velocities
from bearingdyn.cms import Skin
from bearingdyn.examples.paper import paper_pedestal
from bearingdyn.sound.radiators import Radiators
from spheres import SPEED, decibels

FINER = 0.6  # of the program's side; panels that are 2.8 times as many
TOLERANCE = 0.1  # dB, that the power may still change
FAR = 0.05  # dB, between the surface and the far field


def box_skin(sides: tuple[float, float, float], cells: int = 4) -> Skin:
    """A box of second-order triangles that moves as a rigid body, breathes, and bends its faces to ±y."""
    index: dict[tuple[float, ...], int] = {}

    def at(x: np.ndarray) -> int:
        return index.setdefault(tuple(np.round(x, 9) + 0.0), len(index))

    half, faces = 0.5 * np.array(sides), []
    for axis in range(3):
        for sign in (1, -1):
            u, v = [(axis + k) % 3 for k in ((1, 2) if sign > 0 else (2, 1))]
            for i in range(cells):
                for j in range(cells):
                    for three in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1))):
                        x = np.zeros((3, 3))
                        x[:, axis] = sign * half[axis]
                        x[:, u] = [half[u] * (2 * (i + a) / cells - 1) for a, _ in three]
                        x[:, v] = [half[v] * (2 * (j + b) / cells - 1) for _, b in three]
                        faces.append([at(y) for y in (*x, *(0.5 * (x + np.roll(x, -1, axis=0))))])
    points = np.array(list(index))
    bending = np.sin(np.pi * (points[:, 0] / sides[0] + 0.5)) * np.sign(points[:, 1])
    motions = np.zeros((len(points), 3, 5))
    motions[:, :, :3] = np.eye(3)
    motions[:, :, 3] = points / sides[0]
    motions[:, 1, 4] = bending
    return Skin(points, np.array(faces), motions.reshape(-1, 5), {})


def changes(skin: Skin, f: float, top: float, motions: np.ndarray) -> tuple[list[float], list[float]]:
    """By how much the power of each motion differs from that on finer panels, and from the far field's, dB.

    f: Hz. top: of its octave, Hz, by which the program chooses.
    """
    body = Radiators([skin], np.zeros((1, 3)))
    size = body.size(SPEED / top)
    (surface, rows), (fine, fine_rows) = body.surface(size), body.surface(FINER * size)
    found = bd.sound.solve(surface, rows, f, coarse=True)
    better = bd.sound.solve(fine, fine_rows, f, coarse=True)
    return (
        [decibels(found.power(v), better.power(v)) for v in motions],
        [decibels(bd.sound.far_power(found, v, order=32), found.power(v)) for v in motions],
    )


@pytest.mark.slow
@pytest.mark.parametrize("f", [572.0, 3000.0])
def test_a_box_on_the_programs_panels(f: float) -> None:
    """It moves along x, y and z, breathes and bends; at 572 Hz a wave is twice as long as the box."""
    change, far = changes(box_skin((0.3, 0.2, 0.15)), f, f, np.eye(5))
    assert change == pytest.approx(np.zeros(5), abs=TOLERANCE)
    assert far == pytest.approx(np.zeros(5), abs=FAR)


@pytest.mark.slow
@pytest.mark.parametrize(("f", "top"), [(100.0, 187.5), (3000.0, 3000.0), (4500.0, 6000.0)])
def test_the_demos_pedestal_on_the_programs_panels(f: float, top: float) -> None:
    """Moved by a force at its bore along x, y and z. A plate of 30 mm: what its edges do is a large part."""
    part = paper_pedestal(0.078).superelement()
    app = bd.Application()
    app.add("housing", part)
    app.ground("housing.feet")
    app.free("housing.bore")
    state = linear(app)
    inputs = [Input.of(state.system, f"housing.bore.{axis}") for axis in "xyz"]
    (velocity,) = part_velocities(state, state.system.parts[:1], np.array([f]), inputs)
    assert part.skin is not None
    change, far = changes(part.skin, f, top, velocity[0].T)
    assert change == pytest.approx(np.zeros(3), abs=TOLERANCE)
    assert far == pytest.approx(np.zeros(3), abs=FAR)


def test_panels_are_a_sixth_of_the_wavelength_and_a_sixteenth_of_the_body() -> None:
    """Which of the two is the smaller."""
    body = Radiators([box_skin((0.32, 0.2, 0.15), 1)], np.zeros((1, 3)))
    assert body.size(10.0) == pytest.approx(0.02)
    assert body.size(0.06) == pytest.approx(0.01)
    assert math.isclose(body.panels(0.05).surface.areas.sum(), 2 * (0.064 + 0.048 + 0.03), rel_tol=1e-9)
