"""What comes out of a render: radiance, depth, timings, and the ways to keep or show them."""

from __future__ import annotations

from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path

import numpy as np

from pellucid.errors import AssetError


@dataclass(frozen=True, eq=False)
class Frame:
    """One rendered picture.

    radiance : (H, W, 3) float32, linear Rec.709, scene-referred, never clamped; colours purer than Rec.709, which
        matter with many wavelengths makes, have negative components. Row 0 is the top.
    depth : (H, W) float32, metres along the view axis to the first surface, inf where nothing is.
    display : (H, W, 3) uint8, after exposure, tone mapping and sRGB encoding.
    timings : {pass: milliseconds}; the device's own clock for passes, the wall clock for "prepare" and "total".
    """

    radiance: np.ndarray
    depth: np.ndarray
    display: np.ndarray
    timings: dict[str, float] = field(default_factory=dict)

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in pixels."""
        return self.radiance.shape[1], self.radiance.shape[0]

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
