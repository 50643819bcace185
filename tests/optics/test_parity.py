"""The twins agree: every WGSL function against its float64 Python, where they are most likely to differ.

The Python side is given the arguments rounded to single precision, so that what is compared is the
arithmetic. A tolerance is a number of single-precision roundings (EPS) of the largest term, times
the conditioning of the formula where a comment says so.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from pellucid import optics

if TYPE_CHECKING:
    from collections.abc import Callable

    from pellucid.gpu import Device

pytest.importorskip("wgpu")

EPS = 2.0**-24
RNG = np.random.default_rng(11)


def single(array: Any) -> np.ndarray:
    """The values that single precision holds, in double."""
    return np.asarray(array, np.float32).astype(np.float64)


def interface_sweep() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cosines and index pairs: grazing, normal, around the critical angle, equal and nearly equal indices."""
    indices = [1.0, 1.0003, 1.333, 1.5, 2.417]
    rows = []
    for n_i, n_t in itertools.product(indices, indices):
        cosines = [0.0, 1e-7, 1e-4, 1e-2, *np.linspace(0.05, 1.0, 20)]
        if n_i > n_t:
            limit = np.arcsin(n_t / n_i)
            cosines += [np.cos(limit + e) for e in (-1e-2, -1e-4, 1e-4, 1e-2) if 0 < limit + e < np.pi / 2]
        rows += [(c, n_i, n_t) for c in cosines]
    rows += [(c, 1.5, 1.5 * (1 + 2.0**-20)) for c in (0.0, 1e-3, 0.5, 1.0)]
    cos_i, n_i, n_t = single(np.array(rows)).T
    return cos_i, n_i, n_t


COS_I, N_I, N_T = interface_sweep()
Q_SQUARED = optics.normal_momentum_squared(COS_I, N_I, N_T)
TERMS = np.abs((N_T - N_I) * (N_T + N_I)) + (N_I * COS_I) ** 2


def share_conditioning() -> np.ndarray:
    """How far rounding q^2 by EPS of its terms moves q = n_t cos_t, relative to n_i; large at the critical angle."""
    return TERMS / np.maximum(np.sqrt(np.abs(Q_SQUARED)), np.sqrt(EPS * TERMS) + 1e-12)


def decided() -> np.ndarray:
    """Rows whose side of the critical angle survives rounding; the others may fall either way."""
    return np.abs(Q_SQUARED) >= 8 * EPS * TERMS


def probed(device: Device, module: str, function: str, *arrays: Any) -> np.ndarray:
    from pellucid.gpu.probe import probe

    return probe(f"optics/{module}", function, *arrays, device=device)


def test_normal_momentum(device: Device) -> None:
    found = probed(device, "normal_momentum", "normal_momentum_squared", COS_I, N_I, N_T)
    # Either term is rounded three times, and their sum once.
    assert np.all(np.abs(found - Q_SQUARED) <= 4 * EPS * TERMS)


@pytest.mark.parametrize("function", ["fresnel_dielectric", "fresnel_schlick"])
def test_reflectance(device: Device, function: str) -> None:
    found = probed(device, "fresnel", function, COS_I, N_I, N_T)
    expected = getattr(optics, function)(COS_I, N_I, N_T)
    # dR/dq is at most 4/(n_i c) near the critical angle and dq is EPS times the conditioning.
    slope = 4.0 / np.maximum(N_I * COS_I + np.sqrt(np.abs(Q_SQUARED)), 1e-6)
    bound = 8 * EPS * (1.0 + slope * share_conditioning() * np.maximum(N_I, N_T))
    sure = decided()
    assert sure.sum() > 0.9 * sure.size
    assert np.isfinite(found).all() and found.min() >= 0.0 and found.max() <= 1.0 + 4 * EPS
    assert np.all(np.abs(found - expected)[sure] <= bound[sure])


def test_polarised_reflectance(device: Device) -> None:
    found = probed(device, "fresnel", "fresnel_polarised", COS_I, N_I, N_T)
    expected = optics.fresnel_polarised(COS_I, N_I, N_T)
    away = decided() & (np.abs(Q_SQUARED) > 1e-3)
    np.testing.assert_allclose(found["s"][away], expected.s[away], atol=2e-5)
    np.testing.assert_allclose(found["p"][away], expected.p[away], atol=2e-5)


