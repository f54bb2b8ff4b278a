# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The shipped bags and their parameters; bags as rosbags reads and the project writes them."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from rosbags.rosbag2 import Reader

from gear_kinematics.bag import Message
from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.parameters import NodeParameters

BAGS = Path(__file__).resolve().parents[2] / 'bags'
CONFIGS = BAGS.parent / 'config'
JOINT_STATE, POSE_ARRAY = 'sensor_msgs/msg/JointState', 'geometry_msgs/msg/PoseArray'
ROTOR, OUTPUT, POSES = '/rotor_state', '/output_state', '/body_poses'
TYPES = {ROTOR: JOINT_STATE, OUTPUT: JOINT_STATE, POSES: POSE_ARRAY}


def config(name: str = 'actuator', **changed) -> NodeParameters:
    """Return the parameters of a shipped file, some of them changed."""
    return replace(NodeParameters.load(CONFIGS / f'{name}.yaml'), **changed)


def config_of(bag: str) -> NodeParameters:
    """Return the parameters with which a shipped bag was recorded."""
    return config('single_turn' if bag == 'single_turn_encoder' else 'actuator')


def read_bag(path: Path) -> list[Message]:
    """Read a bag by rosbags alone."""
    return [*_messages(path)]


@lru_cache(8)  # more than there are shipped bags
def _messages(path: Path) -> tuple[Message, ...]:
    with Reader(path) as reader:
        messages = reader.messages()
        return tuple((c.topic, received, bytes(data)) for c, received, data in messages)


def write_bag(path: Path, messages, types=TYPES, **form) -> Path:
    with BagWriter(path, **form) as writer:
        for topic, kind in types.items():
            writer.add_topic(topic, kind)
        writer.write_all(messages)
    return path
