# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The links of a URDF, and where its joints put them."""

import math
import xml.etree.ElementTree as ET
from typing import NamedTuple

import numpy as np


class Joint(NamedTuple):
    kind: str
    parent: str
    child: str
    origin: np.ndarray
    axis: np.ndarray


def read(text: str) -> tuple[list[str], dict[str, Joint]]:
    """Read links and joints the way URDF readers do, with the defaults of the format."""
    robot = ET.fromstring(text)  # noqa: S314, the project's own
    assert robot.tag == 'robot'
    joints = {}
    for element in robot.iterfind('joint'):
        origin = element.find('origin')
        xyz = '0 0 0' if origin is None else origin.get('xyz')
        assert origin is None or origin.get('rpy', '0 0 0') == '0 0 0'
        assert element.get('name') not in joints
        joints[element.get('name')] = Joint(
            element.get('type'),
            element.find('parent').get('link'),
            element.find('child').get('link'),
            np.array([float(number) for number in xyz.split()]),
            np.array([float(number) for number in element.find('axis').get('xyz').split()]),
        )
    return [element.get('name') for element in robot.iterfind('link')], joints


def link_poses(joints: dict[str, Joint], positions: dict[str, float]) -> dict[str, np.ndarray]:
    """Forward kinematics: the 4×4 pose of every link in the root's frame."""
    children = {joint.child for joint in joints.values()}
    [root] = {joint.parent for joint in joints.values()} - children
    poses = {root: np.eye(4)}
    while missing := {name for name, joint in joints.items() if joint.child not in poses}:
        for name in missing:
            joint = joints[name]
            if joint.parent in poses:
                poses[joint.child] = poses[joint.parent] @ displacement(joint, positions[name])
    return poses


def pinocchio_configuration(model, positions: dict[str, float]) -> np.ndarray:
    """Configuration of Pinocchio: continuous joints have cosine and sine of their angle."""
    q = np.zeros(model.nq)
    for name, position in positions.items():
        joint = model.joints[model.getJointId(name)]
        turns = joint.nq == 2
        value = (math.cos(position), math.sin(position)) if turns else position
        q[joint.idx_q : joint.idx_q + joint.nq] = value
    return q


def displacement(joint: Joint, position: float) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = joint.origin
    if joint.kind == 'prismatic':
        pose[:3, 3] += position * joint.axis
    else:
        assert joint.axis.tolist() == [0.0, 0.0, 1.0]
        cosine, sine = math.cos(position), math.sin(position)
        pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return pose
