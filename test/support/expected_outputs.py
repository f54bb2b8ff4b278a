# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The outputs of the node to a rotor position, at 50 digits, and the comparison with them."""

from functools import cache
from typing import NamedTuple

import oracle
from live import STATES
from replaying import ACTUATOR, BOUND, assert_poses


class Settings(NamedTuple):
    """The parameters that the outputs depend on, by their names."""

    rotor_direction: int = 1
    rotor_zero: float = 0.0
    output_joint: str = 'output_shaft'
    frame_prefix: str = ''


DEFAULT = Settings()


@cache
def motion(position, zero, direction, numbers):
    rotor_angle = oracle.rotor_angle_of(position, zero, direction)
    return rotor_angle, oracle.expected_motion(numbers, rotor_angle)


def assert_output(
    topic, message, position, settings=DEFAULT, numbers=ACTUATOR, branch_names='ab'
) -> None:
    """Compare an output, without velocity and effort, with that to a position of the rotor."""
    rotor, moved = motion(position, settings.rotor_zero, settings.rotor_direction, numbers)
    prefix, shaft, unit = settings.frame_prefix, moved.output_angle, numbers.eccentricity
    if topic == 'body_poses':
        assert message.header.frame_id == f'{prefix}stator'
        assert all(pose.orientation.w >= 0.0 for pose in message.poses)
        assert_poses(message.poses, moved, numbers)
        return
    joints = {prefix + settings.output_joint: shaft}
    if topic == 'mechanism_joint_states':
        joints[f'{prefix}rotor'] = rotor
        for name, branch in zip(branch_names, moved.branches, strict=True):
            joints[f'{prefix}satellite_{name}'] = shaft - rotor
            joints[f'{prefix}oldham_{name}'] = branch.satellite_slide / unit
    assert sorted(message.name) == sorted(joints)
    for name, value in zip(message.name, message.position, strict=True):
        found = value / unit if 'oldham' in name else value
        assert oracle.angle_error(found, joints[name]) <= BOUND, name
    assert not message.velocity
    assert not message.effort


def assert_outputs(output, position, settings=DEFAULT, **gear) -> None:
    """Compare the outputs of `Peer.outputs` in the same way."""
    for topic, message in zip(STATES, output, strict=True):
        assert_output(topic, message, position, settings, **gear)
