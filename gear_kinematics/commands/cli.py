"""Kinematics, validation and preload of hypocycloidal gears with Oldham couplings.

Exit codes: 0 done, 1 a check failed, 2 unusable input or arguments.
"""

import argparse
import os
import re
import shlex
import sys
from collections.abc import Sequence
from importlib import import_module
from io import TextIOWrapper
from typing import Any, NoReturn

import numpy as np

from gear_kinematics.commands import Command, ExitCode
from gear_kinematics.commands.extras import remedy
from gear_kinematics.commands.output import closed_pipe_ignored, complain
from gear_kinematics.share import version
from gear_kinematics.wire.nearest import among

COMMANDS: dict[str, str] = {
    'info': 'what is in recordings: duration, topics, rates, joints and gaps',
    'validate': 'compare recorded outputs with recomputed ones',
    'compute': 'write a bag with the outputs for a recorded rotor topic',
    'replay': "publish a bag's rotor topic with the timing of the recording",
    'demo': 'play the shipped bag into the live node and validate its outputs',
    'init': 'list the drivers that are running, and write a parameter file for one',
    'watch': 'show a running node and its driver live: on a page, or in the terminal',
    'describe': 'properties of a gear: ratio, mobility, vernier, interference of the teeth',
    'index': 'pin holes for a turn of the ring gear, a preload or the phase of branch B',
    'preload': 'preload, torque limits and torque split, and the ring turn for them',
    'lost-motion': 'lost motion, stiffness, play and transmission error from recordings',
    'calibrate': 'calibrate the real output, from recordings with an encoder at rotor and output',
    'plot': 'draw figures: kinematic scheme, roses, slides, output over time',
    'animate': 'animate the mechanism as a GIF or an MP4',
    'urdf': 'print the URDF, and write its meshes',
    'completion': 'print what completes commands in a shell',
}
"""The subcommands, each with its purpose in one line."""


class _Parser(argparse.ArgumentParser):
    """Reports an error in one line, without the usage, and takes -58/3 for a number."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # By its own pattern, -58/3 would be an unknown option.
        self._negative_number_matcher = re.compile(r'-\d+(/\d+)?$|-\d*\.\d+$')
        self.set_defaults(parser=self)  # that of the innermost subcommand remains

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
    words = [*map(str, sys.argv[1:] if arguments is None else arguments)]
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors='backslashreplace')  # not every encoding has a ″
    if not os.environ.get('COLUMNS', 'unset').strip('0'):
        del os.environ['COLUMNS']  # rich would print nothing
    called = next((word for word in words if not word.startswith('-')), '')
    try:
        parser = make_parser(*([] if called == 'completion' else [called]))
        options, unknown = parser.parse_known_args(words)
        if unknown:
            options.parser.refuse(unknown)
        options.command_line = shlex.join(['gearkin', *words])
        # Overflows show in the results.
        with closed_pipe_ignored(), np.errstate(all='ignore'):
            return int(options.run(options))
    except (ValueError, OSError, RuntimeError) as error:
        complain(error)
    except ImportError as error:  # an optional package, on first use
        complain(remedy(error))
    except Exception as error:  # noqa: BLE001, the traceback is shown with --debug
        from gear_kinematics.bag.errors import unexpected  # noqa: PLC0415, slow

        complain(unexpected(error, debug='--debug' in words))
    else:
        return ExitCode.DONE  # nobody reads the rest
    return ExitCode.UNUSABLE


def make_parser(*called: str) -> argparse.ArgumentParser:
    """Build the parser of the program.

    Args:
        called: the subcommands whose modules are imported, for their arguments; all if none.
    """
    parser = _Parser(prog='gearkin', description=__doc__)
    parser.set_defaults(program=parser)
    parser.add_argument('--version', action='version', version=f'gearkin {version()}')
    commands = parser.add_subparsers(title='commands', required=True, metavar='COMMAND')
    for name, purpose in COMMANDS.items():
        added = commands.add_parser(name, help=purpose, description=purpose)
        if called and name not in called:
            continue
        command: Command = import_module(f'{__package__}.{name.replace("-", "_")}')
        command.add_arguments(added)
        added.add_argument(
            '--debug', action='store_true', help='print the traceback of an unexpected error'
        )
        added.set_defaults(run=command.run)
    return parser
