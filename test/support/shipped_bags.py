# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The shipped bags, their topics, and bags as rosbags reads them and the project writes them."""

from pathlib import Path

from rosbags.rosbag2 import Reader

from gear_kinematics.bag import Message
from gear_kinematics.bag.writing import BagWriter

BAGS = Path(__file__).resolve().parents[2] / 'bags'
CONFIGS = BAGS.parent / 'config'
JOINT_STATE, POSE_ARRAY = 'sensor_msgs/msg/JointState', 'geometry_msgs/msg/PoseArray'
ROTOR, OUTPUT, POSES = '/rotor_state', '/output_state', '/body_poses'
TYPES = {ROTOR: JOINT_STATE, OUTPUT: JOINT_STATE, POSES: POSE_ARRAY}


def read_bag(path: Path) -> list[Message]:
    """Read a bag by rosbags alone."""
    with Reader(path) as reader:
        return [(c.topic, received, bytes(data)) for c, received, data in reader.messages()]


def write_bag(path: Path, messages, types=TYPES, **form) -> Path:
    with BagWriter(path, **form) as writer:
        for topic, kind in types.items():
            writer.add_topic(topic, kind)
        writer.write_all(messages)
    return path
