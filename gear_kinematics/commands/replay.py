"""`gearkin replay`: publish a bag's rotor topic with the timing of the recording."""

import argparse
import math
import sys
from pathlib import Path

from gear_kinematics.bag import Bag
from gear_kinematics.bag.roles import find_rotor_topic
from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import warn_of_shared_memory
from gear_kinematics.wire.topics import ROTOR_STATE

HELP = "publish a bag's rotor topic with the timing of the recording"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument('bag', type=Path, metavar='BAG')
    parser.add_argument('--rate', type=float, default=1.0, help='playback speed (default: 1)')
    parser.add_argument('--loop', action='store_true', help='repeat until stopped')
    for option, default, text in (
        ('--start-offset', 0.0, 'bag time to skip'),
        ('--duration', math.inf, 'bag time to play'),
    ):
        parser.add_argument(option, type=float, default=default, metavar='S', help=text)
    parser.add_argument(
        '--topics', nargs='+', metavar='NAME', help='(default: the rotor topic, as rotor_state)'
    )
    parser.add_argument(
        '--clock', type=float, nargs='?', const=40, default=0, metavar='HZ', help='publish /clock'
    )
    parser.add_argument(
        '--no-wait', action='store_true', help='do not wait for a subscriber before the start'
    )


def run(options: argparse.Namespace) -> ExitCode:
    """Publish the messages and print their greatest delay."""
    warn_of_shared_memory(participants=1)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros.replay import play, stopped_by_signals  # noqa: PLC0415

    with Bag(options.bag) as bag, stopped_by_signals() as stopped:
        if options.topics:
            topics = {topic: topic for topic in options.topics}
        else:
            topics = {find_rotor_topic(bag): ROTOR_STATE}
        if not options.no_wait:
            print(f'waiting for a subscriber on {", ".join(topics.values())}', file=sys.stderr)
        played = play(
            bag,
            topics,
            rate=options.rate,
            loop=options.loop,
            start_offset=options.start_offset,
            duration=options.duration,
            clock=options.clock,
            stopped=stopped,
            wait=0.0 if options.no_wait else math.inf,
        )
    print(f'{played.messages} messages, at most {1e3 * played.worst_delay:.1f} ms late')
    return ExitCode.DONE
