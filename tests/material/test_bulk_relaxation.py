"""Loss in volume: a complex bulk modulus in the material, in layers and solids, and in both domains."""

from dataclasses import replace

import numpy as np
import pytest

import bearingdyn as bd
from bearingdyn.fem import box_mesh
from bearingdyn.material import volume_of

PLAIN = bd.Maxwell(1e6, [2e6], [1e-4], K=2e9, density=1150.0)
LOSS = bd.BulkRelaxation.of_loss_factor(0.02, (10.0, 1e4))
LOSSY = replace(PLAIN, bulk=LOSS)
THIN = {"r_inner": 0.020, "r_outer": 0.021, "width": 0.017}


def condensed(element, omega):
    """Stiffness of the 12 interface coordinates at ω, without inertia."""
    D = element.stiffness(omega)
    r, i = np.arange(12), np.arange(12, element.n)
    return D[np.ix_(r, r)] - D[np.ix_(r, i)] @ np.linalg.solve(D[np.ix_(i, i)], D[np.ix_(i, r)])


@pytest.mark.parametrize("eta", [0.005, 0.02, 0.1])
def test_the_loss_factor_is_constant_and_the_modulus_rises_as_kramers_and_kronig_demand(eta):
    f = np.geomspace(10.0, 1e4, 300)
    K = bd.BulkRelaxation.of_loss_factor(eta, (10.0, 1e4)).modulus(2e9, 2 * np.pi * f)
    np.testing.assert_allclose(K.imag / K.real, eta, rtol=0.03)  # as promised
    # a constant angle is a power law, |K*| ~ ω^(2/π · arctan η); the ends of the band feel what lies beyond
    inside = (f > 30.0) & (f < 3e3)
    slope = np.polyfit(np.log(f[inside]), np.log(np.abs(K[inside])), 1)[0]
    assert slope == pytest.approx(2 / np.pi * np.arctan(eta), rel=0.02)
    assert abs(bd.BulkRelaxation.of_loss_factor(eta, (10.0, 1e4)).modulus(2e9, 0.0) - 2e9) == 0.0


def test_times_in_volume_move_with_temperature_as_those_in_shear_do():
    warm = replace(LOSSY, law=bd.material.WLF(8.0, 120.0, 20.0), temperature=20.0).at(50.0)
    factor = warm.tau[0] / LOSSY.tau[0]
    w = 2 * np.pi * np.array([50.0, 700.0])
    np.testing.assert_allclose(warm.bulk_modulus(w / factor), LOSSY.bulk_modulus(w), rtol=1e-12)
    np.testing.assert_allclose(volume_of(warm).complex_modulus(w), warm.bulk_modulus(w), rtol=1e-12)


def test_it_is_written_read_and_part_of_what_makes_two_materials_equal():
    assert bd.Maxwell.from_json(LOSSY.to_json()) == LOSSY != PLAIN
    columns = bd.material.to_abaqus_frequency(LOSSY, [100.0]).splitlines()[-1].split(",")
    K = LOSSY.bulk_modulus(2 * np.pi * 100.0) / LOSSY.K
    assert [float(columns[2]), float(columns[3])] == pytest.approx([K.imag, 1 - K.real], rel=1e-8)
    with pytest.raises(ValueError, match="constant bulk modulus"):
        bd.material.to_ansys(LOSSY)


@pytest.mark.parametrize("component", [0, 2, 3, 5])
def test_the_loss_of_a_layer_is_its_stiffness_times_the_share_of_volume_to_first_order(component):
    # shear without loss, so that all loss is volume's: Im k = Im K · dk/dK, the slope from layers of real K
    elastic = bd.Maxwell(1e6, [], [], K=2e9, density=1150.0)
    w = 2 * np.pi * 300.0
    weak = bd.BulkRelaxation.of_loss_factor(1e-3, (10.0, 1e4))
    K = weak.modulus(2e9, w)
    k = bd.Layer(**THIN, material=replace(elastic, bulk=weak)).stiffness(w)[component, component]
    soft, hard = (
        bd.Layer(**THIN, material=replace(elastic, K=K.real * (1 + s))).stiffness()[component, component].real
        for s in (-1e-4, 1e-4)
    )
    slope = (hard - soft) / (2e-4 * K.real)
    # to the square of the loss factor and of the step, and torsion to round-off: it changes no volume
    assert k.imag == pytest.approx(K.imag * slope, rel=1e-4, abs=1e-9 * k.real)
    assert k.real == pytest.approx(0.5 * (soft + hard), rel=1e-6)


@pytest.mark.parametrize("thickness", [0.001, 0.004])
@pytest.mark.parametrize("frequency", [0.0, 100.0, 1000.0])
def test_the_superelement_has_it_between_its_shapes(thickness, frequency):
    layer = bd.Layer(r_inner=0.020, r_outer=0.020 + thickness, width=0.017, material=LOSSY)
    w = 2 * np.pi * frequency
    exact, reduced = layer.stiffness(w), condensed(layer.superelement(), w)
    # shapes are taken at K at rest, and K rises by 20 %: second order in it
    assert abs(reduced[0, 0] / exact[0, 0] - 1) < 1e-5
    assert abs(reduced[2, 2] / exact[2, 2] - 1) < 1e-5
    plain = condensed(bd.Layer(**{**THIN, "r_outer": 0.020 + thickness}, material=PLAIN).superelement(), w)
    if frequency:
        assert reduced[0, 0].imag > plain[0, 0].imag * (1.02 if thickness == 0.001 else 1.001)


