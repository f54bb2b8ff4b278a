"""The options for the columns and topics of a recording, and for its encoders."""

import argparse

from gear_kinematics.commands import arguments
from gear_kinematics.measurement.csv_files import ANGLE_UNITS, Sources

_COLUMNS = {
    'angle': 'under torque',
    'torque': 'N·m',
    'rotor': 'angle of the rotor',
    'output': 'angle of the output encoder',
    'time': 's, unless its name ends in a unit',
}


def add_options(parser: argparse.ArgumentParser, *roles: str) -> None:
    """Add the options for the columns of a CSV file, and for encoders; see `given`."""
    group = parser.add_argument_group('columns of a CSV', 'by default found by name')
    for role in roles:
        group.add_argument(f'--{role}-column', metavar='NAME', help=_COLUMNS[role])
    group.add_argument(
        '--angle-unit', choices=ANGLE_UNITS, help='of all angles (default: by name, or rad)'
    )
    what = 'angle and torque are' if 'angle' in roles else 'the torque is'
    group.add_argument(
        '--on-rotor',
        action='store_true',
        help=f'{what} of the rotor, unless the name of the column says output',
    )
    encoders = parser.add_argument_group('encoders')
    encoders.add_argument(
        '--rotor-counts',
        '--counts',
        type=arguments.count,
        metavar='N',
        help='steps per turn of the encoder of the rotor, or of the angle column: in them are the '
        'angles of columns such as motor_inc (default: from the readings)',
    )
    encoders.add_argument(
        '--output-counts', type=arguments.count, metavar='N', help='the same of the output encoder'
    )


def given(options: argparse.Namespace) -> Sources:
    """The columns and topics given by the options."""
    names = {role: getattr(options, f'{role}_column', None) for role in _COLUMNS}
    return Sources(
        **names,
        unit=options.angle_unit,
        on_rotor=options.on_rotor,
        rotor_counts=options.rotor_counts,
        output_counts=options.output_counts,
        rotor_topic=options.rotor_topic,
        encoder_topic=options.encoder_topic,
    )
