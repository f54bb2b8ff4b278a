# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bytes as messages: decoded as rclpy decodes them or malformed, one by one and in batches.

An input is one message, or several with `SEPARATOR` between them, as a driver sends one after the
other.
"""

import math
import os
import struct
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import Any, NamedTuple

import geometry_msgs.msg
import sensor_msgs.msg
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.serialization import deserialize_message

from gear_kinematics.kinematics import Branch, Mechanism, RotorSample
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.state_messages import StateMessages
from gear_kinematics.wire.batches import decode_joint_states, decode_pose_arrays
from gear_kinematics.wire.cdr import (
    SECOND,
    STAMP_OFFSET,
    MalformedMessageError,
    MessageLayout,
    joint_state_layout,
    pose_array_layout,
)
from gear_kinematics.wire.joint_reader import RejectedInputError
from gear_kinematics.wire.topics import STATE_TOPICS

SEPARATOR = b'\xff<>\xff'

_JOINT = 'rotor'
_JOINTS = _JOINT, '', '1'
_POSES = 4
_NOW = 1_700_000_000 * SECOND  # the clock, for messages without a stamp
_SETTINGS = replace(NodeParameters.load(), rotor_joint=_JOINT, rotor_direction=-1, rotor_zero=0.5)
_NOWHERE = os.open(os.devnull, os.O_WRONLY)
_STATES = StateMessages(
    Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi))),
    output_joint='output_shaft',
    frame_prefix='',
)


class JointState(NamedTuple):
    """A decoded sensor_msgs/JointState."""

    stamp: int
    names: tuple[bytes, ...]
    position: tuple[float, ...]
    velocity: tuple[float, ...]
    effort: tuple[float, ...]


class PoseArray(NamedTuple):
    """A decoded geometry_msgs/PoseArray; the numbers are x y z, x y z w, pose after pose."""

    stamp: int
    frame_id: bytes
    numbers: tuple[float, ...]


def decode_joint_state(data: bytes) -> JointState:
    """Take out of a message all that its layout says is in it.

    Raises:
        MalformedMessageError: if it has none.
    """
    layout = joint_state_layout(data)
    stamp, arrays = _content(data, layout)
    return JointState(stamp, layout.texts[1:], *arrays)


def decode_pose_array(data: bytes) -> PoseArray:
    """As `decode_joint_state`, for the other type."""
    layout = pose_array_layout(data)
    stamp, [numbers] = _content(data, layout)
    return PoseArray(stamp, layout.texts[0], numbers)


def _content(data: bytes, layout: MessageLayout) -> tuple[int, list[tuple[float, ...]]]:
    seconds, nanoseconds = struct.unpack_from(f'{layout.order}iI', data, STAMP_OFFSET)
    arrays = [
        struct.unpack_from(f'{layout.order}{count}d', data, offset)
        for offset, count in layout.arrays
    ]
    return seconds * SECOND + nanoseconds, arrays


def check(data: bytes) -> None:
    """Hold everything that decodes messages against rclpy, and against each other.

    Raises:
        AssertionError: if they differ.
    """
    messages = data.split(SEPARATOR)
    states = [reference_joint_state(message) for message in messages]
    _assert_same([_decoded(_joint_state, message) for message in messages], states)
    for joint in _JOINTS:
        _check_joint_batch(messages, states, joint)

    arrays = [reference_pose_array(message) for message in messages]
    _assert_same([_decoded(_pose_array, message) for message in messages], arrays)
    _check_pose_batch(messages, arrays)

    for encoder in ('multi_turn', 'single_turn'):
        _check_rotor_input(messages, encoder)


def reference_joint_state(data: bytes) -> JointState | None:
    """Decode with rclpy; None where there is no JointState."""
    message = _reference(data, sensor_msgs.msg.JointState)
    if message is None:
        return None
    numbers = (tuple(values) for values in (message.position, message.velocity, message.effort))
    return JointState(_stamp(message), tuple(name.encode() for name in message.name), *numbers)


def reference_pose_array(data: bytes) -> PoseArray | None:
    """Decode with rclpy; None where there is no PoseArray."""
    message = _reference(data, geometry_msgs.msg.PoseArray)
    if message is None:
        return None
    numbers: list[float] = []
    for pose in message.poses:
        p, q = pose.position, pose.orientation
        numbers += (p.x, p.y, p.z, q.x, q.y, q.z, q.w)
    return PoseArray(_stamp(message), message.header.frame_id.encode(), tuple(numbers))


def _reference(data: bytes, kind: Any) -> Any:
    with _silence():
        try:
            return deserialize_message(data, kind)
        except rclpy_implementation.RMWError:
            return None


@contextmanager
def _silence() -> Iterator[None]:
    """Drop what the type support prints to stderr of every length beyond the message."""
    stderr = os.dup(2)
    os.dup2(_NOWHERE, 2)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)


def _stamp(message: Any) -> int:
    stamp = message.header.stamp
    return int(stamp.sec) * SECOND + int(stamp.nanosec)


def _text(raw: bytes) -> bytes:
    """Replace what is not UTF-8, as rclpy does."""
    return raw.decode(errors='replace').encode()


def _joint_state(data: bytes) -> JointState:
    message = decode_joint_state(data)
    return message._replace(names=tuple(map(_text, message.names)))


def _pose_array(data: bytes) -> PoseArray:
    message = decode_pose_array(data)
    return message._replace(frame_id=_text(message.frame_id))


def _decoded(decode: Callable[[bytes], Any], data: bytes) -> Any:
    try:
        return decode(data)
    except MalformedMessageError:
        return None


def _assert_same(found: object, expected: object) -> None:
    # In writing, NaN is the same as NaN, and 0.0 is another number than -0.0.
    assert repr(found) == repr(expected)


def _check_joint_batch(
    messages: Sequence[bytes], states: Sequence[JointState | None], joint: str
) -> None:
    batch = decode_joint_states(messages, joint)
    for row, state in enumerate(states):
        assert batch.malformed[row] == (state is None)
        if state is None:
            continue
        index = _index(state, joint)
        values = [
            None if index is None or index >= len(numbers) else numbers[index]
            for numbers in (state.position, state.velocity, state.effort)
        ]
        assert batch.stamp[row] == state.stamp
        assert batch.joint_found[row] == (index is not None)
        assert batch.present[row].tolist() == [value is not None for value in values]
        _assert_same(
            batch.values[row].tolist(), [math.nan if value is None else value for value in values]
        )


def _index(state: JointState, joint: str) -> int | None:
    """Apply the node's rule of `rotor_joint`."""
    if any(state.names):
        names = [name.decode() for name in state.names]
    else:
        names = [str(index) for index in range(len(state.names) or len(state.position))]
    found = [index for index, name in enumerate(names) if name == joint or not joint]
    return found[0] if found and (joint or len(found) == 1) else None