def test_equal_indices_reflect_nothing_and_grazing_is_finite(device: Device) -> None:
    cosines = single([0.0, 1e-30, 1e-20, 1e-10, 1e-3, 1.0])
    found = probed(device, "fresnel", "fresnel_dielectric", cosines, 1.5, 1.5)
    np.testing.assert_allclose(found, 0.0, atol=1e-7)


def test_refraction_and_reflection(device: Device) -> None:
    azimuth = RNG.uniform(0, 2 * np.pi, COS_I.size)
    sine = np.sqrt(1 - COS_I**2)
    d = single(np.stack([sine * np.cos(azimuth), -COS_I, sine * np.sin(azimuth)], -1))
    up = np.array([0.0, 1.0, 0.0])
    found = probed(device, "snell", "refract", d, up, N_I, N_T)
    expected = optics.refract(d, up, N_I, N_T)
    sure = decided()
    np.testing.assert_array_equal(found["valid"][sure], expected.valid[sure])
    error = np.max(np.abs(found["direction"] - expected.direction), axis=-1)
    assert np.all(error[sure] <= (16 * EPS * (1.0 + N_I / N_T + share_conditioning() / N_T))[sure])
    assert np.isfinite(found["direction"]).all()
    np.testing.assert_allclose(np.linalg.norm(found["direction"], axis=-1), 1.0, atol=1e-3)
    np.testing.assert_array_equal(found["direction"][~found["valid"]], d[~found["valid"]])
    np.testing.assert_allclose(probed(device, "snell", "reflect", d, up), optics.reflect(d, up), atol=4 * EPS)


def test_equal_indices_do_not_bend(device: Device) -> None:
    cosines = single([0.0, 1e-6, 1e-3, 0.5, 1.0])
    d = single(np.stack([np.sqrt(1 - cosines**2), -cosines, 0 * cosines], -1))
    found = probed(device, "snell", "refract", d, [0.0, 1.0, 0.0], 1.333, 1.333)
    assert found["valid"].all()
    np.testing.assert_allclose(found["direction"], d, atol=4 * EPS)


def test_refraction_by_a_factor(device: Device) -> None:
    d, normal = single(UNITS[0]), single(UNITS[1])
    normal = np.where(np.sum(d * normal, axis=-1, keepdims=True) < 0.0, normal, -normal)
    factor = single(np.linspace(-0.4, 2.0, 64))
    found = probed(device, "refraction_factor", "refract_by_factor", d, normal, factor)
    expected = optics.refract_by_factor(d, normal, factor)
    np.testing.assert_array_equal(found["valid"], expected.valid)
    np.testing.assert_allclose(found["direction"], expected.direction, atol=2e-6)


NS = single(np.linspace(1.0, 2.6, 30))
VECTORS = single(RNG.normal(size=(4, 64, 3)))
SCALARS = single(RNG.uniform(0.1, 2.0, (4, 64)))
UNITS = single(VECTORS / np.linalg.norm(VECTORS, axis=-1, keepdims=True))
N_PAIR = single(RNG.uniform(1.2, 2.6, (2, 64)))
FIELDS = single(RNG.normal(size=(2, 64, 4)))
LAMBDAS = single(np.linspace(400.0, 700.0, 64))
LIGHT = single(np.abs(RNG.normal(size=(400, 3))) * 10.0 ** np.linspace(-4, 3, 400)[:, None])
BEYOND = single(RNG.normal(size=(400, 3)))
ENCODED = single(np.repeat(np.linspace(-0.1, 1.2, 300)[:, None], 3, axis=1))
SELLMEIER = single([1.03961212, 0.231792344, 1.01046945]), single([0.00600069867, 0.0200179144, 103.560653])

