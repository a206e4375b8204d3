"""Panels made for the skin of a part: they keep its shape, its flux and its sound."""

from __future__ import annotations

import math

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.cms import Skin
from bearingdyn.sound import TriangleSurface
from bearingdyn.sound.skin_panels import panelled
from spheres import SPEED, decibels, power, sphere


def sphere_skin(n: int) -> Skin:
    """A unit sphere of second-order triangles that pulsates, moves along y, and moves as P₂(y)."""
    corners, faces = sphere(n)
    points = list(corners / np.linalg.norm(corners, axis=1)[:, None])
    middles: dict[tuple[int, int], int] = {}
    rows = []
    for f in faces.tolist():
        row = list(f)
        for a, b in zip(f, (*f[1:], f[0]), strict=True):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append((points[a] + points[b]) / np.linalg.norm(points[a] + points[b]))
            row.append(middles[key])
        rows.append(row)
    u = np.array(points)
    motion = np.stack([u, np.tile([0.0, 1.0, 0.0], (len(u), 1)), u * (1.5 * u[:, 1:2] ** 2 - 0.5)], axis=2)
    return Skin(
        u,
        np.array(rows),
        motion.reshape(-1, 3),
        {"upper": np.flatnonzero(u[np.array(rows)][:, :, 1].min(axis=1) > -1e-9)},
    )


def errors(skin: Skin, size: float, ka: float) -> list[float]:
    panels = panelled(skin, size)
    surface = TriangleSurface(panels.points, panels.faces)
    R = bd.sound.solve(surface, panels.rows, ka * SPEED / (2 * np.pi)).resistance
    return [decibels(0.5 * R[j, j], power(j, ka)) for j in range(3)]


@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
@pytest.mark.parametrize("ka", [0.1, math.pi, 4.493409])
def test_spheres_on_the_programs_mesh_radiate_their_power(ka: float) -> None:
    """.007 dB seen on 532 panels made of 512 curved triangles."""
    assert np.abs(errors(sphere_skin(8), 0.25, ka)) == pytest.approx(0.0, abs=0.02)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::bearingdyn.notice.CoarsePanels")
@pytest.mark.parametrize("ka", [0.1, 0.3, 1.0, 2.081576, math.pi, 5.763459, 2 * math.pi, 8.0, 10.0])
def test_spheres_on_a_finer_mesh_of_the_program(ka: float) -> None:
    """A sixth of the wavelength is .105 at ka = 10, here .16; .004 dB seen."""
    assert np.abs(errors(sphere_skin(8), 0.16, ka)) == pytest.approx(0.0, abs=0.01)


def test_a_sphere_keeps_its_volume() -> None:
    panels = panelled(sphere_skin(6), 0.35)
    x = panels.points[panels.faces]
    volume = np.einsum("fi,fi->", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6
    assert volume == pytest.approx(4 * np.pi / 3, rel=3e-3)  # the curved triangles themselves lack 1e-4
    assert panels.shares["upper"] @ (
        0.5 * np.linalg.norm(np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), axis=1)
    ) == pytest.approx(2 * np.pi, rel=0.02)


@pytest.mark.parametrize("size", [0.04, 0.012])
def test_a_housing_keeps_its_shape_and_moves_as_one_body(size: float) -> None:
    """Coarser and finer than its elements; flux and first moments of a rigid motion are the volume's."""
    housing = bd.Housing(0.16, 0.20, 0.03, 0.078, bore_height=0.12, f_max=0.0)
    skin = housing.superelement().skin
    assert skin is not None
    panels = panelled(skin, size)
    surface = TriangleSurface(panels.points, panels.faces)
    longest = np.linalg.norm(np.diff(panels.points[panels.faces], axis=1), axis=2).max()
    assert longest < 1.5 * size
    x = surface.points[surface.faces]
    volume = np.einsum("fi,fi->", x[:, 0], np.cross(x[:, 1], x[:, 2])) / 6
    exact = (0.16 * 0.20 - math.pi * 0.039**2) * 0.03
    assert volume == pytest.approx(exact, rel=2e-3)  # the bore by chords
    rigid = np.zeros((skin.rows.shape[1], 3))
    for at in (0, 6):  # bore and feet
        rigid[at : at + 3] = np.eye(3)
    v = panels.rows @ rigid
    assert surface.areas @ v == pytest.approx(np.zeros(3), abs=1e-12)
    assert surface.middles.T @ (surface.areas[:, None] * v) == pytest.approx(
        exact * np.eye(3), abs=2e-3 * exact
    )
