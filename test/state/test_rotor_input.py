"""The rotor input, by the rows of the contract's table of bad input."""

import math
import struct
from contextlib import nullcontext
from dataclasses import replace

import oracle
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from live import SECOND, rotor_bytes
from wire import micro_ros_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()
SINGLE_TURN = replace(SETTINGS, rotor_encoder='single_turn')
NOW = 77 * SECOND + 7
START = 100 * SECOND
TURN = 2.0 * math.pi
QUARTER = 0.5 * math.pi
LARGEST = 2**51 * TURN  # rad: beyond it a position is too large


def clock() -> int:
    return NOW


def no_clock() -> int:
    raise AssertionError('a message with a stamp needs no clock')


def accept(rotor_input, stamp, position, velocity=(), effort=()):
    data = rotor_bytes(stamp, position=[position], velocity=velocity, effort=effort)
    return rotor_input.accept(data, no_clock)


def homed(position, velocity=()) -> RotorInput:
    """The input of a single-turn encoder, homed at its first message."""
    rotor_input = RotorInput(SINGLE_TURN)
    accept(rotor_input, START, position, velocity)
    rotor_input.home(0.0)
    return rotor_input


def angle_error(sample, expected) -> float:
    """Difference from an exact rotor angle, including its turns, rad."""
    turns, angle = sample.position
    assert isinstance(turns, int)
    return oracle.angle_error(angle, expected - 2 * oracle.mp.pi * turns)


@pytest.fixture
def rotor_input() -> RotorInput:
    return RotorInput(SETTINGS)


REJECTED = [
    ('joint missing', {'names': [], 'position': []}),
    ('joint missing', {'names': ['wheel'], 'position': [1.0]}),
    ('joint missing', {'names': ['Rotor', 'rotor ', 'rotor\u200b'], 'position': [1.0] * 3}),
    ('joint missing', {'names': [], 'position': [1.0]}),
    ('position missing', {'position': []}),
    ('position missing', {'names': ['a', 'b', 'rotor'], 'position': [1.0, 2.0]}),
    ('position not finite', {'position': [math.nan]}),
    ('position not finite', {'position': [math.inf]}),
    ('position not finite', {'position': [-math.inf]}),
    ('position not finite', {'names': ['a', 'rotor'], 'position': [1.0, math.nan]}),
    ('position too large', {'position': [math.nextafter(LARGEST, math.inf)]}),
    ('position too large', {'position': [-1e17]}),
    ('position too large', {'position': [1.7e308]}),
]


@pytest.mark.parametrize(('cause', 'fields'), REJECTED)
def test_message_without_position_is_rejected_and_counted(rotor_input, cause, fields):
    first = accept(rotor_input, START, 1.0)
    for count in (1, 2):
        with pytest.raises(RejectedInputError, match=rf'^{cause}$'):
            rotor_input.accept(rotor_bytes(START + count, **fields), no_clock)
        assert rotor_input.rejected == {cause: count}
    assert rotor_input.received == 3
    assert rotor_input.last is first
    # Its stamp is ignored: the next message is not out of order.
    assert accept(rotor_input, START + 1, 2.0).stamp == START + 1


@pytest.mark.parametrize(
    'data',
    [b'', b'\0', b'\0\1\0\0', b'garbage!' * 20, rotor_bytes(1, position=[1.0])[:-1]],
    ids=['empty', 'one byte', 'encapsulation', 'garbage', 'cut off'],
)
def test_bytes_that_are_no_joint_state_are_rejected_and_counted(rotor_input, data):
    with pytest.raises(RejectedInputError, match=r'^not a JointState$'):
        rotor_input.accept(data, no_clock)
    assert rotor_input.rejected == {'not a JointState': 1}
    assert (rotor_input.received, rotor_input.last) == (1, None)


def test_causes_are_counted_separately(rotor_input):
    messages = (
        rotor_bytes(1, names=['x'], position=[0.0]),
        rotor_bytes(1, position=[math.nan]),
        rotor_bytes(1, names=['x'], position=[0.0]),
    )
    for data in messages:
        with pytest.raises(RejectedInputError):
            rotor_input.accept(data, no_clock)
    assert rotor_input.rejected == {'joint missing': 2, 'position not finite': 1}