# module, function, arguments, relative and absolute tolerance
CASES: list[tuple[str, str, tuple[Any, ...], float, float]] = [
    # asin is an approximation on GPUs: WGSL grants it an absolute error of 2^-11
    ("snell", "critical_angle", (single(1.5), NS), 0.0, 2.0**-11),
    ("fresnel", "brewster_angle", (single(1.0), NS), 0.0, 1e-5),
    ("refraction_factor", "exact_factor", (COS_I[N_I <= N_T], N_I[N_I <= N_T], N_T[N_I <= N_T]), 1e-5, 3e-4),
    # sin is an approximation on GPUs: WGSL grants it an absolute error of 2^-11
    ("refraction_factor", "fitted_factor", (single(1.0), NS, single(np.linspace(0.0, 1.5, 30))), 0.0, 2.0**-10),
    ("refraction_factor", "opposite_factor", (SCALARS[0],), 1e-6, 1e-7),
    ("fresnel", "normal_reflectance", (single(1.5), NS), 1e-5, 1e-7),
    ("fresnel", "schlick", (single(0.04), single(np.linspace(0, 1, 50)), single(5.0)), 1e-5, 1e-7),
    ("attenuation", "transmittance", (np.abs(VECTORS[0]), 5 * SCALARS[0]), 2e-6, 1e-7),
    ("attenuation", "extinction_from_half_distance", (np.abs(VECTORS[0]), SCALARS[0]), 1e-6, 0.0),
    ("attenuation", "water_colour", (VECTORS[0], VECTORS[1], np.abs(VECTORS[2]), SCALARS[0]), 1e-5, 2e-6),
    ("phase", "henyey_greenstein", (single(np.linspace(-1, 1, 64)), single(np.linspace(-0.9, 0.9, 64))), 2e-6, 0.0),
    ("phase", "henyey_greenstein", (single([1.0, -1.0, 0.999]), single([0.99, -0.999, 0.99])), 1e-5, 0.0),
    ("dispersion", "cauchy", (LAMBDAS, single(1.5), single(0.004)), 1e-6, 0.0),
    ("dispersion", "sellmeier", (LAMBDAS, *SELLMEIER), 1e-6, 0.0),
    ("dispersion", "abbe_number", (single(1.5), single(1.75), single([1.25, 1.0])), 1e-6, 0.0),
    ("eikonal", "drift", (VECTORS[0], VECTORS[1], SCALARS[0]), 1e-6, 1e-6),
    ("eikonal", "kick", (VECTORS[0], SCALARS[0], VECTORS[1], SCALARS[1]), 1e-6, 2e-6),
    ("eikonal", "euler_position", (VECTORS[0], VECTORS[1], SCALARS[0], SCALARS[1]), 1e-6, 1e-5),
    ("eikonal", "euler_momentum", (VECTORS[0], VECTORS[1], SCALARS[0]), 1e-6, 1e-6),
    ("crystal", "extraordinary_index", (single(np.linspace(-1, 1, 64)), N_PAIR[0], N_PAIR[1]), 1e-6, 0.0),
    ("crystal", "extraordinary_momentum", (UNITS[0], UNITS[1], *N_PAIR), 2e-6, 1e-6),
    ("crystal", "extraordinary_ray", (VECTORS[0], UNITS[0], *N_PAIR), 1e-5, 2e-6),
    ("crystal", "momentum_of_ray", (UNITS[0], UNITS[1], *N_PAIR), 2e-6, 2e-6),
    # atan2 is an approximation on GPUs: WGSL grants it 4096 units in the last place
    ("crystal", "walk_off", (single(np.linspace(-1, 1, 64)), *N_PAIR), 2.0**-11, 1e-5),
    ("crystal", "crystal_hamiltonian", (VECTORS[0], UNITS[0], *N_PAIR), 1e-5, 2e-6),
    ("crystal", "crystal_force", (VECTORS[0], UNITS[0], *N_PAIR, *VECTORS[1:]), 1e-5, 1e-5),
    ("crystal", "extraordinary_extinction", (VECTORS[0], UNITS[0], *N_PAIR, *np.abs(VECTORS[1:3])), 1e-5, 1e-5),
    ("crystal", "normal_flux", (FIELDS[0], FIELDS[1]), 1e-5, 1e-5),
    ("colour", "srgb_encode", (ENCODED,), 1e-5, 1e-6),
    ("colour", "srgb_decode", (ENCODED,), 1e-5, 1e-6),
    ("colour", "luminance", (LIGHT,), 1e-6, 0.0),
    ("colour", "into_gamut", (LIGHT,), 1e-6, 0.0),
    ("colour", "into_gamut", (BEYOND,), 1e-5, 1e-6),
    ("colour", "tone_reinhard", (LIGHT,), 1e-6, 1e-7),
    ("colour", "tone_aces", (LIGHT,), 2e-5, 2e-6),
    # the curve's alternating coefficients sum to 40 times its value
    ("colour", "tone_agx", (LIGHT,), 1e-4, 1e-5),
    ("colour", "tone_khronos_neutral", (LIGHT,), 1e-5, 2e-6),
]


@pytest.mark.parametrize(
    ("module", "function", "arguments", "rtol", "atol"), CASES, ids=lambda v: v if isinstance(v, str) else ""
)
def test_twins(
    device: Device, module: str, function: str, arguments: tuple[Any, ...], rtol: float, atol: float
) -> None:
    python: Callable[..., np.ndarray] = getattr(optics, function)
    np.testing.assert_allclose(probed(device, module, function, *arguments), python(*arguments), rtol=rtol, atol=atol)


