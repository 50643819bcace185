"""Uniaxial crystals against closed forms, energy, reciprocity and Berreman's method."""

from __future__ import annotations

import numpy as np
import pytest

from pellucid import optics
from pellucid.optics import crystal

RNG = np.random.default_rng(5)
COUNT = 4000
CALCITE = 1.6584, 1.4864


def units(count: int = COUNT) -> np.ndarray:
    v = RNG.normal(size=(count, 3))
    return v / np.linalg.norm(v, axis=1, keepdims=True)


NORMAL, AXIS, OTHER = units(), units(), units()
TRAVELS = units()
TRAVELS *= -np.sign((TRAVELS * NORMAL).sum(1, keepdims=True))
N_1, N_2, N_3, N_4 = RNG.uniform(1.0, 2.6, (4, COUNT))


def test_the_walk_off_of_calcite() -> None:
    assert np.degrees(crystal.walk_off(np.cos(np.pi / 4), *CALCITE)) == pytest.approx(6.22, abs=0.005)
    np.testing.assert_allclose(crystal.walk_off([0.0, 1.0, -1.0], *CALCITE), 0.0, atol=1e-15)


def test_ray_and_wave_belong_together() -> None:
    p = crystal.extraordinary_momentum(TRAVELS, AXIS, N_1, N_2)
    np.testing.assert_allclose(crystal.crystal_hamiltonian(p, AXIS, N_1, N_2), 0.0, atol=1e-14)
    ray = crystal.extraordinary_ray(p, AXIS, N_1, N_2)
    ray /= np.linalg.norm(ray, axis=1, keepdims=True)
    angle = np.arccos(np.clip((ray * TRAVELS).sum(1), -1.0, 1.0))
    np.testing.assert_allclose(angle, crystal.walk_off((TRAVELS * AXIS).sum(1), N_1, N_2), atol=1e-7)
    np.testing.assert_allclose(crystal.momentum_of_ray(ray, AXIS, N_1, N_2), p, rtol=1e-12, atol=1e-12)
    index = crystal.extraordinary_index([1.0, 0.0], *CALCITE)
    np.testing.assert_allclose(index, CALCITE)


def incoming(kind: str) -> tuple:
    """Arguments of `split_modes` for light that comes from an isotropic medium, or as o or e from a crystal."""
    if kind == "isotropic":
        return N_1[:, None] * TRAVELS, np.full((COUNT, 2), 0.5), NORMAL, N_1, N_1, NORMAL
    if kind == "o":
        return N_1[:, None] * TRAVELS, np.tile([1.0, 0.0], (COUNT, 1)), NORMAL, N_1, N_2, AXIS
    p = crystal.momentum_of_ray(TRAVELS, AXIS, N_1, N_2)
    return p, np.tile([0.0, 1.0], (COUNT, 1)), NORMAL, N_1, N_2, AXIS


@pytest.mark.parametrize("kind", ["isotropic", "o", "e"])
@pytest.mark.parametrize("behind", ["isotropic", "crystal"])
def test_no_light_is_lost_at_an_interface(kind: str, behind: str) -> None:
    other = (N_3, N_3, NORMAL) if behind == "isotropic" else (N_3, N_4, OTHER)
    split = crystal.split_modes(*incoming(kind), *other)
    assert split.powers.min() >= 0.0
    np.testing.assert_allclose(split.powers.sum(1), 1.0, atol=1e-10)
    assert 0.05 < (split.valid == 0).any(1).mean() < 0.95, "total reflection is among the cases"
    assert (split.powers[split.valid == 0] == 0.0).all()


@pytest.mark.parametrize("kind", ["isotropic", "o", "e"])
def test_momenta_keep_their_tangent_and_rays_go_to_their_sides(kind: str) -> None:
    p, _, normal, *near = incoming(kind)
    split = crystal.split_modes(*incoming(kind), N_3, N_4, OTHER)
    waves = (split.reflected_o, split.reflected_e, split.transmitted_o, split.transmitted_e)
    sides = ((*near, 1.0), (*near, 1.0), (N_3, N_4, OTHER, -1.0), (N_3, N_4, OTHER, -1.0))
    for i, (wave, (n_o, n_e, axis, side)) in enumerate(zip(waves, sides, strict=True)):
        good = split.valid[:, i] == 1
        np.testing.assert_allclose(np.cross(wave - p, normal), 0.0, atol=1e-12)
        ray = crystal.extraordinary_ray(wave, axis, n_o, n_e) if i % 2 else wave
        assert (side * (ray * normal).sum(1))[good].min() >= 0.0
        length = (wave * ray).sum(1)
        np.testing.assert_allclose(length[good], 1.0 if i % 2 else (n_o**2)[good], rtol=1e-11)


