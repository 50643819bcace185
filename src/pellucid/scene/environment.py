"""Light from all around, as a map of directions."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike, fspath
from pathlib import Path
from typing import Any, Self

import numpy as np

from pellucid.errors import AssetError, SceneError
from pellucid.scene import checks, equirect
from pellucid.scene.placement import Origin, Value, rotation_matrix, store

RATIO_RANGE = (1.8, 2.2)


@dataclass(frozen=True, eq=False)
class Environment(Value):
    """An equirectangular map of radiance: row 0 is +Y, the centre column looks along -Z, +X right of it.

    Parameters
    ----------
    pixels : (H, W, 3) linear Rec.709 radiance, >= 0, about twice as wide as high; sRGB when of uint8 or uint16.
    intensity : factor on the whole map, >= 0.
    rotation_deg : turns the surroundings about +Y, counter-clockwise seen from above: what was along
        -Z comes to lie along -X after 90 degrees.
    kind : a label: ``"studio"``, ``"sky"``, ``"constant"``, ``"file"`` or ``"array"``.
    origin : the recipe that scene files store; set by the class methods.

    Raises
    ------
    SceneError : wrong shape, values that are negative or not finite, a ratio far from 2 to 1.
    """

    pixels: np.ndarray
    intensity: float = 1.0
    rotation_deg: float = 0.0
    kind: str = "array"
    origin: Origin | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        pixels = checks.picture("environment.pixels", self.pixels, (None, None, 3))
        _check_radiance(pixels)
        store(
            self,
            pixels=pixels,
            intensity=checks.number("environment.intensity", self.intensity, low=0.0),
            rotation_deg=checks.number("environment.rotation_deg", self.rotation_deg),
        )

    def replace(self, **changes: Any) -> Self:
        """A copy with some fields changed; new pixels have no recipe."""
        if "pixels" in changes:
            changes = {"kind": "array", "origin": None} | changes
        return super().replace(**changes)

    @classmethod
    def load(cls, path: str | PathLike[str], *, intensity: float = 1.0, rotation_deg: float = 0.0) -> Self:
        """A map from a picture: .hdr, .exr, or any other, which is then linearised from sRGB.

        Raises
        ------
        AssetError : the file cannot be read, is not about 2 to 1, or holds radiance that is negative
            or not finite.
        SceneError : intensity or rotation out of range.
        """
        from pellucid.io.images import read_image

        pixels = read_image(path)
        grey = pixels.shape[2] <= 2
        pixels = np.repeat(pixels[..., :1], 3, axis=2) if grey else np.ascontiguousarray(pixels[..., :3])
        try:
            _check_radiance(pixels)
        except SceneError as error:
            raise AssetError(path, f"cannot be an environment: {error.reason}", error.remedy) from None
        origin = Origin({"file": str(Path(fspath(path)).resolve())})
        return cls(checks.frozen(pixels), intensity, rotation_deg, "file", origin)

    @classmethod
    def studio(cls, *, intensity: float = 1.0, rotation_deg: float = 0.0) -> Self:
        """A dark photographer's studio with soft panels up to a radiance of 20, made to show glass."""
        from pellucid.scene.studio import studio_map

        return cls(studio_map(), intensity, rotation_deg, "studio", Origin({"kind": "studio"}))

    @classmethod
    def sky(
        cls,
        sun_elevation_deg: float = 35.0,
        sun_azimuth_deg: float = 40.0,
        turbidity: float = 3.0,
        *,
        sun_disc: bool = True,
        sun_diameter_deg: float = 2.0,
        ground_albedo: float | checks.Vector = (0.19, 0.17, 0.14),
        intensity: float = 1.0,
        rotation_deg: float = 0.0,
    ) -> Self:
        """A clear daylight sky over a matt ground [preetham1999].

        Parameters
        ----------
        sun_elevation_deg : 0 to 90. sun_azimuth_deg : 0 is -Z, 90 is +X.
        turbidity : haze, 2 to 10; 3 is a clear day.
        sun_disc : draw the sun; leave it out next to ``DirectionalLight.sun``, which casts shadows.
        sun_diameter_deg : 0.53 in nature; wider by default so that the map shows it round. Its
            irradiance stays that of the sun.
        ground_albedo : one number or (r, g, b), from 0 to 1.

        Raises
        ------
        SceneError : a value out of range.
        """
        from pellucid.scene import sky

        sky.check_sky(sun_elevation_deg, sun_azimuth_deg, turbidity)
        if isinstance(ground_albedo, int | float):
            ground_albedo = (ground_albedo,) * 3
        settings: dict[str, Any] = {
            "sun_disc": checks.flag("environment.sun_disc", sun_disc),
            "sun_diameter_deg": checks.number("environment.sun_diameter_deg", sun_diameter_deg, low=0.1, high=20.0),
            "ground_albedo": checks.color("environment.ground_albedo", ground_albedo, high=1.0),
        }
        pixels = sky.sky_map(sun_elevation_deg, sun_azimuth_deg, turbidity, width=1024, **settings)
        sun = {"sun_elevation_deg": sun_elevation_deg, "sun_azimuth_deg": sun_azimuth_deg, "turbidity": turbidity}
        origin = Origin({"kind": "sky", **sun, **settings})
        return cls(checks.frozen(pixels.astype(np.float32)), intensity, rotation_deg, "sky", origin)

    @classmethod
    def constant(cls, rgb: float | checks.Vector = (1.0, 1.0, 1.0), *, intensity: float = 1.0) -> Self:
        """The same radiance from everywhere; `rgb` is one number or three, linear, >= 0."""
        color = checks.color("environment.rgb", (rgb,) * 3 if np.ndim(rgb) == 0 else rgb)
        pixels = checks.frozen(np.broadcast_to(np.asarray(color, np.float32), (4, 8, 3)).copy())
        return cls(pixels, intensity, 0.0, "constant", Origin({"kind": "constant", "rgb": color}))

    def radiance(self, directions: np.ndarray) -> np.ndarray:
        """What comes from world `directions` (..., 3), bilinear between pixels: (..., 3) float64."""
        turned = np.asarray(directions, np.float64) @ rotation_matrix((0.0, self.rotation_deg, 0.0))
        return equirect.look_up(self.pixels, turned) * self.intensity


def _check_radiance(pixels: np.ndarray) -> None:
    height, width = pixels.shape[:2]
    low, high = RATIO_RANGE
    if not low <= width / height <= high:
        raise SceneError(
            "environment.pixels",
            f"is {width} x {height} pixels, but a map of all directions is twice as wide as high",
            "use an equirectangular (latitude-longitude) picture",
        )
    for bad, words in ((~np.isfinite(pixels), "not finite"), (pixels < 0, "negative")):
        if bad.any():
            row, column = np.argwhere(bad.any(axis=2))[0]
            where = f"{np.count_nonzero(bad)} values are {words}, the first in column {column} of row {row}"
            raise SceneError("environment.pixels", where, "clean the picture; radiance is finite and at least 0")