def test_joint_is_looked_up_by_name(rotor_input):
    data = rotor_bytes(START, ['a', 'rotor', 'b'], [9.0, 1.5, 9.0], [8.0, 2.5, 8.0], [7.0, 3.5])
    sample = rotor_input.accept(data, no_clock)
    assert sample == (START, (0, 1.5), 2.5, 3.5)


def test_joint_name_may_be_any_text():
    rotor_input = RotorInput(replace(SETTINGS, rotor_joint='Läufer φ₂'))
    data = rotor_bytes(START, ['Läufer', 'Läufer φ₂'], [9.0, 1.5])
    assert rotor_input.accept(data, no_clock).position == (0, 1.5)


@pytest.mark.parametrize('names', [[], [''], ['anything']])
@pytest.mark.parametrize('write', [rotor_bytes, micro_ros_bytes])
def test_empty_rotor_joint_takes_the_only_joint(names, write):
    rotor_input = RotorInput(replace(SETTINGS, rotor_joint=''))
    data = write(START, names, [1.5], [2.5])
    assert rotor_input.accept(data, no_clock) == (START, (0, 1.5), 2.5, None)


@pytest.mark.parametrize(
    ('names', 'position'), [([], []), ([], [1.0, 2.0]), (['rotor', 'other'], [1.0, 2.0])]
)
def test_empty_rotor_joint_with_none_or_many_is_rejected(names, position):
    rotor_input = RotorInput(replace(SETTINGS, rotor_joint=''))
    with pytest.raises(RejectedInputError, match=r'^joint missing$'):
        rotor_input.accept(rotor_bytes(START, names, position), no_clock)


@pytest.mark.parametrize('names', [[], ['', '', '']])
def test_joint_without_a_name_is_looked_up_by_its_index(names):
    rotor_input = RotorInput(replace(SETTINGS, rotor_joint='2'))
    data = rotor_bytes(START, names, [7.0, 8.0, 1.5], [7.0, 8.0, 2.5])
    assert rotor_input.accept(data, no_clock) == (START, (0, 1.5), 2.5, None)


@pytest.mark.parametrize(
    ('given_values', 'taken'),
    [
        ([], None),
        ([5.0], None),  # too short: the rotor is the second joint
        ([5.0, math.nan], None),
        ([5.0, math.inf], None),
        ([5.0, -math.inf], None),
        ([math.nan, 6.0], 6.0),
        ([5.0, 0.0], 0.0),
    ],
)
@pytest.mark.parametrize('field', ['velocity', 'effort'])
def test_missing_velocity_or_effort_is_none(rotor_input, field, given_values, taken):
    data = rotor_bytes(START, ['other', 'rotor'], [9.0, 1.5], **{field: given_values})
    sample = rotor_input.accept(data, no_clock)
    assert sample.position == (0, 1.5)
    assert getattr(sample, field) == taken
    assert getattr(sample, 'effort' if field == 'velocity' else 'velocity') is None
    assert not rotor_input.rejected


def test_zero_stamp_is_replaced_by_the_clock_and_counted(rotor_input):
    sample = rotor_input.accept(rotor_bytes(0, position=[1.0]), clock)
    assert sample.stamp == NOW
    assert rotor_input.zero_stamps == 1
    accept(rotor_input, NOW + 1, 1.0)
    assert rotor_input.zero_stamps == 1


@pytest.mark.parametrize('stamp', [1, SECOND, -1, 2**31 * SECOND - 1])
def test_any_other_stamp_is_kept_exactly(rotor_input, stamp):
    assert accept(rotor_input, stamp, 1.0).stamp == stamp
    assert rotor_input.zero_stamps == 0


def test_unnormalised_stamp_is_normalised_and_counted(rotor_input):
    def restamped(seconds, nanoseconds):
        data = rotor_bytes(START, position=[1.0])
        return data[:4] + struct.pack('<iI', seconds, nanoseconds) + data[12:]

    assert rotor_input.accept(restamped(100, 3_158_772_736), no_clock).stamp == 103_158_772_736
    assert rotor_input.unnormalised_stamps == 1
    # The order is that of the times that stamps mean, not that of their seconds.
    with pytest.raises(RejectedInputError, match=r'^out of order$'):
        rotor_input.accept(restamped(103, 0), no_clock)
    assert rotor_input.accept(restamped(102, 2 * SECOND), no_clock).stamp == 104 * SECOND
    assert rotor_input.unnormalised_stamps == 2
    with pytest.raises(RejectedInputError, match=r'^stamp out of range$'):
        rotor_input.accept(restamped(2**31 - 1, SECOND), no_clock)
    assert (rotor_input.unnormalised_stamps, rotor_input.zero_stamps) == (2, 0)
    assert rotor_input.rejected == {'out of order': 1, 'stamp out of range': 1}


