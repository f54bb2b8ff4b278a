"""The subcommands of `gearkin`, one module each.

Each module implements `Command` and imports no other command; common functions are in `arguments`
and `output`. Commands compute nothing: their results come from the other rooms.
"""

import argparse
from enum import IntEnum
from typing import Protocol


class ExitCode(IntEnum):
    """Exit codes of `gearkin`."""

    DONE = 0
    FAILED = 1
    """A check failed."""
    UNUSABLE = 2
    """The input or the arguments are unusable; stderr has one line on the cause."""


class Command(Protocol):
    """Interface of the module of a subcommand, which has the subcommand's name."""

    def add_arguments(self, parser: argparse.ArgumentParser, /) -> None:
        """Add the arguments of the command."""

    def run(self, options: argparse.Namespace, /) -> ExitCode:
        """Run the command.

        Raises:
            ValueError, OSError, RuntimeError: if input or arguments are unusable, in one line.
        """
