"""`gearkin demo`: play the shipped bag into the live node."""

import argparse
from pathlib import Path

from rich.console import Console

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import warn_of_shared_memory

HELP = 'play the shipped bag into the live node and validate its outputs'


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument(
        '--calibration',
        type=Path,
        metavar='FILE',
        help='of the gear, to show and validate the corrected output too',
    )


def run(options: argparse.Namespace) -> ExitCode:
    """Show the outputs live, then the result of the validation."""
    warn_of_shared_memory(participants=2)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros import demo  # noqa: PLC0415

    return ExitCode.DONE if demo.run(Console(), options.calibration).passed else ExitCode.FAILED
