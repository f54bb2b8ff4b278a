# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin demo`: play the shipped bag into the live node."""

import argparse
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from gear_kinematics.bag import Bag, Message
from gear_kinematics.bag.roles import Topics
from gear_kinematics.bag.schedule import count_due
from gear_kinematics.commands import ExitCode
from gear_kinematics.commands.output import Console, announce_ros, progress
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number
from gear_kinematics.report.text import render
from gear_kinematics.share import share_directory
from gear_kinematics.validation.document import document
from gear_kinematics.validation.task import Task, Tolerances
from gear_kinematics.validation.validate_bag import validate_bag
from gear_kinematics.wire.joint_reader import JointReader

_TOLERANCE = 1e-12  # of angles in rad, of positions in units of the eccentricity
_BAG = 'servo_point_to_point'


def add_arguments(_parser: argparse.ArgumentParser) -> None:
    """Add no arguments."""


def run(_options: argparse.Namespace) -> ExitCode:
    announce_ros(participants=2)
    # Needs ROS, unlike most commands.
    from gear_kinematics.ros.live import ReplayError, live_messages  # noqa: PLC0415

    console, parameters, angles = Console(), NodeParameters.load(), [0.0]
    tolerances = Tolerances(*[_TOLERANCE] * 4)
    tolerances = tolerances._replace(position=_TOLERANCE * parameters.eccentricity)
    path = share_directory() / 'bags' / _BAG
    task = Task(path, parameters, tolerances=tolerances, independent=True)
    with Bag(path) as bag:
        count = count_due(bag, [Topics().rotor])
    console.print(
        f'Playing {_BAG}, {count} recorded rotor states, into gear_state_publisher over DDS.',
        soft_wrap=not console.is_terminal,
    )
    reader = JointReader(parameters.output_name)
    with progress('rotor states') as bars:
        bar = bars.add_task('', total=count)

        def play(*arguments: Any, **options: Any) -> Iterator[Message]:
            for topic, received, data in live_messages(*arguments, **options):
                if topic == Topics().output:
                    _, _, angle, *_ = reader.read(data)
                    angles.append(angle)
                    bars.update(bar, description=f'output {math.degrees(angle):9.2f}°')
                yield topic, received, data

        report = validate_bag(task, lambda sent, _: bars.update(bar, completed=sent), play)
    if report.error:
        raise ReplayError(report.error)
    render(document([replace(report, bag=_BAG)]), console, brief=True)
    if not (report.passed and report.independent):
        return ExitCode.FAILED
    greatest = math.degrees(max(map(abs, angles)))
    error = number(math.degrees(report.independent.errors['position']) * 60.0)
    console.print(
        f'The output turned by up to {greatest:.1f}°, and each angle that the node '
        f'published is right within {error}′.\n'
        'Next: make simulator, and gearkin watch beside it; docs/first_hour.md goes on.',
        soft_wrap=True,
        highlight=False,
    )
    return ExitCode.DONE
