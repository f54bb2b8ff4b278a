# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin init`: a parameter file for a driver that is running."""

import argparse
from pathlib import Path

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.encoders import add_known_ratio, known_ratio
from gear_kinematics.commands.joints import ask, can_ask, choose_joint
from gear_kinematics.commands.output import Console, complain, warn_of_shared_memory
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.commissioning.analysis import Channel
from gear_kinematics.measurement.rotor_fields import questions
from gear_kinematics.parameters import default_config
from gear_kinematics.parameters.new_config import new_config, start_command, write_new
from gear_kinematics.report.document import printable


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('--topic', metavar='NAME', help="the driver's topic, if there are several")
    parser.add_argument('--joint', metavar='NAME', help="the rotor's joint, if there are several")
    add_known_ratio(
        parser,
        'of the gear, such as -19 or 1457/26; negative if the output turns '
        'against the rotor (default: asked for)',
    )
    parser.add_argument(
        '-o',
        '--output',
        type=Path,
        default=default_config().name,
        metavar='FILE',
        help='the parameter file to create (default: %(default)s); it must not exist yet',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """List the drivers, and write the file."""
    path: Path = options.output
    if path.exists() or path.is_symlink():
        raise ValueError(f'{path}: exists already; give another name with -o')
    warn_of_shared_memory(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import list_drivers  # noqa: PLC0415

    drivers = listen()
    list_drivers(drivers, Console())
    joints = [Channel(driver.topic, joint) for driver in drivers for joint in driver.joints]
    given = Channel(options.topic or '', options.joint or '')
    topic, joint = choose_joint(joints, given, 'rotor')
    ratio = known_ratio(options)
    if not ratio:
        if not can_ask():
            raise ValueError(
                'which ratio has the gear? Repeat with it, such as --ratio -19 or --teeth 80/76'
            )
        text = ask('Ratio of the gear, negative if the output turns against the rotor: ')
        ratio = GearRatio.parse(text)
    write_new(path, new_config(topic, joint, str(path), ratio, options.teeth))
    print(
        f'{path} is for the joint {printable(joint)} on {topic}, with the gear ratio {ratio}. '
        'Start the node:'
    )
    print(f'    {start_command(topic, str(path))}')
    heard = next(driver.messages for driver in drivers if driver.topic == topic)
    for question in questions([m[2] for m in heard], [m[1] for m in heard], joint, ratio):
        complain(f'{topic}: {question}')
    return ExitCode.DONE