def test_cauchy_from_abbe(device: Device) -> None:
    found = probed(device, "dispersion", "cauchy_from_abbe", single([1.5, 1.9]), single([64.0, 21.0]))
    expected = optics.cauchy_from_abbe(single([1.5, 1.9]), single([64.0, 21.0]))
    np.testing.assert_allclose(found["a"], expected.a, rtol=1e-6)
    np.testing.assert_allclose(found["b_um2"], expected.b_um2, rtol=1e-5)


@pytest.mark.parametrize("kind", ["ordinary_wave", "extraordinary_wave"])
def test_waves_behind_an_interface(device: Device, kind: str) -> None:
    p, normal, axis = 1.5 * UNITS[0], UNITS[1], UNITS[2]
    side = single(np.where(np.arange(64) % 2, 1.0, -1.0))
    arguments = (N_PAIR[0],) if kind == "ordinary_wave" else (axis, *N_PAIR)
    found = probed(device, "crystal", kind, p, normal, side, *arguments)
    expected = getattr(optics.crystal, kind)(p, normal, side, *arguments)
    np.testing.assert_array_equal(found["valid"], expected.valid)
    np.testing.assert_allclose(found["p"], expected.p, atol=2e-5)
    np.testing.assert_allclose(found["decay"], expected.decay, atol=2e-5)


@pytest.mark.parametrize("kind", ["ordinary_field", "extraordinary_field"])
def test_fields_along_an_interface(device: Device, kind: str) -> None:
    p, normal, axis = 1.5 * UNITS[0], UNITS[1], UNITS[2]
    decay = single(normal * (np.arange(64) % 2)[:, None] * 0.4)
    arguments = (axis,) if kind == "ordinary_field" else (axis, *N_PAIR)
    found = probed(device, "crystal", kind, p, decay, normal, *arguments)
    expected = getattr(optics.crystal, kind)(p, decay, normal, *arguments)
    np.testing.assert_allclose(found["real"], expected.real, atol=5e-6)
    np.testing.assert_allclose(found["imaginary"], expected.imaginary, atol=5e-6)


@pytest.mark.parametrize("mode", [0, 1])
def test_split_modes(device: Device, mode: int) -> None:
    count = 8000
    directions, normals, near, far = (single(v) for v in np.random.default_rng(3).normal(size=(4, count, 3)))
    directions, normals, near, far = (
        single(v / np.linalg.norm(v, axis=1, keepdims=True)) for v in (directions, normals, near, far)
    )
    directions *= -np.sign((directions * normals).sum(1, keepdims=True))
    indices = single(np.random.default_rng(4).uniform(1.0, 2.6, (4, count)))
    momenta = indices[0][:, None] * directions
    if mode:
        momenta = optics.crystal.momentum_of_ray(directions, near, *indices[:2])
    shares = np.tile([0.0, 1.0] if mode else [1.0, 0.0], (count, 1))
    arguments = (single(momenta), shares, normals, *indices[:2], near, *indices[2:], far)
    found = probed(device, "crystal", "split_modes", *arguments)
    expected = optics.crystal.split_modes(*arguments)
    sure = (found["valid"] == expected.valid).all(axis=1) & (found["powers"].sum(axis=1) > 0.5)
    assert sure.mean() > 0.999 and np.isfinite(found["powers"]).all()
    # powers near grazing incidence and near the critical angle have a square root of rounding in them
    error = np.abs(found["powers"] - expected.powers).max(axis=1)[sure]
    assert np.quantile(error, 0.99) < 1e-4 and error.max() < 0.02
    assert np.quantile(np.abs(found["powers"].sum(axis=1) - 1.0)[sure], 0.99) < 1e-4
    for wave in ("reflected_o", "reflected_e", "transmitted_o", "transmitted_e"):
        np.testing.assert_allclose(found[wave][sure], getattr(expected, wave)[sure], atol=3e-3)


def test_every_law_is_swept() -> None:
    import ast
    from pathlib import Path

    folder = Path(optics.__file__).parent
    laws = {
        node.name
        for path in folder.glob("*.py")
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    }
    callbacks = {"leapfrog_step", "euler_step", "hamiltonian_step"}
    swept = "".join(path.read_text(encoding="utf-8") for path in Path(__file__).parent.glob("test_*.py"))
    assert sorted(law for law in laws - callbacks if f'"{law}"' not in swept) == []
