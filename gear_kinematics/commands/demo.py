# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin demo`: play the shipped bag into the live node."""

import argparse

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import Console, warn_of_shared_memory
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
    report = demo.run(console)
    render(document([report]), console, brief=True)
    return ExitCode.DONE if report.passed else ExitCode.FAILED
