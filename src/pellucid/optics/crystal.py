"""Light in uniaxial crystals: two rays, where they go, and how much light each carries. Twin of ``crystal.wgsl``.

A crystal has an optic axis ``axis`` (unit vector a, its sign is free), an ordinary index ``n_o`` and an extraordinary
one ``n_e``. A wave has a momentum ``p`` (wave vector over that of vacuum). The ordinary wave has p.p = n_o^2, its ray
goes along p. The extraordinary wave has **p.Mp = 1** with M = I/n_e^2 + (1/n_o^2 - 1/n_e^2) a a^T, and its ray goes
along M p, which is not p [born1999, 15.2-15.3; kravtsov1990]. An isotropic medium is n_o = n_e; its axis then only says
what the two polarisations are: with the normal of an interface for axis, "ordinary" is s and "extraordinary" is p.

``normal`` is unit and faces the side that light comes from, as in :mod:`pellucid.optics.snell`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
CrystalField = Callable[[Array], tuple[Array, Array, Array, Array, Array, Array]]
"""Maps positions (..., 3), m, to n_o (...), n_e (...), axis (..., 3), grad n_o and grad n_e (..., 3), 1/m, and the
derivatives of the axis (..., 3, 3), 1/m, [i, j] that of component j along axis i of space."""

# Waves closer than this to the optic axis, rad, get a polarisation that does not depend on the last digits of p.
_CONE = 1e-4
# Smaller normal components of p are rounding in the twin: such a wave does not arrive at the interface.
_GRAZING = 1e-6


class WaveMomentum(NamedTuple):
    """Momentum of a wave behind an interface.

    Attributes
    ----------
    p : (..., 3), real part.
    decay : (..., 3), imaginary part; along the normal, 0 for a wave that travels.
    valid : (...), bool; false for an evanescent wave, which carries no light away.
    """

    p: Array
    decay: Array
    valid: NDArray[np.bool_]


class TangentialField(NamedTuple):
    """Field of a wave along an interface: E.u, E.v, H.u, H.v with u, v, normal right-handed.

    Attributes
    ----------
    real, imaginary : (..., 4).
    """

    real: Array
    imaginary: Array


class ModeSplit(NamedTuple):
    """What an interface makes of a wave.

    Attributes
    ----------
    reflected_o, reflected_e, transmitted_o, transmitted_e : (..., 3), momenta.
    powers : (..., 4), share of the arriving flux in each of the four; they sum to 1.
    valid : (..., 4), 0 where that wave is evanescent and carries nothing.
    """

    reflected_o: Array
    reflected_e: Array
    transmitted_o: Array
    transmitted_e: Array
    powers: Array
    valid: NDArray[np.uint32]


def _dot(a: ArrayLike, b: ArrayLike) -> Array:
    return np.sum(np.asarray(a) * np.asarray(b), axis=-1)


def _column(a: ArrayLike) -> Array:
    return np.asarray(a, float)[..., None]


def extraordinary_index(cos_theta: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """Index of the extraordinary wave, 1/n^2 = cos^2/n_o^2 + sin^2/n_e^2 [born1999, 15.3.1; tevs2007, A.2].

    Parameters
    ----------
    cos_theta : (...), cosine between the wave's direction and the axis.
    n_o, n_e : (...), principal indices, > 0.
    """
    square = np.square(np.asarray(cos_theta, float))
    n_o, n_e = np.asarray(n_o, float), np.asarray(n_e, float)
    return n_o * n_e / np.sqrt(n_e**2 * square + n_o**2 * (1.0 - square))


def extraordinary_momentum(direction: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """Momentum (..., 3) of the extraordinary wave whose **wave** travels along a unit direction (..., 3)."""
    n = extraordinary_index(_dot(direction, axis), n_o, n_e)
    return _column(n) * np.asarray(direction, float)


def extraordinary_ray(p: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """Velocity M p of the extraordinary ray: where its energy goes [tevs2007, A.2; kravtsov1990].

    Parameters
    ----------
    p : (..., 3), momentum.

    Returns
    -------
    (..., 3); its length is 1 over the ray's index, and p.Mp = 1 on the ray.
    """
    p, axis = np.asarray(p, float), np.asarray(axis, float)
    across, along = 1.0 / np.square(np.asarray(n_e, float)), 1.0 / np.square(np.asarray(n_o, float))
    return _column(across) * p + _column((along - across) * _dot(axis, p)) * axis


def momentum_of_ray(direction: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """Momentum (..., 3) of the extraordinary wave whose **ray** goes along a unit direction (..., 3).

    p = M^-1 t / sqrt(t.M^-1 t), the inverse of :func:`extraordinary_ray`.
    """
    t, axis = np.asarray(direction, float), np.asarray(axis, float)
    across, along = np.square(np.asarray(n_e, float)), np.square(np.asarray(n_o, float))
    p = _column(across) * t + _column((along - across) * _dot(axis, t)) * axis
    return p / _column(np.sqrt(_dot(t, p)))


def walk_off(cos_theta: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """Angle between the extraordinary wave and its ray, rad, >= 0 [born1999, 15.3.2].

    Parameters
    ----------
    cos_theta : (...), cosine between the wave's direction and the axis.
    """
    c = np.clip(np.asarray(cos_theta, float), -1.0, 1.0)
    s = np.sqrt(1.0 - c**2)
    across, along = 1.0 / np.square(np.asarray(n_e, float)), 1.0 / np.square(np.asarray(n_o, float))
    return np.arctan2(np.abs((along - across) * s * c), along * c**2 + across * s**2)


def crystal_hamiltonian(p: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike) -> Array:
    """H = (p.Mp - 1)/2, which is 0 along every extraordinary ray [kravtsov1990]."""
    return 0.5 * (_dot(p, extraordinary_ray(p, axis, n_o, n_e)) - 1.0)


def crystal_force(
    p: ArrayLike,
    axis: ArrayLike,
    n_o: ArrayLike,
    n_e: ArrayLike,
    grad_n_o: ArrayLike,
    grad_n_e: ArrayLike,
    grad_along: ArrayLike,
) -> Array:
    """What bends an extraordinary ray where the crystal varies: dp/dsigma = -grad(p.Mp)/2 at fixed p [kravtsov1990].

    Parameters
    ----------
    grad_n_o, grad_n_e : (..., 3), gradients of the indices, 1/m.
    grad_along : (..., 3), gradient of a.p at fixed p, 1/m.
    """
    n_o, n_e = np.asarray(n_o, float), np.asarray(n_e, float)
    along = _dot(axis, p)
    across_squared = _dot(p, p) - along**2
    turn = _column((1.0 / n_e**2 - 1.0 / n_o**2) * along) * np.asarray(grad_along, float)
    stretch = _column(across_squared / n_e**3) * np.asarray(grad_n_e, float)
    return turn + stretch + _column(along**2 / n_o**3) * np.asarray(grad_n_o, float)


def hamiltonian_step(
    x: ArrayLike, p: ArrayLike, dsigma: ArrayLike, field: CrystalField, iterations: int = 12
) -> tuple[Array, Array]:
    """Implicit midpoint step of dx = Mp, dp = -grad(p.Mp)/2 [hairer2006, II.1.1]: second order, undone by -dsigma.

    H mixes x and p, so that no explicit leapfrog exists; the midpoint is found by fixed-point iteration.

    Parameters
    ----------
    x, p : (..., 3), position, m, and momentum.
    dsigma : (...), step, m; the arc length is |Mp| dsigma.
    iterations : evaluations of the field; 2 are the explicit midpoint rule, 3 keep H a hundred times better.
    """
    x, p = np.asarray(x, float), np.asarray(p, float)
    half = 0.5 * _column(dsigma)
    velocity, force = np.zeros_like(p), np.zeros_like(p)
    for k in range(iterations):
        x_mid, p_mid = (x + half * velocity, p + half * force) if k else (x, p)
        n_o, n_e, axis, grad_o, grad_e, turning = field(x_mid)
        velocity = extraordinary_ray(p_mid, axis, n_o, n_e)
        force = crystal_force(p_mid, axis, n_o, n_e, grad_o, grad_e, np.einsum("...ij,...j->...i", turning, p_mid))
    return x + 2.0 * half * velocity, p + 2.0 * half * force


def extraordinary_extinction(
    p: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike, sigma_o: ArrayLike, sigma_e: ArrayLike
) -> Array:
    """Extinction along the extraordinary **ray**: pleochroism, 1/m.

    (sigma_o (a.p)^2 / n_o^3 + sigma_e (p^2 - (a.p)^2) / n_e^3) / |Mp|: what complex indices n + i sigma lambda/(4 pi)
    make of p.Mp = 1, to first order in sigma. Across the axis it is sigma_e, along it sigma_o. The formula in
    [tevs2007, A.3], sigma_o cos^2 + sigma_e (n_o/n_e)^2 sin^2, is (n_o/n_e)^2 sigma_e across the axis, 24 % too much in
    calcite.

    Parameters
    ----------
    sigma_o, sigma_e : (..., 3), extinction of the ordinary ray, and of the extraordinary one across the axis, 1/m.

    Returns
    -------
    (..., 3), 1/m.
    """
    n_o, n_e = np.asarray(n_o, float), np.asarray(n_e, float)
    along_squared = _dot(axis, p) ** 2
    across_squared = np.maximum(_dot(p, p) - along_squared, 0.0)
    ray = extraordinary_ray(p, axis, n_o, n_e)
    per_ray = 1.0 / np.sqrt(_dot(ray, ray))
    from_o = _column(per_ray * along_squared / n_o**3) * np.asarray(sigma_o, float)
    return from_o + _column(per_ray * across_squared / n_e**3) * np.asarray(sigma_e, float)


def ordinary_wave(p: ArrayLike, normal: ArrayLike, side: ArrayLike, n_o: ArrayLike) -> WaveMomentum:
    """The ordinary wave behind an interface: tangential p is kept, |p| = n_o [born1999, 1.5.1].

    Parameters
    ----------
    p : (..., 3), momentum of the wave that arrives.
    side : (...), 1 for the side that the normal points to (reflection), -1 for the other (refraction).
    """
    p, normal = np.asarray(p, float), np.asarray(normal, float)
    along = _dot(p, normal)
    square = np.square(np.asarray(n_o, float)) - _dot(p, p) + along**2
    return _behind(p - _column(along) * normal, normal, np.zeros_like(square), square, np.asarray(side, float))


def extraordinary_wave(
    p: ArrayLike, normal: ArrayLike, side: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike
) -> WaveMomentum:
    """The extraordinary wave behind an interface: tangential p is kept, p.Mp = 1, and the **ray** goes to that side.

    With p = p_t + s n the condition is quadratic in s, and n.Mp = n.M p_t + s n.Mn = +-sqrt(discriminant): the sign of
    the root is the side of the ray, whatever that of p [born1999, 15.3.3].
    """
    p, normal = np.asarray(p, float), np.asarray(normal, float)
    tangential = p - _column(_dot(p, normal)) * normal
    of_normal = extraordinary_ray(normal, axis, n_o, n_e)
    a = _dot(normal, of_normal)
    b = _dot(tangential, of_normal)
    c = _dot(tangential, extraordinary_ray(tangential, axis, n_o, n_e)) - 1.0
    return _behind(tangential, normal, -b / a, (b * b - a * c) / (a * a), np.asarray(side, float))


def _behind(tangential: Array, normal: Array, middle: Array, square: Array, side: Array) -> WaveMomentum:
    """tangential + (middle + side sqrt(square)) normal; for a negative square it decays away from the interface."""
    root = side * np.sqrt(np.abs(square))
    valid = square >= 0.0
    along = middle + np.where(valid, root, 0.0)
    return WaveMomentum(
        tangential + _column(along) * normal,
        _column(np.where(valid, 0.0, root)) * np.broadcast_to(normal, tangential.shape),
        valid,
    )


def ordinary_field(p: ArrayLike, decay: ArrayLike, normal: ArrayLike, axis: ArrayLike) -> TangentialField:
    """Field of an ordinary wave of momentum p + i decay: E along a x p, H = p x E [born1999, 15.3.2]."""
    wave = np.asarray(p, float) + 1j * np.asarray(decay, float)
    electric = _across_axis(wave, axis)
    return _tangential(electric, np.cross(wave, electric), normal)


def extraordinary_field(
    p: ArrayLike, decay: ArrayLike, normal: ArrayLike, axis: ArrayLike, n_o: ArrayLike, n_e: ArrayLike
) -> TangentialField:
    """Field of an extraordinary wave: H along a x p, D = H x p, E = D / permittivity [born1999, 15.3.2]."""
    wave = np.asarray(p, float) + 1j * np.asarray(decay, float)
    axis = np.asarray(axis, float)
    magnetic = _across_axis(wave, axis)
    d = np.cross(magnetic, wave)
    ordinary, extraordinary = 1.0 / np.square(np.asarray(n_o, float)), 1.0 / np.square(np.asarray(n_e, float))
    electric = ordinary[..., None] * d + ((extraordinary - ordinary) * _dot(axis, d))[..., None] * axis
    return _tangential(electric, magnetic, normal)


def _across_axis(wave: Complex, axis: ArrayLike) -> Complex:
    """Unit vector along a x p; near the axis, where that vanishes, it is led over to a fixed one."""
    axis = np.asarray(axis, float)
    h = np.cross(axis, wave)
    size = np.sqrt(np.sum(np.abs(h) ** 2, axis=-1))
    h = h + np.maximum(_CONE - size, 0.0)[..., None] * _perpendicular(axis)
    return h / np.sqrt(np.sum(np.abs(h) ** 2, axis=-1))[..., None]


def _perpendicular(v: Array) -> Array:
    """A unit vector across a unit vector."""
    helper = np.where((np.abs(v[..., :1]) < 0.6), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    u = np.cross(v, helper)
    return u / np.sqrt(_dot(u, u))[..., None]


def _tangential(electric: Complex, magnetic: Complex, normal: ArrayLike) -> TangentialField:
    normal = np.asarray(normal, float)
    u = _perpendicular(normal)
    v = np.cross(normal, u)
    parts = np.stack(
        np.broadcast_arrays(_dot(electric, u), _dot(electric, v), _dot(magnetic, u), _dot(magnetic, v)), -1
    )
    return TangentialField(parts.real.astype(float), parts.imag.astype(float))


def normal_flux(real: ArrayLike, imaginary: ArrayLike) -> Array:
    """Poynting flux Re(E x H*) along the normal, of a :class:`TangentialField` [born1999, 1.4.3]."""
    a, b = np.asarray(real, float), np.asarray(imaginary, float)
    return a[..., 0] * a[..., 3] + b[..., 0] * b[..., 3] - a[..., 1] * a[..., 2] - b[..., 1] * b[..., 2]


def split_modes(
    p: ArrayLike,
    shares: ArrayLike,
    normal: ArrayLike,
    n_o_i: ArrayLike,
    n_e_i: ArrayLike,
    axis_i: ArrayLike,
    n_o_t: ArrayLike,
    n_e_t: ArrayLike,
    axis_t: ArrayLike,
) -> ModeSplit:
    """What becomes of a wave at an interface between two uniaxial (or isotropic) media, exactly.

    Tangential E and H are the same on both sides [born1999, 1.1.3]: four equations for the amplitudes of two reflected
    and two transmitted waves; powers are their Poynting fluxes through the interface. Waves of one side with the same
    tangential momentum carry their fluxes independently, so the four sum to 1.

    Parameters
    ----------
    p : (..., 3), momentum that arrives.
    shares : (..., 2), shares of the arriving flux that are ordinary and extraordinary: (1, 0) or (0, 1) in a crystal;
        (1/2, 1/2) for unpolarised light in an isotropic medium, whose axis is the normal.
    n_o_i, n_e_i, axis_i : of the side that light comes from.
    n_o_t, n_e_t, axis_t : of the other.
    """
    shares, normal = np.asarray(shares, float), np.asarray(normal, float)
    still = np.zeros(3)
    waves = (
        ordinary_wave(p, normal, 1.0, n_o_i),
        extraordinary_wave(p, normal, 1.0, axis_i, n_o_i, n_e_i),
        ordinary_wave(p, normal, -1.0, n_o_t),
        extraordinary_wave(p, normal, -1.0, axis_t, n_o_t, n_e_t),
    )
    fields = (
        ordinary_field(waves[0].p, waves[0].decay, normal, axis_i),
        extraordinary_field(waves[1].p, waves[1].decay, normal, axis_i, n_o_i, n_e_i),
        ordinary_field(waves[2].p, waves[2].decay, normal, axis_t),
        extraordinary_field(waves[3].p, waves[3].decay, normal, axis_t, n_o_t, n_e_t),
    )
    # What arrives is put on its surface again: near grazing incidence rounding would outweigh its normal component.
    in_o = ordinary_wave(p, normal, -1.0, n_o_i)
    in_e = extraordinary_wave(p, normal, -1.0, axis_i, n_o_i, n_e_i)
    from_o = _powers(ordinary_field(in_o.p, still, normal, axis_i), fields, 0)
    from_e = _powers(extraordinary_field(in_e.p, still, normal, axis_i, n_o_i, n_e_i), fields, 1)
    valid = np.stack(np.broadcast_arrays(*(w.valid for w in waves)), -1)
    powers = np.where(valid, shares[..., :1] * from_o + shares[..., 1:] * from_e, 0.0)
    return ModeSplit(waves[0].p, waves[1].p, waves[2].p, waves[3].p, powers, valid.astype(np.uint32))


def _powers(arriving: TangentialField, fields: tuple[TangentialField, ...], mode: int) -> Array:
    """Flux of each of the four waves over that which arrives: r_1 c_1 + r_2 c_2 + b = t_1 c_3 + t_2 c_4, by Cramer.

    What passes along the interface goes on as it is.
    """
    c = [f.real + 1j * f.imaginary for f in fields]
    b = arriving.real + 1j * arriving.imaginary
    back, on = _wedge(c[0], c[1]), _wedge(c[2], c[3])
    determinant = _meet(back, on)
    amplitudes = (
        _meet(_wedge(b, c[1]), on),
        _meet(_wedge(c[0], b), on),
        _meet(back, _wedge(b, c[3])),
        _meet(back, _wedge(c[2], b)),
    )
    arrives = np.abs(normal_flux(arriving.real, arriving.imaginary))
    passes_by = arrives < _GRAZING
    size = np.abs(determinant) ** 2 * np.where(passes_by, 1.0, arrives)
    fluxes = [np.abs(normal_flux(f.real, f.imaginary)) for f in fields]
    powers = [np.abs(a) ** 2 * f / size for a, f in zip(amplitudes, fluxes, strict=True)]
    itself = np.eye(4)[mode]
    return np.where(passes_by[..., None], itself, np.stack(np.broadcast_arrays(*powers), -1))


def _wedge(u: Complex, v: Complex) -> tuple[Complex, Complex]:
    """The six 2 x 2 minors of two columns of four."""
    first = u[..., :1] * v[..., 1:] - v[..., :1] * u[..., 1:]
    return first, np.cross(u[..., 1:], v[..., 1:])


def _meet(a: tuple[Complex, Complex], b: tuple[Complex, Complex]) -> Complex:
    """Determinant of four columns from the minors of the first two and the last two (Laplace)."""
    return _dot(a[0], b[1]) + _dot(a[1], b[0])  # type: ignore[return-value]
