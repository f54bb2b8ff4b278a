"""`gearkin completion`: complete commands, options and files on the Tab key of a shell."""

import argparse

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.arguments import parsers

_SHELLS = ('bash', 'zsh', 'tcsh')
_FILES = {'FILE', 'BAG', 'BAG|CSV', 'OUT'}
"""Names of arguments that are paths."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('shell', choices=_SHELLS, help='for which')


def run(options: argparse.Namespace) -> ExitCode:
    """Print the script of the shell."""
    import shtab  # noqa: PLC0415, an extra

    for parser in parsers(options.program):
        for action in parser._actions:  # noqa: SLF001, argparse has no other way
            if action.metavar in _FILES:
                action.complete = shtab.FILE  # type: ignore[attr-defined]
    print(shtab.complete(options.program, options.shell))
    return ExitCode.DONE
