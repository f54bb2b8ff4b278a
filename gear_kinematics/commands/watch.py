# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin watch`: a running node live, on a page or in the terminal."""

import argparse
from functools import partial
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import Console, warn_of_shared_memory


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        '--text', action='store_true', help='in the terminal, or as lines in a pipe; no page'
    )
    parser.add_argument(
        '--node',
        default='',
        metavar='FULL_NAME',
        help='the node, such as /left/gear_state_publisher (default: the first that runs)',
    )
    parser.add_argument(
        '--record', type=Path, metavar='BAG', help='folder to record to, from the start'
    )
    parser.add_argument(
        '--port',
        type=arguments.between(0, 65535, int),
        default=0,
        help='of the page, on 127.0.0.1 (default: a free one)',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """Watch until interrupted.

    Raises:
        KeyboardInterrupt: on SIGINT or SIGTERM, when everything is closed.
    """
    if options.record and (options.record.exists() or options.record.is_symlink()):
        raise ValueError(f'{options.record}: exists already')
    warn_of_shared_memory(participants=1)
    # These need ROS, unlike most commands.
    from gear_kinematics.ros.replay import stopped_by_signals  # noqa: PLC0415

    if options.text:
        from gear_kinematics.watch.text import show  # noqa: PLC0415
    else:
        from gear_kinematics.watch.server import serve  # noqa: PLC0415, an extra

        show = partial(serve, port=options.port)
    from gear_kinematics.watch.watcher import Watcher  # noqa: PLC0415

    console = Console()
    watcher = Watcher(options.node, options.record)
    with stopped_by_signals() as stopped:
        try:
            with watcher:
                show(watcher, console, lambda: stopped() or watcher.ended)
        finally:
            if watcher.exit_message:
                console.print(watcher.exit_message, soft_wrap=True, markup=False, highlight=False)
        if stopped():
            raise KeyboardInterrupt
    return ExitCode.DONE
