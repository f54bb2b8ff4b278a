# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The wire format against rclpy, which reads and writes what the middleware does."""

import struct
import tracemalloc
from itertools import chain

import pytest
import replaying
from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion
from harnesses import harness
from hypothesis import given, settings
from hypothesis import strategies as st
from live import SECOND, rotor_bytes, rotor_state
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from wire import ENCAPSULATIONS, Wire

from gear_kinematics.wire.cdr import JointStateTemplate, MalformedMessageError, PoseArrayTemplate

texts = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=12)
doubles = st.lists(st.floats(width=64), max_size=6)
stamps = st.integers(-(2**31) * SECOND, 2**31 * SECOND - 1)
FULL = rotor_bytes(
    12_000_000_034, ['m1', 'rotor'], [1.0, 2.0], [3.0, 4.0], [5.0, 6.0], frame_id='base'
)
# Where FULL has the length of its frame id, its names, each name, and of each array.
LENGTHS = (12, 24, 28, 36, 48, 68, 92)

decode_joint_state = harness('messages').decode_joint_state
decode_pose_array = harness('messages').decode_pose_array
assert_as_rclpy = harness('messages').check
"""Holds what is decoded, if anything is, against `deserialize_message`, for both types."""


def bits(values) -> list[bytes]:
    """Give what tells NaN from NaN and 0.0 from -0.0."""
    return [struct.pack('<d', value) for value in values]


def template_values(count):
    return st.lists(st.floats(width=64), min_size=count, max_size=count)


@settings(max_examples=80)
@given(stamps, st.lists(texts, max_size=5), st.booleans(), st.booleans(), st.data())
def test_joint_state_template_gives_what_others_read_and_write(
    stamp, names, velocity, effort, data
):
    present = {'position': True, 'velocity': velocity, 'effort': effort}
    arrays = {
        field: data.draw(template_values(len(names))) if there else []
        for field, there in present.items()
    }
    template = JointStateTemplate(names, velocity=velocity, effort=effort)
    # What an earlier message has left in the template must not show.
    template.encode(-1, [7.0] * len(names) * sum(present.values()))
    encoded = template.encode(stamp, [*chain(*arrays.values())])
    assert isinstance(encoded, bytes)
    assert encoded == rotor_bytes(stamp, names, **arrays)
    message = deserialize_message(encoded, JointState)
    expected = rotor_state(stamp, names, **arrays)
    assert message.header == expected.header
    assert message.name == expected.name
    for field in present:
        assert bits(getattr(message, field)) == bits(arrays[field])


def pose_array(stamp, frame_id, numbers) -> PoseArray:
    poses = [numbers[n : n + 7] for n in range(0, len(numbers), 7)]
    message = PoseArray(
        poses=[
            Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=i, y=j, z=k, w=w))
            for x, y, z, i, j, k, w in poses
        ]
    )
    message.header = rotor_state(stamp, frame_id=frame_id).header
    return message


pose_arrays = st.integers(0, 5).flatmap(lambda count: template_values(7 * count))


