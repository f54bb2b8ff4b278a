# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The choice of a joint among those that are heard."""

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from gear_kinematics.report.document import printable
from gear_kinematics.wire.nearest import nearest

if TYPE_CHECKING:
    from gear_kinematics.watch.drivers import Driver


def choose_joint(
    drivers: Sequence['Driver'],
    given: tuple[str | None, str | None],
    role: str,
    options: str,
    taken: tuple[str, str] | None = None,
) -> tuple[str, str]:
    """Return the topic and the joint that are given, the only ones, or those that the user names.

    Args:
        drivers: that are heard.
        given: topic and joint, where options name them.
        role: of the joint.
        options: that name them, for messages.
        taken: topic and joint of another role.

    Raises:
        ValueError: if there is none, or there are several and nobody to ask.
    """
    topic, name = given
    if topic:
        topic = f'/{topic.removeprefix("/")}'
        known = [driver.topic for driver in drivers]
        if topic not in known:
            raise ValueError(f'no topic {topic} of type JointState{nearest(topic, known)}')
        drivers = [driver for driver in drivers if driver.topic == topic]
    joints = [(driver.topic, joint) for driver in drivers for joint in driver.joints]
    joints = [joint for joint in joints if joint != taken]
    if name:
        known = [joint for _, joint in joints]
        if name not in known:
            hint = nearest(name, known)
            raise ValueError(f'no joint {name}{hint}; there are: {", ".join(known)}')
        joints = [(topic, joint) for topic, joint in joints if joint == name]
    if len(joints) == 1:
        return joints[0]
    if not joints:
        raise ValueError(f'no message with a joint for the {role} was heard')
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        raise ValueError(f'which joint is the {role}? Choose with {options}')
    for number, (topic, joint) in enumerate(joints, 1):
        print(f'{number:3}  {printable(joint)} on {topic}')
    answer = input(f'Number of the joint of the {role}: ')
    if not (answer.isdecimal() and 1 <= int(answer) <= len(joints)):
        raise ValueError(f'{answer!r} is no number from 1 to {len(joints)}')
    return joints[int(answer) - 1]
