"""`gearkin demo`: play the shipped bag into the live node."""

import argparse

from rich.console import Console

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import warn_of_shared_memory

HELP = 'play the shipped bag into the live node and validate its outputs'


def add_arguments(_parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(_options: argparse.Namespace) -> ExitCode:
    """Show the outputs live, then the result of the validation."""
    warn_of_shared_memory(participants=2)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros import demo  # noqa: PLC0415

    return ExitCode.DONE if demo.run(Console()).passed else ExitCode.FAILED
