# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Batches of messages say what the messages say one by one."""

import math
import struct

import numpy as np
import pytest
from harnesses import harness
from hypothesis import given, settings
from hypothesis import strategies as st
from live import rotor_bytes
from wire import micro_ros_bytes

from gear_kinematics.wire.batches import decode_joint_states
from gear_kinematics.wire.cdr import PoseArrayTemplate
from gear_kinematics.wire.joint_reader import JointReader

SECOND = 1_000_000_000
LARGEST = 2**51 * math.tau  # rad: beyond it a position is too large
bounds = st.sampled_from([LARGEST, math.nextafter(LARGEST, math.inf), -1e280])
numbers = st.lists(st.floats(width=64) | bounds, max_size=3)
fields = (
    st.integers(0, 50).map(lambda k: k * SECOND // 10),
    st.lists(st.sampled_from(['rotor', 'brake', 'x']), max_size=3) | st.just(['', '']),
    numbers,
    numbers,
    numbers,
)


def restamped(data: bytes, seconds: int, nanoseconds: int) -> bytes:
    """Write a stamp over another, whether or not it is normalised."""
    return data[:4] + struct.pack('<iI' if data[1] else '>iI', seconds, nanoseconds) + data[12:]


joint_states = (
    st.builds(rotor_bytes, *fields, little_endian=st.booleans())
    | st.builds(micro_ros_bytes, *fields)
    | st.builds(
        restamped,
        st.builds(rotor_bytes, *fields, little_endian=st.booleans()),
        st.integers(-4, 5) | st.just(2**31 - 1),
        st.sampled_from([0, SECOND - 1, SECOND, 2 * SECOND + 1, 2**32 - 1]),
    )
)
pose_arrays = st.builds(
    lambda stamp, frame, count: PoseArrayTemplate(frame, count).encode(
        stamp, [0.5 * k for k in range(7 * count)]
    ),
    st.integers(0, 2**60),
    st.sampled_from(['stator', 'base']),
    st.integers(3, 5),
)


@pytest.mark.slow
@settings(max_examples=80)
@given(st.lists(joint_states | pose_arrays | st.binary(max_size=40), max_size=20))
def test_batches_are_read_as_rclpy_reads_one_by_one(batch):
    harness('messages').check(harness('messages').SEPARATOR.join(batch))


def test_padding_that_is_left_to_chance_makes_no_layout():
    data = rotor_bytes(SECOND, ['abc'], [1.0], [2.0], [3.0])
    # Behind the frame id's single byte there are three bytes of padding.
    assert data[17:20] == bytes(3)
    other = data[:17] + b'xyz' + data[20:]
    batch = decode_joint_states([data, other], 'abc')
    assert not batch.malformed.any()
    reader = JointReader('abc')
    assert reader.read(other) == reader.read(data) == (SECOND, False, 1.0, 2.0, 3.0)
    np.testing.assert_array_equal(batch.values, [[1.0, 2.0, 3.0]] * 2)
