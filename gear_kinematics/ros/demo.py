# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The demo: plays the shipped bag into the node, shows its output live and validates it."""

import math
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from gear_kinematics.bag import Bag, Message
from gear_kinematics.bag.roles import Topics
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.live import live_messages
from gear_kinematics.share import share_directory
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.task import Task, Tolerances
from gear_kinematics.validation.validate_bag import independent_of, with_proof
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.joint_reader import JointReader

TOLERANCE = 1e-12
"""Tolerance: of angles in rad, of positions in units of the eccentricity."""
BAG = 'servo_point_to_point'
"""The shipped bag that is played."""
_TOPICS = Topics()


def run(console: Console) -> tuple[BagReport, float]:
    """Play the shipped bag's rotor states into a node process and validate its outputs.

    Returns:
        The report, and the greatest output angle, rad.
    """
    config = NodeParameters.load()
    with Bag(share_directory() / 'bags' / BAG) as bag:
        count = sum(1 for _ in bag.messages([_TOPICS.rotor]))
        console.print(
            f'Playing {BAG}, {count} recorded rotor states, into gear_state_publisher over DDS.',
            soft_wrap=not console.is_terminal,
        )
        published, greatest = _play(console, bag, config, count)
    task = Task(
        Path(BAG),
        config,
        tolerances=Tolerances(TOLERANCE, TOLERANCE * config.eccentricity, TOLERANCE, TOLERANCE),
        strict=True,
    )
    # Not the node's own formulas.
    proof, validator = independent_of(task, _TOPICS), Validator(task, solver=matrix_method.solve)
    validator.feed([published])
    proof.take(published)
    return with_proof(validator.report(), proof), greatest


def _play(
    console: Console, bag: Bag, config: NodeParameters, count: int
) -> tuple[list[Message], float]:
    """Play the bag, and show on a terminal how far it is and where the output is."""
    received, greatest = list[Message](), 0.0
    reader = JointReader(config.output_name)
    with Progress(
        TextColumn('{task.description}'),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    ) as bars:
        task = bars.add_task('', total=count)

        def show(sent: int, _total: int | None) -> None:
            bars.update(task, completed=sent)

        for message in live_messages(bag, config, progress=show):
            received.append(message)
            topic, _, data = message
            if topic == _TOPICS.output:
                _, _, angle, *_ = reader.read(data)
                greatest = max(greatest, abs(angle))
                bars.update(task, description=f'output {math.degrees(angle):9.2f}°')
    return received, greatest