def test_equal_indices_are_exactly_fresnel() -> None:
    reflectance = optics.fresnel_dielectric(-(TRAVELS * NORMAL).sum(1), N_1, N_3)
    for near, far in ((NORMAL, AXIS), (AXIS, NORMAL), (AXIS, OTHER)):
        light = N_1[:, None] * TRAVELS, np.full((COUNT, 2), 0.5), NORMAL
        split = crystal.split_modes(*light, N_1, N_1, near, N_3, N_3, far)
        np.testing.assert_allclose(split.powers[:, :2].sum(1), reflectance, atol=1e-10)
        bent = optics.refract(TRAVELS, NORMAL, N_1, N_3)
        expected = (N_3[:, None] * bent.direction)[bent.valid]
        np.testing.assert_allclose(split.transmitted_o[bent.valid], expected, atol=1e-12)
        np.testing.assert_allclose(split.transmitted_e[bent.valid], expected, atol=1e-12)


def test_normal_incidence_and_light_along_the_axis() -> None:
    down, up = np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0])
    across = crystal.split_modes(down, [0.5, 0.5], up, 1.0, 1.0, up, *CALCITE, np.array([1.0, 0.0, 0.0]))
    expected = [0.5 * (1.0 - ((n - 1) / (n + 1)) ** 2) for n in CALCITE]
    np.testing.assert_allclose(across.powers[2:], expected, rtol=1e-12)
    along = crystal.split_modes(down, [0.5, 0.5], up, 1.0, 1.0, up, *CALCITE, up)
    np.testing.assert_allclose(along.powers[2:], expected[0], rtol=1e-12)
    np.testing.assert_allclose(along.transmitted_o, along.transmitted_e, atol=1e-12)


def test_an_interface_is_the_same_seen_from_behind() -> None:
    """Reciprocity: as much of s and p goes into a wave of the crystal as comes back out of it into s and p."""
    into = crystal.split_modes(*incoming("isotropic"), N_3, N_4, OTHER)
    for wave, share, i in ((into.transmitted_o, [1.0, 0.0], 2), (into.transmitted_e, [0.0, 1.0], 3)):
        good = into.valid[:, i] == 1
        back = crystal.split_modes(
            -wave[good], share, -NORMAL[good], N_3[good], N_4[good], OTHER[good], N_1[good], N_1[good], NORMAL[good]
        )
        np.testing.assert_allclose(0.5 * back.powers[:, 2:].sum(1), into.powers[good, i], atol=1e-10)


def test_amplitudes_solve_the_boundary_conditions() -> None:
    """The same powers from a general solver of the four equations."""
    p, shares, normal, *near = incoming("e")
    split = crystal.split_modes(p, shares, normal, *near, N_3, N_4, OTHER)
    waves = [
        crystal.ordinary_wave(p, normal, 1.0, near[0]),
        crystal.extraordinary_wave(p, normal, 1.0, near[2], near[0], near[1]),
        crystal.ordinary_wave(p, normal, -1.0, N_3),
        crystal.extraordinary_wave(p, normal, -1.0, OTHER, N_3, N_4),
    ]
    fields = [
        crystal.ordinary_field(waves[0].p, waves[0].decay, normal, near[2]),
        crystal.extraordinary_field(waves[1].p, waves[1].decay, normal, near[2], near[0], near[1]),
        crystal.ordinary_field(waves[2].p, waves[2].decay, normal, OTHER),
        crystal.extraordinary_field(waves[3].p, waves[3].decay, normal, OTHER, N_3, N_4),
    ]
    columns = np.stack([s * (f.real + 1j * f.imaginary) for s, f in zip((1, 1, -1, -1), fields, strict=True)], -1)
    arriving = crystal.extraordinary_field(p, np.zeros(3), normal, near[2], near[0], near[1])
    amplitudes = np.linalg.solve(columns, -(arriving.real + 1j * arriving.imaginary)[..., None])[..., 0]
    fluxes = np.stack([crystal.normal_flux(f.real, f.imaginary) for f in fields], -1)
    arrives = crystal.normal_flux(arriving.real, arriving.imaginary)
    expected = np.abs(amplitudes) ** 2 * np.abs(fluxes / arrives[:, None]) * split.valid
    steep = -(TRAVELS * normal).sum(1) > 0.05
    np.testing.assert_allclose(split.powers[steep], expected[steep], atol=1e-9)


