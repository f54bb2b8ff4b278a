# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin watch`: a running node live, on a page or in the terminal."""

import argparse

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import Console, announce_ros, stopped_by_signals


def add_arguments(parser: argparse.ArgumentParser) -> None:
    text = 'show text in the terminal, or lines in a pipe, instead of a page'
    parser.add_argument('--text', action='store_true', help=text)
    arguments.add_running(parser, 'the first one running', 'the first')


def run(options: argparse.Namespace) -> ExitCode:
    """Watch until interrupted; then raises KeyboardInterrupt, once everything is closed."""
    announce_ros(participants=1)
    # These need ROS, unlike most commands.

    if options.text:
        from gear_kinematics.watch.text import show  # noqa: PLC0415
    else:
        from gear_kinematics.watch.server import serve as show  # noqa: PLC0415, an extra
    from gear_kinematics.watch.watcher import Watcher  # noqa: PLC0415

    watcher = Watcher(options.node, options.actuator)
    with stopped_by_signals() as stopped:
        with watcher:
            show(watcher, Console(), lambda: stopped() or watcher.ended)
        if stopped():
            raise KeyboardInterrupt
    return ExitCode.DONE
