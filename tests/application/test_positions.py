"""Where parts stand, and which of them are free bodies."""

from __future__ import annotations

import numpy as np
import pytest

from bearingdyn.analysis import equilibrium, mode_shapes, modes
from bearingdyn.application import Application
from bearingdyn.cms import Superelement
from bearingdyn.parts import RigidBody, Section, Shaft


def positions(app: Application) -> dict[str, np.ndarray]:
    """Place to (3,) position, m, as the mode shapes carry it."""
    shapes = mode_shapes(app, modes(app, 8))
    return dict(zip(shapes.place.values.tolist(), shapes.position.values, strict=True))


@pytest.mark.parametrize("order", ["near first", "far first"])
def test_a_part_joined_at_its_second_place_stands_where_that_place_meets(order: str) -> None:
    """A shaft of 0.3 m, and one of 0.2 m whose right seat, 0.15 m on from its left, is joined to its end."""
    app = Application()
    app.add("a", Shaft([Section(0.3, 0.03)], seats={"left": 0.05, "right": 0.25}, f_max=3e3))
    second = Shaft([Section(0.2, 0.02)], seats={"left": 0.02, "right": 0.17}, points={"tip": 0.2}, f_max=3e3)
    app.add("b", second)
    ends = ("a.right", "b.right")
    app.spring(*(ends if order == "near first" else ends[::-1]), (1e8,) * 3 + (1e5,) * 3, (0.0,) * 6)
    app.ground("a.left", stiffness=(1e8,) * 3 + (1e5,) * 3)
    app.free("b.left")
    at = positions(app)
    # from the first interface of the first part, a.left: along z by what the seats are apart
    wanted = {"a.left": 0.0, "a.right": 0.2, "b.right": 0.2, "b.left": 0.05, "b.tip": 0.23}
    for name, z in wanted.items():
        np.testing.assert_allclose(at[name], [0, 0, z], atol=1e-9, err_msg=name)


@pytest.mark.parametrize("held", [[0], [1, 2], [5]], ids=["x", "y and z", "θz"])
def test_a_part_held_in_one_direction_only_is_no_free_body(held: list[int]) -> None:
    """Its own stiffness resists that rigid motion, so it is no body that gravity moves freely."""

    class Held:
        def superelement(self) -> Superelement:
            K = np.zeros((6, 6))
            K[held, held] = 1e6
            return Superelement(
                M=np.eye(6), C=np.zeros((6, 6)), K=K, G=np.zeros((6, 6)), interfaces={"a": np.arange(6)}
            )

    app = Application()
    app.add("post", Held())
    app.ground("post.a", stiffness=(1e6,) * 6)
    app.gravity((0, -9.81, 0))
    with pytest.raises(ValueError, match="'post' has no rigid motion of its own"):
        equilibrium(app)


def test_a_part_that_nothing_holds_is_a_free_body() -> None:
    """The other side of the line: it sags by m g/k."""
    app = Application()
    app.add("post", RigidBody(2.0, (1e-2,) * 3))
    app.ground("post.centre", stiffness=(1e6,) * 6)
    app.gravity((0, -9.81, 0))
    assert equilibrium(app).displacement("post.centre")[1] == pytest.approx(-2 * 9.81 / 1e6, rel=1e-12)
