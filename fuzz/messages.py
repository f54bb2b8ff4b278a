"""Bytes as messages: decoded as rosbags decodes them or malformed, one by one and in batches.

An input is one message, or several with `SEPARATOR` between them, as a driver sends one after the
other.
"""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any

from rosbags.serde import SerdeError
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from gear_kinematics.joint_input import RejectedInputError
from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.message_batches import decode_joint_states, decode_pose_arrays
from gear_kinematics.messages import (
    SECOND,
    JointState,
    MalformedMessageError,
    PoseArray,
    decode_joint_state,
    decode_pose_array,
)
from gear_kinematics.rotor_input import InputSettings, RotorInput
from gear_kinematics.state_messages import StateMessages

SEPARATOR = b'\xff<>\xff'

_JOINT = 'rotor'
_POSES = 4
_NOW = 1_700_000_000 * SECOND  # the clock, for messages without a stamp
_MAX_LEFT_OVER = 15  # bytes that DDS and rclpy may leave behind a message
_STATES = StateMessages(
    Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi))),
    output_joint='output_shaft',
    frame_prefix='',
)

# A string is the same on the wire as its bytes, which need not be UTF-8.
_HEADER = 'int32 seconds\nuint32 nanoseconds\nText frame_id\n'
_typestore = get_typestore(Stores.EMPTY)
_typestore.register(
    get_types_from_msg('uint8[] data', 'raw/msg/Text')
    | get_types_from_msg('float64[7] data', 'raw/msg/Pose')
    | get_types_from_msg(
        f'{_HEADER}Text[] names\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort',
        'raw/msg/JointState',
    )
    | get_types_from_msg(f'{_HEADER}Pose[] poses', 'raw/msg/PoseArray')
)


def check(data: bytes) -> None:
    """Hold everything that decodes messages against rosbags, and against each other.

    Raises:
        AssertionError: if they differ.
    """
    messages = data.split(SEPARATOR)
    states = [reference_joint_state(message) for message in messages]
    _assert_same([_decoded(decode_joint_state, message) for message in messages], states)
    for joint in (_JOINT, ''):
        _check_joint_batch(messages, states, joint)

    arrays = [reference_pose_array(message) for message in messages]
    _assert_same([_decoded(decode_pose_array, message) for message in messages], arrays)
    _check_pose_batch(messages, arrays)

    for encoder in ('multi_turn', 'single_turn'):
        _check_rotor_input(messages, encoder)


def reference_joint_state(data: bytes) -> JointState | None:
    """Decode with rosbags; None where there is no JointState."""
    message = _reference(data, 'raw/msg/JointState')
    texts = message and _texts([message.frame_id, *message.names])
    if not texts:
        return None
    numbers = (message.position, message.velocity, message.effort)
    return JointState(_stamp(message), texts[1:], *(tuple(array.tolist()) for array in numbers))


def reference_pose_array(data: bytes) -> PoseArray | None:
    """Decode with rosbags; None where there is no PoseArray."""
    message = _reference(data, 'raw/msg/PoseArray')
    texts = message and _texts([message.frame_id])
    if not texts:
        return None
    numbers = (number for pose in message.poses for number in pose.data.tolist())
    return PoseArray(_stamp(message), texts[0], tuple(numbers))


def _reference(data: bytes, kind: str) -> Any:
    # Left alone, rosbags counts through any length that the bytes claim.
    _typestore.max_sequence_length = len(data) + 1
    for spare in range(0, _MAX_LEFT_OVER, 4):  # rosbags allows three bytes
        try:
            message: Any = _typestore.deserialize_cdr(data[: max(len(data) - spare, 0)], kind)
        except SerdeError as error:
            if 'size mismatch' in str(error):
                continue
            return None
        return message if message.nanoseconds < SECOND else None
    return None


def _texts(raw: Sequence[Any]) -> tuple[bytes, ...] | None:
    """Take the zeros off the ends of texts; None if one is missing."""
    texts = [text.data.tobytes() for text in raw]
    return tuple(text[:-1] for text in texts) if all(t.endswith(b'\0') for t in texts) else None


def _stamp(message: Any) -> int:
    return int(message.seconds) * SECOND + int(message.nanoseconds)


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
        found = [name for name in state.names if name == joint.encode() or not joint]
        index = state.names.index(found[0]) if found and (joint or len(found) == 1) else None
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


def _check_pose_batch(messages: Sequence[bytes], arrays: Sequence[PoseArray | None]) -> None:
    batch = decode_pose_arrays(messages, _POSES)
    for row, array in enumerate(arrays):
        assert batch.malformed[row] == (array is None or len(array.numbers) != 7 * _POSES)
        if array and not batch.malformed[row]:
            assert batch.stamp[row] == array.stamp
            assert batch.frame_ids[batch.frame[row]] == array.frame_id
            _assert_same(batch.poses[row].ravel().tolist(), list(array.numbers))


def _check_rotor_input(messages: Sequence[bytes], encoder: str) -> None:
    """Take messages one by one and at once, with the same outcome; what is taken has a state."""
    settings = InputSettings(_JOINT, -1, 0.5, encoder, 650.0, 6500.0)
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
    for account in ('received', 'rejected', 'duplicates', 'zero_stamps', 'resets', 'referenced'):
        assert getattr(one_by_one, account) == getattr(at_once, account)
    for sample in samples:
        for _, message in _STATES.encode(sample):
            assert _decoded(decode_joint_state, message) or _decoded(decode_pose_array, message)
