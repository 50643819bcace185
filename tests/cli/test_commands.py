"""What every command has in common: help, version, exit codes, the form of errors."""

from __future__ import annotations

import errno
import subprocess
import sys

import pytest

COMMANDS = ("demo", "render", "animate", "trace", "media", "doctor", "bench")


def test_version(pellucid):
    import pellucid as package

    said = pellucid("--version")
    assert (said.code, said.out.strip()) == (0, f"pellucid {package.__version__}")


def test_help_names_every_command_and_an_example_of_each_use(pellucid):
    said = pellucid("--help")
    assert said.code == 0
    for name in COMMANDS:
        assert name in said.out
    assert "pellucid render bunny.ply" in said.out and "Exit codes" in said.out


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself_with_examples(pellucid, command):
    said = pellucid(command, "--help")
    assert said.code == 0 and said.err == ""
    assert f"Usage: pellucid {command}" in said.out
    assert "Examples:" in said.out


@pytest.mark.parametrize(
    "arguments",
    [
        ["draw"],
        ["--colour"],
        ["render"],
        ["render", "a.obj"],
        ["animate", "a.toml"],
        ["media", "--json"],
        ["bench", "--repeat", "0"],
    ],
)
def test_a_call_that_is_not_understood_exits_with_2(pellucid, arguments):
    said = pellucid(*arguments)
    assert said.code == 2 and said.out == ""
    assert "Usage:" in said.err


def test_a_fault_of_ours_asks_for_a_report(pellucid, monkeypatch):
    def fail():
        raise RuntimeError("the cat sat on it")

    monkeypatch.setattr("pellucid.media.names", fail)
    said = pellucid("media")
    assert said.code == 1
    assert "RuntimeError: the cat sat on it" in said.err and "report" in said.err


def test_ctrl_c_ends_with_one_clean_line(pellucid, monkeypatch):
    def interrupt():
        raise KeyboardInterrupt

    monkeypatch.setattr("pellucid.media.names", interrupt)
    said = pellucid("media")
    assert (said.code, said.err.strip()) == (1, "stopped: interrupted")


def test_a_full_disk_under_standard_output_is_no_fault_of_ours(pellucid, monkeypatch):
    def full():
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("pellucid.media.names", full)
    said = pellucid("media")
    assert said.code == 1 and said.err.startswith("error: the disk is full") and "Traceback" not in said.err


def test_help_loads_neither_device_nor_mesh_library():
    code = (
        "import sys; sys.argv = ['pellucid', '--help']\n"
        "from pellucid.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'wgpu', 'trimesh', 'OpenImageIO', 'scipy', 'pydantic'} & set(sys.modules)\n"
        "assert not heavy, heavy"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr


def test_the_installed_command_runs():
    run = subprocess.run([sys.executable, "-c", "from pellucid.cli import main; main()", "media", "nope"],
                         capture_output=True, text=True, check=False)  # fmt: skip
    assert run.returncode == 1
    assert run.stderr.startswith("error: ") and len(run.stderr.splitlines()) == 1
    assert "\x1b" not in run.stderr, "no colours where there is no terminal"
