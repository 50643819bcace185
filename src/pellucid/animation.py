"""Pictures of a scene that moves: numbered files, made one after the other, to go on with after an interruption."""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pellucid.errors import AssetError, SceneError

if TYPE_CHECKING:
    from pellucid.scene import Camera, Scene
    from pellucid.scene.placement import Light

MANIFEST = "animation.json"
"""Lies beside the frames and says how they were made."""

MOST_FRAMES = 1_000_000
FASTEST_FPS = 1000.0

SceneAt = Callable[[float], "Scene"]


def animate(
    scene_at: SceneAt,
    folder: str | PathLike[str],
    frames: int,
    fps: float = 24.0,
    size: tuple[int, int] = (800, 600),
    samples: int = 4,
    *,
    start_s: float = 0.0,
    only: tuple[int, int] | None = None,
    overwrite: bool = False,
    video: str | PathLike[str] | None = None,
    settings: Mapping[str, Any] | None = None,
    progress: Callable[[int, float], None] | None = None,
) -> list[Path]:
    """Draw the frames of an animation to ``frame_0000.png``, ``frame_0001.png`` and so on.

    A frame that is there is not drawn again, so an animation that was interrupted goes on where it stopped. What the
    frames were made with lies beside them in ``animation.json``, and other settings are refused.

    Parameters
    ----------
    scene_at : the scene at a time in seconds; frame i is drawn at start_s + i / fps. What changes inside of it
        is not noticed: draw again with `overwrite`, or let a setting change with it.
    folder : where the frames go; made when it is missing.
    frames : how many the whole animation has.
    fps : frames a second.
    size : (width, height) in pixels. samples : jittered pictures that are averaged for each frame.
    start_s : time of the first frame, seconds >= 0: water may have moved before it.
    only : (first, end) draws frames first to end - 1, as a Python slice counts.
    overwrite : draw again what is there. With other settings than before, all old frames are removed first.
    video : an ``.mp4`` to write of all frames afterwards; needs ``pip install 'pellucid[video]'``.
    settings : more that the frames depend on, for ``animation.json``; text, numbers and lists of them.
    progress : called with the number of a frame and the share of all frames asked for that is done, 0 to 1.

    Returns
    -------
    Paths of the frames asked for.

    Raises
    ------
    SceneError : a number out of range. AssetError : the folder cannot be used, or holds frames of something else.
    """
    first, end = _checked(frames, fps, start_s, only)
    target = Path(folder)
    if video is not None:
        from pellucid.io.video import check_video

        check_video(video)
    made_with = {
        "frames": frames,
        "fps": float(fps),
        "size": [int(s) for s in size],
        "samples": int(samples),
        **({"start_s": float(start_s)} if start_s else {}),
        **(settings or {}),
    }
    every = frame_paths(target, frames)
    _claim(target, every, made_with, overwrite)
    wanted = range(first, end)
    missing = [i for i in wanted if overwrite or not every[i].exists()]
    for done, i in enumerate(missing):
        before = len(wanted) - len(missing) + done
        time = start_s + i / fps
        _draw(scene_at(time), every[i], time, size, samples, _within(progress, i, before, len(wanted)))
    if video is not None:
        _write_video(video, every, fps)
    return every[first:end]


def frame_paths(folder: str | PathLike[str], frames: int) -> list[Path]:
    """Where the frames of an animation lie, whether they are there or not."""
    digits = max(4, len(str(frames - 1)))
    return [Path(folder) / f"frame_{i:0{digits}d}.png" for i in range(frames)]


def orbited(camera: Camera, degrees: float) -> Camera:
    """The camera carried about the vertical through its target; to the right as it looks, for angles above 0."""
    position = _turned(camera.position, degrees, camera.target)
    return camera.replace(position=position, up=_turned(camera.up, degrees))


def lit_from(lights: Sequence[Light], degrees: float, about: Sequence[float]) -> list[Light]:
    """Lamps carried about the vertical through a point, anticlockwise seen from above for angles above 0."""
    turned = []
    for light in lights:
        changes: dict[str, Any] = {}
        for name in ("direction", "edge_u", "edge_v"):
            if hasattr(light, name):
                changes[name] = _turned(getattr(light, name), degrees)
        if hasattr(light, "position"):
            changes["position"] = _turned(light.position, degrees, about)
        turned.append(light.replace(**changes))
    return turned


