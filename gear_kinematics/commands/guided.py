# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The live form of `gearkin commission`: both encoders, while a person turns the output."""

import argparse
from contextlib import closing
from dataclasses import replace
from typing import TYPE_CHECKING

from gear_kinematics.commands import arguments
from gear_kinematics.commands.joints import choose_joint
from gear_kinematics.commands.output import Console, warn_of_shared_memory
from gear_kinematics.measurement.commissioning import Channel, Request

if TYPE_CHECKING:
    from gear_kinematics.measurement.commissioning.reading import Read

_WAIT = 4.0  # s; a driver may find this listener only when it announces itself, every 3 s


def add_live(parser: argparse.ArgumentParser) -> None:
    """Add the option that takes the place of recordings."""
    arguments.group(parser, 'recording').add_argument(
        '--live',
        action='store_true',
        help='hear the drivers now, and guide through turning the output by hand; Enter ends it',
    )


def read_live(options: argparse.Namespace, request: Request) -> 'Read':
    """Hear both encoders until they tell what is needed, or the user ends it.

    Raises:
        KeyboardInterrupt: on SIGINT or SIGTERM.
        ValueError: if there is nothing to hear.
    """
    if options.recordings:
        raise ValueError('--live hears the drivers; it takes no recordings')
    warn_of_shared_memory(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.ros.live import replay_node  # noqa: PLC0415
    from gear_kinematics.ros.replay import stopped_by_signals  # noqa: PLC0415
    from gear_kinematics.watch.commissioning import LiveCommissioning  # noqa: PLC0415
    from gear_kinematics.watch.drivers import listen  # noqa: PLC0415
    from gear_kinematics.watch.text import guide, list_drivers  # noqa: PLC0415

    console, drivers = Console(stderr=True), listen(_WAIT)
    list_drivers(drivers, console)
    given = options.rotor_topic, options.joint
    rotor = choose_joint(drivers, given, 'rotor', '--rotor-topic and --joint')
    given = options.encoder_topic, options.encoder_joint
    output = choose_joint(drivers, given, 'output', '--encoder-topic and --encoder-joint', rotor)
    request = replace(request, rotor=Channel(*rotor), output=Channel(*output))
    with stopped_by_signals() as stopped, replay_node('') as node:
        live = LiveCommissioning(node, request, once=True)
        with closing(live):
            guide(live, console, stopped)
        if stopped():
            raise KeyboardInterrupt
        live.finish()
    if not live.collected:
        raise ValueError(live.fault)
    options.zero_here = live.request.zero_here
    return *live.collected, request.rotor, request.output
