# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One joint of messages of any layout, against the decoder that knows no layout before."""

import math
import struct

import pytest
from harnesses import harness
from hypothesis import given, settings
from hypothesis import strategies as st
from live import SECOND, rotor_bytes
from wire import micro_ros_bytes

from gear_kinematics.wire.batches import decode_joint_states
from gear_kinematics.wire.cdr import MalformedMessageError
from gear_kinematics.wire.joint_reader import (
    GREATEST,
    JointReader,
    JointsReader,
    RejectedInputError,
)

decode_joint_state = harness('messages').decode_joint_state
LARGEST = 2**51 * math.tau  # rad: beyond it a position is too large

names = st.sampled_from(['rotor', 'wheel', 'm1', '', '0', '1'])
bounds = [1e280, -1.0000000000000002e280, math.nan, LARGEST, -math.nextafter(LARGEST, math.inf)]
doubles = st.lists(st.floats() | st.sampled_from(bounds), max_size=4)
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
    """Apply the node's table of bad input to the decoded message."""
    try:
        message = decode_joint_state(data)
    except MalformedMessageError:
        return 'not a JointState'
    stamp, order = message.stamp, '<' if data[1] & 1 else '>'
    if stamp >= 2**31 * SECOND:
        return 'stamp out of range'
    joints = [name.decode(errors='replace') for name in message.names]
    if not any(joints):
        joints = [str(k) for k in range(len(joints) or len(message.position))]
    found = [k for k, name in enumerate(joints) if (name == joint if joint else len(joints) == 1)]
    if not found:
        return 'joint missing'
    arrays = message.position, message.velocity, message.effort
    if len(found) > 1 or any(len(array) not in {0, len(joints)} for array in arrays):
        return 'array sizes'
    if not len(message.position):
        return 'position missing'
    position, *rates = (
        values[found[0]] if found[0] < len(values) else None
        for values in (message.position, message.velocity, message.effort)
    )
    if not math.isfinite(position):
        return 'position not finite'
    if abs(position) > LARGEST:
        return 'position too large'
    rates = [rate if rate is not None and abs(rate) <= GREATEST else None for rate in rates]
    (nanoseconds,) = struct.unpack_from(f'{order}I', data, 8)
    return stamp, nanoseconds >= SECOND, position, *rates


@pytest.mark.slow
@settings(max_examples=80)
@given(st.lists(st.tuples(messages, st.booleans()), max_size=8), names)
def test_any_layout_is_read_after_any_other(sequence, joint):
    reader = JointReader(joint)
    for message, little_endian in sequence:
        for stamp in (message['stamp'], 5):  # the second time with the layout of the first
            data = rotor_bytes(**message | {'stamp': stamp}, little_endian=little_endian)
            assert read(reader, data) == expected(data, joint)


@pytest.mark.slow
@settings(max_examples=80)
@given(st.lists(messages, max_size=8), st.lists(names, min_size=1, max_size=3))
def test_several_joints_are_read_as_each_alone(sequence, joints):
    reader = JointsReader(joints)
    for message in sequence * 2:
        data = rotor_bytes(**message)
        alone = [expected(data, joint) for joint in joints]
        found = read(reader, data)
        if isinstance(found, str):
            assert {found} == {*alone}
        else:
            found = [str(one) if isinstance(one, Exception) else one for one in found]
            some = [None if one == 'joint missing' else one for one in alone]
            assert found == (some if any(some) else alone)


@pytest.mark.slow
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


def test_messages_may_have_any_size():
    count = 20_000  # far more than a layout that is kept
    data = rotor_bytes(7, [f'joint_{n}' for n in range(count)], range(count))
    reader = JointReader(f'joint_{count - 1}')
    for _ in range(2):
        assert reader.read(data) == (7, False, count - 1.0, None, None)


