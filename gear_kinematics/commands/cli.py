# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Set up, record, prove and measure the output angle of any geared joint.

For hypocycloidal gears with Oldham couplings, compute all bodies, forces and the preload as well.
"""

import argparse
import re
import shlex
import sys
from collections.abc import Sequence
from importlib import import_module
from io import TextIOWrapper
from typing import Any, NoReturn

import numpy as np

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.extras import remedy
from gear_kinematics.commands.output import closed_pipe_ignored, complain
from gear_kinematics.share import version
from gear_kinematics.wire.nearest import among

_EXIT_CODES = 'exit codes: 0 done, 1 a check failed, 2 unusable input or arguments'
GROUPS: dict[str, dict[str, tuple[str, str]]] = {
    'set up': {
        'commission': (
            'find ratio, directions, zeros and kind of encoder, and write a parameter file',
            'logs/monday -o actuator.yaml',
        ),
        'init': ('list running drivers, and write a parameter file for one', '--ratio -19'),
        'watch': ('show a running node and its driver live, and home it', '--text'),
        'home': (
            'tell a running node that the output is at its home angle now',
            '--node /left/gear_state_publisher',
        ),
    },
    'record and prove': {
        'record': ('record what running nodes receive and publish', 'monday'),
        'validate': ('compare recorded outputs with recomputed ones', 'logs/monday'),
        'compute': ('compute the outputs of a recorded rotor topic', 'logs/monday computed'),
        'replay': ("publish a bag's rotor topic with its own timing", 'logs/monday --loop'),
        'info': ('list the contents of recordings: topics, rates, joints and gaps', 'logs/*/'),
        'demo': ('play the shipped bag into the live node and validate its outputs', ''),
    },
    'measure the real gear': {
        'calibrate': (
            'calibrate the real output from recordings of the encoders at rotor and output',
            'encoder/monday encoder/tuesday -o calibration.yaml',
        ),
        'lost-motion': (
            'measure hysteresis, lost motion, stiffness, play and transmission error',
            'ramps.csv --html ramps.html --max-hysteresis 90',
        ),
        'loads': (
            'check whether the preload held in recordings, and report the forces at every joint',
            'logs/monday --config actuator.yaml',
        ),
        'preload': (
            'compute preload, torque limits and torque split, and find the pin holes for them',
            '--wanted-threshold 1 --branch-stiffness 3000 --shaft-stiffness 1000',
        ),
    },
    'the mechanism': {
        'describe': ('report ratio, mobility, vernier and teeth of a gear', '--html gear.html'),
        'index': (
            'find the pin holes for a turn of the ring gear (for a preload: gearkin preload)',
            '--degrees 0.15',
        ),
        'plot': (
            'draw figures: kinematic scheme, roses, slides, output over time',
            'output output.svg --bag logs/monday',
        ),
        'animate': ('animate the mechanism as a GIF', 'servo.gif --bag logs/monday'),
        'urdf': ('print the URDF, and write its meshes', '--meshes meshes > gear.urdf'),
        'mjcf': (
            'write the gear with its springs, play, preload and friction as a model of MuJoCo',
            '--measured ramps.json -o gear.xml',
        ),
    },
}
"""The subcommands by the headings of --help, each with its purpose and arguments as an example."""
COMMANDS = {
    name: (purpose, f'{name} {example}'.rstrip())
    for group in GROUPS.values()
    for name, (purpose, example) in group.items()
}
"""The subcommands, each with its purpose and an example."""


class _Parser(argparse.ArgumentParser):
    """Reports an error in one line, without the usage, and accepts -58/3 as a number."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        # By the pattern of argparse, -58/3 and -1e-3 would be unknown options.
        number = r'-(\d+/\d+|[\d.]+(e[-+]?\d+)?|inf|nan)$'
        self._negative_number_matcher = re.compile(number, re.IGNORECASE)
        self.set_defaults(parser=self)  # that of the innermost subcommand remains

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        """Suggest the nearest choice in the error."""
        if action.choices is not None and value not in action.choices:
            choices = list(map(str, action.choices))
            hint = among(str(value), choices, most=len(choices))
            raise argparse.ArgumentError(action, f'invalid choice: {value!r}{hint}')

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print help; argparse would ignore that it cannot be written, as to a full disk."""
        (file or sys.stderr).write(message)

    def refuse(self, unknown: Sequence[str]) -> NoReturn:
        """Report unknown options together with what is known, or surplus arguments."""
        message = f'unrecognized arguments: {" ".join(unknown)}'
        if options := [word for word in unknown if word.startswith('-') and word != '-']:
            known = [text for text in self._option_string_actions if text.startswith('--')]
            known.remove('--debug')  # hidden in --help, too
            message += among(options[0].partition('=')[0], known, most=len(known))
            if plain := [each.metavar or each.dest for each in self._get_positional_actions()]:
                message += f'; without an option: {", ".join(map(str, plain))}'
        self.error(message)

    def error(self, message: str) -> NoReturn:
        found = re.search(r"invalid (\w+) value: (?='.*'$)", message)  # the name of a function
        if found:
            whole = 'whole ' * (found[1] == 'int')
            message = message.replace(found[0], f'must be a {whole}number, not ')
        command = self.prog.partition(' ')[2]
        if 'are required' in message and command:
            message += f', as in gearkin {COMMANDS[command][1]}'
        complain(f'{message}; see {self.prog} --help')
        raise SystemExit(ExitCode.UNUSABLE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; returns the exit code: 0 done, 1 a check failed, 2 unusable input."""
    words = [*map(str, sys.argv[1:] if arguments is None else arguments)]
    if isinstance(sys.stdout, TextIOWrapper):
        sys.stdout.reconfigure(errors='backslashreplace')  # not every encoding has a ″
    called = next((word for word in words if not word.startswith('-')), '')
    try:
        # Overflows can be seen in the results.
        with closed_pipe_ignored(), np.errstate(all='ignore'):
            options, unknown = make_parser(called).parse_known_args(words)
            if unknown:
                options.parser.refuse(unknown)
            options.command_line = shlex.join(['gearkin', *words])
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
    """Build the parser; imports only the `called` subcommands for their arguments, or else all."""
    listed = [
        f'{title}:\n' + ''.join(f'  {name:12} {about[0]}\n' for name, about in group.items())
        for title, group in GROUPS.items()
    ]
    parser = _Parser(
        prog='gearkin',
        description=__doc__,
        epilog='\n'.join([*listed, _EXIT_CODES]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('--version', action='version', version=f'gearkin {version()}')
    commands = parser.add_subparsers(
        title='commands', required=True, metavar='COMMAND', help='one of those below'
    )
    for name, (purpose, example) in COMMANDS.items():
        added = commands.add_parser(
            name,
            description=purpose,
            epilog=f'example:\n  gearkin {example}',
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        if called and name not in called:
            continue
        command = import_module(f'{__package__}.{name.replace("-", "_")}')
        command.add_arguments(added)
        added._action_groups.sort(key=lambda group: group.title == 'output')  # noqa: SLF001
        # Hidden: the line on an unexpected error names it, and it is of no use before.
        added.add_argument('--debug', action='store_true', help=argparse.SUPPRESS)
        added.set_defaults(run=command.run)
    return parser