@pytest.mark.parametrize("theta_deg", [0.5, 35.0, 70.0])
@pytest.mark.parametrize("turn", range(3))
def test_energies_of_both_rays_are_those_of_berreman(theta_deg: float, turn: int) -> None:
    """Reflection and both transmitted modes of a crystal under air against pyelli."""
    elli = pytest.importorskip("elli")
    n_o, n_e = CALCITE
    axis = [(0.0, 0.6, 0.8), (1.0, 0.0, 0.0), (0.48, -0.64, 0.6)][turn]
    # pyelli: light travels to +z in the plane of x and z; the axis of a uniaxial material is turned from its z
    rotation = elli.rotation_v_theta(*_turn_of_z(np.array(axis)))
    back = elli.UniaxialMaterial(elli.ConstantRefractiveIndex(n_o), elli.ConstantRefractiveIndex(n_e))
    back.set_rotation(rotation)
    front = elli.IsotropicMaterial(elli.ConstantRefractiveIndex(1.0))
    found = elli.Experiment(elli.Structure(front, [], back), np.array([589.3]), theta_deg).evaluate(elli.Solver4x4)
    theta = np.radians(theta_deg)
    # its modes of the crystal, E_x, E_y, H_x, H_y each, and their fluxes along z
    delta = elli.Solver4x4.build_delta_matrix(np.array([np.sin(theta)]), back.get_tensor(np.array([589.3])))
    modes = elli.Solver4x4.transition_matrix_halfspace(delta)[0][:, [2, 0]]
    fluxes = np.real(modes[0] * modes[3].conj() - modes[1] * modes[2].conj())
    # the columns of its matrix are light that arrives as p and as s, of E = 1
    transmitted = (np.abs(found.jones_matrix_t[0]) ** 2 * fluxes[:, None] / np.cos(theta)).mean(axis=1)
    momenta = np.real([np.vdot(m, delta[0] @ m) / np.vdot(m, m) for m in modes.T])
    ordinary = np.argmin(np.abs(momenta - np.sqrt(n_o**2 - np.sin(theta) ** 2)))

    d, up = np.array([np.sin(theta), 0.0, np.cos(theta)]), np.array([0.0, 0.0, -1.0])
    ours = crystal.split_modes(d, [0.5, 0.5], up, 1.0, 1.0, up, n_o, n_e, np.array(axis)).powers
    assert ours[:2].sum() == pytest.approx(float(found.R_matrix[0].sum()) / 2, abs=1e-9)
    assert ours[2] == pytest.approx(transmitted[ordinary], abs=1e-9)
    assert ours[3] == pytest.approx(transmitted[1 - ordinary], abs=1e-9)


def _turn_of_z(axis: np.ndarray) -> tuple[np.ndarray, float]:
    """Rotation vector and angle (degrees) that turn z to an axis."""
    across = np.cross([0.0, 0.0, 1.0], axis)
    size = np.linalg.norm(across)
    return (across / size if size > 0 else np.array([1.0, 0.0, 0.0])), float(np.degrees(np.arctan2(size, axis[2])))


def test_pleochroism_is_what_complex_indices_say() -> None:
    """Against the imaginary part of p that solves p.Mp = 1 with n + i kappa, along the ray."""
    sigma_o, sigma_e = 300.0, 40.0
    k = 2.0 * np.pi / 589.3e-9
    p = crystal.momentum_of_ray(TRAVELS, AXIS, N_1, N_2)
    eps = 1e-6  # the strength of absorption, small enough for the first order
    n_o, n_e = N_1 + 0.5j * eps * sigma_o / k * 1e3, N_2 + 0.5j * eps * sigma_e / k * 1e3
    along, across = (AXIS * p).sum(1), (p * p).sum(1) - (AXIS * p).sum(1) ** 2
    # p grows by the factor 1 + i delta along itself: (1 + i delta)^2 (along^2/n_o^2 + across/n_e^2) = 1
    factor = 1.0 / np.sqrt(along**2 / n_o**2 + across / n_e**2)
    decay = 2.0 * k * factor.imag[:, None] * p
    expected = (decay * TRAVELS).sum(1) / (1e3 * eps)
    found = crystal.extraordinary_extinction(p, AXIS, N_1, N_2, np.full(3, sigma_o), np.full(3, sigma_e))
    np.testing.assert_allclose(found, np.repeat(expected[:, None], 3, 1), rtol=1e-5)
    ends = crystal.extraordinary_extinction(
        [[1.5, 0.0, 0.0], [0.0, 1.7, 0.0]], [1.0, 0.0, 0.0], 1.5, 1.7, np.full(3, 3.0), np.full(3, 5.0)
    )
    np.testing.assert_allclose(ends, [[3.0] * 3, [5.0] * 3])


