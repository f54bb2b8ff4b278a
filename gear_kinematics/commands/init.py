# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin init`: a parameter file for a driver that is running."""

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.encoders import (
    add_known_ratio,
    add_new_config,
    ask_for_one_topic,
    ratio_of_teeth,
)
from gear_kinematics.commands.files import check_targets
from gear_kinematics.commands.joints import ask, can_ask, choose_joint, joints_of_arm
from gear_kinematics.commands.output import Console, announce_ros, complain
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.commissioning.analysis import Channel
from gear_kinematics.measurement.rotor_fields import kind_of_encoder, questions
from gear_kinematics.measurement.wording import shown
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import faults_in
from gear_kinematics.parameters.arm_file import add_actuators, check_new
from gear_kinematics.parameters.files import write_config
from gear_kinematics.parameters.new_config import arm_head, new_actuator, new_config, start_command
from gear_kinematics.report.document import printable
from gear_kinematics.wire.batches import JointStateBatch
from gear_kinematics.wire.nearest import among

_ASSUMED = 'could not be determined, and is assumed to be multi_turn'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('--topic', metavar='NAME', help="the driver's topic, if there are several")
    text = "the rotor's joint, if there are several; with --arm those of all its motors"
    parser.add_argument('--joint', metavar='NAME', nargs='+', default=[], help=text)
    add_known_ratio(
        parser,
        'ratio of the gear, such as -19 or 1457/26; negative if the output turns '
        'against the rotor (default: asked for); with --arm also one for each joint, such as '
        'shoulder=-101 elbow=-51',
        several=True,
    )
    text = 'set up all joints of the topic, or those given, as actuators named like them'
    arguments.group(parser, 'gear').add_argument('--arm', action='store_true', help=text)
    add_new_config(parser)


def run(options: argparse.Namespace) -> ExitCode:
    path = Path(options.output)
    if options.arm and options.actuator:
        raise ValueError('--arm names actuators like their joints: leave out --actuator')
    if not options.arm:
        check_new(path, options.actuator)
    check_targets(options, {} if path.exists() else {'-o': options.output})
    announce_ros(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import list_drivers  # noqa: PLC0415

    drivers = listen()
    list_drivers(drivers, Console())
    joints = [Channel(driver.topic, joint) for driver in drivers for joint in driver.joints]
    if options.arm:
        chosen = joints_of_arm(joints, options.topic or '', options.joint)
    elif len(options.joint) > 1:
        raise ValueError('--joint takes several joints only with --arm')
    else:
        given = Channel(options.topic or '', *(options.joint or ['']))
        chosen = [choose_joint(joints, given, 'rotor', '; gearkin init --arm sets up all')]
    topic = chosen[0].topic
    ratios = _ratios(options, [channel.joint for channel in chosen])
    heard = next(driver.messages for driver in drivers if driver.topic == topic)
    data, received = JointStateBatch([m[2] for m in heard]), [m[1] for m in heard]
    encoders = {joint: kind_of_encoder(data, received, joint) for joint in ratios}
    found = {
        joint: (ratio, options.teeth, {e.name: e.value for e in encoders[joint] if e.value})
        for joint, ratio in ratios.items()
    }
    command = start_command(topic, str(path))
    if options.arm or options.actuator:
        blocks = {
            options.actuator or _actuator(joint): new_actuator(topic, joint, *gear)
            for joint, gear in found.items()
        }
        if len(blocks) < len(ratios):
            raise ValueError('two joints have nearly the same name: add each with --actuator')
        add_actuators(path, blocks, arm_head(command))
        ask_for_one_topic(path)
        print(f'{path}: added {", ".join(map(printable, blocks))}. Start the node:')
    else:
        [(joint, ratio)] = ratios.items()
        write_config(path, new_config(topic, joint, str(path), *found[joint]))
        print(
            f'{path} is for the joint {printable(joint)} on {topic}, with the gear ratio {ratio}. '
            'Start the node:'
        )
    print(f'    {command}')
    limits = NodeParameters.load().rotor_limits
    for joint, ratio in ratios.items():
        kind = [each for each in encoders[joint] if each.value != 'multi_turn']
        told = [
            f'{e.name} {f"is {shown(e.value)}" if e.value else _ASSUMED}: {e.evidence}'
            for e in kind
        ]
        asked = questions(data, received, joint, ratio, limits, steps=True)
        for question in (*told, *asked):
            complain(f'{topic}: {f"{printable(joint)}: " * options.arm}{question}')
    return ExitCode.DONE


def _ratios(options: argparse.Namespace, joints: Sequence[str]) -> dict[str, GearRatio]:
    """Return the ratio of each joint's gear, which is given or asked for."""
    given: dict[str, GearRatio] = dict(options.ratio or ())
    if len(given) < len(options.ratio or ()):
        raise ValueError('--ratio: one ratio for all joints, or one for each, such as m1=-19')
    if unknown := [name for name in given if name not in {'', *joints}]:
        raise ValueError(f'--ratio: no joint {unknown[0]!r}{among(unknown[0], joints)}')
    if options.teeth:
        given[''] = ratio_of_teeth(options.teeth)
    ratios, before = {}, ''
    for joint in joints:
        gear = f'the gear of {printable(joint)}' if options.arm else 'the gear'
        if not (ratio := given.get(joint, given.get(''))):
            if not can_ask():
                example = f'{joint}=-19' if options.arm else '-19'
                remedy = f'Give it, such as --ratio {example} or --teeth 80/76'
                remedy += '; if it is no motor, name the motors by --joint' * options.arm
                raise ValueError(f'what is the ratio of {gear}? {remedy}')
            again = f' (Enter: {before})' if before else ''
            question = (
                f'Exact ratio of {gear}, such as 1457/26, negative if the output turns against '
                f'the rotor{again}: '
            )
            ratio = ask(question, lambda answer: GearRatio.parse(answer or before))  # noqa: B023, at once
            before = str(ratio)
        ratios[joint] = ratio
    return ratios


def _actuator(joint: str) -> str:
    """Name an actuator after its joint: with allowed characters, and as no branch or parameter."""
    name = re.sub(r'\W', '_', joint, flags=re.ASCII)
    return f'joint_{name}' if faults_in({'actuators': [name]}) else name
