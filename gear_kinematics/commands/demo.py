# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin demo`: play the shipped bag into the live node."""

import argparse
from pathlib import Path

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import Console, warn_of_shared_memory
from gear_kinematics.report.text import render
from gear_kinematics.validation.document import document


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    arguments.group(parser, 'gear').add_argument(
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

    console = Console()
    report = demo.run(console, options.calibration)
    render(document([report]), console, brief=True)
    return ExitCode.DONE if report.passed else ExitCode.FAILED
