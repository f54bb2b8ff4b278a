# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin demo`: play the shipped bag into the live node."""

import argparse
import math

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import Console, warn_of_shared_memory
from gear_kinematics.report.document import number
from gear_kinematics.report.text import render
from gear_kinematics.validation.document import document


def add_arguments(_parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(_options: argparse.Namespace) -> ExitCode:
    """Show the output live, then the result of the validation."""
    warn_of_shared_memory(participants=2)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros import demo  # noqa: PLC0415

    console = Console()
    report, angle = demo.run(console)
    render(document([report]), console, brief=True)
    if report.passed:
        error = number(math.degrees(report.topics[0].fields[0].max_error) * 60.0)
        console.print(
            f'The output turned by up to {math.degrees(angle):.1f}°, and each angle that the node '
            f'published is right within {error}′.\n'
            'Next: make simulator, and gearkin watch beside it; docs/first_hour.md goes on.',
            soft_wrap=True,
            highlight=False,
        )
    return ExitCode.DONE if report.passed else ExitCode.FAILED
