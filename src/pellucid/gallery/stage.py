"""The photographer's things: tables, cloths, backdrops and lamps that the pictures share."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt

from pellucid import media
from pellucid.fields.volume import Volume
from pellucid.media import Medium
from pellucid.scene import DirectionalLight, Environment, LightQuality, Mesh

Image = npt.NDArray[np.float32]
Rgb = tuple[float, float, float]

#: Travels like the light of the studio's key panel: from behind on the left, so that shadows fall to the viewer.
KEY_DIRECTION = (0.567, -0.695, 0.443)


#: Air between a body and its table: solids touch in a few points only, and rays must know what comes first.
GAP_M = 2e-4


#: Light for a picture of the gallery: a few times quicker than the default, and patterns nearly as fine.
QUICK_LIGHT = LightQuality(front_voxels=3.0, split_voxels=2.0, bounces=8, min_flux=1e-2)

#: Light for bodies with flat faces, which spread no bundle: only their edges divide a coarse front.
FACET_LIGHT = LightQuality(front_voxels=8.0, split_voxels=4.0, bounces=8, min_flux=0.02)


def key_light(irradiance: float = 2.0) -> DirectionalLight:
    """A lamp where the studio has its main panel; it gives the shadows."""
    return DirectionalLight(KEY_DIRECTION, (1.0, 0.97, 0.92), irradiance)


def daylight(elevation_deg: float = 50.0, azimuth_deg: float = -60.0) -> tuple[Environment, DirectionalLight]:
    """A clear sky without its sun, and the sun as a lamp that gives shadows."""
    sky = Environment.sky(elevation_deg, azimuth_deg, 2.0, sun_disc=False)
    return sky, DirectionalLight.sun(elevation_deg, azimuth_deg, 2.0)


def jewellers_lamps(lamps: int = 40, radiance: float = 60.0, width_deg: float = 3.5) -> Environment:
    """The studio, dimmed, with many small bright lamps overhead: what makes a stone flash in colours.

    Parameters
    ----------
    lamps : how many, spread evenly over the upper half.
    radiance, width_deg : of each.
    """
    room = np.array(Environment.studio().pixels) * 0.6
    height, width = room.shape[:2]
    v, u = np.meshgrid(
        (np.arange(height) + 0.5) / height * np.pi, (np.arange(width) + 0.5) / width * 2.0 * np.pi, indexing="ij"
    )
    directions = np.stack([np.sin(v) * np.cos(u), np.cos(v), np.sin(v) * np.sin(u)], axis=-1)
    k = np.arange(lamps)
    y, turn = 0.1 + 0.88 * (k + 0.5) / lamps, k * np.pi * (3.0 - np.sqrt(5.0))
    centres = np.stack([np.sqrt(1.0 - y * y) * np.cos(turn), y, np.sqrt(1.0 - y * y) * np.sin(turn)])
    nearest = np.degrees(np.arccos(np.clip((directions @ centres).max(axis=-1), -1.0, 1.0)))
    room += radiance * np.clip(width_deg - 2.0 * nearest + 0.5, 0.0, 1.0)[..., None]
    return Environment(np.asarray(room, np.float32))


def tinted(name: str, absorption_per_m: Rgb) -> Medium:
    """A catalogue glass, coloured in the melt: its index, and our absorption."""
    glass = media.get(name)
    return dataclasses.replace(
        glass, name=f"{name}, coloured", absorption_per_m=absorption_per_m, absorption_source="chosen for the picture"
    )


def table(tile_m: float, image: Image, size_m: float, **look: object) -> Mesh:
    """A floor at y = 0 on which an image repeats every `tile_m`."""
    ground = Mesh.plane(size_m)
    assert ground.uvs is not None
    uvs = (np.asarray(ground.uvs) - 0.5) * (size_m / tile_m)
    settings: dict[str, object] = {"base_color": (1.0, 1.0, 1.0), "roughness": 0.55} | look
    return Mesh(ground.vertices, ground.faces, ground.normals, uvs, base_color_map=image, **settings)  # type: ignore[arg-type]


def noise(shape: tuple[int, int], scale: tuple[float, float], seed: int) -> npt.NDArray[np.float64]:
    """Smooth noise that repeats at its edges: mean 0, deviation 1; `scale` is its correlation in pixels (y, x)."""
    white = np.random.default_rng(seed).standard_normal(shape)
    fy, fx = np.fft.fftfreq(shape[0])[:, None], np.fft.fftfreq(shape[1])[None, :]
    kept = np.exp(-2.0 * np.pi**2 * ((fy * scale[0]) ** 2 + (fx * scale[1]) ** 2))
    kept[0, 0] = 0.0
    values = np.fft.ifft2(np.fft.fft2(white) * kept).real
    return np.asarray(values / values.std())


def noise_3d(shape: tuple[int, int, int], scale: float, seed: int) -> npt.NDArray[np.float64]:
    """Smooth noise on voxels: mean 0, deviation 1; `scale` is its correlation in voxels."""
    white = np.random.default_rng(seed).standard_normal(shape)
    frequencies = np.meshgrid(*(np.fft.fftfreq(n) for n in shape), indexing="ij", sparse=True)
    kept = np.exp(-2.0 * np.pi**2 * scale**2 * sum(f * f for f in frequencies))
    kept[0, 0, 0] = 0.0
    values = np.fft.ifftn(np.fft.fftn(white) * kept).real
    return np.asarray(values / values.std())


def voxel_centres(volume: Volume) -> tuple[npt.NDArray[np.float64], ...]:
    """(Z, Y, X) each: x, y and z of the voxels, metres from the middle of the box."""
    axes = [
        (np.arange(n) + 0.5) * h - 0.5 * e
        for n, h, e in zip(volume.shape[::-1], volume.voxel_m, volume.extent_m, strict=True)
    ]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return x, y, z


def turned(angle_deg: float) -> npt.NDArray[np.float64]:
    """(3, 3) a turn about the upright axis."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def wood(size: int = 1024, planks: int = 6, light: Rgb = (0.46, 0.27, 0.13), dark: Rgb = (0.20, 0.095, 0.04)) -> Image:
    """Boards that run along x, with grain."""
    rows = np.arange(size) * planks / size
    plank, across = np.floor(rows).astype(int), rows % 1.0
    rng = np.random.default_rng(5)
    shade, shift = rng.uniform(-0.22, 0.22, planks), rng.integers(0, size, planks)
    grain = 0.6 * noise((size, size), (1.6, 90.0), 1) + 0.8 * noise((size, size), (7.0, 160.0), 2)
    grain = np.stack([np.roll(grain[y], shift[plank[y]]) for y in range(size)])
    amount = np.clip(0.5 + 0.17 * grain + shade[plank][:, None], 0.0, 1.0)[..., None]
    image = amount * np.array(light) + (1.0 - amount) * np.array(dark)
    gap = np.minimum(across, 1.0 - across) * size / planks
    image *= (0.25 + 0.75 * np.clip(gap / 2.5, 0.0, 1.0))[:, None, None]
    return np.asarray(image, np.float32)


