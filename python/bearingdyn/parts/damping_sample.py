"""The damping sample: two metal rings with a layer bonded between them."""

from __future__ import annotations

from bearingdyn.checks import positive, vector
from bearingdyn.material import STEEL, Elastic
from bearingdyn.parts.regions import Region, ViscoelasticSolid
from bearingdyn.parts.revolved import Revolved
from bearingdyn.parts.revolved_faces import Cylinder


def damping_sample(
    material: Elastic | ViscoelasticSolid,
    radii: tuple[float, float, float, float] = (0.015, 0.0175, 0.020, 0.026),
    width: float = 0.011,
    metal: Elastic = STEEL,
    damping: float = 0.0,
    f_max: float = 0.0,
    refinement: float = 1.0,
) -> Revolved:
    """Two concentric metal rings with a layer bonded between them, the paper's damping sample (figure 3).

    Parameters
    ----------
    material
        Of the layer.
    radii
        Bore, inner bond, outer bond, outside, m. Interfaces "inner" (the bore) and "outer" (the outside) are
        rigid.
    width
        Along z, m.
    metal
        Of the rings.
    damping
        Ratio of every elastic mode.
    f_max
        Frequency, Hz, up to which modes are kept; 0: none.
    refinement
        Mesh density; 1 gives layer stiffnesses within some 0.02 %.

    Returns
    -------
    Revolved

    Raises
    ------
    ValueError
        For radii that do not rise.

    References
    ----------
    Paper section 3.4.

    Examples
    --------
    >>> import bearingdyn as bd
    >>> sample = bd.damping_sample(bd.Elastic(2.98e6, 0.49, 1200.0))  # G = 1 MPa
    >>> [round(float(f)) for f in sample.modes(0, 4).frequency[2:]]  # axial, torsion, Hz
    [840, 925]
    """
    width = positive("width", width, "it must be a positive length in m")
    half = (-0.5 * width, 0.5 * width)
    a, b, c, d = vector("radii", radii, (4,), "of the bore, the two bonds and the outside, m").tolist()
    return Revolved(
        (
            Region((a, b), half, metal),
            Region((b, c), half, material, graded=True),
            Region((c, d), half, metal),
        ),
        {"inner": Cylinder(a), "outer": Cylinder(d)},
        damping=damping,
        f_max=f_max,
        refinement=refinement,
    )