def _check_pose_batch(messages: Sequence[bytes], arrays: Sequence[PoseArray | None]) -> None:
    batch = decode_pose_arrays(messages, _POSES)
    for row, array in enumerate(arrays):
        assert batch.malformed[row] == (array is None or len(array.numbers) != 7 * _POSES)
        if array and not batch.malformed[row]:
            assert batch.stamp[row] == array.stamp
            assert _text(batch.frame_ids[batch.frame[row]]) == array.frame_id
            _assert_same(batch.poses[row].ravel().tolist(), list(array.numbers))


def _encoded(sample: RotorSample, topics: Iterable[str]) -> dict[str, bytes]:
    rows = _STATES.rows(sample, topics)
    return {topic: template.encode(sample.stamp, numbers) for topic, template, numbers in rows}


def _check_rotor_input(messages: Sequence[bytes], encoder: str) -> None:
    """Take messages one by one and at once, with the same outcome; what is taken has a state."""
    settings = replace(_SETTINGS, rotor_encoder=encoder)
    one_by_one, at_once = RotorInput(settings), RotorInput(settings)
    samples = []
    for message in messages:
        with suppress(RejectedInputError):
            samples.append(one_by_one.accept(message, lambda: _NOW))
    batch = at_once.accept_batch(messages, [_NOW] * len(messages))
    columns = [column.tolist() for column in batch[:5]]
    _assert_same(
        [(stamp, turns + 0.0, *others) for stamp, turns, *others in zip(*columns, strict=True)],
        [
            (stamp, float(turns), angle, *(math.nan if rate is None else rate for rate in rates))
            for stamp, (turns, angle), *rates in samples
        ],
    )
    for account in (
        'received', 'rejected', 'duplicates', 'zero_stamps', 'unnormalised_stamps', 'resets',
        'referenced',
    ):  # fmt: skip
        assert getattr(one_by_one, account) == getattr(at_once, account)
    outputs = _STATES.encode_outputs(batch)
    expected = [_encoded(sample, outputs) for sample in samples]
    assert outputs == {topic: [each[topic] for each in expected] for topic in outputs}
    for sample in samples:
        for message in _encoded(sample, STATE_TOPICS).values():
            assert _decoded(decode_joint_state, message) or _decoded(decode_pose_array, message)
