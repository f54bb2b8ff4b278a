# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin init`: a parameter file for a driver that is running."""

import argparse
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.joints import choose_joint
from gear_kinematics.commands.output import Console, warn_of_shared_memory
from gear_kinematics.parameters import default_config
from gear_kinematics.parameters.new_config import new_config, start_command, write_new
from gear_kinematics.report.document import printable


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('--topic', metavar='NAME', help='of the driver, if there are several')
    parser.add_argument('--joint', metavar='NAME', help='of the rotor, if there are several')
    parser.add_argument(
        '-o',
        '--output',
        default=default_config().name,
        metavar='FILE',
        help='the parameter file; - is stdout (default: %(default)s)',
    )
    parser.add_argument(
        '--wait',
        type=arguments.positive,
        default=4.0,  # a driver may find this listener only when it announces itself, every 3 s
        metavar='S',
        help='time to listen; up to twice as long until all drivers have been heard '
        '(default: %(default)g)',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """List the drivers, and write the file."""
    path = Path(options.output)
    to_stdout = options.output == '-'
    if not to_stdout and (path.exists() or path.is_symlink()):
        raise ValueError(f'{path}: exists already; give another name with -o')
    warn_of_shared_memory(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import list_drivers  # noqa: PLC0415

    drivers = listen(options.wait)
    if not drivers:
        raise ValueError(
            f'no topic of type JointState in {options.wait:g} s: is the driver running, with the '
            'same ROS_DOMAIN_ID?'
        )
    console = Console(stderr=to_stdout)
    list_drivers(drivers, console)
    given = options.topic, options.joint
    topic, joint = choose_joint(drivers, given, 'rotor', '--topic and --joint')
    name = default_config().name if to_stdout else str(path)
    text = new_config(topic, joint, name)
    if to_stdout:
        print(text, end='')
    else:
        write_new(path, text)
        print(f'{path} is for the joint {printable(joint)} on {topic}. Start the node:')
        print(f'    {start_command(topic, name)}')
    return ExitCode.DONE
