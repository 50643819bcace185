"""Pictures of what lies below and above a surface of water, for rays that look things up instead of meeting them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from pellucid.gpu.targets import COLOR_FORMAT, DEPTH_FORMAT
from pellucid.scene.water_outline import PART
from pellucid.surroundings.views import Box, SceneView, Shown, above, below
from pellucid.techniques.water.cameras import Basin, pictures
from pellucid.techniques.water.layouts import WaterViews

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.scene.water import Water
    from pellucid.scene.water_quality import WaterQuality
    from pellucid.surroundings import Surroundings
    from pellucid.surroundings.camera import View

NAMES = ("picture_colors", "picture_depths")
LABELS = ("water picture below", "water picture above")
CLIP_MARGIN_M = 0.01  # of what both pictures have in common round the surface [mihalik2008, 5.1, 5.2]
HIDDEN_MARGIN_M = 1e-4  # so that nothing that touches the surface is lost to rounding
HIDDEN_SHARE = 2e-4  # of the rectangle, at its borders
VISIBILITY = 0.01  # share of light that comes from the farthest that is worth a place in a picture


class SurfacePictures:
    """Takes the two pictures of a body of water: layer 0 shows what is below its surface, layer 1 what is above.

    Parameters
    ----------
    device : where to draw.

    Attributes
    ----------
    views : the cameras of the last pictures, None where there is none.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        # Looked up between texels: 32-bit floats, where the device can do that with them.
        self.format = COLOR_FORMAT if device.float32_filterable else "rgba16float"
        self.views: tuple[View | None, View | None] = (None, None)
        self._scenes = [SceneView(device, self.format) for _ in LABELS]
        self._params = device.buffer(WaterViews.itemsize, "uniform", "water views")
        self._sampler = device.sampler("nearest", "clamp")
        self._colors: Any = None
        self._depths: Any = None
        self._stacks: list[Any] = []
        self._wanted: tuple[Any, ...] = ()
        self._taken: tuple[View | None, View | None] = (None, None)

    @property
    def bindings(self) -> dict[str, Any]:
        """Resources of bind group 0 by their WGSL names; empty before anything was drawn."""
        return {
            **dict(zip(NAMES, self._stacks, strict=False)),
            "water_views": self._params,
            "picture_sampler": self._sampler,
        }

    @property
    def nbytes(self) -> int:
        """Bytes of GPU memory held."""
        texels = 0 if self._colors is None else 2 * self._colors.width * self._colors.height
        own = texels * ((16 if self.format == COLOR_FORMAT else 8) + 4) + WaterViews.itemsize
        return own + sum(scene.nbytes for scene in self._scenes)

    def draw(
        self,
        encoder: Any,
        item: Water,
        quality: WaterQuality,
        waves: tuple[tuple[float, float], float],
        surroundings: Surroundings,
        timer: Any = None,
    ) -> None:
        """Take the pictures that a quality asks for, for the camera of the surroundings.

        Parameters
        ----------
        waves : lowest and highest height over the level, metres, and the steepest slope.
        """
        size = (quality.texture_size, quality.texture_size)
        kept = self._use_size(size)
        (low, high), slope = waves
        reach = lowest_and_highest(surroundings)
        basin = basin_of(item, quality, slope, reach)
        wanted = wanted_pictures(quality, surroundings.view, item.level)
        taken = self._cameras(surroundings.view, basin, quality)
        self.views = tuple(v if w else None for v, w in zip(taken, wanted, strict=True))  # type: ignore[assignment]
        self.device.write(self._params, views_record(self.views, reach))
        clips = below(item.level + high + CLIP_MARGIN_M), above(item.level + low - CLIP_MARGIN_M)
        for layer, (view, scene, clip) in enumerate(zip(self.views, self._scenes, clips, strict=True)):
            if view is not None:
                scene.draw(
                    encoder,
                    _layer(self._colors, layer),
                    _layer(self._depths, layer),
                    surroundings,
                    Shown(clip, cull_back_faces=quality.cull_back_faces, stand_ins=True),
                    view,
                    size,
                    sky=True,
                    timer=timer,
                    label=LABELS[layer],
                    kept=kept,
                    waters=layer == 0,
                )

    def _cameras(self, view: View, basin: Basin, quality: WaterQuality) -> tuple[View | None, View | None]:
        """Those of before while the camera stands: they cost as much as a small picture."""
        seen = view.view_from_world.tobytes(), view.projection.tobytes(), view.near_m, view.far_m
        wanted = (*seen, basin, quality.cameras, quality.field_of_view)
        if wanted != self._wanted:
            self._wanted = wanted
            self._taken = pictures(view, basin, quality.cameras, quality.field_of_view)
        return self._taken

    def read(self, layer: int) -> tuple[np.ndarray, np.ndarray]:
        """(H, W, 3) radiance and (H, W) reversed depth of a picture, to look at."""
        color = self.device.read_texture(self._colors, layer=layer)[..., :3]
        return color, self.device.read_texture(self._depths, layer=layer)[..., 0]

    def _use_size(self, size: tuple[int, int]) -> bool:
        """Have pictures of a size; tells whether they are those of before."""
        if self._colors is not None and (self._colors.width, self._colors.height) == size:
            return True
        usage = ("sample", "render")
        self._colors = self.device.texture(size=size, format=self.format, layers=2, usage=usage, label=NAMES[0])
        self._depths = self.device.texture(size=size, format=DEPTH_FORMAT, layers=2, usage=usage, label=NAMES[1])
        self._stacks = [t.create_view(dimension="2d-array") for t in (self._colors, self._depths)]
        return False


