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
    completion,
    compute,
    demo,
    describe,
    index,
    info,
    init,
    lost_motion,
    plot,
    preload,
    replay,
    urdf,
    validate,
    watch,
)
from gear_kinematics.commands.arguments import parsers
from gear_kinematics.commands.extras import remedy
from gear_kinematics.commands.origin import command_line
from gear_kinematics.commands.output import closed_pipe_ignored, complain
from gear_kinematics.state.share import version
from gear_kinematics.wire.nearest import among

COMMANDS: dict[str, Command] = {
    'info': info,
    'validate': validate,
    'compute': compute,
    'replay': replay,
    'demo': demo,
    'init': init,
    'watch': watch,
    'describe': describe,
    'index': index,
    'preload': preload,
    'lost-motion': lost_motion,
    'calibrate': calibrate,
    'plot': plot,
    'animate': animate,
    'urdf': urdf,
    'completion': completion,
}


class _Parser(argparse.ArgumentParser):
    """Reports an error in one line, without the usage, and takes -58/3 for a number."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # By its own pattern, -58/3 would be an unknown option.
        self._negative_number_matcher = re.compile(r'-\d+(/\d+)?$|-\d*\.\d+$')

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Name the nearest choice, too."""
        if action.choices is not None and value not in action.choices:
            choices = list(map(str, action.choices))
            hint = among(str(value), choices, most=len(choices))
            raise argparse.ArgumentError(action, f'invalid choice: {value!r}{hint}')

    def refuse(self, unknown: Sequence[str]) -> NoReturn:
        """Report unknown options, with those that there are, or surplus arguments."""
        message = f'unrecognized arguments: {" ".join(unknown)}'
        if options := [word for word in unknown if word.startswith('-') and word != '-']:
            known = [text for text in self._option_string_actions if text.startswith('--')]
            message += among(options[0].partition('=')[0], known, most=len(known))
        self.error(message)

    def error(self, message: str) -> NoReturn:
        """Print the message and exit."""
        complain(f'{message}; see {self.prog} --help')
        raise SystemExit(ExitCode.UNUSABLE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; returns the exit code: 0 done, 1 a check failed, 2 unusable input."""
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors='backslashreplace')  # not every encoding has a ″
    options, unknown = make_parser().parse_known_args(arguments)
    if unknown:
        options.parser.refuse(unknown)
    options.command_line = command_line(arguments)
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
    parser.set_defaults(program=parser)
    parser.add_argument('--version', action='version', version=f'gearkin {version()}')
    commands = parser.add_subparsers(title='commands', required=True, metavar='COMMAND')
    for name, command in COMMANDS.items():
        added = commands.add_parser(name, help=command.HELP, description=command.HELP)
        command.add_arguments(added)
        added.add_argument(
            '--debug', action='store_true', help='print the traceback of an unexpected error'
        )
        added.set_defaults(run=command.run)
        for each in parsers(added):
            each.set_defaults(parser=each)
    return parser
