"""`pellucid doctor`: what it tells, and that it fails where nothing can be drawn."""

from __future__ import annotations

import pytest

from pellucid.errors import NoAdapterError
from pellucid.gpu.device import adapter_remedy


def test_it_tells_what_a_report_needs(pellucid):
    said = pellucid("doctor")
    assert said.code == 0, said.out + said.err
    for words in ("wgpu", "python", "free memory", "Adapters", "max-texture-dimension-2d", "Snell's law", "ready"):
        assert words in said.out


def test_no_adapter_exits_with_1_and_the_remedy(pellucid, monkeypatch):
    def none():
        raise NoAdapterError(f"no graphics adapter was found: {adapter_remedy()}")

    monkeypatch.setattr("pellucid.gpu.device.list_adapters", lambda: [])
    monkeypatch.setattr("pellucid.session.default_device", none)
    said = pellucid("doctor")
    assert said.code == 1 and adapter_remedy() in said.err
    assert "numpy" in said.out, "the versions are told all the same"


@pytest.mark.parametrize("raised", [False, True])
def test_a_driver_that_draws_wrongly_is_found_out(pellucid, monkeypatch, raised):
    def wrong():
        if raised:
            raise RuntimeError("device lost")
        return False, "turned by 90 degrees"

    monkeypatch.setattr("pellucid.cli.doctor._bends_as_snell_says", wrong)
    monkeypatch.setattr("pellucid.cli.doctor._keeps_the_light", lambda: (True, "fine"))
    said = pellucid("doctor")
    assert said.code == 1 and "FAILED" in said.out and "ready" not in said.out
