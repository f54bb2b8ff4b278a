# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin replay`: publish a bag's rotor topic with the timing of the recording."""

import argparse
import math
import sys
from pathlib import Path

from gear_kinematics.bag import Bag
from gear_kinematics.bag.roles import find_rotor_topic, joints_on
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.commands import ExitCode, arguments, bags
from gear_kinematics.commands.output import message_progress, warn_of_shared_memory
from gear_kinematics.wire.nearest import among
from gear_kinematics.wire.topics import ROTOR_STATE


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('bag', type=Path, metavar='BAG')
    bags.add_rotor(parser, configured=False)
    playing = arguments.group(parser, 'motion')
    playing.add_argument('--rate', type=float, default=1.0, help='playback speed (default: 1)')
    playing.add_argument('--loop', action='store_true', help='repeat until stopped')
    for option, default, text in (
        ('--start-offset', 0.0, 'bag time to skip'),
        ('--duration', math.inf, 'bag time to play'),
    ):
        playing.add_argument(option, type=float, default=default, metavar='S', help=text)
    playing.add_argument(
        '--no-wait', action='store_true', help='do not wait for a subscriber before the start'
    )
    output = arguments.group(parser, 'output')
    output.add_argument(
        '--topics', nargs='+', metavar='NAME', help='(default: the rotor topic, as rotor_state)'
    )
    output.add_argument(
        '--as', dest='published', metavar='NAME', help='publish the topic under this name'
    )
    arguments.add_quiet(parser)


def run(options: argparse.Namespace) -> ExitCode:
    """Publish the messages and print their greatest delay."""
    warn_of_shared_memory(participants=1)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros.replay import play, stopped_by_signals  # noqa: PLC0415

    with bags.naming(options.bag), Bag(options.bag) as bag:
        topics = _topics(bag, options)
        shown = sys.stderr.isatty() and not (options.quiet or options.loop)
        span = options.start_offset, options.duration
        total = count_due(bag, topics, *span) if shown else None
        if not (options.no_wait or options.quiet):
            print(f'waiting for a subscriber on {", ".join(topics.values())}', file=sys.stderr)
        with (
            stopped_by_signals() as stopped,
            message_progress(options.bag.name, quiet=options.quiet) as progress,
        ):
            played = play(
                bag,
                topics,
                rate=options.rate,
                loop=options.loop,
                start_offset=options.start_offset,
                duration=options.duration,
                stopped=stopped,
                wait=0.0 if options.no_wait else math.inf,
                progress=lambda sent, _: progress(sent, total),
            )
            interrupted = stopped()
    if not options.quiet:
        delay = 1e3 * played.worst_delay
        print(f'{played.messages} messages, at most {delay:.1f} ms late')
    if interrupted:
        raise KeyboardInterrupt
    return ExitCode.DONE


def _topics(bag: Bag, options: argparse.Namespace) -> dict[str, str]:
    """Return the published names of the topics by those in the bag."""
    if options.topics:
        if options.rotor_topic or options.joint is not None:
            raise ValueError('--topics excludes --rotor-topic and --joint')
        if options.published and len(options.topics) > 1:
            raise ValueError(f'--as names one topic, not {len(options.topics)}')
        for topic in options.topics:
            bag.type_of(topic)
        return {topic: options.published or topic for topic in options.topics}
    topic = find_rotor_topic(bag, options.rotor_topic, options.joint or '')
    if options.joint and options.joint not in (joints := joints_on(bag, [topic])[topic]):
        hint = among(options.joint, joints)
        raise ValueError(f'{bag.path}: {topic}: no joint {options.joint!r} in it{hint}')
    return {topic: options.published or ROTOR_STATE}
