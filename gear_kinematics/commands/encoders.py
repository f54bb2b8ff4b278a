# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Options of several commands for recordings of encoders and torques, and for known ratios."""

import argparse
import re
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

from gear_kinematics.commands import arguments
from gear_kinematics.commands.bags import add_encoder, add_rotor
from gear_kinematics.commands.output import complain
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.columns import GIVEN_UNITS, Sources, option
from gear_kinematics.measurement.formats import is_table
from gear_kinematics.measurement.recording import Recording
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.parameters import default_config
from gear_kinematics.report.document import printable
from gear_kinematics.wire.nearest import listed

_COLUMNS = {
    'angle': 'angle under torque',
    'torque': 'torque (default unit: by name, or N·m)',
    'rotor': 'angle of the rotor',
    'output': 'angle of the output encoder',
    'time': 'time of a row (default unit: by name, or by the sampling)',
    'output_time': 'time of the output encoder, if --time-column is that of the rotor alone',
}
_JOINT_OF = re.compile('# (?:The joint .* on|a joint of) (\\S+?)(?:, with .*)?')
"""The comment in parameter files on the joint in the next line, with its topic."""
_DRIVERS = {'rotor_joint': 'motors', 'output_encoder_joint': 'encoders'}


def add_recordings(parser: argparse.ArgumentParser, *roles: str, configured: bool = True) -> None:
    """Add the recordings and the options on how to read them; tables have roles of `_COLUMNS`.

    `load_config` applies `--ratio` and `--joint`, and `sources` returns the others. A command that
    is not `configured` takes neither parameters of the node nor a ratio.
    """
    number = '+' if configured else '*'  # --live takes their place
    text = 'ROS recording, or a table such as a CSV file'
    parser.add_argument('recordings', nargs=number, type=Path, metavar='BAG|TABLE', help=text)
    add_rotor(parser, configured=configured)
    add_encoder(parser)
    arguments.group(parser, 'gear')  # before the columns, also where the command adds to it
    if configured:
        arguments.add_config(parser)
        arguments.add_ratio(parser)
    add_columns(parser, *roles)


def add_columns(parser: argparse.ArgumentParser, *roles: str) -> None:
    """Add the options on the columns of tables, for quantities of `_COLUMNS`."""
    group = parser.add_argument_group(
        'columns of a table', "by default found by name; units may follow, as in 'ms_today [ms]'"
    )
    for role in ('time', *roles, *['output_time'] * ('output' in roles)):
        group.add_argument(option(role), metavar='NAME', help=_COLUMNS[role])
    text = 'unit of all angles (default: by name, or rad unless something contradicts it)'
    group.add_argument('--angle-unit', choices=GIVEN_UNITS, help=text)
    if 'torque' in roles:
        text = (
            'take angle and torque as those of the rotor, unless a column is named after '
            'the output'
        )
        group.add_argument('--on-rotor', action='store_true', help=text)
    of_rotor = (
        "the rotor's encoder, or of that of the angle column, for angles in counts such as "
        'motor_inc (default: from the readings)'
    )
    for name, encoder in ('rotor', of_rotor), ('output', 'the output encoder'):
        count, text = arguments.between(1, kind=int), f'counts per turn of {encoder}'
        group.add_argument(f'--{name}-counts', type=count, metavar='N', help=text)


def add_known_ratio(
    parser: argparse.ArgumentParser, purpose: str, *, several: bool = False
) -> argparse._MutuallyExclusiveGroup:
    """Add `--ratio` and `--teeth`, for `known_ratio`; `several` ratios have names of joints."""
    known = arguments.group(parser, 'gear').add_mutually_exclusive_group()
    if several:
        known.add_argument('--ratio', nargs='+', type=_named_ratio, metavar='I', help=purpose)
    else:
        known.add_argument('--ratio', type=arguments.ratio_text, metavar='I', help=purpose)
    text = 'give the ratio by the numbers of teeth of ring and satellite'
    known.add_argument('--teeth', type=teeth, metavar='ZK/ZS', help=text)
    return known


def known_ratio(options: argparse.Namespace) -> GearRatio | None:
    """Return the ratio that the options of `add_known_ratio` give, if any."""
    if options.teeth:
        return ratio_of_teeth(options.teeth)
    return GearRatio.parse(options.ratio) if options.ratio else None


def ratio_of_teeth(numbers: tuple[int, int]) -> GearRatio:
    """Return the ratio of a gear with the numbers of teeth of its ring gear and satellites."""
    ring, satellite = numbers
    return GearRatio(-satellite, ring - satellite)


def add_new_config(parser: argparse.ArgumentParser) -> None:
    """Add the options for the parameter file to write, and the actuator of an arm in it."""
    output = arguments.group(parser, 'output')
    text = (
        'parameter file to create (default: %(default)s); it must not exist, unless '
        'an actuator is added to the file of an arm'
    )
    output.add_argument('-o', '--output', default=default_config().name, metavar='FILE', help=text)
    text = 'write the gear to FILE, new or existing, as this actuator of an arm'
    output.add_argument('--actuator', default='', metavar='NAME', help=text)


def ask_for_one_topic(path: Path) -> None:
    """Say so if the file of an arm is from several topics, by the comments of its actuators."""
    topics_of: dict[str, set[str]] = {kind: set() for kind in _DRIVERS.values()}
    for comment, line in pairwise(map(str.strip, path.read_text('utf-8').split('\n'))):
        kind = _DRIVERS.get(line.partition(':')[0])
        if kind and (of_joint := _JOINT_OF.fullmatch(comment)):
            topics_of[kind].add(of_joint[1])
    for kind, topics in topics_of.items():
        if len(topics) > 1:
            complain(f'one topic has to have all {kind}: remap the drivers of {listed(topics)}')


def teeth(text: str) -> tuple[int, int]:
    """Parse the teeth of ring gear and satellite, such as 80/76."""
    ring, _, satellite = text.partition('/')
    if not (ring.isdecimal() and satellite.isdecimal() and 0 < int(satellite) < int(ring)):
        raise argparse.ArgumentTypeError(f'must be such as 80/76, not {text}')
    return int(ring), int(satellite)


def sources(options: argparse.Namespace) -> Sources:
    """Return the columns and topics that the options give."""
    names: dict[str, Any] = {role: getattr(options, f'{role}_column', None) for role in _COLUMNS}
    return Sources(
        **names,
        unit=options.angle_unit,
        on_rotor=getattr(options, 'on_rotor', False),
        rotor_counts=options.rotor_counts,
        output_counts=options.output_counts,
        rotor_topic=options.rotor_topic,
        encoder_topic=getattr(options, 'encoder_topic', None),
        command=options.command_line,
    )


def say_columns(recording: Recording, options: argparse.Namespace) -> None:
    """Print on stderr which columns of a table were read, in one line.

    Units that were assumed follow, and what cannot be true.
    """
    taken: list[object] = [', '.join(recording.columns)] if is_table(recording.path) else []
    taken += (one for one in recording.remarks if one.what is Observation.UNITS_ASSUMED)
    for clause in () if options.quiet else (*taken, *recording.faults):
        print(printable(f'{recording.name}: {clause}'), file=sys.stderr)


def _named_ratio(text: str) -> tuple[str, GearRatio]:
    """Parse a ratio, perhaps with the name of a joint before it: `shoulder=-101`."""
    name, _, ratio = text.rpartition('=')
    return name, GearRatio.parse(arguments.ratio_text(ratio))
