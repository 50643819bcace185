"""The device: buffers and textures there and back, limits, adapters and their remedies."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from pellucid.errors import NoAdapterError, PellucidError
from pellucid.gpu import device as device_module
from pellucid.gpu.device import Device, adapter_remedy
from pellucid.gpu.readback import TEXEL

if TYPE_CHECKING:
    from collections.abc import Iterator

RNG = np.random.default_rng(5)
COLOR_FORMATS = [name for name in TEXEL if not name.startswith("depth")]


def texels(format: str, *shape: int) -> np.ndarray:
    dtype, channels = TEXEL[format]
    return RNG.integers(0, 256, (*shape, channels)).astype(dtype)


# ---- buffers ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "array",
    [
        np.zeros(0, np.float32),
        np.zeros((0, 3), np.float32),
        np.arange(3, dtype=np.uint8),
        np.arange(17, dtype=np.float16),
        np.arange(30, dtype=np.float32).reshape(5, 6)[:, ::2],
        np.array(7.0),
        np.array([True, False, True]),
        np.array([(1, 2.5), (3, 4.5)], dtype=[("a", np.uint32), ("b", np.float64)]),
    ],
    ids=["nothing", "no rows", "3 bytes", "34 bytes", "strided", "no axis", "truths", "records"],
)
def test_arrays_come_back_as_they_went(device: Device, array: np.ndarray) -> None:
    np.testing.assert_array_equal(device.read(device.buffer(array), array.dtype, array.shape), array)


def test_a_buffer_of_bytes_is_zero_and_may_be_empty(device: Device) -> None:
    assert not device.read(device.buffer(37), np.uint8, 37).any()
    assert device.buffer(0).size == 16
    assert device.read(device.buffer(0), np.float32, (0, 3)).shape == (0, 3)


def test_a_write_at_an_offset_leaves_the_rest(device: Device) -> None:
    buffer = device.buffer(np.arange(8, dtype=np.float32))
    device.write(buffer, np.array([-1, -2], np.float32), offset=8)
    assert device.read(buffer, np.float32, 8).tolist() == [0, 1, -1, -2, 4, 5, 6, 7]


@pytest.mark.parametrize(("count", "offset"), [(5, 0), (4, 4), (1, 16), (1, 2), (1, -4)])
def test_a_write_that_does_not_fit_is_refused(device: Device, count: int, offset: int) -> None:
    with pytest.raises(PellucidError, match=rf"rays: {4 * count} bytes at {offset} do not fit into 16 bytes"):
        device.write(device.buffer(16, label="rays"), np.zeros(count, np.float32), offset)


def test_more_than_there_is_cannot_be_read(device: Device) -> None:
    with pytest.raises(PellucidError, match="rays: 20 bytes asked of a buffer of 16"):
        device.read(device.buffer(16, label="rays"), np.float32, 5)


@pytest.mark.parametrize("usage", ["storage", "uniform", "vertex", "index", "indirect"])
def test_too_large_a_buffer_is_refused_before_the_driver_sees_it(
    device: Device, usage: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    limit = device.limits.get(f"max-{usage}-buffer-binding-size", device.limits["max-buffer-size"])
    monkeypatch.setattr(device, "wgpu", None)
    with pytest.raises(PellucidError, match=rf"rays: {limit + 1} bytes; this device allows {usage} .* to {limit}"):
        device.buffer(limit + 1, usage, "rays")
    with pytest.raises(PellucidError, match="rays: -1 bytes"):
        device.buffer(-1, usage, "rays")


def test_wait_returns_when_the_work_is_done(device: Device) -> None:
    device.wait()
    buffer = device.buffer(16)
    device.write(buffer, np.ones(4, np.float32))
    device.wait()
    assert device.read(buffer, np.float32, 4).tolist() == [1.0] * 4


# ---- textures --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("format", COLOR_FORMATS)
@pytest.mark.parametrize("width", [1, 13, 64])
def test_pictures_come_back_as_they_went(device: Device, format: str, width: int) -> None:
    array = texels(format, 3, width)
    np.testing.assert_array_equal(device.read_texture(device.texture(array, format=format)), array)


@pytest.mark.parametrize("format", COLOR_FORMATS)
def test_stacks_and_volumes_come_back_slice_by_slice(device: Device, format: str) -> None:
    array = texels(format, 3, 5, 7)
    for dimension in ("2d", "3d"):
        texture = device.texture(array, format=format, dimension=dimension)
        assert texture.size == (7, 5, 3)
        for k in range(3):
            np.testing.assert_array_equal(device.read_texture(texture, layer=k), array[k])


def test_the_axis_of_a_single_channel_may_be_left_out(device: Device) -> None:
    volume = texels("r32float", 2, 3, 5)[..., 0]
    texture = device.texture(volume, format="r32float", dimension="3d")
    np.testing.assert_array_equal(device.read_texture(texture, layer=1)[..., 0], volume[1])
    texture = device.texture(volume[0], format="r32float")
    np.testing.assert_array_equal(device.read_texture(texture)[..., 0], volume[0])


def test_levels_and_layers_are_apart(device: Device) -> None:
    texture = device.texture(size=(13, 6), format="rgba16float", layers=2, mips=3)
    levels = [texels("rgba16float", 2, height, width) for width, height in ((13, 6), (6, 3), (3, 1))]
    for mip, level in enumerate(levels):
        device.write_texture(texture, level, mip=mip)
    alone = texels("rgba16float", 3, 6)
    device.write_texture(texture, alone, layer=1, mip=1)
    levels[1][1] = alone
    for mip, level in enumerate(levels):
        for layer in range(2):
            np.testing.assert_array_equal(device.read_texture(texture, layer, mip), level[layer])


def test_wider_numbers_are_narrowed_to_the_format(device: Device) -> None:
    array = np.array([[[0.1, 1, 2, 3]]])
    found = device.read_texture(device.texture(array, format="rgba16float"))
    np.testing.assert_array_equal(found, array.astype(np.float16))


@pytest.mark.parametrize(
    ("array", "format", "said"),
    [
        (np.zeros((4, 5, 3), np.float32), "rgba32float", r"shape \(4, 5, 3\) does not fill .* 4 channels"),
        (np.zeros((4, 5), np.float32), "rgba32float", r"shape \(4, 5\) does not fill"),
        (np.zeros((4, 5, 4), np.float32), "rgba8unorm", "rgba8unorm takes uint8, not float32"),
        (np.zeros((0, 5, 4), np.float32), "rgba32float", "map: 5 x 0 x 1 texels; this device allows 1 x 1 x 1"),
    ],
)
def test_an_array_that_does_not_fit_its_format_is_refused(
    device: Device, array: np.ndarray, format: str, said: str
) -> None:
    with pytest.raises(PellucidError, match=said):
        device.texture(array, format=format, label="map")


def test_a_level_is_filled_whole(device: Device) -> None:
    texture = device.texture(size=(8, 8), mips=2, label="map")
    with pytest.raises(PellucidError, match=r"map: an array of shape \(8, 8, 4\) does not fill \(4, 4\)"):
        device.write_texture(texture, np.zeros((8, 8, 4), np.float32), mip=1)


@pytest.mark.parametrize(
    ("dimension", "limit", "axis"),
    [
        ("2d", "max-texture-dimension-2d", 0),
        ("2d", "max-texture-dimension-2d", 1),
        ("2d", "max-texture-array-layers", 2),
        ("3d", "max-texture-dimension-3d", 1),
        ("3d", "max-texture-dimension-3d", 2),
    ],
)
def test_too_large_a_texture_is_refused_before_the_driver_sees_it(
    device: Device, dimension: str, limit: str, axis: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    size = [1, 1, 1]
    size[axis] = device.limits[limit] + 1
    monkeypatch.setattr(device, "wgpu", None)
    with pytest.raises(PellucidError, match=f"map: {' x '.join(map(str, size))} texels; this device allows"):
        device.texture(size=size, dimension=dimension, label="map")


def test_memory_that_runs_out_within_the_limits_is_said(device: Device, monkeypatch: pytest.MonkeyPatch) -> None:
    import wgpu

    def refuse(**_: Any) -> None:
        raise wgpu.GPUOutOfMemoryError("Validation Error\n\nCaused by:\n  Not enough memory left.\n")

    monkeypatch.setattr(device, "wgpu", SimpleNamespace(create_texture=refuse, create_buffer=refuse))
    with pytest.raises(PellucidError, match=r"map: 9 x 8 x 7 texels of r32float .*: Not enough memory left\.$"):
        device.texture(size=(9, 8, 7), format="r32float", dimension="3d", label="map")
    with pytest.raises(PellucidError, match=r"rays: 32 bytes cannot be had on this device: Not enough memory left\.$"):
        device.buffer(20, label="rays")


def test_samplers_are_made_once(device: Device) -> None:
    assert device.sampler("linear", "clamp") is device.sampler("linear", ("clamp", "clamp", "clamp"))
    assert device.sampler("linear", "clamp") is not device.sampler("nearest", "clamp")
    assert device.sampler(address=("repeat", "clamp", "clamp")) is not device.sampler()
    assert device.sampler(compare="greater-equal") is not device.sampler()


# ---- adapters --------------------------------------------------------------------------------------------------


def adapter(kind: str, backend: str = "Vulkan", error: Exception | None = None) -> Any:
    def request_device_sync(**_: Any) -> Any:
        if error:
            raise error
        return SimpleNamespace(features={"timestamp-query"}, limits={"max-buffer-size": 1})

    info = {"adapter_type": kind, "backend_type": backend, "device": f"a {kind}"}
    return SimpleNamespace(info=info, features=set(), limits={}, request_device_sync=request_device_sync)


@pytest.fixture
def adapters(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Any]]:
    """What this machine is made to have."""
    import wgpu

    present: list[Any] = []
    monkeypatch.setattr(wgpu.gpu, "enumerate_adapters_sync", lambda: list(present))
    yield present


@pytest.mark.parametrize(
    ("system", "remedy", "software_remedy"),
    [
        ("Linux", "apt-get install mesa-vulkan-drivers", "apt-get install mesa-vulkan-drivers"),
        ("Darwin", "Metal is part of macOS", "macOS has none"),
        ("Windows", "install the graphics driver", "WARP is part of Windows"),
        ("Plan 9", "install a Vulkan, Metal or DirectX 12 driver", "install a Vulkan, Metal or DirectX 12 driver"),
    ],
)
def test_without_an_adapter_the_remedy_is_for_this_system(
    system: str, remedy: str, software_remedy: str, adapters: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(device_module.platform, "system", lambda: system)
    with pytest.raises(NoAdapterError, match=f"no graphics adapter was found: .*{remedy}"):
        Device.create()
    with pytest.raises(NoAdapterError, match=f"no software Vulkan driver was found: .*{software_remedy}"):
        Device.create(software=True)
    assert remedy in adapter_remedy() and software_remedy in adapter_remedy(software=True)


def test_gpus_come_before_software_unless_software_is_asked_for(adapters: list[Any]) -> None:
    adapters += [adapter("CPU"), adapter("DiscreteGPU", "OpenGL"), adapter("IntegratedGPU"), adapter("DiscreteGPU")]
    assert [a.info["adapter_type"] for a in device_module.list_adapters()] == ["DiscreteGPU", "IntegratedGPU", "CPU"]
    assert not Device.create().is_software
    made = Device.create(software=True)
    assert made.is_software and made.name == "a CPU" and made.features == {"timestamp-query"}
    adapters[:] = adapters[1:]
    with pytest.raises(NoAdapterError, match="no software Vulkan driver"):
        Device.create(software=True)


def test_an_adapter_that_does_not_open_is_named(adapters: list[Any]) -> None:
    adapters.append(adapter("DiscreteGPU", error=RuntimeError("device lost")))
    with pytest.raises(NoAdapterError, match=r"a DiscreteGPU could not be opened \(device lost\): "):
        Device.create()


# ---- what a fresh process does ---------------------------------------------------------------------------------


def fresh(code: str, **environment: str) -> str:
    variables = {k: v for k, v in os.environ.items() if k != "XDG_RUNTIME_DIR"} | environment
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=variables, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout.strip()


def test_importing_opens_nothing() -> None:
    code = "import pellucid.gpu, sys, os; print('wgpu' in sys.modules, os.environ.get('XDG_RUNTIME_DIR'))"
    assert fresh(code) == "False None"


LISTED = "from pellucid.gpu import list_adapters; import os; list_adapters(); print(os.environ['XDG_RUNTIME_DIR'])"


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no XDG_RUNTIME_DIR")
class TestRuntimeFolder:
    """Vulkan loaders want one: ours is private, and nobody else's."""

    def test_it_is_made_private(self, tmp_path: Path) -> None:
        folder = Path(fresh(LISTED, TMPDIR=str(tmp_path)))
        assert folder == tmp_path / f"pellucid-runtime-{os.getuid()}"
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700

    def test_one_that_is_set_is_kept(self, tmp_path: Path) -> None:
        assert fresh(LISTED, TMPDIR=str(tmp_path), XDG_RUNTIME_DIR="/somewhere") == "/somewhere"
        assert not list(tmp_path.iterdir())

    @pytest.mark.parametrize("trap", ["open", "link", "file"])
    def test_one_that_others_can_reach_is_not_used(self, tmp_path: Path, trap: str, monkeypatch: Any) -> None:
        expected = tmp_path / f"pellucid-runtime-{os.getuid()}"
        if trap == "open":
            expected.mkdir()
            expected.chmod(0o777)
        elif trap == "link":
            (tmp_path / "theirs").mkdir(mode=0o700)
            expected.symlink_to(tmp_path / "theirs")
        else:
            expected.write_text("")
        monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
        monkeypatch.setattr(device_module.tempfile, "tempdir", str(tmp_path))
        monkeypatch.setattr(device_module.platform, "system", lambda: "Linux")
        device_module._private_runtime_folder()
        folder = Path(os.environ["XDG_RUNTIME_DIR"])
        assert folder != expected and folder.parent == tmp_path
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
