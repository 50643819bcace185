"""Light that a lens scatters round bright things, as a pyramid of blurred pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from pellucid.gpu.kernel import RenderPass

if TYPE_CHECKING:
    from pellucid.gpu import Device
    from pellucid.gpu.timing import PassTimer

FORMAT = "rgba16float"
MAX_LEVELS = 7
SMALLEST = 4  # pixels of the shorter side of the last level


class Glow:
    """A wide blur that keeps the light of the picture: each step is a weighted mean.

    Parameters
    ----------
    device : where to draw.
    """

    def __init__(self, device: Device) -> None:
        self.device = device
        shaders = "techniques/finish/shaders"
        self._first = RenderPass(device, f"{shaders}/glow_first", targets=(FORMAT,), nearest=("radiance",))
        self._down = RenderPass(device, f"{shaders}/glow_down", targets=(FORMAT,))
        self._up = RenderPass(device, f"{shaders}/glow_up", targets=(FORMAT,))
        self._size: tuple[int, int] = (0, 0)
        self._narrow: list[Any] = []
        self._wide: list[Any] = []

    def draw(self, encoder: Any, radiance: Any, timer: PassTimer | None = None) -> Any:
        """Encode the pyramid.

        Parameters
        ----------
        radiance : texture of the picture.

        Returns
        -------
        Texture of half the size, to be magnified with linear filtering: the blurred picture.
        """
        self._use_size((radiance.width, radiance.height))
        sampler = self.device.sampler("linear", "clamp")
        self._run(self._first, encoder, self._narrow[0], {"radiance": radiance}, timer)
        for finer, coarser in zip(self._narrow, self._narrow[1:], strict=False):
            self._run(self._down, encoder, coarser, {"finer": finer, "glow_sampler": sampler}, timer)
        blurred = self._narrow[-1]
        for narrow, wide in zip(self._narrow[-2::-1], self._wide[::-1], strict=True):
            inputs = {"narrow": narrow, "coarser": blurred, "glow_sampler": sampler}
            self._run(self._up, encoder, wide, inputs, timer)
            blurred = wide
        return blurred

    def _run(self, step: RenderPass, encoder: Any, target: Any, inputs: dict[str, Any], timer: Any) -> None:
        view = target.create_view()
        step.run(encoder, color=[view], clear=[(0.0, 0.0, 0.0, 0.0)], bindings=inputs, timer=timer, label="glow")

    def _use_size(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        sizes = level_sizes(size)
        self._size = size
        self._narrow = [self._level(s, "glow narrow") for s in sizes]
        self._wide = [self._level(s, "glow wide") for s in sizes[:-1]]

    def _level(self, size: tuple[int, int], label: str) -> Any:
        return self.device.texture(size=size, format=FORMAT, usage=("sample", "render"), label=label)


def level_sizes(size: tuple[int, int]) -> list[tuple[int, int]]:
    """Sizes of the levels, each half of the one before, rounded up; the first is half of the picture."""
    sizes = [((size[0] + 1) // 2, (size[1] + 1) // 2)]
    while len(sizes) < MAX_LEVELS and min(sizes[-1]) >= 2 * SMALLEST:
        width, height = sizes[-1]
        sizes.append(((width + 1) // 2, (height + 1) // 2))
    return sizes
