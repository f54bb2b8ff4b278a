"""`gearkin demo`: the shipped bag through the live node."""

import argparse

from rich.console import Console

from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import warn_of_shared_memory

HELP = 'the shipped bag through the live node, validated'


def add_arguments(_parser: argparse.ArgumentParser) -> None:
    """Take none."""


def run(_options: argparse.Namespace) -> ExitCode:
    """Show it live, then whether it agrees."""
    warn_of_shared_memory(participants=2)
    # Needs ROS, which most commands do without.
    from gear_kinematics.ros import demo  # noqa: PLC0415

    return ExitCode.DONE if demo.run(Console()).passed else ExitCode.FAILED
