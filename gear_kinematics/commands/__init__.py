"""The subcommands of `gearkin`: a module each, with its arguments and what it runs.

A command's module has what `Command` lists. Commands import nothing of each other; what several
need is in `arguments` and `output`. Their results come from the modules below; there is no
mathematics here.
"""

import argparse
from enum import IntEnum
from typing import Protocol


class ExitCode(IntEnum):
    """What `gearkin` tells the shell."""

    DONE = 0
    FAILED = 1
    """A check failed."""
    UNUSABLE = 2
    """Of the input or the arguments, with one line on stderr."""


class Command(Protocol):
    """What a module of a subcommand has; the subcommand is called as the module is."""

    HELP: str
    """What the command is for, in a line."""

    def add_arguments(self, parser: argparse.ArgumentParser, /) -> None:
        """Say which arguments the command takes."""

    def run(self, options: argparse.Namespace, /) -> ExitCode:
        """Do it.

        Raises:
            ValueError, OSError, RuntimeError: what is unusable, as one line for the user.
        """
