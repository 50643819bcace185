"""What comes out of a render: radiance, depth, timings, and the ways to keep or show them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from pellucid.errors import AssetError

Singles = npt.NDArray[np.float32]


class Frame:
    """One rendered picture.

    What was rendered stays on the device until `radiance` or `depth` are asked for: copying them takes longer than
    copying the picture for a screen.

    Parameters
    ----------
    radiance : (H, W, 3) float32, linear Rec.709, scene-referred, never clamped; colours purer than Rec.709, which
        matter with many wavelengths makes, have negative components. Row 0 is the top. Or what gives it when called.
    depth : (H, W) float32, metres along the view axis to the first surface, inf where nothing is; or what gives it.
    display : (H, W, 3) uint8, after exposure, tone mapping and sRGB encoding.
    timings : {pass: milliseconds}; the device's own clock for passes, the wall clock for "prepare", "illuminate" (the
        picture is encoded meanwhile) and "total", which ends when `display` is there.
    """

    def __init__(
        self,
        radiance: Singles | Callable[[], Singles],
        depth: Singles | Callable[[], Singles],
        display: npt.NDArray[np.uint8],
        timings: Mapping[str, float] | None = None,
    ) -> None:
        self._radiance, self._depth = radiance, depth
        self.display = display
        self.timings: dict[str, float] = dict(timings or {})

    @property
    def radiance(self) -> Singles:
        """(H, W, 3) float32, linear Rec.709, scene-referred."""
        if callable(self._radiance):
            self._radiance = self._radiance()
        return self._radiance

    @property
    def depth(self) -> Singles:
        """(H, W) float32, metres along the view axis, inf where nothing is."""
        if callable(self._depth):
            self._depth = self._depth()
        return self._depth

    def __reduce__(self) -> tuple[Any, ...]:
        """Sent elsewhere or kept in a file, a frame has all its arrays with it."""
        return Frame, (self.radiance, self.depth, self.display, self.timings)

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        picture = self.display if callable(self._radiance) else self._radiance
        return picture.shape[1], picture.shape[0]

    def srgb(self) -> np.ndarray:
        """The picture for a screen: (H, W, 3) uint8, sRGB."""
        return self.display

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the picture: ``.png`` as it is shown, ``.exr`` and ``.hdr`` as linear radiance.

        Raises
        ------
        AssetError : for another suffix, or when the file cannot be written; nothing half-written is left.
        """
        from pellucid.io.images import write_image
        from pellucid.optics import into_gamut

        target = Path(path)
        suffix = target.suffix.lower()
        if suffix == ".png":
            write_image(target, self.display)
        elif suffix in (".exr", ".hdr"):
            # That format has no negative numbers, as colours beyond Rec.709 have them.
            write_image(target, self.radiance if suffix == ".exr" else into_gamut(self.radiance).astype(np.float32))
        else:
            raise AssetError(target, f"pictures are not saved as '{suffix}'", "use .png, .exr or .hdr")
        return target

    def _repr_png_(self) -> bytes:
        """The picture in a notebook."""
        import tempfile

        with tempfile.TemporaryDirectory() as folder:
            return self.save(Path(folder) / "frame.png").read_bytes()
