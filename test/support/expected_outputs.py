# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The outputs of the node to a rotor position, at 50 digits, and the comparison with them."""

import math
from functools import cache
from typing import NamedTuple

import oracle
from geometry_msgs.msg import PoseArray
from live import STATES
from replaying import ACTUATOR, BOUND


class Settings(NamedTuple):
    """The parameters that the outputs depend on, by their names."""

    rotor_direction: int = 1
    rotor_zero: float = 0.0
    output_joint: str = 'output_shaft'
    frame_prefix: str = ''


DEFAULT = Settings()


class Contents(NamedTuple):
    """The content of a message: names, angles in rad, lengths in units of the eccentricity."""

    names: list[str]
    numbers: list[float]


def contents(message, unit=ACTUATOR.eccentricity) -> Contents:
    """Extract the content; joints are in the order of their names."""
    if isinstance(message, PoseArray):
        numbers = []
        for pose in message.poses:
            p, q = pose.position, pose.orientation
            numbers += [p.x / unit, p.y / unit, p.z / unit, q.x, q.y, q.z, q.w]
        return Contents([message.header.frame_id], numbers)
    found = joints(
        (name, position / (unit if 'oldham' in name else 1.0))
        for name, position in zip(message.name, message.position, strict=True)
    )
    found.numbers.extend([*message.velocity, *message.effort])
    return found


def joints(positions) -> Contents:
    found = sorted(positions)
    return Contents([name for name, _ in found], [float(position) for _, position in found])


@cache
def motion(position, zero, direction, numbers):
    rotor_angle = oracle.rotor_angle_of(position, zero, direction)
    return rotor_angle, oracle.expected_motion(numbers, rotor_angle)


@cache
def expected(position, settings, numbers, branch_names) -> dict[str, Contents]:
    """Compute the content of the three outputs."""
    rotor, moved = motion(position, settings.rotor_zero, settings.rotor_direction, numbers)
    unit, shaft, branches = numbers.eccentricity, moved.output_angle, moved.branches
    prefix, joint = settings.frame_prefix, settings.frame_prefix + settings.output_joint
    positions = [(prefix + 'rotor', rotor), (joint, shaft)]
    for name, branch in zip(branch_names, branches, strict=True):
        positions.append((f'{prefix}satellite_{name}', shaft - rotor))
        positions.append((f'{prefix}oldham_{name}', branch.satellite_slide / unit))
    cosine, sine = oracle.mp.cos_sin(shaft / 2)
    quaternion = (0, 0, sine, cosine) if cosine > 0 else (0, 0, -sine, -cosine)
    coordinates = [
        float(number)
        for centre in moved.centres
        for number in (*(length / unit for length in centre), *quaternion)
    ]
    poses = Contents([f'{prefix}stator'], coordinates)
    return dict(zip(STATES, (joints([(joint, shaft)]), poses, joints(positions)), strict=True))


def is_right(
    topic, message, position, settings=DEFAULT, *, numbers=ACTUATOR, branch_names=('a', 'b')
) -> bool:
    """Compare an output, without velocity and effort, with that to a position of the rotor."""
    found = contents(message, numbers.eccentricity)
    wanted = expected(position, settings, numbers, branch_names)[topic]
    return (found.names, len(found.numbers)) == (wanted.names, len(wanted.numbers)) and all(
        abs(a - b) <= max(BOUND, 2.0 * math.ulp(b))
        for a, b in zip(found.numbers, wanted.numbers, strict=True)
    )


def all_right(output, position, settings=DEFAULT, **gear) -> bool:
    """Compare the outputs of `Peer.outputs` in the same way."""
    return all(
        is_right(topic, message, position, settings, **gear)
        for topic, message in zip(STATES, output, strict=True)
    )
