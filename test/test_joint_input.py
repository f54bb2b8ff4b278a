"""One joint of messages of any layout, against the decoder that knows no layout before."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from live import rotor_bytes

from gear_kinematics.joint_input import GREATEST, JointReader, RejectedInputError
from gear_kinematics.messages import MalformedMessageError, decode_joint_state

names = st.sampled_from(['rotor', 'wheel', 'm1', ''])
doubles = st.lists(
    st.floats() | st.sampled_from([1e300, -1.0000000000000002e300, math.nan]), max_size=4
)
messages = st.builds(
    dict,
    stamp=st.integers(-(2**31) * 10**9, 2**31 * 10**9 - 1),
    names=st.lists(names, max_size=4),
    position=doubles,
    velocity=doubles,
    effort=doubles,
    frame_id=st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=9),
)
FULL = rotor_bytes(
    12_000_000_034, ['m1', 'rotor'], [1.0, 2.0], [3.0, 4.0], [5.0, 6.0], frame_id='base'
)


def read(reader, data):
    """Give what is read, or why it is not."""
    try:
        return reader.read(data)
    except RejectedInputError as rejection:
        return str(rejection)


def expected(data, joint):
    """Apply the README's table of bad input to the decoded message."""
    try:
        message = decode_joint_state(data)
    except MalformedMessageError:
        return 'not a JointState'
    found = [
        k
        for k, name in enumerate(message.names)
        if (name == joint.encode() if joint else len(message.names) == 1)
    ]
    if not found:
        return 'joint missing'
    if found[0] >= len(message.position):
        return 'position missing'
    values = [
        values[found[0]]
        if found[0] < len(values)
        and math.isfinite(values[found[0]])
        and abs(values[found[0]]) <= GREATEST
        else None
        for values in (message.position, message.velocity, message.effort)
    ]
    return 'position not finite' if values[0] is None else (message.stamp, *values)


@given(st.lists(st.tuples(messages, st.booleans()), max_size=8), names)
def test_any_layout_is_read_after_any_other(sequence, joint):
    reader = JointReader(joint)
    for message, little_endian in sequence:
        for stamp in (message['stamp'], 5):  # the second time with the layout of the first
            data = rotor_bytes(**message | {'stamp': stamp}, little_endian=little_endian)
            assert read(reader, data) == expected(data, joint)


@given(messages, names, st.data())
def test_every_message_is_held_against_the_layout(message, joint, data):
    good = rotor_bytes(**message)
    reader = JointReader(joint)
    assert read(reader, good) == expected(good, joint)
    changed = bytearray(good)
    for _ in range(data.draw(st.integers(1, 3))):
        changed[data.draw(st.integers(0, len(good) - 1))] ^= data.draw(st.integers(1, 255))
    assert read(reader, bytes(changed)) == expected(bytes(changed), joint)
    assert read(reader, good) == expected(good, joint)


def test_reading_goes_on_after_bytes_that_are_no_message():
    reader = JointReader('rotor')
    for data in (b'', FULL[:50], bytes(len(FULL)), FULL + bytes(64)):
        assert reader.read(FULL) == (12_000_000_034, 2.0, 4.0, 6.0)
        with pytest.raises(RejectedInputError, match='not a JointState'):
            reader.read(data)
    assert reader.read(FULL) == (12_000_000_034, 2.0, 4.0, 6.0)


def test_padding_is_passed_over():
    # Between "frame" with its length and the number of names are two bytes of chance.
    data = rotor_bytes(1, ['rotor'], [1.0], frame_id='frame')
    start = data.index(b'frame\0') + len(b'frame\0')
    reader = JointReader('rotor')
    assert reader.read(data) == (1, 1.0, None, None)
    assert reader.read(data[:start] + b'\x5a\xa5' + data[start + 2 :]) == (1, 1.0, None, None)


def test_messages_may_have_any_size():
    count = 20_000  # far more than a layout that is kept
    data = rotor_bytes(7, [f'joint_{n}' for n in range(count)], range(count))
    reader = JointReader(f'joint_{count - 1}')
    for _ in range(2):
        assert reader.read(data) == (7, count - 1.0, None, None)