def test_full_models_have_the_same_of_revolved_bodies_and_of_solids():
    w = 2 * np.pi * 500.0
    layer = bd.Layer(**THIN, material=LOSSY, refinement=0.5)
    model = layer.body.full_model()
    moduli = [complex(p.material.complex_modulus(w)) for p in model.viscoelastic]
    at = np.concatenate([f.dofs for f in model.interfaces.values()])
    u = np.zeros((model.n, 12), dtype=complex)
    u[at] = np.block([[f.T if i == j else np.zeros((len(f.dofs), 6)) for j in range(2)]
                      for i, f in enumerate(model.interfaces.values())])  # fmt: skip
    K = model.stiffness(moduli).tocsc()
    inner = np.setdiff1d(np.arange(model.n), at)
    from scipy.sparse.linalg import spsolve

    u[inner] = -spsolve(K[inner][:, inner], (K[inner] @ u))
    np.testing.assert_allclose((u.T @ (K @ u))[0, 0], layer.stiffness(w)[0, 0], rtol=1e-9)
    # a confined block, thin enough to be pressed as a whole: K + 4G/3 but for its edges, and its loss is K's
    stiff = replace(LOSSY, G0=3e8, G=[], tau=[])
    mesh = box_mesh([0.0, 0.15, 0.3], [0.0, 0.15, 0.3], [0.0, 3e-4], element="hex27")
    solid = bd.Solid(mesh, stiff, {"low": "z-", "high": "z+"}, moduli=(3e8,))
    k = solid.stiffness(w)[8, 8]
    confined = (stiff.bulk_modulus(w) + 4e8) * 0.09 / 3e-4
    assert k.real == pytest.approx(confined.real, rel=0.01)  # the edge gives over one thickness in a thousand
    assert k.imag == pytest.approx(confined.imag, rel=0.02)


def machine(material):
    app = bd.Application()
    app.add("layer", bd.Layer(**THIN, material=material))
    app.add("mass", bd.RigidBody(mass=20.0, inertia=(0.1, 0.1, 0.1)))
    app.connect("mass.centre", "layer.inner")
    app.ground("layer.outer")
    return app


def test_a_march_has_the_loss_of_the_harmonic_answer():
    # shear without loss: what damps the swing is volume alone
    app = machine(replace(LOSSY, G=[], tau=[]))
    name, hz, per = "mass.centre.x", 300.0, 200
    response = bd.frequency_response(app, [hz], [name], [name])["response"].values[0, 0, 0]
    assert response.imag < -1e-3 * abs(response)
    app.load("mass.centre", (100.0, 0, 0, 0, 0, 0), frequency=hz)
    state = bd.equilibrium(app)
    run = bd.transient(
        state, speed=0.0, dt=1 / hz / per, steps=10 * per, settle=1500 * per, record=[name], progress=False
    )
    x = 2 * np.mean(run.record.sel(channel=name).values * np.exp(-2j * np.pi * hz * run.time.values))
    # Newmark at 200 steps a period: (ωΔt)²/12 = 8e-5 of the inertia, which is .4 of the net stiffness here
    assert abs(x / (100.0 * response) - 1) < 2e-4
    assert x.imag / x.real == pytest.approx(response.imag / response.real, rel=2e-3)


def test_it_is_told_apart_from_shear_where_energies_are():
    app = machine(replace(LOSSY, G=[], tau=[]))  # shear without loss
    found = bd.modes(app, damped=True)
    shares = bd.energy_shares(app, found)
    assert {"layer (shear)", "layer (volume)"} <= set(shares["part"].values.tolist())
    swing = shares.isel(mode=int(np.abs(found["shape"].values[:, 0]).argmax()))
    np.testing.assert_allclose(swing["dissipation"].sel(part="layer (volume)"), 1.0, rtol=1e-9)
    np.testing.assert_allclose(swing["strain"].sum(), 1.0, rtol=1e-9)
    # its share in the radial stiffness, 14 %, at the modulus of the mode some more
    assert 0.1 < float(swing["strain"].sel(part="layer (volume)")) < 0.25
    assert bd.equilibrium(machine(LOSSY)).moduli == {"layer": 1e6}


def test_what_cannot_be_is_named():
    with pytest.raises(ValueError, match="share"):
        bd.BulkRelaxation([-0.1], [1.0])
    with pytest.raises(ValueError, match="as many values as share"):
        bd.BulkRelaxation([0.1, 0.1], [1.0])
    with pytest.raises(ValueError, match=r"at most 0\.2"):
        bd.BulkRelaxation.of_loss_factor(0.5, (1.0, 10.0))
    with pytest.raises(ValueError, match="squeezed body the bulk modulus must be constant"):
        bd.Layer(r_inner=0.02, r_outer=0.024, width=0.012, material=LOSSY).assembled(
            squeeze=0.02, inside="slip", outside="slip"
        )
