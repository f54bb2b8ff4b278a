# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bags of each outcome for the commands that read recordings."""

from pathlib import Path
from types import MappingProxyType

import pytest
import replaying
from shipped_bags import BAGS, JOINT_STATE, TYPES, write_bag

from gear_kinematics.bag import Bag
from gear_kinematics.bag.writing import BagWriter

SAMPLES = 300
CHANGED = 100
"""Which output is changed, if one is."""


def rewrite(
    path: Path,
    edit=lambda *_: None,
    rename=lambda topic: topic,
    drop=(),
    late=MappingProxyType({}),
) -> Path:
    """Write the beginning of a servo's move, each output position as `edit` gives it.

    Topics that are `late` lack so many messages at the beginning.
    """
    number = 0
    late = dict(late)
    with Bag(BAGS / 'servo_point_to_point') as bag, BagWriter(path) as writer:
        for topic, kind in TYPES.items():
            if topic not in drop:
                writer.add_topic(rename(topic), kind)
        for k, (topic, received, data) in enumerate(bag.messages(TYPES)):
            if k == 3 * SAMPLES:
                break
            if topic in drop:
                continue
            if late.get(topic):
                late[topic] -= 1
                continue
            if topic == '/output_state':
                message = replaying.decode(data, JOINT_STATE)
                message.position = message.position.copy()
                edit(number, message.position)
                data = replaying.encode(message)  # noqa: PLW2901
                number += 1
            writer.write_all([(rename(topic), received, data)])
    return path


def off_by_2e_9(number, position) -> None:
    if number == CHANGED:
        position += 2e-9


def shifted(_, position) -> None:
    position += 0.125


@pytest.fixture(scope='session')
def bags(tmp_path_factory) -> Path:
    """Make a bag of each outcome, in a folder."""
    folder = tmp_path_factory.mktemp('bags')
    rewrite(folder / 'good')
    rewrite(folder / 'wrong', off_by_2e_9)
    rewrite(folder / 'shifted', shifted)
    rewrite(folder / 'rotor_only', drop=('/output_state', '/body_poses'))
    rewrite(folder / 'namespaced', rename=lambda topic: f'/arm{topic}')
    rewrite(folder / 'late', late={'/body_poses': 40})
    sides = (f'/{side}/rotor_state' for side in ('left', 'right'))
    write_bag(folder / 'left_and_right', [], dict.fromkeys(sides, JOINT_STATE))
    (folder / 'garbage.mcap').write_bytes(b'garbage' * 1000)
    return folder


@pytest.fixture
def other_gear(tmp_path):
    """The configuration of a gear of which only the ratio is known."""
    path = tmp_path / 'other.yaml'
    path.write_text("/**: {ros__parameters: {gear_ratio: '1457/26'}}", 'utf-8')
    return path
