# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin replay`: publish a bag's rotor topic with the timing of the recording."""

import argparse
import sys
from pathlib import Path

from gear_kinematics.bag import Bag
from gear_kinematics.bag.roles import find_rotor_topic, joints_on
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import announce_ros, message_progress, stopped_by_signals
from gear_kinematics.report.document import counted
from gear_kinematics.wire.nearest import among
from gear_kinematics.wire.topics import ROTOR_STATE


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument('bag', type=Path, metavar='BAG', help='file or folder')
    bags.add_rotor(parser, configured=False)
    playing = arguments.group(parser, 'motion')
    text = 'playback speed (default: 1)'
    playing.add_argument('--rate', type=arguments.RATE, default=1.0, help=text)
    playing.add_argument('--loop', action='store_true', help='repeat until stopped')
    playing.add_argument(
        '--no-wait', action='store_true', help='do not wait for a subscriber before the start'
    )
    arguments.add_config(
        parser,
        default='actuator.yaml beside the recording, to find the topic',
        actuator=arguments.ALL,
    )
    arguments.group(parser, 'output').add_argument(
        '--as',
        dest='published',
        default=ROTOR_STATE,
        metavar='NAME',
        help=f'publish the topic under this name (default: {ROTOR_STATE})',
    )
    arguments.add_quiet(parser)


def run(options: argparse.Namespace) -> ExitCode:
    announce_ros(participants=1)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros.replay import play  # noqa: PLC0415

    with bags.naming(options.bag), Bag(options.bag) as bag:
        topic = _topic(bag, options)
        shown = sys.stderr.isatty() and not (options.quiet or options.loop)
        total = count_due(bag, [topic]) if shown else None
        if not (options.no_wait or options.quiet):
            waiting = f'waiting for a subscriber on {options.published}'
            if options.published == ROTOR_STATE:
                waiting += ', or end this and give its topic with --as'
            print(waiting, file=sys.stderr)
        with (
            stopped_by_signals() as stopped,
            message_progress(options.bag.name, quiet=options.quiet) as progress,
        ):
            played = play(
                bag,
                topic,
                options.published,
                rate=options.rate,
                loop=options.loop,
                wait=not options.no_wait,
                stopped=stopped,
                progress=lambda sent, _: progress(sent, total),
            )
            interrupted = stopped()
    if not options.quiet:
        late = f', at most {1e3 * played.worst_delay:.1f} ms late' * bool(played.messages)
        print(counted(played.messages, 'message') + late)
    if interrupted:
        raise KeyboardInterrupt
    return ExitCode.DONE


def _topic(bag: Bag, options: argparse.Namespace) -> str:
    """Return the rotor's topic, which must have a given joint, or one of the parameters'."""
    configs = arguments.load_configs(options).values() if options.config else ()
    wanted = [each.rotor_joint for each in configs if each.rotor_joint]
    wanted = wanted or [options.joint] * bool(options.joint)
    joints = wanted or bags.joints_beside(options.bag, options)
    topic = find_rotor_topic(bag, options.rotor_topic, *joints)
    joints = joints_on(bag, [topic])[topic]
    if wanted and not {*wanted}.intersection(joints):
        hint = among(wanted[0], joints)
        raise ValueError(f'{bag.path}: {topic}: no joint {wanted[0]!r} in it{hint}')
    return topic