def needs_pictures(quality: WaterQuality) -> bool:
    """Whether anything is looked up in pictures at all."""
    return any(wanted_pictures(quality, None, 0.0))


def quality_seen_from(view: View, quality: WaterQuality, level_m: float, range_m: tuple[float, float]) -> WaterQuality:
    """What is left of a quality for a camera: rays instead of look-ups between the trough and the crest of the waves.

    There it sees the surface from both sides, and the pictures are those of one. The thesis looks up what it sees from
    below in any case; that stays.

    Parameters
    ----------
    range_m : lowest and highest wave of the moment, over the level.
    """
    low, high = (level_m + wave for wave in range_m)
    if quality.underside == "mihalik" or not low - view.near_m < view.position[1] < high + view.near_m:
        return quality
    mirrored = "rays" if quality.reflection in ("march", "point") else quality.reflection
    return quality.replace(refraction="rays", reflection=mirrored)


def wanted_pictures(quality: WaterQuality, view: View | None, level_m: float) -> tuple[bool, bool]:
    """Which of the two are looked up, below and above; from any place where no view is given."""
    may_look_up = view is None or bool(view.position[1] < level_m)
    both = may_look_up and quality.underside == "mihalik"
    return both or quality.refraction in ("march", "iteration"), both or quality.reflection in ("march", "point")


def hidden_box(item: Water, limits_m: tuple[float, float], view: View) -> Box | None:
    """Box below the lowest wave, which a camera outside of the water sees through the surface or not at all.

    None where the water has borders of its own: it is seen through those too.

    Parameters
    ----------
    limits_m : lowest and highest wave over the level. view : the camera.
    """
    (x0, z0), (x1, z1) = item.bounds_m
    # Walls that stand at the border are no part of it: from outside they cover the water.
    wall_x, wall_z = (HIDDEN_SHARE * size for size in item.size_m)
    x, y, z = view.position
    over = y > item.level + limits_m[1] + view.near_m
    aside = x < x0 - view.near_m or x > x1 + view.near_m or z < z0 - view.near_m or z > z1 + view.near_m
    if view.is_orthographic or not (over or aside) or item.shape.kind != PART:
        return None
    top = item.level + limits_m[0] - HIDDEN_MARGIN_M
    return (x0 + wall_x, -np.inf, z0 + wall_z), (x1 - wall_x, top, z1 - wall_z)


def lowest_and_highest(surroundings: Surroundings) -> tuple[float, float]:
    """Heights that all meshes lie between, metres."""
    bounds = surroundings.mesh_bounds_ws
    return min((float(b[0][1]) for b in bounds), default=0.0), max((float(b[1][1]) for b in bounds), default=0.0)


def basin_of(item: Water, quality: WaterQuality, slope: float, reach: tuple[float, float]) -> Basin:
    """What cameras need to know: what is too deep to be seen through the water has no place in the picture."""
    matter = item.matter
    extinction = np.asarray(matter.absorption_rgb_per_m) + np.asarray(matter.scattering_rgb_per_m)
    clear = float(extinction.min()) if quality.color == "physical" else item.clarity_per_m
    sight = -np.log(VISIBILITY) / clear if clear > 0.0 else np.inf
    low, high = item.bounds_m
    bottom = max(min(reach[0], item.level), item.level - float(sight))
    steepest = _steepest(item, slope)
    return Basin(item.level, low, high, steepest, item.matter.n_d, item.ambient_n, bottom, reach[1])


def _steepest(item: Water, now: float) -> float:
    """Slope that cameras count with: where it can be, the same at all times, so that one picture serves many."""
    expected = getattr(item.waves, "steepest", None)
    return _in_steps(now) if expected is None else float(expected)


def _in_steps(slope: float) -> float:
    """The next power of 2^(1/4), which changes seldom."""
    return float(2.0 ** (np.ceil(4.0 * np.log2(slope)) / 4.0)) if slope > 0.0 else 0.0


def views_record(views: tuple[View | None, View | None], reach: tuple[float, float]) -> np.ndarray:
    """(1,) structured array of dtype `layouts.WaterViews`; a picture that is missing shows no point."""
    record = np.zeros(1, WaterViews)
    for layer, view in enumerate(views):
        record["limit"][0, layer, 0] = reach[layer]
        if view is not None:
            record["clip_from_world"][0, layer] = (view.projection @ view.view_from_world).T
            record["position"][0, layer] = *view.position, view.near_m
            record["forward"][0, layer] = *view.axes[2], view.far_m if view.is_orthographic else 0.0
    return record


def _layer(texture: Any, layer: int) -> Any:
    return texture.create_view(dimension="2d", base_array_layer=layer, array_layer_count=1)