CHOSEN = [  # the joint, the names and number of positions of the message, the index taken
    ('', [], 1, 0),
    ('', [''], 1, 0),
    ('', ['m1'], 1, 0),
    ('', [], 2, None),
    ('', ['', ''], 2, None),
    ('0', [], 1, 0),
    ('1', [], 3, 1),
    ('2', ['', '', ''], 3, 2),
    ('3', ['', '', ''], 3, None),
    ('-1', ['', ''], 2, None),
    ('01', ['', ''], 2, None),
    ('1', ['m1', ''], 2, None),  # who names one joint names all
    ('1', ['1', '0'], 2, 0),  # a name, where there are names
    ('rotor', [], 1, None),
]


@pytest.mark.parametrize(('joint', 'names', 'count', 'index'), CHOSEN)
@pytest.mark.parametrize('write', [rotor_bytes, micro_ros_bytes])
def test_joint_without_a_name_goes_by_its_index(joint, names, count, index, write):
    position = [10.0 + k for k in range(count)]
    data = write(1, names, position, position)
    if index is None:
        with pytest.raises(RejectedInputError, match='joint missing'):
            JointReader(joint).read(data)
    else:
        assert JointReader(joint).read(data) == (1, False, 10.0 + index, 10.0 + index, None)


@pytest.mark.parametrize(('seconds', 'nanoseconds', 'stamp'), [
    (12, 10**9 - 1, 12_999_999_999), (12, 10**9, 13 * SECOND),
    (1732231175, 3_158_772_736, 1_732_231_178_158_772_736),
    (2**31 - 2, 10**9 + 7, (2**31 - 1) * SECOND + 7), (-1, 2**32 - 1, 3_294_967_295),
])  # fmt: skip
def test_stamp_is_the_time_that_its_parts_mean(seconds, nanoseconds, stamp):
    data = FULL[:4] + struct.pack('<iI', seconds, nanoseconds) + FULL[12:]
    assert JointReader('rotor').read(data) == (stamp, nanoseconds >= 10**9, 2.0, 4.0, 6.0)


@pytest.mark.parametrize(
    ('joint', 'names', 'detail'),
    [
        (
            'rotor',
            ['wheel', 'rotor_1'],
            "no joint 'rotor' in it; did you mean `rotor_1`? there are: rotor_1, wheel",
        ),
        ('rotor', ['wheel'], "no joint 'rotor' in it; there are: wheel"),
        ('rotor', [], "no joint 'rotor' in it; there are none"),
        ('', ['b', 'a'], 'more than one joint in it; there are: a, b'),
        ('', [], 'no joint in it'),
        ('m', ['\x1b[2J'], r"no joint 'm' in it; there are: \x1b[2J"),
        ('m', [''], "no joint 'm' in it; there are: 0"),
    ],
)
def test_missing_joint_is_told_with_those_that_there_are(joint, names, detail):
    data = rotor_bytes(SECOND, names, len(names) * [1.0])
    with pytest.raises(RejectedInputError) as rejected:
        JointReader(joint).read(data)
    assert (str(rejected.value), rejected.value.detail) == ('joint missing', detail)
    assert decode_joint_states([data], joint).missing_joint == detail
    assert next(iter(JointsReader([joint, 'm9']).read(data))).detail == detail


@pytest.mark.parametrize(
    ('names', 'position', 'effort', 'detail'),
    [
        (['m1', 'm2'], [1.0, 2.0], [0.5], '2 in name, but 1 in effort'),
        (['m1', 'm2'], [1.0], [0.5], '2 in name, but 1 in position and 1 in effort'),
        (['m1', 'm1'], [1.0, 2.0], [], "it names 'm1' 2 times"),
        (['m1'], [], [0.5], ''),
    ],
)
def test_sizes_that_do_not_fit_are_told(names, position, effort, detail):
    data = rotor_bytes(SECOND, names, position, [], effort)
    with pytest.raises(RejectedInputError) as rejected:
        JointReader('m1').read(data)
    assert rejected.value.detail == detail
