# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The demo: plays the shipped bag into the node, shows its outputs live and validates them."""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from pathlib import Path

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from gear_kinematics.bag import Bag, Message
from gear_kinematics.bag.roles import Topics, corrected_beside
from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.kinematics import matrix_method
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.live import live_messages, outputs_of
from gear_kinematics.share import share_directory
from gear_kinematics.validation.report import BagReport
from gear_kinematics.validation.task import Task, Tolerances
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.batches import decode_pose_arrays
from gear_kinematics.wire.cdr import STAMP_BYTES
from gear_kinematics.wire.joint_reader import JointReader
from gear_kinematics.wire.topics import CORRECTED_STATE

TOLERANCE = 1e-12
"""Tolerance: of angles in rad, of positions in units of the eccentricity."""
BAG = 'servo_point_to_point'
"""The shipped bag that is played."""
_TOPICS = Topics()


def run(console: Console, calibration_file: Path | None = None) -> BagReport:
    """Play the shipped bag's rotor states into a node process and validate its outputs.

    The calibration, by default that of the parameters if any, raises ValueError if it is unusable.
    """
    config = NodeParameters.load()
    calibration = None
    if file := calibration_file or config.calibration:
        calibration = Calibration.load(Path(file), config.gear)
        config = replace(config, calibration=str(file))
    with Bag(share_directory() / 'bags' / BAG) as bag:
        count = sum(1 for _ in bag.messages([_TOPICS.rotor]))
        console.print(
            f'Playing {BAG}, {count} recorded rotor states, into gear_state_publisher over DDS.',
            soft_wrap=not console.is_terminal,
        )
        published = _play(console, bag, config, count)
    task = Task(
        Path(BAG),
        config,
        tolerances=Tolerances(TOLERANCE, TOLERANCE * config.eccentricity, TOLERANCE, TOLERANCE),
        strict=True,
        calibration=calibration,
    )
    corrected = corrected_beside() if calibration else {}
    # Not the node's own formulas.
    validator = Validator(task, corrected=corrected, solver=matrix_method.solve)
    validator.feed([published])
    return validator.report()


def _play(console: Console, bag: Bag, config: NodeParameters, count: int) -> list[Message]:
    if not console.is_terminal:
        return list(live_messages(bag, config))
    progress = Progress(
        TextColumn('rotor states'),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=console,
    )
    task = progress.add_task('', total=count)
    bodies = 2 * len(config.branches)
    received: list[Message] = []
    topics = {_TOPICS.rotor, *outputs_of(config)}
    with Live(progress, console=console, auto_refresh=False, transient=True) as live:

        def show(sent: int, _total: int | None) -> None:
            progress.update(task, completed=sent)
            live.update(
                Group(progress, _current(latest_complete(received, topics), bodies)), refresh=True
            )

        for message in live_messages(bag, config, progress=show):
            received.append(message)  # noqa: PERF402, `show` reads the list meanwhile
    return received


def latest_complete(messages: Sequence[Message], topics: AbstractSet[str]) -> dict[str, bytes]:
    """Return the last messages, by topic, of a stamp that all topics have; {} if there is none.

    A rotor state that the node rejects has no outputs.
    """
    by_stamp: defaultdict[bytes, dict[str, bytes]] = defaultdict(dict)
    for topic, _, data in reversed(messages):
        group = by_stamp[data[STAMP_BYTES]]
        group.setdefault(topic, data)
        if group.keys() >= topics:
            return group
    return {}


def _current(latest: Mapping[str, bytes], bodies: int) -> Table:
    """Return a table of messages of one stamp, by topic."""
    table = Table('topic', 'now', box=None)
    angles = {
        _TOPICS.rotor: 'rotor angle',
        _TOPICS.output: 'output angle',
        f'/{CORRECTED_STATE}': 'corrected angle',
    }
    for topic, name in angles.items():
        if topic in latest:
            _, _, angle, *_ = JointReader('').read(latest[topic])
            table.add_row(topic, f'{name} {angle:10.4f} rad {math.degrees(angle):10.2f}°')
    if poses := latest.get(_TOPICS.poses):
        x, y = 1e3 * decode_pose_arrays([poses], bodies).poses[0, 0, :2]
        table.add_row(_TOPICS.poses, f'satellite_a {x:+.4f} mm, {y:+.4f} mm')
    return table
