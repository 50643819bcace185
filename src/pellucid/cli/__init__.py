"""The command line, `pellucid`: thin, one file a command; nothing heavy is loaded before a command needs it."""

from __future__ import annotations


def main() -> None:
    """Run the command that `sys.argv` names and exit: 0 done, 1 an error of the work, 2 an error of the call."""
    from pellucid.cli.app import run

    run()
