# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin home`: tell a running node that the output shaft is at its home angle now."""

import argparse

from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.output import announce_ros, complain


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_running(parser, 'the only one running', 'all')


def run(options: argparse.Namespace) -> ExitCode:
    """Home the node, and print where the shaft was and is; a refusal fails."""
    announce_ros(participants=1)
    from gear_kinematics.watch.homing import home  # noqa: PLC0415, needs ROS

    answer = home(options.node, options.actuator)
    (print if answer.done else complain)(answer.text)
    return ExitCode.DONE if answer.done else ExitCode.FAILED
