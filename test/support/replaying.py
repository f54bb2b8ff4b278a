# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a recorded rotor topic calls for, worked out from the contract alone, at 50 digits.

Nothing of `gear_kinematics` is imported here: messages are decoded by rosbags, expected values
come from the oracle's matrix products.
"""

import math
from collections import Counter
from functools import cache
from typing import NamedTuple

import oracle
from rosbags.typesys import Stores, get_typestore

TYPESTORE = get_typestore(Stores.ROS2_JAZZY)
ACTUATOR = oracle.Numbers(80, 76, 0.0011, ((0.0, 0.04), (math.pi, -0.04)))
RATIO = -19
BOUND = 1e-12
"""rad, and of positions in units of the eccentricity."""
SECOND = 1_000_000_000


class Sample(NamedTuple):
    """A rotor message that calls for an output."""

    stamp: int
    position: float
    turns: int
    """Counted by a single-turn encoder."""
    velocity: float | None
    effort: float | None


def decode(data: bytes, kind: str):
    return TYPESTORE.deserialize_cdr(data, kind)


def encode(message, *, little_endian: bool = True) -> bytes:
    kind = message.__msgtype__
    return bytes(TYPESTORE.serialize_cdr(message, kind, little_endian=little_endian))


def edited(data: bytes, kind: str, edit) -> bytes:
    """Change a message object by `edit`, also in place."""
    message = decode(data, kind)
    for name in ('position', 'velocity', 'effort'):
        if hasattr(message, name):
            setattr(message, name, getattr(message, name).copy())
    edit(message)
    return encode(message)


def stamp_of(message) -> int:
    """Return a message's stamp, ns."""
    return message.header.stamp.sec * SECOND + message.header.stamp.nanosec


def valid_samples(
    messages: list[bytes], *, joint: str = 'rotor', single_turn: bool = False
) -> tuple[list[Sample], Counter[str]]:
    """Apply the contract's table of bad input; also count what it rejects."""
    samples: list[Sample] = []
    rejected: Counter[str] = Counter()
    turns = 0
    for data in messages:
        message = decode(data, 'sensor_msgs/msg/JointState')
        if joint not in message.name:
            rejected['joint missing'] += 1
            continue
        index = message.name.index(joint)
        if index >= len(message.position):
            rejected['position missing'] += 1
            continue
        position = float(message.position[index])
        if not math.isfinite(position):
            rejected['position not finite'] += 1
            continue
        stamp = stamp_of(message)
        if samples and 0 < samples[-1].stamp - stamp <= SECOND:
            rejected['out of order'] += 1
            continue
        if single_turn and samples:
            turns -= round((position - samples[-1].position) / math.tau)
        fields = (
            float(values[index]) if index < len(values) and math.isfinite(values[index]) else None
            for values in (message.velocity, message.effort)
        )
        samples.append(Sample(stamp, position, turns, *fields))
    return samples, rejected


def assert_poses(poses, expected: oracle.Expected, numbers: oracle.Numbers) -> None:
    """Compare the poses of a PoseArray with the motion: satellites by branch, then couplings."""
    for pose, centre in zip(poses, expected.centres, strict=True):
        point, q = pose.position, pose.orientation
        assert oracle.point_error((point.x, point.y), centre, numbers.eccentricity) <= BOUND
        assert point.z == centre[2]
        assert (q.x, q.y) == (0.0, 0.0)
        assert math.isclose(math.hypot(q.z, q.w), 1.0, rel_tol=1e-15)
        turn = oracle.mp.atan2(oracle.mp.mpf(q.z), oracle.mp.mpf(q.w)) * 2
        assert oracle.turn_angle_error(turn, expected.output_angle) <= BOUND


def assert_right(
    samples: list[Sample], states: list[bytes], poses: list[bytes], *, zero: float = 0.0
) -> None:
    """Compare every output message with its sample, in order and by stamp; nothing may miss."""
    expected_motion = cache(oracle.expected_motion)
    assert len(states) == len(poses) == len(samples)
    for sample, state_data, poses_data in zip(samples, states, poses, strict=True):
        angle = oracle.rotor_angle_of(sample.position, zero, turns=sample.turns)
        expected = expected_motion(ACTUATOR, angle)
        state = decode(state_data, 'sensor_msgs/msg/JointState')
        assert stamp_of(state) == sample.stamp
        assert state.name == ['output_shaft']
        [position] = state.position
        assert oracle.angle_error(position, expected.output_angle) <= BOUND
        for values, given, factor in (
            (state.velocity, sample.velocity, 1.0 / RATIO),
            (state.effort, sample.effort, RATIO),
        ):
            wanted = [] if given is None else [given * factor]
            assert len(values) == len(wanted)
            for value, want in zip(values, wanted, strict=True):
                assert math.isclose(value, want, rel_tol=1e-15, abs_tol=0.0)

        array = decode(poses_data, 'geometry_msgs/msg/PoseArray')
        assert stamp_of(array) == sample.stamp
        assert array.header.frame_id == 'stator'
        assert_poses(array.poses, expected, ACTUATOR)