def stone(size: int = 512, base: Rgb = (0.30, 0.30, 0.31), contrast: float = 0.12, seed: int = 3) -> Image:
    """Speckled stone: three sizes of grain."""
    grains = sum(
        w * noise((size, size), (s, s), seed + i) for i, (s, w) in enumerate(((1.2, 0.5), (5.0, 0.4), (40.0, 0.6)))
    )
    return np.asarray(np.clip(1.0 + contrast * np.asarray(grains)[..., None], 0.2, 1.8) * np.array(base), np.float32)


def grid(size: int, lines: int, ground: Rgb, line: Rgb, width: float) -> Image:
    """Lines both ways; `width` is the share of a cell that a line takes."""
    at = (np.arange(size) + 0.5) * lines / size % 1.0
    on = np.minimum(at, 1.0 - at) < 0.5 * width
    return _two(on[:, None] | on[None, :], line, ground)


def checks(light: Rgb, dark: Rgb, size: int = 256) -> Image:
    """Two by two fields of a chessboard."""
    half = np.arange(size) < size // 2
    return _two(half[:, None] ^ half[None, :], light, dark)


def stripes(size: int, bars: int, first: Rgb, second: Rgb, share: float = 0.5) -> Image:
    """Bars that run from top to bottom; the first colour takes `share` of the width."""
    at = (np.arange(size) + 0.5) * bars / size % 1.0
    return _two(np.broadcast_to(at < share, (8, size)), first, second)


def _two(where: npt.NDArray[np.bool_], first: Rgb, second: Rgb) -> Image:
    return np.where(where[..., None], np.asarray(first, np.float32), np.asarray(second, np.float32))
