"""Kinematics, validation and preload of hypocycloidal gears with Oldham couplings.

Exit codes: 0 done, 1 a check failed, 2 unusable input or arguments.
"""

import argparse
import re
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from typing import Any, NoReturn

import numpy as np

from gear_kinematics.bag.errors import unexpected
from gear_kinematics.commands import (
    Command,
    ExitCode,
    animate,
    calibrate,
    compute,
    demo,
    describe,
    index,
    lost_motion,
    plot,
    preload,
    replay,
    urdf,
    validate,
)
from gear_kinematics.commands.extras import remedy
from gear_kinematics.commands.output import closed_pipe_ignored, complain
from gear_kinematics.state.share import version

COMMANDS: dict[str, Command] = {
    'validate': validate,
    'compute': compute,
    'replay': replay,
    'demo': demo,
    'describe': describe,
    'index': index,
    'preload': preload,
    'lost-motion': lost_motion,
    'calibrate': calibrate,
    'plot': plot,
    'animate': animate,
    'urdf': urdf,
}


class _Parser(argparse.ArgumentParser):
    """Reports an error in one line, without the usage, and takes -58/3 for a number."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # By its own pattern, -58/3 would be an unknown option.
        self._negative_number_matcher = re.compile(r'-\d+(/\d+)?$|-\d*\.\d+$')

    def error(self, message: str) -> NoReturn:
        """Print the message and exit."""
        complain(f'{message}; see {self.prog} --help')
        raise SystemExit(ExitCode.UNUSABLE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; returns the exit code: 0 done, 1 a check failed, 2 unusable input."""
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors='backslashreplace')  # not every encoding has a ″
    options = make_parser().parse_args(arguments)
    code = ExitCode.DONE
    try:
        # Overflows show in the results.
        with closed_pipe_ignored(), np.errstate(all='ignore'):
            code = options.run(options)
    except (ValueError, OSError, RuntimeError) as error:
        complain(error)
        code = ExitCode.UNUSABLE
    except ImportError as error:  # an optional package, on first use
        complain(remedy(error))
        code = ExitCode.UNUSABLE
    except Exception as error:  # noqa: BLE001, the traceback is shown with --debug
        complain(unexpected(error, debug=options.debug))
        code = ExitCode.UNUSABLE
    return code


def make_parser() -> argparse.ArgumentParser:
    """Build the parser of the program, with those of its subcommands."""
    parser = _Parser(prog='gearkin', description=__doc__)
    parser.add_argument('--version', action='version', version=f'gearkin {version()}')
    commands = parser.add_subparsers(title='commands', required=True, metavar='COMMAND')
    for name, command in COMMANDS.items():
        added = commands.add_parser(name, help=command.HELP, description=command.HELP)
        command.add_arguments(added)
        added.add_argument(
            '--debug', action='store_true', help='print the traceback of an unexpected error'
        )
        added.set_defaults(run=command.run)
    return parser
