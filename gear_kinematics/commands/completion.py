# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin completion`: complete commands, options and files on the Tab key of a shell."""

import argparse
from collections.abc import Iterator

from gear_kinematics.commands import ExitCode

_FILES = {'FILE', 'BAG', 'BAG|CSV', 'OUT'}
"""Names of arguments that are paths."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('shell', choices=('bash', 'zsh', 'tcsh'), help='for which')


def run(options: argparse.Namespace) -> ExitCode:
    """Print the script of the shell."""
    import shtab  # noqa: PLC0415, an extra

    for action in _actions(options.program):
        if action.metavar in _FILES:
            action.complete = shtab.FILE  # type: ignore[attr-defined]
    print(shtab.complete(options.program, options.shell))
    return ExitCode.DONE


def _actions(parser: argparse.ArgumentParser) -> Iterator[argparse.Action]:
    """Yield the arguments of a parser and of its subcommands."""
    for action in parser._actions:  # noqa: SLF001, argparse has no other way
        yield action
        if isinstance(action, argparse._SubParsersAction):  # noqa: SLF001
            for subcommand in action.choices.values():
                yield from _actions(subcommand)