# ---- inhomogeneous crystals ---------------------------------------------------------------------------------


def twisted(x: np.ndarray) -> tuple:
    """A crystal whose axis turns along z and whose indices vary across it."""
    angle = 3.0 * x[..., 2] + 0.5 * x[..., 0]
    zero, one = np.zeros_like(angle), np.ones_like(angle)
    axis = np.stack([np.cos(angle), np.sin(angle), zero], -1)
    turned = np.stack([-np.sin(angle), np.cos(angle), zero], -1)
    slope = np.stack([0.5 * one, zero, 3.0 * one], -1)
    n_o, n_e = 1.6 + 0.1 * x[..., 1], 1.5 - 0.05 * x[..., 0] ** 2
    grad_o = np.stack([zero, 0.1 * one, zero], -1)
    grad_e = np.stack([-0.1 * x[..., 0], zero, zero], -1)
    return n_o, n_e, axis, grad_o, grad_e, slope[..., :, None] * turned[..., None, :]


def run(steps: int, length: float = 1.0, iterations: int = 12) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x = np.array([[0.1, 0.2, 0.0], [0.0, -0.1, 0.3]])
    d = np.array([[0.3, 0.2, 0.93], [-0.6, 0.5, 0.62]])
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    n_o, n_e, axis, *_ = twisted(x)
    p = crystal.momentum_of_ray(d, axis, n_o, n_e)
    energies = []
    for _ in range(steps):
        x, p = crystal.hamiltonian_step(x, p, np.full(2, length / steps), twisted, iterations)
        n_o, n_e, axis, *_ = twisted(x)
        energies.append(np.abs(crystal.crystal_hamiltonian(p, axis, n_o, n_e)).max())
    return x, p, np.array(energies)


@pytest.mark.parametrize("iterations", [2, 3, 12])
def test_the_hamiltonian_step_is_of_second_order(iterations: int) -> None:
    truth = run(2000)[0]
    errors = [np.abs(run(steps, iterations=iterations)[0] - truth).max() for steps in (20, 40, 80)]
    assert 3.5 < errors[0] / errors[1] < 4.6 and 3.7 < errors[1] / errors[2] < 4.4, errors


def test_the_hamiltonian_is_kept_and_a_reversed_ray_returns() -> None:
    start = np.array([[0.1, 0.2, 0.0], [0.0, -0.1, 0.3]])
    coarse, fine = run(200, length=10.0)[2].max(), run(400, length=10.0)[2].max()
    assert fine < 6e-5 and 3.6 < coarse / fine < 4.4
    x, p, _ = run(40)
    for _ in range(40):
        x, p = crystal.hamiltonian_step(x, p, np.full(2, -1.0 / 40), twisted)
    np.testing.assert_allclose(x, start, atol=1e-12)


def test_the_force_is_the_gradient_of_the_hamiltonian() -> None:
    x, p = RNG.uniform(-0.3, 0.3, (50, 3)), 1.5 * units(50)
    n_o, n_e, axis, grad_o, grad_e, turning = twisted(x)
    along = np.einsum("...ij,...j->...i", turning, p)
    force = crystal.crystal_force(p, axis, n_o, n_e, grad_o, grad_e, along)
    h = 1e-5
    for i in range(3):
        step = h * np.eye(3)[i]
        ahead, behind = twisted(x + step), twisted(x - step)
        slope = crystal.crystal_hamiltonian(p, ahead[2], *ahead[:2]) - crystal.crystal_hamiltonian(
            p, behind[2], *behind[:2]
        )
        np.testing.assert_allclose(force[:, i], -slope / (2 * h), atol=1e-8)
