"""Pipelines are made once for what they declare, with a device or with an owner."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from pellucid.errors import ShaderError
from pellucid.gpu import Pipelines

if TYPE_CHECKING:
    from pellucid.gpu import Device

KERNEL = "surroundings/shaders/query"
PASS = "surroundings/shaders/resolve_caustics"


def test_a_pipeline_is_made_once_for_the_constants_that_its_module_declares(device: Device) -> None:
    own = Pipelines(device)
    first = own.kernel(KERNEL, {"LAMPS_NEAR": 1.0, "RELIEF_PIECES": 3.0}, "irradiance")
    assert own.kernel(KERNEL, {"RELIEF_PIECES": 4.0, "LAMPS_NEAR": 1.0}, "irradiance") is first
    others = [
        own.kernel(KERNEL, {"LAMPS_NEAR": 0.0}, "irradiance"),
        own.kernel(KERNEL, {"LAMPS_NEAR": 1.0}, "camera"),
        own.kernel(KERNEL, entry="irradiance"),
    ]
    assert len({id(made) for made in (first, *others)}) == len(own) == 4


def test_options_tell_passes_apart(device: Device) -> None:
    own = Pipelines(device)
    formats = ["rgba16float"] * 2
    assert own.draw(PASS, targets=formats) is own.draw(PASS, {}, targets=list(formats))
    assert own.draw(PASS, targets=formats) is not own.draw(PASS, targets=["rgba32float"] * 2)
    assert own.draw(PASS, {"MOST": 1.0}, targets=formats) is not own.draw(PASS, targets=formats)
    assert len(own) == 3


def test_a_device_keeps_what_is_shared_and_an_owner_what_is_its_own(device: Device) -> None:
    shared, own = Pipelines(device, shared=True), Pipelines(device)
    kernel = shared.kernel(KERNEL, entry="camera")
    known = len(shared)
    assert Pipelines(device, shared=True).kernel(KERNEL, entry="camera") is kernel
    assert own.kernel(KERNEL, entry="camera") is not kernel
    assert len(own) == 1 and len(Pipelines(device, shared=True)) == known >= 1
    with pytest.raises(ShaderError):
        own.kernel(KERNEL, entry="no such entry")
    assert len(own) == 1