def digest(path: str | PathLike[str]) -> str:
    """Of a file's content; another one when the file has changed."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


def _turned(
    vector: Sequence[float], degrees: float, about: Sequence[float] = (0.0, 0.0, 0.0)
) -> tuple[float, float, float]:
    angle = math.radians(degrees)
    c, s = math.cos(angle), math.sin(angle)
    x, y, z = (a - b for a, b in zip(vector, about, strict=True))
    return about[0] + c * x + s * z, about[1] + y, about[2] + c * z - s * x


def _checked(frames: Any, fps: Any, start_s: Any, only: Any) -> tuple[int, int]:
    from pellucid.scene import checks

    checks.integer("animate.frames", frames, low=1, high=MOST_FRAMES)
    checks.number("animate.fps", fps, low=0.0, high=FASTEST_FPS, exclusive=True, unit="frames a second")
    checks.number("animate.start_s", start_s, low=0.0, unit="seconds")
    first, end = (0, frames) if only is None else only
    checks.integer("animate.only", first, low=0, high=frames)
    checks.integer("animate.only", end, low=0, high=frames)
    if first >= end:
        raise SceneError("animate.only", f"asks for frames {first} to {end}, which are none", "end lies behind first")
    return first, end


def _claim(folder: Path, every: list[Path], made_with: dict[str, Any], overwrite: bool) -> None:
    """Make the folder this animation's: write the manifest, or see that the one there says the same."""
    from pellucid.io.files import replacing

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        reason = f"cannot be made a folder: {error.strerror or error}"
        raise AssetError(folder, reason, "choose another folder") from None
    manifest = folder / MANIFEST
    old = sorted(folder.glob("frame_*.png"))
    there = _read_manifest(manifest, overwrite)
    if there == made_with:
        return
    if old and not overwrite:
        again = "choose another folder, or draw them again with overwrite"
        if there is None:
            raise AssetError(folder, f"holds {len(old)} frames, and no {MANIFEST} that says of what", again)
        raise AssetError(manifest, f"the {len(old)} frames there were made with {_unlike(there, made_with)}", again)
    for frame in old:
        frame.unlink(missing_ok=True)
    with replacing(manifest) as part:
        part.write_text(json.dumps(made_with, indent=2) + "\n", encoding="utf-8")


def _read_manifest(manifest: Path, overwrite: bool) -> dict[str, Any] | None:
    if not manifest.exists():
        return None
    try:
        found = json.loads(manifest.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        if overwrite and not isinstance(error, OSError):
            return None
        raise AssetError(manifest, f"cannot be read: {error}", "remove it, and the frames beside it") from None
    return found if isinstance(found, dict) else {}


def _unlike(there: dict[str, Any], here: dict[str, Any]) -> str:
    """What differs: ``size [400, 300] instead of [800, 600]``."""
    names = [name for name in {**here, **there} if there.get(name) != here.get(name)]
    return ", ".join(f"{name} {there.get(name)} instead of {here.get(name)}" for name in names)


def _draw(
    scene: Scene, path: Path, time: float, size: tuple[int, int], samples: int, progress: Callable[[float], None] | None
) -> None:
    from pellucid.session import default_renderer

    default_renderer().render(scene, size, time=time, samples=samples, progress=progress).save(path)


def _within(
    progress: Callable[[int, float], None] | None, frame: int, before: int, count: int
) -> Callable[[float], None] | None:
    """The share that is done of one frame, told as that of all."""
    if progress is None:
        return None
    progress(frame, before / count)
    return lambda share: progress(frame, (before + share) / count)


def _write_video(video: str | PathLike[str], every: list[Path], fps: float) -> None:
    from pellucid.io.video import write_video

    missing = [path.name for path in every if not path.exists()]
    if missing:
        named = ", ".join(missing[:3]) + (" ..." if len(missing) > 3 else "")
        raise AssetError(video, f"needs all frames, and {len(missing)} are missing: {named}", "draw these first")
    write_video(video, every, fps)