@pytest.mark.parametrize('position', [LARGEST, -LARGEST, 1e15 + 0.5])
def test_position_is_exact_up_to_the_largest(rotor_input, position):
    sample = accept(rotor_input, START, position)
    assert angle_error(sample, oracle.rotor_angle_of(position)) < 1e-15


def test_mostly_rejected_is_more_than_half(rotor_input):
    assert not rotor_input.mostly_rejected
    for rejected, mostly in ((False, False), (True, False), (True, True), (False, False)):
        stamp = START + rotor_input.received
        with pytest.raises(RejectedInputError) if rejected else nullcontext():
            accept(rotor_input, stamp, math.nan if rejected else 1.0)
        assert rotor_input.mostly_rejected is mostly


def test_duplicate_is_taken_and_counted(rotor_input):
    accept(rotor_input, START, 1.0)
    assert rotor_input.duplicates == 0
    for count in (1, 2):
        assert accept(rotor_input, START, 1.0 + count).position == (0, 1.0 + count)
        assert rotor_input.duplicates == count
    assert not rotor_input.rejected


@pytest.mark.parametrize('age', [1, SECOND // 2, SECOND - 1, SECOND])
def test_stamp_older_by_up_to_a_second_is_dropped_and_counted(rotor_input, age):
    newest = accept(rotor_input, START, 1.0)
    with pytest.raises(RejectedInputError, match=r'^out of order$'):
        accept(rotor_input, START - age, 2.0)
    assert rotor_input.rejected == {'out of order': 1}
    assert rotor_input.last is newest
    assert rotor_input.resets == 0


@pytest.mark.parametrize('age', [SECOND + 1, 2 * SECOND, START - 1, START + 5])
def test_stamp_older_by_more_than_a_second_resets_the_state(rotor_input, age):
    accept(rotor_input, START, 1.0)
    assert accept(rotor_input, START - age, 2.0).stamp == START - age
    assert (rotor_input.resets, sum(rotor_input.rejected.values())) == (1, 0)
    assert accept(rotor_input, START - age + 1, 2.0).stamp == START - age + 1


def test_age_counts_from_the_last_accepted_message(rotor_input):
    # Dropped stamps must not shift the reference until they amount to a reset.
    accept(rotor_input, START, 1.0)
    for age in (SECOND, SECOND // 2, SECOND):
        with pytest.raises(RejectedInputError):
            accept(rotor_input, START - age, 1.0)
    assert rotor_input.rejected == {'out of order': 3}
    accept(rotor_input, START - SECOND - 1, 1.0)
    assert rotor_input.resets == 1


def test_zero_stamp_obeys_the_order_too(rotor_input):
    accept(rotor_input, NOW + 1, 1.0)
    with pytest.raises(RejectedInputError, match=r'^out of order$'):
        rotor_input.accept(rotor_bytes(0, position=[1.0]), clock)


@pytest.mark.parametrize('direction', [1, -1])
def test_direction_and_zero_give_the_rotor_angle_rate_and_torque(direction):
    rotor_input = RotorInput(replace(SETTINGS, rotor_direction=direction, rotor_zero=0.75))
    sample = accept(rotor_input, START, 30.5, [4.0], [0.25])
    expected = oracle.rotor_angle_of(30.5, zero=0.75, direction=direction)
    assert angle_error(sample, expected) < 1e-14
    assert (sample.velocity, sample.effort) == (direction * 4.0, direction * 0.25)


@given(st.floats(-1e9, 1e9), st.floats(-1e6, 1e6), st.sampled_from([1, -1]))
@example(1e15, 0.1, 1)
@example(6.283185307179586e9, 0.0, -1)
@example(123456.789, 123456.789, 1)
def test_rotor_angle_is_exact(position, zero, direction):
    rotor_input = RotorInput(replace(SETTINGS, rotor_direction=direction, rotor_zero=zero))
    sample = accept(rotor_input, START, position)
    expected = oracle.rotor_angle_of(position, zero=zero, direction=direction)
    # Turns are integers, so what is left is the rounding of two angles within a turn.
    assert angle_error(sample, expected) < 4e-15


def test_changed_settings_hold_for_the_next_message(rotor_input):
    accept(rotor_input, START, 1.0)
    rotor_input.parameters = replace(SETTINGS, rotor_direction=-1, rotor_zero=0.25)
    assert accept(rotor_input, START + 1, 1.0).position == (0, -0.75)
    rotor_input.parameters = replace(SETTINGS, rotor_joint='other')
    with pytest.raises(RejectedInputError, match=r'^joint missing$'):
        accept(rotor_input, START + 2, 1.0)


def test_home_before_any_input_is_refused(rotor_input):
    with pytest.raises(RuntimeError):
        rotor_input.home(0.0)


@pytest.mark.parametrize('settings', [SETTINGS, SINGLE_TURN], ids=['multi', 'single'])
@pytest.mark.parametrize('direction', [1, -1])
@pytest.mark.parametrize('declared', [0.0, 3.7, -250.0])
def test_home_gives_the_zero_for_the_declared_angle(settings, direction, declared):
    settings = replace(settings, rotor_direction=direction, rotor_zero=0.5)
    rotor_input = RotorInput(settings)
    accept(rotor_input, START, 2.25)
    zero = rotor_input.home(declared)
    rotor_input.parameters = replace(settings, rotor_zero=zero)
    assert rotor_input.referenced
    sample = accept(rotor_input, START + SECOND // 1000, 2.25)
    assert angle_error(sample, oracle.mp.mpf(declared)) < 1e-13


def test_home_after_many_turns_of_a_single_turn_encoder():
    rotor_input = RotorInput(SINGLE_TURN)
    step = SECOND // 100
    stamp = START
    for number in range(41):  # ten turns and a position of 1 rad
        stamp += step
        accept(rotor_input, stamp, math.remainder(1.0 + number * QUARTER, TURN))
    zero = rotor_input.home(5.0)
    rotor_input.parameters = replace(SINGLE_TURN, rotor_zero=zero)
    assert angle_error(accept(rotor_input, stamp + step, 1.0), oracle.mp.mpf(5)) < 1e-13
    onward = accept(rotor_input, stamp + 2 * step, 1.0 + QUARTER)
    assert angle_error(onward, 5 + oracle.mp.pi / 2) < 1e-13


def test_multi_turn_encoder_is_always_referenced(rotor_input):
    assert rotor_input.referenced
    accept(rotor_input, START, 1.0)
    accept(rotor_input, START + 1000 * SECOND, 1e6)
    assert rotor_input.referenced


@pytest.mark.parametrize('direction', [1, -1])
@pytest.mark.parametrize('sign', [1, -1])
@pytest.mark.parametrize('offset', [0.0, math.pi, 20 * math.pi])
def test_single_turn_encoder_is_unwrapped(direction, sign, offset):
    rotor_input = RotorInput(replace(SINGLE_TURN, rotor_direction=direction))
    for number in range(50):
        # Within 2 ms the rotor turns 1.3 rad at most; here it turns 1.2.
        angle = 1.2 * sign * number
        wrapped = math.remainder(angle, TURN) + offset
        sample = accept(rotor_input, START + number * SECOND // 500, wrapped)
    turns = round((angle - math.remainder(angle, TURN)) / TURN)
    assert turns != 0
    # A first position beyond a turn may begin on any turn, but must stay on it.
    expected = oracle.rotor_angle_of(math.remainder(angle, TURN), 0.0, direction, turns)
    assert oracle.turn_angle_error(sample.position.angle, expected + direction * offset) < 1e-13
    first = RotorInput(replace(SINGLE_TURN, rotor_direction=direction))
    began = accept(first, START, offset).position
    travelled = TURN * (sample.position.turns - began.turns)
    travelled += sample.position.angle - began.angle
    assert travelled == pytest.approx(direction * angle, abs=1e-12)


def test_single_turn_encoder_is_not_referenced_before_home():
    rotor_input = RotorInput(SINGLE_TURN)
    assert not rotor_input.referenced
    accept(rotor_input, START, 1.0)
    assert not rotor_input.referenced
    rotor_input.home(0.0)
    assert rotor_input.referenced


# At 650 rad/s half a turn takes 4.833 ms.
@pytest.mark.parametrize(('gap', 'known'), [(0, True), (4_800_000, True), (4_900_000, False)])
def test_single_turn_encoder_loses_its_reference_over_half_a_turn(gap, known):
    rotor_input = homed(1.0)
    accept(rotor_input, START + gap, 1.25)
    assert rotor_input.referenced is known
    # Then output goes on from the nearest turn, and stays without reference.
    assert accept(rotor_input, START + gap + 1, 1.25).position == (0, 1.25)
    assert rotor_input.referenced is known


@pytest.mark.parametrize(
    ('before', 'after', 'turns'), [(3.0, -3.0, 1), (-3.0, 3.0, -1), (1.0, -1.0, 0)]
)
def test_single_turn_encoder_goes_on_from_the_nearest_turn(before, after, turns):
    rotor_input = homed(before)
    sample = accept(rotor_input, START + 60 * SECOND, after)
    assert not rotor_input.referenced
    assert sample.position == (turns, after)


def test_velocity_narrows_the_possible_turn_of_a_single_turn_encoder():
    # 20 ms at a steady 400 rad/s are 8 rad: more than a turn, and known from the velocities.
    rotor_input = homed(0.0, [400.0])
    sample = accept(rotor_input, START + 20_000_000, 8.0 - TURN, [400.0])
    assert rotor_input.referenced
    assert sample.position == (1, pytest.approx(8.0 - TURN))


def test_clock_reset_loses_the_reference_of_a_single_turn_encoder():
    rotor_input = homed(3.0)
    accept(rotor_input, START - 2 * SECOND, 3.0)
    assert not rotor_input.referenced
    assert rotor_input.resets == 1


def test_rejected_messages_do_not_turn_the_rotor():
    rotor_input = homed(3.0)
    with pytest.raises(RejectedInputError):
        accept(rotor_input, START - 1, -1.0)
    assert rotor_input.last.position == (0, 3.0)
    assert accept(rotor_input, START + 1_000_000, -3.0).position.turns == 1
    assert rotor_input.referenced


def test_change_of_encoder_resets_the_state(rotor_input):
    accept(rotor_input, START, 20.0)
    rotor_input.parameters = SINGLE_TURN
    assert not rotor_input.referenced
    with pytest.raises(RuntimeError):
        rotor_input.home(0.0)
    rotor_input.parameters = SETTINGS
    assert rotor_input.referenced


def test_other_changes_keep_the_turns():
    rotor_input = homed(3.0)
    accept(rotor_input, START + 1_000_000, -3.0)
    rotor_input.parameters = replace(SINGLE_TURN, rotor_zero=0.25, max_rotor_speed=1.0)
    assert rotor_input.referenced
    assert accept(rotor_input, START + 2_000_000, -3.0).position == (1, -3.25)


def test_changed_maximum_speed_holds_from_now_on():
    rotor_input = homed(1.0)
    rotor_input.parameters = replace(SINGLE_TURN, max_rotor_speed=1.0)
    accept(rotor_input, START + 3 * SECOND, 1.0)
    assert rotor_input.referenced  # 3 rad at most
    accept(rotor_input, START + 7 * SECOND, 1.0)
    assert not rotor_input.referenced


numbers = st.lists(st.floats(width=64), max_size=2)


@given(
    st.sampled_from([SETTINGS, SINGLE_TURN]),
    st.lists(
        st.tuples(st.integers(-3 * SECOND, 3 * SECOND), numbers, numbers, numbers), max_size=8
    ),
)
@example(SINGLE_TURN, [(0, [1.0], [0.0], []), (SECOND, [1.0], [1e200], [])])
@example(SETTINGS, [(0, [1.7e308], [1.7e308], [-1.7e308])])
@example(SINGLE_TURN, [(0, [1.7e308], [], []), (SECOND, [-1.7e308], [], [])])
def test_any_numbers_are_accepted_or_rejected(settings, messages):
    rotor_input = RotorInput(settings)
    stamp, taken = START, 0
    for step, position, velocity, effort in messages:
        stamp += step
        data = rotor_bytes(stamp, ['rotor'], position, velocity, effort)
        try:
            sample = rotor_input.accept(data, clock)
        except RejectedInputError:
            continue
        taken += 1
        assert math.isfinite(sample.position.angle)
        assert all(value is None or math.isfinite(value) for value in sample[2:])
    assert rotor_input.received == len(messages) == taken + rotor_input.rejected.total()
