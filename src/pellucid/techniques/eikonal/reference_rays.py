"""Photons on their way through bodies and varying matter: straight pieces, leapfrog steps, Snell and Fresnel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from pellucid.optics.eikonal import kick
from pellucid.optics.fresnel import fresnel_dielectric
from pellucid.optics.snell import reflect, refract
from pellucid.techniques.eikonal.reference_bodies import Array, Body, Convex, Matter

BACKGROUND, OUTSIDE = -1, -2


@dataclass(frozen=True)
class World:
    """Bodies in a box. Where bodies overlap, the first owns the point; `background` fills the rest of the box.

    extent_m : edges of the box along x, y, z.
    bodies : convex shapes.
    background : what is in the box around them.
    ambient_n : index outside of the box.
    step_m : length of the steps in matter that varies.
    """

    extent_m: tuple[float, float, float]
    bodies: Sequence[Body] = ()
    background: Matter = field(default_factory=Matter)
    ambient_n: float = 1.0
    step_m: float = 1e-4

    @property
    def matters(self) -> list[Matter]:
        """Indexed by owner: body, `OUTSIDE`, `BACKGROUND`."""
        return [*(body.matter for body in self.bodies), Matter(self.ambient_n), self.background]


@dataclass(frozen=True)
class Limits:
    """When a photon ends.

    min_flux : below this share of the flux it began with, in every channel.
    bounces : events at surfaces on one path.
    roulette : follow one of the two rays of an interface, chosen at random, instead of both.
    """

    min_flux: float = 1e-4
    bounces: int = 32
    roulette: bool = False


@dataclass
class Photons:
    """Rays under way: `x`, `d` (P, 3) position and unit direction, `flux` (P, 3), `first` (P,) largest flux of their
    start, `bounces` (P,), `name` (P,) number of the ray that they come from."""

    x: Array
    d: Array
    flux: Array
    first: Array
    bounces: np.ndarray
    name: np.ndarray

    def __getitem__(self, which: np.ndarray) -> Photons:
        return Photons(*(getattr(self, key)[which] for key in self.__dataclass_fields__))

    @classmethod
    def begin(cls, x: Array, d: Array, flux: Array) -> Photons:
        """New ones."""
        count = len(x)
        return cls(x, d, flux, flux.max(1), np.zeros(count, np.int64), np.arange(count))


@dataclass
class Ledger:
    """Where the flux went, (3,) each, and the rays that left."""

    absorbed: Array = field(default_factory=lambda: np.zeros(3))
    out: Array = field(default_factory=lambda: np.zeros(3))
    ended: Array = field(default_factory=lambda: np.zeros(3))
    left: list[Photons] = field(default_factory=list)


Piece = Callable[[Photons, Array, Array, Array, int], None]
"""Called with (rays at the start of a straight piece, its lengths (P,), extinctions (P, 3), indices (P,), owner)."""


def follow(world: World, photons: Photons, piece: Piece, limits: Limits, rng: np.random.Generator) -> Ledger:
    """Move rays until all have left, ended or been absorbed; `piece` sees every straight piece of their ways."""
    ledger = Ledger()
    box = Convex.box(world.extent_m, Matter())
    tiny = 1e-9 * max(world.extent_m)
    while len(photons.x):
        ended = (photons.flux.max(1) <= limits.min_flux * photons.first) | (photons.bounces > limits.bounces)
        ledger.ended += photons.flux[ended].sum(0)
        photons = photons[~ended]
        if not len(photons.x):
            break
        distance, surface, here, there = _next_event(world, box, photons.x, photons.d, tiny)
        following = []
        for owner in np.unique(here):
            mine = here == owner
            group, rest = photons[mine], (distance[mine], surface[mine], there[mine])
            matter = world.matters[owner]
            if matter.graded:
                following += _curved(world, box, group, matter, owner, tiny, piece, ledger, limits, rng)
            else:
                _straight(group, rest[0], matter, owner, piece, ledger)
                following += _meet(world, box, group, int(owner), rest[1], rest[2], ledger, limits, rng)
        photons = joined(following)
    return ledger


def _next_event(world: World, box: Convex, x: Array, d: Array, tiny: float) -> tuple[np.ndarray, ...]:
    """Distance to the next change of owner, the surface there (body, or the number of bodies for the box), the owner
    now and the owner beyond, (P,) each."""
    count = len(world.bodies)
    spans = [body.interval(x, d) for body in world.bodies]
    leave = box.interval(x, d)[1]

    def owner(t: Array) -> np.ndarray:
        found = np.where(t < leave, BACKGROUND, OUTSIDE)
        for number in reversed(range(count)):
            near, far = spans[number]
            found = np.where((near < t) & (t < far) & (t < leave), number, found)
        return found

    times = np.stack([*(t for span in spans for t in span), leave])
    order = np.argsort(times, axis=0)
    here = owner(np.full(len(x), tiny))
    best, where, there = leave.copy(), np.full(len(x), count), np.full(len(x), OUTSIDE)
    for rank in reversed(range(len(times))):
        row = order[rank]
        t = np.take_along_axis(times, row[None], 0)[0]
        usable = (t > tiny) & (t <= leave)
        after = owner(np.where(usable, t + tiny, 0.0))
        usable &= after != owner(np.where(usable, t - tiny, 0.0))
        best, where, there = (
            np.where(usable, t, best),
            np.where(usable, row // 2, where),
            np.where(usable, after, there),
        )
    return best, where, here, there


def _straight(group: Photons, distance: Array, matter: Matter, owner: int, piece: Piece, ledger: Ledger) -> None:
    """Advance in place by `distance`, in matter that is the same everywhere along it."""
    middle = group.x + 0.5 * distance[:, None] * group.d
    sigma = matter.extinction(middle)
    piece(group, distance, sigma, matter.index(middle), owner)
    lost = -group.flux * np.expm1(-sigma * distance[:, None])
    ledger.absorbed += lost.sum(0)
    group.x = group.x + distance[:, None] * group.d
    group.flux = group.flux - lost


def _curved(
    world: World,
    box: Convex,
    group: Photons,
    matter: Matter,
    owner: int,
    tiny: float,
    piece: Piece,
    ledger: Ledger,
    limits: Limits,
    rng: np.random.Generator,
) -> list[Photons]:
    """One leapfrog step: half a drift, the kick, and half a drift that ends at a surface when one is near."""
    reach = _next_event(world, box, group.x, group.d, tiny)[0]
    step = np.minimum(reach, world.step_m)
    p = matter.index(group.x)[:, None] * group.d
    dsigma = step / np.linalg.norm(p, axis=1)
    _straight(group, 0.5 * step, matter, owner, piece, ledger)
    p = kick(p, *matter.slope(group.x), dsigma)
    length = np.linalg.norm(p, axis=1)
    group.d = p / length[:, None]
    distance, surface, _, there = _next_event(world, box, group.x, group.d, tiny)
    half = 0.5 * dsigma * length
    meets = (reach <= world.step_m) & (distance < 2.0 * step) | (distance <= half)
    _straight(group, np.where(meets, distance, half), matter, owner, piece, ledger)
    return [
        group[~meets],
        *_meet(world, box, group[meets], int(owner), surface[meets], there[meets], ledger, limits, rng),
    ]


def _meet(
    world: World,
    box: Convex,
    group: Photons,
    owner: int,
    surface: np.ndarray,
    there: np.ndarray,
    ledger: Ledger,
    limits: Limits,
    rng: np.random.Generator,
) -> list[Photons]:
    """Snell and Fresnel at a surface: the reflected and the refracted rays."""
    following: list[Photons] = []
    for target in np.unique(there):
        beyond = world.matters[target]
        for number in np.unique(surface[there == target]):
            rays = group[(there == target) & (surface == number)]
            if beyond.opaque:
                ledger.absorbed += rays.flux.sum(0)
                continue
            normal = (box if number == len(world.bodies) else world.bodies[number]).normal(rays.x)
            normal = normal * -np.sign((normal * rays.d).sum(1, keepdims=True))
            n_i, n_t = world.matters[owner].index(rays.x), beyond.index(rays.x)
            through, back = split(rays, normal, n_i, n_t, limits, rng)
            following.append(back)
            if target == OUTSIDE:
                ledger.out += through.flux.sum(0)
                ledger.left.append(through)
            else:
                following.append(through)
    return following


def split(
    rays: Photons, normal: Array, n_i: Array, n_t: Array, limits: Limits, rng: np.random.Generator
) -> tuple[Photons, Photons]:
    """Refracted and reflected rays, with their shares of the flux [born1999, 1.5]."""
    share = fresnel_dielectric(-(rays.d * normal).sum(1), n_i, n_t)
    refracted = refract(rays.d, normal, n_i, n_t)
    share = np.where(refracted.valid, share, 1.0)
    bent = refracted.direction / np.linalg.norm(refracted.direction, axis=1, keepdims=True)
    bounces = rays.bounces + (n_i != n_t)
    if limits.roulette:
        share = np.where(rng.random(len(share)) < share, 1.0, 0.0)
    through = Photons(rays.x, bent, rays.flux * (1.0 - share)[:, None], rays.first, bounces, rays.name)
    back = Photons(rays.x, reflect(rays.d, normal), rays.flux * share[:, None], rays.first, bounces, rays.name)
    return through[share < 1.0], back[share > 0.0]


def joined(groups: list[Photons]) -> Photons:
    """All of them as one."""
    kept = [g for g in groups if len(g.x)] or groups[:1]
    if not kept:
        return Photons.begin(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)))
    return Photons(*(np.concatenate([getattr(g, key) for g in kept]) for key in Photons.__dataclass_fields__))


def enter(world: World, photons: Photons, limits: Limits, rng: np.random.Generator) -> tuple[Photons, Array]:
    """Rays that stand on the faces of the box and point inwards: those inside it, and the flux (3,) mirrored away."""
    box = Convex.box(world.extent_m, Matter())
    here = _next_event(world, box, photons.x, photons.d, 1e-9 * max(world.extent_m))[2]
    n_t = np.zeros(len(photons.x))
    for owner in np.unique(here):
        n_t[here == owner] = world.matters[owner].index(photons.x[here == owner])
    normal = box.normal(photons.x)
    through, back = split(photons, normal, np.full_like(n_t, world.ambient_n), n_t, limits, rng)
    return through, back.flux.sum(0)