@pytest.mark.slow
@settings(max_examples=80)
@given(stamps, texts, pose_arrays)
def test_pose_array_template_gives_what_others_read_and_write(stamp, frame_id, numbers):
    template = PoseArrayTemplate(frame_id, len(numbers) // 7)
    encoded = template.encode(stamp, numbers)
    message = deserialize_message(encoded, PoseArray)
    expected = pose_array(stamp, frame_id, numbers)
    assert message.header == expected.header
    assert repr(message.poses) == repr(expected.poses)  # in which NaN equals NaN
    other = replaying.decode(encoded, 'geometry_msgs/msg/PoseArray')
    assert replaying.encode(other) == encoded


@pytest.mark.parametrize(
    ('decode', 'data'),
    [
        (decode_joint_state, FULL),
        (decode_joint_state, rotor_bytes(1, ['rotor'], [1.0])),  # with empty arrays
        (decode_joint_state, rotor_bytes(1, ['rotor'], [1.0], little_endian=False)),
        (decode_pose_array, PoseArrayTemplate('stator', 2).encode(1, [0.5] * 14)),
    ],
    ids=['full', 'empty arrays', 'big endian', 'poses'],
)
def test_cut_off_message_is_malformed(decode, data):
    decode(data)
    for length in range(len(data)):
        with pytest.raises(MalformedMessageError):
            decode(data[:length])


@pytest.mark.parametrize('offset', LENGTHS)
@pytest.mark.parametrize('length', [2**31 - 1, 2**31, 2**32 - 1, 2**29, 1000])
def test_length_beyond_the_message_is_malformed_and_takes_no_memory(offset, length):
    data = bytearray(FULL)
    (original,) = struct.unpack_from('<I', data, offset)
    assert original in {2, 3, 5, 6}, 'no length stands here'
    struct.pack_into('<I', data, offset, length)
    tracemalloc.start()
    try:
        with pytest.raises(MalformedMessageError):
            decode_joint_state(bytes(data))
        assert tracemalloc.get_traced_memory()[1] < 100_000
    finally:
        tracemalloc.stop()


@given(st.binary(max_size=200), st.sampled_from([b'', b'\0\1\0\0', b'\0\0\0\0', FULL[:12]]))
def test_any_bytes_are_read_as_rclpy_reads_them(data, start):
    assert_as_rclpy(start + data)


@pytest.mark.parametrize('offset', range(len(FULL)))
def test_flipped_bits_are_read_as_rclpy_reads_them(offset):
    for bit in range(8):
        data = bytearray(FULL)
        data[offset] ^= 1 << bit
        assert_as_rclpy(bytes(data))


RAW = (b'', b'\0', b'rotor', b'rotor\0', b'ro\0tor\0', b'ro\0tor', b'rotor\0\0\0', b'\xff', b'm1')
raw_strings = st.sampled_from(RAW) | st.binary(max_size=9)
headers = st.tuples(st.integers(-(2**31), 2**31 - 1), st.integers(0, 2**32 - 1), raw_strings)


def whole(text: bytes) -> str:
    """Give what a ROS node gets of a string: up to its first zero, and always UTF-8."""
    return text.split(b'\0')[0].decode(errors='replace')


@pytest.mark.slow
@settings(max_examples=80)
@given(
    st.sampled_from(ENCAPSULATIONS), headers, st.lists(raw_strings, max_size=4), doubles, doubles,
    doubles, st.binary(max_size=40), st.integers(0, 40),
)  # fmt: skip
def test_joint_state_is_whatever_rclpy_takes(
    encapsulation, header, names, position, velocity, effort, behind, cut
):
    wire = Wire(encapsulation)
    wire.header(*header)
    wire.joint_state(names, position, velocity, effort)
    for data in (wire.data, wire.data + behind, wire.data[: len(wire.data) - cut]):
        assert_as_rclpy(data)
    message, decoded = deserialize_message(wire.data, JointState), decode_joint_state(wire.data)
    # What was written is there, in rclpy too.
    assert list(message.name) == [whole(name) for name in names]
    assert bits(message.position) == bits(position)
    assert bits(message.effort) == bits(effort)
    assert decoded.stamp == header[0] * SECOND + header[1]


@pytest.mark.slow
@settings(max_examples=80)
@given(
    st.sampled_from(ENCAPSULATIONS), headers, pose_arrays, st.binary(max_size=40),
    st.integers(0, 40),
)  # fmt: skip
def test_pose_array_is_whatever_rclpy_takes(encapsulation, header, numbers, behind, cut):
    wire = Wire(encapsulation)
    wire.header(*header)
    wire.number('I', len(numbers) // 7)
    for number in numbers:
        wire.number('d', number)
    for data in (wire.data, wire.data + behind, wire.data[: len(wire.data) - cut]):
        assert_as_rclpy(data)
    assert deserialize_message(wire.data, PoseArray).header.frame_id == whole(header[2])
    assert bits(decode_pose_array(wire.data).numbers) == bits(numbers)


@pytest.mark.parametrize('encapsulation', [(0, 4), (0, 5), (0, 12), (0, 13), (1, 1), (255, 255)])
def test_other_encapsulation_is_malformed(encapsulation):
    data = bytes(encapsulation) + FULL[2:]
    with pytest.raises(MalformedMessageError):
        decode_joint_state(data)
    assert_as_rclpy(data)
